//! The deposit model: what a layer's passes would build, as a height field, and what is wrong with it.
//!
//! Our plans and other programs are judged alike: both become [`Stroke`]s, straight pieces of bead, whose heights
//! ([`stroke`]: the closed form) add up on a [grid](field::Grid). [`field`] does so at every point in double precision;
//! a [`Judge`] takes the same points in single precision, but skips those whose verdict is known in advance (`tiles`),
//! and layers that repeat an earlier one. Only a few layers are held in memory.
//!
//! Inside the outline, less a rim of a quarter of a bead width, a point is a *void* below [`VOID`] times the nominal
//! bead height, *low* from there to [`LOW`], and *overfilled* above [`OVERFILL`]. *Outside* is metal higher than
//! [`OUTSIDE`] times the nominal bead height beyond the outline and the machining allowance.

pub mod corner;
pub mod field;
pub mod figures;
mod lay;
pub mod patch;
pub mod picture;
mod repeat;
mod ridges;
pub mod stack;
pub mod stroke;
mod tiles;

pub use figures::Figures;
pub use patch::{Cause, Patch};
pub use picture::Picture;
pub use stack::Stack;
pub use stroke::{Nominal, Stroke};

use crate::layer::Layer;
use field::{Band, Grid, Height};
use glam::DVec2;
use patch::Run;
use picture::Canvas;
use planar::{Bounds, Join, PerRow, Region};
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// Below this fraction of the nominal bead height a point is a void.
pub const VOID: f64 = 0.35;
/// Below this fraction of the nominal bead height, but not a void, a point is low: beads a tangent overlap (0.738 w)
/// apart leave at least 0.77 of that height.
pub const LOW: f64 = 0.7;
/// Above this fraction of the nominal bead height a point is overfilled.
pub const OVERFILL: f64 = 1.3;
/// Metal outside counts above this fraction of the nominal bead height.
pub const OUTSIDE: f64 = 0.05;
/// The edge of a layer is rounded over this fraction of a bead width, so no voids are searched for there.
pub const RIM: f64 = 0.25;
/// Grid points across a bead by default.
pub const POINTS_ACROSS: f64 = 20.0;
/// A part whose layers have more points in total than this gets a coarser grid.
pub const MANY_POINTS: f64 = 5e8;
/// Most grid points of a layer.
pub const MOST_POINTS: f64 = 6.4e7;

/// How layers are judged.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DepositSettings {
    /// The nominal bead of the profile.
    pub nominal: Nominal,
    /// How far metal may lie outside the outline, mm.
    pub machining_allowance: f64,
    /// Distance between grid points, mm.
    pub step: f64,
    /// Whether layers can be stacked as given; around an axis each one is unrolled separately.
    pub over_one_another: bool,
}

impl DepositSettings {
    /// With the default grid of a twentieth of a bead.
    pub fn new(nominal: Nominal, machining_allowance: f64) -> Self {
        Self { nominal, machining_allowance, step: nominal.bead.width / POINTS_ACROSS, over_one_another: true }
    }

    /// Coarsens the grid for a part of `layers` layers: up to twofold if all layers together would have more than
    /// [`MANY_POINTS`], and as far as needed if one would have more than [`MOST_POINTS`].
    pub fn fitted_to(mut self, bounds: &Bounds, layers: usize) -> Self {
        let area = bounds.size().x * bounds.size().y;
        let many = (area * layers as f64 / MANY_POINTS).sqrt();
        self.step = self.step.max(many.min(2.0 * self.step)).max((area / MOST_POINTS).sqrt());
        self
    }
}

/// The verdict on a layer.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Judgement {
    /// Areas and heights.
    #[serde(with = "figures::whole")]
    pub figures: Figures,
    /// Connected voids, the largest first; empty for a judge without patches.
    pub voids: Vec<Patch>,
    /// Connected overfilled patches, the highest first; empty for a judge without patches.
    pub peaks: Vec<Patch>,
    /// The height field as a coarse picture.
    pub picture: Option<Picture>,
    /// Number of point evaluations, summed over the strokes.
    pub work: usize,
}

/// Judges layer after layer.
#[derive(Debug)]
pub struct Judge {
    settings: DepositSettings,
    stack: Option<Stack>,
    picture_pixels: Option<usize>,
    patches: bool,
    every_point: bool,
    known: repeat::Known,
    total: Figures,
}

impl Judge {
    /// A judge that keeps no stack, and no picture.
    pub fn new(settings: DepositSettings) -> Self {
        Self {
            settings,
            stack: None,
            picture_pixels: None,
            patches: true,
            every_point: false,
            known: repeat::Known::default(),
            total: Figures::default(),
        }
    }

    /// Computes every point of every layer in double precision, which takes many times as long: the reference for the
    /// faster methods.
    pub fn with_every_point(mut self) -> Self {
        self.every_point = true;
        self
    }

    /// Also stacks the layers, if they can be stacked, to see how the part grows; `bounds` contains all layers.
    pub fn with_stack(mut self, bounds: &Bounds) -> Self {
        self.stack = self.settings.over_one_another.then(|| Stack::new(bounds, self.settings));
        self
    }

    /// Also draws the layers, at most `pixels` wide or high.
    pub fn with_pictures(mut self, pixels: usize) -> Self {
        self.picture_pixels = Some(pixels);
        self
    }

    /// Does not join voids and overfilled points into patches; their areas are still in the figures.
    pub fn without_patches(mut self) -> Self {
        self.patches = false;
        self
    }

    /// The figures of all layers so far.
    pub fn total(&self) -> &Figures {
        &self.total
    }

    /// The stacked layers, if asked for.
    pub fn stack(&self) -> Option<&Stack> {
        self.stack.as_ref()
    }

    /// Its settings.
    pub fn settings(&self) -> &DepositSettings {
        &self.settings
    }

    /// Judges the next layer.
    ///
    /// ```
    /// use bead_plan::deposit::{DepositSettings, Judge, Nominal};
    /// use bead_plan::pass::{Along, Pass, PassKind};
    /// use bead_plan::{bead::Bead, layer::Layer};
    /// use glam::DVec3;
    ///
    /// let bead = Bead::parabola(6.0, 2.0);
    /// let settings = DepositSettings::new(Nominal { bead, pace: 8.0, rise: bead.rise(4.0) }, 0.0);
    /// let (points, width, pace) = (vec![DVec3::ZERO, DVec3::X * 50.0], Along::Same(6.0), Along::Same(8.0));
    /// let pass = Pass { kind: PassKind::Infill, closed: false, points, width, pace, wait: 0.0 };
    /// let judgement = Judge::new(settings).layer(&Layer { height: 2.0, passes: vec![pass], ..Layer::default() });
    /// assert!((judgement.figures.deposited_volume - 50.0 * bead.area()).abs() < 1e-9);
    /// ```
    pub fn layer(&mut self, layer: &Layer) -> Judgement {
        if let Some(stack) = &mut self.stack {
            stack.add(layer);
        }
        let repeats = !self.every_point;
        let near = repeat::NEAR * self.settings.step;
        let known = self.known.find(layer, near).filter(|_| repeats);
        let judgement = known.unwrap_or_else(|| self.look(layer));
        if repeats {
            self.known.keep(layer, &judgement);
        }
        self.total.add(&judgement.figures);
        judgement
    }

    fn look(&self, layer: &Layer) -> Judgement {
        let nominal = self.settings.nominal;
        let strokes: Vec<Stroke> = layer.passes.iter().flat_map(|pass| stroke::strokes(pass, &nominal)).collect();
        let Some(grid) = grid_of(layer, &strokes, self.settings.step) else { return Judgement::nothing() };
        let eye = Eye {
            mask: &Mask::new(layer, &self.settings, &grid),
            canvas: self.picture_pixels.map(|pixels| Canvas::new(&grid, pixels, &nominal)),
            patches: self.patches,
            nominal: &nominal,
            grid: &grid,
        };
        let seen = if self.every_point { eye.every_point(&strokes) } else { eye.quick(&strokes) };
        let mut figures = Figures::default();
        seen.iter().for_each(|s| figures.add(&s.figures));
        figures.deposited_volume = strokes.iter().map(Stroke::volume).sum();
        let work = seen.iter().map(|s| s.work).sum();
        let (voids, peaks) = if self.patches {
            let runs = patch::in_order(seen.iter().flat_map(|seen| &seen.runs), grid.rows);
            patch::patches(&runs, &grid, layer, &nominal)
        } else {
            Default::default()
        };
        let picture = eye.canvas.map(|canvas| canvas.picture(seen.into_iter().filter_map(|s| s.picture)));
        Judgement { figures, voids, peaks, picture, work }
    }
}

/// What is looked at in a layer, and how.
struct Eye<'a> {
    grid: &'a Grid,
    mask: &'a Mask,
    nominal: &'a Nominal,
    canvas: Option<Canvas>,
    /// Whether runs are joined into patches.
    patches: bool,
}

/// What is kept of a section of a layer.
#[derive(Default)]
struct Seen {
    figures: Figures,
    runs: Vec<Run>,
    picture: Option<picture::Strip>,
    work: usize,
}

/// With fewer grid points than this along a pixel, a picture shows single beads and needs every point.
const BEADS_SHOWN: usize = 4;

impl Eye<'_> {
    fn every_point(&self, strokes: &[Stroke]) -> Vec<Seen> {
        field::bands(strokes, self.grid, |band| {
            let mut seen = self.begin(band.first..band.first + band.heights.len() / self.grid.columns);
            self.take(&mut seen, &band);
            seen
        })
    }

    fn quick(&self, strokes: &[Stroke]) -> Vec<Seen> {
        let ridges = self.canvas.as_ref().is_none_or(|canvas| canvas.side() >= BEADS_SHOWN);
        let field = tiles::Field { grid: self.grid, mask: self.mask, nominal: self.nominal, ridges };
        field.look(
            strokes,
            |rows| self.begin(rows),
            |seen, part| match part {
                tiles::Part::Band(band) => self.take(seen, band),
                tiles::Part::Ridges(square, ridges) => {
                    let begun = self.next_runs(seen);
                    patch::find_between(ridges, square, self.grid, &mut seen.runs);
                    let runs = &seen.runs[begun..];
                    seen.figures.add(&Figures::of_ridges(square, ridges, runs, self.grid));
                    if let (Some(canvas), Some(strip)) = (&self.canvas, &mut seen.picture) {
                        canvas.paint_ridges(strip, square, ridges, runs);
                    }
                }
            },
        )
    }

    fn begin(&self, rows: Range<usize>) -> Seen {
        Seen { picture: self.canvas.as_ref().map(|canvas| canvas.strip(rows)), ..Seen::default() }
    }

    /// Index of the first run of the next section.
    fn next_runs(&self, seen: &mut Seen) -> usize {
        if !self.patches {
            seen.runs.clear();
        }
        seen.runs.len()
    }

    fn take<H: Height>(&self, seen: &mut Seen, band: &Band<'_, H>) {
        seen.figures.add(&Figures::of(band, self.mask, self.nominal));
        let begun = self.next_runs(seen);
        patch::find(band, self.mask, self.nominal, &mut seen.runs);
        if let (Some(canvas), Some(strip)) = (&self.canvas, &mut seen.picture) {
            canvas.paint(strip, band, &seen.runs[begun..]);
        }
        seen.work += band.work;
    }
}

impl Judgement {
    fn nothing() -> Self {
        Self { figures: Figures::default(), voids: Vec::new(), peaks: Vec::new(), picture: None, work: 0 }
    }
}

fn grid_of(layer: &Layer, strokes: &[Stroke], step: f64) -> Option<Grid> {
    let outlines = layer.islands.iter().flat_map(|i| i.outer.points().iter().copied());
    let bounds = Bounds::of(outlines.chain(strokes.iter().flat_map(|s| [s.from, s.to])))?;
    let widest = strokes.iter().map(|s| s.bead.width).fold(0.0, f64::max);
    Some(Grid::covering(&bounds, widest / 2.0 + step, step))
}

/// The outline less its rim, and the area where metal is allowed, as column ranges row by row.
pub struct Mask {
    core: PerRow<Range<usize>>,
    allowed: PerRow<Range<usize>>,
}

impl Mask {
    /// The mask of a layer on a grid: its islands, and the areas beyond them that do not count as outside.
    pub fn new(layer: &Layer, settings: &DepositSettings, grid: &Grid) -> Self {
        let whole = Region::from_normalised(layer.islands.clone());
        let rows = |region: &Region| {
            let crossings = region.rows(grid.place(0, 0).y, grid.step, grid.rows);
            crossings.iter().map(|crossings| columns(crossings, grid)).collect()
        };
        let core = rows(&whole.offset(-RIM * settings.nominal.bead.width, Join::ROUND));
        let allowance = settings.machining_allowance;
        let whole = match &layer.beyond[..] {
            [] => whole,
            beyond => whole.union(&Region::from_normalised(beyond.to_vec())),
        };
        let allowed = if allowance > 0.0 { rows(&whole.offset(allowance, Join::ROUND)) } else { rows(&whole) };
        Self { core, allowed }
    }

    /// The columns of a row inside the outline less its rim, from left to right.
    pub fn core(&self, row: usize) -> &[Range<usize>] {
        self.core.row(row)
    }

    /// The columns of a row where metal may be, from left to right.
    fn allowed(&self, row: usize) -> &[Range<usize>] {
        self.allowed.row(row)
    }
}

fn columns<'a>(crossings: &'a [f64], grid: &'a Grid) -> impl Iterator<Item = Range<usize>> + 'a {
    let mut end = 0;
    let columns = crossings.chunks_exact(2).map(move |pair| {
        let columns = grid.columns_between(pair[0], pair[1]);
        // Where two outlines touch at a grid point, the point counts once.
        let start = columns.start.max(end);
        end = columns.end.max(end);
        start..columns.end
    });
    columns.filter(|columns| !columns.is_empty())
}

/// Height at one point, mm: the sum over all pieces.
pub fn height_at(strokes: &[Stroke], p: DVec2) -> f64 {
    strokes.iter().map(|s| s.height_at(p)).sum()
}
