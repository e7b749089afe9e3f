//! A plane that separates two sets of points: the vector between their convex hulls is shortened until a plane square
//! to it separates them (Gilbert's algorithm, stopped early).

use crate::chart::Plane;
use glam::DVec3;

/// Most iterations; convex hulls that need more are taken to touch.
const STEPS: usize = 400;
/// Iteration stops when the hulls are apart by this fraction of the vector between them, so that the plane has
/// clearance on both sides.
const ROOM: f64 = 0.7;
/// Hulls nearer than this are not separated, mm.
const APART: f64 = 0.05;

/// A plane between the convex hulls of two sets, with `upper` above it, equally far from both; `None` if they touch.
pub(super) fn between(upper: &[DVec3], lower: &[DVec3]) -> Option<Plane> {
    let farthest =
        |points: &[DVec3], way: DVec3| points.iter().copied().max_by(|a, b| way.dot(*a).total_cmp(&way.dot(*b)));
    // Points of the two hulls; the vector between them converges to the shortest.
    let (mut above, mut below) = (*upper.first()?, *lower.first()?);
    for _ in 0..STEPS {
        let way = above - below;
        if way.length() < APART {
            return None;
        }
        let (next_above, next_below) = (farthest(upper, -way)?, farthest(lower, way)?);
        let next = next_above - next_below;
        if way.dot(next) >= ROOM * way.length_squared() {
            let up = way.normalize();
            let middle = (up.dot(next_above) + up.dot(next_below)) / 2.0;
            return Some(Plane { origin: up * middle, up });
        }
        // Move to the point nearest to the other hull on the line to the next points.
        let step = next - way;
        let part = (-way.dot(step) / step.length_squared()).clamp(0.0, 1.0);
        above += (next_above - above) * part;
        below += (next_below - below) * part;
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corners(low: DVec3, high: DVec3) -> Vec<DVec3> {
        let pick = |k: usize, axis: usize| if k >> axis & 1 == 0 { low[axis] } else { high[axis] };
        (0..8).map(|k| DVec3::new(pick(k, 0), pick(k, 1), pick(k, 2))).collect()
    }

    #[test]
    fn a_plane_parts_two_boxes_with_room_on_both_sides() {
        let lower = corners(DVec3::ZERO, DVec3::splat(10.0));
        let upper = corners(DVec3::new(14.0, -30.0, 3.0), DVec3::new(20.0, 40.0, 5.0));
        let plane = between(&upper, &lower).unwrap();
        let height = |p: &DVec3| plane.up.dot(*p - plane.origin);
        let room =
            [upper.iter().map(height).fold(f64::MAX, f64::min), -lower.iter().map(height).fold(f64::MIN, f64::max)];
        // The boxes are 4 mm apart.
        assert!(room.iter().all(|room| (1.4..=2.0).contains(room)), "{room:?}");
    }

    #[test]
    fn hulls_that_meet_have_no_plane_between_them() {
        let lower = corners(DVec3::ZERO, DVec3::splat(10.0));
        let upper = corners(DVec3::splat(9.0), DVec3::splat(12.0));
        assert!(between(&upper, &lower).is_none());
    }
}
