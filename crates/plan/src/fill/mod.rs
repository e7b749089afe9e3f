//! Filling: one island becomes passes, the centre-lines along which metal is laid.
//!
//! A strategy is one file and one line in [`StrategyName`](enum@StrategyName), which says what each of them lays. It returns
//! *stages*: passes of one stage may be laid in any order, stages one after another.

pub mod angle;
pub mod around;
pub mod compound;
pub mod contour;
pub mod coverage;
pub mod dot;
pub mod fermat;
pub mod hilbert;
pub mod hybrid;
pub mod line_index;
pub mod mat;
mod name;
pub mod one_loop;
pub mod partition;
pub mod raster;
mod ring_tree;
pub mod sound;
pub mod spiral;
pub mod thin;
pub mod trails;
pub mod wall;
pub mod zigzag;

pub use name::{StrategyName, UnknownStrategy};

use crate::bead::{Bead, Law};
use crate::pass::{Along, PassKind};
use glam::DVec2;
use planar::scan::Spacing;
use planar::{Join, Polygon, Region, Ring};
use serde::{Deserialize, Serialize};

/// A way to fill an island.
pub trait Strategy: Sync {
    /// The name people type.
    fn name(&self) -> &'static str;

    /// Lays passes into one island.
    fn fill(&self, island: &Polygon, settings: &FillSettings) -> Fill;

    /// Lays passes into an island that is the same on several layers, [`Self::period`] apart; their settings differ
    /// only in the layer.
    fn fill_layers(&self, island: &Polygon, layers: &[FillSettings]) -> Vec<Fill> {
        layers.iter().map(|settings| self.fill(island, settings)).collect()
    }

    /// Number of layers of the same shape after which most of the work repeats; `None` if every layer is different.
    fn period(&self) -> Option<usize> {
        None
    }

    /// Settings for a simpler fill, the better first, for islands that the strategy cannot fill with the given ones.
    fn simpler<'a>(&self, _settings: &FillSettings<'a>) -> Vec<FillSettings<'a>> {
        Vec::new()
    }

    /// The region of an island that is filled with scan lines; empty where none are laid.
    fn infill(&self, _island: &Polygon, _settings: &FillSettings) -> Region {
        Region::default()
    }

    /// The scan lines through such a region.
    fn lines(&self, _infill: &Region, _settings: &FillSettings) -> Fill {
        Fill::default()
    }

    /// The narrowest bead, mm.
    fn narrowest(&self, settings: &FillSettings) -> f64 {
        settings.wall.width_limits.0
    }

    /// Whether layers of the same shape and raster angle get the same passes, whatever their number.
    fn repeats(&self) -> bool {
        false
    }

    /// Whether all walls are welded, however thin, with beads that then reach beyond them.
    fn welds_thin_walls(&self) -> bool {
        false
    }
}

/// One path with the arc on, in the plane of its layer.
#[derive(Debug, Clone, PartialEq)]
pub struct Path {
    /// What it is for.
    pub kind: PassKind,
    /// Whether it ends where it began; the first point is then not repeated.
    pub closed: bool,
    /// Centre-line, mm.
    pub points: Vec<DVec2>,
    /// Bead width, mm.
    pub width: Along,
    /// Whether it may be laid from its end to its start.
    pub reversible: bool,
}

impl Path {
    /// A closed pass along a ring, with a bead of the given width, mm.
    pub fn contour(ring: Ring, width: f64) -> Self {
        let (kind, width) = (PassKind::Contour, Along::Same(width));
        Self { kind, closed: true, points: ring.into_points(), width, reversible: true }
    }

    fn line(kind: PassKind, points: Vec<DVec2>, width: f64) -> Self {
        Self { kind, closed: false, points, width: Along::Same(width), reversible: true }
    }

    /// The points in order, the first one again at the end of a closed pass.
    pub fn path(&self) -> Vec<DVec2> {
        let again = self.closed.then(|| self.points.first()).flatten();
        self.points.iter().chain(again).copied().collect()
    }

    /// Length of the centre-line, mm.
    pub fn length(&self) -> f64 {
        planar::polyline::length(&self.path())
    }
}

/// The passes of one island.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Fill {
    /// Groups of passes to be laid one group after another.
    pub stages: Vec<Vec<Path>>,
    /// Whether the passes of a stage must be laid in the given order.
    pub fixed_order: bool,
}

impl Fill {
    /// Whether nothing is laid.
    pub fn is_empty(&self) -> bool {
        self.stages.iter().all(Vec::is_empty)
    }

    /// Adds the passes of a neighbour, its outermost contours to the outermost ones here.
    fn add(&mut self, other: Self, order: ContourOrder) {
        let (mut own, mut stages) = (std::mem::take(&mut self.stages), other.stages);
        let count = own.len().max(stages.len());
        for list in [&mut own, &mut stages] {
            let missing = vec![Vec::new(); count - list.len()];
            let at = if order == ContourOrder::InsideOut { 0 } else { list.len() };
            list.splice(at..at, missing);
        }
        own.iter_mut().zip(stages).for_each(|(stage, passes)| stage.extend(passes));
        *self = Self { stages: own, fixed_order: self.fixed_order || other.fixed_order };
    }
}

/// Order of contours.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum ContourOrder {
    /// The outermost contour first.
    OutsideIn,
    /// The outermost contour last.
    InsideOut,
}

/// How scan lines are spread.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum RasterSpacing {
    /// Evenly from edge to edge, at most one stepover apart.
    Even,
    /// Exactly one stepover apart (Liu et al. 2022, eq 11).
    Exact,
    /// One line along each long edge that is parallel to the lines, the rest evenly between, so that no strip is left
    /// next to an edge; `raster` treats this as `even`.
    Fitted,
}

/// How scan lines end where they are not linked.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum LineEnds {
    /// Straight, at the boundary (Liu et al. 2022).
    #[default]
    Plain,
    /// With a hook along the boundary where it leaves the lines at a slant, so that no wedge stays bare there.
    Hooked,
}

/// What a strategy needs to know; lengths in mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FillSettings<'a> {
    /// Index of the layer, from 0: seams move from layer to layer.
    pub layer: usize,
    /// The nominal bead.
    pub bead: Bead,
    /// How a bead's height follows its width.
    pub law: &'a Law,
    /// Distance between neighbouring centre-lines, mm.
    pub stepover: f64,
    /// Distance from the innermost perimeter to the infill, mm.
    pub contour_gap: f64,
    /// Perimeters around the infill of `compound`.
    pub perimeters: u32,
    /// Order of contours.
    pub contour_order: ContourOrder,
    /// Whether the perimeters of `compound` are laid before its infill.
    pub perimeters_first: bool,
    /// Density of the infill of `compound` where it may be sparse: the fraction that is filled, 0 to 1.
    pub infill_density: f64,
    /// The area where a sparse infill is nevertheless solid: near tops and bottoms. `None` if all of it is solid.
    pub solid: Option<&'a Region>,
    /// How far beads may reach outside the island, mm.
    pub machining_allowance: f64,
    /// Angle of the scan lines, radians from x.
    pub raster_angle: f64,
    /// How scan lines are spread.
    pub raster_spacing: RasterSpacing,
    /// How scan lines end where they are not linked.
    pub line_ends: LineEnds,
    /// Passes shorter than this are left out, mm: they would end before the arc is steady.
    pub min_pass_length: f64,
    /// Thresholds of the hybrid.
    pub hybrid: hybrid::HybridSettings,
    /// How walls are laid.
    pub wall: wall::WallSettings,
    /// How loops are laid.
    pub one_loop: one_loop::LoopOptions,
    /// The turns of a helix, if islands that go all the way around an axis are filled with one.
    pub turn: Option<around::Turn>,
    /// A reference point, mm, the same on all layers of a part; patterns that repeat over the layers are measured from
    /// it.
    pub datum: DVec2,
}

impl FillSettings<'_> {
    /// The outermost centre-line: half a bead inside the island, less the machining allowance.
    pub fn outermost(&self, island: &Polygon) -> Region {
        island.offset(self.machining_allowance - self.bead.width / 2.0, Join::ROUND)
    }

    /// From this thickness on a wall has space for two of the narrowest beads side by side, mm.
    pub fn double(&self) -> f64 {
        self.one_loop.width_limits.0 * (1.0 + self.stepover / self.bead.width)
    }

    fn spacing(&self) -> Spacing {
        match self.raster_spacing {
            RasterSpacing::Even | RasterSpacing::Fitted => Spacing::AtMost(self.stepover),
            RasterSpacing::Exact => Spacing::Exact(self.stepover),
        }
    }

    fn ordered(&self, mut outside_in: Vec<Vec<Path>>) -> Vec<Vec<Path>> {
        if self.contour_order == ContourOrder::InsideOut {
            outside_in.reverse();
        }
        outside_in
    }
}
