//! Parts that are welded as several bodies, one after another (`layers.bodies`): each is planned as a part of its own, in the
//! coordinates of its own chart, on the metal of those before it.

use super::beside::{Beside, Watch};
use super::charted::{self, Unrolled};
use super::row::{NUMBERED_APART, Row};
use super::support::Footing;
use super::warm::Warmth;
use super::{Header, PlanError, Sink, Summary, plan_at, slabs_of, warm};
use crate::chart::{Chart, warp};
use crate::layer::Extent;
use crate::model::{Mesh, PartRef};
use crate::profile::{Body, Profile};
use crate::slice::{Slab, Slicer};
use crate::task::Task;
use planar::{Polygon, Region};
use std::borrow::Cow;

/// A body with what it takes to plan it.
struct Own<'a> {
    body: &'a Body,
    profile: Cow<'a, Profile>,
    /// In space; around an axis and along a guide with what lies below its first layer.
    mesh: Mesh,
}

/// Plans a part as the bodies that its profile names, and hands all layers to `sink`, numbered consecutively.
///
/// # Errors
/// [`PlanError`], including [`PlanError::Body`] for a body of which nothing is there, or that cannot be planned.
pub(super) fn bodies_into<S: Sink + Send>(
    name: &str,
    part: PartRef,
    profile: &Profile,
    task: &Task,
    sink: &mut S,
) -> Result<Summary, PlanError<S::Error>> {
    let PartRef::Mesh { mesh, milled, onto } = part else { return Err(PlanError::ChartOfCurves) };
    if milled.is_some() {
        return Err(PlanError::PreformOfChart);
    }
    if profile.layers.bodies.len() > 1 && !profile.process.layers.is_empty() {
        return Err(PlanError::Parts(NUMBERED_APART));
    }
    let whole = [Body::of(name, profile.layers.chart.clone())];
    let bodies = if profile.layers.bodies.is_empty() { &whole[..] } else { &profile.layers.bodies };
    let bodies = bodies.iter().enumerate();
    let owned: Vec<Own<'_>> =
        bodies.map(|(k, body)| Own { body, profile: profile.of_body(k), mesh: body.of_mesh(mesh) }).collect();
    let ready = owned.iter().map(|own| Ready::of(own, task)).collect::<Result<Vec<_>, _>>()?;
    let bounds = ready.iter().map(|ready| ready.part().bounds()).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
    let (low, high) = bounds.unwrap_or_default();
    let extent = Extent { layers: ready.iter().map(|ready| ready.layers).sum(), low, high };
    let strategy = profile.fill.strategy.to_string();
    sink.begin(&Header { part: name.to_owned(), profile: profile.name.clone(), strategy, extent })
        .map_err(PlanError::Sink)?;
    let (mut row, mut beside) = (Row::new(profile, sink, owned.len() > 1), Beside::new(profile));
    if let Some(base) = onto {
        beside.finish(BASE, base);
    }
    for (k, (own, ready)) in owned.iter().zip(&ready).enumerate() {
        row.body = k;
        let under = owned[..k].iter().map(|other| &other.mesh).chain(onto);
        let footing = if k == 0 && onto.is_none() { Footing::Plate } else { own.footing(under, task)? };
        let mut watch = Watch::new(&mut row, &mut beside, own.body, &own.profile);
        let summary = ready.plan(footing, task, &mut watch)?;
        row.finish(&own.body.name, ready.layers, &summary);
        beside.finish(&own.body.name, &own.mesh);
    }
    let mut summary = row.summary(&format!("The part is welded as {} bodies, one after another", owned.len()));
    let volume = summary.metrics.mesh_volume_mm3;
    summary.notes.extend(missing(mesh, volume).filter(|_| !profile.layers.bodies.is_empty()));
    summary.notes.extend(beside.note());
    summary.forbidden.extend(beside.sentences());
    Ok(summary)
}

/// What messages call an existing part.
const BASE: &str = "the part that is there already";

/// Metal that belongs to no body, or to two, counts from this part of the whole.
const MISSING: f64 = 2e-3;

fn missing(mesh: &Mesh, bodies: Option<f64>) -> Option<String> {
    let (whole, bodies) = (mesh.volume(), bodies?);
    let missing = whole - bodies;
    (missing.abs() > MISSING * whole).then(|| {
        let what = if missing > 0.0 {
            "belong to no body and are not welded"
        } else {
            "belong to two bodies and would be welded twice"
        };
        format!(
            "{:.1} of {:.1} cm³ of the part {what} (layers.bodies: chart and within).",
            missing.abs() / 1e3,
            whole / 1e3
        )
    })
}

impl Own<'_> {
    fn part(&self) -> PartRef<'_> {
        PartRef::Mesh { mesh: &self.mesh, milled: None, onto: None }
    }

    fn wrong<E>(&self, reason: impl Into<String>) -> PlanError<E> {
        PlanError::Body { name: self.body.name.clone(), reason: reason.into() }
    }

    /// Errors of a body name it.
    fn named<E>(&self, error: PlanError<E>) -> PlanError<E> {
        match error {
            PlanError::Cancelled(_) | PlanError::Sink(_) => error,
            PlanError::Empty(reason) => self.wrong(reason),
            PlanError::Chart(torn) => self.wrong(torn.to_string()),
            other => other,
        }
    }

    /// What its first layer lies on.
    fn footing<'m, E>(&self, below: impl Iterator<Item = &'m Mesh>, task: &Task) -> Result<Footing, PlanError<E>> {
        let chart = &self.profile.layers.chart;
        if self.body.on_stock || chart.is_level() {
            return Ok(Footing::Plate);
        }
        let metal = below.map(|mesh| under(chart, mesh, &self.profile, task));
        let metal = metal.collect::<Result<Vec<_>, _>>()?;
        let metal = metal.into_iter().fold(Region::default(), |all, part| all.union(&part));
        Ok(Footing::Metal(metal.into_polygons()))
    }
}

/// A body in the coordinates of its chart, ready to be planned.
struct Ready<'a> {
    own: &'a Own<'a>,
    unrolled: Option<Unrolled<'a>>,
    warmth: Warmth,
    /// Number of layers.
    layers: usize,
}

impl<'a> Ready<'a> {
    fn of<E>(own: &'a Own<'a>, task: &Task) -> Result<Self, PlanError<E>> {
        if own.mesh.triangles.is_empty() {
            return Err(own.wrong("nothing of the part lies above all planes of its within."));
        }
        let unrolled = Unrolled::of(own.part(), &own.profile, task).map_err(|error| own.named(error))?;
        let mut ready = Self { own, unrolled, warmth: Warmth::default(), layers: 0 };
        ready.warmth = warm::predicted(ready.part(), &own.profile, task)?;
        ready.layers = slabs_of(&ready.warmth, ready.part(), &own.profile, task)?.len();
        Ok(ready)
    }

    fn part(&self) -> PartRef<'_> {
        self.unrolled.as_ref().map_or(self.own.part(), Unrolled::part)
    }

    fn plan<S: Sink + Send>(
        &self,
        footing: Footing,
        task: &Task,
        sink: &mut S,
    ) -> Result<Summary, PlanError<S::Error>> {
        let (own, part) = (self.own, self.part());
        let planned = plan_at(&self.warmth, &own.body.name, part, footing, &own.profile, task, sink);
        let mut summary = planned.map_err(|error| own.named(error))?;
        summary.forbidden.extend(charted::too_narrow(part.bounds().1.z, &own.profile));
        if let PartRef::Mesh { mesh, .. } = part {
            summary.notes.extend(charted::stretched(mesh, &own.profile.layers.chart));
        }
        Ok(summary)
    }
}

/// What of a mesh lies just under the first layer of a chart, as that layer's underside is unrolled.
fn under<E>(chart: &Chart, mesh: &Mesh, profile: &Profile, task: &Task) -> Result<Region, PlanError<E>> {
    let depth = profile.layers.height / 2.0;
    let lowered = chart.lowered(depth);
    let mesh = warp::warped(&lowered, mesh, charted::TOLERANCE, task)?;
    let slab = Slab { z: depth, height: depth };
    let slices = Slicer::of_slabs(&mesh, vec![slab], profile.slice_options(), task)?.on(&lowered).all(task)?;
    let islands: Vec<Polygon> = slices.into_iter().flat_map(|slice| slice.islands).collect();
    let (here, there) = (chart.sheet(0.0), chart.sheet(-depth / 2.0));
    let moved = islands.iter().map(|island| island.moved(|p| here.across(p, &there))).collect();
    Ok(Region::from_normalised(moved))
}
