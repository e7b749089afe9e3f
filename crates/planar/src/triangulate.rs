//! Triangles that fill a polygon with holes (ear clipping).

use crate::Polygon;

/// Triangles as indices into the polygon's points, outer ring first and then the holes in order; counter-clockwise.
pub fn triangulate(polygon: &Polygon) -> Vec<[usize; 3]> {
    let points: Vec<[f64; 2]> = polygon.rings().flat_map(|r| r.points()).map(|p| [p.x, p.y]).collect();
    let mut start = polygon.outer.points().len();
    let mut hole_starts: Vec<usize> = Vec::with_capacity(polygon.holes.len());
    for hole in &polygon.holes {
        hole_starts.push(start);
        start += hole.points().len();
    }
    let mut indices: Vec<usize> = Vec::new();
    earcut::Earcut::new().earcut(points.iter().copied(), &hole_starts, &mut indices);
    let ccw = |&[a, b, c]: &[usize; 3]| {
        let [a, b, c] = [a, b, c].map(|i| glam::DVec2::from_array(points[i]));
        if (b - a).perp_dot(c - a) >= 0.0 { [0, 1, 2] } else { [0, 2, 1] }
    };
    let triangles = indices.as_chunks::<3>().0;
    triangles.iter().map(|t| ccw(t).map(|k| t[k])).collect()
}
