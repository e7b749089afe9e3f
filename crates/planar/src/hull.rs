//! Convex hull (Andrew's variant of Graham's scan) and the rectangle of least area (rotating calipers).

use glam::DVec2;

/// A rectangle at any angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OrientedRect {
    /// The middle.
    pub center: DVec2,
    /// Unit vector along `size.x`.
    pub axis: DVec2,
    /// Extent along `axis` and across it, mm.
    pub size: DVec2,
}

impl OrientedRect {
    /// Area, mm².
    pub fn area(&self) -> f64 {
        self.size.x * self.size.y
    }
}

/// The convex hull of `points`, counter-clockwise, without points on its edges.
///
/// ```
/// use planar::{DVec2, convex_hull};
///
/// let points = [(0.0, 0.0), (2.0, 0.0), (4.0, 0.0), (4.0, 4.0), (1.0, 2.0), (0.0, 4.0)].map(DVec2::from);
/// assert_eq!(convex_hull(&points), [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)].map(DVec2::from));
/// ```
pub fn convex_hull(points: &[DVec2]) -> Vec<DVec2> {
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    sorted.dedup();
    if sorted.len() < 3 {
        return sorted;
    }
    let mut hull = half_hull(sorted.iter().copied());
    hull.extend(half_hull(sorted.iter().rev().copied()));
    hull
}

/// One chain of the hull, without its last point.
fn half_hull(points: impl Iterator<Item = DVec2>) -> Vec<DVec2> {
    let mut chain: Vec<DVec2> = Vec::new();
    for p in points {
        while let [.., a, b] = chain[..] {
            if (b - a).perp_dot(p - b) > 0.0 {
                break;
            }
            chain.pop();
        }
        chain.push(p);
    }
    chain.pop();
    chain
}

/// The rectangle of least area around `points`; `None` when fewer than two of them differ.
/// One of its sides lies along a hull edge (Freeman and Shapira 1975), so the edges are tried in turn.
///
/// ```
/// use planar::{DVec2, min_area_rect};
///
/// // A square that stands on a corner: half the box around it.
/// let square = [(2.0, 0.0), (0.0, 2.0), (-2.0, 0.0), (0.0, -2.0)].map(DVec2::from);
/// assert!(min_area_rect(&square).is_some_and(|rect| (rect.area() - 8.0).abs() < 1e-9));
/// ```
pub fn min_area_rect(points: &[DVec2]) -> Option<OrientedRect> {
    let hull = convex_hull(points);
    let edges = hull.iter().zip(hull.iter().cycle().skip(1));
    edges
        .filter_map(|(&a, &b)| (b - a).try_normalize())
        .map(|axis| rect_along(&hull, axis))
        .min_by(|a, b| a.area().total_cmp(&b.area()))
}

fn rect_along(hull: &[DVec2], axis: DVec2) -> OrientedRect {
    let turned = hull.iter().map(|&p| DVec2::new(p.dot(axis), axis.perp_dot(p)));
    let (min, max) = turned.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(lo, hi), p| (lo.min(p), hi.max(p)));
    let middle = (min + max) / 2.0;
    OrientedRect { center: axis * middle.x + axis.perp() * middle.y, axis, size: max - min }
}
