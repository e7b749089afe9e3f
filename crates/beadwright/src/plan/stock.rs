//! Turns a part into its preform, which is planned instead.

use super::slicing::Slicing;
use super::{PlanError, TORN};
use crate::model::{Import, Mesh, Milled, Part};
use crate::preform::Preform;
use crate::preform::faces;
use crate::preform::figures::Figures;
use crate::profile::Profile;
use crate::slice::{Slice, Slicer};
use crate::task::{Cancelled, Task};
use crate::warning::WarningKind;
use std::convert::Infallible;

/// A part plus the stock that is milled off afterwards.
#[derive(Debug, Clone, PartialEq)]
pub struct Stocked {
    /// The preform, to be planned; it holds the part that is milled from it ([`Import::milled`]).
    pub part: Part,
    /// The steps from which it is made.
    pub preform: Preform,
    /// Its mass, time and cost.
    pub figures: Figures,
}

impl Stocked {
    /// The preform of a solid by a profile.
    ///
    /// ```
    /// use beadwright::plan::{plan, stock::Stocked};
    /// use beadwright::{Profile, Task, example, model::{Model, Placement}};
    ///
    /// let profile = Profile::built_in("cmt-al2319-kuka")?;
    /// let cross = Model::read(&example::find("cross").ok_or("no such example")?.stl(), &Task::new())?;
    /// let cross = cross.place(&Placement::default(), None, profile.bead.width)?;
    /// let Stocked { part, figures, .. } = Stocked::of(cross, &profile, &Task::new())?;
    /// assert!(figures.preform_kg > figures.part_kg);
    /// let plan = plan("cross", &part, &profile, &Task::new())?;
    /// assert!(plan.summary.forbidden.is_empty());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`PlanError::NoSolid`] for curves, [`PlanError::PreformOfChart`] for layers that are not level, [`PlanError::Open`] for a
    /// surface that is not closed, unless the profile says that it is the skin of a solid, [`PlanError::Empty`] where no contour closes, and
    /// [`PlanError::Cancelled`].
    pub fn of(part: Part, profile: &Profile, task: &Task) -> Result<Self, PlanError<Infallible>> {
        let Part::Mesh(mut import) = part else { return Err(PlanError::NoSolid) };
        if !profile.layers.are_level() {
            return Err(PlanError::PreformOfChart);
        }
        let slicing = Slicing::of(profile);
        slicing.closed(&import.mesh)?;
        import.notes.extend(lost(&import.mesh, &slicing, task)?);
        let settings = profile.preform_settings();
        let preform = Preform::of(&import.mesh, &settings, task)?;
        let solid = preform.mesh();
        if solid.triangles.is_empty() {
            return Err(PlanError::Empty(EMPTY.to_owned()));
        }
        let figures = Figures::of(&import.mesh, &preform, &settings, &profile.preform_rates());
        let mut mesh = std::mem::replace(&mut import.mesh, solid);
        mesh.vertices.iter_mut().for_each(|vertex| vertex.z += preform.lift);
        let milled = Milled { stock: faces::stock(&mesh, &preform, settings.plate), mesh };
        Ok(Self { part: Part::Mesh(Import { milled: Some(Box::new(milled)), ..import }), preform, figures })
    }
}

/// What an open surface loses where its contours do not close, as a sentence.
fn lost(mesh: &Mesh, slicing: &Slicing, task: &Task) -> Result<Option<String>, Cancelled> {
    if !slicing.is_open(mesh) {
        return Ok(None);
    }
    let slices = Slicer::new(mesh, slicing.options, task)?.all(task)?;
    let dropped = |slice: &Slice| {
        let dropped = slice.warnings.iter().filter(|warning| warning.kind == WarningKind::OpenContourDropped);
        let longest = dropped.max_by(|a, b| a.size.total_cmp(&b.size))?;
        Some((longest.size, longest.place.extend(slice.z - slice.height / 2.0)))
    };
    let longest = slices.iter().filter_map(dropped).max_by(|a, b| a.0.total_cmp(&b.0));
    Ok(longest.filter(|(length, _)| *length > TORN * slicing.bead_width).map(|(length, at)| {
        format!(
            "The preform lacks part of the solid: as it stands, contours of its open surface do not close and are \
             left out, the longest {length:.0} mm near x {:.1} y {:.1} z {:.1} mm. Turn the part so that it stands on \
             its opening, or mend the model.",
            at.x, at.y, at.z
        )
    }))
}

const EMPTY: &str = "no slice of the part has a closed contour, so it has no preform. The skin of a solid that is open at one end has \
                     closed contours only where it stands on that end: turn it.";

/// Refuses a surface that is not closed, unless the profile says that it is the skin of a solid.
///
/// # Errors
/// [`PlanError::Open`].
pub fn is_closed<E>(mesh: &Mesh, profile: &Profile) -> Result<(), PlanError<E>> {
    Slicing::of(profile).closed(mesh)
}
