//! The section `[layers]`.

use super::Body;
use crate::chart::{Chart, Sheet};
use crate::layer::Layer;
use crate::limit::{Limit, limits};
use crate::slice::LayerFit;
use crate::wedge::Wedge;
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// The layers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LayersSection {
    /// Thickness of a layer with many beads side by side, mm; for walls it is used only where their layer heights are not
    /// predicted (`predict`).
    pub height: f64,
    /// How the layers fit the height of a solid: `fixed` (layers of this thickness, as many as come nearest to the
    /// height), `last` (one more layer if the part would extend above the last), or `even` (the nearest number of equal
    /// layers, each laid at the pace that fills it); default fixed. What is left over is reported. Level layers end at the
    /// top of the part.
    #[serde(default)]
    pub fit: LayerFit,
    /// Whether layers of solids are as high as their metal fills their slices (a wide one is `height` high), end at the
    /// top of the part, and get metal where the slice needs it: more in beads at the rim and where the model finds the
    /// layers below too low, less in beads between others and where it finds them too high; default true. If false, all
    /// layers have the same height and all beads are alike, and a part with few beads side by side ends lower than
    /// planned.
    #[serde(default = "yes")]
    pub level: bool,
    /// Whether layers are placed where the wall's beads are predicted to lie (Li et al., eqs 5 to 8) instead of one
    /// thickness apart: `auto` (for the strategy `wall` only, unless it was chosen for a solid whose walls are thicker than the
    /// bead), `always` or `never`; default auto.
    #[serde(default, alias = "foretell")]
    pub predict: Predict,
    /// Least thickness of a bead where the thickness of a layer varies (a bend of `guide`), mm; default 0.6 times the
    /// height.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub min_height: Option<f64>,
    /// Greatest thickness of a bead there, mm; default 1.4 times the height. Where a bend would make a layer thicker on
    /// its outer side, that side is welded in two layers.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max_height: Option<f64>,
    /// How layers lie in space where they are not level: `plane:up=X/Y/Z`, `cylinder:axis=z,radius=MM`,
    /// `cone:axis=-z,tip=X/Y/Z,angle=DEGREES`, `guide:points=X/Y/Z:X/Y/Z:X/Y/Z,radius=MM`, or `surface:…` as
    /// `beadwright surface` writes it; optional.
    #[serde(default, skip_serializing_if = "Chart::is_level")]
    #[cfg_attr(feature = "schema", schemars(with = "String"))]
    pub chart: Chart,
    /// The bodies that a part is welded as, one after another, each with layers of its own kind; optional.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub bodies: Vec<Body>,
    /// The box around an existing part on which this one is welded, its lowest and highest corner, mm: travels between bodies keep
    /// clear of it. `plan --onto` sets it; optional.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub base: Option<[[f64; 3]; 2]>,
}

fn yes() -> bool {
    true
}

/// When the heights of layers are predicted from the bead.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Predict {
    /// For the strategy `wall` only.
    #[default]
    Auto,
    /// For every strategy.
    Always,
    /// Never: layers are one thickness apart.
    Never,
}

/// Default limits of a bead's thickness where the thickness of a layer varies, in heights of a layer.
const THIN: f64 = 0.6;
const THICK: f64 = 1.4;

impl LayersSection {
    /// How the layers of each body lie in space; for a part that is one body, its only chart.
    pub fn charts(&self) -> impl Iterator<Item = &Chart> {
        let one = self.bodies.is_empty().then_some(&self.chart);
        self.bodies.iter().map(|body| &body.chart).chain(one)
    }

    /// Whether all layers are level.
    pub fn are_level(&self) -> bool {
        self.charts().all(Chart::is_level)
    }

    /// One of three values: for level layers, for other layers of a single body, or for several bodies.
    pub fn by_lie<T>(&self, level: T, charted: T, bodies: T) -> T {
        if self.are_level() {
            level
        } else if self.bodies.is_empty() {
            charted
        } else {
            bodies
        }
    }

    /// How the layers of a layer's body lie in space.
    pub(crate) fn chart_of(&self, layer: &Layer) -> &Chart {
        self.bodies.get(layer.body).map_or(&self.chart, |body| &body.chart)
    }

    /// How a layer lies in space; `None` where it is level.
    pub fn sheet(&self, layer: &Layer) -> Option<Sheet<'_>> {
        let chart = self.chart_of(layer);
        (!chart.is_level()).then(|| chart.sheet(layer.middle()))
    }

    /// The wedge that a layer forms; `None` where its thickness is uniform.
    pub fn wedge(&self, layer: &Layer) -> Option<Wedge<'_>> {
        Wedge::of(layer, self.chart_of(layer), self.window())
    }

    /// Least and greatest thickness of a bead where the thickness of a layer varies, mm.
    pub fn window(&self) -> (f64, f64) {
        let [thin, thick] = [THIN, THICK].map(|part| part * self.height);
        (self.min_height.unwrap_or(thin), self.max_height.unwrap_or(thick))
    }

    /// Whether a place of the part is to be welded: what belongs to no body, such as the shaft below layers around it,
    /// already exists.
    pub fn has(&self, p: DVec3) -> bool {
        match &self.bodies[..] {
            [] => self.chart.coordinates(p).z >= 0.0,
            bodies => bodies.iter().any(|body| body.has(p)),
        }
    }

    /// The limits of the numbers.
    pub(super) fn limits(&self) -> Vec<Limit> {
        limits! {
            "layers.height": self.height, 0.01, 50.0, "mm", "a layer can only be as high as its beads";
            "layers.min_height": self.window().0, 0.01, 50.0, "mm", "a layer can only be as thin as its beads";
            "layers.max_height": self.window().1, 0.01, 50.0, "mm", "a layer can only be as high as its beads";
        }
    }
}
