//! Opening the database: connections, migrations, refusal of a newer schema.

use std::path::{Path, PathBuf};
use std::time::Duration;

use sqlx::migrate::Migrator;
use sqlx::sqlite::{SqliteConnectOptions, SqliteJournalMode, SqlitePoolOptions, SqliteSynchronous};

use super::{Store, StoreError};

static MIGRATIONS: Migrator = sqlx::migrate!("../migrations");

/// The database cannot be opened.
#[derive(Debug, thiserror::Error)]
pub enum OpenError {
    /// The address is not one of SQLite.
    #[error("database {0:?}: give a path or sqlite://PATH")]
    Address(String),
    /// The folder cannot be made.
    #[error("folder {path}: {source}")]
    Folder {
        /// Which one.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// The file was written by a newer version of the service.
    #[error(
        "database {path}: schema {found} is newer than {known}, the newest this version knows; upgrade the service"
    )]
    Newer {
        /// Which file.
        path: PathBuf,
        /// Newest migration in the file.
        found: i64,
        /// Newest migration known.
        known: i64,
    },
    /// A migration failed; the file is as before it.
    #[error("database {path}: migration: {source}")]
    Migrate {
        /// Which file.
        path: PathBuf,
        /// Why.
        source: Box<sqlx::migrate::MigrateError>,
    },
    /// The database refused.
    #[error("database {path}: {source}")]
    Sql {
        /// Which file.
        path: PathBuf,
        /// Why.
        source: sqlx::Error,
    },
}

impl Store {
    /// Opens, or creates, the database at `address` (`sqlite://PATH` or a path) and brings it to the newest schema.
    ///
    /// # Errors
    /// [`OpenError`] when the file cannot be used; it is left as it was.
    pub async fn open(address: &str, readers: u32) -> Result<Self, OpenError> {
        let path = file_of(address)?;
        if let Some(folder) = path.parent().filter(|folder| !folder.as_os_str().is_empty()) {
            std::fs::create_dir_all(folder)
                .map_err(|source| OpenError::Folder { path: folder.to_owned(), source })?;
        }
        let sql = |source| OpenError::Sql { path: path.clone(), source };
        let options = SqliteConnectOptions::new()
            .filename(&path)
            .create_if_missing(true)
            .journal_mode(SqliteJournalMode::Wal)
            .synchronous(SqliteSynchronous::Full)
            .foreign_keys(true)
            .busy_timeout(Duration::from_secs(5))
            .pragma("temp_store", "memory")
            .pragma("journal_size_limit", "67108864")
            .pragma("cache_size", "-65536");
        let writer = SqlitePoolOptions::new()
            .max_connections(1)
            .min_connections(1)
            .idle_timeout(None)
            .max_lifetime(None)
            .acquire_timeout(Duration::from_secs(60))
            .connect_with(options)
            .await
            .map_err(sql)?;
        migrate(&writer, &path).await?;
        // The journal mode is the file's; a read-only connection cannot set it.
        let read_only = SqliteConnectOptions::new()
            .filename(&path)
            .read_only(true)
            .busy_timeout(Duration::from_secs(5))
            .pragma("query_only", "on")
            .pragma("temp_store", "memory")
            .pragma("cache_size", "-65536");
        let reader = SqlitePoolOptions::new()
            .max_connections(readers)
            .min_connections(1)
            .idle_timeout(None)
            .max_lifetime(None)
            .acquire_timeout(Duration::from_secs(60))
            .connect_with(read_only)
            .await
            .map_err(sql)?;
        Ok(Self { writer, reader })
    }

    /// Lets go of the file: waits for running statements, folds the write-ahead log back.
    pub async fn close(&self) {
        self.reader.close().await;
        let folded = sqlx::query("pragma wal_checkpoint(truncate)").execute(&self.writer).await;
        if let Err(error) = folded {
            tracing::warn!(%error, "the write-ahead log was not folded back; the next start does it");
        }
        self.writer.close().await;
    }
}

fn file_of(address: &str) -> Result<PathBuf, OpenError> {
    let path = match address.split_once("://") {
        Some(("sqlite", rest)) => rest.split('?').next().unwrap_or(rest),
        Some(_) => return Err(OpenError::Address(address.to_owned())),
        None => address.strip_prefix("sqlite:").unwrap_or(address),
    };
    if path.is_empty() || path == ":memory:" {
        return Err(OpenError::Address(address.to_owned()));
    }
    Ok(PathBuf::from(path))
}

async fn migrate(writer: &sqlx::SqlitePool, path: &Path) -> Result<(), OpenError> {
    let sql = |source| OpenError::Sql { path: path.to_owned(), source };
    let known = MIGRATIONS.iter().map(|one| one.version).max().unwrap_or(0);
    let has_history: Option<i64> =
        sqlx::query_scalar("select 1 from sqlite_schema where name = '_sqlx_migrations'")
            .fetch_optional(writer)
            .await
            .map_err(sql)?;
    if has_history.is_some() {
        let found: Option<i64> = sqlx::query_scalar("select max(version) from _sqlx_migrations")
            .fetch_one(writer)
            .await
            .map_err(sql)?;
        if let Some(found) = found.filter(|&found| found > known) {
            return Err(OpenError::Newer { path: path.to_owned(), found, known });
        }
    }
    MIGRATIONS
        .run(writer)
        .await
        .map_err(|source| OpenError::Migrate { path: path.to_owned(), source: Box::new(source) })
}

impl From<OpenError> for StoreError {
    fn from(error: OpenError) -> Self {
        Self::Corrupt { what: "database".to_owned(), why: error.to_string() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses() {
        assert_eq!(file_of("sqlite:///var/lib/tamp.sqlite").unwrap(), PathBuf::from("/var/lib/tamp.sqlite"));
        assert_eq!(file_of("sqlite://data/tamp.sqlite?mode=rwc").unwrap(), PathBuf::from("data/tamp.sqlite"));
        assert_eq!(file_of("tamp.sqlite").unwrap(), PathBuf::from("tamp.sqlite"));
        assert!(file_of("postgres://host/tamp").is_err());
        assert!(file_of("sqlite::memory:").is_err());
    }

    #[tokio::test]
    async fn a_newer_schema_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("tamp.sqlite");
        let address = file.to_str().unwrap();
        let store = Store::open(address, 1).await.unwrap();
        sqlx::query(
            "insert into _sqlx_migrations (version, description, success, checksum, execution_time)
             values (9999, 'future', 1, x'00', 0)",
        )
        .execute(&store.writer)
        .await
        .unwrap();
        store.close().await;
        assert!(matches!(Store::open(address, 1).await, Err(OpenError::Newer { found: 9999, .. })));
    }
}
