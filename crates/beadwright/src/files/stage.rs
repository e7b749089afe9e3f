//! Where the files of a run lie until they are complete: a folder `.beadwright-…`, locked as long as its run lives.

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

const PREFIX: &str = ".beadwright-";
/// The names of the files being replaced, while files are moved one by one.
const JOURNAL: &str = "moving";
/// The journal while it is written.
const DRAFT: &str = "draft";
/// Whatever else is in a folder is not ours.
const OURS: [&str; 5] = ["new", "old", "lock", JOURNAL, DRAFT];

/// Files on their way into a folder. Dropped, it leaves nothing behind.
pub(super) struct Stage {
    folder: TempDir,
    _lock: File,
}

impl Stage {
    /// A stage in `place`, once those that dead runs left there are cleared away.
    pub(super) fn new(place: &Path) -> io::Result<Self> {
        clear(place);
        // Another run may take the folder for a dead one's before it is locked.
        Self::make(place).or_else(|_| Self::make(place))
    }

    fn make(place: &Path) -> io::Result<Self> {
        let folder = tempfile::Builder::new().prefix(PREFIX).tempdir_in(place)?;
        let lock = open_lock(folder.path())?;
        lock.lock()?;
        fs::create_dir(folder.path().join("new"))?;
        fs::create_dir(folder.path().join("old"))?;
        Ok(Self { folder, _lock: lock })
    }

    /// The folder of the new files.
    pub(super) fn new_files(&self) -> PathBuf {
        self.folder.path().join("new")
    }

    /// Moves files of a stage that lies in `target`, one by one: the `old` ones out of it, then the `new` ones into it. If
    /// one cannot be moved, nothing changes; what a killed run did not move, the next one moves.
    pub(super) fn move_into(mut self, target: &Path, old: &[&str], new: &[&str]) -> io::Result<()> {
        let (journal, draft) = (self.folder.path().join(JOURNAL), self.folder.path().join(DRAFT));
        // All or nothing: half a list would leave old files among the new ones.
        fs::write(&draft, old.join("\n"))?;
        fs::rename(draft, &journal)?;
        // Should even undoing the moves fail, the stage stays, with the older set in it.
        self.folder.disable_cleanup(true);
        let moves = moves(self.folder.path(), target, old, new);
        let failed = moves.iter().enumerate().find_map(|(done, (from, to))| Some((done, fs::rename(from, to).err()?)));
        if let Some((done, _)) = failed {
            moves[..done].iter().rev().try_for_each(|(from, to)| fs::rename(to, from))?;
        }
        self.folder.disable_cleanup(false);
        fs::remove_file(journal)?;
        failed.map_or(Ok(()), |(_, error)| Err(error))
    }
}

/// From where to where: all old files first, so that the two sets never mix.
fn moves(stage: &Path, target: &Path, old: &[&str], new: &[&str]) -> Vec<(PathBuf, PathBuf)> {
    let out = old.iter().map(|name| (target.join(name), stage.join("old").join(name)));
    let into = new.iter().map(|name| (stage.join("new").join(name), target.join(name)));
    out.chain(into).collect()
}

/// What is locked: the folder itself, which exists as long as anything in it.
#[cfg(unix)]
fn open_lock(stage: &Path) -> io::Result<File> {
    File::open(stage)
}

/// What is locked: a file, since folders cannot be.
#[cfg(not(unix))]
fn open_lock(stage: &Path) -> io::Result<File> {
    File::options().create(true).truncate(true).write(true).open(stage.join("lock"))
}

/// Clears what dead runs have left in a folder. What cannot be cleared stays until the next time.
pub(super) fn clear(place: &Path) {
    let Ok(entries) = fs::read_dir(place) else { return };
    let stages = entries.filter_map(Result::ok).filter(|e| e.file_name().to_string_lossy().starts_with(PREFIX));
    for stage in stages.map(|entry| entry.path()).filter(|path| path.is_dir()) {
        if !names(&stage).is_ok_and(|names| names.iter().all(|name| OURS.contains(&name.as_str()))) {
            continue;
        }
        let lock = open_lock(&stage);
        if lock.as_ref().is_ok_and(|lock| lock.try_lock().is_ok()) {
            // Nothing is deleted while part of it is still to be moved.
            _ = complete(&stage, place).and_then(|()| fs::remove_dir_all(&stage));
        }
    }
}

/// Moves what a killed run still had to move.
fn complete(stage: &Path, target: &Path) -> io::Result<()> {
    let Ok(journal) = fs::read_to_string(stage.join(JOURNAL)) else { return Ok(()) };
    let new: Vec<String> = names(&stage.join("new"))?;
    // Once a new file has been moved, all old ones have.
    let old: Vec<&str> = journal.lines().filter(|name| !stage.join("old").join(name).exists()).collect();
    let new: Vec<&str> = new.iter().map(String::as_str).collect();
    for (from, to) in moves(stage, target, &old, &new) {
        match fs::rename(from, to) {
            // It has been taken away in the meantime.
            Err(error) if error.kind() == io::ErrorKind::NotFound => {}
            done => done?,
        }
    }
    // Nothing is left to be moved, even if only part of the rest of the stage is cleared.
    fs::remove_file(stage.join(JOURNAL))
}

/// Whether a file belongs to a stage.
pub(super) fn is_stage(name: &str) -> bool {
    name.starts_with(PREFIX)
}

/// Names in a folder; names that are not text are not ours.
fn names(folder: &Path) -> io::Result<Vec<String>> {
    fs::read_dir(folder)?.map(|entry| entry.map(|e| e.file_name().into_string().unwrap_or_default())).collect()
}
