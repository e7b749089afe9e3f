//! A slice with its passes, and the places in it that a bead cannot reach.

use super::candidates;
use super::scan_lines::Planned;
use crate::fill::contour::rings_only;
use crate::fill::coverage::{Bare, Coverage};
use crate::fill::sound::{self, Fault};
use crate::fill::{Fill, FillSettings, Path, Strategy};
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
    /// Number of warnings that the slice came with.
    pub(super) known: usize,
    /// Whether other layers have the same passes.
    pub(super) shared: bool,
}

/// Fills a batch of slices in parallel; `datum` is the place of the part. Slices of the same shape are filled together:
/// prismatic parts once where the strategy lays the same on every layer, and a few times where layers take turns.
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

/// The slices of a batch, those together that are filled together.
fn groups(batch: &[Planned], strategy: &dyn Strategy, profile: &Profile) -> Vec<Vec<usize>> {
    let settings = |i: usize| FillSettings { layer: 0, ..settings_of(&batch[i], profile) };
    // Short passes are told by the time that they take.
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
        let told = self.slice.warnings.iter().skip(self.known).map(|w| Warning { layer: slice.index, ..*w });
        let warnings = slice.warnings.iter().copied().chain(told).collect();
        Self { slice: Slice { warnings, ..slice.clone() }, known: slice.warnings.len(), ..self.clone() }
    }
}

fn settings_of<'a>(layer: &'a Planned, profile: &'a Profile) -> FillSettings<'a> {
    let mut settings = profile.fill_settings(layer.slice.index);
    settings.raster_angle = layer.raster_angle.unwrap_or(settings.raster_angle);
    settings.solid = layer.solid.as_ref();
    settings
}

/// Fills a slice; `datum` is the place of the part.
pub(super) fn fill_planned(layer: &Planned, strategy: &dyn Strategy, profile: &Profile, datum: DVec2) -> Filled {
    let settings = FillSettings { datum, ..settings_of(layer, profile) };
    let fill = |_: usize, island: &Polygon| strategy.fill(island, &settings);
    fill_layer(layer.slice.clone(), fill, strategy, profile, &settings)
}

/// Fills a slice; `fill` gives what the strategy lays into an island of a number.
fn fill_layer(
    mut slice: Slice,
    fill: impl Fn(usize, &Polygon) -> Fill,
    strategy: &dyn Strategy,
    profile: &Profile,
    settings: &FillSettings,
) -> Filled {
    let (mut fills, mut planned_area, came_with) = (Vec::with_capacity(slice.islands.len()), 0.0, slice.warnings.len());
    for (i, island) in slice.islands.iter().enumerate() {
        let thin = strategy.welds_thin_walls();
        let known = slice.warnings.len();
        let reached = reach(island, strategy.narrowest(settings), slice.index, &mut slice.warnings);
        if thin {
            slice.warnings[known..].iter_mut().for_each(|warning| warning.kind = WarningKind::ThinWall);
        }
        let mut own = if thin || reached > 0.0 {
            sound_fill(fill(i, island), island, strategy, profile, settings, reached, &mut slice.warnings)
        } else {
            Fill::default()
        };
        if reached > 0.0 && own.is_empty() {
            // Wide enough for a bead, but with room for neither a ring nor a wall.
            let place = Bounds::of(island.outer.points().iter().copied()).map(|b| b.center()).unwrap_or_default();
            let (kind, size) = (WarningKind::IslandTooSmall, island.area());
            slice.warnings.push(Warning { kind, layer: slice.index, place, size });
        }
        for stage in &mut own.stages {
            drop_short(stage, profile, slice.index, &mut slice.warnings);
        }
        let left_out = slice.warnings[known..].iter().any(|w| w.kind == WarningKind::IslandTooSmall);
        let (covered, bare) = covered(&own, island, profile, reached);
        planned_area += covered;
        if let Some(bare) = bare.filter(|_| !left_out) {
            let (kind, layer) = (WarningKind::Bare, slice.index);
            slice.warnings.push(Warning { kind, layer, place: bare.place, size: bare.area });
        }
        fills.push(own);
    }
    Filled { slice, fills, planned_area, known: came_with, shared: false }
}

/// What beads leave bare is told when it is more than this part of an island.
const WORTH_TELLING: f64 = 0.01;

/// Area of an island that its beads cover, mm², and what they leave bare of what one could reach, if that is worth telling.
fn covered(fill: &Fill, island: &Polygon, profile: &Profile, reached: f64) -> (f64, Option<Bare>) {
    let paths: Vec<&Path> = fill.stages.iter().flatten().collect();
    if profile.fill.infill_density < 1.0 && !paths.is_empty() {
        // Bare on purpose.
        return (reached, None);
    }
    let (whole, area, width) = (Region::from(island.clone()), island.area(), profile.bead.width);
    let Some(coverage) = Coverage::of(&paths, &whole, width) else { return (0.0, None) };
    let bare = coverage.bare(&whole).area;
    // What no bead reaches, as sharp corners, is not left bare by the strategy.
    let (unreached, least) = ((area - reached).max(0.0), WORTH_TELLING * area);
    let left = bare - unreached;
    let worst = (left > least).then(|| {
        let inner = coverage.bare(&whole.offset(-FLANK * width, Join::ROUND));
        let area = if left > FLANKS_TOO * area { left } else { inner.area - unreached };
        Bare { area, ..inner }
    });
    ((area - bare).max(0.0), worst.filter(|worst| worst.area > least))
}

/// Strips along the outline count, too, from this part of an island on.
const FLANKS_TOO: f64 = 0.02;

/// A bead is so flat over this part of its width that strips of it along the outline make little difference.
const FLANK: f64 = 0.1;

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
        // No known part comes here.
        warnings.push(Warning { kind: WarningKind::Unsound, layer: settings.layer, place, size: island.area() });
    }
    fill
}

/// Where the passes of a strategy cannot be welded: they leave the island or cross. An island with room for two beads side
/// by side that was left empty counts too.
fn unsound(fill: &Fill, island: &Polygon, settings: &FillSettings, reached: f64) -> Option<DVec2> {
    let paths: Vec<&Path> = fill.stages.iter().flatten().collect();
    if paths.is_empty() {
        let wide = reached > 0.0 && !settings.outermost(island).is_empty();
        return wide.then(|| Bounds::of(island.outer.points().iter().copied()).map(|b| b.center())).flatten();
    }
    sound::fault(&paths, island, settings.machining_allowance).map(|fault| match fault {
        Fault::Outside { place, .. } | Fault::Crossing { place } => place,
    })
}

/// Leaves out passes that are too short to weld, with a warning.
pub(super) fn drop_short(stage: &mut Vec<Path>, profile: &Profile, layer: usize, warnings: &mut Vec<Warning>) {
    let (shortest, soonest) = (profile.fill.min_pass_length, profile.soonest_arc_end());
    stage.retain(|pass| {
        let length = pass.length();
        let steady = length >= shortest && arc_time(pass, profile, layer) >= soonest;
        let keep = steady && pass.points.len() >= 2;
        // A zigzag that touches a corner with a line of no length loses nothing.
        if !keep && length > 0.1 * shortest {
            let place = pass.points.first().copied().unwrap_or_default();
            warnings.push(Warning { kind: WarningKind::PassTooShort, layer, place, size: length });
        }
        keep
    });
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

/// A feature is reported from this area on, in squared bead widths.
const THIN_FEATURE: f64 = 0.25;

/// Lost pieces end this far, in bead widths, before what a bead reaches: their edges then touch nowhere else.
const CLEAR: f64 = 0.01;

/// Area of an island that a bead of the given width can reach without leaving it, mm²; warns of places it cannot reach.
///
/// That area is the opening of the island by a disc of the bead's width. With C the region inside the outermost
/// centre-lines and r half a width, Steiner's formula gives it as long as C is connected like the island; so the shapes are
/// computed only at necks, and where this figure shows that something is lost; the area is then too large by a hair, [`CLEAR`]
/// along what is lost.
fn reach(island: &Polygon, width: f64, layer: usize, warnings: &mut Vec<Warning>) -> f64 {
    let r = width / 2.0;
    let area = island.area();
    let centre = island.centres_of_disc(r, Join::ROUND);
    if centre.is_empty() {
        let place = Bounds::of(island.outer.points().iter().copied()).map(|b| b.center()).unwrap_or_default();
        warnings.push(Warning { kind: WarningKind::IslandTooSmall, layer, place, size: area });
        return 0.0;
    }
    let smallest = THIN_FEATURE * width * width;
    if let Some(opened) = island.reached_by_disc(r, &centre)
        && island.is_roomy_for_disc(r, &centre, smallest)
    {
        return opened.clamp(0.0, area);
    }
    let lost = Region::from(island.clone()).difference(&centre.offset(r + CLEAR * width, Join::ROUND));
    for piece in lost.polygons().iter().filter(|p| p.area() > smallest) {
        let place = piece.outer.points().first().copied().unwrap_or_default();
        warnings.push(Warning { kind: WarningKind::ThinFeature, layer, place, size: piece.area() });
    }
    (area - lost.area()).max(0.0)
}
