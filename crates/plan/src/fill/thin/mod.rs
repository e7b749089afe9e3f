//! Thin walls: the parts of an island with space for only one bead.
//!
//! A disc as wide as two of the narrowest beads side by side is rolled through the island (an opening). What it reaches
//! is *thick* and left to a strategy; elsewhere one bead follows the medial axis, as wide as the wall ([`split`]).
//! Where a thin wall meets a thick part, its bead is tied to the passes there ([`tie`](mod@tie)). Corners, and walls no
//! longer than they are wide, do not count as thin walls: they stay with the thick part they belong to. `around` does
//! all this for a strategy.

pub mod tie;

use super::{Fill, FillSettings, Path};
use crate::pass::Along;
use glam::DVec2;
use planar::medial::{Branch, CORNER, MedialAxis, MedialOptions, Node};
use planar::polyline::simplify_ring;
use planar::{Bounds, FillRule, Join, Polygon, Region, Ring};
use std::collections::HashMap;
use std::ops::Range;
use tie::{TieSettings, tie};

/// Which walls are thin; all in mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ThinLimits {
    /// Nominal bead width.
    pub bead_width: f64,
    /// The narrowest and the widest single bead.
    pub single: (f64, f64),
    /// Walls thinner than this get no bead; from here up to the narrowest bead they get that bead, which extends beyond
    /// them.
    pub thinnest: f64,
    /// From this thickness on there is space for two beads.
    pub double: f64,
}

/// A wall for one bead.
#[derive(Debug, Clone, PartialEq)]
pub struct ThinWall {
    /// Its middle, with half its thickness.
    pub nodes: Vec<Node>,
    /// How it ends.
    pub ends: [End; 2],
}

/// How a thin wall ends.
#[derive(Debug, Clone, PartialEq)]
pub enum End {
    /// Free: it meets nothing.
    Free,
    /// At other thin walls, or at its own other end: all ends that meet there have this number.
    Junction(usize),
    /// In a thick part: the middle of the wall continues into it along these nodes.
    Mouth(Vec<Node>),
}

/// An island split into parts.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Split {
    /// The parts with room for two beads or more.
    pub thick: Vec<Polygon>,
    /// The walls for one bead.
    pub thin: Vec<ThinWall>,
    /// Where a disc for two beads fits, and a little more.
    pub open: Region,
}

/// Minimum length of a wall that is attached at one end only, or tapers to nothing, in bead widths.
const SHORTEST: f64 = 1.5;
/// Least length of one of several necks thinner than the narrowest bead, such as those between holes, in bead widths: a
/// bead for each would cost an arc start, so shorter necks are filled by passes along both sides.
const NECK: f64 = 3.0;
/// Minimum area of a thin piece, in squared bead widths.
const SMALLEST: f64 = 0.15;
/// The open region is grown by this many bead widths: its edges then stay clear of those of the island, and the pieces
/// cut from the island have no slivers. Four times [`ACCURACY`] would put a point of its arcs onto the edges beside every
/// right angle.
const GROWN: f64 = 0.024;
/// Outline points closer than this to the line between their neighbours are dropped, in bead widths.
const SIMPLER: f64 = 0.001;
/// Accuracy of the shapes that are cut out, in bead widths.
const ACCURACY: f64 = 0.005;
/// A disc with this fraction of the thinnest wall as its diameter fits into every thin piece.
const ROOMY: f64 = 0.8;
/// A neck gets two beads if it is at least this fraction as wide as two beads need.
const NEARLY_DOUBLE: f64 = 0.94;
/// The same for a neck so short that two beads touch nowhere else.
const DOUBLE_IF_SHORT: f64 = 0.8;
/// The middle of a wall is followed this far into the thick part, in bead widths.
const TAIL: f64 = 1.5;
/// Samples of the medial axis per bead width; a wall begins and ends at one of them.
const SAMPLES: f64 = 6.0;

/// If a strategy's beads all have the same width, walls from this thickness on, in bead widths, are left to it.
const DOUBLE: f64 = 1.4;

/// Fills the thick parts of an island with `fill`, and ties a bead for each thin wall to the passes there.
pub(super) fn around<'a>(
    island: &Polygon,
    settings: &FillSettings<'a>,
    fill: impl Fn(&Polygon, &FillSettings<'a>) -> Fill,
) -> Fill {
    let (w, single) = (settings.bead.width, settings.wall.width_limits);
    let (single, thinnest) = ((single.0, single.1.min(DOUBLE * w)), settings.wall.thinnest);
    let limits = ThinLimits { bead_width: w, single, thinnest, double: DOUBLE * w };
    let mut result = Fill::default();
    for grown in island.offset(settings.machining_allowance, Join::ROUND).polygons() {
        let centres = centres(grown, &limits);
        if limits.single.1 <= limits.double && is_thick(grown, &centres, &limits) {
            return fill(island, settings);
        }
        let split = split_by(grown, &centres, &limits);
        if split.thin.is_empty() {
            // Nothing was cut off.
            return fill(island, settings);
        }
        let within = FillSettings { machining_allowance: 0.0, ..*settings };
        let mut own = Fill::default();
        for part in &split.thick {
            own.add(fill(part, &within), settings.contour_order);
        }
        if own.stages.is_empty() {
            own.stages.push(Vec::new());
        }
        let outermost = nearest_stage(&own.stages, &split.thin);
        let ends = TieSettings { limits, end_gap: settings.wall.end_gap, shortest: settings.min_pass_length };
        let stage = std::mem::take(&mut own.stages[outermost]);
        own.stages[outermost] = tie(stage, &split.thin, &ends);
        own.stages[outermost].iter_mut().for_each(|pass| step_widths(pass, settings.one_loop.width_step));
        result.add(own, settings.contour_order);
    }
    result
}

/// Keeps each width until the wanted one is more than half a step off, so that few moves change the speed.
fn step_widths(pass: &mut Path, step: f64) {
    let Along::Each(widths) = &mut pass.width else { return };
    let mut held = f64::NEG_INFINITY;
    for width in widths {
        if (*width - held).abs() > step / 2.0 {
            held = *width;
        }
        *width = held;
    }
}

/// The stage with the pass that is nearest to a mouth.
fn nearest_stage(stages: &[Vec<Path>], walls: &[ThinWall]) -> usize {
    let mouths: Vec<_> = walls
        .iter()
        .flat_map(|wall| [(wall.nodes.first(), &wall.ends[0]), (wall.nodes.last(), &wall.ends[1])])
        .filter(|(_, end)| matches!(end, End::Mouth(_)))
        .filter_map(|(node, _)| node)
        .collect();
    let distance = |stage: &Vec<Path>| {
        let points = stage.iter().flat_map(|pass| &pass.points);
        let squares = points.flat_map(|p| mouths.iter().map(move |node| node.at.distance_squared(*p)));
        squares.fold(f64::INFINITY, f64::min)
    };
    let distances: Vec<f64> = stages.iter().map(distance).collect();
    (0..stages.len()).min_by(|&a, &b| distances[a].total_cmp(&distances[b])).unwrap_or(0)
}

/// Where the centre of a disc for two beads may lie.
fn centres(island: &Polygon, limits: &ThinLimits) -> Region {
    island.centres_of_disc(limits.double / 2.0, round(limits))
}

/// Round joins as accurate as the shapes that are cut out.
fn round(limits: &ThinLimits) -> Join {
    Join::Round(ACCURACY * limits.bead_width)
}

/// Whether [`split`] certainly finds no thin wall.
fn is_thick(island: &Polygon, centres: &Region, limits: &ThinLimits) -> bool {
    island.is_roomy_for_disc(limits.double / 2.0, centres, SMALLEST * limits.bead_width * limits.bead_width)
}

/// Splits an island.
pub fn split(island: &Polygon, limits: &ThinLimits) -> Split {
    split_by(island, &centres(island, limits), limits)
}

/// [`split`], given where the centre of a disc for two beads may lie.
fn split_by(island: &Polygon, centres: &Region, limits: &ThinLimits) -> Split {
    let whole = with_fewer_points(island, SIMPLER * limits.bead_width);
    let open = centres.offset(limits.double / 2.0 + GROWN * limits.bead_width, round(limits));
    let needs_two = |part: &&Polygon| part.holds_disc(limits.single.1 / 2.0);
    // The disc that opened a part fits into it; the part has been grown since.
    let widest = limits.single.1 / 2.0 + GROWN * limits.bead_width;
    let opens_two = |part: &&Polygon| limits.single.1 <= limits.double || part.holds_disc(widest);
    let thick: Vec<Polygon> = open.polygons().iter().filter(opens_two).cloned().collect();
    let between = Between::of(&thick);
    let rest = whole.difference(&Region::from_normalised(thick));
    let smallest = SMALLEST * limits.bead_width * limits.bead_width;
    // Most pieces are corners, in which no bead could lie.
    let roomy = |piece: &Polygon| piece.area() > smallest && piece.holds_disc(ROOMY * limits.thinnest / 2.0);
    let candidates = rest.into_polygons().into_iter().map(|piece| (!roomy(&piece), piece));
    let (short, candidates): (Vec<bool>, Vec<Polygon>) =
        candidates.filter(|(short, piece)| !short || between.joins(piece)).unzip();
    let axis = axis(&candidates, &whole, limits);
    let alone = open.polygons().is_empty();
    let welded = |through: bool| -> Vec<(Vec<ThinWall>, &Polygon)> {
        let pieces = candidates.iter().zip(&short);
        let walls = pieces.map(|(piece, &short)| (walls(piece, Neck { short, through }, &axis, limits), piece));
        walls.filter(|(walls, _)| !walls.is_empty()).collect()
    };
    // A single wall from passes to passes opens their loop, and costs no arc start.
    let single = |welded: &[(Vec<ThinWall>, &Polygon)]| matches!(welded, [(walls, _)] if walls.len() == 1);
    let every = welded(true);
    let welded = if alone || single(&every) { every } else { welded(false) };
    let (thin, pieces): (Vec<Vec<ThinWall>>, Vec<Polygon>) =
        welded.into_iter().map(|(walls, piece)| (walls, piece.clone())).unzip();
    let thin = thin.concat();
    if thin.is_empty() {
        let thick = Some(island.clone()).filter(|island| needs_two(&island)).into_iter().collect();
        return Split { thick, thin, open };
    }
    // Slightly more is cut off: coinciding edges take long to resolve.
    let rest = whole.difference(&Region::from_normalised(pieces).offset(ACCURACY * limits.bead_width, round(limits)));
    Split { thick: rest.into_polygons().into_iter().filter(|p| needs_two(&p)).collect(), thin, open }
}

/// Which pieces of an island lie between thick parts.
struct Between {
    /// The part that has a point at a position, in whole micrometres.
    parts: HashMap<[i64; 2], usize>,
}

impl Between {
    fn of(thick: &[Polygon]) -> Self {
        if thick.len() < 2 {
            return Self { parts: HashMap::new() };
        }
        let points = |part: &Polygon| part.rings().flat_map(|ring| ring.points().to_vec()).collect::<Vec<_>>();
        let placed =
            thick.iter().enumerate().flat_map(|(k, part)| points(part).into_iter().map(move |p| (place(p), k)));
        Self { parts: placed.collect() }
    }

    /// Whether a piece of the remainder joins two parts, however short it is: it has points of both.
    fn joins(&self, piece: &Polygon) -> bool {
        if self.parts.is_empty() {
            return false;
        }
        let mut parts = piece.rings().flat_map(Ring::points).filter_map(|p| self.parts.get(&place(*p)));
        let first = parts.next();
        first.is_some_and(|first| parts.any(|part| part != first))
    }
}

/// A position in whole micrometres.
fn place(point: DVec2) -> [i64; 2] {
    (point * 1e3).round().as_i64vec2().to_array()
}

/// An island without points that hardly matter: scanned outlines have many.
fn with_fewer_points(island: &Polygon, tolerance: f64) -> Region {
    let rings: Vec<Ring> = island.rings().filter_map(|ring| simplify_ring(ring.clone(), tolerance)).collect();
    let points = |ring: &Ring| ring.points().len();
    if rings.iter().map(points).sum::<usize>() == island.rings().map(points).sum::<usize>() {
        return island.clone().into();
    }
    Region::from_rings(&rings, FillRule::NonZero)
}

/// The medial axis around thin pieces of `whole`.
fn axis(pieces: &[Polygon], whole: &Region, limits: &ThinLimits) -> MedialAxis {
    // The piece is extended beyond its mouths, so that the axis runs straight through them.
    let around = Region::from_normalised(pieces.to_vec()).offset(2.0 * limits.double, round(limits));
    let options = MedialOptions { spacing: limits.bead_width / SAMPLES, ..MedialOptions::default() };
    // Teeth and bumps would cut the wall that they are on into short pieces.
    let is_spur = |nodes: &[Node]| length(nodes) < SHORTEST * limits.bead_width;
    MedialAxis::of_region(&whole.intersection(&around), &options).pruned(CORNER).without_spurs(is_spur)
}

/// Properties of the necks of a thin piece.
#[derive(Debug, Clone, Copy)]
struct Neck {
    /// The piece is a neck between two thick parts, and hardly longer than thick.
    short: bool,
    /// Even the shortest neck gets a wall: the island has no thick part whose passes could fill it, or no other wall.
    through: bool,
}

/// The walls of a thin piece.
fn walls(piece: &Polygon, neck: Neck, axis: &MedialAxis, limits: &ThinLimits) -> Vec<ThinWall> {
    let Some(bounds) = Bounds::of(piece.outer.points().iter().copied()) else { return Vec::new() };
    let near = |node: &Node| node.at.cmpge(bounds.min).all() && node.at.cmple(bounds.max).all();
    let branches = axis.branches.iter().filter(|branch| branch.nodes.iter().any(near));
    let mut walls: Vec<ThinWall> = branches.flat_map(|branch| walls_along(branch, piece, neck, limits)).collect();
    drop_stubs(&mut walls, limits);
    let double = if neck.short { DOUBLE_IF_SHORT } else { NEARLY_DOUBLE } * limits.double;
    let nearly = |wall: &ThinWall| wall.nodes.iter().all(|node| 2.0 * node.radius >= double);
    let hangs = |wall: &ThinWall| wall.ends.iter().any(|end| matches!(end, End::Mouth(_)));
    if walls.iter().all(|wall| nearly(wall) && hangs(wall)) { Vec::new() } else { walls }
}

/// The sections of a branch that lie within the thin piece and are wide enough for a bead.
fn walls_along(branch: &Branch, piece: &Polygon, neck: Neck, limits: &ThinLimits) -> Vec<ThinWall> {
    let nodes = &branch.nodes;
    let inside: Vec<bool> = nodes.iter().map(|node| piece.contains(node.at)).collect();
    let fits_by = |width: f64| -> Vec<bool> {
        nodes.iter().zip(&inside).map(|(node, inside)| *inside && 2.0 * node.radius >= width).collect()
    };
    let (mut fits, thin) = (fits_by(limits.single.0), fits_by(limits.thinnest));
    let thinner: Vec<bool> = fits.iter().zip(thin).map(|(fits, thin)| thin && !fits).collect();
    let is_long = |stretch: &Range<usize>| {
        let wider = |k: Option<usize>| k.filter(|k| *k < nodes.len()).is_some_and(|k| fits[k] || !inside[k]);
        let is_neck = wider(stretch.start.checked_sub(1)) && wider(Some(stretch.end));
        let least = match (is_neck, neck.through) {
            (true, true) => 0.0,
            (true, false) => NECK,
            (false, _) => SHORTEST,
        };
        length(&nodes[stretch.clone()]) >= least * limits.bead_width
    };
    let long: Vec<Range<usize>> = stretches(&thinner).into_iter().filter(is_long).collect();
    long.into_iter().flatten().for_each(|k| fits[k] = true);
    // A neck may be shorter than the distance between two nodes.
    let longer = |stretch: Range<usize>| match neck.short && stretch.len() < 2 {
        true => stretch.start.saturating_sub(1)..(stretch.end + 1).min(nodes.len()),
        false => stretch,
    };
    stretches(&fits)
        .into_iter()
        .map(longer)
        .filter(|stretch| stretch.len() >= 2)
        .map(|stretch| {
            let end = |beyond: Option<usize>, junction: usize, outwards: bool| match beyond {
                None => End::Junction(junction),
                Some(k) if inside[k] => End::Free,
                Some(k) => End::Mouth(tail(nodes, k, outwards, TAIL * limits.bead_width)),
            };
            let before = end(stretch.start.checked_sub(1), branch.from, false);
            let behind = end(Some(stretch.end).filter(|k| *k < nodes.len()), branch.to, true);
            ThinWall { nodes: nodes[stretch].to_vec(), ends: [before, behind] }
        })
        .collect()
}

fn stretches(fits: &[bool]) -> Vec<Range<usize>> {
    let mut stretches = Vec::new();
    let mut start = None;
    for (i, fits) in fits.iter().copied().chain([false]).enumerate() {
        match (fits, start) {
            (true, None) => start = Some(i),
            (false, Some(from)) => {
                stretches.push(from..i);
                start = None;
            }
            _ => {}
        }
    }
    stretches
}

/// The nodes from index `from` on, up to a length of `reach` (mm).
fn tail(nodes: &[Node], from: usize, outwards: bool, reach: f64) -> Vec<Node> {
    let on: Vec<Node> = if outwards { nodes[from..].to_vec() } else { nodes[..=from].iter().rev().copied().collect() };
    let mut along = 0.0;
    let within = on.windows(2).take_while(|w| {
        along += w[0].at.distance(w[1].at);
        along <= reach
    });
    let count = within.count() + 1;
    on[..count].to_vec()
}

/// Drops walls with one free end that are hardly longer than wide: they are corners. Junctions where they ended may
/// then be junctions no longer.
fn drop_stubs(walls: &mut Vec<ThinWall>, limits: &ThinLimits) {
    loop {
        let mut degrees = std::collections::BTreeMap::new();
        for end in walls.iter().flat_map(|wall| &wall.ends) {
            if let End::Junction(number) = end {
                *degrees.entry(*number).or_insert(0) += 1;
            }
        }
        for end in walls.iter_mut().flat_map(|wall| &mut wall.ends) {
            if matches!(end, End::Junction(number) if degrees.get(number) == Some(&1)) {
                *end = End::Free;
            }
        }
        let before = walls.len();
        walls.retain(|wall| {
            let free = wall.ends.iter().filter(|end| **end == End::Free).count();
            free != 1 || wall.length() >= SHORTEST * limits.bead_width
        });
        if walls.len() == before {
            return;
        }
    }
}

impl ThinWall {
    /// Length, mm.
    pub fn length(&self) -> f64 {
        length(&self.nodes)
    }
}

/// Length of a line through nodes, mm.
fn length(nodes: &[Node]) -> f64 {
    nodes.windows(2).map(|w| w[0].at.distance(w[1].at)).sum()
}
