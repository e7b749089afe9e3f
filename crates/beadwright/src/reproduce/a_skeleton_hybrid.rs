//! Zhao et al. 2023: the contour-skeleton hybrid on a propeller of 260 × 260 × 20 mm with the values of their table 1.

use super::{ReproduceError, Reproduced};
use crate::bead::MassBalance;
use crate::compare::{self, Chosen, Entry};
use crate::example;
use crate::fill::hybrid::{Steps, pockets::Pocket};
use crate::model::Mesh;
use crate::plan;
use crate::post;
use crate::profile::Profile;
use crate::program::Programmer;
use crate::report::sheet::Sheet;
use crate::report::sketch::Sketch;
use crate::slice::Slicer;
use crate::task::Task;
use planar::{Bounds, Polygon, Region};
use std::collections::BTreeSet;

/// The speed that the abstract of the paper would need at 0.02 m/s, mm/s.
const PRINTED_SPEED: f64 = 20.0;
/// The layer that is drawn, from 0.
const LAYER: usize = 4;

const CONTOUR: &str = "#1f6fd6";
const CUT: &str = "#e8862a";
const KEPT: &str = "#7e57c2";
const DROPPED: &str = "#c4c9d1";
const SLICE: &str = "#eef0f3";

/// Does the experiment.
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
    stages(&mesh, &profile, task).map_err(|e| wrong(&e))?.iter().for_each(|sketch| {
        page.svg(&sketch.svg());
    });
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
    let files = krl(&mesh, &profile, task).map_err(|e| wrong(&e))?;
    let names: BTreeSet<&String> = files.iter().map(|(name, _)| name).collect();
    lines.push(format!("KRL of the default hybrid: {} files beside the page", names.len()));
    Ok(Reproduced { page, lines, files })
}

/// The four pictures of the paper's figure 4.
fn stages(mesh: &Mesh, profile: &Profile, task: &Task) -> Result<Vec<Sketch>, crate::task::Cancelled> {
    let layers = Slicer::new(mesh, profile.slice_options(), task)?.all(task)?;
    let islands: &[Polygon] = layers.get(LAYER).map_or(&[], |layer| &layer.islands);
    let slice = Region::from_normalised(islands.to_vec());
    let bounds = slice.bounds().unwrap_or(Bounds { min: glam::DVec2::ZERO, max: glam::DVec2::ONE });
    let titles = ["1. Contours and their pockets", "2. Skeleton regions", "3. Contours, cut", "4. Passes"];
    let mut sketches = titles.map(|title| Sketch::new(bounds, title));
    sketches.iter_mut().for_each(|sketch| {
        sketch.region(&slice, SLICE);
    });
    let settings = profile.fill_settings(LAYER);
    let thin = 0.004 * bounds.size().max_element();
    for island in islands {
        let steps = Steps::of(island, &settings);
        let [pockets, regions, cut, passes] = &mut sketches;
        for level in &steps.levels {
            let of = |kept: bool| {
                let chosen = level.pockets.iter().filter(|p: &&Pocket| p.kept == kept).map(|p| p.shape.clone());
                Region::from_normalised(chosen.collect())
            };
            pockets.region(&of(false), DROPPED).region(&of(true), KEPT);
            for ring in level.region.rings() {
                pockets.line(ring.points(), true, CONTOUR, thin / 2.0);
            }
        }
        regions.region(&steps.regions, KEPT);
        for (_, ring) in &steps.contours.complete {
            cut.line(ring.points(), true, CONTOUR, thin);
        }
        for piece in &steps.contours.incomplete {
            cut.line(&piece.points, false, CUT, thin);
        }
        for (list, colour) in [(&steps.skeleton, KEPT), (&steps.chains, CONTOUR)] {
            for pass in list {
                passes.line(&pass.points, pass.closed, colour, thin);
            }
        }
    }
    Ok(sketches.into())
}

/// Layer 5 by every strategy, and by the paper to the letter.
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

fn krl(mesh: &Mesh, profile: &Profile, task: &Task) -> Result<Vec<(String, String)>, Box<dyn std::error::Error>> {
    let plan = plan::plan("propeller", mesh, profile, task)?;
    let mut post = post::post("krl", "propeller", profile)?;
    let mut programmer = Programmer::new(profile.travel.clearance);
    let mut chunks = post.begin(plan.layers.len());
    plan.layers.iter().for_each(|layer| chunks.extend(post.layer(&programmer.layer(layer))));
    chunks.extend(post.end(programmer.leave()));
    Ok(chunks.into_iter().map(|chunk| (chunk.file, chunk.text)).collect())
}
