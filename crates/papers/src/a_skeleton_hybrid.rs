//! Zhao et al. 2023: the contour-skeleton hybrid on a propeller of 260 × 260 × 20 mm with the values of their table 1.

use crate::goal::{self, Goal};
use crate::{ReproduceError, Reproduced};
use beadwright::bead::MassBalance;
use beadwright::check;
use beadwright::compare::{self, Entry};
use beadwright::dialect;
use beadwright::example;
use beadwright::fill::StrategyName;
use beadwright::fill::hybrid::{ScanAlong, Steps};
use beadwright::model::Mesh;
use beadwright::plan;
use beadwright::profile::Profile;
use beadwright::report::sheet::Sheet;
use beadwright::slice::Slicer;
use beadwright::task::Task;
use glam::DVec3;
use std::collections::BTreeSet;

/// The speed if the 0.02 m/min printed in the paper's abstract were 0.02 m/s, mm/s.
const PRINTED_SPEED: f64 = 20.0;
/// Index of the layer that is drawn, from 0.
const LAYER: usize = 4;

/// Parts are turned about the vertical from 0° to 165° in steps of this many degrees.
const TURN: usize = 15;
/// The parts on which our own hybrid is compared with contours.
const PARTS: [&str; 4] = ["cross", "star", "gear", "propeller"];

/// Runs the experiment.
///
/// # Errors
/// [`ReproduceError`] when the task was cancelled.
pub fn run(task: &Task) -> Result<Reproduced, ReproduceError> {
    let mut profile = Profile::built_in("cmt-al2319-kuka").map_err(|e| wrong(&e))?;
    profile.fill.strategy = StrategyName::Hybrid;
    // The paper's layers have one height, its beads one speed.
    profile.layers.level = false;
    let literal = literal(&profile, ScanAlong::Auto);
    let mesh = part("propeller", 0.0)?;
    let entries = entries(&mesh, &profile, task)?;
    let goals = goals(&profile, task)?;

    let mut page = Sheet::new(
        "a-skeleton-hybrid",
        "Zhao et al. 2023: a propeller of 260 × 260 × 20 mm in layers of 2 mm, d1 = 5.39 mm, d2 = 5 mm, ER2319 wire of \
         1.2 mm at 6 m/min. The paper prints no voids and no number of starts: it shows pictures. Two methods are shown: the \
         literal one follows the paper; ours, the default of the strategy hybrid, adds beads along medial axes, widths that \
         follow the room, and a choice by the deposit model. What is reached is judged over all layers, by the worst figure \
         of the part turned about the vertical in steps of 15°.",
    );
    goal::tabulate(&mut page, &goals);
    page.heading("The steps on layer 5: the literal method");
    compare::add_steps(&mut page, &mesh, &literal, StrategyName::Hybrid, LAYER, task).map_err(|e| wrong(&e))?;
    page.heading("The steps on layer 5: ours");
    page.text(
        "Narrow regions get beads along their medial axis, widths follow the room, beads are linked to contours that end \
         near them. The deposit model chooses how deep pockets are searched for, how far corners are drawn out and which \
         regions are filled; there are never more arc starts than contours need.",
    );
    compare::add_steps(&mut page, &mesh, &profile, StrategyName::Hybrid, LAYER, task).map_err(|e| wrong(&e))?;
    page.heading("What the deposit model says about all layers");
    page.text(
        "Figure 5 of the paper: along the long side of a region, lines are long but stairs stay at its edges; along the \
         short side they meet the contours squarely.",
    );
    compare::tabulate(&mut page, &entries);
    let maps: Vec<_> = entries.iter().map(|e| (e.name.clone(), vec![e.layers[LAYER].picture.as_ref()])).collect();
    page.maps(&["layer 5".to_owned()], &maps);
    page.heading("Does the wire fit the speed?");
    let finding = balance(&profile);
    page.text(&finding);

    let mut lines: Vec<String> = goals.iter().map(Goal::line).collect();
    lines.extend(entries.iter().map(line));
    lines.push(finding);
    let plan = plan::plan("propeller", &mesh, &profile, task).map_err(|e| wrong(&e))?;
    let files: Vec<_> =
        dialect::write("krl", &plan.layers, &profile.job("propeller")).map_err(|e| wrong(&e))?.into_iter().collect();
    let names: BTreeSet<&String> = files.iter().map(|(name, _)| name).collect();
    lines.push(format!("KRL of our hybrid: {} files next to the page", names.len()));
    Ok(Reproduced { page, goals, pictures: Vec::new(), lines, files })
}

fn wrong(error: &dyn std::fmt::Display) -> ReproduceError {
    ReproduceError(error.to_string())
}

/// An example part, turned about the vertical by this many degrees.
fn part(name: &str, turn: f64) -> Result<Mesh, ReproduceError> {
    let missing = || ReproduceError(format!("there is no example part called {name}"));
    let mut mesh = example::find(name).ok_or_else(missing)?.mesh();
    mesh.place(1.0, DVec3::new(0.0, 0.0, turn));
    Ok(mesh)
}

/// The profile that follows the paper to the letter.
fn literal(profile: &Profile, along: ScanAlong) -> Profile {
    let mut profile = profile.clone();
    (profile.hybrid.literal, profile.hybrid.scan_along) = (true, along);
    profile
}

fn judged(mesh: &Mesh, profile: &Profile, strategy: StrategyName, task: &Task) -> Result<Entry, ReproduceError> {
    compare::strategy(mesh, profile, strategy, plan::deposit_settings(profile), &None, task).map_err(|e| wrong(&e))
}

/// The literal method with both directions of lines, ours, and the methods that they are compared with.
fn entries(mesh: &Mesh, profile: &Profile, task: &Task) -> Result<Vec<Entry>, ReproduceError> {
    let named = |name: &str, profile: &Profile| {
        Ok(Entry { name: name.to_owned(), ..judged(mesh, profile, StrategyName::Hybrid, task)? })
    };
    let mut entries = vec![
        named("the literal method", &literal(profile, ScanAlong::Short))?,
        named("literal, along the long side", &literal(profile, ScanAlong::Long))?,
        named("ours", profile)?,
    ];
    for strategy in [
        StrategyName::Contour,
        StrategyName::Zigzag,
        StrategyName::Compound,
        StrategyName::Partition,
        StrategyName::Mat,
        StrategyName::Loop,
    ] {
        entries.push(judged(mesh, profile, strategy, task)?);
    }
    Ok(entries)
}

/// The goals that are judged, by the worst of all turns.
fn goals(profile: &Profile, task: &Task) -> Result<Vec<Goal>, ReproduceError> {
    let mut goals = literal_goals(profile, task)?;
    for name in PARTS {
        goals.push(beside_contours(name, profile, task)?);
    }
    for (method, profile) in [("literal", &literal(profile, ScanAlong::Short)), ("ours", profile)] {
        goals.push(joining(method, profile, task)?);
    }
    Ok(goals)
}

/// Angles at which parts are judged, degrees.
fn turns() -> impl Iterator<Item = f64> {
    (0..180).step_by(TURN).map(|turn| turn as f64)
}

/// Arc starts per layer.
fn starts(entry: &Entry) -> f64 {
    entry.totals.arc_starts as f64 / entry.layers.len().max(1) as f64
}

/// The goals for the literal method on the propeller.
fn literal_goals(profile: &Profile, task: &Task) -> Result<Vec<Goal>, ReproduceError> {
    let (short, long) = (literal(profile, ScanAlong::Short), literal(profile, ScanAlong::Long));
    let (mut most, mut void, mut saved, mut better): (f64, f64, f64, f64) = (0.0, 0.0, f64::INFINITY, f64::INFINITY);
    for turn in turns() {
        let mesh = part("propeller", turn)?;
        let ours = judged(&mesh, &short, StrategyName::Hybrid, task)?;
        let along = judged(&mesh, &long, StrategyName::Hybrid, task)?;
        let contour = judged(&mesh, profile, StrategyName::Contour, task)?;
        (most, void) = (most.max(starts(&ours)), void.max(ours.figures.void_percent()));
        saved = saved.min(starts(&contour) - starts(&ours));
        better = better.min(along.figures.void_percent() - ours.figures.void_percent());
    }
    let found = findings(&short, task)?;
    Ok(vec![
        Goal::new(
            "literal, propeller: arc starts a layer, at most 12",
            format!("{most:.1}"),
            "not given",
            most <= 12.0,
        ),
        Goal::new("literal, propeller: void, at most 0.8 %", format!("{void:.3} %"), "no unfilled areas", void <= 0.8),
        Goal::new(
            "literal, propeller: fewer arc starts a layer than contours",
            format!("{saved:.1} fewer"),
            "fewer starts and ends",
            saved > 0.0,
        ),
        Goal::new(
            "literal, propeller: less void with lines along the short side than along the long one",
            format!("{better:.2} points less"),
            "figure 5, no figure given",
            better > 0.0,
        ),
        Goal::new(
            "literal, propeller: nothing that beadwright check would find",
            if found.is_empty() { "nothing".to_owned() } else { found.join(" ") },
            "welded",
            found.is_empty(),
        ),
    ])
}

/// What the checks find in a plan of the propeller, as sentences.
fn findings(profile: &Profile, task: &Task) -> Result<Vec<String>, ReproduceError> {
    let plan = plan::plan("propeller", &part("propeller", 0.0)?, profile, task).map_err(|e| wrong(&e))?;
    let settings = plan::deposit_settings(profile);
    let found = check::check(&plan.layers, profile, settings, task).map_err(|e| wrong(&e))?;
    Ok(check::grouped(&found).iter().map(|finding| format!("{}: {}", finding.kind, finding.text)).collect())
}

/// Our hybrid next to plain contours.
fn beside_contours(name: &str, profile: &Profile, task: &Task) -> Result<Goal, ReproduceError> {
    let (mut times, mut humps, mut more) = (f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY);
    for turn in turns() {
        let mesh = part(name, turn)?;
        let ours = judged(&mesh, profile, StrategyName::Hybrid, task)?;
        let contour = judged(&mesh, profile, StrategyName::Contour, task)?;
        times = times.min(contour.figures.void_percent() / ours.figures.void_percent().max(1e-3));
        humps = humps.max(ours.figures.overfill_percent() - contour.figures.overfill_percent());
        more = more.max(starts(&ours) - starts(&contour));
    }
    Ok(Goal::new(
        &format!(
            "ours, {name}: a fifth of the voids of contours, overfill at most 2 points more, no more arc starts a layer"
        ),
        format!("voids divided by {times:.1}, {humps:+.2} points, {more:+.1} starts"),
        "not given",
        times >= 5.0 && humps <= 2.0 && more <= 0.0,
    ))
}

/// Innovation 2 of the paper: contours and pieces of them joined into few passes, on all layers of the propeller.
fn joining(method: &str, profile: &Profile, task: &Task) -> Result<Goal, ReproduceError> {
    let mesh = part("propeller", 0.0)?;
    let slicer = Slicer::new(&mesh, profile.slice_options(), task).map_err(|e| wrong(&e))?;
    let slices = slicer.all(task).map_err(|e| wrong(&e))?;
    let (mut apart, mut joined) = (0, 0);
    for slice in &slices {
        for island in &slice.islands {
            let steps = Steps::of(island, &profile.fill_settings(slice.index));
            apart += steps.contours.complete.len() + steps.contours.incomplete.len();
            joined += steps.chains.len();
        }
    }
    let a_layer = |count: usize| count as f64 / slices.len().max(1) as f64;
    Ok(Goal::new(
        &format!("{method}, propeller: joining at least halves the arc starts of contours and their pieces"),
        format!("{:.1} a layer unjoined, {:.1} joined", a_layer(apart), a_layer(joined)),
        "innovation 2, no figure given",
        2 * joined <= apart,
    ))
}

fn line(entry: &Entry) -> String {
    let (f, t) = (&entry.figures, &entry.totals);
    format!(
        "{:<28} void {:5.2} %  overfill {:5.2} %  arc starts of all layers {:4}",
        entry.name,
        f.void_percent(),
        f.overfill_percent(),
        t.arc_starts
    )
}

/// The finding on the printed speed.
fn balance(profile: &Profile) -> String {
    let Profile { wire, process, .. } = profile;
    let at = |speed: f64| {
        MassBalance::new(profile.bead(), process.wire_feed_speed, wire.diameter, process.efficiency, speed)
    };
    let printed = at(PRINTED_SPEED);
    format!(
        "At {PRINTED_SPEED} mm/s the wire brings {:.2} mm² of bead section, but the layer needs {:.2} mm². A deposition \
         speed of {:.1} mm/s fits; the printed 0.02 m/min cannot be meant.",
        printed.wire / PRINTED_SPEED,
        profile.bead().area(),
        printed.fitting_speed
    )
}
