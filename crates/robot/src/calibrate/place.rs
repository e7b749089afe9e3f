//! A place and an orientation that bring points to where they belong, by Gauss-Newton steps from a first guess.

use super::least_squares::Equations;
use super::{CalibrateError, Residuals};
use glam::{DQuat, DVec3};

/// A place and an orientation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// The origin, mm.
    pub at: DVec3,
    /// Rotation from its directions to those outside.
    pub turn: DQuat,
}

impl Place {
    /// Where a point given in it lies outside, mm.
    pub fn outside(&self, p: DVec3) -> DVec3 {
        self.turn * p + self.at
    }

    /// The coordinates in it of a point outside, mm.
    pub fn inside(&self, p: DVec3) -> DVec3 {
        self.turn.inverse() * (p - self.at)
    }
}

/// A calibrated place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Calibrated {
    /// The place.
    pub place: Place,
    /// Half the widths of the intervals that hold the coordinates of its origin with 95 % probability, mm.
    pub at_within: DVec3,
    /// The same for small turns about its own x, y and z, °.
    pub turn_within: DVec3,
    /// How far each point lies from where it belongs.
    pub residuals: Residuals,
}

/// A measured point: where it is outside, and which of its coordinates inside are known, mm.
#[derive(Debug, Clone, Copy)]
pub(super) struct Known {
    pub(super) outside: DVec3,
    pub(super) inside: [Option<f64>; 3],
}

/// Steps until nothing changes.
const STEPS: usize = 30;
const STILL: f64 = 1e-12;

/// The place near `guess` in which all points have the coordinates that are known of them.
pub(super) fn fitted(guess: Place, points: &[Known], remedy: &'static str) -> Result<Calibrated, CalibrateError> {
    let mut place = guess;
    let step = |place: &mut Place| {
        // A small turn about the own axes changes the coordinates inside by p × turn, a small shift along them by -shift.
        let mut equations = Equations::new(6);
        for point in points {
            let p = place.inside(point.outside);
            for (k, known) in point.inside.iter().enumerate() {
                let Some(known) = known else { continue };
                let e = [DVec3::X, DVec3::Y, DVec3::Z][k];
                let by_turn = e.cross(p);
                let row = [by_turn.x, by_turn.y, by_turn.z, -e.x, -e.y, -e.z];
                equations.add(&row, known - p[k]);
            }
        }
        let solution = equations.solve(remedy)?;
        let three =
            |from: usize| DVec3::new(solution.values[from], solution.values[from + 1], solution.values[from + 2]);
        let (turn, shift) = (three(0), three(3));
        place.at += place.turn * shift;
        place.turn = (place.turn * DQuat::from_scaled_axis(turn)).normalize();
        Ok((solution, turn.length() + shift.length()))
    };
    let (mut solution, mut change) = step(&mut place)?;
    for _ in 0..STEPS {
        if change < STILL {
            break;
        }
        (solution, change) = step(&mut place)?;
    }
    let three = |from: usize| DVec3::new(solution.within[from], solution.within[from + 1], solution.within[from + 2]);
    // The origin's coordinates outside are mixtures of shifts along its own axes.
    let outside = [DVec3::X, DVec3::Y, DVec3::Z].map(|e| {
        let own = place.turn.inverse() * e;
        solution.within_of(&[0.0, 0.0, 0.0, own.x, own.y, own.z])
    });
    let missed = points.iter().map(|point| {
        let p = place.inside(point.outside);
        let off = point.inside.iter().enumerate().filter_map(|(k, known)| known.map(|known| known - p[k]));
        off.map(|off| off * off).sum::<f64>().sqrt()
    });
    Ok(Calibrated {
        place,
        at_within: DVec3::from_array(outside),
        turn_within: three(0).map(f64::to_degrees),
        residuals: Residuals::of(missed, solution.spare),
    })
}
