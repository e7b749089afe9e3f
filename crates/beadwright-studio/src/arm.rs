//! The arm of the robot cell, in its pose with the torch at a place of the plan.

use crate::holding::{self, Come, Place};
use crate::known::Known;
use crate::machine;
use crate::view::ViewState;
use crate::view3d::{BELOW, Floor, LayerBeads, Shape};
use beadwright::program::Held;
use beadwright::robot::body::{Capsule, Solid, capsules};
use beadwright::robot::{Cell, Frame, Joints, Reach, Stop};

/// The pose of the arm with the torch at a place.
#[derive(Debug, Clone, PartialEq)]
pub struct Stand {
    /// Angles of the joints, °.
    pub joints: Joints,
    /// The least distance to a limit or a singularity, °.
    pub margin: f64,
    /// Its links and the torch, in the part's space.
    pub links: Vec<Capsule>,
    /// How they look, likewise.
    pub shapes: Vec<Shape>,
}

/// The pose of the arm with the torch at a place, in the posture that the program uses there; `None` where the arm
/// cannot get there.
pub fn stand(cell: &Cell, reach: &Reach, place: &Place) -> Option<Stand> {
    let key = (place.layer, place.pass);
    let first = reach.poses.partition_point(|(stop, _)| (stop.layer, stop.pass) < key);
    let of_pass = reach.poses[first..].iter().take_while(|(stop, _)| (stop.layer, stop.pass) == key);
    let reached = of_pass.filter_map(|(stop, pose)| Some((stop, pose.as_ref()?)));
    let far = |stop: &Stop| stop.at.distance_squared(place.torch.at);
    let (stop, pose) = reached.min_by(|a, b| far(a.0).total_cmp(&far(b.0)))?;
    let (arm, base_from_part) = (cell.arm(), reach.place.base_from_part());
    let turned = holding::attitude(&reach.poses, place).filter(|attitude| attitude.held.is_some());
    let stop = Stop { at: place.torch.at, attitude: turned.unwrap_or(stop.attitude), ..*stop };
    let tool = stop.tool(pose.torch_angle);
    let flange = base_from_part.then(&tool).then(&cell.flange_from_tool().inverse());
    let ways = arm.inverse(&flange);
    let (_, joints) = ways.into_iter().find(|(branch, _)| *branch == reach.branch)?;
    // Joints that can turn more than once are put at the angle that the program has for them.
    let joints: Joints = std::array::from_fn(|i| joints[i] + 360.0 * ((pose.joints[i] - joints[i]) / 360.0).round());
    let part_from_base = stop.turned_table().inverse().then(&base_from_part.inverse());
    let links = cell.body.as_ref().map(|body| {
        let flange_from_tool = cell.flange_from_tool();
        capsules(&arm, body, &flange_from_tool, &joints, &part_from_base)
    });
    let links = links.unwrap_or_default();
    let neck = links.iter().filter(|link| link.solid == Solid::Torch).collect::<Vec<_>>();
    let torch = match neck[..] {
        [first, second] => machine::torch([first.ends[0], first.ends[1], second.ends[1]], first.radius),
        _ => Vec::new(),
    };
    let body = machine::arm(cell, &joints).into_iter().map(|shape| shape.moved(&part_from_base));
    let shapes = body.chain(torch).collect();
    Some(Stand { joints, margin: arm.margins(&joints).least(), links, shapes })
}

impl LayerBeads {
    /// The torch at a fraction `part` (0 to 1) of the length of a segment of this layer; `segment` is its index.
    fn place(&self, layer: usize, segment: usize, part: f64) -> Option<Place> {
        let (pass, torch) = (self.pass_of(segment), self.beads().get(segment)?.torch(part));
        Some(Place { layer, pass, come: Come::Along(self.laid(pass, segment, torch.at)), torch })
    }
}

impl Known<'_> {
    /// Where the torch is: as it plays, at the chosen bead, or at the end of the beads shown.
    pub(crate) fn torch_place(self, view: &ViewState) -> Option<Place> {
        let scene = &self.plans.own.scene;
        if view.torch.is_some() {
            let now = scene.at_time(view.seconds)?;
            let laid = || scene.layer(now.layer).map(|beads| beads.laid(now.pass, now.segment, now.torch.at));
            let come = now.come.map(Come::Towards).or_else(|| laid().map(Come::Along))?;
            return Some(Place { layer: now.layer, pass: now.pass, come, torch: now.torch });
        }
        if let Some(chosen) = view.chosen.and_then(|chosen| self.pick(chosen)) {
            let beads = scene.layer(chosen.layer)?;
            let segments = beads.segments_of(beads.piece(chosen.segment));
            let segment = segments.start.midpoint(segments.end);
            return beads.place(chosen.layer, segment, 0.5);
        }
        let layer = view.last;
        let beads = scene.layer(layer)?;
        let shown = (view.progress * beads.len() as f64).round() as usize;
        beads.place(layer, shown.max(1) - 1, 1.0)
    }

    /// How the part is held there; `None` where nothing turns it, or the robot is not shown.
    pub(crate) fn held(self, view: &ViewState) -> Option<Held> {
        let reach = self.jobs.reach.as_ref().filter(|_| view.robot)?;
        holding::held(&reach.poses, &self.torch_place(view)?)
    }

    /// The pose of the arm there; `None` where it is not shown, not yet computed, or cannot get there.
    pub(crate) fn arm(self, view: &ViewState) -> Option<Stand> {
        let (cell, reach) = (self.jobs.cell.as_ref()?, self.jobs.reach.as_ref()?);
        stand(cell, reach, &self.torch_place(view)?).filter(|_| view.robot)
    }

    /// What stands around the part, and the floor, where the robot is shown; `arm` is its pose.
    pub(crate) fn machine(self, view: &ViewState, arm: Option<&Stand>) -> (Vec<Shape>, Option<Floor>) {
        let shown = self.jobs.cell.as_ref().zip(self.jobs.reach.as_ref()).filter(|_| view.robot);
        let Some((cell, reach)) = shown else { return Default::default() };
        let (held, base_from_part) = (self.held(view), reach.place.base_from_part());
        let part_from_cell = held.map_or(Frame::IDENTITY, Frame::from).inverse();
        let floor = machine::floor(cell, &part_from_cell.then(&base_from_part.inverse()));
        let own = &self.plans.own;
        let positioner = own.profile.as_ref().and_then(|profile| profile.program.positioner.as_ref());
        let below = self.plate().map_or(0.0, |plate| plate.thickness) + f64::from(BELOW);
        let height = base_from_part.position.z;
        let (low, high) = own.part.as_ref().map_or_else(Default::default, |part| part.bounds());
        let radius = low.truncate().abs().max(high.truncate().abs()).length();
        let carrier = match positioner.zip(held.as_ref()) {
            Some((positioner, held)) => machine::positioner(positioner, held, [below, height, radius]),
            None => machine::table(cell, below, height, held.is_some() || cell.table.is_some()),
        };
        (carrier.into_iter().chain(arm.into_iter().flat_map(|arm| arm.shapes.clone())).collect(), Some(floor))
    }
}
