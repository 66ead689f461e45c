//! A checkpoint: the saved state of a simulation with what it belongs to, and where it lies on this machine.

use std::path::{Path, PathBuf};
use std::time::Duration;
use std::{fs, io};

use bytes::Bytes;
use scene::SceneKey;
use serde::{Deserialize, Serialize};

use crate::files::write_durably;
use crate::seal::{self, Damaged};

/// Format 01 of a checkpoint file.
const MAGIC: [u8; 8] = *b"TAMPCK01";

/// What a checkpoint belongs to.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Label {
    /// The scene and its physics version.
    pub scene_key: SceneKey,
    /// Steps done.
    pub steps: u64,
    /// Wall time spent so far, over all attempts [s].
    pub wall_s: f64,
}

/// A checkpoint ready to be stored or uploaded.
#[derive(Clone, Debug)]
pub struct Sealed {
    /// What it belongs to.
    pub label: Label,
    /// The container.
    pub bytes: Bytes,
}

impl Sealed {
    /// Packs the state of a simulation.
    ///
    /// # Errors
    /// When the compressor fails for lack of memory.
    pub fn new(label: Label, state: &[u8]) -> io::Result<Self> {
        let bytes = Bytes::from(seal::seal(MAGIC, &label, state)?);
        Ok(Self { label, bytes })
    }
}

/// Checks and unpacks a checkpoint of the scene `key`.
///
/// # Errors
/// [`Damaged`] when it is not whole or belongs to another scene or physics version.
pub fn open(bytes: &[u8], key: &SceneKey) -> Result<(Label, Vec<u8>), Damaged> {
    let (label, state): (Label, Vec<u8>) = seal::open(MAGIC, bytes)?;
    if label.scene_key != *key {
        return Err(Damaged("belongs to another scene or physics version"));
    }
    Ok((label, state))
}

/// The checkpoints on this machine, one per scene: whichever worker process made it, any may go on from it.
#[derive(Clone, Debug)]
pub struct Shelf {
    directory: PathBuf,
}

impl Shelf {
    /// The shelf in `directory`, made if needed.
    ///
    /// # Errors
    /// The error of the file system.
    pub fn open(directory: &Path) -> io::Result<Self> {
        fs::create_dir_all(directory)?;
        Ok(Self { directory: directory.to_owned() })
    }

    /// Where the checkpoint of a scene lies.
    #[must_use]
    pub fn path(&self, key: &SceneKey) -> PathBuf {
        self.directory.join(format!("{key}.ckpt"))
    }

    /// Stores a checkpoint in place of an older one.
    ///
    /// # Errors
    /// The error of the file system.
    pub fn put(&self, sealed: &Sealed) -> io::Result<()> {
        write_durably(&self.path(&sealed.label.scene_key), &sealed.bytes)
    }

    /// The checkpoint of a scene; `None` when there is none that can be read.
    #[must_use]
    pub fn get(&self, key: &SceneKey) -> Option<Bytes> {
        fs::read(self.path(key)).ok().map(Bytes::from)
    }

    /// Forgets the checkpoint of a scene.
    pub fn forget(&self, key: &SceneKey) {
        // nothing there is what we want
        let _ = fs::remove_file(self.path(key));
    }

    /// Removes what nobody has touched for longer than `age`.
    pub fn tidy(&self, age: Duration) {
        let Ok(entries) = fs::read_dir(&self.directory) else { return };
        for entry in entries.flatten() {
            let untouched = entry.metadata().and_then(|data| data.modified()).ok();
            if untouched.and_then(|time| time.elapsed().ok()).is_some_and(|since| since > age) {
                // best effort: another worker may have been first
                let _ = fs::remove_file(entry.path());
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn key(word: &[u8]) -> SceneKey {
        SceneKey::of(word)
    }

    fn sealed(of: &SceneKey) -> Sealed {
        Sealed::new(Label { scene_key: of.clone(), steps: 7, wall_s: 0.5 }, b"state").unwrap()
    }

    #[test]
    fn a_checkpoint_belongs_to_its_scene_only() {
        let bytes = sealed(&key(b"a")).bytes;
        let (label, state) = open(&bytes, &key(b"a")).unwrap();
        assert_eq!((label.steps, state.as_slice()), (7, b"state".as_slice()));
        assert!(open(&bytes, &key(b"b")).is_err());
    }

    #[test]
    fn the_shelf_keeps_one_per_scene() {
        let directory = tempfile::tempdir().unwrap();
        let shelf = Shelf::open(directory.path()).unwrap();
        shelf.put(&sealed(&key(b"a"))).unwrap();
        shelf.put(&sealed(&key(b"a"))).unwrap();
        assert!(shelf.get(&key(b"a")).is_some());
        assert!(shelf.get(&key(b"b")).is_none());
        shelf.tidy(Duration::from_secs(3600));
        assert!(shelf.get(&key(b"a")).is_some(), "young enough to stay");
        shelf.tidy(Duration::ZERO);
        assert!(shelf.get(&key(b"a")).is_none());
    }
}
