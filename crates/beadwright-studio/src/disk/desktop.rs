//! Files of the disk.

use beadwright::dialect::Chunk;
use beadwright::files::{self, Folder, Post, write_file};
use std::path::Path;

/// Distinguishes one content of a file from a later one.
pub type Stamp = std::time::SystemTime;

/// The bytes of a file.
///
/// # Errors
/// A sentence that names the file.
pub fn read(path: &Path) -> Result<Vec<u8>, String> {
    if path.is_dir() {
        return Err(format!("{}: this is a folder, not a model file.", path.display()));
    }
    std::fs::read(path).map_err(|error| format!("{}: {error}.", path.display()))
}

/// When a file was last changed, where that is known.
pub fn stamp(path: &Path) -> Option<Stamp> {
    path.metadata().and_then(|about| about.modified()).ok()
}

/// Writes a file, completely or not at all.
///
/// # Errors
/// A sentence that names the file.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), String> {
    write_file(path, bytes).map_err(|error| format!("{error}."))
}

/// Writes files into a folder, all or none, and returns their names.
///
/// # Errors
/// A sentence that names the file that cannot be written.
pub fn write_folder(folder: &Path, _: &str, chunks: Vec<Chunk>) -> Result<Vec<String>, String> {
    let written = Folder::new(folder).and_then(|mut folder| {
        folder.extend(chunks)?;
        Ok(folder.commit()?.files)
    });
    written.map_err(|error| format!("{error}."))
}

/// The dialects of these names, among them folders of templates.
///
/// # Errors
/// A sentence: a folder that holds no dialect.
pub fn posts(names: &[String]) -> Result<Vec<Post>, String> {
    files::posts(names, Path::new("")).map_err(|error| error.to_string())
}
