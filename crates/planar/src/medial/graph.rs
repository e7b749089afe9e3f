//! The discs linked into curves: noise is peeled off and branches are traced.

use super::boundary::Boundary;
use super::disc::{Disc, Tent, on_tent};
use super::mesh::{Mesh, Sample};
use super::{Branch, MERGE_MM, MedialAxis, MedialOptions, Node};
use smallvec::SmallVec;
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::f64::consts::PI;

/// Nodes closer than this to the one before are left out, mm.
const SAME_MM: f64 = 1e-6;

/// A gap between two nodes is filled with at most this many pieces.
const MOST_PIECES: f64 = 50.0;

/// If the curve turns by more than this, rad, at a node below the least object angle, that node is noise beside the
/// curve.
const SPUR_TURN: f64 = PI / 6.0;

/// The neighbours of a disc: three at most, except where junctions coincide.
pub(super) type Links = SmallVec<[usize; 3]>;

/// Discs and their links. The discs of chords come first, indexed as their chords.
pub(super) struct Graph<'a> {
    pub boundary: &'a Boundary,
    pub mesh: &'a Mesh,
    pub discs: Vec<Disc>,
    /// How the disc of each chord was found.
    pub tents: Vec<Tent>,
    /// Neighbours; none where a disc has been removed.
    pub links: Vec<Links>,
    pub out: Vec<bool>,
}

impl Graph<'_> {
    pub(super) fn link(&mut self, a: usize, b: usize) {
        self.links[a].push(b);
        self.links[b].push(a);
    }

    pub(super) fn add(&mut self, disc: Disc, neighbours: &[usize]) {
        let number = self.discs.len();
        self.discs.push(disc);
        self.links.push(Links::new());
        self.out.push(false);
        for &other in neighbours {
            self.link(number, other);
        }
    }

    fn unlink(&mut self, from: usize, to: usize) {
        if let Some(i) = self.links[from].iter().position(|&n| n == to) {
            self.links[from].remove(i);
        }
    }

    pub(super) fn remove(&mut self, node: usize) {
        self.out[node] = true;
        for other in std::mem::take(&mut self.links[node]) {
            self.unlink(other, node);
        }
    }

    /// Removes free ends as long as their object angle is below `min_angle`, the smallest discs first; one disc
    /// always stays. What remains of a branch then ends exactly where the angle is reached.
    pub(super) fn peel(&mut self, min_angle: f64) {
        let key = |graph: &Self, node: usize| Reverse((graph.discs[node].radius.to_bits(), node));
        let free = |graph: &Self, node: usize| graph.links[node].len() == 1;
        let mut ends: BinaryHeap<_> = (0..self.discs.len()).filter(|&n| free(self, n)).map(|n| key(self, n)).collect();
        let mut left = self.out.iter().filter(|&&out| !out).count();
        let mut peeled = Vec::new();
        while let Some(Reverse((_, node))) = ends.pop() {
            if left == 1 || self.discs[node].angle >= min_angle {
                continue;
            }
            let Some(&inner) = self.links[node].first() else { continue };
            self.remove(node);
            left -= 1;
            peeled.push((inner, node));
            if free(self, inner) {
                ends.push(key(self, inner));
            }
        }
        for (inner, outer) in peeled {
            if !self.out[inner] && free(self, inner) {
                self.discs[inner] = self.last_disc(inner, outer, min_angle);
            }
        }
    }

    /// A disc between those of two chords that share one end, at fraction `t` from the first to the second.
    fn between(&self, chords: [usize; 2], t: f64) -> Option<Disc> {
        let mesh = self.mesh;
        if chords.iter().any(|&c| c >= mesh.chords.len()) {
            return None;
        }
        let [first, second] = chords.map(|c| mesh.chords[c]);
        let shared = *first.iter().find(|s| second.contains(s))?;
        let other = |ends: [usize; 2]| ends.iter().find(|&&s| s != shared).map(|&s| mesh.at(s));
        let foot = self.boundary.nearest(other(first)?.lerp(other(second)?, t), f64::INFINITY)?;
        let moved = Sample { at: foot.at, edge: foot.edge };
        let [p, q] = chords.map(|c| self.tents[c].peak);
        let peak = p.zip(q).map(|(p, q)| p.lerp(q, t));
        Some(on_tent(self.boundary, &Tent { ends: [mesh.samples[shared], moved], peak }).disc)
    }

    /// The last disc of at least `min_angle` between a chord that stays and the next one, which was removed.
    fn last_disc(&self, kept: usize, gone: usize, min_angle: f64) -> Disc {
        let (mut low, mut high) = (0.0, 1.0);
        let mut last = self.discs[kept];
        for _ in 0..24 {
            let t = (low + high) / 2.0;
            let Some(disc) = self.between([kept, gone], t) else { break };
            if disc.angle >= min_angle {
                (low, last) = (t, disc);
            } else {
                high = t;
            }
        }
        last
    }

    /// Traces the branches between discs whose number of neighbours is not two, and then the loops without such discs.
    pub(super) fn into_axis(mut self, options: &MedialOptions) -> MedialAxis {
        let mut axis = MedialAxis::default();
        let mut junction_of = vec![None; self.discs.len()];
        let junctions: Vec<usize> =
            (0..self.discs.len()).filter(|&n| !self.out[n] && self.links[n].len() != 2).collect();
        for &start in &junctions {
            self.mark(start, &mut axis, &mut junction_of);
        }
        for start in junctions.into_iter().chain(0..self.discs.len()) {
            while !self.links[start].is_empty() {
                self.mark(start, &mut axis, &mut junction_of);
                let path = self.walk(start, &junction_of);
                let ends = [path.first(), path.last()].map(|n| n.and_then(|&n| junction_of[n]));
                if let [Some(from), Some(to)] = ends {
                    axis.branches.push(Branch { nodes: self.nodes_along(&path, options), from, to });
                }
            }
        }
        axis.merged(MERGE_MM).without_noise(options.min_angle)
    }

    fn mark(&self, node: usize, axis: &mut MedialAxis, junction_of: &mut [Option<usize>]) {
        if junction_of[node].is_none() {
            junction_of[node] = Some(axis.junctions.len());
            axis.junctions.push(self.discs[node].node());
        }
    }

    /// Walks from a junction to the next and removes the links on the way.
    fn walk(&mut self, start: usize, junction_of: &[Option<usize>]) -> Vec<usize> {
        let mut path = vec![start];
        let mut here = start;
        while let Some(next) = self.links[here].pop() {
            self.unlink(next, here);
            path.push(next);
            here = next;
            if junction_of[here].is_some() {
                break;
            }
        }
        path
    }

    /// The discs as nodes: wide gaps filled in, repeated points and noise beside the curve left out.
    fn nodes_along(&self, path: &[usize], options: &MedialOptions) -> Vec<Node> {
        let mut kept: Vec<Disc> = Vec::with_capacity(path.len());
        let noise = |a: &Disc, b: &Disc, c: &Disc| {
            let turn = (b.at - a.at).angle_to(c.at - b.at).abs();
            c.at.distance(b.at) < SAME_MM || (b.angle < options.min_angle && turn > SPUR_TURN)
        };
        for disc in self.discs_along(path, options.spacing) {
            while let [.., a, b] = &kept[..]
                && noise(a, b, &disc)
            {
                kept.pop();
            }
            kept.push(disc);
        }
        // The ends are junctions and stay: drop a second node that repeats the first.
        if kept.len() > 2 && kept[1].at.distance(kept[0].at) < SAME_MM {
            kept.remove(1);
        }
        kept.iter().map(Disc::node).collect()
    }

    fn discs_along(&self, path: &[usize], spacing: f64) -> Vec<Disc> {
        let mut discs: Vec<Disc> = Vec::with_capacity(path.len());
        for pair in path.windows(2) {
            let [from, to] = [pair[0], pair[1]].map(|n| self.discs[n]);
            discs.push(from);
            let gap = from.at.distance(to.at);
            let pieces = (gap / spacing).ceil().clamp(1.0, MOST_PIECES);
            for k in 1..pieces as usize {
                let between = self.between([pair[0], pair[1]], k as f64 / pieces);
                discs.extend(between.filter(|d| d.at.distance(from.at).max(d.at.distance(to.at)) < gap));
            }
        }
        discs.extend(path.last().map(|&n| self.discs[n]));
        discs
    }
}

impl Disc {
    fn node(&self) -> Node {
        Node { at: self.at, radius: self.radius }
    }
}
