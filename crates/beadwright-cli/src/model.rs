//! Model files: mapped into memory, imported and placed.

use anyhow::Context;
use beadwright::model::iges::{self, IgesFile};
use beadwright::model::{self, Import, Part, Placement, Units};
use beadwright::task::Task;
use glam::DVec3;
use memmap2::Mmap;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

/// Which model, and how it is placed.
#[derive(clap::Args)]
pub(crate) struct Model {
    /// The model: binary or ASCII STL; for `plan`, also IGES with the centre-lines of walls.
    pub(crate) model: PathBuf,
    /// Unit of the model's coordinates; needed if the part would otherwise be smaller than a few beads.
    #[arg(long, value_parser = parse_units, value_name = "mm|cm|m|in")]
    pub(crate) units: Option<Units>,
    /// Factor by which the part is enlarged.
    #[arg(long, default_value_t = 1.0, value_parser = parse_scale)]
    pub(crate) scale: f64,
    /// Turn the part about x, then y, then z, in degrees, such as --turn 90,0,0.
    #[arg(long, value_parser = parse_turn, value_name = "X,Y,Z", allow_hyphen_values = true, default_value = "0,0,0")]
    pub(crate) turn: DVec3,
    /// Move the middle of the part to x = y = 0.
    #[arg(long)]
    pub(crate) centre: bool,
}

pub(crate) fn parse_units(text: &str) -> Result<Units, String> {
    let found = Units::ALL.iter().find(|(name, _)| *name == text);
    found.map(|(_, unit)| *unit).ok_or_else(|| "the units are mm, cm, m and in".to_owned())
}

fn parse_scale(text: &str) -> Result<f64, String> {
    let factor: f64 = text.parse().map_err(|_| "a number is expected".to_owned())?;
    if (1e-6..=1e6).contains(&factor) { Ok(factor) } else { Err("the factor must lie between 1e-6 and 1e6".to_owned()) }
}

fn parse_turn(text: &str) -> Result<DVec3, String> {
    let angles: Result<Vec<f64>, _> = text.split(',').map(|a| a.trim().parse::<f64>()).collect();
    match angles.as_deref() {
        Ok(&[x, y, z]) if [x, y, z].iter().all(|a| a.is_finite()) => Ok(DVec3::new(x, y, z)),
        _ => Err("three angles in degrees are expected, such as 90,0,0".to_owned()),
    }
}

fn open(path: &Path) -> anyhow::Result<File> {
    let context = || format!("{}", path.display());
    let file = File::open(path).with_context(context)?;
    if file.metadata().with_context(context)?.is_dir() {
        anyhow::bail!("{}: this is a folder, not a model file", path.display());
    }
    Ok(file)
}

/// An IGES file; `None` for any other.
pub(crate) fn read_iges(path: &Path) -> anyhow::Result<Option<IgesFile>> {
    const CARD: u64 = 80;
    let context = || format!("{}", path.display());
    let (mut file, mut bytes) = (open(path)?, Vec::new());
    file.by_ref().take(CARD).read_to_end(&mut bytes).with_context(context)?;
    if !model::is_iges(&bytes) {
        return Ok(None);
    }
    file.read_to_end(&mut bytes).with_context(context)?;
    iges::read(&bytes).map(Some).with_context(context)
}

/// A solid read from a file.
pub(crate) fn read(path: &Path, task: &Task) -> anyhow::Result<Import> {
    with_bytes(path, |bytes| model::import(bytes, task))?.with_context(|| format!("{}", path.display()))
}

/// Hands the bytes of a file to a reader; large files are not copied.
fn with_bytes<R>(path: &Path, read: impl FnOnce(&[u8]) -> R) -> anyhow::Result<R> {
    let context = || format!("{}", path.display());
    let file = open(path)?;
    if file.metadata().with_context(context)?.len() == 0 {
        return Ok(read(&[]));
    }
    // SAFETY: the mapping is read only and does not outlive this function; if another program truncates the file
    // meanwhile, this process ends, as any reader of mapped files would.
    #[allow(unsafe_code)]
    let bytes = unsafe { Mmap::map(&file) }.with_context(context)?;
    Ok(read(&bytes))
}

impl Model {
    /// The solid or the curves, placed. Curves that all lie at one height need a height to end at, mm.
    pub(crate) fn part_placed(&self, bead_width: f64, height: Option<f64>, task: &Task) -> anyhow::Result<Part> {
        let context = || format!("{}", self.model.display());
        let model = with_bytes(&self.model, |bytes| model::Model::read(bytes, task))?.with_context(context)?;
        model.place(&self.placement(), height, bead_width).with_context(context)
    }

    fn placement(&self) -> Placement {
        Placement { units: self.units, scale: self.scale, turn: self.turn, centre: self.centre }
    }

    /// The part's name: the file name without its extension.
    pub(crate) fn part(&self) -> String {
        self.model.file_stem().map_or("part".to_owned(), |stem| stem.to_string_lossy().into_owned())
    }

    /// The model, scaled to mm, turned, and placed on z = 0.
    pub(crate) fn placed(&self, bead_width: f64, task: &Task) -> anyhow::Result<Import> {
        let import = read(&self.model, task)?;
        self.placement().solid(import, bead_width).with_context(|| format!("{}", self.model.display()))
    }
}
