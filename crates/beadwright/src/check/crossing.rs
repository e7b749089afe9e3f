//! Passes over a bead of their own layer.

use super::{Check, Finding, Subject};
use crate::layer::Layer;
use glam::DVec2;
use rstar::primitives::{GeomWithData, Line};
use rstar::{AABB, RTree, RTreeObject};

pub(super) const CHECK: Check = Check {
    name: "crossing",
    what: "passes that cross a bead laid before in the same layer",
    why: "metal is laid twice there; the hump grows from layer to layer until the torch hits it",
    example: "layer 1, pass 3, x 12.0 y 8.0 z 2.00 mm: it crosses pass 1.",
    remedy: "end the pass before the bead, or take a strategy whose passes do not cross",
    find,
};

type Piece = GeomWithData<Line<[f64; 2]>, (usize, usize)>;

fn find(subject: &Subject<'_>) -> Vec<Finding> {
    subject.layers.iter().copied().flat_map(in_layer).collect()
}

fn in_layer(layer: &Layer) -> Vec<Finding> {
    let pieces = layer.passes.iter().enumerate().flat_map(|(i, pass)| {
        let ends = |(k, s): (usize, crate::pass::Segment)| {
            let (a, b) = (s.from.truncate(), s.to.truncate());
            GeomWithData::new(Line::new(a.to_array(), b.to_array()), (i, k))
        };
        pass.segments().filter(|s| s.from.is_finite() && s.to.is_finite()).enumerate().map(ends).collect::<Vec<Piece>>()
    });
    let tree = RTree::bulk_load(pieces.collect());
    let crossed = |i: usize| {
        let own = tree.iter().filter(|piece| piece.data.0 == i);
        own.flat_map(|piece| {
            let around: AABB<[f64; 2]> = piece.envelope();
            tree.locate_in_envelope_intersecting(&around).filter_map(move |other| {
                let before = other.data.0 < i || (other.data.0 == i && other.data.1 + 1 < piece.data.1);
                Some((other.data.0, crossing(piece, other).filter(|_| before)?))
            })
        })
        .next()
    };
    let finding = |i: usize| {
        let (other, place) = crossed(i)?;
        let text = format!("it crosses pass {}.", other + 1);
        Some(Finding::of_pass(&CHECK, layer, i, Some(place.extend(layer.z)), text))
    };
    (0..layer.passes.len()).filter_map(finding).collect()
}

/// Where two pieces cross, their ends not counted.
fn crossing(a: &Piece, b: &Piece) -> Option<DVec2> {
    const INNER: f64 = 1e-6;
    let [p, q, r, s] = [a.geom().from, a.geom().to, b.geom().from, b.geom().to].map(DVec2::from);
    let (u, v) = (q - p, s - r);
    let across = u.perp_dot(v);
    let (t, w) = ((r - p).perp_dot(v) / across, (r - p).perp_dot(u) / across);
    let inside = |x: f64| (INNER..1.0 - INNER).contains(&x);
    (across != 0.0 && inside(t) && inside(w)).then(|| p + u * t)
}
