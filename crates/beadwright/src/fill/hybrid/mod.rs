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
//! | widths that follow the room (ours) | [`adapt`] | |
//!
//! The default goes beyond the paper ([`HybridSettings::literal`] follows it to the letter): corners whose pocket is
//! not kept stay sharp; the outermost contour is cut only in walls as thin as one bead; the fill keeps exactly d2 from
//! the remaining contours, since it fills what lies outside their neighbourhood; narrow regions get a few beads along
//! their medial axis instead of short strokes across; the ends of cut contours reach into the fill.

pub mod adapt;
pub mod chain;
pub mod contours;
pub mod line_index;
pub mod medial;
pub mod pockets;
pub mod skeleton;

use super::thin;
use super::{Fill, FillSettings, Path, Strategy};
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
    /// How far sharp corners of contours are drawn out into the void before them, 0 to 1.
    pub tip_reach: f64,
    /// The narrowest and the widest bead of the process.
    pub width_limits: (f64, f64),
}

impl HybridSettings {
    /// Round joins as accurate as pockets need them: chords within half the tolerance.
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
#[derive(Debug, Clone, PartialEq)]
pub struct Steps {
    /// The contours from outside in, with their pockets.
    pub levels: Vec<Level>,
    /// The kept pockets merged.
    pub regions: Region,
    /// The contours, complete and cut.
    pub contours: Contours,
    /// The contours joined to passes.
    pub chains: Vec<Path>,
    /// The fill of the skeleton regions.
    pub skeleton: Vec<Path>,
}

impl Steps {
    /// Runs all steps.
    pub fn of(island: &Polygon, settings: &FillSettings) -> Self {
        let outermost = settings.outermost(island);
        let levels = pockets::levels(outermost.clone(), settings);
        let regions = pockets::merge(&levels, &outermost, settings);
        let contours = contours::cut(&levels, &regions, settings);
        let chains = chain::join(&contours, &outermost, settings);
        let skeleton = skeleton::fill(&outermost, &regions, &chains, settings);
        let (chains, skeleton) =
            if settings.hybrid.literal { (chains, skeleton) } else { adapted(chains, skeleton, island, settings) };
        Self { levels, regions, contours, chains, skeleton }
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

/// Both kinds of passes with widths that follow the room.
fn adapted(
    mut chains: Vec<Path>,
    skeleton: Vec<Path>,
    island: &Polygon,
    settings: &FillSettings,
) -> (Vec<Path>, Vec<Path>) {
    let count = chains.len();
    chains.extend(skeleton);
    adapt::widths(&mut chains, island, settings);
    let skeleton = chains.split_off(count);
    (chains, skeleton)
}
