//! Checks: what would go wrong if a plan were welded as it is. A check is one file and one line in [`CHECKS`].
//!
//! Every check has a name and says what it looks for, why that matters, how a finding may read and what to do about it.
//! Its limits are in the profile's section `[check]`.

mod air;
mod alternating_ends;
mod bead_width;
mod built_height;
mod clearance;
mod cooling;
mod crossing;
mod dense_points;
mod heat_input;
mod layers;
mod low_travel;
mod off_level;
mod outside;
mod overfill;
mod overhang;
mod points;
mod positioner_speed;
mod program_size;
mod rehearsal;
mod retraced;
mod short_arc;
mod short_pass;
mod speed_window;
mod stacked_starts;
mod towers;
mod turned;
mod void;
mod wire_balance;

pub use rehearsal::rehearse;

use crate::deposit::stack::{Grown, Growth, Stack};
use crate::deposit::{DepositSettings, Figures, Judge, Judgement};
use crate::finding::{Finding, Severity, as_sentence};
use crate::layer::Layer;
use crate::pass::PassKind;
use crate::plan::{AsWelded, PlanSettings, Summary};
use crate::profile::Profile;
use crate::slice::Half;
use crate::task::{Cancelled, Stage, Task};
use crate::warning::{WarningKind, Warnings};
use glam::DVec3;
use planar::Bounds;
use std::borrow::Borrow;
use std::collections::BTreeSet;

/// The checks.
pub const CHECKS: [Check; 26] = [
    points::CHECK,
    layers::CHECK,
    air::CHECK,
    crossing::CHECK,
    retraced::CHECK,
    clearance::CHECK,
    low_travel::CHECK,
    off_level::CHECK,
    positioner_speed::CHECK,
    short_pass::CHECK,
    short_arc::CHECK,
    speed_window::CHECK,
    bead_width::CHECK,
    wire_balance::CHECK,
    heat_input::CHECK,
    cooling::CHECK,
    void::CHECK,
    overfill::CHECK,
    outside::CHECK,
    overhang::CHECK,
    built_height::CHECK,
    towers::CHECK,
    stacked_starts::CHECK,
    alternating_ends::CHECK,
    program_size::CHECK,
    dense_points::CHECK,
];

/// Checks whose findings `plan` already reports as warnings.
const ALSO_WARNED: [(&Check, &[WarningKind]); 3] = [
    (&overhang::CHECK, &[WarningKind::Overhang, WarningKind::InTheAir, WarningKind::OverUnwelded]),
    (&layers::CHECK, &[WarningKind::EmptyLayer, WarningKind::HighStart, WarningKind::NothingBelow]),
    (&short_arc::CHECK, &[WarningKind::ShortArc]),
];

/// Checks that find metal in the wrong place, a torch that is dragged over it, or a program that stops.
const SERIOUS: [&Check; 9] = [
    &points::CHECK,
    &layers::CHECK,
    &air::CHECK,
    &crossing::CHECK,
    &retraced::CHECK,
    &clearance::CHECK,
    &low_travel::CHECK,
    &off_level::CHECK,
    &towers::CHECK,
];

/// A check.
pub struct Check {
    /// The name that users type.
    pub name: &'static str,
    /// What it looks for.
    pub what: &'static str,
    /// Why that matters.
    pub why: &'static str,
    /// An example of a finding.
    pub example: &'static str,
    /// What to do.
    pub remedy: &'static str,
    /// Runs the check.
    find: fn(&Subject<'_>) -> Vec<Finding>,
}

/// The plan to be checked, with what the deposit model says about it.
pub struct Subject<'a> {
    layers: Vec<&'a Layer>,
    settings: &'a PlanSettings<'a>,
    /// The layers of bodies welded earlier, and the settings of all bodies.
    earlier: &'a [&'a Layer],
    whole: &'a PlanSettings<'a>,
    /// What the deposit model says about each layer.
    figures: Vec<Figures>,
    /// How the part grows from layer to layer.
    growth: Vec<Growth>,
    /// How the part has grown at its end.
    built: Option<Growth>,
}

/// What the deposit model says about a plan.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LayerFigures {
    /// The figures of each layer.
    pub figures: Vec<Figures>,
    /// The figures of all layers together.
    pub total: Figures,
    /// How the part grows.
    pub grown: Grown,
}

/// Judges a plan layer by layer, as it is welded with a profile, and passes each layer's index and judgement to `each`.
/// How the part grows is computed, unless it is `known` from planning ([`Summary::grown`]).
///
/// # Errors
/// [`Cancelled`].
pub fn judge_layers<L: Borrow<Layer>>(
    layers: &[L],
    profile: &Profile,
    mut judge: Judge,
    known: Option<Grown>,
    task: &Task,
    mut each: impl FnMut(usize, Judgement),
) -> Result<LayerFigures, Cancelled> {
    let welded = AsWelded::of(profile);
    let mut figures = Vec::with_capacity(layers.len());
    for (i, layer) in layers.iter().map(L::borrow).enumerate() {
        task.step(Stage::Deposit, i as f64 / layers.len() as f64)?;
        let judgement = is_finite(layer).then(|| judge.layer(&welded.alone(layer)));
        figures.push(judgement.as_ref().map_or(Figures::default(), |judgement| judgement.figures));
        judgement.into_iter().for_each(|judgement| each(i, judgement));
    }
    let grown = known.map_or_else(|| grown(layers, profile, *judge.settings(), task), Ok)?;
    Ok(LayerFigures { figures, total: *judge.total(), grown })
}

/// How a plan grows from layer to layer as it is welded.
///
/// # Errors
/// [`Cancelled`].
pub fn grown<L: Borrow<Layer>>(
    layers: &[L],
    profile: &Profile,
    settings: DepositSettings,
    task: &Task,
) -> Result<Grown, Cancelled> {
    let layers: Vec<&Layer> = layers.iter().map(L::borrow).collect();
    let bodies = bodies(&layers).map(|body| {
        let own = profile.of_body(body[0].body);
        body_grown(body, AsWelded::of(&own), settings, task)
    });
    let bodies = bodies.collect::<Result<Vec<_>, _>>()?;
    let built: Vec<Option<Growth>> = bodies.iter().map(|(_, built)| *built).collect();
    Ok(Grown { layers: bodies.into_iter().flat_map(|(layers, _)| layers).collect(), built })
}

/// The layers of each body.
fn bodies<'a, 'l>(layers: &'a [&'l Layer]) -> impl Iterator<Item = &'a [&'l Layer]> {
    layers.chunk_by(|a, b| a.body == b.body)
}

/// How a body grows after each of its layers, and how it ends.
fn body_grown(
    layers: &[&Layer],
    welded: AsWelded,
    settings: DepositSettings,
    task: &Task,
) -> Result<(Vec<Growth>, Option<Growth>), Cancelled> {
    let stacks = !welded.layers().chart.goes_around();
    let Some(bounds) = extent(layers).filter(|_| stacks) else {
        return Ok((vec![Growth::default(); layers.len()], None));
    };
    let mut stack = Stack::new(&bounds, settings);
    for layer in layers.iter().filter(|layer| is_finite(layer)) {
        task.check()?;
        stack.add(&welded.welded(layer));
    }
    Ok((stack.growth().to_vec(), stack.built()))
}

/// Where passes lie, seen from above.
fn extent<L: Borrow<Layer>>(layers: &[L]) -> Option<Bounds> {
    let points = layers.iter().flat_map(|layer| &layer.borrow().passes).flat_map(|pass| &pass.points);
    Bounds::of(points.filter(|p| p.is_finite()).map(|p| p.truncate()))
}

/// Points that are not finite numbers are found by a separate check; the deposit model cannot handle them.
fn is_finite(layer: &Layer) -> bool {
    layer.passes.iter().flat_map(|pass| &pass.points).all(|p| p.is_finite())
}

/// Runs all checks on a plan.
///
/// ```
/// use beadwright::{Along, Layer, Pass, PassKind, Profile, Task, check, glam::DVec3, plan};
///
/// // A pass whose points all lie on one spot.
/// let profile = Profile::built_in("cmt-al2319-kuka")?;
/// let (points, width, pace) = (vec![DVec3::Z * 2.0; 2], Along::Same(7.54), Along::Same(10.5));
/// let pass = Pass { kind: PassKind::Wall, closed: false, points, width, pace, wait: 0.0 };
/// let layer = Layer { z: 2.0, height: 2.0, passes: vec![pass], ..Layer::default() };
/// let found = check::check(&[layer], &profile, plan::deposit_settings(&profile), &Task::new())?;
/// assert!(found.iter().any(|finding| finding.kind == "points"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`Cancelled`].
pub fn check<L: Borrow<Layer>>(
    layers: &[L],
    profile: &Profile,
    settings: DepositSettings,
    task: &Task,
) -> Result<Vec<Finding>, Cancelled> {
    let judged = judge_layers(layers, profile, Judge::new(settings), None, task, |_, _| ())?;
    Ok(check_figures(layers, profile, judged))
}

/// Runs all checks on a plan that has been judged.
pub fn check_figures<L: Borrow<Layer>>(layers: &[L], profile: &Profile, judged: LayerFigures) -> Vec<Finding> {
    let LayerFigures { figures, grown: Grown { layers: growth, built }, .. } = judged;
    let layers: Vec<&Layer> = layers.iter().map(L::borrow).collect();
    let whole = PlanSettings::of(profile);
    let (mut found, mut first) = (Vec::new(), 0);
    for (i, body) in bodies(&layers).enumerate() {
        let own = first..first + body.len();
        let part = |all: usize| own.start.min(all)..own.end.min(all);
        let profile = profile.of_body(body[0].body);
        let subject = Subject {
            layers: body.to_vec(),
            settings: &PlanSettings::of(&profile),
            earlier: &layers[..first],
            whole: &whole,
            figures: figures[part(figures.len())].to_vec(),
            growth: growth[part(growth.len())].to_vec(),
            built: built.get(i).copied().flatten(),
        };
        found.extend(CHECKS.iter().flat_map(|check| (check.find)(&subject)).map(|finding| subject.located(finding)));
        first = own.end;
    }
    // A fault of the profile is found once for each body.
    let mut known = BTreeSet::new();
    found.retain(|finding| finding.layer.is_some() || known.insert(finding.text.clone()));
    found
}

/// The check with this name.
pub fn by_name(name: &str) -> Option<&'static Check> {
    CHECKS.iter().find(|check| check.name == name)
}

/// Findings by their checks, in the order of [`CHECKS`]: the first of each stands for all.
pub fn grouped(findings: &[Finding]) -> Vec<Finding> {
    let of = |check: &Check| {
        let own = || findings.iter().filter(|finding| finding.kind == check.name);
        let (count, first) = (own().count(), own().next()?.clone());
        let text = if count == 1 { first.text } else { format!("{} And {} more.", first.text, count - 1) };
        Some(Finding { count, text, ..first })
    };
    CHECKS.iter().filter_map(of).collect()
}

/// Everything to report about a plan, the worst first: what forbids it, what the checks found (`found`, [`grouped`] or
/// one by one), its warnings, what was mended in the model (sentences), and its notes. Nothing is said twice; remedies are worded
/// for the program in use (`words`).
pub fn all_findings(summary: &Summary, model: &[String], found: &[Finding]) -> Vec<Finding> {
    let warned: Vec<Finding> = summary.warnings.summaries().map(Finding::from).collect();
    let new = |kind, severity| move |text: &String| Finding::new(kind, severity, text.clone());
    let said: BTreeSet<String> = warned.iter().map(Finding::sentence).collect();
    let checks = found.iter().filter(|finding| !is_warned_of(finding.kind, &summary.warnings)).cloned();
    let mut all: Vec<Finding> = checks.chain(warned).collect();
    let forbidden = summary.forbidden.iter().filter(|text| !said.contains(*text));
    all.extend(forbidden.map(new("refused", Severity::Serious)));
    all.extend(lost_geometry(summary));
    all.extend(summary.notes.iter().map(new("plan", Severity::Doubt)));
    all.extend(model.iter().map(new("model", Severity::Note)));
    let mut known = BTreeSet::new();
    all.retain(|finding| known.insert(finding.text.clone()));
    all.sort_by_key(|finding| finding.severity);
    all
}

/// Below this share of the slices, planned, part of the geometry is lost; below the second, the part is another one.
const WHOLE: f64 = 0.9;
const ANOTHER: f64 = 0.75;

/// What to say of a plan that leaves out much of its part, for whatever reasons.
fn lost_geometry(summary: &Summary) -> Option<Finding> {
    let (metrics, share) = (&summary.metrics, summary.metrics.coverage());
    if metrics.slice_area_mm2 <= 0.0 || share >= WHOLE {
        return None;
    }
    let bare = (metrics.slice_area_mm2 - metrics.planned_area_mm2) / 100.0;
    let severity = if share < ANOTHER { Severity::Serious } else { Severity::Doubt };
    let text = format!(
        "Only {:.0} % of the part is planned: {bare:.1} cm² of its slices, all together, stay without metal.",
        100.0 * share
    );
    let remedy = "Choose narrower beads or a strategy for narrow places (hybrid, wall), or plan a preform.".to_owned();
    Some(Finding { remedy: Some(remedy), ..Finding::new("lost-geometry", severity, text) }.sized(100.0 * share))
}

/// Whether a warning of the plan already says what a check of that name finds.
fn is_warned_of(name: &str, warnings: &Warnings) -> bool {
    let warned = |kinds: &[WarningKind]| warnings.summaries().any(|w| kinds.contains(&w.kind));
    ALSO_WARNED.iter().any(|(check, kinds)| check.name == name && warned(kinds))
}

impl Check {
    /// How much its findings matter.
    pub fn severity(&self) -> Severity {
        if SERIOUS.iter().any(|check| check.name == self.name) { Severity::Serious } else { Severity::Doubt }
    }

    fn of_plan(&self, text: String) -> Finding {
        Finding { remedy: Some(as_sentence(self.remedy)), ..Finding::new(self.name, self.severity(), text) }
    }

    fn of_layer(&self, layer: &Layer, place: Option<DVec3>, text: String) -> Finding {
        Finding { layer: Some(layer.index), place, ..self.of_plan(text) }
    }

    fn of_pass(&self, layer: &Layer, pass: usize, place: Option<DVec3>, text: String) -> Finding {
        Finding { pass: Some(pass), ..self.of_layer(layer, place, text) }
    }
}

/// A place as a part of a sentence.
fn at(place: Option<DVec3>) -> String {
    place.map_or_else(String::new, |p| format!(", x {:.1} y {:.1} z {:.2} mm", p.x, p.y, p.z))
}

impl Subject<'_> {
    /// Every pass with its layer and its index in it.
    fn passes(&self) -> impl Iterator<Item = (&Layer, usize, &crate::pass::Pass)> {
        self.layers.iter().flat_map(|&layer| layer.passes.iter().enumerate().map(move |(i, pass)| (layer, i, pass)))
    }

    /// What a layer lies on: the layer below it, and for the upper layer of a pair also the one below that.
    fn below(&self, layer: &Layer) -> &[&Layer] {
        let at = self.layers.partition_point(|other| other.index < layer.index);
        let count = if layer.half == Some(Half::Upper) { 2 } else { 1 };
        &self.layers[at.saturating_sub(count)..at]
    }

    /// A finding whose text says where it is: its place lies on the layer, the text gives it in space.
    fn located(&self, finding: Finding) -> Finding {
        let Some(layer) = finding.layer else { return finding };
        let sheet = self.layers.iter().find(|l| l.index == layer).and_then(|l| self.settings.layers.sheet(l));
        let place = finding.place.map(|p| sheet.map_or(p, |sheet| sheet.at(p).place));
        let pass = finding.pass.map_or_else(String::new, |pass| format!(", pass {}", pass + 1));
        let text = format!("layer {}{pass}{}: {}", layer + 1, at(place), finding.text);
        Finding { text, ..finding }
    }

    /// The passes that are beads; how long dots take and how high they are is given by the profile.
    fn beads(&self) -> impl Iterator<Item = (&Layer, usize, &crate::pass::Pass)> {
        self.passes().filter(|(_, _, pass)| pass.kind != PassKind::Spot)
    }

    /// Index of a layer in its body; the first body begins with the plan, even where only some of its layers are checked.
    fn number_in_body(&self, layer: &Layer) -> usize {
        if layer.body == 0 {
            return layer.index;
        }
        layer.index - self.layers.iter().map(|other| other.index).min().unwrap_or(0)
    }

    /// Time for which the torch welds a layer, s.
    fn seconds(&self, layer: &Layer) -> f64 {
        layer.passes.iter().map(|pass| pass.seconds(&self.settings.weld.process)).sum()
    }

    /// A finding for each layer whose figure is above the limit; turns of a helix are not flat layers, so these figures say
    /// nothing about them.
    fn above(&self, check: &Check, value: fn(&Figures) -> f64, limit: f64, words: &str) -> Vec<Finding> {
        let flat = self.layers.iter().zip(&self.figures).filter(|(layer, _)| !layer.lit.is_turn());
        let over = flat.filter(|(_, figures)| value(figures) > limit);
        let found = |(layer, figures): (&&Layer, &Figures)| {
            let text = format!("{:.2} % {words}; the limit is {limit} %.", value(figures));
            check.of_layer(layer, None, text).sized(value(figures))
        };
        over.map(found).collect()
    }
}
