//! The box around the welded bodies, which the torch avoids on its way from one to another.

use bead_part::chart::At;
use glam::DVec3;

/// The box around all points added so far; empty at first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Room {
    low: DVec3,
    high: DVec3,
}

impl Default for Room {
    fn default() -> Self {
        Self { low: DVec3::INFINITY, high: DVec3::NEG_INFINITY }
    }
}

impl Room {
    /// Adds a point, mm.
    pub(super) fn add(&mut self, p: DVec3) {
        (self.low, self.high) = (self.low.min(p), self.high.max(p));
    }

    /// How far the torch moves out along the normal of a point until it is `clearance` (mm) outside the box, mm; at
    /// least that clearance.
    pub(super) fn out(&self, at: &At, clearance: f64) -> f64 {
        let (low, high) = (self.low - clearance, self.high + clearance);
        if (low.cmpgt(at.place) | high.cmplt(at.place)).any() {
            return clearance;
        }
        let face = DVec3::select(at.normal.cmpgt(DVec3::ZERO), high, low);
        let ways = ((face - at.place) / at.normal).to_array();
        ways.into_iter().filter(|way| way.is_finite()).fold(f64::INFINITY, f64::min).max(clearance)
    }

    /// The path between two points outside the box: up at its side, across above it, and down.
    pub(super) fn around(&self, from: DVec3, to: DVec3, clearance: f64) -> Vec<DVec3> {
        let top = (self.high.z + clearance).max(from.z).max(to.z);
        let [aside, beside] = [from, to].map(|p| self.aside(p, clearance));
        let mut legs = vec![from, aside, aside.with_z(top), beside.with_z(top), beside, to];
        legs.dedup();
        legs.split_off(1)
    }

    /// A point from which the path straight up is free.
    fn aside(&self, p: DVec3, clearance: f64) -> DVec3 {
        let (low, high) = (self.low - clearance, self.high + clearance);
        let is_under = p.z < high.z && (p.cmpgt(low) & p.cmplt(high)).bitmask() & 0b11 == 0b11;
        if !is_under {
            return p;
        }
        let ways = [
            (p.x - low.x, p.with_x(low.x)),
            (high.x - p.x, p.with_x(high.x)),
            (p.y - low.y, p.with_y(low.y)),
            (high.y - p.y, p.with_y(high.y)),
        ];
        ways.into_iter().min_by(|a, b| a.0.total_cmp(&b.0)).map_or(p, |(_, aside)| aside)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn room() -> Room {
        let mut room = Room::default();
        [DVec3::ZERO, DVec3::new(100.0, 60.0, 40.0)].into_iter().for_each(|p| room.add(p));
        room
    }

    fn at(place: DVec3, normal: DVec3) -> At {
        At { place, along: [DVec3::X, DVec3::Y], normal }
    }

    #[test]
    fn the_way_out_ends_on_the_first_face_that_it_meets() {
        let place = DVec3::new(90.0, 30.0, 20.0);
        assert_eq!(room().out(&at(place, DVec3::X), 5.0), 15.0);
        assert_eq!(room().out(&at(place, DVec3::Z), 5.0), 25.0);
        let slanted = room().out(&at(place, DVec3::new(0.6, 0.0, 0.8)), 5.0);
        assert!((slanted - 25.0).abs() < 1e-9);
        assert_eq!(room().out(&at(place.with_z(200.0), DVec3::NEG_Z), 5.0), 5.0);
    }

    #[test]
    fn no_leg_enters_the_room() {
        let places =
            [[-5.0, 30.0, 20.0], [105.0, 10.0, 0.0], [50.0, 30.0, -5.0], [20.0, 20.0, 45.0], [50.0, 65.0, 39.0]];
        let places = places.map(DVec3::from_array);
        for (from, to) in places.into_iter().flat_map(|from| places.map(|to| (from, to))) {
            let legs: Vec<DVec3> = std::iter::once(from).chain(room().around(from, to, 5.0)).collect();
            let inside = |p: DVec3| (p.cmpgt(DVec3::splat(-4.9)) & p.cmplt(DVec3::new(104.9, 64.9, 44.9))).all();
            for leg in legs.windows(2) {
                assert!((0..=100).all(|k| !inside(leg[0].lerp(leg[1], f64::from(k) / 100.0))), "{from} {to} {legs:?}");
            }
            assert!(from == to || legs.last() == Some(&to));
        }
    }
}
