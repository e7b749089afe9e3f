//! Model files: mapped into memory, imported and placed.

use anyhow::Context;
use beadwright::model::iges::{self, IgesFile};
use beadwright::model::wall_curves::WallCurves;
use beadwright::model::{self, Import, RepairReport, Units, units};
use beadwright::planar::Bounds;
use beadwright::task::Task;
use glam::{DAffine3, DQuat, DVec2, DVec3};
use memmap2::Mmap;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

/// Which model, and how it is placed.
#[derive(clap::Args)]
pub(crate) struct Model {
    /// The model: binary or ASCII STL; for `plan`, also IGES with the centre-lines of walls.
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

/// A model read from a file.
pub(crate) fn read(path: &Path, task: &Task) -> anyhow::Result<Import> {
    let context = || format!("{}", path.display());
    let file = open(path)?;
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

/// What is planned.
pub(crate) enum Part {
    /// A solid.
    Mesh(Import),
    /// The centre-lines of a wall, up to a height, mm, and what was wrong with the file.
    Curves { curves: WallCurves, height: f64, warnings: Vec<String> },
}

impl Part {
    /// Lowest and highest coordinates, mm.
    pub(crate) fn bounds(&self) -> (DVec3, DVec3) {
        match self {
            Self::Mesh(import) => import.mesh.bounds(),
            Self::Curves { curves, height, .. } => {
                let sections = [0.0, *height].into_iter().flat_map(|z| curves.at(z, 1.0));
                let points = sections.flat_map(|section| section.points);
                let bounds = Bounds::of(points).unwrap_or(Bounds { min: DVec2::ZERO, max: DVec2::ZERO });
                (bounds.min.extend(0.0), bounds.max.extend(*height))
            }
        }
    }

    /// What was mended; nothing for curves.
    pub(crate) fn repair(&self) -> RepairReport {
        match self {
            Self::Mesh(import) => import.repair.clone(),
            Self::Curves { .. } => RepairReport::default(),
        }
    }
}

impl Model {
    /// The solid or the curves, placed. Curves of one height need one to end at, mm.
    pub(crate) fn part_placed(&self, bead_width: f64, height: Option<f64>, task: &Task) -> anyhow::Result<Part> {
        let Some(file) = read_iges(&self.model)? else {
            anyhow::ensure!(height.is_none(), "--height belongs to walls given by curves (IGES), not to a solid");
            return Ok(Part::Mesh(self.placed(bead_width, task)?));
        };
        let unit = self.units.map_or(1.0, |units| units.in_mm() / file.unit_mm);
        let turn = self.turn * std::f64::consts::PI / 180.0;
        let turn = DQuat::from_rotation_z(turn.z) * DQuat::from_rotation_y(turn.y) * DQuat::from_rotation_x(turn.x);
        let place = DAffine3::from_scale_rotation_translation(DVec3::splat(unit * self.scale), turn, DVec3::ZERO);
        let curves = WallCurves::of_iges(&file, &place).with_context(|| format!("{}", self.model.display()))?;
        let height = height.or(Some(curves.height()).filter(|height| *height > 0.0));
        let height = height.with_context(|| {
            format!("{}: the curves lie at one height; --height says how high the wall grows, mm", self.model.display())
        })?;
        let unread = file.entities.iter().filter(|e| e.unread > 0);
        let unread = unread.map(|e| format!("{} of entity {} ({}) not read.", e.unread, e.entity, e.name));
        let warnings = file.warnings.iter().cloned().chain(unread).collect();
        Ok(Part::Curves { curves, height, warnings })
    }

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
