//! The front door: a mesh and a profile become a [`Plan`], layer by layer in deposition order.
//!
//! [`plan_into`] streams: each finished layer goes to a sink and is forgotten, so a part of thousands of layers
//! needs the memory of the mesh plus [`BATCH`] layers. [`plan`] collects the layers. A wall may
//! be given by its centre-lines instead of a solid.
//!
//! | file | what it does |
//! | --- | --- |
//! | [`clearance`] | whether the torch has room beside parts that stand |
//! | `parts` | parts that are welded one after another |
//! | `centre_lines` | walls of one bead by their centre-lines |
//! | `candidates` | what fills an island that its strategy cannot |
//! | [`choice`] | which strategy a part is planned with |
//! | `emitter` | hands layers over, in order, with the limits of heat and warnings |
//! | [`expected`](expected()) | about how much a plan will hold |
//! | `filled` | a slice with its passes, and the places in it that a bead cannot reach |
//! | `helix` | one helix in place of closed walls |
//! | `level_layers` | layers of solids as high as their metal, which is shared out within them |
//! | `levels` | where the layers of a wall lie |
//! | [`preview`] | one layer ahead of the others |
//! | `warm` | what heat does to the width of beads and to the layers of a wall |
//! | `support` | whether passes lie on the metal below |
//! | `scan_lines` | best raster angles, and which parts of a sparse infill are solid |

mod candidates;
mod centre_lines;
pub mod choice;
pub mod clearance;
mod emitter;
mod expected;
mod filled;
mod helix;
mod level_layers;
mod levels;
mod parts;
mod preview;
mod relight;
mod scan_lines;
mod support;
pub mod warm;

pub use expected::{Expected, expected};
pub use parts::{parts_into, torch_of};
pub use preview::preview;
pub use scan_lines::{ToFill, raster_angle};

use crate::bead::wall::WallError;
use crate::deposit::{DepositSettings, Figures, Nominal, Stack};
use crate::fill::{self, Strategy};
use crate::layer::{Extent, Layer};
use crate::metrics::Metrics;
use crate::model::holes::{self, Opening};
use crate::model::wall_curves::WallCurves;
use crate::model::{Mesh, PartRef};
use crate::order;
use crate::profile::Profile;
use crate::slice::{self, BATCH, LayerFit, Slab, Slicer};
use crate::task::{Cancelled, Stage, Task};
use crate::warning::{WarningKind, WarningSummary, Warnings};
use crate::weld;
use centre_lines::{weld_curves, weld_lines};
use emitter::Emitter;
use filled::Filled;
use glam::{DVec2, DVec3};
use helix::{Helix, NoTurn};
use planar::Bounds;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::convert::Infallible;
use support::Support;
use warm::{Heat, Warmth};

/// A layer as it is welded, for the deposit model: with overlaps, hot starts, lead-outs, humps and craters where the
/// profile has them.
pub fn welded<'a>(layer: &'a Layer, profile: &Profile) -> Cow<'a, Layer> {
    let ends = weld::lit_ends(&profile.start_stop, layer.lit);
    if !ends.changes_passes() {
        return Cow::Borrowed(layer);
    }
    let passes = layer.passes.iter().map(|pass| weld::welded(pass, &ends, profile.bead.height)).collect();
    Cow::Owned(Layer { passes, ..layer.clone() })
}

/// The deposit model's settings for plans made with a profile.
pub fn deposit_settings(profile: &Profile) -> DepositSettings {
    let (bead, pace) = (profile.bead(), profile.process.deposition_speed);
    let nominal = Nominal { bead, pace, rise: bead.rise(profile.stepover()) };
    DepositSettings::new(nominal, profile.fill.machining_allowance)
}

/// Like [`deposit_settings`], with a grid fitted to a part: its lowest and its highest place, mm.
pub fn deposit_settings_over(profile: &Profile, part: (DVec3, DVec3)) -> DepositSettings {
    let (bounds, layers) = grid_over(profile, part);
    deposit_settings(profile).fitted_to(&bounds, layers)
}

/// What the grid for a part is fitted to: the box around it seen from above, and about how many layers it takes.
pub fn grid_over(profile: &Profile, (low, high): (DVec3, DVec3)) -> (Bounds, usize) {
    (Bounds { min: low.truncate(), max: high.truncate() }, (high.z / profile.layers.height) as usize)
}

/// What is the same for all layers of a plan.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Header {
    /// Name of the part, for files and headings.
    pub part: String,
    /// Name of the profile.
    pub profile: String,
    /// Name of the strategy.
    pub strategy: String,
    /// How many layers the part has, and where it lies.
    pub extent: Extent,
}

/// A whole plan.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// What is the same for all layers.
    pub header: Header,
    /// The layers, lowest first.
    pub layers: Vec<Layer>,
    /// Totals and warnings.
    pub summary: Summary,
}

/// Totals and warnings of a plan.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// The totals.
    pub metrics: Metrics,
    /// Events on layers.
    pub warnings: Warnings,
    /// What does not fit in the profile, as sentences.
    pub notes: Vec<String>,
    /// Why its programs should not be written, as sentences; empty for a plan that can be welded.
    pub forbidden: Vec<String>,
}

impl Summary {
    /// The totals, warnings and notes, and what the deposit model says: the content of `metrics.json`.
    pub fn json(&self, figures: Option<&Figures>) -> serde_json::Value {
        let warnings: Vec<_> = self.warnings.summaries().collect();
        let mut value = serde_json::json!(self.metrics);
        value["coverage"] = self.metrics.coverage().into();
        value["warnings"] = serde_json::json!(warnings);
        value["notes"] = serde_json::json!(self.notes);
        value["forbidden"] = serde_json::json!(self.forbidden);
        value["deposit"] = serde_json::json!(figures.map(Figures::summary));
        value
    }
}

/// Why a plan could not be made. `E` is the error of the sink.
#[derive(Debug, thiserror::Error)]
pub enum PlanError<E> {
    /// Stopped by the caller.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The profile names a strategy that does not exist.
    #[error("there is no strategy \"{0}\". The strategies are {known}.", known = fill::STRATEGIES.map(|s| s.name()).join(", "))]
    UnknownStrategy(String),
    /// The plan would be too large.
    #[error(
        "the part is {height:.0} mm high and would take {layers} layers of {layer_height} mm; at most {MAX_LAYERS} are planned. Check the unit of the file and layers.height."
    )]
    TooManyLayers {
        /// Height of the part, mm.
        height: f64,
        /// Number of layers.
        layers: usize,
        /// Thickness of a layer, mm.
        layer_height: f64,
    },
    /// The bead gives no wall.
    #[error(transparent)]
    Wall(#[from] WallError),
    /// A surface that is not closed, of which nobody said what it stands for.
    #[error(
        "the surface of the part is open: near x {:.1} y {:.1} z {:.1} mm by {width:.1} mm. If it is the skin of a solid, close it \
         (`inspect --repair --fill-holes MM`), or say --surface solid (slice.surface), which fills what its contours enclose and leaves \
         out those that do not close. If it stands for a wall, say --surface wall, which lays one bead along it.", .place.x, .place.y, .place.z
    )]
    Open {
        /// Width of the widest opening, mm.
        width: f64,
        /// A place on it, mm.
        place: DVec3,
    },
    /// Nothing would be laid.
    #[error("nothing would be deposited: {0}")]
    Empty(String),
    /// A layer that is not one closed wall, though all are to be turns of a helix.
    #[error(
        "layer {layer} cannot be a turn of the helix that wall.helix asks for: {why}. Leave wall.helix out, plan a surface as walls \
         (--surface wall), or plan the part up to there."
    )]
    NoHelix {
        /// Number of the layer, from 1.
        layer: usize,
        /// Why, as a clause.
        why: String,
    },
    /// Parts cannot be welded one after another with this profile.
    #[error("the parts cannot be welded one after another: {0}")]
    Parts(&'static str),
    /// The sink failed.
    #[error(transparent)]
    Sink(E),
}

/// No plan has more layers than this.
pub const MAX_LAYERS: usize = 100_000;

/// Receives the layers of a plan in deposition order.
pub trait Sink {
    /// What can go wrong while a layer is taken in.
    type Error: Send;

    /// Called once, before the first layer.
    ///
    /// # Errors
    /// Whatever the sink fails with; planning then stops.
    fn begin(&mut self, header: &Header) -> Result<(), Self::Error>;

    /// Takes the next layer.
    ///
    /// # Errors
    /// Whatever the sink fails with; planning then stops.
    fn layer(&mut self, layer: Layer) -> Result<(), Self::Error>;
}

/// Keeps the layers of a plan.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Collect {
    /// What is the same for all layers; `None` before the plan begins.
    pub header: Option<Header>,
    /// The layers so far.
    pub layers: Vec<Layer>,
}

impl Sink for Collect {
    type Error = Infallible;

    fn begin(&mut self, header: &Header) -> Result<(), Infallible> {
        self.header = Some(header.clone());
        Ok(())
    }

    fn layer(&mut self, layer: Layer) -> Result<(), Infallible> {
        self.layers.push(layer);
        Ok(())
    }
}

/// Plans a part that stands on z = 0, either a solid or a wall given by curves, and keeps all layers. `name` is used
/// for files and headings.
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
    let part = part.into();
    plan_at(&warm::foretold(part, profile, task)?, name, part, profile, task, sink)
}

/// Plans a part whose layers follow a known warmth.
fn plan_at<S: Sink + Send>(
    warmth: &Warmth,
    name: &str,
    part: PartRef,
    profile: &Profile,
    task: &Task,
    sink: &mut S,
) -> Result<Summary, PlanError<S::Error>> {
    match part {
        PartRef::Mesh(mesh) => plan_mesh(warmth, name, mesh, strategy_of(profile)?, profile, task, sink),
        PartRef::Curves(curves, height) => plan_curves(warmth, name, curves, height, profile, task, sink),
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
    let warmth = warm::foretold(PartRef::Mesh(mesh), profile, task)?;
    plan_mesh(&warmth, name, mesh, strategy, profile, task, sink)
}

fn plan_mesh<S: Sink + Send>(
    warmth: &Warmth,
    name: &str,
    mesh: &Mesh,
    strategy: &dyn Strategy,
    profile: &Profile,
    task: &Task,
    sink: &mut S,
) -> Result<Summary, PlanError<S::Error>> {
    let opening = holes::openings(mesh).into_iter().next();
    let wide = opening.filter(|opening| opening.width > profile.bead.width);
    let unsaid = profile.slice.surface.is_none();
    if let Some(Opening { width, place, .. }) = wide.filter(|_| unsaid) {
        return Err(PlanError::Open { width, place });
    }
    let is_wall = choice::is_wall_surface(mesh, profile);
    let slabs = slabs_at(warmth, mesh, profile, task)?;
    let left = left_over(mesh, &slabs, profile);
    let (low, high) = mesh.bounds();
    let heat = Heat::of(profile, &Bounds { min: low.truncate(), max: high.truncate() }, &slabs, warmth);
    let slicer = Slicer::of_slabs(mesh, slabs, profile.slice_options(), task)?;
    let datum = middle(mesh);
    let fill_batch = |batch: usize| -> Result<Vec<Filled>, Cancelled> {
        if is_wall {
            return Ok(slicer.lines(batch, task)?.into_par_iter().map(|lines| weld_lines(lines, profile)).collect());
        }
        let planned = scan_lines::planned(batch, &slicer, strategy, profile, task)?;
        filled::fill_batch(planned, strategy, profile, datum, task)
    };
    let (low, high) = mesh.bounds();
    let extent = Extent { layers: slicer.layer_count(), low, high };
    let mut summary = run([name, strategy.name()], extent, heat, profile, task, sink, fill_batch)?;
    if summary.metrics.passes == 0 {
        return Err(PlanError::Empty(why_empty(&summary, mesh, profile)));
    }
    summary.metrics.mesh_volume_mm3 = Some(mesh.volume()).filter(|volume| opening.is_none() && *volume > 0.0);
    let volumes = if is_wall { None } else { other_volume(&summary, mesh.volume(), left.is_some()) };
    summary.notes.splice(0..0, left.into_iter().chain(volumes));
    if unsaid {
        let torn = |w: &&WarningSummary| {
            w.kind == WarningKind::OpenContourDropped && w.largest.size > TORN * profile.bead.width
        };
        let torn = summary.warnings.summaries().find(torn).map(WarningSummary::sentence);
        summary
            .forbidden
            .extend(torn.map(|torn| format!("{torn} --surface solid goes on without what does not close.")));
    }
    Ok(summary)
}

/// A contour that does not close and is longer than this, in bead widths, is a part of the solid that would be missing.
const TORN: f64 = 4.0;

/// Why the slices hold another volume than the mesh, as a sentence where it matters; `left` tells whether the layers end
/// elsewhere than the part.
fn other_volume(summary: &Summary, mesh: f64, left: bool) -> Option<String> {
    /// Fraction of the mesh's volume.
    const WORTH_TELLING: f64 = 0.01;
    let slices = summary.metrics.part_volume_mm3;
    let more = slices / mesh - 1.0;
    if more.abs() <= WORTH_TELLING || mesh <= 0.0 {
        return None;
    }
    let had = |kind| summary.warnings.summaries().any(|w| w.kind == kind);
    let why = if summary.metrics.mesh_volume_mm3.is_none() {
        "the surface is not closed, so the mesh's volume is a guess"
    } else if had(WarningKind::ContoursUnited) && more < 0.0 {
        "shells overlap, and the mesh counts twice what the slices count once"
    } else if had(WarningKind::OpenContourDropped) {
        "contours that are not closed were dropped"
    } else if left {
        "the layers do not end where the part does"
    } else {
        "each layer is as the part is at its middle; thinner layers follow the part more closely"
    };
    let percent = 100.0 * more;
    Some(format!("The slices hold {:.2} cm³, the mesh {:.2} cm³ ({percent:+.1} %): {why}.", slices / 1e3, mesh / 1e3))
}

/// Why a solid gives no passes: what was dropped on the way, or its width.
fn why_empty(summary: &Summary, mesh: &Mesh, profile: &Profile) -> String {
    let told = |kind| summary.warnings.summaries().find(|w| w.kind == kind).map(WarningSummary::sentence);
    let size = mesh.size();
    let part = format!("the part is {:.1} × {:.1} × {:.1} mm", size.x, size.y, size.z);
    if summary.metrics.slice_area_mm2 == 0.0 {
        return match told(WarningKind::OpenContourDropped) {
            Some(open) => format!("the surface of the model is not closed. {open}"),
            None => told(WarningKind::Sliver).or(told(WarningKind::ContoursUnited)).map_or_else(
                || format!("the slices are empty ({part}). Surfaces of opposite sense cancel: check that the model is a solid."),
                |lost| format!("the slices are empty. {lost}"),
            ),
        };
    }
    let width = profile.bead.width;
    let remedy = "Take a narrower bead or a larger part, or check the unit of the file.";
    match told(WarningKind::PassTooShort) {
        Some(short) => {
            format!(
                "what is wide enough for a bead of {width} mm gives passes too short to weld ({part}). {short} {remedy}"
            )
        }
        None => format!("no part of the slices is wide enough for a bead of {width} mm ({part}). {remedy}"),
    }
}

/// How far the last layer ends below or above the part, as a sentence where it matters.
fn left_over(mesh: &Mesh, slabs: &[Slab], profile: &Profile) -> Option<String> {
    /// Fraction of the height.
    const WORTH_TELLING: f64 = 0.005;
    let (top, last) = (mesh.bounds().1.z, slabs.last()?.z);
    let (left, percent) = ((top - last).abs(), 100.0 * (top - last).abs() / top);
    if left <= WORTH_TELLING * top {
        return None;
    }
    let layers = if slabs.len() == 1 { "its layer ends".to_owned() } else { format!("its {} layers end", slabs.len()) };
    let ends = format!("The part is {top:.2} mm high, {layers} at {last:.2} mm");
    Some(if last < top {
        let even = slice::fitted_slabs(mesh, profile.layers.height, LayerFit::Even);
        let each = even.first().map_or(0.0, |slab| slab.height);
        format!(
            "{ends}: the upper {left:.2} mm ({percent:.1} %) are not built. layers.fit = \"last\" adds a layer, \"even\" \
             makes {} layers of {each:.3} mm.",
            even.len()
        )
    } else {
        format!("{ends}: {left:.2} mm ({percent:.1} %) above it.")
    })
}

/// The middle of a part, seen from above.
fn middle(mesh: &Mesh) -> DVec2 {
    let (low, high) = mesh.bounds();
    low.midpoint(high).truncate()
}

/// The strategy of a profile.
fn strategy_of<E>(profile: &Profile) -> Result<&'static dyn Strategy, PlanError<E>> {
    let name = &profile.fill.strategy;
    fill::strategy(name).ok_or_else(|| PlanError::UnknownStrategy(name.clone()))
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
    let part = part.into();
    let warmth = warm::foretold(part, profile, task)?;
    match part {
        PartRef::Mesh(mesh) => slabs_at(&warmth, mesh, profile, task),
        PartRef::Curves(curves, height) => Ok(levels::of_curves(curves, height, &profile.single_wall()?, &warmth)),
    }
}

/// Where the layers of a mesh lie that is so warm.
fn slabs_at<E>(warmth: &Warmth, mesh: &Mesh, profile: &Profile, task: &Task) -> Result<Vec<Slab>, PlanError<E>> {
    check_layer_count(mesh, profile)?;
    Ok(match profile.wall_bead()? {
        Some(wall) => levels::of_mesh(mesh, &wall, warmth, profile, task)?,
        None if profile.is_level() => level_layers::slabs(mesh, strategy_of(profile)?, profile, task)?,
        None => slice::fitted_slabs(mesh, profile.layers.height, profile.layers.fit),
    })
}

/// Plans a wall one bead thick along curves, up to `height` (mm).
fn plan_curves<S: Sink + Send>(
    warmth: &Warmth,
    name: &str,
    curves: &WallCurves,
    height: f64,
    profile: &Profile,
    task: &Task,
    sink: &mut S,
) -> Result<Summary, PlanError<S::Error>> {
    let slabs = levels::of_curves(curves, height, &profile.single_wall()?, warmth);
    let bounds = curves.bounds(height).unwrap_or(Bounds { min: DVec2::ZERO, max: DVec2::ZERO });
    let (low, high) = (bounds.min.extend(0.0), bounds.max.extend(height));
    let extent = Extent { layers: slabs.len(), low, high };
    let heat = Heat::of(profile, &bounds, &slabs, warmth);
    let fill_batch = |batch: usize| -> Result<Vec<Filled>, Cancelled> {
        let layers = batch * BATCH..((batch + 1) * BATCH).min(slabs.len());
        let fill = |index: usize| {
            task.check()?;
            Ok(weld_curves(curves, index, slabs[index], profile))
        };
        layers.into_par_iter().map(fill).collect()
    };
    let summary = run([name, &profile.fill.strategy], extent, heat, profile, task, sink, fill_batch)?;
    if summary.metrics.passes == 0 {
        return Err(PlanError::Empty(
            "each curve is shorter than fill.min_pass_length, or than the distance within which ends meet \
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
    heat: Heat,
    profile: &Profile,
    task: &Task,
    sink: &mut S,
    fill_batch: impl Fn(usize) -> Result<Vec<Filled>, Cancelled> + Sync,
) -> Result<Summary, PlanError<S::Error>> {
    let [part, strategy] = [part, strategy].map(str::to_owned);
    let header = Header { part, profile: profile.name.clone(), strategy, extent };
    sink.begin(&header).map_err(PlanError::Sink)?;
    let mut emitter = Emitter {
        profile,
        sink,
        torch: None,
        heat,
        memory: order::Memory::default(),
        helix: profile.wall.helix.then(|| Helix::new(extent.layers, profile.longest_pass())),
        no_turn: None,
        support: Support::default(),
        grown: profile.is_level().then(|| {
            let (low, high) = (extent.low, extent.high);
            let bounds = Bounds { min: low.truncate(), max: high.truncate() };
            Stack::new(&bounds, deposit_settings_over(profile, (low, high)))
        }),
        below: Vec::new(),
        built: 0.0,
        points: 0,
        metrics: Metrics::new(profile),
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
    let Emitter { metrics, warnings, points, .. } = emitter;
    let forbids = warnings.summaries().filter(|w| w.kind.forbids()).map(WarningSummary::sentence);
    let forbidden = profile.forbidden().into_iter().chain(forbids).collect();
    let large = profile.check.max_plan_points.filter(|most| points > *most as usize);
    let large = large.map(|most| format!("The plan has {points} points; {most} are the most (check.max_plan_points)."));
    Ok(Summary { metrics, warnings, notes: large.into_iter().chain(profile.notes()).collect(), forbidden })
}

fn check_layer_count<E>(mesh: &Mesh, profile: &Profile) -> Result<(), PlanError<E>> {
    let (height, layer_height) = (mesh.size().z, profile.layers.height);
    let layers = (height / layer_height) as usize;
    if layers > MAX_LAYERS {
        return Err(PlanError::TooManyLayers { height, layers, layer_height });
    }
    Ok(())
}
