//! Which skeleton regions are filled, how deep pockets are searched for and how far sharp corners are extended. No
//! single choice suits all shapes, so several are tried and the deposit model judges them: the best one leaves the
//! least void while overfilling little more than plain contours do. Depth and reach are varied only if the settings
//! leave them open.

use super::pockets::{self, Level};
use super::{HybridSettings, Steps};
use crate::deposit::{DepositSettings, Figures, Judge, Nominal};
use crate::fill::{FillSettings, Path, contour};
use crate::layer::Layer;
use crate::pass::Pass;
use planar::{Polygon, Region};
use std::cmp::Ordering;
use std::collections::BTreeSet;

/// Fractions of the skeleton regions that are tried, the largest regions first.
const SHARES: [f64; 3] = [0.0, 0.5, 1.0];
/// Depths of pockets that are tried, in stepovers.
const DEPTHS: [f64; 2] = [1.0, 1.5];
/// Reaches of corners that are tried. The regions are chosen with the first one, the others are tried on the best.
const REACHES: [f64; 3] = [0.4, 0.9, 1.0];
/// Overfill may exceed that of contours by this many percentage points of the judged area. The goal is two; coarse
/// grids are less exact.
const MORE_OVERFILL: f64 = 1.9;
/// Weight of overfill beyond that, relative to void.
const EXCESS: f64 = 2.0;
/// Grid points across a bead: half as many as for a verdict.
const POINTS_ACROSS: f64 = 10.0;

/// The best steps for an island.
pub(super) fn best(island: &Polygon, settings: &FillSettings) -> Steps {
    let (hybrid, contest) = (settings.hybrid, Contest::new(island, settings));
    let depths = DEPTHS.map(|depth| depth * settings.stepover);
    let depths = if hybrid.tries_depths { &depths[..] } else { &[hybrid.pocket_depth] };
    let (first, others) = if hybrid.tries_reaches { (REACHES[0], &REACHES[1..]) } else { (hybrid.tip_reach, &[][..]) };
    let mut ideas: Vec<Idea> = Vec::new();
    for idea in depths.iter().flat_map(|&depth| contest.ideas(depth, first)) {
        if !ideas.iter().any(|other| other.lays_the_same(&idea)) {
            ideas.push(idea);
        }
    }
    let entries = ideas.into_iter().map(|idea| (contest.entry(&idea), idea));
    let Some((best, idea)) = entries.min_by(|a, b| a.0.against(&b.0)) else { return Steps::default() };
    let entries = others.iter().map(|&reach| contest.entry(&idea.reaching(reach)));
    std::iter::once(best).chain(entries).min_by(Entry::against).map(|best| best.steps).unwrap_or_default()
}

/// A candidate.
#[derive(Clone)]
struct Idea<'a> {
    settings: FillSettings<'a>,
    levels: Vec<Level>,
    /// The skeleton regions that are filled.
    regions: Region,
}

impl Idea<'_> {
    /// Whether it differs only in pockets that are not filled.
    fn lays_the_same(&self, other: &Self) -> bool {
        let contours = |idea: &Self| idea.levels.iter().map(|level| level.region.clone()).collect::<Vec<_>>();
        self.regions == other.regions && contours(self) == contours(other)
    }

    fn reaching(&self, tip_reach: f64) -> Self {
        let settings = FillSettings { hybrid: HybridSettings { tip_reach, ..self.settings.hybrid }, ..self.settings };
        Self { settings, ..self.clone() }
    }
}

/// A candidate that was tried, and its verdict.
struct Entry {
    steps: Steps,
    /// Void plus weighted overfill beyond the limit, % of the judged area.
    cost: f64,
}

impl Entry {
    fn against(&self, other: &Self) -> Ordering {
        self.cost.total_cmp(&other.cost)
    }
}

/// How candidates for an island are judged.
struct Contest<'a> {
    island: &'a Polygon,
    settings: &'a FillSettings<'a>,
    outermost: Region,
    /// Number of passes with contours alone: no candidate may have more.
    most: usize,
    /// Overfill without cost, % of the judged area.
    limit: f64,
}

impl<'a> Contest<'a> {
    fn new(island: &'a Polygon, settings: &'a FillSettings<'a>) -> Self {
        let contours: Vec<Path> = contour::rings_only(island, settings).stages.into_iter().flatten().collect();
        let limit = judged(island, &contours, settings).overfill_percent() + MORE_OVERFILL;
        Self { island, settings, outermost: settings.outermost(island), most: contours.len(), limit }
    }

    /// The candidates for a pocket depth, mm, and a reach of corners.
    fn ideas(&self, pocket_depth: f64, tip_reach: f64) -> Vec<Idea<'a>> {
        let hybrid = HybridSettings { pocket_depth, tip_reach, ..self.settings.hybrid };
        let settings = FillSettings { hybrid, ..*self.settings };
        let levels = pockets::levels(self.outermost.clone(), &settings);
        let mut pieces = pockets::merge(&levels, &self.outermost, &settings).into_polygons();
        pieces.sort_by(|a, b| b.area().total_cmp(&a.area()));
        let counts: BTreeSet<usize> = SHARES.map(|share| (share * pieces.len() as f64).round() as usize).into();
        let regions = counts.into_iter().map(|count| Region::from_normalised(pieces[..count].to_vec()));
        regions.map(|regions| Idea { settings, levels: levels.clone(), regions }).collect()
    }

    fn entry(&self, idea: &Idea) -> Entry {
        let Idea { settings, levels, regions } = idea.clone();
        let mut steps = Steps::with(levels, regions, &self.outermost, &settings);
        steps.adapt(self.island, &settings);
        steps.link(&settings);
        steps.keep_longest(self.most, &settings);
        let figures = judged(self.island, steps.chains.iter().chain(&steps.skeleton), &settings);
        let cost = figures.void_percent() + EXCESS * (figures.overfill_percent() - self.limit).max(0.0);
        Entry { steps, cost }
    }
}

/// What the deposit model says about passes in an island.
fn judged<'a>(island: &Polygon, passes: impl IntoIterator<Item = &'a Path>, settings: &FillSettings) -> Figures {
    let bead = settings.bead;
    // Heights depend only on ratios of paces.
    let nominal = Nominal { bead, pace: 1.0, rise: bead.rise(settings.stepover) };
    let step = bead.width / POINTS_ACROSS;
    let limits = DepositSettings { step, ..DepositSettings::new(nominal, settings.machining_allowance) };
    let flat = |path: &Path| Pass {
        kind: path.kind,
        closed: path.closed,
        points: path.points.iter().map(|p| p.extend(0.0)).collect(),
        pace: path.width.clone().map(|width| settings.law.pace(&bead, width)),
        width: path.width.clone(),
        wait: 0.0,
    };
    let passes = passes.into_iter().map(flat).collect();
    let layer = Layer { islands: vec![island.clone()], passes, ..Layer::default() };
    Judge::new(limits).without_patches().layer(&layer).figures
}
