//! One loop per island: rings that fill it evenly, joined into one path, with one arc start where others need many.
//!
//! | step | file |
//! | --- | --- |
//! | areas with space for two beads, and walls for one | [`thin`](super::thin) |
//! | the room: distances and the middle of walls | [`room`] |
//! | how many rings lie on each side of the middle | [`counts`] |
//! | a phase that is whole on rings and half-way between them in the middle | [`phase`] |
//! | rings: lines of whole phase | [`rings`] |
//! | rings joined by flips, or into a spiral | [`flips`], [`spiral`] |
//! | walls for one bead tied in | [`tie`] |
//! | widths by cell | [`cells`] |
//! | relaxation: by heights ([`relax`] on a [`field`]), flat beads by their edges ([`fit`]) | |
//! | lines that would cross are moved back | [`tangles`] |
//! | few pieces, widths in steps | [`finish`] |
//!
//! The whole method is our own. Rings are level sets: closed by construction, nested, and never crossing. There are as
//! many on one side of a wall as on the other, so no bead is left over and none ends; where the width is not a whole
//! number of beads, all of them become slightly wider or narrower.

pub mod cells;
pub mod counts;
pub mod field;
pub mod finish;
pub mod fit;
pub mod flips;
pub mod line;
pub mod phase;
pub mod relax;
pub mod rings;
pub mod room;
pub mod spiral;
pub mod squares;
pub mod tangles;

use super::thin::tie::{TieSettings, tie};
use super::thin::{Split, ThinLimits, split};
use super::{Fill, FillSettings, PassKind, Path, Strategy};
use crate::bead::{Bead, Law, Section};
use crate::pass::Along;
use glam::DVec2;
use line::Line;
use planar::{Bounds, FillRule, Join, Polygon, Region};
use room::Room;

/// One loop per island.
pub struct OneLoop;

/// What a profile sets for loops.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoopOptions {
    /// The narrowest and the widest bead, mm.
    pub width_limits: (f64, f64),
    /// Length over which widths are averaged, so that they change no faster, mm.
    pub smoothing_length: f64,
    /// Widths change in steps of about this, mm.
    pub width_step: f64,
    /// Rounds of relaxation.
    pub rounds: u32,
    /// Length of the sections that a flip removes, in distances between rings.
    pub flip_length: f64,
    /// Whether nested rings become a spiral.
    pub spirals: bool,
}

/// All settings that the steps need; lengths in mm.
#[derive(Debug, Clone, Copy)]
pub struct LoopSettings<'a> {
    /// Index of the layer.
    pub layer: usize,
    /// The point from which the places of flips are measured: the same on all layers.
    pub datum: DVec2,
    /// The nominal bead.
    pub bead: Bead,
    /// How a bead's height follows its width.
    pub law: &'a Law,
    /// Width of the nominal bead.
    pub bead_width: f64,
    /// Distance between neighbouring lines.
    pub stepover: f64,
    /// The narrowest and the widest bead where two or more lie side by side.
    pub width_limits: (f64, f64),
    /// The narrowest and the widest bead alone in a wall.
    pub single: (f64, f64),
    /// Walls thinner than this get no bead.
    pub thinnest: f64,
    /// From this thickness on a wall has space for two beads.
    pub double: f64,
    /// Distance of an end from a line that passes it, in bead widths.
    pub end_gap: f64,
    /// Passes shorter than this are left out.
    pub shortest: f64,
    /// Length over which widths are averaged, so that they change no faster.
    pub smoothing_length: f64,
    /// Widths change in steps of about this.
    pub width_step: f64,
    /// Rounds of relaxation.
    pub rounds: u32,
    /// Length of the sections that a flip removes, in distances between rings.
    pub flip_length: f64,
    /// Whether nested rings become a spiral.
    pub spirals: bool,
}

/// Points per stepover on lines that are being relaxed.
const POINTS_PER_STEPOVER: f64 = 7.0;
/// Coordinates are rounded to this, mm, so that an island is filled alike wherever it lies.
const GRAIN_MM: f64 = 1e-6;

impl Strategy for OneLoop {
    fn name(&self) -> &'static str {
        "loop"
    }

    fn fill(&self, island: &Polygon, settings: &FillSettings) -> Fill {
        self.fill_layers(island, std::slice::from_ref(settings)).pop().unwrap_or_default()
    }

    /// Only the starts of loops differ between the layers.
    fn fill_layers(&self, island: &Polygon, layers: &[FillSettings]) -> Vec<Fill> {
        let Some(first) = layers.first() else { return Vec::new() };
        let mut passes: Vec<Vec<Path>> = vec![Vec::new(); layers.len()];
        for part in island.offset(first.machining_allowance, Join::ROUND).polygons() {
            let (part, middle) = about_origin(part);
            let settings = LoopSettings::of(first, middle);
            let room = Room::of(&part, &settings);
            let relaxed = Steps::relaxed_in(&room, &part, &settings).relaxed;
            for (layer, passes) in layers.iter().zip(&mut passes) {
                let settings = LoopSettings::of(layer, middle);
                let lines = finish::all_finished(&relaxed, &room, &settings);
                passes.extend(lines.into_iter().map(|line| pass(line, middle)));
            }
        }
        passes.into_iter().map(fill_of).collect()
    }

    /// Without a spiral, with beads as narrow as those of thin walls, and without relaxation.
    fn simpler<'a>(&self, settings: &FillSettings<'a>) -> Vec<FillSettings<'a>> {
        let given = settings.one_loop;
        let without = |one_loop: LoopOptions| FillSettings { one_loop, ..*settings };
        let narrowest = given.width_limits.0.min(settings.wall.width_limits.0);
        let narrow = LoopOptions { width_limits: (narrowest, given.width_limits.1), ..given };
        let plain = LoopOptions { rounds: 0, ..given };
        [LoopOptions { spirals: false, ..given }, narrow, plain, LoopOptions { spirals: false, ..plain }]
            .into_iter()
            .filter(|options| *options != given)
            .map(without)
            .collect()
    }

    /// Flips and spirals alternate over the layers.
    fn period(&self) -> Option<usize> {
        Some(2 * flips::TURNS as usize)
    }
}

/// A single loop begins at its seam; several begin wherever the travel is short.
fn fill_of(passes: Vec<Path>) -> Fill {
    let alone = matches!(&passes[..], [pass] if pass.closed);
    Fill { stages: vec![passes], fixed_order: alone }
}

/// The steps of an island, with the middle of its bounding box as origin, and where that middle lies, mm. A machining
/// allowance may join an island to itself or, if negative, split it into several.
pub fn steps(island: &Polygon, settings: &FillSettings) -> Vec<(Steps, DVec2)> {
    let parts = island.offset(settings.machining_allowance, Join::ROUND);
    let placed = parts.polygons().iter().map(|part| {
        let (part, middle) = about_origin(part);
        (Steps::of(&part, &LoopSettings::of(settings, middle)), middle)
    });
    placed.collect()
}

/// The rings of an island, not joined, level by level from the outline inwards, each as wide as its cell. They stay
/// where two of the narrowest beads fit side by side, and half of one from the outline.
pub(super) fn apart(island: &Polygon, settings: &FillSettings) -> Vec<Vec<Path>> {
    let (allowance, roomy) = (settings.machining_allowance, settings.double() / 2.0);
    let mut levels: Vec<Vec<Path>> = Vec::new();
    for part in island.offset(allowance - roomy, Join::ROUND).offset(roomy, Join::ROUND).polygons() {
        let (part, middle) = about_origin(part);
        let settings = LoopSettings::of(settings, middle);
        let (room, inner) = (Room::of(&part, &settings), part.offset(-settings.width_limits.0 / 2.0, Join::ROUND));
        let mut rings: Vec<Vec<planar::Ring>> = Vec::new();
        for ring in rings_of(&room, &settings) {
            let level = ring.level as usize;
            rings.resize_with(rings.len().max(level), Vec::new);
            rings[level - 1].push(planar::Ring::new(ring.points));
        }
        let clipped = rings.iter().map(|rings| Region::from_rings(rings, FillRule::EvenOdd).intersection(&inner));
        let step = settings.stepover / POINTS_PER_STEPOVER;
        let line = |ring: &planar::Ring| Line::ring(rings::resampled(ring.points(), step));
        let placed = clipped
            .enumerate()
            .flat_map(|(level, region)| region.rings().map(|r| (level, line(r))).collect::<Vec<_>>());
        let (numbers, mut lines): (Vec<usize>, Vec<Line>) = placed.unzip();
        cells::set_widths(&mut lines, &room, &settings);
        for (level, mut line) in numbers.into_iter().zip(lines) {
            line.fit_inside(&room, &settings);
            levels.resize_with(levels.len().max(level + 1), Vec::new);
            let mut line = finish::finished(&line, &room, &settings);
            narrow(&mut line, &part);
            levels[level].push(pass(line, middle));
        }
    }
    levels
}

/// Narrows the pieces of a line that would extend beyond an outline.
fn narrow(line: &mut Line, outline: &Polygon) {
    let edges: Vec<(DVec2, DVec2)> = outline.rings().flat_map(planar::Ring::edges).collect();
    let room = |p: &DVec2| {
        let squares = edges.iter().map(|(a, b)| planar::polyline::distance_squared_to_segment(*p, *a, *b));
        squares.fold(f64::INFINITY, f64::min).sqrt()
    };
    let rooms: Vec<f64> = line.points.iter().map(room).collect();
    for i in 0..line.count() {
        line.widths[i] = line.widths[i].min(2.0 * rooms[i].min(rooms[line.behind(i)]));
    }
}

/// The polygon moved so that the middle of its bounding box is the origin, and where that middle was.
fn about_origin(polygon: &Polygon) -> (Polygon, DVec2) {
    let bounds = Bounds::of(polygon.outer.points().iter().copied()).unwrap_or(Bounds::EMPTY);
    let middle = bounds.center();
    let moved = |p: &DVec2| ((*p - middle) / GRAIN_MM).round() * GRAIN_MM;
    let ring = |ring: &planar::Ring| planar::Ring::new(ring.points().iter().map(moved).collect());
    (Polygon { outer: ring(&polygon.outer), holes: polygon.holes.iter().map(ring).collect() }, middle)
}

fn pass(line: Line, middle: DVec2) -> Path {
    let kind = if line.thin.iter().all(|thin| *thin) { PassKind::Wall } else { PassKind::Contour };
    let points = line.points.iter().map(|p| *p + middle).collect();
    Path { kind, closed: line.closed, points, width: Along::Each(line.widths), reversible: true }
}

impl<'a> LoopSettings<'a> {
    /// Settings for an island moved by `middle`.
    fn of(fill: &FillSettings<'a>, middle: DVec2) -> Self {
        let LoopOptions { width_limits, smoothing_length, width_step, rounds, flip_length, spirals } = fill.one_loop;
        Self {
            layer: fill.layer,
            datum: fill.datum - middle,
            bead: fill.bead,
            law: fill.law,
            bead_width: fill.bead.width,
            stepover: fill.stepover,
            width_limits,
            single: fill.wall.width_limits,
            thinnest: fill.wall.thinnest,
            double: fill.double(),
            end_gap: fill.wall.end_gap,
            shortest: fill.min_pass_length,
            smoothing_length,
            width_step,
            rounds,
            flip_length,
            spirals,
        }
    }

    /// Distance from a bead's edge inwards to the end of its cell, mm.
    pub fn edge(&self) -> f64 {
        (self.bead_width - self.stepover) / 2.0
    }

    /// The range of widths of a piece, mm.
    pub fn limits(&self, thin: bool) -> (f64, f64) {
        if thin { self.single } else { self.width_limits }
    }

    /// The range of widths of rings, in bead widths.
    pub fn width_ratios(&self) -> (f64, f64) {
        (self.width_limits.0 / self.bead_width, self.width_limits.1 / self.bead_width)
    }

    /// The mean height that a layer should have, in nominal bead heights.
    pub fn target(&self) -> f64 {
        self.bead.rise(self.stepover) / self.bead.height
    }

    /// Width of the bead whose metal fills a cell of width `cell` (mm), mm.
    pub fn width_for(&self, cell: f64) -> f64 {
        self.law.width_of_area(&self.bead, self.bead.rise(self.stepover) * cell)
    }

    /// Height of a bead of this width, in nominal bead heights.
    pub fn height_of(&self, width: f64) -> f64 {
        self.law.bead(&self.bead, width).height / self.bead.height
    }

    /// Limits that decide which walls have space for one bead only.
    pub fn thin_limits(&self) -> ThinLimits {
        let Self { bead_width, single, thinnest, double, .. } = *self;
        ThinLimits { bead_width, single, thinnest, double }
    }
}

/// The results of all steps for one island, to be tested and drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct Steps {
    /// Thick parts and walls for one bead.
    pub split: Split,
    /// The rings of all thick parts.
    pub rings: Vec<rings::Ring>,
    /// Where rings are joined by flips.
    pub flips: Vec<DVec2>,
    /// Rings joined, walls tied in, with the widths of their cells.
    pub joined: Vec<Line>,
    /// The relaxed lines.
    pub relaxed: Vec<Line>,
    /// The finished lines, as they are laid.
    pub lines: Vec<Line>,
}

impl Steps {
    /// Runs all steps for an island that lies around the origin.
    pub fn of(island: &Polygon, settings: &LoopSettings) -> Self {
        let room = Room::of(island, settings);
        let steps = Self::relaxed_in(&room, island, settings);
        let lines = finish::all_finished(&steps.relaxed, &room, settings);
        Self { lines, ..steps }
    }

    /// All steps but the last, in the island's room.
    fn relaxed_in(room: &Room, island: &Polygon, settings: &LoopSettings) -> Self {
        let split = split(island, &settings.thin_limits());
        let (mut rings, mut flips, mut paths) = (Vec::new(), Vec::new(), Vec::new());
        for part in &split.thick {
            // Usually the whole island is thick.
            let of_part = (part != island).then(|| Room::of(part, settings));
            let room = of_part.as_ref().unwrap_or(room);
            let own = rings_of(room, settings);
            // A thin wall tied to an open path would cost an arc start.
            let open = settings.spirals && split.thin.is_empty();
            match Some(&own).filter(|_| open).and_then(|own| spiral::spiral(own, settings)) {
                Some(path) => paths.push(path_pass(path, false)),
                None => {
                    let joined = flips::join(&own, room, settings);
                    flips.extend(joined.flips);
                    paths.extend(joined.loops.into_iter().map(|line| path_pass(line, true)));
                }
            }
            rings.extend(own);
        }
        let step = settings.stepover / POINTS_PER_STEPOVER;
        let mut joined: Vec<Line> = tied(paths, &split, settings).iter().map(|line| line.resampled(step)).collect();
        cells::set_widths(&mut joined, room, settings);
        let relaxed = relaxed(&joined, room, &split.open, settings);
        Self { split, rings, flips, joined, relaxed, lines: Vec::new() }
    }
}

fn rings_of(room: &Room, settings: &LoopSettings) -> Vec<rings::Ring> {
    let counts = counts::counts(room, settings);
    let phase = phase::phase(room, &counts, settings);
    rings::rings(room, &phase, settings)
}

fn relaxed(lines: &[Line], room: &Room, open: &Region, settings: &LoopSettings) -> Vec<Line> {
    tangles::moved(lines, |lines, mend| match settings.bead.section {
        Section::Stadium => fit::fitted(lines, room, settings, mend),
        Section::Parabola | Section::Ellipse => relax::relaxed(lines, room, open, settings, mend),
    })
}

/// A width of 0 marks pieces whose width is not known yet.
fn path_pass(points: Vec<DVec2>, closed: bool) -> Path {
    Path { kind: PassKind::Contour, closed, points, width: Along::Same(0.0), reversible: true }
}

/// Paths and thin walls tied together.
fn tied(paths: Vec<Path>, split: &Split, settings: &LoopSettings) -> Vec<Line> {
    let tie_settings =
        TieSettings { limits: settings.thin_limits(), end_gap: settings.end_gap, shortest: settings.shortest };
    let line = |pass: Path| {
        let widths: Vec<f64> = (0..pass.points.len()).map(|i| pass.width.after(i)).collect();
        let thin = widths.iter().map(|width| *width > 0.0).collect();
        Line { points: pass.points, widths, thin, closed: pass.closed }
    };
    tie(paths, &split.thin, &tie_settings).into_iter().map(line).collect()
}
