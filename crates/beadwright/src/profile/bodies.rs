//! Bodies that a part is welded as, one after another, each with layers of its own kind (`[[layers.bodies]]`).

use super::{Predict, Profile};
use crate::chart::{self, Bound, Chart};
use crate::fill::StrategyName;
use crate::model::{Mesh, Object, Solids};
use bead_part::directions::{Division, Piece};
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// One of the bodies that a part is welded as.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Body {
    /// Its name in reports and messages.
    pub name: String,
    /// How its layers lie in space, as in `layers.chart`; level if left out. What lies below its first layer belongs to other bodies.
    #[serde(default, skip_serializing_if = "Chart::is_level")]
    #[cfg_attr(feature = "schema", schemars(with = "String"))]
    pub chart: Chart,
    /// Planes such as `up=0/0/-1,through=0/0/60` and cylinders such as `cylinder:axis=z,radius=15,side=outer`: the body is
    /// the part of the model above all planes, inside or outside all cylinders, and above its first layer.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[cfg_attr(feature = "schema", schemars(with = "Vec<String>"))]
    pub within: Vec<Bound>,
    /// More lists like `within`: what lies within all bounds of one of them belongs to the body, too.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[cfg_attr(feature = "schema", schemars(with = "Vec<Vec<String>>"))]
    pub also: Vec<Vec<Bound>>,
    /// The solids that make up this body, where a model has several: each by a point on it (`x/y/z`, mm, as the part stands), or by the
    /// name of its object in the model. All of them if left out.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[cfg_attr(feature = "schema", schemars(with = "Vec<String>"))]
    pub solids: Vec<Solid>,
    /// Whether its first layer lies on existing metal that is not welded, such as a shaft; if left out, it lies on
    /// other bodies or on the plate. What the first body lies on always exists already.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub on_stock: bool,
    /// Strategy that fills it; `fill.strategy` if left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub strategy: Option<StrategyName>,
    /// When the heights of its layers are predicted; `layers.predict` if left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub predict: Option<Predict>,
}

/// How a solid of a model is named.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(from = "String", into = "String")]
pub enum Solid {
    /// The solid whose surface lies nearest to a point, mm.
    At(DVec3),
    /// The solids of the object with this name.
    Named(String),
}

impl From<String> for Solid {
    fn from(text: String) -> Self {
        chart::point(&text).map_or(Self::Named(text), Self::At)
    }
}

impl From<Solid> for String {
    fn from(solid: Solid) -> Self {
        match solid {
            Solid::At(p) => format!("{}/{}/{}", p.x, p.y, p.z),
            Solid::Named(name) => name,
        }
    }
}

/// A file of bodies.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    body: Vec<Body>,
}

/// Why a file of bodies cannot be read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "line {line}: {reason}. Each body is a table [[body]] with a name, and chart, within, solids, on_stock and strategy where they are needed."
)]
pub struct BodiesError {
    /// Number of the line, from 1.
    line: usize,
    /// What is wrong, without a full stop.
    reason: String,
}

impl Body {
    /// Reads a file of bodies: a table `[[body]]` for each, in the order in which they are welded.
    ///
    /// ```
    /// use beadwright::profile::Body;
    ///
    /// let text = r#"
    /// [[body]]
    /// name = "trunk"
    /// within = ["up=0/0/-1,through=0/0/60"]
    ///
    /// [[body]]
    /// name = "arm"
    /// chart = "plane:up=1/0/1,through=0/0/60"
    /// "#;
    /// let bodies = Body::read(text)?;
    /// assert!(bodies[0].chart.is_level() && !bodies[1].chart.is_level());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`BodiesError`], which names the line.
    pub fn read(text: &str) -> Result<Vec<Self>, BodiesError> {
        let file: File = toml::from_str(text).map_err(|error| {
            let before = error.span().and_then(|span| text.get(..span.start)).unwrap_or_default();
            BodiesError { line: before.matches('\n').count() + 1, reason: error.message().to_owned() }
        })?;
        let twice = |k: &usize| file.body[..*k].iter().any(|body| body.name == file.body[*k].name);
        if let Some(k) = (0..file.body.len()).find(twice) {
            let heads = text.lines().enumerate().filter(|(_, line)| line.trim_start().starts_with("[[body]]"));
            let line = heads.map(|(line, _)| line + 1).nth(k).unwrap_or_default();
            return Err(BodiesError { line, reason: format!("another body is named \"{}\", too", file.body[k].name) });
        }
        Ok(file.body)
    }

    /// A whole part as one body.
    pub fn of(name: &str, chart: Chart) -> Self {
        Self {
            name: name.to_owned(),
            chart,
            within: Vec::new(),
            also: Vec::new(),
            solids: Vec::new(),
            on_stock: false,
            strategy: None,
            predict: None,
        }
    }

    /// The bodies of a part that is divided ([`directions`](crate::directions)); `name` is that of a part in one piece.
    pub fn of_division(name: &str, division: &Division) -> Vec<Self> {
        let name = |k: usize| match (division.pieces.len(), k) {
            (1, _) => name.to_owned(),
            (_, 0) => "trunk".to_owned(),
            (_, k) => format!("branch {k}"),
        };
        let body = |(k, piece): (usize, &Piece)| Self {
            within: piece.within.clone(),
            also: piece.also.clone(),
            on_stock: piece.on_stock,
            ..Self::of(&name(k), piece.chart.clone())
        };
        division.pieces.iter().enumerate().map(body).collect()
    }

    /// The text of a file of bodies.
    pub fn write(bodies: &[Self]) -> String {
        let mut text = String::new();
        for body in bodies {
            // Charts hold no quotation marks; a name may.
            text.push_str(&format!(
                "[[body]]\nname = {}\nchart = \"{}\"\n",
                toml::Value::from(body.name.as_str()),
                body.chart
            ));
            if !body.within.is_empty() {
                text.push_str(&format!("within = {}\n", listed(&body.within)));
            }
            if !body.also.is_empty() {
                let also: Vec<String> = body.also.iter().map(|bounds| listed(bounds)).collect();
                text.push_str(&format!("also = [{}]\n", also.join(", ")));
            }
            if !body.solids.is_empty() {
                let solids: Vec<String> = body.solids.iter().cloned().map(String::from).collect();
                text.push_str(&format!("solids = {}\n", toml::Value::from(solids)));
            }
            if body.on_stock {
                text.push_str("on_stock = true\n");
            }
            text.push('\n');
        }
        text
    }

    /// Replaces names of objects by points on their solids; `objects` are those of the model, as the part stands. A
    /// name that none of them has is kept.
    pub fn find_solids(&mut self, objects: &[Object]) {
        let found = |solid: Solid| -> Vec<Solid> {
            let Solid::Named(name) = &solid else { return vec![solid] };
            let named = objects.iter().filter(|object| object.name == *name);
            let points: Vec<Solid> = named.flat_map(|object| &object.at).copied().map(Solid::At).collect();
            if points.is_empty() { vec![solid] } else { points }
        };
        self.solids = self.solids.drain(..).flat_map(found).collect();
    }

    /// The name of a solid that no object of the model has.
    pub fn unknown_solid(&self) -> Option<&str> {
        self.solids.iter().find_map(|solid| match solid {
            Solid::Named(name) => Some(name.as_str()),
            Solid::At(_) => None,
        })
    }

    /// The solids of a mesh that this body is part of.
    pub(crate) fn solids_of<'m>(&self, mesh: &'m Mesh) -> Cow<'m, Mesh> {
        if self.solids.is_empty() {
            return Cow::Borrowed(mesh);
        }
        let solids = Solids::of(mesh);
        let number = |solid: &Solid| match solid {
            Solid::At(point) => solids.nearest(*point),
            Solid::Named(_) => None,
        };
        Cow::Owned(solids.mesh(&self.solids.iter().filter_map(number).collect::<Vec<_>>()))
    }

    /// The part of a mesh that belongs to this body. Around an axis and along a guide, it includes what lies below the
    /// body's first layer.
    pub fn of_mesh(&self, mesh: &Mesh) -> Mesh {
        let first = match &self.chart {
            Chart::Plane(plane) if !self.chart.is_level() => Some(Bound::Plane(*plane)),
            _ => None,
        };
        let whole = self.solids_of(mesh).into_owned();
        let part =
            |bounds: &Vec<Bound>| bounds.iter().chain(&first).fold(whole.clone(), |rest, bound| bound.part_of(&rest));
        let mut own = part(&self.within);
        self.also.iter().for_each(|bounds| own.add(part(bounds)));
        own
    }

    /// Whether a place of the part belongs to it by its chart and bounds; its solids are ignored.
    pub fn has(&self, p: DVec3) -> bool {
        let within = |bounds: &Vec<Bound>| bounds.iter().all(|bound| bound.height(p) >= 0.0);
        self.chart.coordinates(p).z >= 0.0 && (within(&self.within) || self.also.iter().any(within))
    }
}

/// Bounds as a list of TOML.
fn listed(bounds: &[Bound]) -> String {
    let bounds: Vec<String> = bounds.iter().map(|bound| format!("\"{bound}\"")).collect();
    format!("[{}]", bounds.join(", "))
}

impl Profile {
    /// The profile with which one body is planned and judged as if it were the whole part.
    pub fn of_body(&self, body: usize) -> Cow<'_, Self> {
        let Some(Body { chart, strategy, predict, .. }) = self.layers.bodies.get(body) else {
            return Cow::Borrowed(self);
        };
        let mut own = self.clone();
        own.layers.chart = chart.clone();
        own.layers.bodies.clear();
        own.fill.strategy = strategy.unwrap_or(own.fill.strategy);
        own.layers.predict = predict.unwrap_or(own.layers.predict);
        Cow::Owned(own)
    }
}
