//! Triangles that fill a polygon with holes: fast, by ear clipping, or with just its edges as their outer edges.

use crate::Polygon;
use glam::DVec2;
use spade::{ConstrainedDelaunayTriangulation, HasPosition, Point2, Triangulation};
use std::collections::{BTreeMap, HashMap, HashSet};

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
        let [a, b, c] = [a, b, c].map(|i| DVec2::from_array(points[i]));
        if (b - a).perp_dot(c - a) >= 0.0 { [0, 1, 2] } else { [0, 2, 1] }
    };
    let triangles = indices.as_chunks::<3>().0;
    triangles.iter().map(|t| ccw(t).map(|k| t[k])).collect()
}

/// Like [`triangulate`], but every edge of the polygon is an edge of exactly one triangle, and every other edge of two,
/// even where points are exactly collinear, which ear clipping skips: the constrained Delaunay triangulation. Where
/// edges of the polygon cross, triangles beside them overlap and some are clockwise, but the edges of all together are
/// those of the polygon, and their signed areas still add up.
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
    let rim: Vec<[usize; 2]> = edges.iter().map(|edge| edge.map(|k| numbers[k])).collect();
    edges.retain(|edge| times[&same(*edge)] % 2 == 1);
    let mut crossed = false;
    let all = ConstrainedDelaunayTriangulation::<Corner>::try_bulk_load_cdt(corners, edges, |_| crossed = true);
    match all {
        Ok(all) if !crossed => within_edges(&all),
        Ok(all) => closed(within(polygon, &all), &rim),
        Err(_) => closed(Vec::new(), &rim),
    }
}

/// Triangles inside: from the hull inwards, each edge of the polygon that is crossed leads from outside to inside or back.
fn within_edges(all: &ConstrainedDelaunayTriangulation<Corner>) -> Vec<[usize; 3]> {
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

/// Triangles whose middle lies inside, where some edges of the polygon are missing.
fn within(polygon: &Polygon, all: &ConstrainedDelaunayTriangulation<Corner>) -> Vec<[usize; 3]> {
    let middle = |at: Point2<f64>| DVec2::new(at.x, at.y);
    let inside = all.inner_faces().filter(|face| polygon.contains(middle(face.center())));
    inside.map(|face| face.vertices().map(|corner| corner.data().number)).collect()
}

/// Adds fans until the edges of all triangles together are those of the rim, each in its direction.
fn closed(mut triangles: Vec<[usize; 3]>, rim: &[[usize; 2]]) -> Vec<[usize; 3]> {
    // Triangles between corners of one ring would come again in its fan.
    let rings: Vec<HashSet<usize>> = missing(&triangles, rim).into_iter().map(HashSet::from_iter).collect();
    triangles.retain(|triangle| !rings.iter().any(|ring| triangle.iter().all(|corner| ring.contains(corner))));
    for ring in missing(&triangles, rim) {
        triangles.extend((2..ring.len()).map(|k| [ring[0], ring[k - 1], ring[k]]));
    }
    triangles
}

/// Rings of the edges that triangles lack to have those of the rim as their outer edges.
fn missing(triangles: &[[usize; 3]], rim: &[[usize; 2]]) -> Vec<Vec<usize>> {
    // How often each edge is still to be run from its lower end to its higher one, less how often back.
    let mut runs: BTreeMap<[usize; 2], i32> = BTreeMap::new();
    let mut run = |[from, to]: [usize; 2], times: i32| {
        *runs.entry([from.min(to), from.max(to)]).or_default() += if from < to { times } else { -times };
    };
    rim.iter().for_each(|edge| run(*edge, 1));
    triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).for_each(|edge| run(edge, -1));
    let mut ways: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for ([low, high], times) in runs.into_iter().filter(|([low, high], _)| low != high) {
        let (from, to) = if times > 0 { (low, high) } else { (high, low) };
        ways.entry(from).or_default().extend((0..times.abs()).map(|_| to));
    }
    // As often as a way leads to a corner, one leads on from it.
    let mut rings = Vec::new();
    while let Some((first, mut ends)) = ways.pop_first() {
        let Some(mut next) = ends.pop() else { continue };
        ways.insert(first, ends);
        let mut ring = vec![first];
        while next != first {
            ring.push(next);
            let Some(after) = ways.get_mut(&next).and_then(Vec::pop) else { break };
            next = after;
        }
        rings.push(ring);
    }
    rings
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
