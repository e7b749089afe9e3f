//! A chain of hashes over rows: each covers its row and the hash before it, so that a changed, removed, added or moved row shows.

use serde::Serialize;
use sha2::{Digest, Sha256};

/// SHA-256 of bytes, as 64 hexadecimal digits.
///
/// ```
/// // FIPS 180-2, appendix B.1.
/// let hash = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
/// assert_eq!(bead_record::sha256(b"abc"), hash);
/// ```
pub fn sha256(bytes: &[u8]) -> String {
    hex(&Sha256::digest(bytes))
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// The hash of the chain after another row: SHA-256 of the hash before, a line end, and the row.
pub fn link(before: &str, row: &str) -> String {
    sha256(format!("{before}\n{row}").as_bytes())
}

/// The hashes of a chain that begins with `first`, one for each row.
///
/// ```
/// use bead_record::chain;
///
/// let before = chain("part", &["a", "b", "c"]);
/// let after = chain("part", &["a", "B", "c"]);
/// assert!(before[0] == after[0] && before[1] != after[1] && before[2] != after[2]);
/// ```
pub fn chain<S: AsRef<str>>(first: &str, rows: &[S]) -> Vec<String> {
    let mut last = sha256(first.as_bytes());
    let next = |row: &S| {
        last = link(&last, row.as_ref());
        last.clone()
    };
    rows.iter().map(next).collect()
}

/// A file and its hash.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, serde::Deserialize)]
pub struct FileHash {
    /// Its name.
    pub name: String,
    /// Its size.
    pub bytes: u64,
    /// SHA-256 of its content.
    pub sha256: String,
}

impl FileHash {
    /// Of these bytes.
    pub fn of(name: &str, bytes: &[u8]) -> Self {
        Self { name: name.to_owned(), bytes: bytes.len() as u64, sha256: sha256(bytes) }
    }

    /// Of a file that comes in pieces.
    ///
    /// # Errors
    /// Those of the reader.
    pub fn read(name: &str, mut file: impl std::io::Read) -> std::io::Result<Self> {
        let (mut hash, mut bytes, mut piece) = (Sha256::new(), 0, vec![0; 1 << 16]);
        loop {
            let count = file.read(&mut piece)?;
            if count == 0 {
                return Ok(Self { name: name.to_owned(), bytes, sha256: hex(&hash.finalize()) });
            }
            hash.update(&piece[..count]);
            bytes += count as u64;
        }
    }
}
