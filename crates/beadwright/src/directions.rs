//! Ways to divide a part into bodies, each planned for trial, so that what is offered first can be welded.

pub use bead_part::directions::{Division, Piece, Settings, by_planes, divisions};

use crate::chart::Chart;
use crate::dialect::{self, own};
use crate::layer::Layer;
use crate::metrics::Metrics;
use crate::model::Part;
use crate::plan::choice::{Choice, choose};
use crate::plan::{Header, PlanError, Sink, plan_into};
use crate::profile::{Body, Profile};
use crate::task::{Cancelled, Stage, Task};
use crate::warning::WarningKind;
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

impl Found {
    /// Those to choose from, in their order: level layers only where nothing else is found, or where they can be welded.
    pub fn offered(self) -> Vec<Tried> {
        let only = self.divisions.len() == 1;
        let is_offered = |found: &Tried| only || !found.is_level() || found.is_planned();
        self.divisions.into_iter().filter(is_offered).collect()
    }
}

/// Divides a part that stands on the table, and plans it in each way until one can be welded: as what is recognized in it, in
/// pieces cut off by planes, in level layers. `name` is that of a part in one piece; `kept` is whether the strategy of the profile was
/// asked for ([`choose`]).
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
    let (mut done, most) = (0_u32, found.divisions.len() + LATER);
    let mut trial = |untried: Tried| {
        task.step(Stage::Directions, (f64::from(done) / most as f64).min(1.0))?;
        done += 1;
        untried.tried(name, part, profile, kept, task)
    };
    let whole = found.divisions.split_off(found.divisions.len().saturating_sub(1));
    let mut tried = found.divisions.into_iter().map(&mut trial).collect::<Result<Vec<_>, Cancelled>>()?;
    // Planes are searched for what is recognized only if it overhangs.
    let welds_it_all = |tried: &Tried| tried.is_planned() && !tried.needs_stock();
    if !tried.is_empty() && !tried.iter().any(welds_it_all) {
        let is_known = |division: &Division| tried.iter().any(|tried| tried.division == *division);
        let more = by_planes(mesh, settings, task)?.into_iter().filter(|division| !is_known(division));
        let more = more.map(|division| trial(Tried::of(name, division))).collect::<Result<Vec<_>, Cancelled>>()?;
        tried.extend(more);
    }
    let can = tried.iter().any(Tried::is_planned);
    let whole = whole.into_iter().map(|whole| if can { Ok(whole) } else { trial(whole) });
    tried.extend(whole.collect::<Result<Vec<_>, Cancelled>>()?);
    tried.sort_by(|a, b| {
        let [(a, price_a), (b, price_b)] = [a, b].map(|tried| tried.rank(found.level));
        a.cmp(&b).then(price_a.total_cmp(&price_b))
    });
    found.divisions = tried;
    if !found.divisions.iter().any(Tried::is_planned) {
        let farther = divisions(mesh, Settings { tilt: MOST_TILT, ..settings }, task)?.into_iter();
        for division in farther.filter(|division| division.tilt > settings.tilt + 1.0) {
            let tilted = trial(Tried::of(name, division))?;
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

impl Tried {
    fn of(name: &str, division: Division) -> Self {
        Self { bodies: Body::of_division(name, &division), division, outcome: Outcome::Untried }
    }

    fn tried(self, name: &str, part: &Part, profile: &Profile, kept: bool, task: &Task) -> Result<Self, Cancelled> {
        let mut profile = profile.clone();
        profile.layers.bodies.clone_from(&self.bodies);
        let posts = profile.posts.iter().filter(|post| !own::is_folder(post));
        let mut errors = posts.filter_map(|post| dialect::write(post, &NO_LAYERS, &profile.job(name)).err());
        if let Some(error) = errors.next() {
            return Ok(Self { outcome: Outcome::Refused { reason: error.to_string(), hangs: false }, ..self });
        }
        let Choice { profile, .. } = choose(part, &profile, kept, task)?;
        let outcome = match plan_into(name, part, &profile, task, &mut Nowhere) {
            Ok(summary) => match summary.forbidden.into_iter().next() {
                Some(reason) => {
                    let hangs = summary.warnings.summaries().any(|warning| warning.kind == WarningKind::InTheAir);
                    Outcome::Refused { reason, hangs }
                }
                None => Outcome::Planned(Box::new(summary.metrics)),
            },
            Err(PlanError::Cancelled(cancelled)) => return Err(cancelled),
            Err(error) => Outcome::Refused { reason: error.to_string(), hangs: false },
        };
        Ok(Self { outcome, ..self })
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

    /// How the part is divided, as a sentence without a full stop.
    pub fn about(&self) -> String {
        let Division { pieces, hanging, tilt, lean } = &self.division;
        let bodies = match &pieces[..] {
            [_] if self.is_level() => return "level layers".to_owned(),
            [piece] => match &piece.chart {
                Chart::Guide(guide) => format!("1 body along its middle line, {:.0} mm long", guide.length()),
                chart => format!("1 body on {chart}"),
            },
            pieces => format!("{} bodies", pieces.len()),
        };
        let stock =
            if self.needs_stock() { ", on metal that is there already (the hub, turned from bar stock)" } else { "" };
        let leans = lean.map_or(String::new(), |lean| {
            format!(
                ", walls that lean by up to {lean:.0}° (square to them, layers would begin with no room for a bead)"
            )
        });
        format!("{bodies}{stock}: {:.1} cm² overhang, layers at up to {tilt:.0}° from level{leans}", hanging / 100.0)
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
