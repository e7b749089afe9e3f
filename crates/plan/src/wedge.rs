//! Layers that are thicker at some places than at others: wedges of a guide.
//!
//! Everything between slicing and welding sees a layer of even thickness. Only at the end, more metal is laid where it is thicker
//! ([`Wedge::laid`]); the deposit model, which looks at the chart, is shown it as it was before ([`Wedge::even`]).
//!
//! How thin and how thick a bead can be is limited. Where a bend is so tight that the outer side of a layer would be too thick, that side is
//! welded in two layers, of which the lower covers it alone: the upper one has the same underside, and half of its thickness where
//! the lower one lies ([`Half`]).

use crate::layer::Layer;
use crate::pass::{Along, Pass, Segment};
use bead_part::chart::{Chart, Sheet};
use bead_part::slice::Half;
use bead_part::warning::{Warning, WarningKind};
use glam::DVec2;
use planar::{Polygon, Ring};

/// Pieces along which a layer's thickness changes by more than this part are divided.
const STEP: f64 = 0.03;
/// Nothing is thinner than this part of its layer, so that paces stay finite; such layers are refused.
pub const THINNEST: f64 = 0.05;
/// Where the rise differs by no more than this from that at an edge, the edge is near.
const AT_EDGE: f64 = 0.02;
/// Points of a piece lie farther apart than this part of its steps.
const APART: f64 = 0.05;
/// A layer may leave its window by this part, which is what rounding to whole layers takes.
pub const TOLERANCE: f64 = 0.03;

/// The thickness of a layer that is not the same everywhere.
pub struct Wedge<'a> {
    sheet: Sheet<'a>,
    /// As in the chart, mm.
    height: f64,
    /// Thinnest and thickest that it may be, mm.
    window: (f64, f64),
    half: Option<Half>,
}

impl<'a> Wedge<'a> {
    /// The wedge that a layer of a chart is, whose beads may be as thin and as thick as `window` says, mm; `None` where layers are
    /// even.
    pub fn of(layer: &Layer, chart: &'a Chart, window: (f64, f64)) -> Option<Self> {
        let sheet = chart.has_wedges().then(|| chart.sheet(layer.middle()))?;
        Some(Self { sheet, height: layer.height, window, half: layer.half })
    }

    /// Thickness of the beads at a place, mm.
    fn thickness(&self, p: DVec2) -> f64 {
        self.height * self.sheet.rise(p) / self.parts(p)
    }

    /// The rise from which on the lower of two layers lies below.
    fn thick(&self) -> Option<f64> {
        (self.half == Some(Half::Upper)).then_some(self.window.1 / self.height)
    }

    /// Whether a piece crosses the edge of the lower of two layers or lies near it: its own metal changes there.
    pub fn is_on_edge(&self, piece: &Segment) -> bool {
        let Some(thick) = self.thick() else { return false };
        let [from, to] = [piece.from, piece.to].map(|p| self.sheet.rise(p.truncate()) - thick);
        from * to <= 0.0 || from.abs().min(to.abs()) < AT_EDGE
    }

    /// How much more metal a piece needs than one of a layer of even thickness that is filled as usual.
    pub fn thicker(&self, piece: &Segment, usual: f64) -> f64 {
        let middle = piece.from.midpoint(piece.to).truncate();
        let own = if self.half.is_some() { self.own(middle) / usual } else { 1.0 };
        own * self.sheet.rise(middle).max(THINNEST)
    }

    fn parts(&self, p: DVec2) -> f64 {
        if self.thick().is_some_and(|thick| self.sheet.rise(p) > thick) { 2.0 } else { 1.0 }
    }

    /// What of the height of the layer in the chart its own beads fill at a place, mm.
    pub fn own(&self, p: DVec2) -> f64 {
        self.height / self.parts(p)
    }

    /// Passes of the usual height (mm), the two layers of a pair with the metal that each needs.
    pub fn paired(&self, passes: &mut [Pass], usual: f64) {
        if self.half.is_some() {
            let pace = |pace: f64, p: DVec2| pace * usual / self.own(p);
            passes.iter_mut().for_each(|pass| *pass = paced(pass, pace, &self.sheet, self.thick()));
        }
    }

    /// Back from [`Self::paired`].
    pub fn single(&self, passes: &mut [Pass], usual: f64) {
        if self.half.is_some() {
            passes.iter_mut().for_each(|pass| *pass = each_paced(pass, |pace, p| pace * self.own(p) / usual));
        }
    }

    /// Passes with the metal of the wedge.
    pub fn laid(&self, passes: &mut [Pass]) {
        let rise = |p| self.sheet.rise(p).max(THINNEST);
        passes.iter_mut().for_each(|pass| *pass = paced(pass, |pace, p| pace / rise(p), &self.sheet, None));
    }

    /// Back from [`Self::laid`].
    pub fn even(&self, passes: &mut [Pass]) {
        let rise = |p| self.sheet.rise(p).max(THINNEST);
        passes.iter_mut().for_each(|pass| *pass = each_paced(pass, |pace, p| pace * rise(p)));
    }

    /// Volume of the whole wedge, with what the lower of two holds of it, mm³.
    pub fn volume(&self, islands: &[Polygon]) -> f64 {
        let of = |ring: &Ring| ring.area() * ring.centroid().map_or(1.0, |at| self.sheet.rise(at));
        self.height * islands.iter().flat_map(Polygon::rings).map(of).sum::<f64>()
    }

    /// A warning of the place at which the layer leaves its window farthest.
    pub fn doubt(&self, layer: &Layer) -> Option<Warning> {
        let (thinnest, thickest) = (self.window.0 * (1.0 - TOLERANCE), self.window.1 * (1.0 + TOLERANCE));
        let off = |p: &DVec2| (self.thickness(*p) - thickest).max(thinnest - self.thickness(*p));
        let corners = layer.islands.iter().flat_map(|island| island.outer.points()).copied();
        let place = corners.max_by(|a, b| off(a).total_cmp(&off(b)))?;
        let (size, kind) = (off(&place), WarningKind::LayerThickness);
        (size > 0.0).then_some(Warning { kind, layer: layer.index, place, size })
    }
}

/// A pass with another pace everywhere, divided where the thickness of its layer changes, and where `thick` begins.
fn paced(pass: &Pass, pace: impl Fn(f64, DVec2) -> f64, sheet: &Sheet<'_>, thick: Option<f64>) -> Pass {
    let (mut points, mut widths, mut paces) = (Vec::new(), Vec::new(), Vec::new());
    for piece in pass.segments() {
        let rises = [piece.from, piece.to].map(|p| sheet.rise(p.truncate()).max(THINNEST));
        let parts = parts(rises, thick);
        for (k, from) in parts.iter().enumerate() {
            let to = parts.get(k + 1).unwrap_or(&1.0);
            points.push(piece.from.lerp(piece.to, *from));
            widths.push(piece.width);
            paces.push(pace(piece.pace, piece.from.lerp(piece.to, from.midpoint(*to)).truncate()));
        }
    }
    if let (Some(last), false) = (pass.points.last(), pass.closed) {
        points.push(*last);
        widths.extend(widths.last().copied());
        paces.extend(paces.last().copied());
    }
    Pass { points, width: along(widths), pace: along(paces), ..pass.clone() }
}

/// Where the parts of a piece begin between whose ends the rise changes, as parts of its length.
fn parts([from, to]: [f64; 2], thick: Option<f64>) -> Vec<f64> {
    let count = ((to / from).ln().abs() / STEP).ceil().max(1.0);
    let mut parts: Vec<f64> = (0..count as usize).map(|k| k as f64 / count).collect();
    let at = thick.map(|thick| (thick - from) / (to - from)).filter(|at| *at > 0.0 && *at < 1.0);
    if let Some(at) = at.filter(|at| parts.iter().all(|part| (part - at).abs() > APART / count)) {
        parts.push(at);
        parts.sort_by(f64::total_cmp);
    }
    parts
}

/// A pass with another pace on each of its pieces.
fn each_paced(pass: &Pass, pace: impl Fn(f64, DVec2) -> f64) -> Pass {
    let mut paces: Vec<f64> =
        pass.segments().map(|piece| pace(piece.pace, piece.from.midpoint(piece.to).truncate())).collect();
    if !pass.closed {
        paces.extend(paces.last().copied());
    }
    Pass { pace: along(paces), ..pass.clone() }
}

fn along(values: Vec<f64>) -> Along {
    match values.split_first() {
        Some((&first, others)) if others.iter().all(|value| *value == first) => Along::Same(first),
        _ => Along::Each(values),
    }
}
