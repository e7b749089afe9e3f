//! Files that are complete or absent: written into a temporary folder beside their final place, moved at the end.

use crate::dialect::Chunk;
use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// A file or folder that cannot be written.
#[derive(Debug, thiserror::Error)]
#[error("{} cannot be written: {source}", path.display())]
pub struct FolderError {
    /// Where.
    pub path: PathBuf,
    /// The error of the operating system.
    pub source: io::Error,
}

/// The files of one run. Dropped without [`commit`](Self::commit) it leaves nothing behind.
pub struct Folder {
    folder: PathBuf,
    temporary: TempDir,
    names: BTreeSet<String>,
    /// The file written last, kept open: text mostly goes to one file several times in a row.
    open: Option<(String, BufWriter<File>)>,
}

impl Folder {
    /// Files for `folder`, which is made at the end if it is missing.
    ///
    /// # Errors
    /// [`FolderError`] where nothing can be written beside it.
    pub fn new(folder: &Path) -> Result<Self, FolderError> {
        let exists = |p: &&Path| !p.as_os_str().is_empty() && p.exists();
        let beside = folder.ancestors().find(exists).unwrap_or(Path::new("."));
        let temporary = tempfile::Builder::new().prefix(".beadwright-").tempdir_in(beside);
        let temporary = temporary.map_err(named(beside))?;
        Ok(Self { folder: folder.to_owned(), temporary, names: BTreeSet::new(), open: None })
    }

    /// Appends text to a file of this run.
    ///
    /// # Errors
    /// [`FolderError`].
    pub fn append(&mut self, name: &str, text: &str) -> Result<(), FolderError> {
        self.write(name, text).map_err(named(&self.folder.join(name)))
    }

    /// Appends texts, each to its file.
    ///
    /// # Errors
    /// [`FolderError`].
    pub fn extend(&mut self, chunks: impl IntoIterator<Item = Chunk>) -> Result<(), FolderError> {
        chunks.into_iter().try_for_each(|chunk| self.append(&chunk.file, &chunk.text))
    }

    fn write(&mut self, name: &str, text: &str) -> io::Result<()> {
        if self.open.as_ref().is_none_or(|(open, _)| open != name) {
            self.close()?;
            let file = File::options().create(true).append(true).open(self.temporary.path().join(name))?;
            self.names.insert(name.to_owned());
            self.open = Some((name.to_owned(), BufWriter::with_capacity(1 << 16, file)));
        }
        match &mut self.open {
            Some((_, writer)) => writer.write_all(text.as_bytes()),
            None => Ok(()),
        }
    }

    fn close(&mut self) -> io::Result<()> {
        self.open.take().map_or(Ok(()), |(_, mut writer)| writer.flush())
    }

    /// Moves all files to their final place and returns their names in order.
    ///
    /// # Errors
    /// [`FolderError`].
    pub fn commit(mut self) -> Result<Vec<String>, FolderError> {
        self.close().map_err(named(&self.folder))?;
        fs::create_dir_all(&self.folder).map_err(named(&self.folder))?;
        for name in &self.names {
            let place = self.folder.join(name);
            fs::rename(self.temporary.path().join(name), &place).map_err(named(&place))?;
        }
        Ok(self.names.into_iter().collect())
    }
}

/// Writes one file completely or not at all.
///
/// # Errors
/// [`FolderError`].
pub fn write_file(path: &Path, bytes: &[u8]) -> Result<(), FolderError> {
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let write = || -> io::Result<()> {
        let mut file = tempfile::Builder::new().prefix(".beadwright-").tempfile_in(folder)?;
        file.write_all(bytes)?;
        file.persist(path)?;
        Ok(())
    };
    write().map_err(named(path))
}

fn named(path: &Path) -> impl Fn(io::Error) -> FolderError + use<> {
    let path = path.to_owned();
    // Errors of temporary files name a place that nobody knows: their kind is enough.
    let plain = |error: io::Error| if error.raw_os_error().is_some() { error } else { error.kind().into() };
    move |error| FolderError { path: path.clone(), source: plain(error) }
}
