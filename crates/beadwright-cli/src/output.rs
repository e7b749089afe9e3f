//! Files that are complete or absent: written into a temporary folder beside their place, moved at the end.

use anyhow::Context;
use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// The files of one run. Dropped without [`commit`](Self::commit) it leaves nothing behind.
pub(crate) struct Output {
    folder: PathBuf,
    temporary: TempDir,
    names: BTreeSet<String>,
    /// The file written last, kept open: text mostly goes to one file several times in a row.
    open: Option<(String, BufWriter<File>)>,
}

impl Output {
    /// Files for `folder`, which is made at the end if it is missing.
    pub(crate) fn new(folder: &Path) -> anyhow::Result<Self> {
        let exists = |p: &&Path| !p.as_os_str().is_empty() && p.exists();
        let beside = folder.ancestors().find(exists).unwrap_or(Path::new("."));
        let temporary = tempfile::Builder::new().prefix(".beadwright-").tempdir_in(beside);
        let temporary = temporary.with_context(|| format!("nothing can be written into {}", beside.display()))?;
        Ok(Self { folder: folder.to_owned(), temporary, names: BTreeSet::new(), open: None })
    }

    /// Appends text to a file of this run.
    pub(crate) fn append(&mut self, name: &str, text: &str) -> anyhow::Result<()> {
        self.write(name, text).with_context(|| format!("{name} cannot be written"))
    }

    fn write(&mut self, name: &str, text: &str) -> std::io::Result<()> {
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

    fn close(&mut self) -> std::io::Result<()> {
        self.open.take().map_or(Ok(()), |(_, mut writer)| writer.flush())
    }

    /// Names of the files so far, sorted.
    pub(crate) fn names(&self) -> Vec<String> {
        self.names.iter().cloned().collect()
    }

    /// Moves all files to their place.
    pub(crate) fn commit(mut self) -> anyhow::Result<()> {
        self.close().context("the files cannot be written")?;
        let folder = &self.folder;
        fs::create_dir_all(folder).with_context(|| format!("the folder {} cannot be made", folder.display()))?;
        for name in &self.names {
            let place = folder.join(name);
            fs::rename(self.temporary.path().join(name), &place)
                .with_context(|| format!("{} cannot be written", place.display()))?;
        }
        Ok(())
    }
}

/// Writes one file completely or not at all.
pub(crate) fn write_file(path: &Path, bytes: &[u8]) -> anyhow::Result<()> {
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let write = || -> std::io::Result<()> {
        let mut file = tempfile::Builder::new().prefix(".beadwright-").tempfile_in(folder)?;
        file.write_all(bytes)?;
        file.persist(path)?;
        Ok(())
    };
    write().with_context(|| format!("{} cannot be written", path.display()))
}
