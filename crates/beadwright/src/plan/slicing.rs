//! How a part is cut into layers, and what an open surface then stands for.

use super::PlanError;
use crate::chart::Chart;
use crate::model::holes::{self, Opening};
use crate::model::{Mesh, NO_NEIGHBOUR};
use crate::slice::{Slab, SliceOptions, Slicer, Surface};
use crate::task::{Cancelled, Task};

/// How a part is cut into layers.
#[derive(Debug, Clone, Copy)]
pub(super) struct Slicing<'p> {
    pub(super) options: SliceOptions,
    /// How its layers lie in space.
    pub(super) chart: &'p Chart,
    /// Greatest thickness of a bead where that of a layer varies, mm.
    pub(super) thickest: f64,
    /// What an open surface stands for, if that is known.
    pub(super) surface: Option<Surface>,
    /// Width of the nominal bead, mm: wider openings are no flaws of the model.
    pub(super) bead_width: f64,
}

impl<'p> Slicing<'p> {
    /// Cuts a mesh, given in the coordinates of its chart, at some layers.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub(super) fn slicer<'m>(&self, mesh: &'m Mesh, slabs: Vec<Slab>, task: &Task) -> Result<Slicer<'m>, Cancelled>
    where
        'p: 'm,
    {
        Ok(Slicer::of_slabs(mesh, slabs, self.options, task)?.on(self.chart))
    }

    /// The same for layers that are to be filled, none of which is thicker than a bead can be.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub(super) fn filled<'m>(&self, mesh: &'m Mesh, slabs: Vec<Slab>, task: &Task) -> Result<Slicer<'m>, Cancelled>
    where
        'p: 'm,
    {
        Ok(self.slicer(mesh, slabs, task)?.no_thicker_than(self.thickest))
    }

    /// Whether a mesh is an open surface along which one bead is laid.
    pub(super) fn is_wall(&self, mesh: &Mesh) -> bool {
        self.surface == Some(Surface::Wall) && mesh.neighbours.iter().flatten().any(|&across| across == NO_NEIGHBOUR)
    }

    /// Whether a mesh has an opening wider than a bead.
    pub(super) fn is_open(&self, mesh: &Mesh) -> bool {
        holes::openings(mesh).first().is_some_and(|opening| opening.width > self.bead_width)
    }

    /// Refuses a surface that is not closed, unless it is said to be the skin of a solid.
    ///
    /// # Errors
    /// [`PlanError::Open`].
    pub(super) fn closed<E>(&self, mesh: &Mesh) -> Result<(), PlanError<E>> {
        let opening = holes::openings(mesh).into_iter().next();
        match opening.filter(|opening| opening.width > self.bead_width) {
            Some(Opening { width, place, .. }) if self.surface != Some(Surface::Solid) => {
                Err(PlanError::Open { width, place })
            }
            _ => Ok(()),
        }
    }
}
