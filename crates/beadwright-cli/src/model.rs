//! Model files, imported and placed.

use crate::{convert, file};
use anyhow::Context;
use beadwright::model::iges::{self, IgesFile};
use beadwright::model::{self, Import, Mesh, Part, Placement, Units};
use beadwright::preform::orient;
use beadwright::profile::Profile;
use beadwright::task::Task;
use glam::{DVec2, DVec3};
use std::path::{Path, PathBuf};

/// Which model, and how it is placed.
#[derive(clap::Args, Clone)]
pub(crate) struct Model {
    /// Model, - for standard input, or the name of an example part, such as propeller. A model is STL, 3MF, OBJ, PLY or AMF;
    /// STEP or IGES surfaces with a converter; for `plan`, also IGES with the centre-lines of walls, or DXF or SVG with
    /// outlines (--height).
    pub(crate) model: PathBuf,
    #[command(flatten)]
    pub(crate) placing: Placing,
}

/// How models are placed, and what is used of them.
#[derive(clap::Args, Clone)]
pub(crate) struct Placing {
    /// Unit of the model's coordinates; needed if the part would otherwise be smaller than a few beads.
    #[arg(long, value_parser = parse_units, value_name = "mm|cm|m|in")]
    pub(crate) units: Option<Units>,
    /// Factor by which to enlarge the part.
    #[arg(long, default_value_t = 1.0, value_parser = parse_scale)]
    scale: f64,
    /// Turn the part about x, then y, then z, in degrees, such as --turn 90,0,0.
    #[arg(long, value_parser = parse_turn, value_name = "X,Y,Z", allow_hyphen_values = true, default_value = "0,0,0")]
    turn: DVec3,
    /// Lay the part on its largest suitable flat face.
    #[arg(long)]
    lay_flat: bool,
    /// Turn the part onto the flat face that leaves the least overhang (of several, the one on which the part is lowest), or a
    /// preform so that it costs least to weld and mill.
    #[arg(long, conflicts_with = "lay_flat")]
    orient: bool,
    /// Move the middle of the part to x = y = 0.
    #[arg(long)]
    centre: bool,
    /// Move the part along x and y after all else, in mm, such as --shift 250,-40.
    #[arg(long, value_parser = parse_shift, value_name = "X,Y", allow_hyphen_values = true, default_value = "0,0")]
    shift: DVec2,
    /// Accept an STL file that ends too early or holds more than it says, and use the triangles that it does have.
    #[arg(long)]
    pub(crate) accept_damaged: bool,
}

impl Placing {
    /// Whether anything is asked for.
    pub(crate) fn moves(&self) -> bool {
        let Self { units, scale, turn, lay_flat, orient, centre, shift, accept_damaged: _ } = self;
        let moved = *turn != DVec3::ZERO || *shift != DVec2::ZERO || *scale != 1.0 || units.is_some();
        moved || *lay_flat || *orient || *centre
    }
}

/// What is made of a model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Use {
    /// The part as it is drawn.
    AsDrawn,
    /// Its preform.
    Preform,
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
    let angles = numbers(text).map(DVec3::from_array);
    angles.ok_or_else(|| "three angles in degrees are expected, such as 90,0,0".to_owned())
}

fn parse_shift(text: &str) -> Result<DVec2, String> {
    let lengths = numbers(text).map(DVec2::from_array);
    lengths.ok_or_else(|| "two lengths in mm are expected, such as 250,-40".to_owned())
}

/// `N` numbers separated by commas.
fn numbers<const N: usize>(text: &str) -> Option<[f64; N]> {
    let numbers = text.split(',').map(|number| number.trim().parse().ok().filter(|number: &f64| number.is_finite()));
    numbers.collect::<Option<Vec<f64>>>()?.try_into().ok()
}

/// An IGES file; `None` for any other.
pub(crate) fn read_iges(path: &Path, bytes: &[u8]) -> anyhow::Result<Option<IgesFile>> {
    if !model::is_iges(bytes) {
        return Ok(None);
    }
    iges::read(bytes).map(Some).with_context(|| format!("{}", path.display()))
}

impl Model {
    /// A model placed as it is in its file.
    pub(crate) fn of(path: &Path) -> Self {
        let placing = Placing {
            units: None,
            scale: 1.0,
            lay_flat: false,
            orient: false,
            turn: DVec3::ZERO,
            centre: false,
            shift: DVec2::ZERO,
            accept_damaged: false,
        };
        Self::placed_so(path, &placing)
    }

    /// A model placed as `placing` says.
    pub(crate) fn placed_so(path: &Path, placing: &Placing) -> Self {
        Self { model: path.to_owned(), placing: placing.clone() }
    }

    /// The solid or the curves, placed. Curves that all lie at one height need a height to end at, mm.
    pub(crate) fn part_placed(
        &self,
        profile: &Profile,
        use_as: Use,
        height: Option<f64>,
        task: &Task,
    ) -> anyhow::Result<Part> {
        let bead_width = profile.bead.width;
        let context = || format!("{}", self.model.display());
        let read = if self.placing.accept_damaged { model::Model::read_damaged } else { model::Model::read };
        let bytes = convert::solid(&self.model, file::model(&self.model)?)?;
        let model = read(&bytes, task).with_context(context)?;
        let placement = self.placing.placement();
        let part = model.place(&placement, height, bead_width).with_context(context)?;
        match part.mesh().filter(|_| self.placing.turns()) {
            None => Ok(part),
            Some(mesh) => {
                let turn = self.placing.turn_for(&placement, mesh, (profile, use_as), task)?;
                let flat = read(&bytes, task)
                    .and_then(|model| model.place(&Placement { turn, ..placement }, height, bead_width));
                flat.with_context(context)
            }
        }
    }

    /// A solid with an existing part on which it is welded: both placed as one.
    pub(crate) fn placed_onto(&self, base: &Path, profile: &Profile, task: &Task) -> anyhow::Result<(Import, Mesh)> {
        anyhow::ensure!(
            !self.placing.turns(),
            "--onto: the part lies as its base does, so it is not turned by itself (--turn turns both)"
        );
        let (own, base) = (self.placing.import(&self.model, task)?, self.placing.import(base, task)?);
        let placed = self.placing.placement().solid_onto(own, base, profile.bead.width);
        placed.with_context(|| self.model.display().to_string())
    }

    /// The part's name: the file name without its extension.
    pub(crate) fn part(&self) -> String {
        file::stem(&self.model).unwrap_or_else(|| "part".to_owned())
    }

    /// The solid in the coordinates and units of its file.
    pub(crate) fn drawn(&self, task: &Task) -> anyhow::Result<Mesh> {
        Ok(self.placing.import(&self.model, task)?.mesh)
    }

    /// The model, scaled to mm, turned, and placed on z = 0.
    pub(crate) fn placed(&self, profile: &Profile, use_as: Use, task: &Task) -> anyhow::Result<Import> {
        let bead_width = profile.bead.width;
        let context = || format!("{}", self.model.display());
        let import = self.placing.import(&self.model, task)?;
        let placement = self.placing.placement();
        let part = if self.placing.turns() {
            let placed = placement.solid(import.clone(), bead_width).with_context(context)?.mesh;
            let turn = self.placing.turn_for(&placement, &placed, (profile, use_as), task)?;
            Placement { turn, ..placement }.solid(import, bead_width)
        } else {
            placement.solid(import, bead_width)
        };
        part.with_context(context)
    }
}

impl Placing {
    /// A solid as its file has it.
    fn import(&self, path: &Path, task: &Task) -> anyhow::Result<Import> {
        let import = if self.accept_damaged { model::import_damaged } else { model::import };
        let bytes = convert::solid(path, file::model(path)?)?;
        import(&bytes, task).with_context(|| path.display().to_string())
    }

    /// Whether the part is turned according to how it lies.
    fn turns(&self) -> bool {
        self.lay_flat || self.orient
    }

    /// How a part placed in this way is to be turned.
    fn turn_for(
        &self,
        placement: &Placement,
        mesh: &Mesh,
        (profile, use_as): (&Profile, Use),
        task: &Task,
    ) -> anyhow::Result<DVec3> {
        match (self.orient, use_as) {
            (false, _) => return Ok(placement.laid_flat(mesh)),
            (true, Use::AsDrawn) => return Ok(placement.least_overhang(mesh)),
            (true, Use::Preform) => {}
        }
        let found = orient::best(mesh, &profile.preform_settings(), &profile.preform_rates(), task)?;
        Ok(found.first().map_or(placement.turn, |best| placement.turned_onto(best.down)))
    }

    fn placement(&self) -> Placement {
        Placement { units: self.units, scale: self.scale, turn: self.turn, centre: self.centre, shift: self.shift }
    }
}
