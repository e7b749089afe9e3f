//! Passes that go around an axis more than once: their points run on from turn to turn in unrolled coordinates, while
//! whatever judges or draws a layer sees each turn within the layer unrolled once, where its metal lies.

use super::cover;
use crate::chart::Chart;
use crate::fill::around::{self, Turn};
use crate::fill::{Fill, Path};
use crate::layer::Layer;
use crate::pass::{Along, Pass, Segment};
use crate::profile::{LayersSection, Profile};
use crate::slice::{Slice, middle};
use crate::warning::Warning;
use glam::{DVec2, DVec3};
use planar::{Bounds, Polygon, Ring};
use std::borrow::Cow;

/// Pieces shorter than this are ignored, mm.
const NOTHING: f64 = 1e-6;

/// How layers that go around an axis are unrolled.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Unrolling<'p> {
    /// How layers lie in space.
    pub(crate) layers: &'p LayersSection,
    /// Width of the nominal bead, mm.
    pub(crate) bead_width: f64,
    /// How far beads may reach beyond the outline, mm.
    pub(crate) allowance: f64,
}

impl Unrolling<'_> {
    /// A turn of a slice of the only body; `None` where its layers do not close around an axis. `most` is the greatest
    /// number of turns.
    pub(super) fn turn(&self, slice: &Slice, most: f64) -> Option<Turn> {
        let length = turn(&self.layers.chart, middle(slice.z, slice.height, slice.half))?;
        Some(Turn { length, most })
    }

    /// A layer in which every pass lies within one turn.
    pub(super) fn once<'l>(&self, layer: &'l Layer) -> Cow<'l, Layer> {
        match self.bands(layer) {
            Some(bands) => {
                let (passes, beyond) = (bands.cut(&layer.passes).0, bands.beyond(self.bead_width));
                Cow::Owned(Layer { passes, beyond, ..layer.clone() })
            }
            None => Cow::Borrowed(layer),
        }
    }

    /// The bands of a layer; `None` where no pass goes around more than once.
    pub(crate) fn bands(&self, layer: &Layer) -> Option<Bands> {
        let turn = turn(self.layers.chart_of(layer), layer.middle())?;
        self.bands_among(&layer.islands, turn).filter(|bands| layer.passes.iter().any(|pass| bands.goes_on(pass)))
    }

    /// The bands among some islands; `turn` in mm.
    fn bands_among(&self, islands: &[Polygon], turn: f64) -> Option<Bands> {
        let width = self.bead_width;
        // Beads may reach beyond the outline, and may be moved there.
        let beyond = DVec2::new(0.0, self.allowance);
        let band = |island| around::band(island, turn, width);
        let wider = |band: Bounds| Bounds { min: band.min - beyond, max: band.max + beyond };
        let bands: Vec<Bounds> = islands.iter().filter_map(band).map(wider).collect();
        let own = Bands { bands, turn, beyond: self.allowance + width };
        (turn > width && !own.bands.is_empty()).then_some(own)
    }

    /// The fill of an island, cut where the next turn begins.
    pub(super) fn fill_once<'f>(&self, fill: &'f Fill, island: &Polygon, turn: Option<Turn>) -> Cow<'f, Fill> {
        let islands = std::slice::from_ref(island);
        let Some(bands) = turn.and_then(|turn| self.bands_among(islands, turn.length)) else {
            return Cow::Borrowed(fill);
        };
        let flat = |path: &Path| Pass {
            kind: path.kind,
            closed: path.closed,
            points: path.points.iter().map(|p| p.extend(0.0)).collect(),
            width: path.width.clone(),
            pace: Along::Same(1.0),
            wait: 0.0,
        };
        let once = |stage: &Vec<Path>| {
            let passes: Vec<Pass> = stage.iter().map(flat).collect();
            bands.cut(&passes).0.iter().map(cover::path).collect()
        };
        Cow::Owned(Fill { stages: fill.stages.iter().map(once).collect(), ..*fill })
    }
}

/// Length of a turn of the layer whose middle is at this height (mm); `None` where layers do not close around an axis.
fn turn(chart: &Chart, middle: f64) -> Option<f64> {
    let sheet = chart.sheet(middle);
    sheet.turned(DVec2::ZERO, 1.0).map(|end| end.x.abs())
}

/// A layer in which every pass lies within one turn: passes that run on are cut where the next turn begins. A layer
/// without such passes is returned as it is.
pub fn unrolled_once<'a>(layer: &'a Layer, profile: &Profile) -> Cow<'a, Layer> {
    Unrolling::of(profile).once(layer)
}

/// A layer to be drawn unrolled once: passes that go around more than once jump back where the next turn begins, along
/// the bead that they have just laid and with almost no width.
pub fn drawn<'a>(layer: &'a Layer, profile: &Profile) -> Cow<'a, Layer> {
    let Some(bands) = Bands::of_layer(layer, profile) else { return Cow::Borrowed(layer) };
    let (pieces, of) = bands.cut(&layer.passes);
    let mut passes: Vec<Pass> = Vec::with_capacity(layer.passes.len());
    for (piece, index) in pieces.into_iter().zip(of) {
        match passes.get_mut(index) {
            Some(pass) => {
                let (end, start) = (pass.end().unwrap_or_default(), piece.start().unwrap_or_default());
                let jump = Segment { from: end, to: start, width: HAIR, pace: AT_ONCE };
                let segments: Vec<Segment> = pass.segments().chain([jump]).chain(piece.segments()).collect();
                *pass = pass.of_pieces(&segments);
            }
            None => passes.push(piece),
        }
    }
    let place = |warning: &Warning| Warning { place: bands.place(warning.place), ..*warning };
    let warnings = layer.warnings.iter().map(place).collect();
    Cow::Owned(Layer { passes, warnings, ..layer.clone() })
}

/// Width (mm) and pace (mm/s) of a jump in a picture.
const HAIR: f64 = 0.001;
const AT_ONCE: f64 = 1e6;

/// Whether a piece of a drawn pass is not a bead but the jump to the next turn.
pub fn is_jump(piece: &Segment) -> bool {
    piece.width <= HAIR
}

/// The islands of a layer that go all around and have passes that go around more than once.
pub struct Bands {
    bands: Vec<Bounds>,
    /// Length of a turn, mm.
    turn: f64,
    /// A pass that runs on reaches more than this beyond its island, mm: beads may lie on an allowance.
    beyond: f64,
}

impl Bands {
    /// The bands of a layer; `None` where no pass goes around more than once.
    pub fn of_layer(layer: &Layer, profile: &Profile) -> Option<Self> {
        Unrolling::of(profile).bands(layer)
    }

    fn goes_on(&self, pass: &Pass) -> bool {
        let is_finite = pass.points.iter().all(|p| p.is_finite());
        self.around(pass).filter(|_| is_finite && !pass.closed).is_some_and(|band| {
            let outside = |p: &DVec3| p.x < band.min.x - self.beyond || p.x > band.max.x + self.beyond;
            pass.points.iter().any(outside)
        })
    }

    /// The island that a pass goes around.
    fn around(&self, pass: &Pass) -> Option<&Bounds> {
        let start = pass.start().filter(|start| start.is_finite())?;
        self.band_at(start.truncate())
    }

    fn band_at(&self, p: DVec2) -> Option<&Bounds> {
        self.bands.iter().find(|band| (band.min.y..=band.max.y).contains(&p.y))
    }

    /// How many turns a place lies after the beginning of its band.
    fn turns(&self, band: &Bounds, x: f64) -> f64 {
        ((x - band.min.x) / self.turn).floor()
    }

    /// A piece of a pass moved, as a whole, onto the layer unrolled once.
    pub fn piece(&self, piece: Segment) -> Segment {
        let middle = piece.from.midpoint(piece.to).truncate();
        let on = (self.place(middle) - middle).extend(0.0);
        Segment { from: piece.from + on, to: piece.to + on, ..piece }
    }

    /// A place of a pass on the layer unrolled once.
    pub(crate) fn place(&self, p: DVec2) -> DVec2 {
        let on = |band: &Bounds| p - DVec2::new(self.turns(band, p.x) * self.turn, 0.0);
        self.band_at(p).map_or(p, on)
    }

    /// Passes cut where they come to the next turn, each piece on the layer unrolled once, and for each piece the index
    /// of its pass.
    pub(crate) fn cut(&self, passes: &[Pass]) -> (Vec<Pass>, Vec<usize>) {
        let pieces = |(index, pass): (usize, &Pass)| {
            let band = self.around(pass).filter(|_| self.goes_on(pass));
            let pieces = band.map_or_else(|| vec![pass.clone()], |band| self.pieces(pass, band));
            pieces.into_iter().map(move |piece| (piece, index)).collect::<Vec<_>>()
        };
        passes.iter().enumerate().flat_map(pieces).unzip()
    }

    fn pieces(&self, pass: &Pass, band: &Bounds) -> Vec<Pass> {
        let mut pieces: Vec<(f64, Vec<Segment>)> = Vec::new();
        for segment in pass.segments().flat_map(|segment| self.within_turns(segment, band)) {
            let turns = self.turns(band, segment.from.x.midpoint(segment.to.x));
            let back = DVec3::new(turns * self.turn, 0.0, 0.0);
            let segment = Segment { from: segment.from - back, to: segment.to - back, ..segment };
            match pieces.last_mut() {
                Some((same, piece)) if *same == turns => piece.push(segment),
                _ => pieces.push((turns, vec![segment])),
            }
        }
        let waits = std::iter::once(pass.wait).chain(std::iter::repeat(0.0));
        pieces.iter().zip(waits).map(|((_, piece), wait)| Pass { wait, ..pass.of_pieces(piece) }).collect()
    }

    /// A piece cut at the seams that it crosses.
    fn within_turns(&self, segment: Segment, band: &Bounds) -> Vec<Segment> {
        let [from, to] = [segment.from.x, segment.to.x];
        let (low, high) = (from.min(to) + NOTHING, from.max(to) - NOTHING);
        let first = self.turns(band, low) as i64 + 1;
        let seams = (first..=self.turns(band, high) as i64).map(|k| band.min.x + k as f64 * self.turn);
        let mut cuts: Vec<f64> = seams.map(|seam| (seam - from) / (to - from)).collect();
        if to < from {
            cuts.reverse();
        }
        let ends = std::iter::once(0.0).chain(cuts).chain([1.0]).collect::<Vec<_>>();
        let at = |part: f64| segment.from.lerp(segment.to, part);
        ends.windows(2).map(|ends| Segment { from: at(ends[0]), to: at(ends[1]), ..segment }).collect()
    }

    /// Strips beyond both ends of each island, one bead wide: the ends of a turn reach there, as metal of the next
    /// turn.
    fn beyond(&self, width: f64) -> Vec<Polygon> {
        let strip = |from: f64, band: &Bounds| {
            let (low, high) = (DVec2::new(from, band.min.y), DVec2::new(from + width, band.max.y));
            Polygon::simple(Ring::new(vec![low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)]))
        };
        self.bands.iter().flat_map(|band| [strip(band.min.x - width, band), strip(band.max.x, band)]).collect()
    }

    /// The passes cut by [`Self::cut`], joined again, whatever has happened to the pieces meanwhile; `of` gives the
    /// pass of each piece.
    pub(crate) fn joined(&self, pieces: Vec<Pass>, of: &[usize]) -> Vec<Pass> {
        let mut joined: Vec<(usize, Pass)> = Vec::new();
        for (piece, &index) in pieces.into_iter().zip(of) {
            match joined.last_mut() {
                Some((same, pass)) if *same == index => self.append(pass, &piece),
                _ => joined.push((index, piece)),
            }
        }
        joined.into_iter().map(|(_, pass)| pass).collect()
    }

    /// Appends the next turn to a pass. They meet halfway if one of them was moved.
    fn append(&self, pass: &mut Pass, next: &Pass) {
        let (Some(end), Some(start)) = (pass.end(), next.start()) else { return };
        let on = DVec3::new(((end.x - start.x) / self.turn).round() * self.turn, 0.0, 0.0);
        let mut segments: Vec<Segment> = pass.segments().collect();
        let meet = end.midpoint(start + on);
        segments.iter_mut().last().into_iter().for_each(|last| last.to = meet);
        let more = next.segments().map(|s| Segment { from: s.from + on, to: s.to + on, ..s });
        let more = more.enumerate().map(|(i, s)| if i == 0 { Segment { from: meet, ..s } } else { s });
        segments.extend(more);
        *pass = pass.of_pieces(&segments);
    }
}
