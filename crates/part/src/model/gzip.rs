//! Models compressed with gzip, such as `part.stl.gz`.

use super::ImportError;
use super::package::{most_of, unfolds};
use flate2::read::MultiGzDecoder;
use std::io::Read;

/// Whether the bytes are gzip data.
pub(super) fn is_packed(bytes: &[u8]) -> bool {
    bytes.starts_with(b"\x1f\x8b")
}

/// The decompressed bytes, up to the limit for a model of this size.
///
/// # Errors
/// [`ImportError::Broken`] for a damaged file, and for one that decompresses to more than the limit.
pub(super) fn unpacked(bytes: &[u8]) -> Result<Vec<u8>, ImportError> {
    let broken = |reason: String| ImportError::Broken { format: "gzip", reason };
    let (most, mut unpacked) = (most_of(bytes.len()), Vec::new());
    let read = MultiGzDecoder::new(bytes).take(most + 1).read_to_end(&mut unpacked);
    read.map_err(|error| broken(format!("it is damaged ({error}). Copy it again")))?;
    if unpacked.len() as u64 > most { Err(broken(unfolds(most))) } else { Ok(unpacked) }
}
