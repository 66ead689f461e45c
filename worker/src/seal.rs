//! The container of everything the worker stores or uploads: a header that tells what it is, a digest, and a
//! compressed payload.
//!
//! | bytes | content |
//! |---|---|
//! | 8 | magic, names the kind of content and the version of the format |
//! | 32 | BLAKE3 of everything behind it |
//! | 4 | length of the label, little endian |
//! | 8 | length of the payload when unpacked, little endian |
//! | … | label, JSON |
//! | … | payload, zstd |

use serde::Serialize;
use serde::de::DeserializeOwned;

/// Largest payload that is unpacked [bytes]: a damaged length must not ask for all memory.
const LARGEST: u64 = 16 << 30;
const MAGIC: usize = 8;
const DIGEST: usize = 32;
const FIXED: usize = MAGIC + DIGEST + 4 + 8;
/// Fast and already a third of the size; the state of a packing gains little from more.
const LEVEL: i32 = 1;

/// The bytes are not what they should be.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("damaged or foreign: {0}")]
pub struct Damaged(pub &'static str);

/// Packs `payload` with its label.
///
/// # Errors
/// When the compressor fails, which happens only for lack of memory.
pub fn seal<L: Serialize>(magic: [u8; MAGIC], label: &L, payload: &[u8]) -> std::io::Result<Vec<u8>> {
    let label = serde_json::to_vec(label)?;
    let packed = zstd::bulk::compress(payload, LEVEL)?;
    let label_length = u32::try_from(label.len()).expect("a label is a few words");
    let mut bytes = Vec::with_capacity(FIXED + label.len() + packed.len());
    bytes.extend_from_slice(&magic);
    bytes.extend_from_slice(&[0; DIGEST]);
    bytes.extend_from_slice(&label_length.to_le_bytes());
    bytes.extend_from_slice(&(payload.len() as u64).to_le_bytes());
    bytes.extend_from_slice(&label);
    bytes.extend_from_slice(&packed);
    let digest = blake3::hash(&bytes[MAGIC + DIGEST..]);
    bytes[MAGIC..MAGIC + DIGEST].copy_from_slice(digest.as_bytes());
    Ok(bytes)
}

/// Checks and unpacks what [`seal`] made.
///
/// # Errors
/// [`Damaged`] when a single bit differs, or the magic is another.
pub fn open<L: DeserializeOwned>(magic: [u8; MAGIC], bytes: &[u8]) -> Result<(L, Vec<u8>), Damaged> {
    if bytes.len() < FIXED {
        return Err(Damaged("shorter than its header"));
    }
    if bytes[..MAGIC] != magic {
        return Err(Damaged("another kind of file or another version"));
    }
    let sealed = &bytes[MAGIC + DIGEST..];
    if blake3::hash(sealed).as_bytes() != &bytes[MAGIC..MAGIC + DIGEST] {
        return Err(Damaged("the digest does not match"));
    }
    let (lengths, rest) = sealed.split_at(12);
    let label_length = u32::from_le_bytes(lengths[..4].try_into().expect("four bytes")) as usize;
    let unpacked_length = u64::from_le_bytes(lengths[4..].try_into().expect("eight bytes"));
    if label_length > rest.len() || unpacked_length > LARGEST {
        return Err(Damaged("impossible lengths"));
    }
    let (label, packed) = rest.split_at(label_length);
    let label = serde_json::from_slice(label).map_err(|_| Damaged("the label makes no sense"))?;
    let capacity = usize::try_from(unpacked_length).map_err(|_| Damaged("too large for this machine"))?;
    let payload = zstd::bulk::decompress(packed, capacity).map_err(|_| Damaged("cannot be unpacked"))?;
    if payload.len() != capacity {
        return Err(Damaged("shorter than promised"));
    }
    Ok((label, payload))
}

#[cfg(test)]
mod tests {
    use super::*;

    const HERE: [u8; 8] = *b"TESTTT01";

    #[test]
    fn every_damaged_bit_and_every_cut_is_noticed() {
        let payload: Vec<u8> = (0..200u8).collect();
        let bytes = seal(HERE, &"label", &payload).unwrap();
        assert_eq!(open::<String>(HERE, &bytes).unwrap(), ("label".to_owned(), payload));
        for at in 0..bytes.len() {
            let mut bad = bytes.clone();
            bad[at] ^= 0x10;
            assert!(open::<String>(HERE, &bad).is_err(), "byte {at}");
            assert!(open::<String>(HERE, &bytes[..at]).is_err(), "cut at {at}");
        }
    }

    #[test]
    fn another_kind_is_refused() {
        let bytes = seal(HERE, &1, b"x").unwrap();
        assert!(open::<u32>(*b"OTHER_01", &bytes).is_err());
    }
}
