//! Files by their paths: on the disk, or in a browser, those that the user has handed to the page, and downloads.

#[cfg(target_arch = "wasm32")]
#[path = "disk/browser.rs"]
mod place;
#[cfg(not(target_arch = "wasm32"))]
#[path = "disk/desktop.rs"]
mod place;

#[cfg(target_arch = "wasm32")]
pub use place::hand_over;
pub use place::{Stamp, posts, read, stamp, write, write_folder};

use std::path::Path;

/// The text of a file.
///
/// # Errors
/// A sentence that names the file.
pub fn text(path: &Path) -> Result<String, String> {
    let bytes = read(path)?;
    String::from_utf8(bytes).map_err(|error| format!("{}: {error}.", path.display()))
}
