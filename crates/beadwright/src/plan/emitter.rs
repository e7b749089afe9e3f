//! Hands filled layers over: puts their passes in order and at their heights, shares out the metal of level layers over
//! the metal below, keeps the limits of heat, and warns of what a layer cannot be welded on.

use super::charted::Across;
use super::cover::{Cover, Reach};
use super::filled::Filled;
use super::helix::{Helix, NoTurn};
use super::milled::undersize;
use super::settings::PlanSettings;
use super::support::Support;
use super::warm::{self, Heat};
use super::{Sink, level_layers, relight};
use crate::bead::pace::PaceSettings;
use crate::deposit::Stack;
use crate::fill::{Fill, Path};
use crate::heat::{LONGEST_WAIT, NOISE, PassHeat};
use crate::layer::{Layer, Temperature, overhang};
use crate::metrics::Metrics;
use crate::order::{self, OrderSettings};
use crate::pass::{Pass, PassKind};
use crate::process::Dot;
use crate::slice::{Half, Slice};
use crate::warning::{Warning, WarningKind, Warnings};
use crate::wedge::Wedge;
use glam::DVec2;
use planar::{Polygon, Region};
use std::borrow::Cow;

/// How paths become passes: their order and their pace.
#[derive(Debug, Clone, Copy)]
pub(super) struct Laying<'p> {
    /// How the first layer is put in order.
    pub(super) order: OrderSettings,
    pub(super) paces: PaceSettings<'p>,
    /// The dot that the process lays, if it lays any.
    pub(super) dot: Option<Dot>,
}

impl Laying<'_> {
    /// How a layer is put in order.
    fn in_order(&self, layer: usize) -> OrderSettings {
        OrderSettings { layer, ..self.order }
    }

    /// The passes of a layer, in order and at their height, from its top and thickness, mm.
    pub(super) fn passes(
        &self,
        fills: Vec<Fill>,
        layer: usize,
        heights: (f64, f64),
        torch: &mut Option<DVec2>,
    ) -> Vec<Pass> {
        self.lifted(order::order(fills, &self.in_order(layer), torch), layer, heights)
    }

    /// Paths at the height of their layer; its top and its thickness, mm.
    pub(super) fn lifted(&self, paths: Vec<Path>, layer: usize, (top, thickness): (f64, f64)) -> Vec<Pass> {
        let paces = self.paces.in_layer(layer, thickness);
        let lift = |path: Path| Pass {
            kind: path.kind,
            closed: path.closed,
            points: path.points.into_iter().map(|p| p.extend(top)).collect(),
            // The wire feed stays the same: a wider bead is laid more slowly.
            pace: path.width.map(|width| path.kind.pace(&paces, self.dot, width)),
            width: path.width,
            wait: 0.0,
        };
        paths.into_iter().map(lift).collect()
    }
}

/// Puts filled layers in order and hands them over.
pub(super) struct Emitter<'a, S> {
    pub(super) settings: &'a PlanSettings<'a>,
    pub(super) sink: &'a mut S,
    /// Middle of the part seen from above, and so of its plate, mm.
    pub(super) middle: DVec2,
    pub(super) torch: Option<DVec2>,
    pub(super) heat: &'a mut Heat,
    pub(super) memory: order::Memory,
    pub(super) helix: Option<Helix>,
    /// The first layer that could not become a turn of the helix.
    pub(super) no_turn: Option<NoTurn>,
    pub(super) support: Support,
    /// What has been built so far, if metal is shared out over it.
    pub(super) grown: Option<Stack>,
    /// Whether what has been built is compared with the plan.
    pub(super) asks_how_it_grows: bool,
    /// Outlines of the welded islands of the layer below.
    pub(super) below: Vec<Polygon>,
    /// Outlines of the layer below that one.
    pub(super) before: Vec<Polygon>,
    /// Height of the middle of the layer below, mm.
    pub(super) below_middle: f64,
    /// Top of the highest layer with beads, mm.
    pub(super) built: f64,
    pub(super) points: usize,
    /// Whether a layer is filled with a helix around an axis.
    pub(super) has_helix: bool,
    pub(super) metrics: Metrics,
    pub(super) warnings: Warnings,
}

impl<S: Sink> Emitter<'_, S> {
    /// Takes the next layer.
    ///
    /// # Errors
    /// Whatever the sink fails with.
    pub(super) fn emit(&mut self, filled: Filled) -> Result<(), S::Error> {
        let Filled { slice, fills, planned_area, reaches, has_helix, milled, shared, .. } = filled;
        self.has_helix |= has_helix;
        let Slice { index, z, height, half, islands, mut warnings } = slice;
        let slice_area = islands.iter().map(Polygon::area).sum();
        let laid = |&(island, _): &(usize, &Polygon)| fills.get(island).is_none_or(|fill| !fill.is_empty());
        let laid: Vec<Polygon> = islands.iter().enumerate().filter(laid).map(|(_, island)| island.clone()).collect();
        if islands.is_empty() {
            warnings.push(Warning { kind: WarningKind::EmptyLayer, layer: index, place: DVec2::ZERO, size: 0.0 });
        }
        let settings = self.settings;
        let laying = &settings.filling.laying;
        let order = laying.in_order(index).around(self.middle);
        let paths = self.memory.order(fills, shared, &order, &mut self.torch);
        let passes = laying.lifted(paths, index, (z, height / self.heat.lift(index, z - height)));
        let mut layer =
            Layer { index, z, height, half, islands, passes, slice_area, planned_area, warnings, ..Layer::default() };
        if half == Some(Half::Upper) {
            self.below.append(&mut self.before);
        }
        let wedge = settings.layers.wedge(&layer);
        if let Some(wedge) = &wedge {
            wedge.paired(&mut layer.passes, settings.welded.usual_height(height));
            layer.warnings.extend(wedge.doubt(&layer));
        }
        self.share(&mut layer, &reaches, wedge.as_ref());
        let undersize = milled.and_then(|part| undersize(&layer, &part, settings.bead_width));
        layer.warnings.extend(undersize);
        if let Some(helix) = &mut self.helix {
            let turn = helix.turn(&mut layer, settings.bead_width);
            self.no_turn = self.no_turn.take().or(turn.err());
        }
        relight::relight(&mut layer, &settings.relighting);
        self.support.judge(&mut layer, &settings.ground);
        if let Some(wedge) = &wedge {
            wedge.laid(&mut layer.passes);
        }
        self.warm(&mut layer);
        self.doubts(&mut layer);
        let laid = laid.into_iter().filter(|island| !self.support.is_left_out(island)).collect();
        self.before = std::mem::replace(&mut self.below, laid);
        self.below_middle = layer.middle();
        let sheet = settings.layers.sheet(&layer);
        for warning in &layer.warnings {
            let at = sheet.map(|sheet| sheet.at(warning.place.extend(layer.z)).place);
            self.warnings.add_at(*warning, layer.z, at);
        }
        self.metrics.add(&layer);
        if let Some(grown) = &mut self.grown {
            let welded = settings.welded.welded(&layer);
            if self.asks_how_it_grows {
                grown.add(&welded);
            } else {
                grown.weld(&welded.passes);
            }
        }
        self.sink.layer(layer)
    }

    /// Shares out the metal of a level layer, and measures what it covers of the islands whose `reaches` are known.
    fn share(&self, layer: &mut Layer, reaches: &[Option<Reach>], wedge: Option<&Wedge<'_>>) {
        let bands = self.settings.unrolling.bands(layer);
        let of = bands.as_ref().map(|bands| {
            let (pieces, of) = bands.cut(&layer.passes);
            layer.passes = pieces;
            of
        });
        if let Some(sharing) = &self.settings.sharing {
            level_layers::share(layer, self.grown.as_ref(), wedge, sharing);
        }
        if !reaches.is_empty() {
            let cover = Cover::of_layer(layer, reaches, self.settings.bead_width);
            layer.planned_area = cover.area;
            let warning = |(kind, place, size)| Warning { kind, layer: layer.index, place, size };
            layer.warnings.extend(cover.doubts.into_iter().map(warning));
        }
        if let Some((bands, of)) = bands.zip(of) {
            layer.passes = bands.joined(std::mem::take(&mut layer.passes), &of);
        }
    }

    /// Keeps the limits of `[interpass]`, warns where that is impossible, and widens beads by the heat of the metal
    /// below.
    fn warm(&mut self, layer: &mut Layer) {
        let Some(build) = &mut self.heat.build else { return };
        // Each body is planned as if it were the only one, but the heat model knows all of them.
        layer.body = self.heat.body;
        let heat = build.layer_within_limits(layer);
        layer.body = 0;
        layer.warnings.extend(heat.cuts.iter().map(|&place| Warning {
            kind: WarningKind::Paused,
            layer: layer.index,
            place,
            size: 1.0,
        }));
        // The next layer is ordered from the point where this one ends.
        self.torch = layer.passes.last().and_then(Pass::end).map(|end| end.truncate()).or(self.torch);
        let temperature = |pass: &PassHeat| Temperature { start: pass.start, mean: pass.mean() };
        layer.temperatures = heat.passes.iter().map(temperature).collect();
        let warming = &self.settings.warming;
        if let Some(law) = &warming.by_heat {
            warm::widen(layer, &heat, build, law, self.settings.bead_width);
        }
        let Some(limits) = warming.interpass else { return };
        for (pass, heat) in layer.passes.iter().zip(&heat.passes) {
            let (place, peak) = heat.peak();
            // Otherwise the start is too hot even after waiting, which is another warning. A helix cannot wait between
            // its turns.
            let is_asked = heat.start <= limits.max_temperature + NOISE || layer.lit.is_turn();
            if is_asked && peak > limits.max_temperature + NOISE {
                let place = place_on(pass, place as f64 * build.spacing());
                layer.warnings.push(Warning { kind: WarningKind::HotAhead, layer: layer.index, place, size: peak });
            }
            let kind = if pass.wait >= LONGEST_WAIT {
                WarningKind::NeverCools
            } else if limits.min_temperature.is_some_and(|least| heat.start < least) {
                WarningKind::TooCold
            } else {
                continue;
            };
            let place = pass.start().unwrap_or_default().truncate();
            layer.warnings.push(Warning { kind, layer: layer.index, place, size: heat.start });
        }
    }

    /// Warns of metal that a layer cannot be welded on, and of what a controller may refuse.
    fn doubts(&mut self, layer: &mut Layer) {
        let PlanSettings { limits, layers, weld, soonest_arc_end, .. } = self.settings;
        let index = layer.index;
        let across = Across::new(&layers.chart, self.below_middle, layer.middle());
        let mut below = across.map_or(Cow::Borrowed(&self.below[..]), |across| across.islands(&self.below).into());
        let there = self.support.there(layer, &layers.chart);
        let stands =
            |pass: &Pass| pass.start().is_some_and(|p| there.iter().any(|island| island.contains(p.truncate())));
        if !there.is_empty() {
            let [own, there] = [below.to_vec(), there.clone()].map(Region::from_normalised);
            below = own.union(&there).into_polygons().into();
        }
        let mut doubts = Vec::new();
        let mut doubt = |kind, place, size| doubts.push(Warning { kind, layer: index, place, size });
        if let Some(first) = layer.passes.first() {
            let gap = layer.z - layer.height - self.built;
            if gap > LARGE_GAP * layer.height && !stands(first) {
                let kind = if self.metrics.passes == 0 { WarningKind::HighStart } else { WarningKind::NothingBelow };
                doubt(kind, first.start().unwrap_or_default().truncate(), gap);
                // The gap concerns the whole layer, so these warnings would only repeat it.
                layer
                    .warnings
                    .retain(|warning| !matches!(warning.kind, WarningKind::InTheAir | WarningKind::OverUnwelded));
            } else if !below.is_empty() {
                let (reach, width) = (limits.max_overhang * self.settings.bead_width, self.settings.bead_width);
                if let Some((area, place)) = overhang(&below, &layer.islands, reach, width) {
                    doubt(WarningKind::Overhang, place, area);
                }
            }
            self.built = layer.z;
        }
        let points: usize = layer.passes.iter().map(|pass| pass.points.len()).sum();
        self.points += points;
        if points > limits.max_points as usize {
            doubt(WarningKind::ManyPoints, DVec2::ZERO, points as f64);
        }
        // Dots take the time that their trial took, however short.
        let unsteady =
            |pass: &&Pass| pass.kind != PassKind::Spot && pass.seconds(&weld.process) < 0.999 * soonest_arc_end;
        for pass in layer.passes.iter().filter(unsteady) {
            doubt(WarningKind::ShortArc, pass.start().unwrap_or_default().truncate(), pass.length());
        }
        layer.warnings.extend(doubts);
    }
}

/// The place at a distance `way` along a pass, mm, seen from above.
fn place_on(pass: &Pass, way: f64) -> DVec2 {
    let line = pass.line();
    planar::polyline::point_at(&line, way).or(line.first().copied()).unwrap_or_default()
}

/// A gap below a layer is reported from this fraction of the layer's thickness.
const LARGE_GAP: f64 = 0.25;
