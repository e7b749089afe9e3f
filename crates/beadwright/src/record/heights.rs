//! Heights along the passes of a layer, from a scan of it.

use super::{Heights, Measured, PassRow, PlannedPass, Spot, Top};
use crate::adapt::{AdaptError, SeeError, Seen, see};
use crate::layer::Layer;
use crate::plan;
use crate::profile::Profile;
use glam::{DVec2, DVec3};
use rstar::RTree;
use rstar::primitives::GeomWithData;
use serde::Serialize;

/// Distance between places along a pass, and how far from its middle a scan counts, in bead widths.
const STEP: f64 = 0.5;
const REACH: f64 = 0.5;

/// What a scan shows of the passes of a layer.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Shown {
    /// Points of the scan that lie over the layer.
    pub points: usize,
    /// Number of passes that it shows, and of all passes of the layer.
    pub passes: [usize; 2],
    /// Fraction, 0 to 1, of the length of all these passes that it shows.
    pub covered: f64,
    /// Heights along each pass of the layer.
    #[serde(skip)]
    pub heights: Vec<Heights>,
}

impl Shown {
    /// Measured minus planned heights of all these passes, mm.
    pub fn off(&self) -> Option<Measured> {
        Measured::of(self.heights.iter().flat_map(|own| &own.tops).map(Top::off))
    }
}

/// Why a scan gives no heights of the passes of a layer.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum HeightsError {
    /// The turns of a helix rise while they are welded.
    #[error(
        "layer {number} is a turn of a helix, which rises as it is welded: the deposit model does not predict its height. Scans are \
         compared with level layers only."
    )]
    Helix {
        /// Number of the layer, from 1.
        number: usize,
    },
    /// Nothing was measured where passes lie.
    #[error(
        "the scan shows none of the passes of layer {number}: its points lie beside them, or at the ends of beads only. Scan the tops of \
         the beads."
    )]
    Nothing {
        /// Number of the layer, from 1.
        number: usize,
    },
    /// Layers that are not level, or a scan that cannot be of this layer.
    #[error(transparent)]
    Adapt(#[from] AdaptError),
}

/// The layer `number`, from 1, if a scan after it can be compared with its passes.
///
/// # Errors
/// [`HeightsError`] if there is no such layer, if layers are not level, or if it is a turn of a helix.
pub fn scannable<'a>(layers: &'a [Layer], profile: &Profile, number: usize) -> Result<&'a Layer, HeightsError> {
    if !profile.layers.are_level() {
        return Err(AdaptError::NotLevel.into());
    }
    let none = SeeError::NoLayer { number, layers: layers.len() };
    let layer = number.checked_sub(1).and_then(|index| layers.get(index)).ok_or(AdaptError::See(none))?;
    if layer.lit.is_turn() { Err(HeightsError::Helix { number }) } else { Ok(layer) }
}

/// The tops of the passes of a layer: planned, as the deposit model predicts them, and measured, each the mean over half a bead width
/// about each place. Places that the scan does not show, and the ends of beads, where the model itself predicts a hump or a hollow,
/// are left out. `points` are those of a scan after layer `number`, from 1, in the part's coordinates, mm.
///
/// # Errors
/// [`HeightsError`] for a layer that cannot be compared, for a scan that cannot be of this layer, and for one that shows none of its
/// passes.
pub fn heights(
    layers: &[Layer],
    profile: &Profile,
    passes: &[PlannedPass],
    points: &[DVec3],
    number: usize,
) -> Result<Shown, HeightsError> {
    let layer = scannable(layers, profile, number)?;
    let seen = see(layers, number, points, plan::deposit_settings(profile).nominal).map_err(AdaptError::See)?;
    let (tops, width) = (tops(&seen, layer.z), profile.bead.width);
    let mean = |at: DVec3| {
        let near = tops.locate_within_distance(at.truncate().to_array(), (REACH * width).powi(2));
        let (sum, count) = near.fold((DVec2::ZERO, 0), |(sum, count), top| (sum + top.data, count + 1));
        (count > 0).then(|| sum / f64::from(count))
    };
    let top = |(time, spot): &(f64, Spot)| {
        let DVec2 { x: planned, y: measured } = mean(spot.at)?;
        Some(Top { spot: *spot, time: *time, planned, measured })
    };
    let step = STEP * width;
    let along = |(pass, planned): (usize, &PlannedPass)| {
        let places = planned.every(step);
        let tops: Vec<Top> = places.iter().filter_map(top).collect();
        Heights { pass, step, share: tops.len() as f64 / places.len().max(1) as f64, tops }
    };
    let of_layer = passes.iter().enumerate().filter(|(_, pass)| pass.layer == number);
    let heights: Vec<Heights> = of_layer.map(along).collect();
    let shown = heights.iter().filter(|own| !own.tops.is_empty()).count();
    if shown == 0 {
        return Err(HeightsError::Nothing { number });
    }
    let length = |share: fn(&Heights) -> f64| -> f64 {
        heights.iter().map(|own| share(own) * passes[own.pass].length().max(step)).sum()
    };
    let covered = length(|own| own.share) / length(|_| 1.0);
    Ok(Shown { points: seen.points, passes: [shown, heights.len()], covered, heights })
}

/// Planned (x) and measured (y) heights, mm, by place; `top` is the planned top of the layer, mm.
fn tops(seen: &Seen, top: f64) -> RTree<GeomWithData<[f64; 2], DVec2>> {
    let grid = seen.surface.grid();
    let cell = |&(at, off): &(usize, f64)| {
        let planned = top + seen.predicted[at]?;
        let place = grid.place(at % grid.columns, at / grid.columns);
        Some(GeomWithData::new(place.to_array(), DVec2::new(planned, planned + off)))
    };
    RTree::bulk_load(seen.measured.iter().filter_map(cell).collect())
}

/// A column of page and table: its name, its unit, its value, and its digits on the page.
type Column = (&'static str, &'static str, fn(&PassRow) -> Option<f64>, usize);

/// What scans show of a pass.
pub(super) const COLUMNS: [Column; 7] = [
    ("height planned", "mm", |row| row.height[0], 2),
    ("height", "mm", |row| row.height[1], 2),
    ("height off, mean", "mm", |row| Some(row.off?.mean), 2),
    ("height off, least", "mm", |row| Some(row.off?.min), 2),
    ("height off, greatest", "mm", |row| Some(row.off?.max), 2),
    ("height off, deviation", "mm", |row| Some(row.off?.deviation), 2),
    ("length scanned", "%", |row| Some(100.0 * row.scanned?), 0),
];
