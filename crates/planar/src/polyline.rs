//! Open and closed lines: length and simplification.

use crate::Ring;
use glam::DVec2;

/// Length of the open line through `points`, mm.
///
/// ```
/// use planar::{DVec2, polyline};
///
/// let line = [(0.0, 0.0), (3.0, 4.0), (3.0, 10.0)].map(DVec2::from);
/// assert_eq!(polyline::length(&line), 5.0 + 6.0);
/// ```
pub fn length(points: &[DVec2]) -> f64 {
    points.windows(2).map(|w| w[0].distance(w[1])).sum()
}

/// The point at `distance` (mm) along the open line through `points`; beyond the end, the last point.
///
/// ```
/// use planar::{DVec2, polyline};
///
/// let line = [(0.0, 0.0), (3.0, 4.0), (3.0, 10.0)].map(DVec2::from);
/// assert_eq!(polyline::point_at(&line, 8.0), Some(DVec2::new(3.0, 7.0)));
/// assert_eq!(polyline::point_at(&line, 99.0), Some(DVec2::new(3.0, 10.0)));
/// ```
pub fn point_at(points: &[DVec2], distance: f64) -> Option<DVec2> {
    let mut left = distance;
    for pair in points.windows(2) {
        let step = pair[0].distance(pair[1]);
        if step >= left && step > 0.0 {
            return Some(pair[0].lerp(pair[1], left / step));
        }
        left -= step;
    }
    points.last().copied()
}

/// The open line through `points` shortened at its end by `by` (mm).
pub fn without_end(mut points: Vec<DVec2>, by: f64) -> Vec<DVec2> {
    let mut left = by;
    while let [.., a, b] = points[..] {
        let (step, last) = (a.distance(b), points.len() - 1);
        if step > left {
            points[last] = b.lerp(a, left / step);
            break;
        }
        left -= step;
        points.pop();
    }
    points
}

/// Drops every point within `tolerance` (mm) of the line that remains (Douglas–Peucker); the ends stay.
///
/// ```
/// use planar::{DVec2, polyline};
///
/// // Points in line go, corners stay.
/// let line = [(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (2.0, 1.0), (2.0, 5.0)].map(DVec2::from);
/// assert_eq!(polyline::simplify(&line, 0.01), [line[0], line[2], line[4]]);
/// ```
pub fn simplify(points: &[DVec2], tolerance: f64) -> Vec<DVec2> {
    let Some(last) = points.len().checked_sub(1) else { return Vec::new() };
    let mut keep = vec![false; points.len()];
    keep[0] = true;
    keep[last] = true;
    keep.iter_mut().skip(1).zip(points.windows(3)).for_each(|(keep, w)| *keep = is_corner(w[0], w[1], w[2], tolerance));
    let (mut from, mut open) = (0, Vec::new());
    for to in 1..=last {
        if keep[to] {
            open.push((from, to));
            mark_kept(points, &mut open, tolerance * tolerance, &mut keep);
            from = to;
        }
    }
    let mut kept = Vec::with_capacity(keep.iter().filter(|&&k| k).count());
    kept.extend(points.iter().zip(&keep).filter(|&(_, &k)| k).map(|(&p, _)| p));
    kept
}

/// Whether a point between two others is always kept: it lies more than three times the tolerance from the line between
/// them, so no straight line passes within the tolerance of all three. Only the short sections between such corners
/// remain to be simplified.
fn is_corner(before: DVec2, point: DVec2, after: DVec2, tolerance: f64) -> bool {
    let turns_back = (point - before).dot(after - point) <= 0.0;
    !turns_back && distance_squared_to_segment(point, before, after) > 9.0 * tolerance * tolerance
}

/// [`simplify`] for a closed ring, anchored at two points far apart so that the start vertex does not matter.
/// `None` when fewer than three points remain.
pub fn simplify_ring(ring: Ring, tolerance: f64) -> Option<Ring> {
    let mut points = ring.into_points();
    if points.len() > 3 {
        let low = (0..points.len()).min_by(|&i, &j| lexicographic(points[i], points[j]))?;
        points.rotate_left(low);
        let start = points[0];
        let distance = |p: DVec2| p.distance_squared(start);
        let far = (0..points.len()).max_by(|&i, &j| {
            distance(points[i]).total_cmp(&distance(points[j])).then(lexicographic(points[i], points[j]))
        })?;
        points.push(start);
        let mut kept = simplify(&points[..=far], tolerance);
        kept.pop();
        kept.extend(simplify(&points[far..], tolerance));
        kept.pop();
        points = kept;
    }
    (points.len() >= 3).then(|| Ring::new(points))
}

fn lexicographic(a: DVec2, b: DVec2) -> std::cmp::Ordering {
    a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y))
}

/// Marks the points to keep within each open section; uses an explicit stack, so that long lines cannot overflow the
/// call stack.
fn mark_kept(points: &[DVec2], open: &mut Vec<(usize, usize)>, tolerance_squared: f64, keep: &mut [bool]) {
    while let Some((a, b)) = open.pop() {
        let mut worst = (tolerance_squared, None);
        let (from, way) = (points[a], points[b] - points[a]);
        let per_length = 1.0 / way.length_squared().max(f64::MIN_POSITIVE);
        for (i, p) in points.iter().enumerate().take(b).skip(a + 1) {
            let d = (*p - from - way * ((*p - from).dot(way) * per_length).clamp(0.0, 1.0)).length_squared();
            if d > worst.0 {
                worst = (d, Some(i));
            }
        }
        if let Some(i) = worst.1 {
            keep[i] = true;
            open.push((a, i));
            open.push((i, b));
        }
    }
}

/// Squared distance, mm², from `p` to the segment `a`–`b`.
pub fn distance_squared_to_segment(p: DVec2, a: DVec2, b: DVec2) -> f64 {
    p.distance_squared(closest_on_segment(p, a, b))
}

/// The point of the segment `a`–`b` that is nearest to `p`.
pub fn closest_on_segment(p: DVec2, a: DVec2, b: DVec2) -> DVec2 {
    let ab = b - a;
    let length_squared = ab.length_squared();
    let t = if length_squared > 0.0 { ((p - a).dot(ab) / length_squared).clamp(0.0, 1.0) } else { 0.0 };
    a + ab * t
}
