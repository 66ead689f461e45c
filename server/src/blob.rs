//! Content-addressed files for checkpoints and outcomes: `blobs/ab/abcdef…`, named by the BLAKE3 hash of the bytes.
//!
//! A file appears under its name only when it is complete and on disk (temporary file, fsync, rename, fsync of the
//! folder), so a row that refers to a hash never meets half a file.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

/// The store of files.
#[derive(Debug)]
pub struct BlobStore {
    root: PathBuf,
    /// Held as long as the store is open: two coordinators on one data directory would take each other's leases.
    _lock: std::fs::File,
    counter: AtomicU64,
}

/// A file cannot be written or read.
#[derive(Debug, thiserror::Error)]
pub enum BlobError {
    /// The file system refused.
    #[error("blob {hash}: {source}")]
    Io {
        /// Which file.
        hash: String,
        /// Why.
        source: std::io::Error,
    },
    /// The bytes on disk are not those that were written.
    #[error("blob {0} is damaged: its bytes do not have this hash")]
    Damaged(String),
}

impl BlobStore {
    /// Opens the store under `data_dir`, creating it when absent, and locks the directory.
    ///
    /// # Errors
    /// When the folder cannot be made, or another process has it.
    pub fn open(data_dir: &Path) -> std::io::Result<Self> {
        let lock = std::fs::File::create(data_dir.join("lock"))?;
        lock.try_lock().map_err(|refused| match refused {
            std::fs::TryLockError::WouldBlock => {
                std::io::Error::other("another coordinator uses it; stop that one first")
            }
            std::fs::TryLockError::Error(error) => error,
        })?;
        let root = data_dir.join("blobs");
        std::fs::create_dir_all(root.join("new"))?;
        // What a crash left half written is of no use to anybody.
        for entry in std::fs::read_dir(root.join("new"))? {
            std::fs::remove_file(entry?.path())?;
        }
        Ok(Self { root, _lock: lock, counter: AtomicU64::new(0) })
    }

    /// Stores `bytes` durably and returns their hash. Blocking.
    ///
    /// # Errors
    /// [`BlobError::Io`] when the disk refuses; nothing is left under the name then.
    pub fn put(&self, bytes: &[u8]) -> Result<String, BlobError> {
        let hash = blake3::hash(bytes).to_hex().to_string();
        let failed = |source| BlobError::Io { hash: hash.clone(), source };
        let target = self.path(&hash);
        if target.metadata().is_ok_and(|known| known.len() == bytes.len() as u64) {
            return Ok(hash);
        }
        let turn = self.counter.fetch_add(1, Ordering::Relaxed);
        let fresh = self.root.join("new").join(format!("{hash}.{}.{turn}", std::process::id()));
        let written = write_durably(&fresh, &target, bytes);
        if written.is_err() {
            // Best effort: the name in `new` is cleared at the next start anyway.
            let _ = std::fs::remove_file(&fresh);
        }
        written.map_err(failed)?;
        Ok(hash)
    }

    /// Reads a file back and checks it against its name. Blocking.
    ///
    /// # Errors
    /// [`BlobError`] when the file is missing, unreadable or damaged.
    pub fn get(&self, hash: &str) -> Result<Vec<u8>, BlobError> {
        let bytes = std::fs::read(self.path(hash))
            .map_err(|source| BlobError::Io { hash: hash.to_owned(), source })?;
        if blake3::hash(&bytes).to_hex().as_str() == hash {
            Ok(bytes)
        } else {
            Err(BlobError::Damaged(hash.to_owned()))
        }
    }

    /// Removes a file; a missing one is no error. Blocking.
    ///
    /// # Errors
    /// [`BlobError::Io`] when the disk refuses.
    pub fn remove(&self, hash: &str) -> Result<(), BlobError> {
        match std::fs::remove_file(self.path(hash)) {
            Err(source) if source.kind() != std::io::ErrorKind::NotFound => {
                Err(BlobError::Io { hash: hash.to_owned(), source })
            }
            _ => Ok(()),
        }
    }

    fn path(&self, hash: &str) -> PathBuf {
        self.root.join(hash.get(..2).unwrap_or("xx")).join(hash)
    }
}

fn write_durably(fresh: &Path, target: &Path, bytes: &[u8]) -> std::io::Result<()> {
    let mut file = std::fs::File::create(fresh)?;
    file.write_all(bytes)?;
    file.sync_all()?;
    let folder = target.parent().expect("a blob lies in a folder");
    std::fs::create_dir_all(folder)?;
    std::fs::rename(fresh, target)?;
    std::fs::File::open(folder)?.sync_all()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_coordinator_at_a_time() {
        let folder = tempfile::tempdir().unwrap();
        let first = BlobStore::open(folder.path()).unwrap();
        let error = BlobStore::open(folder.path()).unwrap_err();
        assert!(error.to_string().contains("another coordinator"), "{error}");
        drop(first);
        BlobStore::open(folder.path()).unwrap();
    }

    #[test]
    fn bytes_come_back_and_damage_is_seen() {
        let folder = tempfile::tempdir().unwrap();
        let store = BlobStore::open(folder.path()).unwrap();
        let hash = store.put(b"packing").unwrap();
        assert_eq!(store.put(b"packing").unwrap(), hash);
        assert_eq!(store.get(&hash).unwrap(), b"packing");
        std::fs::write(store.path(&hash), b"pocking").unwrap();
        assert!(matches!(store.get(&hash), Err(BlobError::Damaged(_))));
        store.remove(&hash).unwrap();
        store.remove(&hash).unwrap();
        assert!(matches!(store.get(&hash), Err(BlobError::Io { .. })));
    }
}
