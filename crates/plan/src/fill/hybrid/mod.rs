//! The contour-skeleton hybrid (Zhao et al. 2023, paper A): contours keep the shape; the pockets that they would leave
//! are found, merged into skeleton regions and filled in their own way; the contours are cut there and joined into few
//! passes.
//!
//! | step | file | section of the paper |
//! | --- | --- | --- |
//! | levels and their pockets, which of them are kept | [`pockets`] | 1.1.1, 1.1.2 |
//! | skeleton regions: the kept pockets merged | [`pockets::merge`] | 1.1.3 |
//! | contours cut at the regions | [`contours`] | 1.3 (1)–(2) |
//! | contours joined into chains | [`chain`] | 1.3 (3)–(4) |
//! | regions filled | [`skeleton`] | 1.2 |
//! | widths adapted to the available space (ours) | [`adapt`] | |
//! | choosing what suits a shape best (ours) | `choose` | |
//!
//! Joins are round in both modes. In the paper square corners survive moving in and back out, as with mitred joins; with
//! round ones their pocket is 0.44 w long and its filter drops it. Mitred joins of any limit break its propeller into 16 to
//! 24 passes per layer instead of 12.
//!
//! The default goes beyond the paper ([`HybridSettings::literal`] follows it to the letter): corners whose pocket is
//! not kept stay sharp; the outermost contour is cut only in walls as thin as one bead; the fill keeps exactly d2 from
//! the remaining contours, since it fills what lies outside their neighbourhood; narrow regions get a few beads along
//! their medial axis instead of short strokes across; the ends of cut contours reach into the fill, and beads are linked to
//! contours that end near them. The deposit model chooses what is filled, and how. It never needs more passes than contours
//! alone: the smallest regions are left to the contours.

pub mod adapt;
pub mod chain;
mod choose;
pub mod contours;
pub mod medial;
pub mod pockets;
pub mod skeleton;

use super::thin;
use super::{Fill, FillSettings, PassKind, Path, Strategy};
use contours::Contours;
use planar::{Join, Polygon, Region};
use pockets::Level;
use serde::{Deserialize, Serialize};

/// Contours with filled pockets.
pub struct Hybrid;

/// Which way the scan lines of a skeleton region run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum ScanAlong {
    /// Parallel to the short side of the region's smallest rectangle, as in the paper.
    Short,
    /// Parallel to the long side.
    Long,
    /// Whichever gives fewer arc starts; if equal, fewer turns.
    Auto,
}

/// What is laid first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum HybridOrder {
    /// The fill of skeleton regions (abstract of the paper).
    SkeletonFirst,
    /// The contours (section 1.3 (5) of the paper).
    ContoursFirst,
}

/// Thresholds of the hybrid; lengths in mm, areas in mm².
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HybridSettings {
    /// Follow the paper to the letter.
    pub literal: bool,
    /// How far a contour is moved in to find its pockets: places narrower than twice this are pockets.
    pub pocket_depth: f64,
    /// Whether other depths are tried as well.
    pub tries_depths: bool,
    /// How much larger the backtracked contour is made, so that numerical slivers do not count as pockets.
    pub tolerance: f64,
    /// Pockets smaller than this are not kept.
    pub min_pocket_area: f64,
    /// Corner pockets shorter than this are not kept.
    pub min_pocket_length: f64,
    /// Distance between skeleton fill and contours, d2.
    pub skeleton_gap: f64,
    /// The least distance between contours and beads along a medial axis: nothing is laid closer.
    pub least_gap: f64,
    /// Skeleton regions narrower than this are filled along their medial axis.
    pub region_width: f64,
    /// Which way scan lines run.
    pub scan_along: ScanAlong,
    /// What is laid first.
    pub order: HybridOrder,
    /// How far free ends of cut contours reach into the fill.
    pub end_overlap: f64,
    /// How far sharp corners of contours are extended into the void in front of them, 0 to 1.
    pub tip_reach: f64,
    /// Whether other reaches are tried as well.
    pub tries_reaches: bool,
    /// The narrowest and the widest bead of the process.
    pub width_limits: (f64, f64),
}

impl HybridSettings {
    /// Round joins accurate enough for pockets: chords within half the tolerance.
    fn join(&self) -> Join {
        Join::Round(self.tolerance / 2.0)
    }
}

impl Strategy for Hybrid {
    fn name(&self) -> &'static str {
        "hybrid"
    }

    fn fill(&self, island: &Polygon, settings: &FillSettings) -> Fill {
        let thick = |part: &Polygon, settings: &FillSettings| Steps::of(part, settings).fill(settings);
        if settings.hybrid.literal { thick(island, settings) } else { thin::around(island, settings, thick) }
    }

    fn narrowest(&self, settings: &FillSettings) -> f64 {
        if settings.hybrid.literal { settings.bead.width } else { settings.wall.width_limits.0 }
    }
}

/// The results of all steps for one island, to be tested and drawn.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Steps {
    /// The contours from outside in, with their pockets.
    pub levels: Vec<Level>,
    /// The kept pockets merged.
    pub regions: Region,
    /// The contours, complete and cut.
    pub contours: Contours,
    /// The contours joined into passes.
    pub chains: Vec<Path>,
    /// The fill of the skeleton regions.
    pub skeleton: Vec<Path>,
}

impl Steps {
    /// Runs all steps. By default the deposit model chooses the regions, and what the settings leave open; there are never
    /// more passes than contours alone would have.
    pub fn of(island: &Polygon, settings: &FillSettings) -> Self {
        if !settings.hybrid.literal {
            return choose::best(island, settings);
        }
        let outermost = settings.outermost(island);
        let levels = pockets::levels(outermost.clone(), settings);
        let regions = pockets::merge(&levels, &outermost, settings);
        Self::with(levels, regions, &outermost, settings)
    }

    /// Adapts the widths of all passes to the available space.
    fn adapt(&mut self, island: &Polygon, settings: &FillSettings) {
        let count = self.chains.len();
        self.chains.append(&mut self.skeleton);
        adapt::widths(&mut self.chains, island, settings);
        self.skeleton = self.chains.split_off(count);
    }

    /// Links beads of the skeleton to contours that end near them.
    fn link(&mut self, settings: &FillSettings) {
        let passes = self.chains.drain(..).chain(self.skeleton.drain(..)).collect();
        (self.chains, self.skeleton) =
            medial::linked(passes, settings).into_iter().partition(|pass| pass.kind == PassKind::Contour);
    }

    /// The steps after the regions are known.
    fn with(levels: Vec<Level>, regions: Region, outermost: &Region, settings: &FillSettings) -> Self {
        let contours = contours::cut(&levels, &regions, settings);
        let chains = chain::join(&contours, outermost, settings);
        let skeleton = skeleton::fill(outermost, &regions, &chains, settings);
        Self { levels, regions, contours, chains, skeleton }
    }

    /// Drops passes that end before the arc is steady, then the shortest ones until at most `most` remain, those of the
    /// skeleton first.
    fn keep_longest(&mut self, most: usize, settings: &FillSettings) {
        let keep = |passes: &mut Vec<Path>, most: usize| {
            passes.retain(|pass| nominal_length(pass, settings) >= settings.min_pass_length);
            passes.sort_by(|a, b| b.length().total_cmp(&a.length()));
            passes.truncate(most);
        };
        keep(&mut self.chains, most);
        keep(&mut self.skeleton, most - self.chains.len());
    }

    /// The passes in the order of the settings.
    pub fn fill(self, settings: &FillSettings) -> Fill {
        let stages = match settings.hybrid.order {
            HybridOrder::SkeletonFirst => vec![self.skeleton, self.chains],
            HybridOrder::ContoursFirst => vec![self.chains, self.skeleton],
        };
        Fill { stages, fixed_order: false }
    }
}

/// Length of the nominal bead that takes as long as a pass, mm: a narrower bead is laid faster.
fn nominal_length(pass: &Path, settings: &FillSettings) -> f64 {
    let line = pass.path();
    let pieces = line.windows(2).enumerate();
    pieces.map(|(i, ends)| ends[0].distance(ends[1]) / settings.law.pace(&settings.bead, pass.width.after(i))).sum()
}
