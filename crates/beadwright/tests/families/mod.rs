//! Random islands of eight families, as parts bring them: the same seed gives the same island.
#![allow(dead_code, unreachable_pub, clippy::unwrap_used, reason = "each test file uses some of it and may panic")]

use beadwright::planar::{DVec2, FillRule, Polygon, Region, Ring};
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
