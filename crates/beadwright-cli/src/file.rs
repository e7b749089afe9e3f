//! Files that are read: whole, and only if they are files; `-` stands for standard input and output.

use crate::memory;
use anyhow::Context;
use beadwright::example;
use beadwright::files::write_file;
use std::fs;
use std::io::{Read, Write};
use std::path::Path;
use std::sync::OnceLock;

/// What came from standard input, kept in case it is asked for again.
static STANDARD_INPUT: OnceLock<Vec<u8>> = OnceLock::new();

/// Whether a name stands for standard input or output.
pub(crate) fn is_standard(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// The bytes of a file. It is read rather than mapped into memory, so that another program which cuts it short meanwhile
/// does no harm.
pub(crate) fn read(path: &Path) -> anyhow::Result<Vec<u8>> {
    if is_standard(path) {
        return standard_input().context("standard input");
    }
    let context = || format!("{}", path.display());
    let about = fs::metadata(path).with_context(context)?;
    anyhow::ensure!(!about.is_dir(), "{}: this is a folder, not a file", path.display());
    // Opening a pipe waits for its writer; devices have no end.
    anyhow::ensure!(
        about.is_file(),
        "{}: this is a device or a pipe. Save its content as a file and give that, or send it to standard input and give -.",
        path.display()
    );
    anyhow::ensure!(
        about.len() <= memory::limit(),
        "{}: the file is {:.1} GB, more memory than may be used (--max-memory).",
        path.display(),
        about.len() as f64 / 1e9
    );
    fs::read(path).with_context(context)
}

/// The bytes of a model: of a file, or of the example part of that name where there is no such file.
pub(crate) fn model(path: &Path) -> anyhow::Result<Vec<u8>> {
    let example = path.to_str().and_then(example::find).filter(|_| !path.exists());
    example.map_or_else(|| read(path), |example| Ok(example.stl()))
}

/// All of standard input.
fn standard_input() -> anyhow::Result<Vec<u8>> {
    // A second caller waits here for what the first one keeps.
    let mut input = std::io::stdin().lock();
    if let Some(bytes) = STANDARD_INPUT.get() {
        return Ok(bytes.clone());
    }
    let (limit, mut bytes) = (memory::limit(), Vec::new());
    input.by_ref().take(limit.saturating_add(1)).read_to_end(&mut bytes)?;
    anyhow::ensure!(bytes.len() as u64 <= limit, "it is more than the memory that may be used (--max-memory)");
    Ok(STANDARD_INPUT.get_or_init(|| bytes).clone())
}

/// The text of a file.
pub(crate) fn text(path: &Path) -> anyhow::Result<String> {
    beadwright::text::of(&read(path)?).with_context(|| format!("{}", path.display()))
}

/// Writes a file, or standard output.
pub(crate) fn write(path: &Path, bytes: &[u8]) -> anyhow::Result<()> {
    if !is_standard(path) {
        return Ok(write_file(path, bytes)?);
    }
    let mut out = std::io::stdout().lock();
    out.write_all(bytes)?;
    Ok(out.flush()?)
}

/// The name of a file without its ending; `-` has none.
pub(crate) fn stem(path: &Path) -> Option<String> {
    let stem = path.file_stem().filter(|_| !is_standard(path))?;
    // `part.stl.gz` is a part.stl, packed.
    let packed = path.extension().is_some_and(|end| end.eq_ignore_ascii_case("gz"));
    let stem = if packed { Path::new(stem).file_stem().unwrap_or(stem) } else { stem };
    Some(stem.to_string_lossy().into_owned())
}
