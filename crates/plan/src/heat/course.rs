//! Where the heat of a build lies, over its time.

use super::body::Body;
use glam::DVec3;

/// Heat and metal of a body at some time.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Moment {
    /// Time since the beginning, s.
    pub time: f64,
    /// Heat of all metal that is warmer than its surroundings, J.
    pub heat: f64,
    /// Middle of this heat, mm; that of the metal while there is none.
    pub hot: DVec3,
    /// Middle of all metal by volume, plate included, mm.
    pub middle: DVec3,
}

/// The moments of a build, no closer together than asked for.
#[derive(Debug, Clone)]
pub(super) struct Watch {
    /// Least time between two moments, s.
    pub(super) every: f64,
    pub(super) moments: Vec<Moment>,
}

impl Watch {
    /// Notes the state of a body at a time, if one is due.
    pub(super) fn note(&mut self, body: &Body, time: f64) {
        if self.moments.last().is_none_or(|last| time >= last.time + self.every) {
            self.moments.push(body.moment(time));
        }
    }
}

impl Body {
    /// Where heat and metal are now, at `time` (s).
    pub fn moment(&self, time: f64) -> Moment {
        let (mut volume, mut metal, mut heat, mut hot) = (0.0, DVec3::ZERO, 0.0, DVec3::ZERO);
        for voxel in (0..self.capacity.len()).filter(|&voxel| self.capacity[voxel] > 0.0) {
            let (at, own) = (self.grid.middle(voxel), self.metal(voxel));
            let warm = self.theta[voxel].max(0.0) * self.capacity[voxel];
            (volume, metal) = (volume + own, metal + own * at);
            (heat, hot) = (heat + warm, hot + warm * at);
        }
        let middle = if volume > 0.0 { metal / volume } else { DVec3::ZERO };
        Moment { time, heat, hot: if heat > 0.0 { hot / heat } else { middle }, middle }
    }
}
