//! How fast the torch goes where no metal is laid, so that the view's clock runs like the program.

use beadwright::motion::Motion;
use beadwright::pass::Pass;
use beadwright::profile::Profile;
use glam::DVec3;

/// What the time of a layer depends on besides its passes; as [`beadwright::metrics`] counts it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pace {
    /// Speed without arc, mm/s.
    pub travel_speed: f64,
    /// Height of a travel above the higher of its ends, mm.
    pub clearance: f64,
    /// Wait before the torch moves with the arc on, s.
    pub before: f64,
    /// Wait before the torch leaves, s.
    pub after: f64,
    /// How the machine speeds up, where the profile says it.
    pub motion: Option<Motion>,
}

impl Pace {
    /// The pace of a profile's programs.
    pub fn of(profile: &Profile) -> Self {
        let process = &profile.process;
        Self {
            travel_speed: profile.travel.speed,
            clearance: profile.travel.clearance,
            before: process.gas_preflow + process.arc_start_delay,
            after: process.arc_end_delay + process.gas_postflow,
            motion: profile.motion,
        }
    }

    /// Time of a travel, s; its legs begin and end at rest.
    pub(super) fn travel_seconds(&self, legs: &[DVec3; 4]) -> f64 {
        legs.windows(2).map(|leg| self.leg_seconds(leg[0], leg[1])).sum()
    }

    fn leg_seconds(&self, from: DVec3, to: DVec3) -> f64 {
        let even = from.distance(to) / self.travel_speed;
        self.motion.map_or(even, |motion| motion.seconds(from, [(to, self.travel_speed)]))
    }

    /// By how much longer a pass takes than length over speed: the acceleration is spread evenly along it.
    pub(super) fn stretch(&self, pass: &Pass) -> f64 {
        let (Some(motion), Some(start)) = (self.motion, pass.start()) else { return 1.0 };
        let moving = motion.seconds(start, pass.segments().map(|s| (s.to, s.speed)));
        let even = pass.seconds();
        if even > 0.0 { moving / even } else { 1.0 }
    }
}

/// The corners of a move without arc: up to the clearance above the higher end, across, and down.
pub(super) fn travel_legs(from: DVec3, to: DVec3, clearance: f64) -> [DVec3; 4] {
    let top = from.z.max(to.z) + clearance;
    [from, from.with_z(top), to.with_z(top), to]
}

/// The point at a part (0 to 1) of the length of a polyline.
pub(super) fn along(points: &[DVec3], part: f64) -> Option<DVec3> {
    let length: f64 = points.windows(2).map(|w| w[0].distance(w[1])).sum();
    let mut left = length * part.clamp(0.0, 1.0);
    for leg in points.windows(2) {
        let here = leg[0].distance(leg[1]);
        if left <= here && here > 0.0 {
            return Some(leg[0].lerp(leg[1], left / here));
        }
        left -= here;
    }
    points.last().copied()
}
