//! Model files: mapped into memory, imported and placed.

use anyhow::Context;
use beadwright::model::{self, Import, Units, units};
use beadwright::task::Task;
use glam::DVec3;
use memmap2::Mmap;
use std::fs::File;
use std::path::{Path, PathBuf};

/// Which model, and how it is placed.
#[derive(clap::Args)]
pub(crate) struct Model {
    /// The model: binary or ASCII STL.
    pub(crate) model: PathBuf,
    /// Unit of the model's coordinates; asked for when the part would be smaller than a few beads.
    #[arg(long, value_parser = parse_units, value_name = "mm|cm|m|in")]
    pub(crate) units: Option<Units>,
    /// Enlarges the part.
    #[arg(long, default_value_t = 1.0, value_parser = parse_scale)]
    pub(crate) scale: f64,
    /// Turns the part about x, then y, then z, in degrees: --turn 90,0,0.
    #[arg(long, value_parser = parse_turn, value_name = "X,Y,Z", allow_hyphen_values = true, default_value = "0,0,0")]
    pub(crate) turn: DVec3,
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

/// A model read from a file.
pub(crate) fn read(path: &Path, task: &Task) -> anyhow::Result<Import> {
    let context = || format!("{}", path.display());
    let file = File::open(path).with_context(context)?;
    if file.metadata().with_context(context)?.is_dir() {
        anyhow::bail!("{}: this is a folder, not a model file", path.display());
    }
    let import = if file.metadata().with_context(context)?.len() == 0 {
        model::import(&[], task)
    } else {
        // SAFETY: the mapping is read only and lives shorter than this function; a file that another program cuts
        // off meanwhile ends this process, as it would end any reader of mapped files.
        #[allow(unsafe_code)]
        let bytes = unsafe { Mmap::map(&file) }.with_context(context)?;
        model::import(&bytes, task)
    };
    import.with_context(context)
}

impl Model {
    /// The part's name: the file name without its extension.
    pub(crate) fn part(&self) -> String {
        self.model.file_stem().map_or("part".to_owned(), |stem| stem.to_string_lossy().into_owned())
    }

    /// The model, scaled to mm, turned, and set onto z = 0.
    pub(crate) fn placed(&self, bead_width: f64, task: &Task) -> anyhow::Result<Import> {
        let mut import = read(&self.model, task)?;
        let units = match self.units {
            Some(units) => units,
            None => units::guess(import.mesh.size() * self.scale, bead_width)
                .with_context(|| format!("{}", self.model.display()))?,
        };
        import.mesh.place(units.in_mm() * self.scale, self.turn);
        import.mesh.check_reach()?;
        Ok(import)
    }
}
