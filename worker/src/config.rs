//! Settings of a worker: flags over `TAMP_…` in the environment over a TOML file over defaults.

use std::path::PathBuf;
use std::time::{Duration, SystemTime};

use clap::Args;
use figment::Figment;
use figment::providers::{Env, Format as _, Serialized, Toml};
use serde::{Deserialize, Serialize};

use crate::error::WorkerError;
use crate::gate::Rules;
use crate::host;

/// Flags of `tamp work` and `tamp-worker`; each also as `TAMP_…` in the environment and as a key of the TOML file.
#[derive(Args, Clone, Debug, Default, Serialize)]
pub struct Flags {
    /// TOML file with settings
    #[arg(long, value_name = "FILE", env = "TAMP_WORKER_CONFIG")]
    #[serde(skip)]
    pub config: Option<PathBuf>,
    /// Address of the coordinator [default: http://127.0.0.1:8300]
    #[arg(long, value_name = "URL")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub server: Option<String>,
    /// Jobs run at the same time [default: number of cores]
    #[arg(long)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub slots: Option<u32>,
    /// Threads inside each job [default: 1]
    #[arg(long)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub threads: Option<u32>,
    /// Token of the coordinator (better in the environment as TAMP_TOKEN)
    #[arg(long)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub token: Option<String>,
    /// Directory for checkpoints and undelivered results [default: tamp-worker]
    #[arg(long, value_name = "DIR")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub data_dir: Option<PathBuf>,
    /// Time between checkpoints of a job [s, default: 60]
    #[arg(long, value_name = "SECONDS")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub checkpoint_seconds: Option<f64>,
    /// Work only while nobody else uses the machine
    #[arg(long, num_args = 0..=1, default_missing_value = "true", value_name = "BOOL")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub idle_only: Option<bool>,
    /// With --idle-only: load of others that counts as use [cores, default: 0.5]
    #[arg(long, value_name = "CORES")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub busy_above: Option<f64>,
    /// With --idle-only: others must be gone for this long [s, default: 60]
    #[arg(long, value_name = "SECONDS")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub quiet_seconds: Option<f64>,
    /// Lower the priority, 0 to 19 [default: 0]
    #[arg(long, value_name = "LEVEL")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub nice: Option<i32>,
    /// Checkpoint, give the jobs back and exit before this time (RFC 3339, e.g. 2026-11-23T08:00:00Z)
    #[arg(long, value_name = "TIME")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub available_until: Option<String>,
    /// Exit when there was nothing to do for this long [s, default: never]
    #[arg(long, value_name = "SECONDS")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub idle_timeout_seconds: Option<f64>,
    /// Time for the last uploads after a stop signal [s, default: 20]
    #[arg(long, value_name = "SECONDS")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub drain_seconds: Option<f64>,
}

/// Settings, all filled in. Unknown keys of the file are errors.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Config {
    /// Address of the coordinator.
    pub server: String,
    /// Jobs run at the same time.
    pub slots: u32,
    /// Threads inside each job.
    pub threads: u32,
    /// Token of the coordinator.
    pub token: Option<String>,
    /// Directory for checkpoints and undelivered results.
    pub data_dir: PathBuf,
    /// Time between checkpoints of a job [s].
    pub checkpoint_seconds: f64,
    /// Work only while nobody else uses the machine.
    pub idle_only: bool,
    /// Load of others that counts as use [cores].
    pub busy_above: f64,
    /// Others must be gone for this long [s].
    pub quiet_seconds: f64,
    /// Niceness added, 0 to 19.
    pub nice: i32,
    /// End before this time (RFC 3339).
    pub available_until: Option<String>,
    /// Exit when there was nothing to do for this long [s].
    pub idle_timeout_seconds: Option<f64>,
    /// Time for the last uploads after a stop signal [s].
    pub drain_seconds: f64,
}

impl Default for Config {
    fn default() -> Self {
        Self {
            server: "http://127.0.0.1:8300".to_owned(),
            slots: host::cores(),
            threads: 1,
            token: None,
            data_dir: PathBuf::from("tamp-worker"),
            checkpoint_seconds: 60.0,
            idle_only: false,
            busy_above: 0.5,
            quiet_seconds: 60.0,
            nice: 0,
            available_until: None,
            idle_timeout_seconds: None,
            drain_seconds: 20.0,
        }
    }
}

/// Keys that are also read from the environment. Listed, because the coordinator uses the same prefix.
const KEYS: [&str; 13] = [
    "server",
    "slots",
    "threads",
    "token",
    "data_dir",
    "checkpoint_seconds",
    "idle_only",
    "busy_above",
    "quiet_seconds",
    "nice",
    "available_until",
    "idle_timeout_seconds",
    "drain_seconds",
];

impl Config {
    /// Merges flags, environment, file and defaults, and checks the result.
    ///
    /// # Errors
    /// [`WorkerError`] naming the setting and, for the file, where it stands.
    pub fn load(flags: &Flags) -> Result<Self, WorkerError> {
        let mut figment = Figment::from(Serialized::defaults(Self::default()));
        if let Some(file) = &flags.config {
            figment = figment.merge(Toml::file_exact(file));
        }
        figment = figment.merge(Env::prefixed("TAMP_").only(&KEYS)).merge(Serialized::defaults(flags));
        let config: Self = figment.extract().map_err(Box::new)?;
        config.check()?;
        Ok(config)
    }

    /// Checks every setting that a type cannot.
    ///
    /// # Errors
    /// [`WorkerError::Config`] for the first one that is out of range.
    pub fn check(&self) -> Result<(), WorkerError> {
        let bad = |field: &str, value: &dyn std::fmt::Display, problem: &str, remedy: &str| {
            Err(WorkerError::Config {
                field: field.to_owned(),
                value: value.to_string(),
                problem: problem.to_owned(),
                remedy: remedy.to_owned(),
            })
        };
        for (field, count) in [("slots", self.slots), ("threads", self.threads)] {
            if !(1..=4096).contains(&count) {
                return bad(field, &count, "out of range", "give 1 to 4096");
            }
        }
        let times = [
            ("checkpoint_seconds", Some(self.checkpoint_seconds)),
            ("quiet_seconds", Some(self.quiet_seconds)),
            ("idle_timeout_seconds", self.idle_timeout_seconds),
            ("drain_seconds", Some(self.drain_seconds)),
            ("busy_above", Some(self.busy_above)),
        ];
        for (field, value) in times {
            if let Some(value) = value
                && !(0.0..=1e7).contains(&value)
            {
                return bad(field, &value, "out of range", "give 0 to 1e7");
            }
        }
        if !(0..=19).contains(&self.nice) {
            return bad("nice", &self.nice, "out of range", "give 0 to 19");
        }
        self.until()?;
        Ok(())
    }

    /// The time before which the worker ends.
    ///
    /// # Errors
    /// [`WorkerError::Config`] when it cannot be read.
    pub fn until(&self) -> Result<Option<SystemTime>, WorkerError> {
        let Some(text) = &self.available_until else { return Ok(None) };
        match text.parse::<jiff::Timestamp>() {
            Ok(time) => Ok(Some(time.into())),
            Err(error) => Err(WorkerError::Config {
                field: "available_until".to_owned(),
                value: text.clone(),
                problem: error.to_string(),
                remedy: "give an RFC 3339 time, for example 2026-11-23T08:00:00Z".to_owned(),
            }),
        }
    }

    /// When the machine may be used.
    ///
    /// # Errors
    /// [`WorkerError::Config`] when a time cannot be read.
    pub fn rules(&self) -> Result<Rules, WorkerError> {
        Ok(Rules {
            idle_only: self.idle_only,
            busy_above: self.busy_above,
            idle_below: 0.5 * self.busy_above,
            quiet_for: Duration::from_secs_f64(self.quiet_seconds),
            yield_after: Duration::from_secs(300),
            until: self.until()?,
            margin: Duration::from_secs_f64(self.drain_seconds) + Duration::from_secs(10),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flags_beat_the_file_and_the_file_beats_the_defaults() {
        let directory = tempfile::tempdir().unwrap();
        let file = directory.path().join("worker.toml");
        std::fs::write(&file, "slots = 3\nserver = \"http://a:1\"\n").unwrap();
        let flags = Flags { config: Some(file), server: Some("http://b:2".to_owned()), ..Flags::default() };
        let config = Config::load(&flags).unwrap();
        assert_eq!((config.slots, config.server.as_str(), config.threads), (3, "http://b:2", 1));
    }

    #[test]
    fn unknown_keys_and_impossible_values_are_errors() {
        let directory = tempfile::tempdir().unwrap();
        let file = directory.path().join("worker.toml");
        std::fs::write(&file, "slot = 3\n").unwrap();
        let flags = Flags { config: Some(file), ..Flags::default() };
        let error = Config::load(&flags).unwrap_err().to_string();
        assert!(error.contains("slot"), "{error}");
        for flags in [
            Flags { slots: Some(0), ..Flags::default() },
            Flags { checkpoint_seconds: Some(f64::NAN), ..Flags::default() },
            Flags { available_until: Some("tomorrow".to_owned()), ..Flags::default() },
        ] {
            assert!(Config::load(&flags).is_err(), "{flags:?}");
        }
    }
}
