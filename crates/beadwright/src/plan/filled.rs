//! A slice with its passes.

use super::candidates;
use super::cover::{Cover, Reach};
use super::emitter::Laying;
use super::scan_lines::Planned;
use super::turns::Unrolling;
use crate::deposit::DepositSettings;
use crate::fill::around::{self, Turn};
use crate::fill::contour::rings_only;
use crate::fill::sound::{self, Fault};
use crate::fill::{Fill, FillSettings, Path, Strategy, dot};
use crate::metrics::Metrics;
use crate::process::{Dot, Process};
use crate::profile::FillSection;
use crate::slice::Slice;
use crate::task::{Cancelled, Task};
use crate::warning::{Warning, WarningKind};
use glam::DVec2;
use planar::{Bounds, Join, Polygon, Region};
use rayon::prelude::*;
use std::cell::OnceCell;

/// How islands are filled.
#[derive(Debug, Clone)]
pub(super) struct Filling<'p> {
    /// How the first layer is filled.
    pub(super) first: FillSettings<'p>,
    /// How that changes from layer to layer, and what is too short.
    pub(super) section: &'p FillSection,
    pub(super) unrolling: Unrolling<'p>,
    /// The most turns of a helix around an axis; `None` where islands that go all around are cut open.
    pub(super) most_turns: Option<f64>,
    /// How passes are laid, where that decides between fills.
    pub(super) laying: Laying<'p>,
    pub(super) process: &'p Process,
    /// A pass that takes less time than this, s, ends before its arc is steady.
    pub(super) soonest_arc_end: f64,
    /// Whether metal is shared out over the passes afterwards, so that only then it is known what they cover.
    pub(super) is_level: bool,
    /// Height of a usual layer, mm.
    pub(super) height: f64,
    /// How fills are judged, and timed without turns of a positioner, where several are tried.
    pub(super) deposit: DepositSettings,
    pub(super) still: Metrics,
}

impl<'p> Filling<'p> {
    /// How a layer is filled, by its index.
    pub(super) fn in_layer(&self, layer: usize) -> FillSettings<'p> {
        FillSettings { layer, raster_angle: self.section.angle(layer), ..self.first }
    }

    /// The turns that a slice allows, if islands that go all around are filled with a helix.
    pub(super) fn turn(&self, slice: &Slice) -> Option<Turn> {
        self.most_turns.and_then(|most| self.unrolling.turn(slice, most))
    }

    /// How a slice is filled.
    fn of_slice<'s>(&self, layer: &'s Planned) -> FillSettings<'s>
    where
        'p: 's,
    {
        let mut settings: FillSettings<'s> = self.in_layer(layer.slice.index);
        settings.raster_angle = layer.raster_angle.unwrap_or(settings.raster_angle);
        settings.solid = layer.solid.as_ref();
        settings.turn = self.turn(&layer.slice);
        settings
    }

    /// Whether a pass is long enough to be welded, and takes longer than its arc needs to become steady.
    fn is_long_enough(&self, pass: &Path, layer: usize) -> bool {
        let is_long = pass.points.len() >= 2 && pass.length() >= self.section.min_pass_length;
        is_long && self.arc_time(pass, layer) >= self.soonest_arc_end
    }

    /// How long the torch takes along a pass, s.
    fn arc_time(&self, pass: &Path, layer: usize) -> f64 {
        let process = self.process.at_layer(layer);
        let (FillSettings { bead, law, .. }, nominal) = (self.first, self.process.deposition_speed);
        let path = pass.path();
        let time = |(i, ends): (usize, &[DVec2])| {
            let pace = nominal * law.pace(&bead, pass.width.after(i));
            ends[0].distance(ends[1]) / process.speed_at(pace)
        };
        path.windows(2).enumerate().map(time).sum()
    }

    /// The longest pass of an island whose passes are all shorter than `fill.min_pass_length`, if it can be welded at
    /// all: the layers above need its metal.
    fn short_but_alone(&self, fill: &Fill, layer: usize) -> Option<Path> {
        let longest = fill.stages.iter().flatten().max_by(|a, b| a.length().total_cmp(&b.length()))?;
        let is_short = (ALONE * self.first.bead.width..self.section.min_pass_length).contains(&longest.length());
        (is_short && self.arc_time(longest, layer) >= self.soonest_arc_end).then(|| longest.clone())
    }

    /// Leaves out passes that are too short to weld, with a warning; `kept` spares one of them.
    pub(super) fn drop_short(
        &self,
        stage: &mut Vec<Path>,
        kept: Option<&Path>,
        layer: usize,
        warnings: &mut Vec<Warning>,
    ) {
        stage.retain(|pass| {
            let length = pass.length();
            let keep = kept == Some(pass) || self.is_long_enough(pass, layer);
            // A zigzag that touches a corner with a line of almost no length loses nothing.
            if !keep && length > 0.1 * self.section.min_pass_length {
                let place = pass.points.first().copied().unwrap_or_default();
                warnings.push(Warning { kind: WarningKind::PassTooShort, layer, place, size: length });
            }
            keep
        });
    }
}

/// A slice with the passes of its islands, not yet in order.
#[derive(Clone)]
pub(super) struct Filled {
    pub(super) slice: Slice,
    pub(super) fills: Vec<Fill>,
    pub(super) planned_area: f64,
    /// For each island the area that beads reach, as long as its cover is not known: it is measured once the metal is
    /// shared out.
    pub(super) reaches: Vec<Option<Reach>>,
    /// Number of warnings that came with the slice.
    pub(super) known: usize,
    /// Whether an island is filled with a helix.
    pub(super) has_helix: bool,
    /// Where the milled part lies in this layer of its preform.
    pub(super) milled: Option<Region>,
    /// Whether other layers have the same passes.
    pub(super) shared: bool,
}

/// Fills a batch of slices in parallel; `datum` is the reference point of the part. Slices of the same shape are filled
/// together: all layers of a prismatic part at once, or a few groups where layers alternate.
pub(super) fn fill_batch(
    batch: Vec<Planned>,
    strategy: &dyn Strategy,
    filling: &Filling,
    datum: DVec2,
    task: &Task,
) -> Result<Vec<Filled>, Cancelled> {
    let fill = |alike: &Vec<usize>| {
        task.check()?;
        let layers: Vec<&Planned> = alike.iter().map(|&i| &batch[i]).collect();
        Ok(fill_alike(&layers, strategy, filling, datum))
    };
    let filled = groups(&batch, strategy, filling).par_iter().map(fill).collect::<Result<Vec<_>, _>>()?;
    let mut filled: Vec<Filled> = filled.into_iter().flatten().collect();
    filled.sort_by_key(|filled| filled.slice.index);
    Ok(filled)
}

/// The slices of a batch, grouped into those that can be filled together.
fn groups(batch: &[Planned], strategy: &dyn Strategy, filling: &Filling) -> Vec<Vec<usize>> {
    let settings = |i: usize| FillSettings { layer: 0, ..filling.of_slice(&batch[i]) };
    // Whether a pass is too short depends on the time that it takes.
    let rate = |i: usize| filling.process.at_layer(batch[i].slice.index).rate();
    let period = if strategy.repeats() { Some(1) } else { strategy.period() };
    let turn = |i: usize| period.map_or(batch[i].slice.index, |period| batch[i].slice.index % period);
    let alike = |k: usize, i: usize| {
        turn(k) == turn(i)
            && batch[k].slice.islands == batch[i].slice.islands
            && batch[k].slice.height == batch[i].slice.height
            && settings(k) == settings(i)
            && rate(k) == rate(i)
    };
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for i in 0..batch.len() {
        match groups.iter_mut().find(|group| alike(group[0], i)) {
            Some(group) => group.push(i),
            None => groups.push(vec![i]),
        }
    }
    groups
}

/// Fills slices of the same shape.
fn fill_alike(layers: &[&Planned], strategy: &dyn Strategy, filling: &Filling, datum: DVec2) -> Vec<Filled> {
    let settings: Vec<FillSettings> =
        layers.iter().map(|layer| FillSettings { datum, ..filling.of_slice(layer) }).collect();
    if let ([layer, others @ ..], true) = (layers, strategy.repeats()) {
        let mut first = fill_planned(layer, strategy, filling, datum);
        let others: Vec<Filled> = others.iter().map(|other| first.shared_with(&other.slice)).collect();
        return std::iter::once(first).chain(others).collect();
    }
    let islands = layers.first().map_or(0, |layer| layer.slice.islands.len());
    let fills: Vec<OnceCell<Vec<Fill>>> = (0..islands).map(|_| OnceCell::new()).collect();
    let fill = |(k, layer): (usize, &&Planned)| {
        let own = |i: usize, island: &Polygon| {
            let all = fills[i].get_or_init(|| strategy.fill_layers(island, &settings));
            all[k].clone()
        };
        fill_layer(layer.slice.clone(), own, strategy, filling, &settings[k])
    };
    layers.iter().enumerate().map(fill).collect()
}

impl Filled {
    /// The same passes on another slice of the same shape.
    fn shared_with(&mut self, slice: &Slice) -> Self {
        self.shared = true;
        let of_fill = self.slice.warnings.iter().skip(self.known).map(|w| Warning { layer: slice.index, ..*w });
        let warnings = slice.warnings.iter().copied().chain(of_fill).collect();
        Self { slice: Slice { warnings, ..slice.clone() }, known: slice.warnings.len(), ..self.clone() }
    }
}

/// Fills a slice; `datum` is the reference point of the part.
pub(super) fn fill_planned(layer: &Planned, strategy: &dyn Strategy, filling: &Filling, datum: DVec2) -> Filled {
    let settings = FillSettings { datum, ..filling.of_slice(layer) };
    let fill = |_: usize, island: &Polygon| strategy.fill(island, &settings);
    fill_layer(layer.slice.clone(), fill, strategy, filling, &settings)
}

/// Fills a slice; `fill` gives what the strategy lays into an island, by the island's index.
fn fill_layer(
    mut slice: Slice,
    fill: impl Fn(usize, &Polygon) -> Fill,
    strategy: &dyn Strategy,
    filling: &Filling,
    settings: &FillSettings,
) -> Filled {
    let (mut fills, mut planned_area, came_with) = (Vec::with_capacity(slice.islands.len()), 0.0, slice.warnings.len());
    let (mut reaches, mut has_helix) = (Vec::new(), false);
    for (i, island) in slice.islands.iter().enumerate() {
        let reach = Reach::of(island, strategy.narrowest(settings));
        let roomy = reach.area > 0.0 || strategy.welds_thin_walls() || island.holds_disc(settings.wall.thinnest / 2.0);
        let helix = around::helix(island, settings).map(|helix| Fill { stages: vec![vec![helix]], fixed_order: true });
        has_helix |= helix.is_some();
        let mut own = if let Some(helix) = helix {
            helix
        } else if roomy {
            sound_fill(fill(i, island), island, strategy, filling, settings, reach.area, &mut slice.warnings)
        } else {
            Fill::default()
        };
        let mut passes = own.stages.iter().flatten();
        let dot = filling.laying.dot.filter(|_| !passes.any(|pass| filling.is_long_enough(pass, slice.index)));
        let is_left_out = match dot.and_then(|dot| dot_in(island, settings.machining_allowance, slice.height, &dot)) {
            Some(pass) => {
                own.stages = vec![vec![pass]];
                false
            }
            None => {
                let (is_left_out, alone) = (own.is_empty(), filling.short_but_alone(&own, slice.index));
                for stage in &mut own.stages {
                    filling.drop_short(stage, alone.as_ref(), slice.index, &mut slice.warnings);
                }
                is_left_out
            }
        };
        let warning = |(kind, place, size)| Warning { kind, layer: slice.index, place, size };
        if is_left_out {
            slice.warnings.push(warning((WarningKind::IslandTooSmall, middle(island), island.area())));
        } else if !filling.is_level {
            let once = filling.unrolling.fill_once(&own, island, settings.turn);
            let cover = Cover::of(&once, island, settings, &reach);
            planned_area += cover.area;
            slice.warnings.extend(cover.doubts.into_iter().map(warning));
        }
        if filling.is_level {
            reaches.push((!is_left_out).then_some(reach));
        }
        fills.push(own);
    }
    Filled { slice, fills, planned_area, reaches, known: came_with, has_helix, milled: None, shared: false }
}

/// The fill of an island by its strategy, or, where that cannot be welded, a simpler one of its own, or, with a warning, the
/// best by another strategy.
fn sound_fill(
    fill: Fill,
    island: &Polygon,
    strategy: &dyn Strategy,
    filling: &Filling,
    settings: &FillSettings,
    reached: f64,
    warnings: &mut Vec<Warning>,
) -> Fill {
    let Some(place) = unsound(&fill, island, settings, reached) else { return fill };
    let is_sound = |fill: &Fill| unsound(fill, island, settings, reached).is_none();
    if let Some(simpler) = candidates::simpler(strategy, island, settings, is_sound) {
        return simpler;
    }
    warnings.push(Warning { kind: WarningKind::Refilled, layer: settings.layer, place, size: island.area() });
    let fill = candidates::best(island, settings, filling, is_sound).unwrap_or_else(|| rings_only(island, settings));
    if let Some(place) = unsound(&fill, island, settings, 0.0) {
        // No known part gets here.
        warnings.push(Warning { kind: WarningKind::Unsound, layer: settings.layer, place, size: island.area() });
    }
    fill
}

/// The first place where the passes of a strategy cannot be welded: they leave the island, or cross, or leave an island
/// empty in which two beads fit side by side.
fn unsound(fill: &Fill, island: &Polygon, settings: &FillSettings, reached: f64) -> Option<DVec2> {
    let paths: Vec<&Path> = fill.stages.iter().flatten().collect();
    if paths.is_empty() {
        let wide = reached > 0.0 && !settings.outermost(island).is_empty();
        return wide.then(|| middle(island));
    }
    sound::fault(&paths, island, settings.machining_allowance).map(|fault| match fault {
        Fault::Outside { place, .. } | Fault::Crossing { place } => place,
    })
}

/// The dot that fills an island with its allowance, mm; `None` if none fits.
fn dot_in(island: &Polygon, allowance: f64, height: f64, dot: &Dot) -> Option<Path> {
    match island.offset(allowance, Join::ROUND).polygons() {
        [grown] => dot::dot(grown, height, dot),
        _ => None,
    }
}

/// A short pass that is the only one of an island is kept from this length, in bead widths.
const ALONE: f64 = 0.25;

/// The middle of the box around an island.
fn middle(island: &Polygon) -> DVec2 {
    Bounds::of(island.outer.points().iter().copied()).map(|bounds| bounds.center()).unwrap_or_default()
}
