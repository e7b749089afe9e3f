//! Whether there is metal everywhere in the part that is milled from a preform.

use super::cover::path;
use crate::fill::Path;
use crate::fill::coverage::{Bare, Coverage};
use crate::layer::Layer;
use crate::model::Mesh;
use crate::slice::{Slab, SliceOptions, Slicer};
use crate::task::{Cancelled, Task};
use crate::warning::{Warning, WarningKind};
use planar::{Join, Region};

/// The part in a preform, cut by the layers of the preform.
pub(super) struct Milled<'a> {
    /// Cuts just inside the bottom and the top of each layer.
    ends: [Slicer<'a>; 2],
}

/// A layer is cut this far inside its bottom and top, as a fraction of its thickness.
const INSIDE: f64 = 1e-3;

/// Missing metal is reported when it is more than this, in squared bead widths.
const WORTH_REPORTING: f64 = 0.02;

impl<'a> Milled<'a> {
    /// The part, placed in its preform, which has these layers.
    ///
    /// # Errors
    /// [`Cancelled`] when the task was.
    pub(super) fn new(part: &'a Mesh, slabs: &[Slab], options: SliceOptions, task: &Task) -> Result<Self, Cancelled> {
        let cut = |at: f64| {
            let slab = |slab: &Slab| {
                let (z, height) = (slab.z - slab.height * (1.0 - at), INSIDE * slab.height);
                Slab { z: z + height / 2.0, height }
            };
            Slicer::of_slabs(part, slabs.iter().map(slab).collect(), options, task)
        };
        Ok(Self { ends: [cut(INSIDE)?, cut(1.0 - INSIDE)?] })
    }

    /// The part within each layer of a batch.
    ///
    /// # Errors
    /// [`Cancelled`] when the task was.
    pub(super) fn batch(&self, batch: usize, task: &Task) -> Result<Vec<Region>, Cancelled> {
        let [low, high] = &self.ends;
        let [low, high] = [low.batch(batch, task)?, high.batch(batch, task)?];
        let both = low.into_iter().zip(high);
        Ok(both
            .map(|(low, high)| {
                let [low, high] = [low, high].map(|slice| Region::from_normalised(slice.islands));
                if low == high { low } else { low.union(&high) }
            })
            .collect())
    }
}

/// The area of the part's faces in a layer that no bead covers; `width` (mm) is that of the nominal bead.
pub(super) fn undersize(layer: &Layer, part: &Region, width: f64) -> Option<Warning> {
    let paths: Vec<Path> = layer.passes.iter().map(path).collect();
    let paths: Vec<&Path> = paths.iter().collect();
    let whole = Region::from_normalised(layer.islands.clone()).union(part);
    let faces = part.difference(&part.offset(-width / 2.0, Join::ROUND));
    let Bare { area: size, place } = Coverage::of(&paths, &whole, width)?.bare_of(&faces);
    let kind = WarningKind::Undersize;
    (size > WORTH_REPORTING * width * width).then_some(Warning { kind, layer: layer.index, place, size })
}
