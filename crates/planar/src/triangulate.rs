//! Triangles that fill a polygon with holes: fast, by ear clipping, or with just its edges as their outer edges.

use crate::Polygon;
use spade::{ConstrainedDelaunayTriangulation, HasPosition, Point2, Triangulation};
use std::collections::HashMap;

/// Triangles as indices into the polygon's points, outer ring first and then the holes in order; counter-clockwise.
///
/// ```
/// use planar::{DVec2, Polygon, Ring, triangulate::triangulate};
///
/// // A polygon with six corners and no holes takes four triangles.
/// let corners = [(0.0, 0.0), (4.0, 0.0), (4.0, 1.0), (1.0, 1.0), (1.0, 3.0), (0.0, 3.0)].map(DVec2::from);
/// assert_eq!(triangulate(&Polygon::simple(Ring::new(corners.to_vec()))).len(), 4);
/// ```
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

/// Like [`triangulate`], but every edge of the polygon is an edge of exactly one triangle, and every other edge of two,
/// even where points are exactly collinear, which ear clipping skips: the constrained Delaunay triangulation. Where
/// edges of the polygon cross, the triangles overlap and some are clockwise, but their signed areas still add up.
pub fn triangulate_by_edges(polygon: &Polygon) -> Vec<[usize; 3]> {
    let (mut corners, mut edges) = (Vec::new(), Vec::new());
    for ring in polygon.rings() {
        let (first, count) = (corners.len(), ring.points().len());
        edges.extend((0..count).map(|k| [first + k, first + (k + 1) % count]));
        corners.extend((first..).zip(ring.points()).map(|(number, p)| Corner { at: Point2::new(p.x, p.y), number }));
    }
    // An edge that runs there and back bounds nothing.
    let mut times: HashMap<[usize; 2], u32> = HashMap::new();
    let place = |k: usize| (corners[k].at.x.to_bits(), corners[k].at.y.to_bits());
    let mut first_at = HashMap::new();
    let numbers: Vec<usize> = (0..corners.len()).map(|k| *first_at.entry(place(k)).or_insert(k)).collect();
    let same = |[i, j]: [usize; 2]| [numbers[i].min(numbers[j]), numbers[i].max(numbers[j])];
    edges.iter().for_each(|edge| *times.entry(same(*edge)).or_default() += 1);
    edges.retain(|edge| times[&same(*edge)] % 2 == 1);
    let mut crossed = false;
    let all = ConstrainedDelaunayTriangulation::<Corner>::try_bulk_load_cdt(corners, edges, |_| crossed = true);
    let Some(all) = all.ok().filter(|_| !crossed) else { return fans(polygon) };
    // From the hull inwards, each edge of the polygon that is crossed leads from outside to inside or back.
    let (mut known, mut inside) = (vec![false; all.num_all_faces()], Vec::new());
    let mut open: Vec<_> = all.convex_hull().map(|edge| (edge.rev(), false)).collect();
    while let Some((edge, was_inside)) = open.pop() {
        let Some(face) = edge.face().as_inner() else { continue };
        if std::mem::replace(&mut known[face.index()], true) {
            continue;
        }
        let is_inside = was_inside != edge.is_constraint_edge();
        if is_inside {
            inside.push(face.vertices().map(|corner| corner.data().number));
        }
        open.extend(face.adjacent_edges().map(|edge| (edge.rev(), is_inside)));
    }
    inside
}

/// A fan from the first point of each ring: closed, with the area of the polygon, whatever it looks like; its triangles overlap.
fn fans(polygon: &Polygon) -> Vec<[usize; 3]> {
    let (mut triangles, mut first) = (Vec::new(), 0);
    for ring in polygon.rings() {
        let count = ring.points().len();
        triangles.extend((2..count).map(|k| [first, first + k - 1, first + k]));
        first += count;
    }
    triangles
}

/// A point of a polygon.
struct Corner {
    at: Point2<f64>,
    /// Its index.
    number: usize,
}

impl HasPosition for Corner {
    type Scalar = f64;

    fn position(&self) -> Point2<f64> {
        self.at
    }
}
