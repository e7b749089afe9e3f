//! How long a machine takes along a path: it speeds up, and slows down before corners.
//!
//! Along every piece of a path the speed over time is a trapezoid: up with the acceleration, along at the wanted speed,
//! down again. At a corner the velocity may jump by at most the corner speed, so sharp corners are passed slowly and
//! straight joints at full speed; a path begins and ends at rest. Without these values, as for robots whose controllers
//! hold the speed, the time is length over speed.

use crate::limit::{Limit, limits};
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// How fast a machine speeds up and turns.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Motion {
    /// Acceleration along the path, mm/s².
    pub acceleration: f64,
    /// Largest jump of the velocity at a corner, mm/s.
    pub corner_speed: f64,
}

/// A straight piece that is to be run.
#[derive(Debug, Clone, Copy)]
struct Piece {
    way: DVec3,
    length: f64,
    speed: f64,
}

impl Motion {
    /// Limits of the values.
    pub fn limits(&self) -> Vec<Limit> {
        limits! {
            "motion.acceleration": self.acceleration, 1.0, 1e6, "mm/s²",
                "a machine that hardly speeds up never gets there";
            "motion.corner_speed": self.corner_speed, 0.01, 1000.0, "mm/s",
                "a machine that stops at every corner needs no corner speed";
        }
    }

    /// Time along a path from rest to rest, s: from a point to each of the others at its speed (mm, mm/s).
    ///
    /// ```
    /// use bead_plan::motion::Motion;
    /// use glam::DVec3;
    ///
    /// // 100 mm at 10 mm/s; speeding up and slowing down cost a tenth of a second together.
    /// let machine = Motion { acceleration: 100.0, corner_speed: 5.0 };
    /// let seconds = machine.seconds(DVec3::ZERO, [(DVec3::X * 100.0, 10.0)]);
    /// assert!((seconds - (100.0 / 10.0 + 10.0 / 100.0)).abs() < 1e-9);
    /// ```
    pub fn seconds(&self, from: DVec3, moves: impl IntoIterator<Item = (DVec3, f64)>) -> f64 {
        let mut at = from;
        let piece = |(to, speed): (DVec3, f64)| {
            let (way, length) = (to - at, at.distance(to));
            at = to;
            Piece { way: way / length, length, speed }
        };
        let pieces: Vec<Piece> = moves.into_iter().map(piece).filter(|p| p.length > 0.0 && p.speed > 0.0).collect();
        let speeds = self.joint_speeds(&pieces);
        pieces.iter().zip(speeds.windows(2)).map(|(piece, ends)| self.trapezoid(piece, ends[0], ends[1])).sum()
    }

    /// Speed at the beginning of each piece and at the end of the last, mm/s: what the corners allow, what can be
    /// reached from the joint before, and what can be slowed down from before the joint after.
    fn joint_speeds(&self, pieces: &[Piece]) -> Vec<f64> {
        let corner = |w: &[Piece]| {
            let jump = (w[1].way - w[0].way).length();
            w[0].speed.min(w[1].speed).min(self.corner_speed / jump.max(1e-9))
        };
        let mut speeds: Vec<f64> = [0.0].into_iter().chain(pieces.windows(2).map(corner)).chain([0.0]).collect();
        let reachable = |speed: f64, length: f64| (speed * speed + 2.0 * self.acceleration * length).sqrt();
        for (i, piece) in pieces.iter().enumerate() {
            speeds[i + 1] = speeds[i + 1].min(reachable(speeds[i], piece.length));
        }
        for (i, piece) in pieces.iter().enumerate().rev() {
            speeds[i] = speeds[i].min(reachable(speeds[i + 1], piece.length));
        }
        speeds
    }

    fn trapezoid(&self, piece: &Piece, first: f64, last: f64) -> f64 {
        let a = self.acceleration;
        // The peak speed if the piece were ramps only.
        let peak = ((2.0 * a * piece.length + first * first + last * last) / 2.0).sqrt();
        let top = peak.min(piece.speed).max(first).max(last);
        let ramps = (2.0 * top * top - first * first - last * last) / (2.0 * a);
        (2.0 * top - first - last) / a + (piece.length - ramps).max(0.0) / top
    }
}
