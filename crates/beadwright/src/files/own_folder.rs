//! Reads the texts of your own dialects from their folders.

use super::Post;
use crate::dialect::own::{self, Own, OwnError};
use crate::text;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// Maximum size of a file of templates, bytes.
const LARGEST: u64 = 1 << 20;
/// Maximum number of files in a folder of templates.
const MOST: usize = 100;

/// The posts of these names: dialects of the library, and folders of templates. Relative paths begin at `base`.
///
/// # Errors
/// [`OwnError`] for a folder that cannot be read or holds no dialect.
pub fn posts<S: AsRef<str>>(names: &[S], base: &Path) -> Result<Vec<Post>, OwnError> {
    let post = |name: &S| match name.as_ref() {
        name if own::is_folder(name) => Ok(Post::Own(Box::new(Own::new(name, texts(name, &base.join(name))?)?))),
        name => Ok(Post::Named(name.to_owned())),
    };
    names.iter().map(post).collect()
}

/// The files of a folder by their names. Links are refused, since templates see nothing outside their folder.
fn texts(name: &str, folder: &Path) -> Result<BTreeMap<String, String>, OwnError> {
    let error =
        |file: &str, reason: String| OwnError { folder: name.to_owned(), file: file.to_owned(), line: None, reason };
    let unreadable = |e: std::io::Error| error("dialect.toml", format!("{} cannot be read: {e}.", folder.display()));
    let mut texts = BTreeMap::new();
    for entry in fs::read_dir(folder).map_err(unreadable)? {
        let entry = entry.map_err(unreadable)?;
        let (Ok(file), Ok(about)) = (entry.file_name().into_string(), entry.metadata()) else { continue };
        let is_template = [".txt", ".toml"].iter().any(|end| file.ends_with(end));
        if is_template && about.is_symlink() {
            let reason = "it is a link, and templates are read from their own folder only. Copy the file there.";
            return Err(error(&file, reason.to_owned()));
        }
        if !about.is_file() || !is_template {
            continue;
        }
        if about.len() > LARGEST || texts.len() >= MOST {
            let reason = format!("a dialect has at most {MOST} files of at most 1 MB each.");
            return Err(error(&file, reason));
        }
        let bytes = fs::read(entry.path()).map_err(|e| error(&file, format!("it cannot be read: {e}.")))?;
        let text = text::of(&bytes).map_err(|e| error(&file, e.to_string()))?;
        texts.insert(file, text);
    }
    Ok(texts)
}
