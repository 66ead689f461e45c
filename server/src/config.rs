//! Configuration: command line over `TAMP_…` environment over TOML file over defaults. Parsed once.

use std::net::SocketAddr;
use std::path::PathBuf;
use std::time::Duration;

use clap::Parser;
use figment::Figment;
use figment::providers::{Env, Format, Serialized, Toml};
use serde::{Deserialize, Serialize};

/// Everything the coordinator can be told.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Config {
    /// Address to listen on; port 0 takes a free one.
    pub bind: SocketAddr,
    /// Directory of the database and of checkpoints and packings.
    pub data_dir: PathBuf,
    /// Database; absent: `tamp.sqlite` in the data directory.
    pub database: Option<String>,
    /// Bearer token asked of everybody; absent: the service is open, bind it to a trusted address.
    pub token: Option<String>,
    /// A lease not renewed for this long returns to the queue [s].
    pub lease_seconds: f64,
    /// Workers are asked for a heartbeat this often [s].
    pub heartbeat_seconds: f64,
    /// Leases found at start hold at least this long: workers may have outlived the coordinator [s].
    pub grace_seconds: f64,
    /// Heartbeats are written together this often [s].
    pub flush_seconds: f64,
    /// Reconcilers run this often, besides being nudged [s].
    pub tick_seconds: f64,
    /// Program failures after which a job is set aside.
    pub max_failures: u32,
    /// Lost workers since the last new checkpoint after which a job is set aside.
    pub max_losses: u32,
    /// First pause after a failure; doubles with every further one [s].
    pub retry_seconds: f64,
    /// Most points of one sweep.
    pub max_points: u64,
    /// Largest body of a submission [bytes].
    pub max_body_bytes: u64,
    /// Largest body of a result [bytes].
    pub max_result_bytes: u64,
    /// Largest checkpoint [bytes].
    pub max_checkpoint_bytes: u64,
    /// Events kept for `Last-Event-ID`.
    pub max_events: u64,
    /// Read connections to the database.
    pub readers: u32,
    /// Log filter, for example `info` or `server=debug`.
    pub log: String,
    /// Logs as JSON lines.
    pub log_json: bool,
}

impl Default for Config {
    fn default() -> Self {
        Self {
            bind: SocketAddr::from(([127, 0, 0, 1], 8300)),
            data_dir: PathBuf::from("tamp-data"),
            database: None,
            token: None,
            lease_seconds: 90.0,
            heartbeat_seconds: 20.0,
            grace_seconds: 120.0,
            flush_seconds: 1.0,
            tick_seconds: 2.0,
            max_failures: 3,
            max_losses: 8,
            retry_seconds: 5.0,
            max_points: 1_000_000,
            max_body_bytes: 16 << 20,
            max_result_bytes: 256 << 20,
            max_checkpoint_bytes: 1 << 30,
            max_events: 200_000,
            readers: 4,
            log: "info".to_owned(),
            log_json: false,
        }
    }
}

/// Command line of the coordinator; every option also as `TAMP_…` in the environment and in the TOML file.
#[derive(Clone, Debug, Default, Parser, Serialize)]
#[command(name = "tamp-server", version, about = "The coordinator of Tamp")]
pub struct Args {
    /// TOML file with any of the options below (underscores instead of dashes).
    #[arg(long, value_name = "FILE")]
    #[serde(skip)]
    pub config: Option<PathBuf>,
    /// Print the configuration that would be used, and exit.
    #[arg(long)]
    #[serde(skip)]
    pub check_config: bool,
    /// Print the API description (the content of api.yaml), and exit.
    #[arg(long)]
    #[serde(skip)]
    pub print_api: bool,
    /// Address to listen on [default: 127.0.0.1:8300].
    #[arg(long, value_name = "ADDRESS")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bind: Option<SocketAddr>,
    /// Directory of database, checkpoints and packings [default: tamp-data].
    #[arg(long, value_name = "DIR")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub data_dir: Option<PathBuf>,
    /// Database, for example sqlite:///var/lib/tamp/tamp.sqlite [default: tamp.sqlite in the data directory].
    #[arg(long, value_name = "URL")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub database: Option<String>,
    /// Bearer token asked of workers and submitters. Better given as TAMP_TOKEN: a command line is public.
    #[arg(long)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub token: Option<String>,
    /// A lease not renewed for this long returns to the queue [s; default: 90].
    #[arg(long, value_name = "S")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lease_seconds: Option<f64>,
    /// Heartbeats asked of workers this often [s; default: 20].
    #[arg(long, value_name = "S")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub heartbeat_seconds: Option<f64>,
    /// Leases found at start hold at least this long [s; default: 120].
    #[arg(long, value_name = "S")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub grace_seconds: Option<f64>,
    /// Program failures after which a job is set aside [default: 3].
    #[arg(long, value_name = "N")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_failures: Option<u32>,
    /// Lost workers without progress after which a job is set aside [default: 8].
    #[arg(long, value_name = "N")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_losses: Option<u32>,
    /// Most points of one sweep [default: 1000000].
    #[arg(long, value_name = "N")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_points: Option<u64>,
    /// Log filter [default: info].
    #[arg(long)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub log: Option<String>,
    /// Logs as JSON lines.
    #[arg(long)]
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub log_json: bool,
}

/// The configuration cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum ConfigError {
    /// A file, a variable or a flag does not fit.
    #[error("configuration: {0}")]
    Read(#[from] Box<figment::Error>),
    /// A value is out of its range.
    #[error("configuration: {field} = {value}: {remedy}")]
    Value {
        /// Name of the option.
        field: &'static str,
        /// What was given.
        value: String,
        /// What to give.
        remedy: &'static str,
    },
}

/// Options that the environment may set; other `TAMP_…` variables belong to the worker.
const FROM_ENVIRONMENT: &[&str] = &[
    "bind",
    "data_dir",
    "database",
    "token",
    "lease_seconds",
    "heartbeat_seconds",
    "grace_seconds",
    "flush_seconds",
    "tick_seconds",
    "max_failures",
    "max_losses",
    "retry_seconds",
    "max_points",
    "max_body_bytes",
    "max_result_bytes",
    "max_checkpoint_bytes",
    "max_events",
    "readers",
    "log",
    "log_json",
];

impl Config {
    /// Defaults, then the TOML file, then the environment, then the command line.
    ///
    /// # Errors
    /// [`ConfigError`], naming the source of the value that does not fit.
    pub fn load(args: &Args) -> Result<Self, ConfigError> {
        let mut figment = Figment::from(Serialized::defaults(Self::default()));
        if let Some(path) = &args.config {
            figment = figment.merge(Toml::file_exact(path));
        }
        let config: Self = figment
            .merge(Env::prefixed("TAMP_").only(FROM_ENVIRONMENT))
            .merge(Serialized::defaults(args))
            .extract()
            .map_err(Box::new)?;
        config.checked()
    }

    fn checked(self) -> Result<Self, ConfigError> {
        let spans = [
            ("lease_seconds", self.lease_seconds),
            ("heartbeat_seconds", self.heartbeat_seconds),
            ("flush_seconds", self.flush_seconds),
            ("tick_seconds", self.tick_seconds),
        ];
        for (field, seconds) in spans {
            if !(seconds > 0.0 && seconds < 1e7) {
                let remedy = "give a positive number of seconds";
                return Err(ConfigError::Value { field, value: seconds.to_string(), remedy });
            }
        }
        for (field, seconds) in [("grace_seconds", self.grace_seconds), ("retry_seconds", self.retry_seconds)]
        {
            if !(0.0..1e7).contains(&seconds) {
                let remedy = "give a number of seconds, 0 or more";
                return Err(ConfigError::Value { field, value: seconds.to_string(), remedy });
            }
        }
        if self.lease_seconds < 2.0 * self.heartbeat_seconds {
            let remedy =
                "give at least twice heartbeat_seconds, so that one lost heartbeat does not lose the lease";
            return Err(ConfigError::Value {
                field: "lease_seconds",
                value: self.lease_seconds.to_string(),
                remedy,
            });
        }
        if self.readers == 0 {
            let remedy = "give at least one read connection";
            return Err(ConfigError::Value { field: "readers", value: "0".to_owned(), remedy });
        }
        if self.token.as_deref().is_some_and(|token| token.trim().len() < 8) {
            let remedy = "give a token of at least 8 characters, or none";
            return Err(ConfigError::Value { field: "token", value: "(hidden)".to_owned(), remedy });
        }
        Ok(self)
    }

    /// Time a lease holds.
    #[must_use]
    pub fn lease(&self) -> Duration {
        Duration::from_secs_f64(self.lease_seconds)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flags_go_over_the_file_and_the_file_over_defaults() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("server.toml");
        std::fs::write(&file, "max_failures = 7\nlog = \"debug\"\n").unwrap();
        let args = Args { config: Some(file), log: Some("warn".to_owned()), ..Args::default() };
        let config = Config::load(&args).unwrap();
        assert_eq!((config.max_failures, config.log.as_str(), config.max_losses), (7, "warn", 8));
    }

    #[test]
    fn an_unknown_option_is_an_error_that_names_it() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("server.toml");
        std::fs::write(&file, "max_failure = 7\n").unwrap();
        let error = Config::load(&Args { config: Some(file), ..Args::default() }).unwrap_err();
        assert!(error.to_string().contains("max_failure"), "{error}");
    }

    #[test]
    fn values_out_of_range_are_refused() {
        for broken in [
            Config { lease_seconds: f64::NAN, ..Config::default() },
            Config { lease_seconds: 30.0, ..Config::default() },
            Config { readers: 0, ..Config::default() },
            Config { token: Some("abc".to_owned()), ..Config::default() },
        ] {
            assert!(broken.checked().is_err());
        }
    }
}
