//! Layers that repeat an earlier one, as in upright parts: their verdict is known.

use super::Judgement;
use crate::layer::Layer;
use crate::pass::{Along, Pass};
use glam::DVec2;
use planar::{Polygon, Ring};
use std::collections::VecDeque;

/// Points nearer than this many grid steps count as the same: the edge of a void moves by no more.
pub(super) const NEAR: f64 = 1e-3;
/// Layers are compared with this many before them: scan lines that turn from layer to layer recur after a few.
const KEPT: usize = 4;

/// The last distinct layers and their verdicts.
#[derive(Debug, Default)]
pub(super) struct Known {
    layers: VecDeque<(Layer, Judgement)>,
}

impl Known {
    /// The verdict on a layer whose passes and outlines lie within `near` (mm) of those of this one.
    pub(super) fn find(&self, layer: &Layer, near: f64) -> Option<Judgement> {
        let alike = |known: &&(Layer, Judgement)| same_layer(&known.0, layer, near);
        let mut judgement = self.layers.iter().find(alike)?.1.clone();
        let patches = judgement.voids.iter_mut().chain(&mut judgement.peaks);
        patches.for_each(|patch| patch.layer = layer.index);
        judgement.work = 0;
        Some(judgement)
    }

    /// Keeps a computed layer, and forgets the oldest.
    pub(super) fn keep(&mut self, layer: &Layer, judgement: &Judgement) {
        if judgement.work > 0 {
            self.layers.truncate(KEPT - 1);
            self.layers.push_front((layer.clone(), judgement.clone()));
        }
    }
}

fn same_layer(a: &Layer, b: &Layer, near: f64) -> bool {
    all(&a.passes, &b.passes, |a, b| same_pass(a, b, near))
        && all(&a.islands, &b.islands, |a, b| same_island(a, b, near))
}

fn same_pass(a: &Pass, b: &Pass, near: f64) -> bool {
    (a.kind, a.closed) == (b.kind, b.closed)
        && same_values(&a.width, &b.width)
        && same_values(&a.pace, &b.pace)
        && all(&a.points, &b.points, |a, b| same_point(a.truncate(), b.truncate(), near))
}

fn same_island(a: &Polygon, b: &Polygon, near: f64) -> bool {
    let same_ring = |a: &Ring, b: &Ring| all(a.points(), b.points(), |a, b| same_point(*a, *b, near));
    same_ring(&a.outer, &b.outer) && all(&a.holes, &b.holes, same_ring)
}

fn same_values(a: &Along, b: &Along) -> bool {
    match (a, b) {
        (Along::Same(a), Along::Same(b)) => near_value(*a, *b),
        (Along::Each(a), Along::Each(b)) => all(a, b, |a, b| near_value(*a, *b)),
        _ => false,
    }
}

/// Whether widths or paces agree to a millionth: heights vary in proportion.
fn near_value(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-6 * a.abs()
}

fn same_point(a: DVec2, b: DVec2, near: f64) -> bool {
    a.distance_squared(b) <= near * near
}

fn all<T>(a: &[T], b: &[T], same: impl Fn(&T, &T) -> bool) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| same(a, b))
}
