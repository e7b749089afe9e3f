//! A plan welded in the height model (`adapt::surface`), with errors and with corrections by a scan after each layer.
//!
//! Every bead comes out with more or less metal than commanded ([`Errors`]) and is laid on the surface; after each
//! layer a scan of the surface corrects the next one, by the same rules as for a real build (`adapt::correct`). Where
//! beads depend on heat, the metal warms up as it is laid, and walls rise less. All random numbers are seeded.

mod errors;
pub mod page;

pub use errors::Errors;

use crate::adapt::area::core;
use crate::adapt::page::relief;
use crate::adapt::{Feedback, Levels, Rules, Spread, Surface, next};
use crate::bead::BeadByHeat;
use crate::chart::Chart;
use crate::deposit::{Nominal, Picture};
use crate::heat;
use crate::layer::Layer;
use crate::pass::PassKind;
use crate::plan::{self, warm::along};
use crate::profile::Profile;
use crate::task::{Cancelled, Stage, Task};

/// How a plan is welded.
#[derive(Debug, Clone)]
pub struct Settings {
    /// The bead that is promised.
    pub nominal: Nominal,
    /// What goes wrong.
    pub errors: Errors,
    /// How far corrections may go.
    pub rules: Rules,
    /// Heat that the plan does not account for; `None` where it does, or where beads do not depend on heat.
    pub heat: Option<Heat>,
}

/// Walls that rise less on warm metal.
#[derive(Debug, Clone)]
pub struct Heat {
    /// The plate before the first layer.
    pub plate: heat::Build,
    /// How beads change.
    pub law: BeadByHeat,
    /// Thickness of a wall's layer at the temperature of the law, mm.
    pub rise: f64,
}

impl Heat {
    /// Welds a layer. Metal that flows to the sides of a warm wall is lost to its height; between beads side by side it
    /// stays.
    fn spread(&mut self, laid: &mut Layer) {
        let (warm, Self { plate, law, rise }) = (self.plate.layer(laid), &*self);
        for (pass, warm) in laid.passes.iter_mut().zip(&warm.passes).filter(|(pass, _)| pass.kind == PassKind::Wall) {
            pass.pace = along(pass, warm, plate, |piece, ahead| piece.pace / law.lift(*rise, ahead));
        }
    }
}

/// A build welded in the model.
#[derive(Debug, Clone)]
pub struct Built {
    /// How its layers were corrected.
    pub by: Feedback,
    /// Its layers, the lowest first.
    pub layers: Vec<BuiltLayer>,
    /// Height of the last layer above the end of the plan, mm.
    pub end: Spread,
    /// Thickness of a planned layer, mm: their mean.
    pub layer_height: f64,
    /// Pieces of passes that were laid.
    pub pieces: usize,
    /// Number of pieces that needed more or less metal than the window allows.
    pub clipped: usize,
}

/// A layer after it was welded.
#[derive(Debug, Clone, PartialEq)]
pub struct BuiltLayer {
    /// The top that it should have, mm.
    pub z: f64,
    /// Its height above that inside the outline less its rim, mm.
    pub error: Spread,
    /// The same seen from above, on a scale of ± one layer height; only for some layers.
    pub picture: Option<Picture>,
}

impl Built {
    /// Root mean square of the error at the end, in layer heights.
    pub fn rms(&self) -> f64 {
        self.end.rms / self.layer_height
    }
}

/// Why layers cannot be built in the height model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum BuildError {
    /// Layers around an axis.
    #[error("unrolled layers around an axis do not lie over one another, so they cannot be built here (layers.chart).")]
    Around,
    /// A bend whose outer side takes more layers.
    #[error(
        "layer {0}: the outer side of a bend takes two layers where the inner side takes one, which cannot be built here. Bend \
         the guide less, or raise layers.max_height."
    )]
    Half(usize),
}

/// Layers as their chart shows them, ready to be built.
///
/// # Errors
/// [`BuildError`] for layers that do not lie over one another.
pub fn ready(layers: &[Layer], profile: &Profile) -> Result<Vec<Layer>, BuildError> {
    if profile.layers.charts().any(Chart::goes_around) {
        return Err(BuildError::Around);
    }
    if let Some(layer) = layers.iter().find(|layer| layer.half.is_some()) {
        return Err(BuildError::Half(layer.index + 1));
    }
    Ok(layers.iter().map(|layer| plan::even(layer, profile).into_owned()).collect())
}

/// Maximum number of layers of a build, as a multiple of the planned number: if metal is lost again and again, it never
/// ends.
const MOST_LAYERS: usize = 2;
/// About this many layers have a picture.
const PICTURES: usize = 50;

/// Welds a plan. `None` for a plan without layers, or whose tops do not rise.
///
/// # Errors
/// [`Cancelled`].
pub fn build(planned: &[Layer], by: Feedback, settings: &Settings, task: &Task) -> Result<Option<Built>, Cancelled> {
    let Some(levels) = Levels::of(planned) else { return Ok(None) };
    let Settings { nominal, errors, rules, heat } = settings;
    let mut metal = heat.clone();
    let mut surface = Surface::plate(planned, *nominal);
    let mut measured = surface.clone();
    let layer_height = (levels.end() - surface.level()) / planned.len() as f64;
    let (layers, end) = (Vec::new(), Spread::default());
    let mut built = Built { by, layers, end, layer_height, pieces: 0, clipped: 0 };
    let mut passes = 0;
    for index in 0..MOST_LAYERS * planned.len() {
        let share = index as f64 / planned.len() as f64;
        task.step(Stage::Plan, share.min(1.0))?;
        let Some(next) = next(planned, &levels, &measured, index, by, rules) else { break };
        let mut laid = errors.layer(&next.layer, share, passes);
        if let Some(heat) = &mut metal {
            heat.spread(&mut laid);
        }
        surface.lay(&next.promised, &laid);
        let core = core(surface.grid(), &next.layer.islands, nominal.bead.width);
        let (z, error) = (surface.level(), surface.spread(&core));
        let shown = index % planned.len().div_ceil(PICTURES) == 0;
        let picture = shown.then(|| relief(&surface, layer_height, |i| surface.error(i)));
        built.layers.push(BuiltLayer { z, error, picture });
        built.end = error.moved(z - levels.end());
        passes += next.layer.passes.len();
        built.pieces += next.pieces;
        built.clipped += next.clipped;
        measured = surface.clone();
        measured.disturb(errors.scan(index));
        if by != Feedback::None {
            let mean = measured.spread(&core).mean;
            measured.settle(mean);
            surface.settle(mean);
        }
    }
    Ok(Some(built))
}
