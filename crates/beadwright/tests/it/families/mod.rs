//! Random islands of eight families, as parts bring them: the same seed gives the same island. And whether layers are sound,
//! judged at other places than the program's own check does.
#![allow(dead_code, unreachable_pub)]

use beadwright::fill::sound;
use beadwright::pass::Along;
use beadwright::planar::triangulate::triangulate;
use beadwright::planar::{DVec2, FillRule, Polygon, Region, Ring, polyline};
use beadwright::{Layer, Mesh, Pass};
use std::f64::consts::TAU;

/// The families by name.
pub const FAMILIES: [&str; 8] = ["star", "spiky", "holes", "slivers", "near-touching", "comb", "thin ring", "nested"];

/// Numbers that look random (splitmix64), 0 to 1.
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15).wrapping_add(0x1234_5678_9ABC_DEF1))
    }

    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }

    pub fn count(&mut self, low: usize, high: usize) -> usize {
        low + (self.next() * (high - low + 1) as f64) as usize
    }
}

/// Islands of a family, mm; beads are some 5 mm wide.
pub fn islands(family: usize, seed: u64) -> Vec<Polygon> {
    let mut random = Random::new(seed * 8 + family as u64);
    let r = &mut random;
    let rings = match family {
        0 => vec![around(r, 60.0, 0.45, 30)],
        1 => {
            let (count, size) = (r.count(5, 16), r.between(30.0, 80.0));
            let spike = |k: usize, r: &mut Random| if k.is_multiple_of(2) { size } else { size * r.between(0.08, 0.5) };
            vec![(0..2 * count).map(|k| polar(spike(k, r), TAU * k as f64 / (2 * count) as f64)).collect()]
        }
        2 => {
            let outer = around(r, 90.0, 0.15, 40);
            let holes = (0..r.count(3, 12)).map(|_| {
                let (radius, middle) = (r.between(2.0, 14.0), polar(r.between(0.0, 60.0), r.between(0.0, TAU)));
                circle(middle, radius, 24)
            });
            std::iter::once(outer).chain(holes).collect()
        }
        3 => {
            let slit = |r: &mut Random| {
                let (at, way) = (polar(r.between(0.0, 30.0), r.between(0.0, TAU)), r.between(0.0, TAU));
                rectangle(at, r.between(10.0, 60.0), r.between(0.05, 3.0), way)
            };
            let outer = around(r, 60.0, 0.2, 24);
            std::iter::once(outer).chain((0..r.count(1, 4)).map(|_| slit(r)).collect::<Vec<_>>()).collect()
        }
        4 => {
            let gap = r.between(0.01, 2.0);
            let (a, b) = (r.between(15.0, 40.0), r.between(15.0, 40.0));
            return [
                Region::from_rings(&[ring(circle(DVec2::new(-a - gap / 2.0, 0.0), a, 64))], FillRule::EvenOdd),
                Region::from_rings(&[ring(circle(DVec2::new(b + gap / 2.0, 0.0), b, 64))], FillRule::EvenOdd),
            ]
            .into_iter()
            .flat_map(Region::into_polygons)
            .collect();
        }
        5 => {
            let (teeth, tooth, gap) = (r.count(3, 9), r.between(3.0, 14.0), r.between(0.5, 9.0));
            let (depth, back) = (r.between(15.0, 60.0), r.between(4.0, 16.0));
            let width = teeth as f64 * tooth + (teeth - 1) as f64 * gap;
            let mut points = vec![DVec2::new(0.0, -back), DVec2::new(width, -back)];
            for k in (0..teeth).rev() {
                let left = k as f64 * (tooth + gap);
                let [low, high] = [0.0, depth];
                points.extend([(left + tooth, low), (left + tooth, high), (left, high), (left, low)].map(DVec2::from));
            }
            vec![points]
        }
        6 => {
            let (radius, wall) = (r.between(20.0, 60.0), r.between(3.0, 12.0));
            let turn = r.between(0.0, 1.0);
            let shift = DVec2::new(wall * 0.45 * turn, 0.0);
            vec![circle(DVec2::ZERO, radius, 90), circle(shift, radius - wall, 90)]
        }
        _ => {
            let mut rings = Vec::new();
            let (mut radius, sides) = (r.between(50.0, 90.0), r.count(3, 8));
            while radius > 6.0 && rings.len() < 8 {
                rings.push(circle(DVec2::ZERO, radius, sides));
                radius -= r.between(4.0, 20.0);
            }
            rings
        }
    };
    let turn = DVec2::from_angle(random.between(0.0, TAU));
    let rings: Vec<Ring> =
        rings.into_iter().map(|points| ring(points.iter().map(|p| turn.rotate(*p)).collect())).collect();
    Region::from_rings(&rings, FillRule::EvenOdd).into_polygons()
}

fn ring(points: Vec<DVec2>) -> Ring {
    Ring::new(points)
}

fn polar(radius: f64, angle: f64) -> DVec2 {
    DVec2::from_angle(angle) * radius
}

fn circle(middle: DVec2, radius: f64, sides: usize) -> Vec<DVec2> {
    (0..sides).map(|k| middle + polar(radius, TAU * k as f64 / sides as f64)).collect()
}

/// A star-shaped outline whose radius wanders.
fn around(r: &mut Random, radius: f64, change: f64, most: usize) -> Vec<DVec2> {
    let sides = r.count(5, most);
    (0..sides).map(|k| polar(radius * r.between(1.0 - change, 1.0), TAU * k as f64 / sides as f64)).collect()
}

fn rectangle(middle: DVec2, length: f64, width: f64, way: f64) -> Vec<DVec2> {
    let (u, v) = (DVec2::from_angle(way) * length / 2.0, DVec2::from_angle(way).perp() * width / 2.0);
    vec![middle - u - v, middle + u - v, middle + u + v, middle - u + v]
}

/// A part that stands on islands, `height` high, mm; `None` without islands.
pub fn extruded(islands: &[Polygon], height: f64) -> Option<Mesh> {
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for island in islands {
        let flat: Vec<DVec2> = island.rings().flat_map(|ring| ring.points().to_vec()).collect();
        let (low, count) = (vertices.len() as u32, flat.len() as u32);
        vertices.extend([0.0, height].iter().flat_map(|&z| flat.iter().map(move |p| p.extend(z))));
        let caps = triangulate(island).into_iter().flat_map(|[a, b, c]| {
            let [a, b, c] = [a, b, c].map(|corner| low + corner as u32);
            [[a, c, b], [a + count, b + count, c + count]]
        });
        triangles.extend(caps);
        let mut first = low;
        for ring in island.rings() {
            let n = ring.points().len() as u32;
            let sides = (0..n).map(|k| (first + k, first + (k + 1) % n));
            triangles.extend(sides.flat_map(|(a, b)| [[a, b, b + count], [a, b + count, a + count]]));
            first += n;
        }
    }
    (!triangles.is_empty()).then(|| Mesh::from_triangles(vertices, triangles).0)
}

/// The centre-line of a pass, seen from above.
pub fn line(pass: &Pass) -> Vec<DVec2> {
    let again = pass.closed.then(|| pass.points.first()).flatten();
    pass.points.iter().chain(again).map(|p| p.truncate()).collect()
}

/// Greatest distance of centre-lines from the islands, judged at points and between them, mm.
pub fn outside(passes: &[Pass], islands: &[Polygon]) -> f64 {
    let to_edges = |p: DVec2| {
        let edges = islands.iter().flat_map(|i| i.rings().flat_map(|ring| ring.edges()).collect::<Vec<_>>());
        let squared = |(a, b)| polyline::distance_squared_to_segment(p, a, b);
        edges.map(squared).fold(f64::INFINITY, f64::min).sqrt()
    };
    let places = passes.iter().flat_map(|pass| {
        let line = line(pass);
        line.windows(2).flat_map(|w| (0..8).map(|k| w[0].lerp(w[1], f64::from(k) / 8.0))).collect::<Vec<_>>()
    });
    let left = |p: &DVec2| !islands.iter().any(|island| island.contains(*p));
    places.filter(left).map(to_edges).fold(0.0, f64::max)
}

/// Why a layer cannot be welded: centre-lines outside, passes that cross, or places without a width.
pub fn fault(layer: &Layer) -> Option<String> {
    let of_each_point = |pass: &&Pass| match &pass.width {
        Along::Same(_) => true,
        Along::Each(widths) => widths.len() == pass.points.len(),
    };
    if let Some(pass) = layer.passes.iter().find(|pass| !of_each_point(pass)) {
        return Some(format!("layer {}: {} points, widths {:?}", layer.index + 1, pass.points.len(), pass.width));
    }
    let by = outside(&layer.passes, &layer.islands);
    let lines: Vec<Vec<DVec2>> = layer.passes.iter().map(line).collect();
    let crossing = sound::crossings(&lines).next();
    (by > 0.011 || crossing.is_some()).then(|| format!("layer {}: {by:.3} mm outside, {crossing:?}", layer.index + 1))
}
