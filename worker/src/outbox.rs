//! Reports that the coordinator has not taken yet, on disk: a finished run is never computed twice because the
//! coordinator was away.

use std::path::{Path, PathBuf};
use std::{fs, io};

use protocol::{Completion, Failure, JobId};
use serde::{Deserialize, Serialize};

use crate::files::write_durably;
use crate::seal;

/// Format 01 of a report file.
const MAGIC: [u8; 8] = *b"TAMPRP01";

/// The last word on an attempt.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Message {
    /// The run is finished.
    Result(Box<Completion>),
    /// The run failed.
    Failure(Failure),
}

/// A report on its way.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// The job.
    pub job: JobId,
    /// Its scene: the local checkpoint of it is forgotten on delivery.
    pub scene_key: scene::SceneKey,
    /// What to tell.
    pub message: Message,
}

impl Report {
    /// The attempt it speaks of.
    #[must_use]
    pub fn attempt(&self) -> u32 {
        match &self.message {
            Message::Result(completion) => completion.attempt,
            Message::Failure(failure) => failure.attempt,
        }
    }

    /// Whether both are the last word on the same attempt.
    #[must_use]
    pub fn is_same(&self, other: &Self) -> bool {
        (self.job, self.attempt()) == (other.job, other.attempt())
    }
}

/// The directory of reports.
#[derive(Clone, Debug)]
pub struct Outbox {
    directory: PathBuf,
    refused: PathBuf,
}

impl Outbox {
    /// The outbox in `directory`, made if needed.
    ///
    /// # Errors
    /// The error of the file system.
    pub fn open(directory: &Path) -> io::Result<Self> {
        let refused = directory.join("refused");
        fs::create_dir_all(&refused)?;
        Ok(Self { directory: directory.to_owned(), refused })
    }

    /// Stores a report durably.
    ///
    /// # Errors
    /// The error of the file system.
    pub fn put(&self, report: &Report) -> io::Result<()> {
        let payload = serde_json::to_vec(report)?;
        write_durably(&self.path(report), &seal::seal(MAGIC, &report.job, &payload)?)
    }

    /// Forgets a report.
    pub fn remove(&self, report: &Report) {
        // another worker process on this machine may have delivered it first
        let _ = fs::remove_file(self.path(report));
    }

    /// Keeps a report that the coordinator refused as evidence, out of the way.
    pub fn set_aside(&self, report: &Report) {
        let from = self.path(report);
        let to = self.refused.join(from.file_name().unwrap_or_default());
        if let Err(error) = fs::rename(&from, &to) {
            tracing::warn!(job = %report.job, %error, "cannot set a refused report aside");
        }
    }

    /// Every readable report left by this or an earlier process, in a fixed order; damaged files are set aside.
    #[must_use]
    pub fn all(&self) -> Vec<Report> {
        let Ok(entries) = fs::read_dir(&self.directory) else { return Vec::new() };
        let mut paths: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
        paths.retain(|path| path.extension().is_some_and(|end| end == "report"));
        paths.sort();
        paths.iter().filter_map(|path| self.read(path)).collect()
    }

    fn read(&self, path: &Path) -> Option<Report> {
        let bytes = fs::read(path).ok()?;
        let opened = seal::open::<JobId>(MAGIC, &bytes).map_err(|damaged| damaged.to_string());
        let report = opened
            .and_then(|(_, payload)| serde_json::from_slice(&payload).map_err(|error| error.to_string()));
        match report {
            Ok(report) => Some(report),
            Err(why) => {
                tracing::error!(path = %path.display(), why, "a report cannot be read and is set aside");
                // best effort: it stays where it is and is told again next time
                let _ = fs::rename(path, self.refused.join(path.file_name().unwrap_or_default()));
                None
            }
        }
    }

    fn path(&self, report: &Report) -> PathBuf {
        self.directory.join(format!("{}-{}.report", report.job, report.attempt()))
    }
}

#[cfg(test)]
mod tests {
    use protocol::{FailureKind, WorkerId};
    use uuid::Uuid;

    use super::*;

    fn report(attempt: u32) -> Report {
        Report {
            job: JobId(Uuid::from_u128(1)),
            scene_key: scene::SceneKey::of(b"a"),
            message: Message::Failure(Failure {
                worker: WorkerId(Uuid::from_u128(2)),
                attempt,
                kind: FailureKind::Retryable,
                class: "panic".to_owned(),
                message: "x".to_owned(),
            }),
        }
    }

    #[test]
    fn a_new_process_finds_what_the_old_one_left() {
        let directory = tempfile::tempdir().unwrap();
        let outbox = Outbox::open(directory.path()).unwrap();
        outbox.put(&report(2)).unwrap();
        outbox.put(&report(1)).unwrap();
        let next = Outbox::open(directory.path()).unwrap();
        assert_eq!(next.all(), [report(1), report(2)]);
        next.remove(&report(1));
        next.set_aside(&report(2));
        assert!(next.all().is_empty());
        assert_eq!(fs::read_dir(directory.path().join("refused")).unwrap().count(), 1);
    }

    #[test]
    fn a_damaged_report_does_not_stop_the_others() {
        let directory = tempfile::tempdir().unwrap();
        let outbox = Outbox::open(directory.path()).unwrap();
        outbox.put(&report(1)).unwrap();
        fs::write(directory.path().join("0.report"), b"torn").unwrap();
        assert_eq!(outbox.all(), [report(1)]);
        assert!(!directory.path().join("0.report").exists());
    }
}
