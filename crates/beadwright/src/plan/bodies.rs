//! Parts that are welded as several bodies, one after another (`layers.bodies`): each is planned as a part of its own,
//! in the coordinates of its own chart, on the metal of the bodies before it.

use super::beside::{Beside, Watch};
use super::charted::{self, Unrolled};
use super::row::{NUMBERED_APART, Row};
use super::settings::PlanSettings;
use super::slicing::Slicing;
use super::support::{Footing, Under};
use super::warm::{Heat, Warmth};
use super::{Header, PlanError, Sink, Start, Summary, plan_at, slabs_of, warm};
use crate::chart::{Chart, warp};
use crate::layer::Extent;
use crate::model::{Mesh, PartRef};
use crate::profile::{Body, Profile};
use crate::slice::{Slab, Slicer};
use crate::task::Task;
use crate::warning::WarningKind;
use planar::{Polygon, Region};
use std::borrow::Cow;

/// A body with what it takes to plan it.
struct Own<'a> {
    body: &'a Body,
    settings: PlanSettings<'a>,
    /// In space; around an axis and along a guide, including what lies below its first layer.
    mesh: Mesh,
}

/// Plans a part as the bodies that its profile names, and hands all layers to `sink`, numbered consecutively.
///
/// # Errors
/// [`PlanError`], including [`PlanError::Body`] for a body that contains nothing of the part or cannot be planned.
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
    let profiles: Vec<Cow<'_, Profile>> = (0..bodies.len()).map(|k| profile.of_body(k)).collect();
    let owned = bodies.iter().zip(&profiles);
    let owned: Vec<Own<'_>> = owned
        .map(|(body, profile)| Own { body, settings: PlanSettings::of(profile), mesh: body.of_mesh(mesh) })
        .collect();
    let ready = owned.iter().map(|own| Ready::of(own, task)).collect::<Result<Vec<_>, _>>()?;
    let bounds = ready.iter().map(|ready| ready.part().bounds()).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
    let (low, high) = bounds.unwrap_or_default();
    let extent = Extent { layers: ready.iter().map(|ready| ready.slabs.len()).sum(), low, high };
    let whole = &PlanSettings::of(profile);
    let strategy = whole.strategy.to_string();
    sink.begin(&Header { part: name.to_owned(), profile: whole.profile.to_owned(), strategy, extent })
        .map_err(PlanError::Sink)?;
    let (mut row, mut beside) = (Row::new(whole, sink, owned.len() > 1), Beside::new(whole.torch));
    if let Some(base) = onto {
        beside.begin_on(BASE, base);
    }
    let placed = ready.iter().filter_map(|ready| match ready.part() {
        PartRef::Mesh { mesh, .. } => Some((ready.own.settings.slicing.chart, mesh)),
        PartRef::Curves(..) => None,
    });
    let mut heat = (owned.len() > 1 || !whole.layers.are_level()).then(|| Heat::of_bodies(&whole.warming, placed));
    for (k, (own, ready)) in owned.iter().zip(&ready).enumerate() {
        row.body = k;
        let under = owned[..k].iter().map(|other| &other.mesh).chain(onto);
        let footing = if k == 0 && onto.is_none() {
            ready.in_order(&owned[1..], task)?;
            Footing::PLATE
        } else {
            ready.footing(under, task)?
        };
        let mut watch = Watch::new(&mut row, &mut beside, (k, &own.body.name), &own.settings);
        let start =
            Start { warmth: &ready.warmth, footing, heat: heat.as_mut().map(|heat| heat.before(k, &ready.warmth)) };
        let summary = ready.plan(start, task, &mut watch)?;
        row.finish(&own.body.name, ready.slabs.len(), &summary);
        beside.finish(k, &own.body.name, &own.mesh);
    }
    let mut summary = row.summary(&format!("The part is welded as {} bodies, one after another", owned.len()));
    summary.notes.extend(beside.note());
    summary.notes.extend(owned.first().filter(|_| onto.is_none()).and_then(Own::on_what_is_there));
    summary.forbidden.extend(beside.sentences());
    summary.blocked = beside.blocked();
    let twice = welded_twice(mesh, &owned);
    // What lies below a body on stock is already there.
    let bodies = &whole.layers.bodies;
    let counts = !bodies.is_empty() && !bodies.iter().any(|body| body.on_stock) && twice.is_empty();
    if let Some(missing) = missing(mesh, summary.metrics.mesh_volume_mm3).filter(|_| counts) {
        // The likely reason why passes lie in the air.
        let hang = summary.warnings.summaries().any(|warning| IN_THE_AIR.contains(&warning.kind));
        let to = if hang { &mut summary.forbidden } else { &mut summary.notes };
        to.insert(0, missing);
    }
    summary.forbidden.splice(0..0, twice);
    Ok(summary)
}

/// Warnings of passes with nothing below.
const IN_THE_AIR: [WarningKind; 4] =
    [WarningKind::InTheAir, WarningKind::OverUnwelded, WarningKind::NothingBelow, WarningKind::HighStart];

/// What messages call an existing part.
const BASE: &str = "the part that is there already";

/// Metal that belongs to no body, or to two, is reported from this fraction of the whole.
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
            "{:.1} of {:.1} cm³ of the part {what} (layers.bodies: chart, within and solids).",
            missing.abs() / 1e3,
            whole / 1e3
        )
    })
}

/// Which bodies share metal that both would weld, as sentences. Around an axis and along a guide the mesh of a body
/// includes what lies below its first layer, and solids may overlap.
fn welded_twice(whole: &Mesh, bodies: &[Own<'_>]) -> Vec<String> {
    let by_planes = |own: &&Own<'_>| matches!(own.body.chart, Chart::Plane(_)) && own.body.solids.is_empty();
    let bodies: Vec<&Own<'_>> = bodies.iter().filter(by_planes).collect();
    let pairs = bodies.iter().enumerate().flat_map(|(k, own)| bodies[k + 1..].iter().map(move |other| (own, other)));
    let shared = |(own, other): (&&Own<'_>, &&Own<'_>)| {
        let common = other.body.of_mesh(&own.mesh);
        let ((low, high), volume) = (common.bounds(), common.volume());
        let at = (low + high) / 2.0;
        (volume > MISSING * whole.volume().abs()).then(|| {
            format!(
                "Bodies \"{}\" and \"{}\" have {:.1} cm³ in common, around x {:.1} y {:.1} z {:.1} mm, which would be welded twice; \
                 the second time, the torch would run into finished metal. Separate them by planes or cylinders (within).",
                own.body.name,
                other.body.name,
                volume / 1e3,
                at.x,
                at.y,
                at.z
            )
        })
    };
    pairs.filter_map(shared).collect()
}

impl Own<'_> {
    /// A note that the first body rests on something that the plan cannot know.
    fn on_what_is_there(&self) -> Option<String> {
        let leans = matches!(self.body.chart, Chart::Plane(_)) && !self.body.chart.is_level() && !self.body.on_stock;
        leans.then(|| {
            format!(
                "The first layer of \"{}\" is not level, so it cannot lie on the plate: it must lie on metal that is there already (on_stock = \
                 true says that it does).",
                self.body.name
            )
        })
    }

    fn part(&self) -> PartRef<'_> {
        PartRef::Mesh { mesh: &self.mesh, milled: None, onto: None }
    }

    fn wrong<E>(&self, reason: impl Into<String>) -> PlanError<E> {
        PlanError::Body { name: self.body.name.clone(), reason: reason.into() }
    }

    /// Errors of a body get its name.
    fn named<E>(&self, error: PlanError<E>) -> PlanError<E> {
        match error {
            PlanError::Cancelled(_) | PlanError::Sink(_) => error,
            PlanError::Empty(reason) => self.wrong(reason),
            PlanError::Chart(torn) => self.wrong(torn.to_string()),
            other => other,
        }
    }
}

/// A body in the coordinates of its chart, ready to be planned.
struct Ready<'a> {
    own: &'a Own<'a>,
    unrolled: Option<Unrolled<'a>>,
    warmth: Warmth,
    slabs: Vec<Slab>,
}

impl<'a> Ready<'a> {
    fn of<E>(own: &'a Own<'a>, task: &Task) -> Result<Self, PlanError<E>> {
        if let Some(name) = own.body.unknown_solid() {
            let why = "or its solids were not found: write a point on each instead, x/y/z in mm";
            return Err(own.wrong(format!("no object of the model is named \"{name}\", {why}.")));
        }
        if own.mesh.triangles.is_empty() {
            return Err(own.wrong("nothing of the part belongs to it: look at its chart, within and solids."));
        }
        let unrolled = Unrolled::of(own.part(), &own.settings.slicing, task).map_err(|error| own.named(error))?;
        let mut ready = Self { own, unrolled, warmth: Warmth::default(), slabs: Vec::new() };
        ready.warmth = warm::predicted(ready.part(), &own.settings, task)?;
        ready.slabs = slabs_of(&ready.warmth, ready.part(), &own.settings, task)?;
        Ok(ready)
    }

    fn part(&self) -> PartRef<'_> {
        self.unrolled.as_ref().map_or(self.own.part(), Unrolled::part)
    }

    /// What its layers lie on, apart from one another.
    fn footing<'m, E>(&self, others: impl Iterator<Item = &'m Mesh>, task: &Task) -> Result<Footing, PlanError<E>> {
        let Own { body, settings: PlanSettings { slicing, .. }, .. } = self.own;
        let mut metal: Vec<Under> = Vec::new();
        for mesh in others {
            let of_mesh = under_layers(mesh, &self.slabs, slicing, task)?;
            if metal.is_empty() {
                metal = of_mesh;
            } else {
                let more = metal.iter_mut().zip(of_mesh);
                more.for_each(|(under, more)| under.outlines.extend(more.outlines));
            }
        }
        Ok(Footing { plate: body.on_stock || slicing.chart.is_level(), metal })
    }

    /// Refuses a body whose first layer lies on one that is welded after it.
    fn in_order<E>(&self, later: &[Own<'_>], task: &Task) -> Result<(), PlanError<E>> {
        let (Own { body, settings: PlanSettings { slicing, .. }, .. }, PartRef::Mesh { mesh, .. }) =
            (self.own, self.part())
        else {
            return Ok(());
        };
        let begins = |slab: &&Slab| slab.z > mesh.bounds().0.z;
        let Some(first) = self.slabs.iter().find(begins).filter(|_| !body.on_stock) else { return Ok(()) };
        let own: Vec<Polygon> =
            slicing.slicer(mesh, vec![*first], task)?.all(task)?.into_iter().flat_map(|slice| slice.islands).collect();
        let own = Region::from_normalised(own);
        // Around an axis and along a guide the mesh of a body includes what lies below its first layer.
        let whole = |other: &&Own<'_>| matches!(other.body.chart, Chart::Plane(_) | Chart::Surface(_));
        for other in later.iter().filter(whole) {
            let under = under_layers(&other.mesh, &[*first], slicing, task)?;
            let outlines = under.into_iter().flat_map(|under| under.outlines).collect();
            if own.intersection(&Region::from_normalised(outlines)).area() > LIES_ON * own.area() {
                let name = &other.body.name;
                let reason = format!(
                    "its first layer lies on \"{name}\", which is welded after it: list bodies in the order in which they are welded."
                );
                return Err(self.own.wrong(reason));
            }
        }
        Ok(())
    }

    fn plan<S: Sink + Send>(&self, start: Start, task: &Task, sink: &mut S) -> Result<Summary, PlanError<S::Error>> {
        let (own, part) = (self.own, self.part());
        let planned = plan_at(start, &own.body.name, part, &own.settings, task, sink);
        let mut summary = planned.map_err(|error| own.named(error))?;
        summary.forbidden.extend(charted::too_narrow(
            part.bounds().1.z,
            own.settings.slicing.chart,
            &own.settings.weld,
        ));
        if let PartRef::Mesh { mesh, .. } = part {
            summary.notes.extend(charted::stretched(mesh, own.settings.slicing.chart));
        }
        Ok(summary)
    }
}

/// A body lies on another if this fraction of its first layer does.
const LIES_ON: f64 = 0.25;

/// How far below the first layer metal may lie, as a fraction of a layer's height.
const GAP: f64 = 0.25;
/// How far below any other layer: where layers wedge out on a slope, the last one below ends where half of it would not
/// fit.
const WEDGED: f64 = 0.55;

/// The parts of a mesh that lie just under each layer.
fn under_layers<E>(mesh: &Mesh, slabs: &[Slab], slicing: &Slicing, task: &Task) -> Result<Vec<Under>, PlanError<E>> {
    let Slicing { options, chart, .. } = *slicing;
    let usual = options.layer_height;
    let lowered = chart.lowered(usual);
    let mesh = warp::unrolled(&lowered, mesh, charted::TOLERANCE, task)?;
    let gap = |k: usize, slab: &Slab| if k == 0 { GAP * usual } else { WEDGED * slab.height };
    let cuts: Vec<(f64, f64)> =
        slabs.iter().enumerate().map(|(k, slab)| (slab.z - slab.height, gap(k, slab))).collect();
    // Slabs are cut at their middle height.
    let thin = GAP * usual;
    let thin = |(height, gap): &(f64, f64)| Slab { z: height + usual - gap + thin / 2.0, height: thin };
    let slicer = Slicer::of_slabs(&mesh, cuts.iter().map(thin).collect(), options, task)?;
    let under = slicer.on(&lowered).all(task)?.into_iter().zip(cuts).map(|(slice, (height, gap))| {
        let (here, there) = (chart.sheet(height), chart.sheet(height - gap));
        let outlines = slice.islands.iter().map(|island| island.moved(|p| here.across(p, &there))).collect();
        Under { outlines, height }
    });
    Ok(under.collect())
}
