//! The closed forms, joint by joint, using quantities that the unknown joints do not change. Angles in rad.
//!
//! Turns about parallel axes do not change a point's height along them: that gives joint 1 from the centre of the
//! wrist. Upper arm and forearm are then two links in a plane, and the wrist's angles follow from directions alone
//! (subproblems of Paden 1986 and Kahan).

use super::turn::{Wave, across, turn_onto, turned};
use super::{Chain, Wrist};
use crate::arm::Frame;
use glam::DVec3;

/// The required end of the forearm, given joint 1 and, with an offset wrist, joints 5 and 6.
struct Wanted {
    q1: f64,
    /// Joints 5 and 6, if already known.
    hand: Option<[f64; 2]>,
    /// The transform required of joints 2, 3 and 4, and of those of the hand that are unknown.
    rest: Frame,
    /// The required end of the forearm.
    end: DVec3,
}

impl Chain {
    /// All solutions, for a chain whose axes are exactly parallel and meet exactly; approximate ones for others.
    pub(super) fn closed_forms(&self, base_from_flange: &Frame) -> Vec<[f64; 6]> {
        let mut found = Vec::with_capacity(8);
        for wanted in self.wanted(base_from_flange).0 {
            for [q2, q3] in self.elbows(wanted.end) {
                let lower = self.axes[1].turn(q2).then(&self.axes[2].turn(q3));
                let left = lower.inverse().then(&wanted.rest);
                found
                    .extend(self.hands(&wanted, &left).into_iter().map(|[q4, q5, q6]| [wanted.q1, q2, q3, q4, q5, q6]));
            }
        }
        found
    }

    /// Distance by which the required end of the forearm is out of reach of the two links, mm.
    pub(super) fn closed_miss(&self, base_from_flange: &Frame) -> f64 {
        let (wanted, beside) = self.wanted(base_from_flange);
        let [upper, fore] = self.links_across(0.0).map(DVec3::length);
        let miss = |wanted: &Wanted| {
            let distance = across(self.axes[1].along, wanted.end - self.axes[1].at).length();
            (distance - upper - fore).max((upper - fore).abs() - distance).max(0.0)
        };
        wanted.iter().map(miss).min_by(f64::total_cmp).unwrap_or(beside)
    }

    /// Where the forearm may end, and the distance by which the wrist is too near to axis 1 for any solution, mm.
    fn wanted(&self, base_from_flange: &Frame) -> (Vec<Wanted>, f64) {
        let [one, two, ..] = self.axes;
        let all = base_from_flange.then(&self.flange.inverse());
        let height = two.along.dot(self.centre - one.at);
        let shoulder = Wave::new(-one.along, all.apply(self.centre) - one.at, two.along, height);
        let after = |q1: f64| {
            let rest = one.turn(-q1).then(&all);
            match self.wrist {
                Wrist::Spherical => vec![Wanted { q1, hand: None, rest, end: rest.apply(self.centre) }],
                Wrist::Offset => self.offset_hands(q1, &rest),
            }
        };
        (shoulder.angles().into_iter().flat_map(after).collect(), shoulder.excess())
    }

    /// Joints 5 and 6 of an offset wrist: the angle between axes 4 and 6 is given, because joints 2 to 4 do not change
    /// the direction of axis 4.
    fn offset_hands(&self, q1: f64, rest: &Frame) -> Vec<Wanted> {
        let [.., four, five, six] = self.axes;
        let angles = Wave::new(five.along, six.along, four.along, four.along.dot(rest.rotation * six.along)).angles();
        let hand = |q5: f64| {
            let seen = turned(five.along, -q5, four.along);
            let q6 = turn_onto(-six.along, seen, rest.rotation.conjugate() * four.along);
            let rest = rest.then(&six.turn(-q6)).then(&five.turn(-q5));
            Wanted { q1, hand: Some([q5, q6]), rest, end: rest.apply(four.at) }
        };
        angles.into_iter().map(hand).collect()
    }

    /// Joints 2 and 3 that bring the end of the forearm to a point.
    fn elbows(&self, end: DVec3) -> Vec<[f64; 2]> {
        let [_, two, three, ..] = self.axes;
        let wanted = across(two.along, end - two.at);
        let [upper, fore] = self.links_across(0.0);
        // |upper + fore|² must be |wanted|².
        let height = (wanted.length_squared() - upper.length_squared() - fore.length_squared()) / 2.0;
        let both = |q3: f64| {
            let [upper, fore] = self.links_across(q3);
            [turn_onto(two.along, upper + fore, wanted), q3]
        };
        Wave::new(three.along, fore, upper, height).angles().into_iter().map(both).collect()
    }

    /// Joints 4, 5 and 6 that supply the rest.
    fn hands(&self, wanted: &Wanted, left: &Frame) -> Vec<[f64; 3]> {
        let [.., four, five, six] = self.axes.map(|axis| axis.along);
        if let Some([q5, q6]) = wanted.hand {
            return vec![[turn_onto(four, five, left.rotation * five), q5, q6]];
        }
        let tip = left.rotation * six;
        let hand = |q5: f64| {
            let q4 = turn_onto(four, turned(five, q5, six), tip);
            let back = |v: DVec3| turned(five, -q5, turned(four, -q4, v));
            [q4, q5, turn_onto(six, five, back(left.rotation * five))]
        };
        Wave::new(five, six, four, four.dot(tip)).angles().into_iter().map(hand).collect()
    }
}
