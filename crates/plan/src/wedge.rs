//! Layers of varying thickness: wedges of a guide.
//!
//! Everything between slicing and welding sees a layer of even thickness. Only at the end is metal added where the
//! layer is thicker ([`Wedge::laid`]); the deposit model, which takes the chart into account, gets the passes from
//! before that ([`Wedge::even`]).
//!
//! The thickness of a bead is limited. Where a bend is so tight that the outer side of a layer would be too thick, that
//! side is welded in two layers. The lower one covers only that side; the upper one has the same underside, and half of
//! its thickness where the lower one lies ([`Half`]).

use crate::layer::Layer;
use crate::pass::{Along, Pass, Segment};
use bead_part::chart::{Chart, Sheet};
use bead_part::slice::Half;
use bead_part::warning::{Warning, WarningKind};
use glam::DVec2;
use planar::{Polygon, Ring};

/// Pieces along which a layer's thickness changes by more than this fraction are divided.
const STEP: f64 = 0.03;
/// Least thickness of a bead, as a fraction of its layer, so that paces stay finite; thinner layers are refused.
pub const THINNEST: f64 = 0.05;
/// An edge is near where the rise differs from that at the edge by at most this.
const AT_EDGE: f64 = 0.02;
/// Least distance of two division points of a piece, as a fraction of its step.
const APART: f64 = 0.05;
/// A layer may leave its window by this fraction, to allow for rounding to whole layers.
pub const TOLERANCE: f64 = 0.03;

/// A layer of varying thickness.
pub struct Wedge<'a> {
    sheet: Sheet<'a>,
    /// Thickness in the chart, mm.
    height: f64,
    /// Least and greatest thickness of a bead, mm.
    window: (f64, f64),
    half: Option<Half>,
}

impl<'a> Wedge<'a> {
    /// The wedge of a layer in a chart; `window` is the least and the greatest thickness of its beads, mm. `None` where
    /// layers are even.
    pub fn of(layer: &Layer, chart: &'a Chart, window: (f64, f64)) -> Option<Self> {
        let sheet = chart.has_wedges().then(|| chart.sheet(layer.middle()))?;
        Some(Self { sheet, height: layer.height, window, half: layer.half })
    }

    /// Thickness of the beads at a point, mm.
    fn thickness(&self, p: DVec2) -> f64 {
        self.height * self.sheet.rise(p) / self.parts(p)
    }

    /// The rise above which the lower of two layers lies below this one.
    fn thick(&self) -> Option<f64> {
        (self.half == Some(Half::Upper)).then_some(self.window.1 / self.height)
    }

    /// Whether a piece crosses or nearly touches the edge of the lower of two layers, where its own metal changes.
    pub fn is_on_edge(&self, piece: &Segment) -> bool {
        let Some(thick) = self.thick() else { return false };
        let [from, to] = [piece.from, piece.to].map(|p| self.sheet.rise(p.truncate()) - thick);
        from * to <= 0.0 || from.abs().min(to.abs()) < AT_EDGE
    }

    /// The metal of a piece, relative to a piece in a layer of even thickness `usual` (mm).
    pub fn thicker(&self, piece: &Segment, usual: f64) -> f64 {
        let middle = piece.from.midpoint(piece.to).truncate();
        let own = if self.half.is_some() { self.own(middle) / usual } else { 1.0 };
        own * self.sheet.rise(middle).max(THINNEST)
    }

    fn parts(&self, p: DVec2) -> f64 {
        if self.thick().is_some_and(|thick| self.sheet.rise(p) > thick) { 2.0 } else { 1.0 }
    }

    /// The part of the layer's thickness in the chart that its own beads fill at a point, mm.
    pub fn own(&self, p: DVec2) -> f64 {
        self.height / self.parts(p)
    }

    /// Gives passes planned for the thickness `usual` (mm) the metal that each of the two layers of a pair needs.
    pub fn paired(&self, passes: &mut [Pass], usual: f64) {
        if self.half.is_some() {
            let pace = |pace: f64, p: DVec2| pace * usual / self.own(p);
            passes.iter_mut().for_each(|pass| *pass = paced(pass, pace, &self.sheet, self.thick()));
        }
    }

    /// Inverse of [`Self::paired`].
    pub fn single(&self, passes: &mut [Pass], usual: f64) {
        if self.half.is_some() {
            passes.iter_mut().for_each(|pass| *pass = each_paced(pass, |pace, p| pace * self.own(p) / usual));
        }
    }

    /// Gives passes the metal of the wedge.
    pub fn laid(&self, passes: &mut [Pass]) {
        let rise = |p| self.sheet.rise(p).max(THINNEST);
        passes.iter_mut().for_each(|pass| *pass = paced(pass, |pace, p| pace / rise(p), &self.sheet, None));
    }

    /// Inverse of [`Self::laid`].
    pub fn even(&self, passes: &mut [Pass]) {
        let rise = |p| self.sheet.rise(p).max(THINNEST);
        passes.iter_mut().for_each(|pass| *pass = each_paced(pass, |pace, p| pace * rise(p)));
    }

    /// Volume of the whole wedge, including the share of the lower of two layers, mm³.
    pub fn volume(&self, islands: &[Polygon]) -> f64 {
        let of = |ring: &Ring| ring.area() * ring.centroid().map_or(1.0, |at| self.sheet.rise(at));
        self.height * islands.iter().flat_map(Polygon::rings).map(of).sum::<f64>()
    }

    /// A warning at the point where the layer leaves its window farthest; `None` if it does not.
    pub fn doubt(&self, layer: &Layer) -> Option<Warning> {
        let (thinnest, thickest) = (self.window.0 * (1.0 - TOLERANCE), self.window.1 * (1.0 + TOLERANCE));
        let off = |p: &DVec2| (self.thickness(*p) - thickest).max(thinnest - self.thickness(*p));
        let corners = layer.islands.iter().flat_map(|island| island.outer.points()).copied();
        let place = corners.max_by(|a, b| off(a).total_cmp(&off(b)))?;
        let (size, kind) = (off(&place), WarningKind::LayerThickness);
        (size > 0.0).then_some(Warning { kind, layer: layer.index, place, size })
    }
}

/// A pass with changed paces, divided where the thickness of its layer changes, and where the rise passes `thick`.
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

/// Start of each part of a piece along which the rise changes between the given values, as fractions of its length.
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

/// A pass with a changed pace on each of its pieces.
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
