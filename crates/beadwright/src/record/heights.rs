//! Heights along the passes of a layer, from a scan of it.

use super::{Heights, PlannedPass};
use crate::adapt::{AdaptError, see};
use crate::layer::Layer;
use crate::plan;
use crate::profile::Profile;
use glam::{DVec2, DVec3};
use rstar::RTree;
use rstar::primitives::GeomWithData;

/// Distance between places along a pass, and how far from its middle a scan counts, in bead widths.
const STEP: f64 = 0.5;
const REACH: f64 = 0.5;

/// How far the tops of the passes of a layer lie from where the plan puts them: measured minus predicted by the deposit model, the mean
/// over half a bead width about each place. Places that the scan does not show, and the ends of beads, where the model itself predicts a
/// hump or a hollow, are left out. `points` are those of a scan after layer `number`, from 1, in the part's coordinates, mm.
///
/// # Errors
/// [`AdaptError`] for layers that are not level, and for a scan that cannot be of this layer.
pub fn heights(
    layers: &[Layer],
    profile: &Profile,
    passes: &[PlannedPass],
    points: &[DVec3],
    number: usize,
) -> Result<Vec<Heights>, AdaptError> {
    if !profile.layers.are_level() {
        return Err(AdaptError::NotLevel);
    }
    let seen = see(layers, number, points, plan::deposit_settings(profile).nominal)?;
    let cells = seen.measured.into_iter().map(|(at, off)| GeomWithData::new(at.to_array(), off)).collect();
    let (tree, width) = (RTree::bulk_load(cells), profile.bead.width);
    let off = |at: DVec2| {
        let near = tree.locate_within_distance(at.to_array(), (REACH * width).powi(2));
        let (sum, count) = near.fold((0.0, 0), |(sum, count), cell| (sum + cell.data, count + 1));
        (count > 0).then(|| sum / f64::from(count))
    };
    let step = STEP * width;
    let along = |(index, pass): (usize, &PlannedPass)| {
        let places = (0..=(pass.length() / step) as usize).map(|k| k as f64 * step);
        let places = places.filter_map(|along| Some([along, off(pass.at(along).1.at.truncate())?]));
        Heights { pass: index, step, places: places.collect() }
    };
    let of_layer = passes.iter().enumerate().filter(|(_, pass)| pass.layer == number);
    Ok(of_layer.map(along).filter(|heights| !heights.places.is_empty()).collect())
}
