//! What a scan says about a build: how far each place is from where the plan puts it.
//!
//! After layer N the plan promises a mean height of that layer's top z, with the shape that the deposit model gives the
//! layer's beads, levelled as the model levels the surface. Points inside the outline, without its rim, are compared
//! with that, except where the model itself predicts a hollow or a hump, such as at the ends of beads: these say
//! nothing about the height. In each cell of the grid the median counts, so that spatter does not. Where nothing was
//! measured, the nearest measured cells fill in, weighted by 1/d².

use super::area::{core, near};
use super::surface::{Spread, Surface};
use crate::deposit::Nominal;
use crate::layer::Layer;
use glam::DVec3;
use rstar::RTree;
use rstar::primitives::GeomWithData;

/// Fewer points than this over a layer say nothing.
const FEWEST: usize = 3;
/// A build is no farther from its plan than this fraction of its height, …
const FARTHEST: f64 = 0.35;
/// … or than this many layers, whichever is more.
const FARTHEST_LAYERS: f64 = 2.0;
/// If the heights deviate from their mean by more layers than this, the scan is of another build.
const UNEVEN: f64 = 2.0;
/// Of the points above half the height, at most this fraction may lie more than a bead width outside the part.
const BESIDE: f64 = 0.2;

/// Where a layer is predicted to be more than this fraction of its thickness above or below its top, nothing is
/// compared.
const DOUBTFUL: f64 = 0.3;

/// Number of measured cells that fill in for one that was not.
const STAND_IN: usize = 8;

/// A scan compared with its plan.
#[derive(Debug, Clone)]
pub struct Seen {
    /// The build as it was measured.
    pub surface: Surface,
    /// Points of the grid at which it is judged.
    pub core: Vec<usize>,
    /// Predicted height of each point of the grid above the layer's planned top, mm; `None` where there is no metal.
    pub predicted: Vec<Option<f64>>,
    /// The points of the grid at which it was measured, and the median of measured minus predicted heights there, mm.
    pub measured: Vec<(usize, f64)>,
    /// Measured minus predicted heights inside the outline without its rim, mm.
    pub error: Spread,
    /// Points of the scan that were compared.
    pub points: usize,
    /// Fraction of the layer, 0 to 1, that lies within a bead width of one of them.
    pub covered: f64,
}

/// Why a scan cannot be of a build.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SeeError {
    /// No such layer.
    #[error("the plan has the layers 1 to {layers}; layer {number} is not one of them.")]
    NoLayer {
        /// The number that was asked for.
        number: usize,
        /// Layers of the plan.
        layers: usize,
    },
    /// Hardly any points lie over the part.
    #[error(
        "only {inside} of the scan's {points} points lie over layer {number}; at least {FEWEST} are needed. Are its \
         coordinates those of the part, in mm?"
    )]
    TooFew {
        /// Points over the layer.
        inside: usize,
        /// All points.
        points: usize,
        /// Number of the layer, from 1.
        number: usize,
    },
    /// Much of what the scan shows lies outside the part.
    #[error(
        "{percent:.0} % of the scan's points above half the height of layer {number} lie outside the part by more than a bead \
         width: the scan has other coordinates, or it is of another part."
    )]
    Beside {
        /// Share of these points, %.
        percent: f64,
        /// Number of the layer, from 1.
        number: usize,
    },
    /// An impossible height.
    #[error(
        "the scan is {measured:.2} mm high on average, but the plan {planned:.2} mm after layer {number}: more than {bound:.2} \
         mm apart. The plan is that high after layer {nearest}. Check the number of the layer, and that z is 0 on the plate."
    )]
    Height {
        /// Mean height of the scan over the layer, mm.
        measured: f64,
        /// Planned top, mm.
        planned: f64,
        /// Number of the layer, from 1.
        number: usize,
        /// Greatest difference that is believed, mm.
        bound: f64,
        /// Number of the layer that is nearest in height.
        nearest: usize,
    },
    /// Not the shape of the layer.
    #[error(
        "the scan's heights over layer {number} deviate by {deviation:.2} mm from their mean, more than {bound:.2} mm: the \
         scan is turned or shifted relative to the part, or it is of another part."
    )]
    Uneven {
        /// Standard deviation, mm.
        deviation: f64,
        /// Greatest deviation that is believed, mm.
        bound: f64,
        /// Number of the layer, from 1.
        number: usize,
    },
}

/// Compares a scan (mm, in the part's coordinates) with the plan after layer `number`, counted from 1.
///
/// # Errors
/// [`SeeError`] for a scan that cannot be of this plan.
pub fn see(planned: &[Layer], number: usize, points: &[DVec3], nominal: Nominal) -> Result<Seen, SeeError> {
    let layers = planned.len();
    let none = SeeError::NoLayer { number, layers };
    let layer = number.checked_sub(1).and_then(|index| planned.get(index)).ok_or(none)?;
    let mut surface = Surface::plate(planned, nominal);
    beside(&planned[..number], points, &surface, nominal)?;
    let (predicted, core) = predicted(&surface, layer, nominal.bead.width);
    let cells = cells(points, &surface, &core, layer.z, &predicted);
    let inside = cells.iter().map(|cell| cell.points).sum();
    if inside < FEWEST {
        return Err(SeeError::TooFew { inside, points: points.len(), number });
    }
    let measured = Spread::of(cells.iter().map(|cell| cell.error));
    believable(planned, number, &measured)?;
    let (errors, covered) = filled(&surface, &cells, &core, &predicted, nominal.bead.width);
    surface.measure(number, layer, &errors);
    let error = surface.spread(&core);
    let measured = cells.iter().map(|cell| (cell.at, cell.error)).collect();
    Ok(Seen { surface, core, predicted, measured, error, points: inside, covered })
}

/// Predicted height above the layer's top for each point with metal, mm, and the points at which heights are compared.
fn predicted(surface: &Surface, layer: &Layer, width: f64) -> (Vec<Option<f64>>, Vec<usize>) {
    let mut shape = surface.clone();
    shape.lay(&Layer::default(), layer);
    let mut core = core(surface.grid(), &layer.islands, width);
    let mut heights: Vec<f64> = core.iter().filter_map(|&i| shape.error(i)).collect();
    heights.sort_by(f64::total_cmp);
    let middle = heights.get(heights.len() / 2).copied().unwrap_or_default();
    core.retain(|&i| shape.error(i).is_some_and(|height| (height - middle).abs() <= DOUBTFUL * layer.height));
    let mean = shape.spread(&core).mean;
    let above = |i: usize| shape.error(i).map(|height| height - mean);
    ((0..surface.grid().points()).map(above).collect(), core)
}

/// Refuses a scan that shows much outside the part.
fn beside(built: &[Layer], points: &[DVec3], surface: &Surface, nominal: Nominal) -> Result<(), SeeError> {
    let grid = surface.grid();
    let mut allowed = vec![false; grid.points()];
    for layer in built {
        near(grid, &layer.islands, nominal.bead.width).into_iter().for_each(|i| allowed[i] = true);
    }
    let half = built.last().map_or(0.0, |last| (last.z + surface.level()) / 2.0);
    let tall: Vec<&DVec3> = points.iter().filter(|p| p.z > half).collect();
    let out = tall.iter().filter(|p| grid.nearest(p.truncate()).is_none_or(|i| !allowed[i])).count();
    let part = out as f64 / tall.len().max(1) as f64;
    if part > BESIDE { Err(SeeError::Beside { percent: 100.0 * part, number: built.len() }) } else { Ok(()) }
}

/// A grid point that has scan points near it.
struct Cell {
    at: usize,
    /// The median of their heights, measured minus predicted, mm.
    error: f64,
    points: usize,
}

fn cells(points: &[DVec3], surface: &Surface, core: &[usize], z: f64, predicted: &[Option<f64>]) -> Vec<Cell> {
    let grid = surface.grid();
    let mut within = vec![false; grid.points()];
    core.iter().for_each(|&i| within[i] = true);
    let error = |p: &DVec3| {
        let at = grid.nearest(p.truncate()).filter(|&i| within[i])?;
        Some((at, p.z - z - predicted[at]?))
    };
    let mut errors: Vec<(usize, f64)> = points.iter().filter_map(error).collect();
    errors.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let cell = |same: &[(usize, f64)]| Cell { at: same[0].0, error: same[same.len() / 2].1, points: same.len() };
    errors.chunk_by(|a, b| a.0 == b.0).map(cell).collect()
}

/// Refuses heights that no build of this plan has.
fn believable(planned: &[Layer], number: usize, error: &Spread) -> Result<(), SeeError> {
    let (layer, floor) = (&planned[number - 1], planned[0].z - planned[0].height);
    let thickness = (layer.z - floor) / number as f64;
    let bound = (FARTHEST * (layer.z - floor)).max(FARTHEST_LAYERS * thickness);
    if error.mean.abs() > bound {
        let measured = layer.z + error.mean;
        let away = |layer: &&Layer| (layer.z - measured).abs();
        let nearest = planned.iter().min_by(|a, b| away(a).total_cmp(&away(b))).map_or(number, |layer| layer.index + 1);
        return Err(SeeError::Height { measured, planned: layer.z, number, bound, nearest });
    }
    let (deviation, bound) = (error.moved(-error.mean).rms, UNEVEN * thickness);
    if deviation > bound { Err(SeeError::Uneven { deviation, bound, number }) } else { Ok(()) }
}

/// The error at every point with metal, and the fraction of the core that lies within `reach` (mm) of a measured cell.
fn filled(
    surface: &Surface,
    cells: &[Cell],
    core: &[usize],
    predicted: &[Option<f64>],
    reach: f64,
) -> (Vec<Option<f64>>, f64) {
    let grid = surface.grid();
    let place = |i: usize| grid.place(i % grid.columns, i / grid.columns).to_array();
    let tree = RTree::bulk_load(cells.iter().map(|cell| GeomWithData::new(place(cell.at), cell.error)).collect());
    let stand_in = |i: usize| {
        let (mut sum, mut weights) = (0.0, 0.0);
        for (near, square) in tree.nearest_neighbor_iter_with_distance_2(&place(i)).take(STAND_IN) {
            // Where the cell itself was measured, it outweighs all others.
            let weight = 1.0 / square.max(1e-12);
            (sum, weights) = (sum + weight * near.data, weights + weight);
        }
        sum / weights
    };
    let errors = (0..predicted.len()).map(|i| predicted[i].map(|_| stand_in(i))).collect();
    let known = |i: &&usize| {
        tree.nearest_neighbor_iter_with_distance_2(&place(**i))
            .next()
            .is_some_and(|(_, square)| square <= reach * reach)
    };
    (errors, core.iter().filter(known).count() as f64 / core.len().max(1) as f64)
}
