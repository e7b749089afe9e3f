//! A slice with its passes.

use super::candidates;
use super::cover::{Cover, Reach};
use super::scan_lines::Planned;
use super::turns;
use crate::fill::around;
use crate::fill::contour::rings_only;
use crate::fill::sound::{self, Fault};
use crate::fill::{Fill, FillSettings, Path, Strategy, dot};
use crate::process::Dot;
use crate::profile::Profile;
use crate::slice::Slice;
use crate::task::{Cancelled, Task};
use crate::warning::{Warning, WarningKind};
use glam::DVec2;
use planar::{Bounds, Join, Polygon, Region};
use rayon::prelude::*;
use std::cell::OnceCell;

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
    profile: &Profile,
    datum: DVec2,
    task: &Task,
) -> Result<Vec<Filled>, Cancelled> {
    let fill = |alike: &Vec<usize>| {
        task.check()?;
        let layers: Vec<&Planned> = alike.iter().map(|&i| &batch[i]).collect();
        Ok(fill_alike(&layers, strategy, profile, datum))
    };
    let filled = groups(&batch, strategy, profile).par_iter().map(fill).collect::<Result<Vec<_>, _>>()?;
    let mut filled: Vec<Filled> = filled.into_iter().flatten().collect();
    filled.sort_by_key(|filled| filled.slice.index);
    Ok(filled)
}

/// The slices of a batch, grouped into those that can be filled together.
fn groups(batch: &[Planned], strategy: &dyn Strategy, profile: &Profile) -> Vec<Vec<usize>> {
    let settings = |i: usize| FillSettings { layer: 0, ..settings_of(&batch[i], profile) };
    // Whether a pass is too short depends on the time that it takes.
    let rate = |i: usize| profile.process.at_layer(batch[i].slice.index).rate();
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
fn fill_alike(layers: &[&Planned], strategy: &dyn Strategy, profile: &Profile, datum: DVec2) -> Vec<Filled> {
    let settings: Vec<FillSettings> =
        layers.iter().map(|layer| FillSettings { datum, ..settings_of(layer, profile) }).collect();
    if let ([layer, others @ ..], true) = (layers, strategy.repeats()) {
        let mut first = fill_planned(layer, strategy, profile, datum);
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
        fill_layer(layer.slice.clone(), own, strategy, profile, &settings[k])
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

fn settings_of<'a>(layer: &'a Planned, profile: &'a Profile) -> FillSettings<'a> {
    let mut settings = profile.fill_settings(layer.slice.index);
    settings.raster_angle = layer.raster_angle.unwrap_or(settings.raster_angle);
    settings.solid = layer.solid.as_ref();
    settings.turn = turns::turn_of(&layer.slice, profile);
    settings
}

/// Fills a slice; `datum` is the reference point of the part.
pub(super) fn fill_planned(layer: &Planned, strategy: &dyn Strategy, profile: &Profile, datum: DVec2) -> Filled {
    let settings = FillSettings { datum, ..settings_of(layer, profile) };
    let fill = |_: usize, island: &Polygon| strategy.fill(island, &settings);
    fill_layer(layer.slice.clone(), fill, strategy, profile, &settings)
}

/// Fills a slice; `fill` gives what the strategy lays into an island, by the island's index.
fn fill_layer(
    mut slice: Slice,
    fill: impl Fn(usize, &Polygon) -> Fill,
    strategy: &dyn Strategy,
    profile: &Profile,
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
            sound_fill(fill(i, island), island, strategy, profile, settings, reach.area, &mut slice.warnings)
        } else {
            Fill::default()
        };
        let mut passes = own.stages.iter().flatten();
        let dot = profile.dot().filter(|_| !passes.any(|pass| is_long_enough(pass, profile, slice.index)));
        let is_left_out = match dot.and_then(|dot| dot_in(island, profile, slice.height, &dot)) {
            Some(pass) => {
                own.stages = vec![vec![pass]];
                false
            }
            None => {
                let (is_left_out, alone) = (own.is_empty(), short_but_alone(&own, profile, slice.index));
                for stage in &mut own.stages {
                    drop_short(stage, alone.as_ref(), profile, slice.index, &mut slice.warnings);
                }
                is_left_out
            }
        };
        let warning = |(kind, place, size)| Warning { kind, layer: slice.index, place, size };
        if is_left_out {
            slice.warnings.push(warning((WarningKind::IslandTooSmall, middle(island), island.area())));
        } else if !profile.is_level() {
            let cover = Cover::of(&turns::fill_once(&own, island, settings.turn, profile), island, profile, &reach);
            planned_area += cover.area;
            slice.warnings.extend(cover.doubts.into_iter().map(warning));
        }
        if profile.is_level() {
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
    profile: &Profile,
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
    let fill = candidates::best(island, settings, profile, is_sound).unwrap_or_else(|| rings_only(island, settings));
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

/// Leaves out passes that are too short to weld, with a warning; `keep` spares one of them.
pub(super) fn drop_short(
    stage: &mut Vec<Path>,
    kept: Option<&Path>,
    profile: &Profile,
    layer: usize,
    warnings: &mut Vec<Warning>,
) {
    stage.retain(|pass| {
        let length = pass.length();
        let keep = kept == Some(pass) || is_long_enough(pass, profile, layer);
        // A zigzag that touches a corner with a line of almost no length loses nothing.
        if !keep && length > 0.1 * profile.fill.min_pass_length {
            let place = pass.points.first().copied().unwrap_or_default();
            warnings.push(Warning { kind: WarningKind::PassTooShort, layer, place, size: length });
        }
        keep
    });
}

/// Whether a pass is long enough to be welded, and takes longer than its arc needs to become steady.
fn is_long_enough(pass: &Path, profile: &Profile, layer: usize) -> bool {
    let is_long = pass.points.len() >= 2 && pass.length() >= profile.fill.min_pass_length;
    is_long && arc_time(pass, profile, layer) >= profile.soonest_arc_end()
}

/// The dot that fills an island with its allowance; `None` if none fits.
fn dot_in(island: &Polygon, profile: &Profile, height: f64, dot: &Dot) -> Option<Path> {
    match island.offset(profile.fill.machining_allowance, Join::ROUND).polygons() {
        [grown] => dot::dot(grown, height, dot),
        _ => None,
    }
}

/// A short pass that is the only one of an island is kept from this length, in bead widths.
const ALONE: f64 = 0.25;

/// The longest pass of an island whose passes are all shorter than `fill.min_pass_length`, if it can be welded at all:
/// the layers above need its metal.
fn short_but_alone(fill: &Fill, profile: &Profile, layer: usize) -> Option<Path> {
    let longest = fill.stages.iter().flatten().max_by(|a, b| a.length().total_cmp(&b.length()))?;
    let is_short = (ALONE * profile.bead.width..profile.fill.min_pass_length).contains(&longest.length());
    (is_short && arc_time(longest, profile, layer) >= profile.soonest_arc_end()).then(|| longest.clone())
}

/// How long the torch takes along a pass, s.
fn arc_time(pass: &Path, profile: &Profile, layer: usize) -> f64 {
    let process = profile.process.at_layer(layer);
    let (bead, nominal) = (profile.bead(), profile.process.deposition_speed);
    let path = pass.path();
    let time = |(i, ends): (usize, &[DVec2])| {
        let pace = nominal * profile.bead.law.pace(&bead, pass.width.after(i));
        ends[0].distance(ends[1]) / process.speed_at(pace)
    };
    path.windows(2).enumerate().map(time).sum()
}

/// The middle of the box around an island.
fn middle(island: &Polygon) -> DVec2 {
    Bounds::of(island.outer.points().iter().copied()).map(|bounds| bounds.center()).unwrap_or_default()
}
