//! The shape that the beads of a plan have in space, compared with the part.
//!
//! A bead takes up its width on its layer, from the layer's underside to its top; the valleys and humps that the
//! deposit model predicts are in the figures of each layer. So this shows whether beads lie where the part is, however
//! its layers run: steps, missing and surplus metal, layers of one body next to those of another. What belongs to no
//! body of the part counts as already there.

use crate::chart::{Chart, Sheet};
use crate::deviation::{Deviation, DeviationError, deviation};
use crate::layer::Layer;
use crate::metrics::Metrics;
use crate::model::Mesh;
use crate::pass::Segment;
use crate::plan::AsWelded;
use crate::profile::{LayersSection, Profile};
use crate::slice::{Slab, SliceOptions, Slicer};
use crate::task::{Cancelled, Task};
use glam::DVec3;
use planar::Region;
use rayon::prelude::*;
use rstar::{AABB, Envelope, RTree, RTreeObject};
use serde::Serialize;

/// The box around part and metal is divided into at most about this many voxels,
const VOXELS: f64 = 4e6;
/// whose edges are no shorter than this fraction of a layer's height.
const FINEST: f64 = 0.5;
/// Where the middle of the first voxel lies in the corner of the box, as a fraction of a voxel's edge.
const OFF: f64 = 0.381_966;
/// Accuracy to which the surface of the metal is found, as a fraction of a voxel's edge.
const SURFACE: f64 = 1.0 / 64.0;

/// What a plan builds, compared with the part that it was made for.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct AsBuilt {
    /// Edge of the voxels that are counted, mm.
    pub step: f64,
    /// Volume of the part that is to be welded, mm³.
    pub part: f64,
    /// Volume that beads take up, mm³; less than the metal laid where they overlap or rise above their layer.
    pub metal: f64,
    /// Volume of the metal that is laid, mm³.
    pub laid: f64,
    /// Volume shared by the part and the beads, mm³.
    pub common: f64,
    /// How far the metal's surface lies from that of the part.
    #[serde(skip)]
    pub surface: Deviation,
}

impl AsBuilt {
    /// The shared volume as a fraction of the union of part and beads, 0 to 1.
    pub fn agreement(&self) -> f64 {
        self.common / (self.part + self.metal - self.common)
    }
}

/// Compares the beads of a plan with its part, placed as it was planned; `profile` is the one that it was planned with.
///
/// ```
/// use beadwright::{Model, Placement, Profile, Task, as_built::as_built, example, plan};
///
/// let (profile, task) = (Profile::built_in("cmt-al2319-kuka")?, Task::new());
/// let bytes = example::find("cross").ok_or("no such example")?.stl();
/// let part = Model::read(&bytes, &task)?.place(&Placement::default(), None, profile.bead.width)?;
/// let plan = plan("cross", &part, &profile, &task)?;
/// let mesh = part.mesh().ok_or("a solid")?;
/// let built = as_built(&plan.layers, &profile, mesh, &task)?;
/// assert!(built.agreement() > 0.95);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`DeviationError`], such as that there are no points where a plan has no bead.
pub fn as_built(layers: &[Layer], profile: &Profile, part: &Mesh, task: &Task) -> Result<AsBuilt, DeviationError> {
    let metal = Metal::of(layers, AsWelded::of(profile));
    let (options, margin) = (profile.slice_options(), profile.bead.width);
    let grid = Grid::around(&[part.bounds(), metal.bounds()], margin, FINEST * options.layer_height);
    let inside = grid.inside(part, options, task)?;
    let held = held(&grid, &profile.layers, options, part, task)?;
    let built = grid.filled(|p| metal.contains(p), task)?;
    let voxels: Vec<Voxel> = inside
        .into_iter()
        .zip(held)
        .zip(built)
        .map(|((inside, held), metal)| Voxel { part: inside && held, stock: inside && !held, metal })
        .collect();
    let volume =
        |counts: fn(&Voxel) -> bool| voxels.iter().filter(|voxel| counts(voxel)).count() as f64 * grid.step.powi(3);
    let points = grid.surface(&voxels, |p| metal.contains(p), task)?;
    let surface = deviation(part, &points, profile.fill.machining_allowance, task)?;
    let mut metrics = Metrics::new(profile);
    layers.iter().for_each(|layer| metrics.add(layer));
    Ok(AsBuilt {
        step: grid.step,
        part: volume(|voxel| voxel.part),
        metal: volume(|voxel| voxel.metal),
        laid: metrics.deposited_volume_mm3,
        common: volume(|voxel| voxel.part && voxel.metal),
        surface,
    })
}

/// Which voxels are to be welded.
fn held(
    grid: &Grid,
    layers: &LayersSection,
    options: SliceOptions,
    part: &Mesh,
    task: &Task,
) -> Result<Vec<bool>, Cancelled> {
    if layers.bodies.iter().all(|body| body.solids.is_empty()) {
        return grid.filled(|p| layers.has(p), task);
    }
    let mut held = vec![false; grid.counts.iter().product()];
    for body in &layers.bodies {
        let inside = grid.inside(&body.solids_of(part), options, task)?;
        let own = grid.filled(|p| body.has(p), task)?;
        held.iter_mut().zip(inside.into_iter().zip(own)).for_each(|(held, (inside, own))| *held |= inside && own);
    }
    Ok(held)
}

/// What lies at the middle of a voxel.
#[derive(Debug, Clone, Copy)]
struct Voxel {
    /// The part, where it is to be welded.
    part: bool,
    /// The part, where it is already there.
    stock: bool,
    /// A bead.
    metal: bool,
}

/// All beads, by body and layer.
struct Metal<'a>(Vec<Body<'a>>);

struct Body<'a> {
    chart: &'a Chart,
    /// Sorted by their undersides, lowest first.
    courses: Vec<Course<'a>>,
    /// The greatest distance from the underside of a course to its top, mm.
    deepest: f64,
}

/// The beads of a layer.
struct Course<'a> {
    sheet: Sheet<'a>,
    /// Its underside and its top, mm.
    low: f64,
    high: f64,
    height: f64,
    beads: RTree<Bead>,
}

/// A straight piece of a bead, seen from above.
struct Bead(Segment);

impl RTreeObject for Bead {
    type Envelope = AABB<[f64; 2]>;

    fn envelope(&self) -> Self::Envelope {
        let Segment { from, to, width, .. } = self.0;
        let (from, to) = (from.truncate(), to.truncate());
        AABB::from_corners((from.min(to) - width / 2.0).to_array(), (from.max(to) + width / 2.0).to_array())
    }
}

impl Bead {
    /// Whether it takes up a point (u, v, h) of its layer, which is `height` (mm) thick.
    fn holds(&self, p: DVec3, height: f64) -> bool {
        let Segment { from, to, width, .. } = self.0;
        let along = (to - from).truncate();
        let share = ((p - from).truncate().dot(along) / along.length_squared()).clamp(0.0, 1.0);
        let foot = if share.is_finite() { from.lerp(to, share) } else { from };
        (p - foot).truncate().length() <= width / 2.0 && (foot.z - height..=foot.z).contains(&p.z)
    }
}

impl<'a> Metal<'a> {
    fn of(layers: &[Layer], as_welded: AsWelded<'a>) -> Self {
        let courses = layers.iter().filter_map(|layer| Course::of(&as_welded.welded(layer), as_welded.layers()));
        let mut bodies: Vec<Body<'a>> = Vec::new();
        let mut of_body: Option<usize> = None;
        for (body, chart, course) in courses {
            if of_body != Some(body) {
                of_body = Some(body);
                bodies.push(Body { chart, courses: Vec::new(), deepest: 0.0 });
            }
            if let Some(body) = bodies.last_mut() {
                body.deepest = body.deepest.max(course.high - course.low);
                body.courses.push(course);
            }
        }
        bodies.iter_mut().for_each(|body| body.courses.sort_by(|a, b| a.low.total_cmp(&b.low)));
        Self(bodies)
    }

    /// The lowest and the highest corner of a box around the paths of all beads in space, mm.
    fn bounds(&self) -> (DVec3, DVec3) {
        let courses = self.0.iter().flat_map(|body| &body.courses);
        let ends = courses.flat_map(|course| {
            course.beads.iter().flat_map(|bead| [bead.0.from, bead.0.to]).map(|p| course.sheet.at(p).place)
        });
        ends.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)))
    }

    /// Whether there is metal at a point in space.
    fn contains(&self, p: DVec3) -> bool {
        self.0.iter().any(|body| body.contains(p))
    }
}

impl Body<'_> {
    fn contains(&self, p: DVec3) -> bool {
        let h = self.chart.coordinates(p).z;
        let begun = self.courses.partition_point(|course| course.low <= h);
        let near = self.courses[..begun].iter().rev().take_while(|course| course.low >= h - self.deepest);
        near.filter(|course| h <= course.high).any(|course| course.contains(p))
    }
}

impl<'a> Course<'a> {
    /// With its body and its chart; `None` for a layer without passes.
    fn of(welded: &Layer, layers: &'a LayersSection) -> Option<(usize, &'a Chart, Self)> {
        let heights = || welded.passes.iter().flat_map(|pass| &pass.points).map(|p| p.z);
        let (low, high) = (heights().reduce(f64::min)? - welded.height, heights().reduce(f64::max)?);
        let beads = welded.passes.iter().flat_map(|pass| pass.segments()).map(Bead).collect();
        let chart = layers.chart_of(welded);
        let sheet = chart.sheet(welded.middle());
        Some((welded.body, chart, Self { sheet, low, high, height: welded.height, beads: RTree::bulk_load(beads) }))
    }

    fn contains(&self, p: DVec3) -> bool {
        let envelope = self.beads.root().envelope();
        let middle = envelope.center().into();
        let once = self.sheet.coordinates(p, middle);
        let again = [-1.0, 1.0].into_iter().filter_map(|turns| self.sheet.turned(once.truncate(), turns));
        std::iter::once(once.truncate()).chain(again).any(|place| {
            let around = AABB::from_point(place.to_array());
            let mut beads = self.beads.locate_in_envelope_intersecting(&around);
            beads.any(|bead| bead.holds(place.extend(once.z), self.height))
        })
    }
}

/// Voxels around part and metal.
struct Grid {
    /// The middle of the first, mm.
    first: DVec3,
    step: f64,
    /// How many there are along x, y and z.
    counts: [usize; 3],
}

impl Grid {
    /// A grid around some boxes, with a margin; a voxel is not smaller than `finest` (all mm).
    fn around(boxes: &[(DVec3, DVec3)], margin: f64, finest: f64) -> Self {
        let low = boxes.iter().fold(DVec3::INFINITY, |low, around| low.min(around.0)) - margin;
        let high = boxes.iter().fold(DVec3::NEG_INFINITY, |high, around| high.max(around.1)) + margin;
        let size = high - low;
        let step = (size.element_product() / VOXELS).cbrt().max(finest);
        let counts = size.to_array().map(|size| (size / step).ceil().max(1.0) as usize);
        // Faces of the part often lie on whole millimetres; this keeps the voxels' middles off them.
        Self { first: low + OFF * step, step, counts }
    }

    fn place(&self, [i, j, k]: [usize; 3]) -> DVec3 {
        self.first + DVec3::new(i as f64, j as f64, k as f64) * self.step
    }

    /// Index of a voxel: by level, then row, then place in the row.
    fn at(&self, [i, j, k]: [usize; 3]) -> usize {
        (k * self.counts[1] + j) * self.counts[0] + i
    }

    /// Which voxels hold something.
    fn filled(&self, holds: impl Fn(DVec3) -> bool + Sync, task: &Task) -> Result<Vec<bool>, Cancelled> {
        let [columns, rows, levels] = self.counts;
        let row = |at: usize| -> Result<Vec<bool>, Cancelled> {
            task.check()?;
            Ok((0..columns).map(|i| holds(self.place([i, at % rows, at / rows]))).collect())
        };
        let found: Vec<Vec<bool>> = (0..levels * rows).into_par_iter().map(row).collect::<Result<_, _>>()?;
        Ok(found.concat())
    }

    /// Which voxels lie in the part.
    fn inside(&self, part: &Mesh, options: SliceOptions, task: &Task) -> Result<Vec<bool>, Cancelled> {
        let [columns, rows, levels] = self.counts;
        let slab = |k: usize| Slab { z: self.place([0, 0, k]).z + self.step / 2.0, height: self.step };
        let slices = Slicer::of_slabs(part, (0..levels).map(slab).collect(), options, task)?.all(task)?;
        let mut inside = vec![false; columns * rows * levels];
        // A slab that ends above the part would be cut lower down, where there still is some of it.
        let within = |k: usize| self.place([0, 0, k]).z <= part.bounds().1.z;
        for (k, slice) in slices.into_iter().enumerate().take_while(|(k, _)| within(*k)) {
            let crossings = Region::from_normalised(slice.islands).rows(self.first.y, self.step, rows);
            for (j, row) in crossings.iter().enumerate() {
                for ends in row.chunks_exact(2) {
                    let [from, to] =
                        [ends[0], ends[1]].map(|x| ((x - self.first.x) / self.step).ceil().max(0.0) as usize);
                    let start = self.at([0, j, k]);
                    inside[start + from.min(columns)..start + to.min(columns)].fill(true);
                }
            }
        }
        Ok(inside)
    }

    /// Points on the surface of the metal: between two neighbouring voxels of which one holds metal and the other
    /// nothing.
    fn surface(
        &self,
        voxels: &[Voxel],
        holds: impl Fn(DVec3) -> bool + Sync,
        task: &Task,
    ) -> Result<Vec<DVec3>, Cancelled> {
        let [columns, rows, levels] = self.counts;
        let of_row = |row: usize| -> Result<Vec<DVec3>, Cancelled> {
            task.check()?;
            let (j, k) = (row % rows, row / rows);
            let mut found = Vec::new();
            for i in 0..columns {
                let (at, here) = ([i, j, k], voxels[self.at([i, j, k])]);
                for next in [[i + 1, j, k], [i, j + 1, k], [i, j, k + 1]] {
                    if next.iter().zip(&self.counts).any(|(n, count)| n >= count) {
                        continue;
                    }
                    let there = voxels[self.at(next)];
                    if here.metal != there.metal && !here.stock && !there.stock {
                        found.push(edge([self.place(at), self.place(next)], here.metal, &holds));
                    }
                }
            }
            Ok(found)
        };
        let found: Vec<Vec<DVec3>> = (0..levels * rows).into_par_iter().map(of_row).collect::<Result<_, _>>()?;
        Ok(found.concat())
    }
}

/// Where the boundary lies between two points, of which `from` is `held` and `to` is not, or the other way round.
fn edge([mut from, mut to]: [DVec3; 2], held: bool, holds: impl Fn(DVec3) -> bool) -> DVec3 {
    let accuracy = SURFACE * from.distance(to);
    while from.distance(to) > accuracy {
        let middle = from.midpoint(to);
        *(if holds(middle) == held { &mut from } else { &mut to }) = middle;
    }
    from.midpoint(to)
}
