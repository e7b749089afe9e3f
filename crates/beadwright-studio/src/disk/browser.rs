//! Files of a page: what the user has chosen or dropped is kept under its name; what is written is downloaded.

use beadwright::dialect::Chunk;
use beadwright::dialect::own;
use beadwright::files::Post;
use js_sys::{Array, Uint8Array};
use std::collections::BTreeMap;
use std::io::{Cursor, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use wasm_bindgen::{JsCast, JsValue};
use web_sys::{Blob, HtmlAnchorElement, Url};
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

/// Counts the files handed over.
pub type Stamp = usize;

type Files = (Stamp, BTreeMap<PathBuf, (Stamp, Result<Vec<u8>, String>)>);

static FILES: Mutex<Files> = Mutex::new((0, BTreeMap::new()));

fn files() -> MutexGuard<'static, Files> {
    FILES.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Keeps a file that the user has handed over, or why it cannot be read.
pub fn hand_over(path: &Path, content: Result<Vec<u8>, String>) {
    let (count, files) = &mut *files();
    *count += 1;
    files.insert(path.to_owned(), (*count, content));
}

/// The bytes of a file that was handed over.
///
/// # Errors
/// A sentence that names the file.
pub fn read(path: &Path) -> Result<Vec<u8>, String> {
    match files().1.get(path) {
        Some((_, Ok(bytes))) => Ok(bytes.clone()),
        Some((_, Err(error))) => Err(format!("{}: {error}.", path.display())),
        None => Err(format!(
            "{}: this page may not read files by itself. Choose the file once, or drop it here; a project together with \
             its model.",
            path.display()
        )),
    }
}

/// The number of the last file handed over under this name.
pub fn stamp(path: &Path) -> Option<Stamp> {
    files().1.get(path).map(|(stamp, _)| *stamp)
}

/// Downloads a file.
///
/// # Errors
/// A sentence that names the file.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), String> {
    let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
    download(&name, bytes)
        .map_err(|error| format!("{name} cannot be downloaded ({error:?}). Allow downloads to this page."))
}

/// Downloads files, several of them in an archive `name.zip`, and returns their names.
///
/// # Errors
/// A sentence that names the file that cannot be downloaded.
pub fn write_folder(_: &Path, name: &str, chunks: Vec<Chunk>) -> Result<Vec<String>, String> {
    let mut files: BTreeMap<String, String> = BTreeMap::new();
    for chunk in chunks {
        files.entry(chunk.file).or_default().push_str(&chunk.text);
    }
    match files.iter().next() {
        Some((name, text)) if files.len() == 1 => write(name.as_ref(), text.as_bytes())?,
        _ => {
            let archive = archive(&files).map_err(|error| format!("{name}.zip: {error}."))?;
            write(format!("{name}.zip").as_ref(), &archive)?;
        }
    }
    Ok(files.into_keys().collect())
}

fn archive(files: &BTreeMap<String, String>) -> zip::result::ZipResult<Vec<u8>> {
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, text) in files {
        archive.start_file(name, SimpleFileOptions::default())?;
        archive.write_all(text.as_bytes())?;
    }
    Ok(archive.finish()?.into_inner())
}

/// Downloads the bytes as if a link to them had been clicked.
fn download(name: &str, bytes: &[u8]) -> Result<(), JsValue> {
    let document = web_sys::window().and_then(|window| window.document()).ok_or("there is no page")?;
    let blob = Blob::new_with_u8_array_sequence(&Array::of1(&Uint8Array::from(bytes)))?;
    let url = Url::create_object_url_with_blob(&blob)?;
    let link: HtmlAnchorElement = document.create_element("a")?.unchecked_into();
    link.set_href(&url);
    link.set_download(name);
    link.click();
    Url::revoke_object_url(&url)
}

/// The dialects of these names.
///
/// # Errors
/// A sentence: a folder of templates, which a page cannot read.
pub fn posts(names: &[String]) -> Result<Vec<Post>, String> {
    match names.iter().find(|name| own::is_folder(name)) {
        Some(name) => Err(format!("{name}: this page cannot read folders of templates; `beadwright plan` can.")),
        None => Ok(names.iter().cloned().map(Post::Named).collect()),
    }
}
