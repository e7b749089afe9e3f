//! Whether the torch has room next to finished bodies, in space: it points along the normal of the layer that it welds
//! and fills a cone above the wire's tip ([`TorchShape`]).

use super::result::Blocked;
use super::settings::PlanSettings;
use super::{Header, Sink};
use crate::chart::At;
use crate::layer::Layer;
use crate::model::Mesh;
use crate::process::TorchShape;
use glam::DVec3;
use rayon::prelude::*;

/// Finished bodies, and where the torch came too close to one of them.
pub(super) struct Beside {
    torch: Option<TorchShape>,
    finished: Vec<Finished>,
    close: Vec<Close>,
}

/// Metal that is finished.
struct Finished {
    /// Index of the body; `None` for what was there before.
    body: Option<usize>,
    /// Its name in messages.
    name: String,
    /// Points on its surface, mm.
    points: Vec<DVec3>,
}

/// The closest that the torch comes to a finished body while it welds another.
#[derive(Debug, Clone, PartialEq)]
struct Close {
    welded: (usize, String),
    /// Index of the finished metal.
    finished: usize,
    /// Where the wire's tip is, and where metal is in the way, mm.
    tip: DVec3,
    metal: DVec3,
    /// The room that the torch needs beside its axis there, and has, mm.
    needs: f64,
    has: f64,
    travels: bool,
}

/// Spacing of the points on surfaces, mm.
const SPACING: f64 = 4.0;
/// Spacing of the places on passes that are checked, in bead widths.
const STEP: f64 = 2.0;
/// Radius kept free around the bare wire, mm.
const WIRE: f64 = 1.5;

impl Beside {
    pub(super) fn new(torch: Option<TorchShape>) -> Self {
        Self { torch, finished: Vec::new(), close: Vec::new() }
    }

    /// Adds metal that is there before the first body; `name` is its name in messages.
    pub(super) fn begin_on(&mut self, name: &str, mesh: &Mesh) {
        self.finished.push(Finished { body: None, name: name.to_owned(), points: surface_points(mesh) });
    }

    /// Adds a finished body.
    pub(super) fn finish(&mut self, body: usize, name: &str, mesh: &Mesh) {
        self.finished.push(Finished { body: Some(body), name: format!("\"{name}\""), points: surface_points(mesh) });
    }

    /// A note that nothing was checked, where the profile lacks `[torch]`.
    pub(super) fn note(&self) -> Option<String> {
        (self.torch.is_none() && self.finished.len() > 1).then(|| {
            "Whether the torch has room next to finished bodies was not checked: the profile lacks the section [torch].".to_owned()
        })
    }

    /// Which body the torch would hit as it welds which.
    pub(super) fn blocked(&self) -> Vec<Blocked> {
        let blocked = |close: &Close| {
            let by = self.finished[close.finished].body?;
            Some(Blocked { body: close.welded.0, by })
        };
        let mut blocked: Vec<Blocked> = self.close.iter().filter_map(blocked).collect();
        blocked.sort_unstable();
        blocked.dedup();
        blocked
    }

    /// What the torch would hit, as sentences.
    pub(super) fn sentences(&self) -> impl Iterator<Item = String> + '_ {
        self.close.iter().map(|close| {
            let Close { welded: (_, welded), finished, tip, metal, needs, has, travels } = close;
            let finished = &self.finished[*finished].name;
            let does = if *travels { "travels over" } else { "welds" };
            format!(
                "The torch would hit {finished} while it {does} \"{welded}\" at x {:.1} y {:.1} z {:.1} mm: near x {:.1} y {:.1} z {:.1} mm it \
                 needs {needs:.1} mm beside its axis and has {has:.1} mm (section [torch]). Weld the bodies in \
                 another order, or divide the part elsewhere (layers.bodies).",
                tip.x, tip.y, tip.z, metal.x, metal.y, metal.z
            )
        })
    }

    /// Checks the torch at places on a body that is being welded.
    fn look(&mut self, welded: (usize, &str), places: &[At], travels: bool) {
        let Some(torch) = self.torch else { return };
        for (finished, Finished { points, .. }) in self.finished.iter().enumerate() {
            let worst = places
                .par_iter()
                .flat_map_iter(|tip| {
                    points
                        .iter()
                        .filter_map(move |metal| lack(&torch, tip, *metal, travels).map(|lack| (lack, tip, metal)))
                })
                .max_by(|a, b| (a.0.0 - a.0.1).total_cmp(&(b.0.0 - b.0.1)));
            if let Some(((needs, has), tip, metal)) = worst {
                let welded = (welded.0, welded.1.to_owned());
                let new = Close { welded, finished, tip: tip.place, metal: *metal, needs, has, travels };
                let same =
                    |old: &&mut Close| old.welded == new.welded && old.finished == finished && old.travels == travels;
                match self.close.iter_mut().find(same) {
                    Some(old) if old.needs - old.has < needs - has => *old = new,
                    Some(_) => {}
                    None => self.close.push(new),
                }
            }
        }
    }
}

/// The room that the torch needs and has beside its axis, mm; `None` where it is clear of the metal.
fn lack(torch: &TorchShape, tip: &At, metal: DVec3, travels: bool) -> Option<(f64, f64)> {
    let from = metal - tip.place;
    let above = from.dot(tip.normal);
    let needs = torch.radius(above).or((travels && above > 0.0).then_some(WIRE))?;
    let has = (from - tip.normal * above).length();
    (has < needs).then_some((needs, has))
}

/// Points on the surface of a mesh, about [`SPACING`] apart.
fn surface_points(mesh: &Mesh) -> Vec<DVec3> {
    let mut cells = std::collections::BTreeMap::new();
    for [a, b, c] in mesh.triangles.iter().map(|corners| corners.map(|corner| mesh.vertices[corner as usize])) {
        let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
        let steps = (longest / SPACING).ceil().max(1.0) as usize;
        for i in 0..=steps {
            for j in 0..=steps - i {
                let p = a + (b - a) * (i as f64 / steps as f64) + (c - a) * (j as f64 / steps as f64);
                cells.entry((p / SPACING).floor().as_i64vec3().to_array()).or_insert(p);
            }
        }
    }
    cells.into_values().collect()
}

/// Hands layers on and checks where the torch goes.
pub(super) struct Watch<'a, S> {
    sink: &'a mut S,
    beside: &'a mut Beside,
    /// Index and name of the body that is welded.
    body: (usize, &'a str),
    settings: &'a PlanSettings<'a>,
}

impl<'a, S> Watch<'a, S> {
    /// `settings` are those of the body.
    pub(super) fn new(
        sink: &'a mut S,
        beside: &'a mut Beside,
        body: (usize, &'a str),
        settings: &'a PlanSettings<'a>,
    ) -> Self {
        Self { sink, beside, body, settings }
    }

    fn watch(&mut self, layer: &Layer) {
        if self.beside.finished.is_empty() {
            return;
        }
        let sheet = self.settings.layers.chart.sheet(layer.middle());
        let spaced = |from: DVec3, to: DVec3| {
            let count = (from.distance(to) / (STEP * self.settings.bead_width)).ceil().max(1.0) as usize;
            (0..=count).map(move |k| from.lerp(to, k as f64 / count as f64))
        };
        let welded =
            layer.passes.iter().flat_map(|pass| pass.segments()).flat_map(|piece| spaced(piece.from, piece.to));
        let welded: Vec<At> = welded.map(|p| sheet.at(p)).collect();
        let ends = layer.passes.windows(2).filter_map(|pair| pair[0].end().zip(pair[1].start()));
        let over = DVec3::Z * self.settings.weld.travel.clearance;
        let travelled: Vec<At> =
            ends.flat_map(|(from, to)| spaced(from + over, to + over)).map(|p| sheet.at(p)).collect();
        self.beside.look(self.body, &welded, false);
        self.beside.look(self.body, &travelled, true);
    }
}

impl<S: Sink> Sink for Watch<'_, S> {
    type Error = S::Error;

    fn begin(&mut self, header: &Header) -> Result<(), S::Error> {
        self.sink.begin(header)
    }

    fn layer(&mut self, layer: Layer) -> Result<(), S::Error> {
        self.watch(&layer);
        self.sink.layer(layer)
    }
}
