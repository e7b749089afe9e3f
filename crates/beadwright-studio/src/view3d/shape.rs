//! What stands around the part: bodies of revolution and boxes, and the floor. They are drawn, no more.

use beadwright::robot::Frame;
use glam::DVec3;
use std::f64::consts::FRAC_PI_2;

/// Edges of cylinders are broken by this share of their radius, and by this much at most, mm.
const CHAMFER: (f64, f64) = (0.12, 8.0);
/// Steps from the side of a round end to its tip.
const ROUND: usize = 12;

/// What a body is, which gives its colour.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Look {
    /// A link of the arm, or what carries the part.
    Link,
    /// A joint.
    Joint,
    /// The torch.
    Torch,
    /// A table, or a stand.
    Table,
}

/// A body around the part.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// A body of revolution.
    Turned {
        /// Where its axis begins, mm.
        from: DVec3,
        /// The direction of its axis, of length 1.
        axis: DVec3,
        /// How far along the axis, and how far from it, mm.
        rings: Vec<[f64; 2]>,
        /// What it is.
        look: Look,
    },
    /// A box.
    Block {
        /// The corner at which its edges begin, mm.
        corner: DVec3,
        /// The three edges from there, mm.
        edges: [DVec3; 3],
        /// What it is.
        look: Look,
    },
}

/// The floor with its grid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Floor {
    /// The middle of what is shown of it, and the directions of its lines.
    pub frame: Frame,
    /// From there to where it ends, mm.
    pub half: f64,
}

impl Shape {
    /// A cylinder from one place to another, its edges broken.
    pub fn cylinder([from, to]: [DVec3; 2], radius: f64, look: Look) -> Self {
        let length = from.distance(to);
        let edge = (CHAMFER.0 * radius).min(CHAMFER.1).min(length / 2.0);
        let rings = [[0.0, 0.0], [0.0, radius - edge], [edge, radius], [length - edge, radius]];
        let rings = rings.into_iter().chain([[length, radius - edge], [length, 0.0]]).collect();
        Self::Turned { from, axis: (to - from).normalize_or(DVec3::Z), rings, look }
    }

    /// A cylinder about a place, along a direction of length 1.
    pub fn drum(middle: DVec3, along: DVec3, length: f64, radius: f64, look: Look) -> Self {
        let half = along * (length / 2.0);
        Self::cylinder([middle - half, middle + half], radius, look)
    }

    /// A leg: flat below, tapered, with a round upper end.
    pub fn leg([foot, top]: [DVec3; 2], [first, last]: [f64; 2], look: Look) -> Self {
        let mut leg = Self::link([foot, top], [first, last], look);
        if let Self::Turned { rings, .. } = &mut leg {
            rings.iter_mut().take(ROUND).for_each(|ring| ring[0] = 0.0);
        }
        leg
    }

    /// A link with round ends of different size.
    pub fn link([from, to]: [DVec3; 2], [first, last]: [f64; 2], look: Look) -> Self {
        let length = from.distance(to);
        let round = |k: usize| (k as f64 / ROUND as f64 * FRAC_PI_2).sin_cos();
        let begin = (0..=ROUND).map(round).map(|(sin, cos)| [-first * cos, first * sin]);
        let end = (0..=ROUND).rev().map(round).map(|(sin, cos)| [length + last * cos, last * sin]);
        Self::Turned { from, axis: (to - from).normalize_or(DVec3::Z), rings: begin.chain(end).collect(), look }
    }

    /// A box between two corners of a frame.
    pub fn block(frame: &Frame, [low, high]: [DVec3; 2], look: Look) -> Self {
        let [x, y, z] = (high - low).to_array();
        let edges = [DVec3::X * x, DVec3::Y * y, DVec3::Z * z].map(|edge| frame.rotation * edge);
        Self::Block { corner: frame.apply(low), edges, look }
    }

    /// The same elsewhere.
    pub fn moved(mut self, by: &Frame) -> Self {
        match &mut self {
            Self::Turned { from, axis, .. } => (*from, *axis) = (by.apply(*from), by.rotation * *axis),
            Self::Block { corner, edges, .. } => {
                *corner = by.apply(*corner);
                edges.iter_mut().for_each(|edge| *edge = by.rotation * *edge);
            }
        }
        self
    }

    /// Places between which it lies, mm.
    pub fn bounds(&self) -> Vec<DVec3> {
        match self {
            Self::Turned { from, axis, rings, .. } => {
                let around = |radius: f64| {
                    let (i, j) = axis.any_orthonormal_pair();
                    [i, -i, j, -j].map(|side| side * radius)
                };
                rings.iter().flat_map(|[along, radius]| around(*radius).map(|by| *from + *axis * *along + by)).collect()
            }
            Self::Block { corner, edges: [x, y, z], .. } => {
                let part = |bit: usize, edge: &DVec3, k: usize| if k >> bit & 1 == 1 { *edge } else { DVec3::ZERO };
                (0..8).map(|k| *corner + part(0, x, k) + part(1, y, k) + part(2, z, k)).collect()
            }
        }
    }
}
