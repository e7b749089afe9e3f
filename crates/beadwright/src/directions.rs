//! Ways to divide a part into bodies, each planned for trial, so that what is offered first can be welded.

pub use bead_part::directions::{Division, Piece, Settings, by_planes, divisions};

use crate::metrics::Metrics;
use crate::model::Mesh;
use crate::plan::{Header, PlanError, Sink, plan_into};
use crate::profile::{Body, Profile};
use crate::task::{Cancelled, Task};
use std::cmp::Ordering;
use std::convert::Infallible;

/// A division, and what came of planning it.
#[derive(Debug, Clone, PartialEq)]
pub struct Tried {
    /// How the part is divided.
    pub division: Division,
    /// The same as bodies for `layers.bodies`.
    pub bodies: Vec<Body>,
    /// What came of planning it.
    pub outcome: Outcome,
}

/// What came of planning a division.
#[derive(Debug, Clone, PartialEq)]
pub enum Outcome {
    /// It can be welded.
    Planned(Box<Metrics>),
    /// It cannot: the first reason, as a sentence.
    Refused(String),
    /// It was not planned, since another can be welded.
    Untried,
}

/// Divisions of a part.
#[derive(Debug, Clone, PartialEq)]
pub struct Found {
    /// Those that can be welded come first; of these the ones with less overhang, without metal that must be there already,
    /// with less left bare, and then the cheaper ones. The last is the whole part in level layers, which is planned only if no
    /// other can be welded.
    pub divisions: Vec<Tried>,
    /// If nothing can be welded: what could be if its layers may lie farther from level than [`Settings::tilt`].
    pub tilted: Option<Tried>,
}

/// Divides a part that stands on the table, and plans it in each way until one can be welded: as what is recognized in it, in
/// pieces cut off by planes, in level layers. `name` is that of a part in one piece.
///
/// ```
/// use beadwright::directions::{Outcome, Settings, tried};
/// use beadwright::{Profile, Task, example};
///
/// let profile = Profile::built_in("cmt-steel-abb")?;
/// let hub = example::find("hub").ok_or("no such example")?.mesh();
/// let settings = Settings { lean: 45.0, tilt: 90.0, bead: profile.bead.width };
/// let found = tried("hub", &hub, &profile, settings, &Task::new())?;
/// let Outcome::Planned(metrics) = &found.divisions[0].outcome else { return Err("nothing can be welded".into()) };
/// assert!(metrics.coverage() > 0.99);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`Cancelled`].
pub fn tried(name: &str, mesh: &Mesh, profile: &Profile, settings: Settings, task: &Task) -> Result<Found, Cancelled> {
    let trial = |division: Division| Tried::of(name, mesh, profile, division, task);
    let trials = |divisions: Vec<Division>| divisions.into_iter().map(trial).collect::<Result<Vec<_>, Cancelled>>();
    let mut found = divisions(mesh, settings, task)?;
    let level = found.split_off(found.len().saturating_sub(1));
    let mut tried = trials(found)?;
    if !tried.iter().any(Tried::is_planned) {
        let is_known = |division: &Division| tried.iter().any(|tried| tried.division == *division);
        let more = by_planes(mesh, settings, task)?.into_iter().filter(|division| !is_known(division)).collect();
        tried.extend(trials(more)?);
    }
    tried.sort_by(Tried::before);
    if tried.iter().any(Tried::is_planned) {
        tried.extend(level.into_iter().map(|level| Tried::untried(name, level)));
        return Ok(Found { divisions: tried, tilted: None });
    }
    tried.extend(trials(level)?);
    if tried.iter().any(Tried::is_planned) {
        return Ok(Found { divisions: tried, tilted: None });
    }
    let mut farther = divisions(mesh, Settings { tilt: MOST_TILT, ..settings }, task)?;
    farther.retain(|division| division.tilt > settings.tilt);
    let tilted = trials(farther)?.into_iter().find(Tried::is_planned);
    Ok(Found { divisions: tried, tilted })
}

/// Layers that face straight down, °.
const MOST_TILT: f64 = 180.0;
/// Overhangs that differ by less than this are alike, mm².
const ALIKE: f64 = 200.0;
/// Shares left bare that differ by less than this are alike.
const BARE: f64 = 0.02;

impl Tried {
    fn untried(name: &str, division: Division) -> Self {
        Self { bodies: Body::of_division(name, &division), division, outcome: Outcome::Untried }
    }

    fn of(name: &str, mesh: &Mesh, profile: &Profile, division: Division, task: &Task) -> Result<Self, Cancelled> {
        let untried = Self::untried(name, division);
        let mut profile = profile.clone();
        profile.layers.bodies.clone_from(&untried.bodies);
        let outcome = match plan_into(name, mesh, &profile, task, &mut Nowhere) {
            Ok(summary) => match summary.forbidden.into_iter().next() {
                Some(reason) => Outcome::Refused(reason),
                None => Outcome::Planned(Box::new(summary.metrics)),
            },
            Err(PlanError::Cancelled(cancelled)) => return Err(cancelled),
            Err(error) => Outcome::Refused(error.to_string()),
        };
        Ok(Self { outcome, ..untried })
    }

    /// Whether it was planned and can be welded.
    pub fn is_planned(&self) -> bool {
        matches!(self.outcome, Outcome::Planned(_))
    }

    /// What can be welded comes first; of that, what leaves less overhang, needs no other metal, covers more, costs less or takes
    /// less time.
    fn before(&self, other: &Self) -> Ordering {
        let rank = |tried: &Self| {
            let metrics = match &tried.outcome {
                Outcome::Planned(metrics) => Some(metrics),
                Outcome::Refused(_) | Outcome::Untried => None,
            };
            let price = |metrics: &Metrics| metrics.cost.unwrap_or(metrics.total_time_s);
            let on_stock = tried.bodies.iter().any(|body| body.on_stock);
            [
                f64::from(u8::from(metrics.is_none())),
                (tried.division.hanging / ALIKE).floor(),
                f64::from(u8::from(on_stock)),
                metrics.map_or(0.0, |metrics| ((1.0 - metrics.coverage()) / BARE).floor()),
                metrics.map_or(0.0, |metrics| price(metrics)),
            ]
        };
        let pairs = rank(self).into_iter().zip(rank(other));
        pairs.fold(Ordering::Equal, |order, (own, other)| order.then(own.total_cmp(&other)))
    }
}

/// Takes layers that nobody needs.
struct Nowhere;

impl Sink for Nowhere {
    type Error = Infallible;

    fn begin(&mut self, _: &Header) -> Result<(), Infallible> {
        Ok(())
    }

    fn layer(&mut self, _: crate::Layer) -> Result<(), Infallible> {
        Ok(())
    }
}
