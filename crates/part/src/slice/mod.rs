//! A mesh cut into layers of equal thickness.
//!
//! Layer k spans the heights k·h … (k+1)·h and is cut at its middle. Every vertex knows its level, the number of planes
//! at or below it; a triangle is crossed by the planes between its lowest and its highest level, so the cost grows with
//! triangles plus segments. On each plane the contour walks from triangle to triangle across shared edges (Zhao et al.
//! 2023, section 1: slicing by triangle adjacency), and no point is ever searched for. A vertex exactly on a plane
//! counts as above it, for all its triangles alike.
//!
//! | file | what it does |
//! | --- | --- |
//! | `trace` | walks the contours of one plane |
//! | `close` | joins what is left open in a broken mesh |

mod close;
mod trace;

use crate::chart::{Chart, seam};
use crate::model::Mesh;
use crate::model::wall_curves::Section;
use crate::task::{Cancelled, Stage, Task};
use crate::warning::{SLIVER_MM, Warning, WarningKind};
use glam::DVec2;
use planar::{FillRule, Polygon, Region, Ring};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::ops::Range;
use std::sync::Mutex;
use trace::{Cut, Scratch, Trace};

/// Layers cut in one batch, so that memory stays proportional to the mesh.
pub const BATCH: usize = 32;

/// How to cut.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SliceOptions {
    /// Thickness of a layer, mm.
    pub layer_height: f64,
    /// Widest gap in an open contour that is bridged, mm.
    pub close_gap: f64,
    /// Contour vertices within this distance of the simplified line are dropped, mm.
    pub simplify: f64,
}

/// One cut, ready to be filled.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Slice {
    /// Index from 0.
    pub index: usize,
    /// Top of the layer, mm.
    pub z: f64,
    /// Thickness, mm.
    pub height: f64,
    /// Whether it is one of two layers with the same underside, and which.
    pub half: Option<Half>,
    /// Connected areas with their holes.
    pub islands: Vec<Polygon>,
    /// What was closed, dropped or united here.
    pub warnings: Vec<Warning>,
}

impl Slice {
    /// Area of the slice, mm².
    pub fn area(&self) -> f64 {
        self.islands.iter().map(Polygon::area).sum()
    }
}

/// Two layers share an underside where a layer varies in thickness: the lower one covers what is too thick for one
/// bead.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Half {
    /// The lower one, half as thick.
    Lower,
    /// The upper one, half of which is filled where the lower one lies.
    Upper,
}

/// Height of a layer's middle, mm; for two layers with the same underside, the middle of the pair.
pub fn middle(z: f64, height: f64, half: Option<Half>) -> f64 {
    match half {
        Some(Half::Lower) => z,
        Some(Half::Upper) | None => z - height / 2.0,
    }
}

impl Half {
    /// The word in plan.json.
    pub fn name(self) -> &'static str {
        match self {
            Self::Lower => "lower",
            Self::Upper => "upper",
        }
    }
}

/// Height range of a layer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slab {
    /// Top of the layer, mm.
    pub z: f64,
    /// Thickness, mm; the layer is cut at its middle.
    pub height: f64,
}

/// The lines in which a layer cuts an open surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Lines {
    /// Index from 0.
    pub index: usize,
    /// Where the layer lies.
    pub slab: Slab,
    /// The lines.
    pub sections: Vec<Section>,
    /// Gaps that were bridged.
    pub warnings: Vec<Warning>,
}

/// What an open surface represents.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Surface {
    /// The skin of a solid: the inside of its contours is filled, and contours that do not close are left out.
    Solid,
    /// A wall: one bead is laid along it.
    Wall,
}

/// How layers are fitted to the height of a part.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum LayerFit {
    /// Layers of the given thickness; their number comes nearest to the height.
    #[default]
    Fixed,
    /// Layers of the given thickness, plus one if the part would end above the last.
    Last,
    /// The same number of layers, made equal so that they end with the part.
    Even,
}

/// Layers of about one height (mm) for a mesh that stands on z = 0, fitted to its height.
///
/// ```
/// use bead_part::example;
/// use bead_part::slice::{LayerFit, fitted_slabs};
///
/// // 72 mm in layers of about 5 mm: too low by 2 mm, too high by 3 mm, or layers a little thicker.
/// let wall = example::find("wall").ok_or("no such example")?.mesh();
/// let tops = [LayerFit::Fixed, LayerFit::Last, LayerFit::Even]
///     .map(|fit| fitted_slabs(&wall, 5.0, fit).last().map_or(0.0, |slab| slab.z));
/// assert_eq!(tops[..2], [70.0, 75.0]);
/// assert!((tops[2] - 72.0).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn fitted_slabs(mesh: &Mesh, height: f64, fit: LayerFit) -> Vec<Slab> {
    let top = mesh.bounds().1.z.max(0.0);
    let slabs = |count: usize, height: f64| (0..count).map(|k| Slab { z: (k + 1) as f64 * height, height }).collect();
    // No layer is more than a quarter thicker than it should be.
    let nearest = (top / height - 0.5).max(top / (THICKEST * height)).ceil().max(1.0);
    match fit {
        LayerFit::Fixed => even_slabs(mesh, height),
        LayerFit::Last => slabs((top / height - ROUNDING).ceil().max(1.0) as usize, height),
        LayerFit::Even if top > 0.0 => slabs(nearest as usize, top / nearest),
        LayerFit::Even => even_slabs(mesh, height),
    }
}

/// Most by which equal layers may exceed the given thickness, as a factor.
const THICKEST: f64 = 1.25;

/// A last layer thinner than this fraction of a layer is a rounding error.
pub(crate) const ROUNDING: f64 = 1e-3;

/// Layers of one height (mm) for a mesh that stands on z = 0. A last layer that would be less than half full is left
/// out: its middle lies above the part.
pub fn even_slabs(mesh: &Mesh, height: f64) -> Vec<Slab> {
    let top = mesh.bounds().1.z.max(0.0);
    let count = (top / height - 0.5).ceil().max(1.0) as usize;
    (0..count).map(|k| Slab { z: (k + 1) as f64 * height, height }).collect()
}

/// A mesh prepared for cutting; layers can be cut in any order.
///
/// ```
/// use bead_part::slice::{SliceOptions, Slicer};
/// use bead_part::{example, task::Task};
///
/// // A wall of 120 × 4.5 × 72 mm in layers of 2 mm.
/// let (wall, task) = (example::find("wall").ok_or("no such example")?.mesh(), Task::new());
/// let options = SliceOptions { layer_height: 2.0, close_gap: 0.1, simplify: 0.01 };
/// let slices = Slicer::new(&wall, options, &task)?.all(&task)?;
/// assert_eq!(slices.len(), 36);
/// assert!(slices.iter().all(|slice| (slice.area() - 120.0 * 4.5).abs() < 1e-3));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Slicer<'a> {
    mesh: &'a Mesh,
    /// The chart in whose coordinates the mesh is given, if its layers are not planes.
    chart: Option<&'a Chart>,
    /// If the next layer has the same underside, only the area where that layer is thicker than this is kept, mm.
    thickest: f64,
    options: SliceOptions,
    slabs: Vec<Slab>,
    /// Height of each plane, mm.
    planes: Vec<f64>,
    /// Level of each vertex. Small integers, so that sorting and walking seldom touch the coordinates.
    levels: Vec<u32>,
    /// For each batch, where its triangles begin in `items`.
    starts: Vec<usize>,
    items: Vec<u32>,
    scratch: Mutex<Vec<Scratch>>,
}

impl<'a> Slicer<'a> {
    /// Sorts the triangles of a mesh that stands on z = 0 into batches of layers.
    ///
    /// # Errors
    /// [`Cancelled`] if the task was cancelled.
    pub fn new(mesh: &'a Mesh, options: SliceOptions, task: &Task) -> Result<Self, Cancelled> {
        let slabs = even_slabs(mesh, options.layer_height);
        Self::of_slabs(mesh, slabs, options, task)
    }

    /// Sorts the triangles into layers of any thickness, the lowest first; `options.layer_height` is the usual
    /// thickness.
    ///
    /// # Errors
    /// [`Cancelled`] if the task was cancelled.
    pub fn of_slabs(mesh: &'a Mesh, slabs: Vec<Slab>, options: SliceOptions, task: &Task) -> Result<Self, Cancelled> {
        task.step(Stage::Slice, 0.0)?;
        let (h, count) = (options.layer_height, slabs.len());
        let top = mesh.bounds().1.z;
        // A layer whose middle lies above the part is cut at mid-height of the piece of the part in it.
        let plane = |k: usize| {
            let Slab { z, height } = slabs[k];
            let (low, middle) = (z - height, middle(z, height, half(&slabs, k)));
            if middle >= top && low < top { low.midpoint(top) } else { middle }
        };
        let planes: Vec<f64> = (0..slabs.len()).map(plane).collect();
        let levels: Vec<u32> = mesh.vertices.par_iter().map(|v| level(&planes, h, v.z)).collect();
        task.check()?;
        let batches = |t: &[u32; 3]| {
            let Range { start, end } = crossed(&levels, t);
            if start == end { 0..0 } else { start / BATCH..(end - 1) / BATCH + 1 }
        };
        let mut starts = vec![0; count.div_ceil(BATCH) + 2];
        for batch in mesh.triangles.iter().flat_map(batches) {
            starts[batch + 2] += 1;
        }
        for i in 2..starts.len() {
            starts[i] += starts[i - 1];
        }
        let mut items = vec![0; starts[starts.len() - 1]];
        for (triangle, corners) in mesh.triangles.iter().enumerate() {
            for batch in batches(corners) {
                items[starts[batch + 1]] = triangle as u32;
                starts[batch + 1] += 1;
            }
        }
        starts.pop();
        Ok(Self {
            mesh,
            chart: None,
            thickest: f64::INFINITY,
            options,
            slabs,
            planes,
            levels,
            starts,
            items,
            scratch: Mutex::default(),
        })
    }

    /// For a mesh in the coordinates of a chart ([`crate::chart::warp`]): islands are joined across the seam.
    pub fn on(self, chart: &'a Chart) -> Self {
        Self { chart: (!chart.is_level()).then_some(chart), ..self }
    }

    /// Limits the thickness of layers (mm): of two with the same underside, the lower covers only where the upper would
    /// be thicker.
    pub fn no_thicker_than(self, thickest: f64) -> Self {
        Self { thickest, ..self }
    }

    /// Number of layers.
    pub fn layer_count(&self) -> usize {
        self.planes.len()
    }

    /// Number of batches of [`BATCH`] layers.
    pub fn batch_count(&self) -> usize {
        self.planes.len().div_ceil(BATCH)
    }

    /// The lines in which one batch of layers cuts an open surface.
    ///
    /// # Errors
    /// [`Cancelled`] if the task was cancelled.
    pub fn lines(&self, batch: usize, task: &Task) -> Result<Vec<Lines>, Cancelled> {
        self.each(batch, task, |index, triangles| {
            let (Trace { rings, open }, warnings) = self.traced(index, triangles);
            let simplify = self.options.simplify;
            let rings = rings.into_iter().filter_map(|ring| planar::polyline::simplify_ring(ring, simplify));
            let closed = rings.map(|ring| Section { points: ring.into_points(), closed: true });
            let open = open.into_iter().filter(|line| line.len() > 1);
            let open = open.map(|line| Section { points: planar::polyline::simplify(&line, simplify), closed: false });
            Lines { index, slab: self.slabs[index], sections: closed.chain(open).collect(), warnings }
        })
    }

    /// Cuts one batch of layers in parallel.
    ///
    /// # Errors
    /// [`Cancelled`] if the task was cancelled.
    pub fn batch(&self, batch: usize, task: &Task) -> Result<Vec<Slice>, Cancelled> {
        self.each(batch, task, |index, triangles| self.cut(index, triangles))
    }

    /// One result per layer of a batch, in parallel.
    fn each<T: Send>(
        &self,
        batch: usize,
        task: &Task,
        of: impl Fn(usize, &[u32]) -> T + Sync,
    ) -> Result<Vec<T>, Cancelled> {
        let layers = batch * BATCH..((batch + 1) * BATCH).min(self.planes.len());
        let by_layer = self.triangles_by_layer(batch, layers.clone());
        layers
            .into_par_iter()
            .zip(by_layer)
            .map(|(index, triangles)| {
                task.check()?;
                Ok(of(index, &triangles))
            })
            .collect()
    }

    /// Cuts all layers. For tall parts, cut [batch](Self::batch) by batch.
    ///
    /// # Errors
    /// [`Cancelled`] if the task was cancelled.
    pub fn all(&self, task: &Task) -> Result<Vec<Slice>, Cancelled> {
        let mut layers = Vec::with_capacity(self.layer_count());
        for batch in 0..self.batch_count() {
            task.step(Stage::Slice, batch as f64 / self.batch_count() as f64)?;
            layers.extend(self.batch(batch, task)?);
        }
        Ok(layers)
    }

    fn triangles_by_layer(&self, batch: usize, layers: Range<usize>) -> Vec<Vec<u32>> {
        let mut by_layer = vec![Vec::new(); layers.len()];
        for &triangle in &self.items[self.starts[batch]..self.starts[batch + 1]] {
            let crossed = crossed(&self.levels, &self.mesh.triangles[triangle as usize]);
            for layer in crossed.start.max(layers.start)..crossed.end.min(layers.end) {
                by_layer[layer - layers.start].push(triangle);
            }
        }
        by_layer
    }

    /// The contours of a layer, open ones separately, and warnings of gaps.
    fn traced(&self, index: usize, triangles: &[u32]) -> (Trace, Vec<Warning>) {
        let scratch = self.scratch.lock().ok().and_then(|mut pool| pool.pop());
        let mut scratch = scratch.unwrap_or_else(|| Scratch::new(self.mesh.triangles.len()));
        let Trace { mut rings, open } =
            Cut { mesh: self.mesh, levels: &self.levels, layer: index as u32, plane: self.planes[index] }
                .trace(triangles, &mut scratch);
        if let Ok(mut pool) = self.scratch.lock() {
            pool.push(scratch);
        }
        let mut gaps = Vec::new();
        let open = close::close(open, self.options.close_gap, &mut rings, |place, size| {
            gaps.push(Warning { kind: WarningKind::GapClosed, layer: index, place, size });
        });
        (Trace { rings, open }, gaps)
    }

    fn cut(&self, index: usize, triangles: &[u32]) -> Slice {
        let (Slab { z, height }, simplify) = (self.slabs[index], self.options.simplify);
        let (Trace { rings, open }, warnings) = self.traced(index, triangles);
        let mut layer = Slice { index, z, height, half: half(&self.slabs, index), warnings, ..Slice::default() };
        let dropped = |line: &Vec<DVec2>| {
            let (kind, place, size) =
                (WarningKind::OpenContourDropped, line[line.len() / 2], planar::polyline::length(line));
            Warning { kind, layer: index, place, size }
        };
        layer.warnings.extend(open.iter().filter(|line| !line.is_empty()).map(dropped));
        let rings: Vec<Ring> = rings.into_iter().filter_map(|r| planar::polyline::simplify_ring(r, simplify)).collect();
        let region = Region::from_rings(&rings, FillRule::NonZero);
        layer.warnings.extend(area_balance(index, &rings, &region));
        layer.islands = match self.chart {
            None => region.into_polygons(),
            Some(chart) => {
                let (cut, middle) = (chart.sheet(self.planes[index]), chart.sheet(middle(z, height, layer.half)));
                seam::joined(self.halved(region, index, chart).into_polygons(), index, &cut, &middle)
            }
        };
        drop_slivers(&mut layer);
        layer
    }

    /// The area of its slice that a layer covers: for the lower of two, only where the upper one is too thick.
    fn halved(&self, region: Region, index: usize, chart: &Chart) -> Region {
        let upper = self.slabs.get(index + 1).filter(|_| half(&self.slabs, index) == Some(Half::Lower));
        let (Some(upper), Some(bounds)) = (upper, region.bounds()) else { return region };
        match chart.sheet(upper.z - upper.height / 2.0).rising(self.thickest / upper.height, &bounds) {
            Some(thick) => region.intersection(&Region::from(thick)),
            None => Region::default(),
        }
    }
}

/// Whether a layer shares its underside with a neighbour, and which of the two it is.
fn half(slabs: &[Slab], index: usize) -> Option<Half> {
    let underside = |slab: &Slab| slab.z - slab.height;
    let own = underside(&slabs[index]);
    let is_same = |other: Option<&Slab>| other.is_some_and(|other| (underside(other) - own).abs() < SAME_MM);
    if is_same(slabs.get(index + 1)) {
        return Some(Half::Lower);
    }
    is_same(index.checked_sub(1).and_then(|below| slabs.get(below))).then_some(Half::Upper)
}

/// Undersides closer than this are the same, mm.
const SAME_MM: f64 = 1e-6;

/// Slivers shorter than this are rounding errors and are not reported.
const WORTH_TELLING_MM: f64 = 1.0;

/// Leaves out holes and islands that are too thin to matter, with a warning.
fn drop_slivers(layer: &mut Slice) {
    let Slice { index, islands, warnings, .. } = layer;
    let mut keep = |ring: &Ring| {
        let size = ring.area().abs();
        // A thin ring is as wide as its area over half its length.
        let thin = 2.0 * size < SLIVER_MM * ring.length();
        if thin && ring.length() > 2.0 * WORTH_TELLING_MM {
            warnings.push(Warning { kind: WarningKind::Sliver, layer: *index, place: center(ring), size });
        }
        !thin
    };
    islands.retain_mut(|island| {
        island.holes.retain(&mut keep);
        keep(&island.outer)
    });
}

/// Number of planes at or below height `z`.
fn level(planes: &[f64], spacing: f64, z: f64) -> u32 {
    // Right for equal layers except for rounding; the planes themselves decide.
    let guess = ((z / spacing + 0.5) as usize).min(planes.len());
    let above = guess == planes.len() || planes[guess] > z;
    let right = above && (guess == 0 || planes[guess - 1] <= z);
    if right { guess as u32 } else { planes.partition_point(|&plane| plane <= z) as u32 }
}

/// The planes that cross a triangle: those above its lowest corner and not above its highest.
fn crossed(levels: &[u32], triangle: &[u32; 3]) -> Range<usize> {
    let [a, b, c] = triangle.map(|v| levels[v as usize]);
    a.min(b).min(c) as usize..a.max(b).max(c) as usize
}

/// Well-wound contours keep their area when they are united; a difference reveals overlaps or wrong winding.
fn area_balance(layer: usize, rings: &[Ring], region: &Region) -> Option<Warning> {
    let signed: f64 = rings.iter().map(Ring::area).sum();
    let area = region.area();
    let size = (signed - area).abs();
    let place =
        || rings.iter().max_by(|a, b| a.area().abs().total_cmp(&b.area().abs())).map(center).unwrap_or_default();
    (size > 0.01 * area.max(1.0)).then(|| Warning { kind: WarningKind::ContoursUnited, layer, place: place(), size })
}

fn center(ring: &Ring) -> DVec2 {
    planar::Bounds::of(ring.points().iter().copied()).map(|b| b.center()).unwrap_or_default()
}
