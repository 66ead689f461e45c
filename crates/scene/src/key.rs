//! The identity of a run.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

/// 32 lower-case hex digits: the first 16 bytes of the BLAKE3 hash of the canonical reduced scene (RFC 8785) and
/// the physics version. Threads, host and chunking are never in it.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct SceneKey(String);

/// The text is not a scene key.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0:?} is not a scene key: 32 lower-case hex digits expected")]
pub struct NotASceneKey(pub String);

impl SceneKey {
    /// The key of canonical bytes.
    #[must_use]
    pub fn of(canonical: &[u8]) -> Self {
        Self(blake3::hash(canonical).to_hex()[..32].to_owned())
    }

    /// The hex digits.
    #[must_use]
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

impl fmt::Display for SceneKey {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(&self.0)
    }
}

impl FromStr for SceneKey {
    type Err = NotASceneKey;
    fn from_str(text: &str) -> Result<Self, NotASceneKey> {
        let is_key = text.len() == 32 && text.bytes().all(|byte| matches!(byte, b'0'..=b'9' | b'a'..=b'f'));
        if is_key { Ok(Self(text.to_owned())) } else { Err(NotASceneKey(text.to_owned())) }
    }
}

impl TryFrom<String> for SceneKey {
    type Error = NotASceneKey;
    fn try_from(text: String) -> Result<Self, NotASceneKey> {
        text.parse()
    }
}

impl From<SceneKey> for String {
    fn from(key: SceneKey) -> Self {
        key.0
    }
}
