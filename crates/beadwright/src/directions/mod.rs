//! Ways to divide a part into bodies, each planned for trial, so that what is offered first can be welded.

mod metal;
pub mod page;
mod sentence;

pub use bead_part::directions::{Division, Piece, Settings, by_planes, divisions};
pub use metal::{Metal, metal};

use crate::dialect::{self, own};
use crate::layer::Layer;
use crate::metrics::Metrics;
use crate::model::Part;
use crate::plan::choice::{Choice, choose};
use crate::plan::{Blocked, Header, PlanError, Sink, Summary, plan_into};
use crate::profile::{Body, Profile};
use crate::task::{Cancelled, Stage, Task};
use crate::warning::WarningKind;
use std::collections::VecDeque;
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
    /// It cannot.
    Refused {
        /// The first reason, as a sentence.
        reason: String,
        /// Whether passes have nothing below them, so that a preform may help.
        hangs: bool,
        /// Number of other orders of the bodies that were tried in vain, since the torch would hit a finished body.
        orders: usize,
    },
    /// It was not planned.
    Untried,
}

/// Divisions of a part.
#[derive(Debug, Clone, PartialEq)]
pub struct Found {
    /// Those that can be welded come first, and of these the cheaper ones (see [`tried`]). The whole part in level layers is one
    /// of them; it is planned only if no other can be welded, and comes last otherwise.
    pub divisions: Vec<Tried>,
    /// What overhangs in level layers, mm².
    pub level: f64,
    /// If nothing can be welded: what could be if its layers may lie farther from level than [`Settings::tilt`].
    pub tilted: Option<Tried>,
}

/// Divides a part that stands on the table, and plans it in each way until one can be welded: as what is recognized in it, in
/// pieces cut off by planes, in level layers. `name` is that of a part in one piece; `kept` is whether the strategy of the profile was
/// asked for ([`choose`]).
///
/// Where the torch would hit a finished body, the bodies are tried in other orders ([`Blocked`]).
///
/// The order is that of the price, or of the time where the profile has no prices. It counts 3 % higher for each body more than one,
/// twice the share that stays bare, and as much as what overhangs is of that in level layers. Metal that must be there
/// already, such as a hub, is not in the price, so what needs it comes after what does not.
///
/// ```
/// use beadwright::directions::{Outcome, Settings, tried};
/// use beadwright::{Model, Placement, Profile, Task, example};
///
/// let (profile, task) = (Profile::built_in("cmt-steel-abb")?, Task::new());
/// let hub = example::find("hub").ok_or("no such example")?.stl();
/// let hub = Model::read(&hub, &task)?.place(&Placement::default(), None, profile.bead.width)?;
/// let settings = Settings { lean: 45.0, tilt: 90.0, bead: profile.bead.width };
/// let found = tried("hub", &hub, &profile, false, settings, &task)?;
/// let Outcome::Planned(metrics) = &found.divisions[0].outcome else { return Err("nothing can be welded".into()) };
/// assert!(metrics.coverage() > 0.99);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`PlanError::ChartOfCurves`], [`PlanError::Cancelled`].
pub fn tried(
    name: &str,
    part: &Part,
    profile: &Profile,
    kept: bool,
    settings: Settings,
    task: &Task,
) -> Result<Found, PlanError<Infallible>> {
    let mesh = part.mesh().ok_or(PlanError::ChartOfCurves)?;
    task.step(Stage::Directions, 0.0)?;
    let mut found = untried(name, part, settings, task)?;
    let (trials, most) = (Trials { name, part, profile, kept, task }, found.divisions.len() + LATER);
    let mut done = 0_u32;
    let mut trial = |division: Division| {
        task.step(Stage::Directions, (f64::from(done) / most as f64).min(1.0))?;
        done += 1;
        trials.of(division)
    };
    let whole = found.divisions.split_off(found.divisions.len().saturating_sub(1));
    let mut tried =
        found.divisions.into_iter().map(|found| trial(found.division)).collect::<Result<Vec<_>, Cancelled>>()?;
    // Planes are searched for what is recognized only if it overhangs.
    let welds_it_all = |tried: &Tried| tried.is_planned() && !tried.needs_stock();
    if !tried.is_empty() && !tried.iter().any(welds_it_all) {
        let is_known = |division: &Division| tried.iter().any(|tried| tried.division == *division);
        let more = by_planes(mesh, settings, task)?.into_iter().filter(|division| !is_known(division));
        let more = more.map(&mut trial).collect::<Result<Vec<_>, Cancelled>>()?;
        tried.extend(more);
    }
    let can = tried.iter().any(Tried::is_planned);
    let whole = whole.into_iter().map(|whole| if can { Ok(whole) } else { trial(whole.division) });
    tried.extend(whole.collect::<Result<Vec<_>, Cancelled>>()?);
    tried.sort_by(|a, b| {
        let [(a, price_a), (b, price_b)] = [a, b].map(|tried| tried.rank(found.level));
        a.cmp(&b).then(price_a.total_cmp(&price_b))
    });
    found.divisions = tried;
    if !found.divisions.iter().any(Tried::is_planned) {
        let farther = divisions(mesh, Settings { tilt: MOST_TILT, ..settings }, task)?.into_iter();
        for division in farther.filter(|division| division.tilt > settings.tilt + 1.0) {
            let tilted = trial(division)?;
            if tilted.is_planned() {
                found.tilted = Some(tilted);
                break;
            }
        }
    }
    Ok(found)
}

/// The same divisions without planning them, as they are found.
///
/// # Errors
/// [`PlanError::ChartOfCurves`], [`PlanError::Cancelled`].
pub fn untried(name: &str, part: &Part, settings: Settings, task: &Task) -> Result<Found, PlanError<Infallible>> {
    let found = divisions(part.mesh().ok_or(PlanError::ChartOfCurves)?, settings, task)?;
    let level = found.last().map_or(0.0, |level| level.hanging);
    let divisions = found.into_iter().map(|division| Tried::of(name, division)).collect();
    Ok(Found { divisions, level, tilted: None })
}

/// Divisions that may be tried besides those that are found first: by planes.
const LATER: usize = 3;
/// Layers that face straight down, °.
const MOST_TILT: f64 = 180.0;
/// Enough to ask a dialect whether it writes what a profile wants.
const NO_LAYERS: [Layer; 0] = [];
/// What each body more costs, as a share of the price: it is a place to begin, to align and to check.
const BODY: f64 = 0.03;
/// Each per cent of the part that stays bare counts as this many per cent of the price.
const BARE: f64 = 2.0;
/// Orders of its bodies in which a division is planned at most, after its own.
const ORDERS: usize = 6;

impl Found {
    /// What is worth choosing from: level layers only where nothing else is found, or nothing else can be welded.
    pub fn offered(&self) -> impl Iterator<Item = &Tried> {
        let only = self.divisions.len() == 1;
        self.divisions.iter().filter(move |tried| only || !tried.is_level() || tried.is_planned())
    }
}

impl Tried {
    fn of(name: &str, division: Division) -> Self {
        Self { bodies: Body::of_division(name, &division), division, outcome: Outcome::Untried }
    }

    /// Whether it was planned and can be welded.
    pub fn is_planned(&self) -> bool {
        matches!(self.outcome, Outcome::Planned(_))
    }

    /// Whether it is the whole part in level layers.
    pub fn is_level(&self) -> bool {
        matches!(&self.bodies[..], [only] if only.chart.is_level())
    }

    /// Whether a body of it is welded on metal that must be there already.
    pub fn needs_stock(&self) -> bool {
        self.bodies.iter().any(|body| body.on_stock)
    }

    /// What `layers.bodies` is to hold for it: nothing for level layers.
    pub fn into_bodies(self) -> Vec<Body> {
        if self.is_level() { Vec::new() } else { self.bodies }
    }

    /// Its class, and its price in that; the lowest comes first. `level` is what overhangs in level layers, mm².
    fn rank(&self, level: f64) -> (u8, f64) {
        match &self.outcome {
            Outcome::Planned(metrics) => {
                let price = metrics.cost.unwrap_or(metrics.total_time_s);
                let bodies = BODY * (self.bodies.len() - 1) as f64;
                let bare = BARE * (1.0 - metrics.coverage()).max(0.0);
                let hanging = self.division.hanging / level.max(1.0);
                (u8::from(self.needs_stock()), price * (1.0 + bodies + bare + hanging))
            }
            Outcome::Refused { .. } if !self.is_level() => (2, 0.0),
            Outcome::Refused { .. } | Outcome::Untried => (3, 0.0),
        }
    }
}

/// What divisions of a part are planned with.
struct Trials<'a> {
    name: &'a str,
    part: &'a Part,
    profile: &'a Profile,
    /// Whether the strategy of the profile was asked for.
    kept: bool,
    task: &'a Task,
}

impl Trials<'_> {
    /// Plans a division, and, where the torch would hit a body, in other orders of its pieces.
    fn of(&self, division: Division) -> Result<Tried, Cancelled> {
        let (mut first, blocked) = self.planned(division)?;
        let mut seen = vec![first.division.pieces.clone()];
        let mut open: VecDeque<_> = orders(&first.division, &blocked).collect();
        while seen.len() <= ORDERS
            && let Some(division) = open.pop_front()
        {
            if seen.contains(&division.pieces) {
                continue;
            }
            seen.push(division.pieces.clone());
            let (other, blocked) = self.planned(division)?;
            if other.is_planned() {
                return Ok(other);
            }
            open.extend(orders(&other.division, &blocked));
        }
        if let Outcome::Refused { orders, .. } = &mut first.outcome {
            *orders = seen.len() - 1;
        }
        Ok(first)
    }

    /// Plans a division in the order of its pieces; and which of them block which, if nothing else forbids the plan.
    fn planned(&self, division: Division) -> Result<(Tried, Vec<Blocked>), Cancelled> {
        let untried = Tried::of(self.name, division);
        let mut profile = self.profile.clone();
        profile.layers.bodies.clone_from(&untried.bodies);
        let refused = |reason: String| Outcome::Refused { reason, hangs: false, orders: 0 };
        let posts = profile.posts.iter().filter(|post| !own::is_folder(post));
        let mut errors = posts.filter_map(|post| dialect::write(post, &NO_LAYERS, &profile.job(self.name)).err());
        if let Some(error) = errors.next() {
            return Ok((Tried { outcome: refused(error.to_string()), ..untried }, Vec::new()));
        }
        let Choice { profile, .. } = choose(self.part, &profile, self.kept, self.task)?;
        let (outcome, blocked) = match plan_into(self.name, self.part, &profile, self.task, &mut Nowhere) {
            Ok(Summary { metrics, warnings, forbidden, blocked, .. }) => {
                let any = |is: &dyn Fn(WarningKind) -> bool| warnings.summaries().any(|warning| is(warning.kind));
                let blocked = if any(&WarningKind::forbids) { Vec::new() } else { blocked };
                let hangs = any(&|kind| kind == WarningKind::InTheAir);
                match forbidden.into_iter().next() {
                    Some(reason) => (Outcome::Refused { reason, hangs, orders: 0 }, blocked),
                    None => (Outcome::Planned(Box::new(metrics)), Vec::new()),
                }
            }
            Err(PlanError::Cancelled(cancelled)) => return Err(cancelled),
            Err(error) => (refused(error.to_string()), Vec::new()),
        };
        Ok((Tried { outcome, ..untried }, blocked))
    }
}

/// For each piece that is blocked, two orders in which it is welded before the one in its way: either it moves to just before
/// that, or that to just after it. The first piece, on which the others stand, stays the first.
fn orders(division: &Division, blocked: &[Blocked]) -> impl Iterator<Item = Division> {
    let movable = blocked.iter().filter(|blocked| blocked.by > 0);
    movable.flat_map(|&Blocked { body, by }| [(body, by), (by, body)]).map(|(from, to)| {
        let mut division = division.clone();
        let piece = division.pieces.remove(from);
        division.pieces.insert(to, piece);
        division
    })
}

/// Takes layers that nobody needs.
struct Nowhere;

impl Sink for Nowhere {
    type Error = Infallible;

    fn begin(&mut self, _: &Header) -> Result<(), Infallible> {
        Ok(())
    }

    fn layer(&mut self, _: Layer) -> Result<(), Infallible> {
        Ok(())
    }
}
