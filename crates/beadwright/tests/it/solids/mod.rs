//! Solids of known volume as loose triangles, mm, and the STL files that hold them.
#![allow(dead_code, unreachable_pub)]

use beadwright::model::{Import, Mesh, import};
use beadwright::planar::{DVec2, Polygon, Ring, triangulate::triangulate};
use beadwright::task::Task;
use glam::DVec3;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use std::f64::consts::TAU;

/// Corners of a triangle, counter-clockwise seen from outside.
pub type Facet = [DVec3; 3];

/// An axis-parallel box of twelve triangles.
pub fn cuboid(low: [f64; 3], high: [f64; 3]) -> Vec<Facet> {
    let [a, b] = [low, high].map(DVec3::from_array);
    let outline = [(a.x, a.y), (b.x, a.y), (b.x, b.y), (a.x, b.y)];
    moved(&prism(&outline, b.z - a.z), DVec3::new(0.0, 0.0, a.z))
}

/// A cube of 10 mm in the corner of the axes.
pub fn cube() -> Vec<Facet> {
    cuboid([0.0; 3], [10.0; 3])
}

/// What stands on a counter-clockwise outline.
pub fn prism(outline: &[(f64, f64)], height: f64) -> Vec<Facet> {
    let ring = Ring::new(outline.iter().map(|&(x, y)| DVec2::new(x, y)).collect());
    extruded(&Polygon::simple(ring), height)
}

/// What stands on an outline with holes.
pub fn extruded(base: &Polygon, height: f64) -> Vec<Facet> {
    let low: Vec<DVec3> = base.rings().flat_map(|ring| ring.points()).map(|p| p.extend(0.0)).collect();
    let high = |i: usize| low[i].with_z(height);
    let caps = triangulate(base).into_iter();
    let caps = caps.flat_map(|[a, b, c]| [[low[a], low[c], low[b]], [high(a), high(b), high(c)]]);
    let walls = base.rings().flat_map(Ring::edges).flat_map(|(a, b)| {
        let [a, b] = [a, b].map(|p| p.extend(0.0));
        [[a, b, b.with_z(height)], [a, b.with_z(height), a.with_z(height)]]
    });
    caps.chain(walls).collect()
}

/// A line of (radius, height) from the bottom up, turned about z in `n` steps. It is closed where it begins and ends on
/// the axis.
pub fn lathe(line: &[(f64, f64)], n: usize) -> Vec<Facet> {
    let at = |(r, z): (f64, f64), i: usize| {
        let angle = TAU * (i % n) as f64 / n as f64;
        DVec3::new(r * angle.cos(), r * angle.sin(), z)
    };
    let bands = line.windows(2).flat_map(|w| {
        (0..n).flat_map(move |i| {
            let [a, b, c, d] = [at(w[0], i), at(w[0], i + 1), at(w[1], i + 1), at(w[1], i)];
            [[a, b, c], [a, c, d]]
        })
    });
    bands.filter(|[a, b, c]| a != b && b != c && c != a).collect()
}

/// A sphere that stands on z = 0.
pub fn sphere(radius: f64, n: usize) -> Vec<Facet> {
    let angle = |k: usize| TAU / 2.0 * k as f64 / n as f64;
    let mut line: Vec<_> = (0..=n).map(|k| (radius * angle(k).sin(), radius * (1.0 - angle(k).cos()))).collect();
    line[0].0 = 0.0;
    line[n].0 = 0.0;
    lathe(&line, 2 * n)
}

/// Area of a regular polygon with `n` corners on a circle.
pub fn regular(radius: f64, n: usize) -> f64 {
    n as f64 / 2.0 * radius * radius * (TAU / n as f64).sin()
}

pub fn flipped(facets: &[Facet]) -> Vec<Facet> {
    facets.iter().map(|&[a, b, c]| [a, c, b]).collect()
}

pub fn moved(facets: &[Facet], by: DVec3) -> Vec<Facet> {
    mapped(facets, |p| p + by)
}

pub fn mapped(facets: &[Facet], map: impl Fn(DVec3) -> DVec3) -> Vec<Facet> {
    facets.iter().map(|f| f.map(&map)).collect()
}

/// Each triangle cut into four at the middles of its edges.
pub fn split(facets: &[Facet]) -> Vec<Facet> {
    let quarter = |&[a, b, c]: &Facet| {
        let [ab, bc, ca] = [(a + b) / 2.0, (b + c) / 2.0, (c + a) / 2.0];
        [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
    };
    facets.iter().flat_map(quarter).collect()
}

pub fn joined(parts: &[Vec<Facet>]) -> Vec<Facet> {
    parts.concat()
}

pub fn facets_of(mesh: &Mesh) -> Vec<Facet> {
    mesh.triangles.iter().map(|t| t.map(|i| mesh.vertices[i as usize])).collect()
}

fn normal([a, b, c]: &Facet) -> DVec3 {
    (b - a).cross(c - a).normalize_or_zero()
}

/// A binary STL file whose header begins with those bytes.
pub fn binary(header: &[u8], facets: &[Facet]) -> Vec<u8> {
    let mut bytes = header.to_vec();
    bytes.resize(80, 0);
    bytes.extend((facets.len() as u32).to_le_bytes());
    for facet in facets {
        for v in [&[normal(facet)], &facet[..]].concat() {
            bytes.extend(v.to_array().iter().flat_map(|x| (*x as f32).to_le_bytes()));
        }
        bytes.extend([0, 0]);
    }
    bytes
}

/// An ASCII STL file, seven lines to a facet.
pub fn ascii(name: &str, facets: &[Facet]) -> String {
    let mut text = format!("solid {name}\n");
    for facet in facets {
        let n = normal(facet);
        text += &format!("facet normal {} {} {}\n  outer loop\n", n.x, n.y, n.z);
        facet.iter().for_each(|v| text += &format!("    vertex {:e} {} {:.4}\n", v.x, v.y, v.z));
        text += "  endloop\nendfacet\n";
    }
    text + &format!("endsolid {name}\n")
}

pub fn imported(facets: &[Facet]) -> Import {
    import(&binary(b"test", facets), &Task::new()).unwrap()
}

/// Runs property tests with a fixed seed.
pub fn runner(cases: u32) -> TestRunner {
    let config = Config { cases, failure_persistence: None, ..Config::default() };
    TestRunner::new_with_rng(config, TestRng::deterministic_rng(RngAlgorithm::ChaCha))
}
