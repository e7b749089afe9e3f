//! Where the layers of a wall lie: as high as its beads grow (Li et al., section 1.2).
//!
//! A layer rises by h_n cos φ where the wall leans by φ from the build direction. The lean is taken from neighbouring
//! layers, as a mean over each: how far the centre-line or the outline moves sideways on the way up.

use crate::bead::wall::WallBead;
use crate::model::Mesh;
use crate::model::wall_curves::WallCurves;
use crate::plan::MAX_LAYERS;
use crate::profile::Profile;
use crate::slice::{self, Slab, Slice, Slicer};
use crate::task::{Cancelled, Task};
use planar::Region;
use rayon::prelude::*;

/// A wall is not taken to lean more than this, radians (60°): steeper places are shoulders and floors, not walls.
const MOST_LEAN: f64 = std::f64::consts::FRAC_PI_3;

/// The layers of a mesh wall that stands on z = 0.
pub(super) fn of_mesh(mesh: &Mesh, wall: &WallBead, profile: &Profile, task: &Task) -> Result<Vec<Slab>, Cancelled> {
    let (step, top) = (wall.rise(), mesh.bounds().1.z.max(0.0));
    let slabs = slice::even_slabs(mesh, step);
    let slicer = Slicer::of_slabs(mesh, slabs, profile.slice_options(), task)?;
    let mut sideways = Vec::with_capacity(slicer.layer_count());
    let mut below: Option<Slice> = None;
    for batch in 0..slicer.batch_count() {
        let slices: Vec<Slice> = below.take().into_iter().chain(slicer.batch(batch, task)?).collect();
        sideways.par_extend(slices.par_windows(2).map(|pair| offset(&pair[0], &pair[1])));
        below = slices.into_iter().last();
    }
    // Slices lie at (k + ½) · step.
    let lean = |z: f64| {
        let pair = (z / step - 0.5).max(0.0) as usize;
        sideways.get(pair.min(sideways.len().saturating_sub(1))).map_or(0.0, |offset: &f64| (offset / step).atan())
    };
    Ok(stacked(top, wall, lean))
}

/// How far the outline moves sideways between two slices, as a mean over it, mm: the area in one but not in both, over
/// the length of the outline.
fn offset(lower: &Slice, upper: &Slice) -> f64 {
    let [a, b] = [lower, upper].map(|slice| Region::from_normalised(slice.islands.clone()));
    let length = (a.perimeter() + b.perimeter()) / 2.0;
    if length > 0.0 { (a.difference(&b).area() + b.difference(&a).area()) / length } else { 0.0 }
}

/// The layers of a wall of centre-lines.
pub(super) fn of_curves(curves: &WallCurves, height: f64, wall: &WallBead) -> Vec<Slab> {
    let step = wall.rise();
    stacked(height, wall, |z| (curves.offset(z - step / 2.0, z + step / 2.0) / step).atan())
}

/// The first layer is as high as the first bead; each further one rises by h_n cos φ, until the top is nearest.
fn stacked(top: f64, wall: &WallBead, lean: impl Fn(f64) -> f64) -> Vec<Slab> {
    let mut slabs = vec![Slab { z: wall.height(), height: wall.height() }];
    let mut z = wall.height();
    while slabs.len() < MAX_LAYERS {
        let height = wall.rise_leaning(lean(z + wall.rise() / 2.0).min(MOST_LEAN));
        if z + height / 2.0 >= top {
            break;
        }
        z += height;
        slabs.push(Slab { z, height });
    }
    slabs
}
