//! Text files as they occur in practice: with a byte order mark, in UTF-16, with the line ends of any system.

pub mod table;
pub mod toml;

use std::borrow::Cow;

/// Why bytes are not text.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum TextError {
    /// An encoding that is not read.
    #[error("this text is in {0}, which is not read. Save it as UTF-8.")]
    Encoding(&'static str),
}

/// The text of a file, without byte order mark and with `\n` at the end of each line. UTF-16 is recognised by its
/// byte order mark; bytes that are not text become `\u{fffd}`.
///
/// ```
/// use bead_part::text;
///
/// // A byte order mark, a line that ends as on Windows, and one that ends as on an old Mac.
/// assert_eq!(text::of(b"\xef\xbb\xbfone\r\ntwo\r")?, "one\ntwo\n");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`TextError`] for UTF-32, and for UTF-16 without a byte order mark.
pub fn of(bytes: &[u8]) -> Result<String, TextError> {
    let text = match bytes {
        [0xff, 0xfe, 0, 0, ..] | [0, 0, 0xfe, 0xff, ..] => return Err(TextError::Encoding("UTF-32")),
        [0xff, 0xfe, rest @ ..] => utf16(rest, u16::from_le_bytes),
        [0xfe, 0xff, rest @ ..] => utf16(rest, u16::from_be_bytes),
        [0xef, 0xbb, 0xbf, rest @ ..] => String::from_utf8_lossy(rest),
        _ if is_wide(bytes) => return Err(TextError::Encoding("UTF-16 without a byte order mark")),
        _ => String::from_utf8_lossy(bytes),
    };
    // Old Macs end lines with \r alone; \r\n counts as one line end.
    if text.contains('\r') { Ok(text.replace("\r\n", "\n").replace('\r', "\n")) } else { Ok(text.into_owned()) }
}

/// Whether a file must pass through [`of`] before a reader of bytes understands it.
pub(crate) fn needs_decoding(bytes: &[u8]) -> bool {
    let head = &bytes[..bytes.len().min(4096)];
    let marked = matches!(bytes, [0xff, 0xfe, ..] | [0xfe, 0xff, ..] | [0xef, 0xbb, 0xbf, ..]);
    marked || is_wide(head) || (head.contains(&b'\r') && !head.contains(&b'\n') && !head.contains(&0))
}

fn utf16(bytes: &[u8], unit: fn([u8; 2]) -> u16) -> Cow<'_, str> {
    let units: Vec<u16> = bytes.as_chunks::<2>().0.iter().map(|pair| unit(*pair)).collect();
    String::from_utf16_lossy(&units).into()
}

/// Whether every second byte of the beginning is 0, as in English text in UTF-16.
fn is_wide(bytes: &[u8]) -> bool {
    const LOOK: usize = 32;
    let pairs = &bytes.as_chunks::<2>().0[..bytes.len().min(LOOK) / 2];
    let text = |byte: u8| byte.is_ascii_graphic() || byte.is_ascii_whitespace();
    pairs.len() >= 4 && (pairs.iter().all(|p| p[1] == 0 && text(p[0])) || pairs.iter().all(|p| p[0] == 0 && text(p[1])))
}
