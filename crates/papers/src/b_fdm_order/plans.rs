//! The ways of planning two layers that are compared, and their figures.

use beadwright::order::Method;

/// The order of the loops.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Loops {
    /// As in the file, each from its first vertex. The files are shuffled, so this is a weak baseline.
    File,
    /// Columns of the part walked up and down (boustrophedon), each loop from its first vertex.
    Columns,
    /// Order and start points by a method.
    By(Method),
}

/// The angle of the scan lines of the first layer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Raster {
    /// 0°, the second layer 90°.
    Zero,
    /// 0° on both layers.
    Alike,
    /// The least turns on the first layer (the paper, eq 9), the second turned by 90°.
    FewestTurns,
    /// This angle, radians, the second layer turned by 90°.
    At(f64),
    /// What `raster_turn = "best"` chooses for both layers, the second turned by 90°.
    Best,
}

/// How scan lines become paths.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Lines {
    /// One after another across the whole section, over all holes in their way: the paper's "traditional parallel scanning".
    Whole,
    /// Each sub-region by itself, in scan order (3.2, its first step).
    SubRegions,
    /// Sub-regions merged (3.2).
    Merged,
}

/// How two layers are planned.
#[derive(Debug, Clone, Copy)]
pub struct Plan {
    /// What it adds to the one before.
    pub name: &'static str,
    /// How contours are ordered.
    pub loops: Loops,
    /// The angle of the scan lines.
    pub raster: Raster,
    /// How scan lines become paths.
    pub lines: Lines,
    /// How the paths are ordered; `None` for scan order.
    pub fill: Option<Method>,
}

/// The paper's "traditional parallel scanning".
pub const WHOLE: Plan = Plan {
    name: "whole lines over holes, file order, 0°/90°",
    loops: Loops::File,
    raster: Raster::Zero,
    lines: Lines::Whole,
    fill: None,
};

/// Sub-regions one by one, so that the first step of the paper's own method is already done.
pub const PLAIN: Plan = Plan { name: "plain: file order, sub-regions, 0°/90°", lines: Lines::SubRegions, ..WHOLE };

/// The plain plan with its loops in columns.
pub const COLUMNS: Plan = Plan { name: "plain, loops in columns (boustrophedon)", loops: Loops::Columns, ..PLAIN };

/// The plans compared; each adds a step to the one before.
pub(super) const STEPS: [Plan; 5] = [
    PLAIN,
    Plan { name: "+ contour order and start points", loops: Loops::By(Method::LocalSearch), ..PLAIN },
    Plan { name: "+ raster angle", raster: Raster::Best, lines: Lines::SubRegions, fill: None, ..OURS },
    Plan { name: "+ sub-regions merged", lines: Lines::Merged, fill: None, ..OURS },
    OURS,
];

/// All steps together, as `plan` takes them.
pub const OURS: Plan = Plan {
    name: "+ their order",
    loops: Loops::By(Method::LocalSearch),
    raster: Raster::Best,
    lines: Lines::Merged,
    fill: Some(Method::LocalSearch),
};

/// The paper to the letter: ant colony on top of the improved nearest neighbour, then always the nearest region next.
pub const LITERAL: Plan = Plan {
    name: "the paper's methods",
    loops: Loops::By(Method::AntColony),
    raster: Raster::FewestTurns,
    lines: Lines::Merged,
    fill: Some(Method::Nearest),
};

/// All steps but the raster angle.
pub const FIXED: Plan = Plan { name: "all steps, fixed 0°/90°", raster: Raster::Zero, ..OURS };

/// All steps but the alternation of directions: shows what crossing the lines of two layers costs.
pub const ALIKE: Plan = Plan { name: "all steps, 0° on both layers", raster: Raster::Alike, ..OURS };

/// The methods for start points and order of the contours.
pub(super) const CONTOURS: [(&str, Loops); 6] = [
    ("file order (shuffled: a weak baseline)", Loops::File),
    ("columns walked up and down", Loops::Columns),
    ("improved nearest neighbour (2.1)", Loops::By(Method::ImprovedNearest)),
    ("ant colony over its start points (2.2): the paper's literal", Loops::By(Method::AntColony)),
    ("local search (ours)", Loops::By(Method::LocalSearch)),
    ("exact, at up to 48 vertices a loop (ours may begin between)", Loops::By(Method::Exact)),
];

/// The figures of a plan of two layers.
#[derive(Debug, Clone, Copy)]
pub struct Outcome {
    /// The closed tour through the start points of one layer's contours, mm.
    pub contour_travel: f64,
    /// Travels of the fill, mm per layer.
    pub fill_travel: f64,
    /// Time, s per layer.
    pub seconds: f64,
    /// Paths of the fill, per layer.
    pub paths: f64,
    /// Turns, per layer.
    pub turns: f64,
    /// Area laid twice at the turns, which equals the area missed there (eqs 10 and 11), mm² per layer.
    pub corner_area: f64,
}

/// What is saved between two outcomes.
#[derive(Debug, Clone, Copy)]
pub struct Saved {
    /// Contour travel, %.
    pub travel: f64,
    /// Layer time, %.
    pub time: f64,
}

impl Outcome {
    /// What this one saves compared with another.
    pub fn saved(&self, of: &Self) -> Saved {
        let percent = |before: f64, after: f64| 100.0 * (1.0 - after / before);
        Saved { travel: percent(of.contour_travel, self.contour_travel), time: percent(of.seconds, self.seconds) }
    }
}
