//! Zhao et al. 2023: the contour-skeleton hybrid on a propeller of 260 × 260 × 20 mm with the values of their table 1.

use super::{ReproduceError, Reproduced};
use crate::bead::MassBalance;
use crate::compare::{self, Chosen, Entry};
use crate::dialect;
use crate::example;
use crate::model::Mesh;
use crate::plan;
use crate::profile::Profile;
use crate::report::sheet::Sheet;
use crate::task::Task;
use std::collections::BTreeSet;

/// The speed that the abstract of the paper would need if its printed 0.02 m/min were 0.02 m/s, mm/s.
const PRINTED_SPEED: f64 = 20.0;
/// Index of the layer that is drawn, from 0.
const LAYER: usize = 4;

/// Runs the experiment.
///
/// # Errors
/// [`ReproduceError`] when the task was cancelled.
pub fn run(task: &Task) -> Result<Reproduced, ReproduceError> {
    let wrong = |e: &dyn std::fmt::Display| ReproduceError(e.to_string());
    let mut profile = Profile::built_in("cmt-al2319-kuka").map_err(|e| wrong(&e))?;
    profile.fill.strategy = "hybrid".to_owned();
    let part = example::find("propeller").ok_or_else(|| wrong(&"there is no example part called propeller"))?;
    let mesh = part.mesh();

    let mut page = Sheet::new(
        "a-skeleton-hybrid",
        "Zhao et al. 2023: a propeller of 260 × 260 × 20 mm in layers of 2 mm, d1 = 5.39 mm, d2 = 5 mm, ER2319 wire of \
         1.2 mm at 6 m/min.",
    );
    page.heading("The steps on layer 5");
    compare::add_steps(&mut page, &mesh, &profile, "hybrid", LAYER, task).map_err(|e| wrong(&e))?;
    let entries = entries(&mesh, &profile, task)?;
    page.heading("What the deposit model says of layer 5");
    compare::tabulate(&mut page, &entries);
    let maps: Vec<_> = entries.iter().map(|e| (e.name.clone(), vec![e.layers[0].picture.as_ref()])).collect();
    page.maps(&["layer 5".to_owned()], &maps);
    page.heading("Does the wire fit the speed?");
    let finding = balance(&profile);
    page.text(&finding);

    let mut lines: Vec<String> = entries.iter().map(line).collect();
    lines.push(finding);
    let plan = plan::plan("propeller", &mesh, &profile, task).map_err(|e| wrong(&e))?;
    let files: Vec<_> =
        dialect::write("krl", &plan.layers, &profile.job("propeller")).map_err(|e| wrong(&e))?.into_iter().collect();
    let names: BTreeSet<&String> = files.iter().map(|(name, _)| name).collect();
    lines.push(format!("KRL of the default hybrid: {} files beside the page", names.len()));
    Ok(Reproduced { page, lines, files })
}

/// Layer 5 planned with every strategy, and to the letter of the paper.
fn entries(mesh: &Mesh, profile: &Profile, task: &Task) -> Result<Vec<Entry>, ReproduceError> {
    let (settings, chosen): (_, Chosen) = (plan::deposit_settings(profile), Some(BTreeSet::from([LAYER])));
    let mut literal = profile.clone();
    literal.hybrid.literal = true;
    let runs =
        [("contour", profile), ("zigzag", profile), ("compound", profile), ("hybrid", &literal), ("hybrid", profile)];
    let entry = |(name, profile): (&str, &Profile)| {
        let mut entry = compare::strategy(mesh, profile, name, settings, &chosen, task)
            .map_err(|e| ReproduceError(e.to_string()))?;
        if profile.hybrid.literal {
            entry.name = "hybrid, literal".to_owned();
        }
        Ok(entry)
    };
    runs.into_iter().map(entry).collect()
}

fn line(entry: &Entry) -> String {
    let (f, t) = (&entry.figures, &entry.totals);
    format!(
        "{:<16} void {:5.2} %  overfill {:5.2} %  arc starts of all layers {:4}",
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
