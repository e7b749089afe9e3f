//! Which strategy a part is planned with: the profile's, or `wall` where the part is nothing but walls for one bead.

use super::charted;
use super::settings::PlanSettings;
use super::slicing::Slicing;
use crate::chart::warp::WarpError;
use crate::chart::{Chart, Plane};
use crate::fill::wall::Wall;
use crate::fill::{Path, Strategy, StrategyName, sound};
use crate::model::{Mesh, Part};
use crate::profile::{Predict, Profile};
use crate::slice::{Slab, Slice};
use crate::task::{Cancelled, Task};
use glam::DVec3;
use planar::{Join, Polygon, Region};

/// The profile that a part is planned with.
#[derive(Debug, Clone, PartialEq)]
pub struct Choice {
    /// The profile with the chosen strategy.
    pub profile: Profile,
    /// Why the strategy differs from the profile's, as a sentence.
    pub note: Option<String>,
}

/// Number of heights at which a part is examined.
const HEIGHTS: usize = 15;
/// Up to this fraction of the area may have room for two beads: thin walls are thicker where they meet.
const JUNCTIONS: f64 = 0.05;
/// A wall counts as thicker than the bead from this thickness, in bead widths.
const THICKER: f64 = 1.1;
/// Walls count as thicker than the bead if this fraction of their area does.
const MOSTLY: f64 = 0.8;

/// Chooses the strategy. Curves, and open surfaces that stand for walls, are always welded with `wall`. So is a solid, if the
/// profile says `loop` and the whole part is walls for one bead, unless the strategy is to be `kept`; their layers are as
/// high as their metal if they are thicker than the bead.
///
/// # Errors
/// [`Cancelled`].
pub fn choose(part: &Part, profile: &Profile, kept: bool, task: &Task) -> Result<Choice, Cancelled> {
    let mut profile = profile.clone();
    let mut note = None;
    if let Part::Mesh(import) = part {
        profile.layers.bodies.iter_mut().for_each(|body| body.find_solids(&import.objects));
        begin_where_it_does(&import.mesh, &mut profile);
    }
    match part {
        Part::Curves { .. } => profile.fill.strategy = StrategyName::Wall,
        Part::Mesh(import) if Slicing::of(&profile).is_wall(&import.mesh) => profile.fill.strategy = StrategyName::Wall,
        Part::Mesh(_) if kept => {}
        Part::Mesh(import) if !profile.layers.bodies.is_empty() => {
            let mut named = Vec::new();
            let unnamed = |k: &usize| profile.layers.bodies[*k].strategy.is_none();
            for k in (0..profile.layers.bodies.len()).filter(unnamed).collect::<Vec<_>>() {
                let own = profile.of_body(k);
                let mesh = profile.layers.bodies[k].of_mesh(&import.mesh);
                let found = of_solid(&mesh, &PlanSettings::of(&own), task)?;
                let body = &mut profile.layers.bodies[k];
                if let Some((strategy, predict)) = found {
                    (body.strategy, body.predict) = (Some(strategy), Some(predict));
                    named.push(body.name.clone());
                }
            }
            note = (!named.is_empty()).then(|| format!("{ALL_WALLS} ({}).", named.join(", ")));
            // What all bodies are filled with is the strategy of the plan.
            if let Some(Some(only)) = profile.layers.bodies.first().map(|body| body.strategy)
                && profile.layers.bodies.iter().all(|body| body.strategy == Some(only))
            {
                profile.fill.strategy = only;
            }
        }
        Part::Mesh(import) => {
            if let Some((strategy, predict)) = of_solid(&import.mesh, &PlanSettings::of(&profile), task)? {
                (profile.fill.strategy, profile.layers.predict) = (strategy, predict);
                note = Some(format!("{ALL_WALLS}; if you ask for loop by name, it is kept."));
            }
        }
    }
    Ok(Choice { profile, note })
}

/// Level layers of a part that begins above the table begin where the part does.
fn begin_where_it_does(mesh: &Mesh, profile: &mut Profile) {
    let raised = |chart: &Chart, mesh: &Mesh| {
        let low = mesh.bounds().0.z;
        let plane = Plane { origin: DVec3::Z * low, ..Plane::default() };
        (chart.is_level() && low.is_finite() && low > ON_TABLE).then_some(Chart::Plane(plane))
    };
    let layers = &mut profile.layers;
    for body in layers.bodies.iter_mut().filter(|body| body.chart.is_level()) {
        body.chart = raised(&body.chart, &body.of_mesh(mesh)).unwrap_or_else(|| body.chart.clone());
    }
    if layers.bodies.is_empty() {
        layers.chart = raised(&layers.chart, mesh).unwrap_or_else(|| layers.chart.clone());
    }
}

/// A part that begins no higher than this stands on the table, mm.
const ON_TABLE: f64 = 1e-3;

/// Why `loop` does not fill a part that it could fill.
const ALL_WALLS: &str = "Strategy wall instead of loop: all of the part is walls for one bead";

/// What fills a solid instead of `loop`, and when the heights of its layers are then predicted; `None` where it stays as it is.
fn of_solid(mesh: &Mesh, settings: &PlanSettings, task: &Task) -> Result<Option<(StrategyName, Predict)>, Cancelled> {
    if settings.strategy != StrategyName::Loop {
        return Ok(None);
    }
    let mesh = match charted::unrolled(mesh, settings.slicing.chart, task) {
        Err(WarpError::Cancelled(cancelled)) => return Err(cancelled),
        // The plan reports the reason.
        Err(_) => return Ok(None),
        Ok(mesh) => mesh,
    };
    let predict = |walls: Walls| match settings.layers.predict {
        Predict::Auto if walls == Walls::Thick => Predict::Never,
        as_it_is => as_it_is,
    };
    Ok(walls(&mesh, settings, task)?.map(|walls| (StrategyName::Wall, predict(walls))))
}

/// Walls for one bead.
#[derive(PartialEq)]
enum Walls {
    /// As thick as the bead or thinner: their layers rise as the bead does.
    Thin,
    /// Thicker than the bead, which is laid wider: their layers rise as their metal does.
    Thick,
}

/// The kind of walls, if one bead fits everywhere in a part, two hardly anywhere, and the part can be welded along the
/// middle of its walls; `None` otherwise.
fn walls(mesh: &Mesh, settings: &PlanSettings, task: &Task) -> Result<Option<Walls>, Cancelled> {
    let (low, high) = mesh.bounds();
    let height = (high.z - low.z) / HEIGHTS as f64;
    let slabs = (1..=HEIGHTS).map(|k| Slab { z: low.z + k as f64 * height, height }).collect();
    let slices = settings.slicing.slicer(mesh, slabs, task)?.all(task)?;
    let settings = settings.filling.first;
    let all: f64 = slices.iter().map(Slice::area).sum();
    // Area in which a bead of this width fits.
    let holding = |width: f64| -> f64 {
        let room = |slice: &Slice| {
            let region = Region::from_normalised(slice.islands.clone());
            region.offset(-width / 2.0, Join::ROUND).offset(width / 2.0, Join::ROUND).area()
        };
        slices.iter().map(room).sum()
    };
    if all == 0.0 || holding(settings.double()) > JUNCTIONS * all {
        return Ok(None);
    }
    // Teeth and ribs that are thin in places do not make a wall.
    let is_wall = |island: &Polygon| {
        let fill = Wall.fill(island, &settings);
        let paths: Vec<&Path> = fill.stages.iter().flatten().collect();
        sound::fault(&paths, island, settings.machining_allowance).is_none()
    };
    for slice in &slices {
        task.check()?;
        if !slice.islands.iter().all(is_wall) {
            return Ok(None);
        }
    }
    let thick = holding(THICKER * settings.bead.width) > MOSTLY * all;
    Ok(Some(if thick { Walls::Thick } else { Walls::Thin }))
}
