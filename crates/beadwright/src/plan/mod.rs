//! The entry point: a mesh and a profile become a [`Plan`], layer by layer in deposition order.
//!
//! [`plan_into`] streams: each finished layer goes to a sink and is forgotten, so a part of thousands of layers
//! needs the memory of the mesh plus [`BATCH`] layers. [`plan`] collects the layers. A wall may
//! be given by its centre-lines instead of a solid.
//!
//! | file | what it does |
//! | --- | --- |
//! | `beside` | whether the torch has room next to finished bodies |
//! | `bodies` | parts that are welded as several bodies, each with layers of its own kind |
//! | [`clearance`] | whether the torch has room next to finished parts |
//! | `parts` | parts that are welded one after another |
//! | `centre_lines` | walls of one bead by their centre-lines |
//! | `charted` | parts whose layers are not level |
//! | `candidates` | what fills an island that its strategy cannot |
//! | [`choice`] | which strategy a part is planned with |
//! | `emitter` | hands layers over in order, within the limits of heat, with warnings |
//! | [`expected`](expected()) | roughly how much a plan will contain |
//! | `cover` | how much of a slice beads cover, and what they leave bare |
//! | `filled` | a slice with its passes |
//! | `judged` | how the deposit model treats plans |
//! | `helix` | one helix in place of closed walls |
//! | `level_layers` | layers of solids as high as their metal, which is shared out within them |
//! | `levels` | where the layers of a wall lie |
//! | `milled` | whether there is metal everywhere in the part that is milled from a preform |
//! | `result` | what a plan is, where its layers go, why there may be none |
//! | `row` | the layers of parts or bodies that are welded one after another, as one plan |
//! | `reasons` | why a plan's volume differs from the part's, or is nothing |
//! | [`preview`] | one layer ahead of the others |
//! | `turns` | passes that go around an axis more than once |
//! | `warm` | what heat does to the width of beads and to the layers of a wall |
//! | `settings` | the settings of every stage, made from the profile once |
//! | `slicing` | how a part is cut into layers, and what an open surface stands for |
//! | [`stock`] | turns a part into its preform, which is planned instead |
//! | `support` | whether passes lie on the metal below |
//! | `wedges` | where layers of varying thickness lie |
//! | `scan_lines` | best raster angles, and which parts of a sparse infill are solid |

mod beside;
mod bodies;
mod candidates;
mod centre_lines;
pub(crate) mod charted;
pub mod choice;
pub mod clearance;
mod cover;
mod emitter;
mod expected;
mod filled;
mod helix;
mod judged;
mod level_layers;
mod levels;
mod milled;
mod parts;
mod preview;
mod reasons;
mod relight;
mod result;
mod row;
mod scan_lines;
mod settings;
mod slicing;
pub mod stock;
mod support;
pub(crate) mod turns;
pub(crate) mod warm;
mod wedges;

pub use expected::{Expected, expected};
pub(crate) use judged::AsWelded;
pub use judged::{deposit_settings, deposit_settings_over, even, grid_over, welded, welded_alone};
pub use parts::{parts_into, torch_of};
pub use preview::preview;
pub use result::{Blocked, Collect, Header, Plan, PlanError, Sink, Summary};
pub use scan_lines::{ToFill, raster_angle};
pub(crate) use settings::PlanSettings;
pub use turns::{Bands, drawn, is_jump, unrolled_once};

use crate::deposit::Stack;
use crate::fill::Strategy;
use crate::fill::around::Around;
use crate::layer::Extent;
use crate::model::holes::{self, Opening};
use crate::model::wall_curves::WallCurves;
use crate::model::{Mesh, PartRef};
use crate::order;
use crate::profile::Profile;
use crate::slice::{self, BATCH, Slab};
use crate::task::{Cancelled, Stage, Task};
use crate::warning::{WarningKind, WarningSummary, Warnings};
use centre_lines::{centre_lines, weld_curves, weld_lines};
use charted::Unrolled;
use emitter::Emitter;
use filled::Filled;
use glam::DVec2;
use helix::{Helix, NoTurn};
use milled::Milled;
use planar::Bounds;
use rayon::prelude::*;
use reasons::{left_over, other_volume, why_empty};
use std::convert::Infallible;
use support::{Footing, Support};
use warm::{Heat, Warmth};

/// Maximum number of layers of a plan.
pub const MAX_LAYERS: usize = 100_000;

/// Plans a part placed on z = 0, either a solid or a wall given by curves, and keeps all layers. `name` is used
/// for files and headings.
///
/// ```
/// use beadwright::{Profile, StrategyName, Task, example, plan};
///
/// let mut profile = Profile::built_in("cmt-al2319-kuka")?;
/// profile.fill.strategy = StrategyName::Zigzag;
/// let cross = example::find("cross").ok_or("no such example")?.mesh();
/// let plan = plan("cross", &cross, &profile, &Task::new())?;
/// let passes: usize = plan.layers.iter().map(|layer| layer.passes.len()).sum();
/// assert_eq!(plan.summary.metrics.arc_starts, passes);
/// assert!(plan.layers.is_sorted_by(|below, above| below.z < above.z));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`PlanError`].
pub fn plan<'a>(
    name: &str,
    part: impl Into<PartRef<'a>>,
    profile: &Profile,
    task: &Task,
) -> Result<Plan, PlanError<Infallible>> {
    let mut collect = Collect::default();
    let summary = plan_into(name, part, profile, task, &mut collect)?;
    let header = collect.header.ok_or_else(|| PlanError::Empty("the part has no layers.".to_owned()))?;
    Ok(Plan { header, layers: collect.layers, summary })
}

/// Plans a part and hands every layer to `sink`. The result does not depend on the number of threads: layers are filled
/// in parallel, but ordered and handed over one after another.
///
/// # Errors
/// [`PlanError`], including the sink's own errors.
pub fn plan_into<'a, S: Sink + Send>(
    name: &str,
    part: impl Into<PartRef<'a>>,
    profile: &Profile,
    task: &Task,
    sink: &mut S,
) -> Result<Summary, PlanError<S::Error>> {
    let given = part.into();
    if !profile.layers.bodies.is_empty() || matches!(given, PartRef::Mesh { onto: Some(_), .. }) {
        return bodies::bodies_into(name, given, profile, task, sink);
    }
    let settings = &PlanSettings::of(profile);
    let chart = settings.slicing.chart;
    let unrolled = Unrolled::of(given, &settings.slicing, task)?;
    let part = unrolled.as_ref().map_or(given, Unrolled::part);
    let warmth = warm::predicted(part, settings, task)?;
    let mut heat = Heat::in_space(part, settings);
    let mut summary = plan_at(Start::alone(&warmth, heat.as_mut()), name, part, settings, task, sink)?;
    if let (Some(_), PartRef::Mesh { mesh: placed, .. }, PartRef::Mesh { mesh, .. }) = (&unrolled, given, part) {
        summary.notes.extend(charted::notes(placed, mesh, chart));
        summary.forbidden.extend(charted::too_narrow(mesh.bounds().1.z, chart, &settings.weld));
    }
    Ok(summary)
}

/// What a part, or one of its bodies, begins on.
struct Start<'a> {
    /// How its layers rise.
    warmth: &'a Warmth,
    footing: Footing,
    /// The heat of those welded earlier; `None` on a cold plate.
    heat: Option<&'a mut Heat>,
}

impl<'a> Start<'a> {
    /// The only body of a part, with `heat` where its layers are not level.
    fn alone(warmth: &'a Warmth, heat: Option<&'a mut Heat>) -> Self {
        Self { warmth, footing: Footing::PLATE, heat: heat.map(|heat| heat.before(0, warmth)) }
    }
}

/// Plans a part from its start.
fn plan_at<S: Sink + Send>(
    start: Start,
    name: &str,
    part: PartRef,
    settings: &PlanSettings,
    task: &Task,
    sink: &mut S,
) -> Result<Summary, PlanError<S::Error>> {
    match part {
        PartRef::Mesh { mesh, milled, .. } => {
            let strategy = settings.strategy.strategy();
            plan_mesh(start, name, (mesh, milled), strategy, settings, task, sink)
        }
        PartRef::Curves(curves, height) => plan_curves(start.warmth, name, curves, height, settings, task, sink),
    }
}

/// Plans a solid with a given strategy, whatever the profile says, and hands every layer to `sink`.
///
/// # Errors
/// [`PlanError`], including the sink's own errors.
pub fn plan_with<S: Sink + Send>(
    name: &str,
    mesh: &Mesh,
    strategy: &dyn Strategy,
    profile: &Profile,
    task: &Task,
    sink: &mut S,
) -> Result<Summary, PlanError<S::Error>> {
    let settings = &PlanSettings::of(profile);
    let mesh = &*charted::unrolled(mesh, settings.slicing.chart, task)?;
    let warmth = warm::predicted(mesh.into(), settings, task)?;
    let mut heat = Heat::in_space(mesh.into(), settings);
    plan_mesh(Start::alone(&warmth, heat.as_mut()), name, (mesh, None), strategy, settings, task, sink)
}

fn plan_mesh<S: Sink + Send>(
    Start { warmth, footing, heat }: Start,
    name: &str,
    (mesh, milled): (&Mesh, Option<&Mesh>),
    strategy: &dyn Strategy,
    settings: &PlanSettings,
    task: &Task,
    sink: &mut S,
) -> Result<Summary, PlanError<S::Error>> {
    let PlanSettings { bead_width, slicing, filling, .. } = settings;
    let opening = holes::openings(mesh).into_iter().next();
    let wide = opening.filter(|opening| opening.width > *bead_width);
    // Around an axis the part itself has already been checked.
    let unsaid = slicing.surface.is_none() && slicing.chart.is_level();
    if let Some(Opening { width, place, .. }) = wide.filter(|_| unsaid) {
        return Err(PlanError::Open { width, place });
    }
    let is_wall = slicing.is_wall(mesh);
    let slabs = slabs_at(warmth, mesh, settings, task)?;
    let left = left_over(mesh, &slabs, settings.layers.height);
    let (low, high) = mesh.bounds();
    let mut own = Heat::default();
    let heat = heat.unwrap_or_else(|| {
        own = Heat::of(&settings.warming, &Bounds { min: low.truncate(), max: high.truncate() }, &slabs, warmth);
        &mut own
    });
    let milled_volume = milled.map(Mesh::volume);
    let milled = milled.map(|part| Milled::new(part, &slabs, slicing.options, task)).transpose()?;
    let slicer = slicing.filled(mesh, slabs, task)?;
    let datum = middle(mesh);
    let fill_batch = |batch: usize| -> Result<Vec<Filled>, Cancelled> {
        if is_wall {
            return Ok(slicer.lines(batch, task)?.into_par_iter().map(|lines| weld_lines(lines, filling)).collect());
        }
        let planned = scan_lines::planned(batch, &slicer, strategy, filling, task)?;
        let mut filled = filled::fill_batch(planned, strategy, filling, datum, task)?;
        if let Some(milled) = &milled {
            filled.iter_mut().zip(milled.batch(batch, task)?).for_each(|(filled, part)| filled.milled = Some(part));
        }
        Ok(filled)
    };
    let (low, high) = mesh.bounds();
    let extent = Extent { layers: slicer.layer_count(), low, high };
    let mut summary = run([name, strategy.name()], extent, (heat, footing), settings, task, sink, fill_batch)?;
    if summary.metrics.passes == 0 {
        return Err(PlanError::Empty(why_empty(&summary, mesh, *bead_width)));
    }
    let volume = slicing.chart.volume(mesh);
    summary.metrics.mesh_volume_mm3 = Some(volume).filter(|volume| opening.is_none() && *volume > 0.0);
    summary.metrics.milled_part_volume_mm3 = milled_volume;
    let volumes = if is_wall { None } else { other_volume(&summary, volume, left.is_some()) };
    summary.notes.splice(0..0, left.into_iter().chain(volumes));
    if unsaid {
        let torn =
            |w: &&WarningSummary| w.kind == WarningKind::OpenContourDropped && w.largest.size > TORN * bead_width;
        let torn = summary.warnings.summaries().find(torn).map(WarningSummary::sentence);
        summary.forbidden.extend(torn.map(|torn| {
            format!("{torn} With slice.surface = \"solid\" the rest is planned without what does not close.")
        }));
    }
    Ok(summary)
}

/// An open contour longer than this, in bead widths, would leave part of the solid missing.
const TORN: f64 = 4.0;

/// The middle of a part, seen from above.
fn middle(mesh: &Mesh) -> DVec2 {
    let (low, high) = mesh.bounds();
    low.midpoint(high).truncate()
}

/// Where the layers of a part would lie, without planning them.
///
/// # Errors
/// [`PlanError`].
pub fn slabs<'a>(
    part: impl Into<PartRef<'a>>,
    profile: &Profile,
    task: &Task,
) -> Result<Vec<Slab>, PlanError<Infallible>> {
    let (given, settings) = (part.into(), &PlanSettings::of(profile));
    let unrolled = Unrolled::of(given, &settings.slicing, task)?;
    let part = unrolled.as_ref().map_or(given, Unrolled::part);
    slabs_of(&warm::predicted(part, settings, task)?, part, settings, task)
}

/// Where the layers of a part lie, with this warmth.
fn slabs_of<E>(
    warmth: &Warmth,
    part: PartRef,
    settings: &PlanSettings,
    task: &Task,
) -> Result<Vec<Slab>, PlanError<E>> {
    match part {
        PartRef::Mesh { mesh, .. } => slabs_at(warmth, mesh, settings, task),
        PartRef::Curves(curves, height) => {
            let curves = centre_lines(curves, settings.curves, settings.bead_width)?;
            Ok(levels::of_curves(&curves, height, &settings.curve_wall?, warmth))
        }
    }
}

/// Where the layers of a mesh lie, with this warmth.
fn slabs_at<E>(warmth: &Warmth, mesh: &Mesh, settings: &PlanSettings, task: &Task) -> Result<Vec<Slab>, PlanError<E>> {
    let PlanSettings { layers, slicing, sharing, .. } = settings;
    check_layer_count(mesh, layers.height)?;
    let slabs = match (settings.wall?, sharing) {
        (Some(wall), _) => levels::of_mesh(mesh, &wall, warmth, slicing, task)?,
        (None, Some(sharing)) => level_layers::slabs(mesh, sharing, settings, task)?,
        (None, None) => slice::fitted_slabs(mesh, layers.height, layers.fit),
    };
    Ok(wedges::slabs(slabs, mesh, layers, slicing.options, task)?)
}

/// Plans a wall one bead thick along curves, up to `height` (mm).
fn plan_curves<S: Sink + Send>(
    warmth: &Warmth,
    name: &str,
    curves: &WallCurves,
    height: f64,
    settings: &PlanSettings,
    task: &Task,
    sink: &mut S,
) -> Result<Summary, PlanError<S::Error>> {
    let (given, width) = (curves, settings.bead_width);
    let curves = &*centre_lines(given, settings.curves, width)?;
    let slabs = levels::of_curves(curves, height, &settings.curve_wall?, warmth);
    let bounds = curves.bounds(height).unwrap_or(Bounds { min: DVec2::ZERO, max: DVec2::ZERO });
    let (low, high) = (bounds.min.extend(0.0), bounds.max.extend(height));
    let extent = Extent { layers: slabs.len(), low, high };
    let mut heat = Heat::of(&settings.warming, &bounds, &slabs, warmth);
    let fill_batch = |batch: usize| -> Result<Vec<Filled>, Cancelled> {
        let layers = batch * BATCH..((batch + 1) * BATCH).min(slabs.len());
        let fill = |index: usize| {
            task.check()?;
            Ok(weld_curves(curves, index, slabs[index], &settings.filling))
        };
        layers.into_par_iter().map(fill).collect()
    };
    let mut summary =
        run([name, settings.strategy.name()], extent, (&mut heat, Footing::PLATE), settings, task, sink, fill_batch)?;
    summary.notes.extend(centre_lines::other_thickness(given, settings.curves, width));
    if summary.metrics.passes == 0 {
        return Err(PlanError::Empty(
            "each curve is shorter than fill.min_pass_length, or than the distance within which ends are joined \
             (wall.junction_tolerance)."
                .to_owned(),
        ));
    }
    Ok(summary)
}

/// Fills batch after batch and hands their layers over in order.
fn run<S: Sink + Send>(
    [part, strategy]: [&str; 2],
    extent: Extent,
    (heat, footing): (&mut Heat, Footing),
    settings: &PlanSettings,
    task: &Task,
    sink: &mut S,
    fill_batch: impl Fn(usize) -> Result<Vec<Filled>, Cancelled> + Sync,
) -> Result<Summary, PlanError<S::Error>> {
    let [part, strategy] = [part, strategy].map(str::to_owned);
    let header = Header { part, profile: settings.profile.to_owned(), strategy, extent };
    sink.begin(&header).map_err(PlanError::Sink)?;
    let grown = settings.sharing.filter(|sharing| sharing.deposit.over_one_another).map(|sharing| {
        let (bounds, layers) = judged::grid(sharing.height, (extent.low, extent.high));
        Stack::new(&bounds, sharing.deposit.fitted_to(&bounds, layers))
    });
    let asks_how_it_grows = sink.asks_how_it_grows();
    let mut emitter = Emitter {
        settings,
        sink,
        middle: extent.seen_from_above().center(),
        torch: None,
        heat,
        memory: order::Memory::default(),
        helix: settings.helix.then(|| Helix::new(extent.layers, settings.relighting.most)),
        no_turn: None,
        below: Vec::new(),
        support: Support::on(footing),
        grown,
        asks_how_it_grows,
        before: Vec::new(),
        below_middle: 0.0,
        built: 0.0,
        points: 0,
        has_helix: false,
        metrics: settings.metrics.clone(),
        warnings: Warnings::default(),
    };
    let batches = extent.layers.div_ceil(BATCH);
    // While one batch is handed over, the next is filled.
    let mut ready = fill_batch(0)?;
    for next in 1..=batches {
        task.step(Stage::Plan, next as f64 / batches as f64)?;
        let (filled, emitted) = rayon::join(
            || if next < batches { fill_batch(next) } else { Ok(Vec::new()) },
            || ready.into_iter().try_for_each(|layer| emitter.emit(layer)),
        );
        emitted.map_err(PlanError::Sink)?;
        if let Some(NoTurn { layer, why }) = emitter.no_turn {
            return Err(PlanError::NoHelix { layer: layer + 1, why });
        }
        ready = filled?;
    }
    let Emitter { metrics, warnings, points, has_helix, memory, grown, .. } = emitter;
    let grown = grown.filter(|_| asks_how_it_grows).as_ref().map(Stack::grown);
    let forbids = warnings.summaries().filter(|w| w.kind.forbids()).map(WarningSummary::sentence);
    let forbidden = settings.forbidden.iter().cloned().chain(forbids).collect();
    let large = settings.limits.max_plan_points.filter(|most| points > *most as usize);
    let large = large.map(|most| format!("The plan has {points} points; the limit is {most} (check.max_plan_points)."));
    let asked = settings.filling.section.around == Some(Around::Helix) && settings.slicing.chart.goes_around();
    let open = (asked && !has_helix).then(|| NO_HELIX.to_owned());
    let balanced = settings.filling.laying.order.balance.map(|_| balanced(memory.detour(), settings.weld.travel.speed));
    let notes = large.into_iter().chain(open).chain(balanced).chain(settings.notes.iter().cloned()).collect();
    Ok(Summary { metrics, warnings, notes, forbidden, blocked: Vec::new(), grown })
}

/// What it costs to keep heat around the middle of the plate: `detour` is how much longer travels became, mm, at a speed in mm/s.
fn balanced(detour: f64, speed: f64) -> String {
    let (metres, seconds) = (detour.max(0.0) / 1e3, detour.max(0.0) / speed);
    format!(
        "Heat is kept around the middle of the plate (order.distortion): travels become {metres:.1} m longer and take \
         {seconds:.0} s more."
    )
}

/// Why there is no helix, though one was asked for.
const NO_HELIX: &str = "No layer is laid as a helix (fill.around): its islands must go all around the axis of a cylinder, between two \
                        edges that are rings, with room for whole beads and without holes, the strategy must not be wall, and the \
                        positioner must be able to turn as often as there are rings.";

fn check_layer_count<E>(mesh: &Mesh, layer_height: f64) -> Result<(), PlanError<E>> {
    let height = mesh.size().z;
    let layers = (height / layer_height) as usize;
    if layers > MAX_LAYERS {
        return Err(PlanError::TooManyLayers { height, layers, layer_height });
    }
    Ok(())
}
