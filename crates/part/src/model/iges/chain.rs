//! Puts the parts of a composite in sequence.
//!
//! The standard requires them in order and direction; some programs (Parasolid among them) write them differently.

use crate::curve::Nurbs;
use glam::DVec3;
use std::collections::VecDeque;

/// The parts of a composite, and how they were listed.
pub(super) enum Chain {
    /// As the standard requires.
    InOrder(Vec<Nurbs>),
    /// They meet, but in another order or direction; here they are in the order in which they meet.
    Reordered(Vec<Nurbs>),
    /// They do not meet; the widest gap between the parts as listed, in units of the file.
    Gap(Vec<Nurbs>, f64),
}

/// Puts parts in order; ends within `tolerance` of each other meet.
pub(super) fn join(parts: Vec<Nurbs>, tolerance: f64) -> Chain {
    let ends: Vec<[DVec3; 2]> = parts.iter().map(ends).collect();
    let widest = ends.windows(2).map(|w| w[0][1].distance(w[1][0])).fold(0.0, f64::max);
    if widest <= tolerance {
        return Chain::InOrder(parts);
    }
    match order(&ends, tolerance) {
        Some(order) => {
            let part = |(i, backwards): (usize, bool)| if backwards { parts[i].reversed() } else { parts[i].clone() };
            Chain::Reordered(order.into_iter().map(part).collect())
        }
        None => Chain::Gap(parts, widest),
    }
}

fn ends(curve: &Nurbs) -> [DVec3; 2] {
    let (start, end) = curve.domain();
    [curve.point(start), curve.point(end)]
}

/// Indices of the parts in the order in which they meet, and whether each runs backwards; the first one does not.
fn order(ends: &[[DVec3; 2]], tolerance: f64) -> Option<VecDeque<(usize, bool)>> {
    let mut order = VecDeque::from([(0, false)]);
    let [mut head, mut tail] = *ends.first()?;
    let mut rest: Vec<usize> = (1..ends.len()).collect();
    while !rest.is_empty() {
        let find = |end: usize, point: DVec3| rest.iter().position(|&i| ends[i][end].distance(point) <= tolerance);
        // Forward ones first: end 0 at the tail, or end 1 at the head.
        let (at, end, behind) = None
            .or_else(|| find(0, tail).map(|at| (at, 0, true)))
            .or_else(|| find(1, head).map(|at| (at, 1, false)))
            .or_else(|| find(1, tail).map(|at| (at, 1, true)))
            .or_else(|| find(0, head).map(|at| (at, 0, false)))?;
        let i = rest.remove(at);
        let other = ends[i][1 - end];
        if behind {
            order.push_back((i, end == 1));
            tail = other;
        } else {
            order.push_front((i, end == 0));
            head = other;
        }
    }
    Some(order)
}
