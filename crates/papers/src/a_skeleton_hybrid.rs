//! Zhao et al. 2023: the contour-skeleton hybrid on a propeller of 260 × 260 × 20 mm with the values of their table 1.

use crate::goal::{self, Goal};
use crate::{ReproduceError, Reproduced};
use beadwright::bead::MassBalance;
use beadwright::compare::{self, Entry};
use beadwright::dialect;
use beadwright::example;
use beadwright::fill::StrategyName;
use beadwright::fill::hybrid::ScanAlong;
use beadwright::model::Mesh;
use beadwright::plan;
use beadwright::profile::Profile;
use beadwright::report::sheet::Sheet;
use beadwright::task::Task;
use glam::DVec3;
use std::collections::BTreeSet;

/// The speed that the abstract of the paper would need if its printed 0.02 m/min were 0.02 m/s, mm/s.
const PRINTED_SPEED: f64 = 20.0;
/// Index of the layer that is drawn, from 0.
const LAYER: usize = 4;

/// The part as it is, and turned about the vertical by this angle, degrees.
const TURNS: [f64; 2] = [0.0, 37.0];
/// The parts on which our own hybrid is compared with contours.
const PARTS: [&str; 4] = ["cross", "star", "gear", "propeller"];

/// Runs the experiment.
///
/// # Errors
/// [`ReproduceError`] when the task was cancelled.
pub fn run(task: &Task) -> Result<Reproduced, ReproduceError> {
    let mut profile = Profile::built_in("cmt-al2319-kuka").map_err(|e| wrong(&e))?;
    profile.fill.strategy = StrategyName::Hybrid;
    // The paper's layers are of one height, its beads of one speed.
    profile.layers.level = false;
    let literal = literal(&profile, ScanAlong::Auto);
    let mesh = part("propeller", 0.0)?;
    let entries = entries(&mesh, &profile, task)?;
    let goals = goals(&profile, task)?;

    let mut page = Sheet::new(
        "a-skeleton-hybrid",
        "Zhao et al. 2023: a propeller of 260 × 260 × 20 mm in layers of 2 mm, d1 = 5.39 mm, d2 = 5 mm, ER2319 wire of \
         1.2 mm at 6 m/min. The paper prints no voids and no number of starts: it shows pictures. What is reached is \
         judged over all layers, by the worse of two figures: the part as it is, and turned by 37° about the vertical.",
    );
    goal::tabulate(&mut page, &goals);
    page.heading("The steps on layer 5, to the letter of the paper");
    compare::add_steps(&mut page, &mesh, &literal, StrategyName::Hybrid, LAYER, task).map_err(|e| wrong(&e))?;
    page.heading("The steps on layer 5, our default");
    page.text(
        "Narrow regions get beads along their medial axis, widths follow the room, beads are linked to contours that end \
         near them, and where regions would need more arc starts than contours, the smallest are left to the contours.",
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
    lines.push(format!("KRL of the default hybrid: {} files next to the page", names.len()));
    Ok(Reproduced { page, lines, files })
}

fn wrong(error: &dyn std::fmt::Display) -> ReproduceError {
    ReproduceError(error.to_string())
}

/// An example part, turned about the vertical by some degrees.
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

/// The paper, its two directions of lines, what it is compared with, and our own.
fn entries(mesh: &Mesh, profile: &Profile, task: &Task) -> Result<Vec<Entry>, ReproduceError> {
    let named = |name: &str, profile: &Profile| {
        Ok(Entry { name: name.to_owned(), ..judged(mesh, profile, StrategyName::Hybrid, task)? })
    };
    let mut entries = vec![
        named("hybrid, literal", &literal(profile, ScanAlong::Short))?,
        named("literal, along the long side", &literal(profile, ScanAlong::Long))?,
        named("hybrid, default", profile)?,
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

/// What is judged, by the worst of all turns.
fn goals(profile: &Profile, task: &Task) -> Result<Vec<Goal>, ReproduceError> {
    let (short, long) = (literal(profile, ScanAlong::Short), literal(profile, ScanAlong::Long));
    let starts = |entry: &Entry| entry.totals.arc_starts as f64 / entry.layers.len() as f64;
    let (mut most, mut void, mut saved, mut better): (f64, f64, f64, f64) = (0.0, 0.0, f64::INFINITY, f64::INFINITY);
    for turn in TURNS {
        let mesh = part("propeller", turn)?;
        let [ours, along, contour] =
            [(&short, StrategyName::Hybrid), (&long, StrategyName::Hybrid), (profile, StrategyName::Contour)]
                .map(|(profile, strategy)| judged(&mesh, profile, strategy, task));
        let (ours, along, contour) = (ours?, along?, contour?);
        (most, void) = (most.max(starts(&ours)), void.max(ours.figures.void_percent()));
        saved = saved.min(starts(&contour) - starts(&ours));
        better = better.min(along.figures.void_percent() - ours.figures.void_percent());
    }
    let mut goals = vec![
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
    ];
    for name in PARTS {
        let (mut more, mut times): (f64, f64) = (f64::NEG_INFINITY, f64::INFINITY);
        for turn in TURNS {
            let mesh = part(name, turn)?;
            let (ours, contour) = (
                judged(&mesh, profile, StrategyName::Hybrid, task)?,
                judged(&mesh, profile, StrategyName::Contour, task)?,
            );
            more = more.max(starts(&ours) - starts(&contour));
            times = times.min(contour.figures.void_percent() / ours.figures.void_percent().max(1e-3));
        }
        goals.push(Goal::new(
            &format!("default, {name}: no more arc starts a layer than contours, and a fifth of their voids"),
            format!("{more:+.1} starts, voids divided by {times:.1}"),
            "not given",
            more <= 0.0 && times >= 5.0,
        ));
    }
    Ok(goals)
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
