//! Files that are complete or absent as a set: written next to their folder, which is exchanged for the new one in one step.
//!
//! A run that is killed, stopped or out of disk space leaves the folder as it was, and no controller ever finds layers
//! of two plans in it. Files that Beadwright did not write stay. Where the file system cannot exchange folders, or the
//! folder is the current one of this process (a shell would still see the old one), the older set is moved out file by
//! file, and then the new one in.

use super::stage::{self, Stage};
use crate::dialect::Chunk;
use std::collections::BTreeSet;
use std::fs::{self, File, Permissions};
use std::io::{self, BufWriter, Write};
use std::path::{Component, Path, PathBuf};

/// A file or folder that cannot be written.
#[derive(Debug, thiserror::Error)]
#[error("{} cannot be written: {reason}", path.display())]
pub struct FolderError {
    /// Where.
    pub path: PathBuf,
    /// The error of the operating system; not a `source`, which would be reported twice.
    pub reason: io::Error,
}

/// A folder with more entries of other programs than this is not exchanged.
const MOST_ENTRIES: usize = 10_000;

/// The files of one run. Dropped without [`commit`](Self::commit) it leaves nothing behind.
pub struct Folder {
    /// As the caller names it.
    named: PathBuf,
    /// Without links, so that the folder itself is exchanged.
    folder: PathBuf,
    stage: Stage,
    names: BTreeSet<String>,
    /// The file written last, kept open: text mostly goes to one file several times in a row.
    open: Option<(String, BufWriter<File>)>,
}

/// What a run has put into its folder.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Written {
    /// Its files, in order.
    pub files: Vec<String>,
    /// Files of an earlier run that were removed and have no successor of that name.
    pub removed: Vec<String>,
}

impl Folder {
    /// Files for `folder`, which is made at the end if it is missing.
    ///
    /// # Errors
    /// [`FolderError`] where nothing can be written next to it or into it.
    pub fn new(folder: &Path) -> Result<Self, FolderError> {
        let error = named(folder);
        let (named, folder) = (folder.to_owned(), real(folder).map_err(&error)?);
        if folder.exists() && !folder.is_dir() {
            return Err(error(io::Error::new(io::ErrorKind::NotADirectory, "it is a file, not a folder")));
        }
        stage::clear(&folder);
        let beside = folder.ancestors().skip(1).find(|p| p.exists()).unwrap_or(&folder);
        let stage =
            Stage::new(beside).or_else(|refused| if folder.exists() { Stage::new(&folder) } else { Err(refused) });
        Ok(Self { stage: stage.map_err(error)?, named, folder, names: BTreeSet::new(), open: None })
    }

    /// Appends text or bytes to a file of this run.
    ///
    /// # Errors
    /// [`FolderError`].
    pub fn append(&mut self, name: &str, content: impl AsRef<[u8]>) -> Result<(), FolderError> {
        self.write(name, content.as_ref()).map_err(named(&self.named.join(name)))
    }

    /// Appends texts, each to its file.
    ///
    /// # Errors
    /// [`FolderError`].
    pub fn extend(&mut self, chunks: impl IntoIterator<Item = Chunk>) -> Result<(), FolderError> {
        chunks.into_iter().try_for_each(|chunk| self.append(&chunk.file, &chunk.text))
    }

    fn write(&mut self, name: &str, content: &[u8]) -> io::Result<()> {
        if self.open.as_ref().is_none_or(|(open, _)| open != name) {
            self.close()?;
            let file = File::options().create(true).append(true).open(self.stage.new_files().join(name))?;
            self.names.insert(name.to_owned());
            self.open = Some((name.to_owned(), BufWriter::with_capacity(1 << 16, file)));
        }
        match &mut self.open {
            Some((_, writer)) => writer.write_all(content),
            None => Ok(()),
        }
    }

    fn close(&mut self) -> io::Result<()> {
        self.open.take().map_or(Ok(()), |(_, mut writer)| writer.flush())
    }

    /// Puts the files in place of those of an earlier run: a plan replaces the whole earlier plan, anything else
    /// replaces only files of the same names.
    ///
    /// # Errors
    /// [`FolderError`]; then nothing has changed.
    pub fn commit(mut self) -> Result<Written, FolderError> {
        let error = named(&self.named);
        self.close().map_err(&error)?;
        // Two runs into one folder take turns; where folders cannot be locked, they cannot know of each other.
        let parent = self.folder.parent().and_then(|parent| File::open(parent).ok());
        parent.iter().for_each(|parent| _ = parent.lock());
        let earlier = earlier(&self.folder);
        let whole = [super::PLAN, super::METRICS].iter().all(|name| self.names.contains(*name));
        let old: BTreeSet<String> = earlier.into_iter().filter(|name| whole || self.names.contains(name)).collect();
        let removed = old.difference(&self.names).cloned().collect();
        self.put(&old).map_err(error)?;
        Ok(Written { files: self.names.into_iter().collect(), removed })
    }

    fn put(&self, old: &BTreeSet<String>) -> io::Result<()> {
        let (new, folder) = (self.stage.new_files(), &self.folder);
        if !folder.exists() {
            folder.parent().map_or(Ok(()), fs::create_dir_all)?;
            return fs::rename(&new, folder);
        }
        if let Some(name) = self.names.iter().find(|name| folder.join(name).is_dir()) {
            return Err(io::Error::new(io::ErrorKind::IsADirectory, format!("{name} is a folder there")));
        }
        let current = std::env::current_dir().and_then(fs::canonicalize).is_ok_and(|at| at.starts_with(folder));
        let inside = new.starts_with(folder);
        if current || inside || self.exchange(old).is_err() {
            self.move_each(old)?;
        }
        Ok(())
    }

    /// Exchanges the folder for that of the new files, to which the files of others have been linked.
    fn exchange(&self, old: &BTreeSet<String>) -> io::Result<()> {
        let (new, mut linked) = (self.stage.new_files(), 0);
        let others = |name: &str| !old.contains(name) && !self.names.contains(name);
        link_all(&self.folder, &new, &others, &mut linked)?;
        let before = fs::metadata(&self.folder)?;
        fs::set_permissions(&new, before.permissions())?;
        if !same_owner(&before, &fs::metadata(&new)?) {
            return Err(io::ErrorKind::PermissionDenied.into());
        }
        swap(&new, &self.folder)?;
        // What others have put there in the meantime stays, too. From here on nothing can fail: the exchange is done.
        for entry in fs::read_dir(&new).into_iter().flatten().filter_map(Result::ok) {
            let place = self.folder.join(entry.file_name());
            if others(&entry.file_name().to_string_lossy()) && fs::symlink_metadata(&place).is_err() {
                _ = fs::rename(entry.path(), place);
            }
        }
        Ok(())
    }

    /// Moves the files one by one, through a stage in the folder itself.
    fn move_each(&self, old: &BTreeSet<String>) -> io::Result<()> {
        let (from, stage) = (self.stage.new_files(), Stage::new(&self.folder)?);
        let mut new: Vec<&str> = self.names.iter().map(String::as_str).collect();
        // The program that calls the others has the shortest name and comes last: without it, none of them is started.
        new.sort_by_key(|name| std::cmp::Reverse(name.len()));
        for name in &new {
            fs::rename(from.join(name), stage.new_files().join(name))
                .or_else(|_| fs::copy(from.join(name), stage.new_files().join(name)).map(|_| ()))?;
        }
        let there = |name: &&str| fs::symlink_metadata(self.folder.join(name)).is_ok();
        let old: BTreeSet<&str> = old.iter().map(String::as_str).chain(new.iter().copied()).filter(there).collect();
        stage.move_into(&self.folder, &old.into_iter().collect::<Vec<_>>(), &new)
    }
}

/// The folder without links and dots; it need not exist.
fn real(folder: &Path) -> io::Result<PathBuf> {
    let full = std::path::absolute(folder)?;
    let Some(there) = full.ancestors().find(|p| p.exists()) else { return Ok(full) };
    let rest = full.strip_prefix(there).map(Path::to_owned).unwrap_or_default();
    let there = fs::canonicalize(there)?;
    Ok(if rest.as_os_str().is_empty() { there } else { there.join(rest) })
}

/// The files of the earlier plan in a folder, as its metrics.json lists them.
fn earlier(folder: &Path) -> BTreeSet<String> {
    #[derive(serde::Deserialize)]
    struct Listing {
        files: Vec<String>,
    }
    let listing = fs::read(folder.join(super::METRICS)).ok().and_then(|text| serde_json::from_slice(&text).ok());
    let files = listing.map_or(Vec::new(), |listing: Listing| listing.files);
    let files = files.into_iter().chain([super::REFUSED.to_owned()]);
    // Even an edited list must not name a place elsewhere.
    let plain = |name: &str| matches!(Path::new(name).components().collect::<Vec<_>>()[..], [Component::Normal(_)]);
    files.filter(|name| plain(name) && folder.join(name).is_file()).collect()
}

/// Links the files of a folder and its folders into another.
fn link_all(from: &Path, to: &Path, wanted: &dyn Fn(&str) -> bool, linked: &mut usize) -> io::Result<()> {
    for entry in fs::read_dir(from)? {
        let entry = entry?;
        let place = to.join(entry.file_name());
        if !wanted(&entry.file_name().to_string_lossy()) {
            continue;
        }
        *linked += 1;
        // Stages of other runs cannot be linked, and read-only folders could not be cleared afterwards.
        let (is_dir, about) = (entry.file_type()?.is_dir(), entry.metadata()?);
        let is_stage = stage::is_stage(&entry.file_name().to_string_lossy());
        if *linked > MOST_ENTRIES || is_stage || (is_dir && about.permissions().readonly()) {
            return Err(io::ErrorKind::Unsupported.into());
        }
        if is_dir {
            fs::create_dir(&place)?;
            link_all(&entry.path(), &place, &|_| true, linked)?;
            fs::set_permissions(&place, about.permissions())?;
        } else {
            fs::hard_link(entry.path(), place)?;
        }
    }
    Ok(())
}

/// Whether two folders belong to the same user and group.
#[cfg(unix)]
fn same_owner(a: &fs::Metadata, b: &fs::Metadata) -> bool {
    use std::os::unix::fs::MetadataExt;
    (a.uid(), a.gid()) == (b.uid(), b.gid())
}

#[cfg(not(unix))]
fn same_owner(_: &fs::Metadata, _: &fs::Metadata) -> bool {
    true
}

/// Exchanges two folders in one step.
#[cfg(any(target_os = "linux", target_os = "android", target_vendor = "apple"))]
fn swap(a: &Path, b: &Path) -> io::Result<()> {
    use rustix::fs::{CWD, RenameFlags, renameat_with};
    Ok(renameat_with(CWD, a, CWD, b, RenameFlags::EXCHANGE)?)
}

#[cfg(not(any(target_os = "linux", target_os = "android", target_vendor = "apple")))]
fn swap(_: &Path, _: &Path) -> io::Result<()> {
    Err(io::ErrorKind::Unsupported.into())
}

/// Writes one file completely or not at all. What is not a plain file, such as `/dev/stdout`, is written to directly;
/// links to files are refused, since their targets may not be intended.
///
/// # Errors
/// [`FolderError`].
pub fn write_file(path: &Path, bytes: &[u8]) -> Result<(), FolderError> {
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let write = || -> io::Result<()> {
        let (itself, behind) = (fs::symlink_metadata(path), fs::metadata(path));
        let is_device = behind.as_ref().is_ok_and(|there| !there.is_file() && !there.is_dir());
        // `/dev/stdout` is a link to whatever it has been redirected to.
        if is_device || path.starts_with("/dev") {
            return File::options().write(true).open(path)?.write_all(bytes);
        }
        if itself.is_ok_and(|there| there.is_symlink()) {
            let to = fs::read_link(path)?;
            return Err(io::Error::other(format!("it is a link to {}; name that file itself", to.display())));
        }
        fs::create_dir_all(folder)?;
        let mut builder = tempfile::Builder::new();
        let permissions = behind.map(|there| there.permissions()).ok().or_else(usual);
        if let Some(permissions) = permissions {
            builder.permissions(permissions);
        }
        let mut file = builder.prefix(".beadwright-").tempfile_in(folder)?;
        file.write_all(bytes)?;
        file.persist(path)?;
        Ok(())
    };
    write().map_err(named(path))
}

/// Permissions of a new file, before the user's umask applies.
#[cfg(unix)]
fn usual() -> Option<Permissions> {
    use std::os::unix::fs::PermissionsExt;
    Some(Permissions::from_mode(0o666))
}

#[cfg(not(unix))]
fn usual() -> Option<Permissions> {
    None
}

fn named(path: &Path) -> impl Fn(io::Error) -> FolderError + use<> {
    let path = path.to_owned();
    // Errors of temporary files name a place unknown to the user: their kind is enough. Our own sentences stay.
    let plain = |error: io::Error| match error.get_ref() {
        Some(inner) if inner.downcast_ref::<io::Error>().is_some() || inner.to_string().contains(".beadwright-") => {
            error.kind().into()
        }
        _ => error,
    };
    move |error| FolderError { path: path.clone(), reason: plain(error) }
}
