//! A dot for a small round island that has no room for a bead.

use super::Path;
use crate::pass::{Along, PassKind};
use crate::process::Dot;
use glam::DVec2;
use planar::Polygon;

/// Greatest distance of the island's outline beyond the edge of the dot, in radii: at the corners of a square it is
/// 0.25.
const BEYOND: f64 = 0.35;
/// A disc of this many radii must fit into the island.
const ROOM: f64 = 0.6;

/// The dot that fills an island of a layer `height` mm thick; `None` if a dot of that volume has another shape, or
/// needs a time that was not tried.
pub fn dot(island: &Polygon, height: f64, dot: &Dot) -> Option<Path> {
    let diameter = dot.diameter_of(island.area() * height)?;
    let (radius, middle) = (diameter / 2.0, island.outer.centroid()?);
    let near = |p: &DVec2| p.distance(middle) <= (1.0 + BEYOND) * radius;
    if !island.contains(middle) || !island.outer.points().iter().all(near) || !island.holds_disc(ROOM * radius) {
        return None;
    }
    let half = DVec2::new(Dot::LENGTH / 2.0, 0.0);
    let (points, width) = (vec![middle - half, middle + half], Along::Same(diameter));
    Some(Path { kind: PassKind::Spot, closed: false, points, width, reversible: true })
}
