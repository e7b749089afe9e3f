//! Files that are read: whole, and only if they are files.

use crate::memory;
use anyhow::Context;
use std::fs;
use std::path::Path;

/// The bytes of a file. It is read rather than mapped into memory, so that another program which cuts it short meanwhile
/// does no harm.
pub(crate) fn read(path: &Path) -> anyhow::Result<Vec<u8>> {
    let context = || format!("{}", path.display());
    let about = fs::metadata(path).with_context(context)?;
    anyhow::ensure!(!about.is_dir(), "{}: this is a folder, not a file", path.display());
    // Opening a pipe waits for its writer; devices have no end.
    anyhow::ensure!(
        about.is_file(),
        "{}: this is a device or a pipe. Save its content as a file and give that.",
        path.display()
    );
    anyhow::ensure!(
        about.len() <= memory::limit(),
        "{}: the file has {:.1} GB, more than may be used (--max-memory).",
        path.display(),
        about.len() as f64 / 1e9
    );
    fs::read(path).with_context(context)
}

/// The text of a file.
pub(crate) fn text(path: &Path) -> anyhow::Result<String> {
    beadwright::text::of(&read(path)?).with_context(|| format!("{}", path.display()))
}
