//! The arm of the robot cell, in its pose with the torch at a place of the plan.

use crate::known::Known;
use crate::view::ViewState;
use crate::view3d::Stance;
use beadwright::robot::body::{Capsule, capsules};
use beadwright::robot::{Cell, Joints, Reach, Stop};

/// A place of the torch: the pass that it lays or comes to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// The layer, from 0.
    pub layer: usize,
    /// The pass in its layer, from 0.
    pub pass: usize,
    /// The torch.
    pub torch: Stance,
}

/// An arm at a place.
#[derive(Debug, Clone, PartialEq)]
pub struct Stand {
    /// Angles of the joints, °.
    pub joints: Joints,
    /// The least distance to a limit or a singularity, °.
    pub margin: f64,
    /// Its links and the torch, in the part's space.
    pub links: Vec<Capsule>,
}

/// The pose of the arm with the torch at a place, in the posture that the walk along the program has chosen; none where the
/// arm cannot get there.
pub fn stand(cell: &Cell, reach: &Reach, place: &Place) -> Option<Stand> {
    let key = (place.layer, place.pass);
    let first = reach.poses.partition_point(|(stop, _)| (stop.layer, stop.pass) < key);
    let of_pass = reach.poses[first..].iter().take_while(|(stop, _)| (stop.layer, stop.pass) == key);
    let reached = of_pass.filter_map(|(stop, pose)| Some((stop, pose.as_ref()?)));
    let far = |stop: &Stop| stop.at.distance_squared(place.torch.at);
    let (stop, pose) = reached.min_by(|a, b| far(a.0).total_cmp(&far(b.0)))?;
    let (arm, base_from_part) = (cell.arm(), reach.place.base_from_part());
    let tool = Stop { at: place.torch.at, ..*stop }.tool(pose.torch_angle);
    let flange = base_from_part.then(&tool).then(&cell.flange_from_tool().inverse());
    let ways = arm.inverse(&flange);
    let (_, joints) = ways.into_iter().find(|(branch, _)| *branch == reach.branch)?;
    // Joints that turn further than once are where the program has them.
    let joints: Joints = std::array::from_fn(|i| joints[i] + 360.0 * ((pose.joints[i] - joints[i]) / 360.0).round());
    let part_from_base = stop.turned_table().inverse().then(&base_from_part.inverse());
    let links = cell.body.as_ref().map(|body| {
        let flange_from_tool = cell.flange_from_tool();
        capsules(&arm, body, &flange_from_tool, &joints, &part_from_base)
    });
    Some(Stand { joints, margin: arm.margins(&joints).least(), links: links.unwrap_or_default() })
}

impl Known<'_> {
    /// Where the torch is: as it plays, at the chosen bead, or at the end of what is shown.
    pub(crate) fn torch_place(self, view: &ViewState) -> Option<Place> {
        let scene = &self.plans.own.scene;
        if view.torch.is_some() {
            let now = scene.at_time(view.seconds)?;
            let beads = scene.layer(now.layer)?;
            let pass = beads.pass_of(now.segment.min(beads.len().checked_sub(1)?));
            return Some(Place { layer: now.layer, pass, torch: now.torch });
        }
        if let Some(chosen) = view.chosen.and_then(|chosen| self.pick(chosen)) {
            let beads = scene.layer(chosen.layer)?;
            let segments = beads.segments_of(beads.piece(chosen.segment));
            let bead = beads.beads().get(segments.start.midpoint(segments.end))?;
            return Some(Place { layer: chosen.layer, pass: chosen.pass, torch: bead.torch(0.5) });
        }
        let layer = view.last;
        let beads = scene.layer(layer)?;
        let shown = (view.progress * beads.len() as f64).round() as usize;
        let bead = beads.beads().get(shown.max(1) - 1)?;
        Some(Place { layer, pass: beads.pass_of(shown.max(1) - 1), torch: bead.torch(1.0) })
    }

    /// The pose of the arm there; none where it is not shown, not yet computed, or cannot get there.
    pub(crate) fn arm(self, view: &ViewState) -> Option<Stand> {
        let (cell, reach) = (self.jobs.cell.as_ref()?, self.jobs.reach.as_ref()?);
        stand(cell, reach, &self.torch_place(view)?).filter(|_| view.robot)
    }
}
