//! Moves the starts of closed passes beside those of the layers below, so that humps do not grow into a tower.

use super::{OrderSettings, Seam, begin_at};
use crate::fill::Path;
use glam::{DVec2, IVec2};
use planar::polyline::point_at;
use rustc_hash::FxHashMap;
use std::collections::VecDeque;

/// Number of layers below whose starts are avoided.
const LAYERS: usize = 5;
/// Least distance between starts, in bead widths.
const APART: f64 = 0.5;
/// Positions tried per bead width.
const PLACES: f64 = 10.0;

/// The starts of the last layers, the lowest first.
#[derive(Debug, Clone, Default)]
pub(super) struct Seams(VecDeque<Starts>);

/// The starts of a layer, binned in squares.
type Starts = FxHashMap<IVec2, Vec<DVec2>>;

impl Seams {
    /// Moves the starts of closed passes by the shortest distance away from those of the layers below, unless seams are
    /// to be aligned, and remembers them for the layers above. A pass without such a position keeps its start.
    pub(super) fn settle(&mut self, passes: Vec<Path>, settings: &OrderSettings) -> Vec<Path> {
        if settings.seam == Seam::Aligned || settings.bead_width <= 0.0 {
            return passes;
        }
        let apart = APART * settings.bead_width;
        let settle = |pass: Path| match self.free_place(&pass, settings.bead_width) {
            Some(place) => begin_at(pass, place),
            None => pass,
        };
        let passes: Vec<Path> = passes.into_iter().map(settle).collect();
        let mut starts = Starts::default();
        for start in passes.iter().filter_map(|pass| pass.points.first()) {
            starts.entry(square(*start, apart)).or_default().push(*start);
        }
        self.0.push_back(starts);
        if self.0.len() > LAYERS {
            self.0.pop_front();
        }
        passes
    }

    /// A better start for a closed pass; `None` if its start is good, or no other is better.
    fn free_place(&self, pass: &Path, width: f64) -> Option<DVec2> {
        let start = *pass.points.first().filter(|_| pass.closed)?;
        if self.is_free(start, APART * width) {
            return None;
        }
        let (path, length, step) = (pass.path(), pass.length(), width / PLACES);
        let places = (1..=(length / 2.0 / step) as usize).flat_map(|n| [n as f64 * step, length - n as f64 * step]);
        places.filter_map(|along| point_at(&path, along)).find(|place| self.is_free(*place, APART * width))
    }

    fn is_free(&self, place: DVec2, apart: f64) -> bool {
        let middle = square(place, apart);
        let around = (-1..=1).flat_map(|x| (-1..=1).map(move |y| middle + IVec2::new(x, y)));
        let mut near = around.flat_map(|square| self.0.iter().filter_map(move |starts| starts.get(&square)).flatten());
        near.all(|start| start.distance(place) >= apart)
    }
}

fn square(place: DVec2, side: f64) -> IVec2 {
    (place / side).floor().as_ivec2()
}
