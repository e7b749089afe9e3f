//! Outlines become closed triangle meshes, wound counter-clockwise seen from outside.

use glam::{DVec2, DVec3};
use planar::triangulate::triangulate;
use planar::{Polygon, Ring};
use std::collections::{HashMap, HashSet};
use std::f64::consts::TAU;

/// A closed surface of triangles, mm.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Solid {
    /// Corners, mm.
    pub(crate) vertices: Vec<DVec3>,
    /// Corners of each triangle, counter-clockwise seen from outside.
    pub(crate) triangles: Vec<[u32; 3]>,
}

impl Solid {
    /// A prism over `base` from height `z0` up to `z1`, mm.
    pub(crate) fn extrude(base: &Polygon, z0: f64, z1: f64) -> Self {
        Self::loft(base, &[z0, z1], |p, _| p)
    }

    /// A body whose outline at each height of `levels` (mm, ascending) is `base` with its points moved by
    /// `place(point, height)`. The motion must leave the outline free of crossings, as turning and scaling do.
    pub(crate) fn loft(base: &Polygon, levels: &[f64], place: impl Fn(DVec2, f64) -> DVec2) -> Self {
        let points: Vec<DVec2> = base.rings().flat_map(Ring::points).copied().collect();
        let vertices = levels.iter().flat_map(|&z| points.iter().map(move |&p| (p, z)));
        let mut solid = Self { vertices: vertices.map(|(p, z)| place(p, z).extend(z)).collect(), triangles: vec![] };
        for level in 1..levels.len() {
            let mut below = (level - 1) * points.len();
            for ring in base.rings() {
                let count = ring.points().len();
                solid.wall(below, below + points.len(), count);
                below += count;
            }
        }
        solid.caps(&cap(base), solid.vertices.len().saturating_sub(points.len()));
        solid
    }

    /// The body that the closed loop `profile` of (radius, height), mm, sweeps around the z axis in `segments`
    /// steps. Points on the axis have radius 0.
    pub(crate) fn revolve(profile: &[DVec2], segments: u32) -> Self {
        let profile = Polygon::simple(Ring::new(profile.to_vec())).outer.into_points();
        let mut solid = Self::default();
        let starts: Vec<u32> = profile.iter().map(|&p| solid.circle(p, segments)).collect();
        let vertex = |i: usize, k: u32| starts[i] + if profile[i].x == 0.0 { 0 } else { k % segments };
        for i in 0..profile.len() {
            let j = (i + 1) % profile.len();
            for k in 0..segments {
                let [a, b, c, d] = [vertex(i, k), vertex(i, k + 1), vertex(j, k + 1), vertex(j, k)];
                let halves = [[a, b, c], [a, c, d]].into_iter();
                solid.triangles.extend(halves.filter(|&[a, b, c]| a != b && b != c && c != a));
            }
        }
        solid
    }

    /// Merges vertices at the same position (to 1 nm) and drops the triangles that then have no area.
    pub(crate) fn welded(self) -> Self {
        let mut numbers = HashMap::new();
        let mut welded = Self::default();
        let number: Vec<u32> = self
            .vertices
            .iter()
            .map(|&vertex| {
                let key = (vertex * 1e6).round().as_i64vec3();
                *numbers.entry(key).or_insert_with(|| {
                    welded.vertices.push(vertex);
                    welded.vertices.len() as u32 - 1
                })
            })
            .collect();
        let triangles = self.triangles.iter().map(|t| t.map(|i| number[i as usize]));
        welded.triangles = triangles.filter(|&[a, b, c]| a != b && b != c && c != a).collect();
        welded
    }

    /// The wall between a ring of `count` vertices that begins at `low` and the one above that begins at `high`.
    fn wall(&mut self, low: usize, high: usize, count: usize) {
        for i in 0..count {
            let j = (i + 1) % count;
            let [a, b, c, d] = [low + i, low + j, high + j, high + i].map(|v| v as u32);
            self.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }

    /// Closes the bottom, whose vertices come first, and the top, whose vertices begin at `top`.
    fn caps(&mut self, cap: &[[usize; 3]], top: usize) {
        for &[a, b, c] in cap {
            self.triangles.push([a, c, b].map(|i| i as u32));
            self.triangles.push([a, b, c].map(|i| (i + top) as u32));
        }
    }

    /// Vertices on the circle that `p` (radius, height) sweeps, a single one on the axis; returns the first index.
    fn circle(&mut self, p: DVec2, segments: u32) -> u32 {
        let first = self.vertices.len() as u32;
        let count = if p.x == 0.0 { 1 } else { segments };
        let at = |k: u32| (DVec2::from_angle(TAU * f64::from(k) / f64::from(count)) * p.x).extend(p.y);
        self.vertices.extend((0..count).map(at));
        first
    }
}

/// Triangles over `base` as indices into its points. Ear clipping passes over points in line with their neighbours; triangles are
/// split there, so that the cap has the same edges as the walls.
pub(super) fn cap(base: &Polygon) -> Vec<[usize; 3]> {
    let mut open = triangulate(base);
    let mut lacks = Lacks::of(base, &open);
    let mut done = Vec::with_capacity(open.len());
    while let Some([a, b, c]) = open.pop() {
        let edges = [[a, b, c], [b, c, a], [c, a, b]];
        match edges.iter().find_map(|&[i, j, k]| Some((k, lacks.way(i, j)?))) {
            Some((k, way)) => open.extend(way.windows(2).map(|step| [step[0], step[1], k])),
            None => done.push([a, b, c]),
        }
    }
    done
}

/// What the edges of triangles lack to a closed cap.
struct Lacks {
    /// Edges to which there is nothing on the other side, and which are not on the rim.
    single: HashSet<[usize; 2]>,
    /// The edges that ought to be on their other side, and those of the rim that no triangle has: where they lead from each point.
    missing: HashMap<usize, Vec<usize>>,
}

impl Lacks {
    fn of(base: &Polygon, triangles: &[[usize; 3]]) -> Self {
        let edges: HashSet<[usize; 2]> = triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).collect();
        let (mut rim, mut first) = (HashSet::new(), 0);
        for ring in base.rings() {
            let count = ring.points().len();
            rim.extend((0..count).map(|k| [first + k, first + (k + 1) % count]));
            first += count;
        }
        let single: HashSet<[usize; 2]> =
            edges.iter().copied().filter(|&[i, j]| !edges.contains(&[j, i]) && !rim.contains(&[i, j])).collect();
        let mut missing: HashMap<usize, Vec<usize>> = HashMap::new();
        let beside = single.iter().map(|&[i, j]| [j, i]);
        let mut all: Vec<[usize; 2]> = rim.into_iter().filter(|edge| !edges.contains(edge)).chain(beside).collect();
        all.sort_unstable();
        all.into_iter().for_each(|[i, j]| missing.entry(i).or_default().push(j));
        Self { single, missing }
    }

    /// The points that an edge passed over, with its ends, if it is single; its pieces are then missing no more.
    fn way(&mut self, i: usize, j: usize) -> Option<Vec<usize>> {
        if !self.single.remove(&[i, j]) {
            return None;
        }
        // The way that was gone so far, and how many of the ways on from each of its points were tried.
        let (mut way, mut tried) = (vec![i], vec![0]);
        while let (Some(&at), Some(count)) = (way.last(), tried.last_mut()) {
            let next = self.missing.get(&at).and_then(|ways| ways.get(*count)).copied();
            *count += 1;
            match next {
                Some(next) if next == j => {
                    way.push(next);
                    break;
                }
                Some(next) if way.contains(&next) => {}
                Some(next) => {
                    way.push(next);
                    tried.push(0);
                }
                None => {
                    way.pop();
                    tried.pop();
                }
            }
        }
        for step in way.windows(2) {
            self.missing.entry(step[0]).or_default().retain(|&to| to != step[1]);
            self.single.remove(&[step[1], step[0]]);
        }
        (way.len() > 2).then_some(way)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;
    use std::f64::consts::SQRT_2;

    /// Every edge of the cap has another triangle on its other side or is one of the rim, and the area is that of the base.
    fn check(base: &Polygon) {
        let points: Vec<DVec2> = base.rings().flat_map(|ring| ring.points().to_vec()).collect();
        let cap = cap(base);
        let area: f64 = cap.iter().map(|t| t.map(|i| points[i])).map(|[a, b, c]| (b - a).perp_dot(c - a) / 2.0).sum();
        assert!((area / base.area() - 1.0).abs() < 1e-9, "{area} for {}", base.area());
        let mut edges: Vec<[usize; 2]> = cap.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).collect();
        edges.sort_unstable();
        assert!(edges.windows(2).all(|pair| pair[0] != pair[1]), "an edge belongs to two triangles on one side");
        let (all, mut rim) = (edges.iter().copied().collect::<HashSet<_>>(), Vec::new());
        rim.extend(edges.into_iter().filter(|&[i, j]| !all.contains(&[j, i])));
        let mut first = 0;
        let wanted = base.rings().flat_map(|ring| {
            let (start, count) = (first, ring.points().len());
            first += count;
            (0..count).map(move |k| [start + k, start + (k + 1) % count])
        });
        let mut wanted: Vec<[usize; 2]> = wanted.collect();
        wanted.sort_unstable();
        assert!(rim == wanted, "an edge inside the cap is open, or one of the rim is missing");
    }

    /// A square with many points on its sides, `off` (mm) beside them at most.
    fn square(middle: DVec2, side: f64, degrees: f64, off: f64, random: &mut Random) -> Ring {
        let corner = |k: usize| middle + DVec2::from_angle(TAU / 4.0 * k as f64 + degrees.to_radians()) * side / SQRT_2;
        let sides = (0..4).flat_map(|k| (0..40).map(move |i| (k, f64::from(i) / 40.0)));
        let mut any = || off * (2.0 * random.unit() - 1.0);
        let mut beside = || DVec2::new(any(), any());
        Ring::new(sides.map(|(k, part)| corner(k).lerp(corner(k + 1), part) + beside()).collect())
    }

    /// A cut through a flat face of many triangles has points in line but for the last digits.
    #[test]
    fn a_cap_with_many_points_in_line_is_closed() {
        let mut random = Random::new(1);
        for degrees in [0.0, 17.0, 45.0] {
            for off in [0.0, 1e-15, 1e-12, 1e-10, 1e-9, 1e-6] {
                let outer = square(DVec2::ZERO, 60.0, degrees, off, &mut random);
                let middles = [-20.0, -10.0, 0.0, 10.0, 20.0].map(|x| DVec2::from_angle(f64::to_radians(degrees)) * x);
                let holes = middles.map(|m| square(m, 6.0, degrees, off, &mut random).reversed()).to_vec();
                check(&Polygon { outer: outer.clone(), holes: Vec::new() });
                check(&Polygon { outer, holes });
            }
        }
    }
}
