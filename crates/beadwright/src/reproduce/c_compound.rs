//! Liu et al. 2022, figure 7: four paths on a cross, and a sweep of the distance between contour and zigzag.

use super::{ReproduceError, Reproduced};
use crate::compare::{self, Entry};
use crate::example;
use crate::plan;
use crate::profile::{Profile, RasterTurn};
use crate::report::plot::{Curve, Plot};
use crate::report::sheet::Sheet;
use crate::task::Task;
use glam::DVec2;
use std::collections::BTreeSet;

/// The paper's distance between contour and zigzag, in bead widths.
const PAPER: f64 = 0.591;
/// The stepover of the zigzag lines, in bead widths.
const TANGENT: f64 = 0.738;

/// What the paper says of its four specimens.
const SPECIMENS: [(&str, &str, f64, &str); 4] = [
    ("zigzag", "zigzag only", PAPER, "the outline is ragged"),
    ("contour", "contour only", PAPER, "pores along the middle"),
    ("compound", "compound, 0.738 w", TANGENT, "pores where zigzag meets contour"),
    ("compound", "compound, 0.591 w", PAPER, "dense, the shape is kept"),
];

/// Runs the experiment.
///
/// # Errors
/// [`ReproduceError`] when the task was cancelled.
pub fn run(task: &Task) -> Result<Reproduced, ReproduceError> {
    let judged = |strategy: &str, gap: f64| entry_of(strategy, gap, task);
    let mut specimens = Vec::new();
    for (strategy, name, gap, words) in SPECIMENS {
        specimens.push((name, words, judged(strategy, gap)?));
    }
    let gaps: Vec<f64> = (0..=35).map(|k| 0.45 + 0.01 * f64::from(k)).collect();
    let mut sweep = Vec::new();
    for &gap in &gaps {
        sweep.push((gap, judged("compound", gap)?));
    }
    let mut page = Sheet::new(
        "c-compound",
        "Liu et al. 2022, figure 7: a cross of 100 mm with arms of 36 mm, beads of 5 mm, one layer, scan lines parallel to y.",
    );
    let rows: Vec<_> = specimens.iter().map(|(name, words, entry)| row(name, words, entry)).collect();
    page.heading("Four paths");
    page.table(&["path", "the paper says", "void %", "low %", "overfill %", "outside %", "arc starts"], &rows);
    let maps: Vec<_> =
        specimens.iter().map(|(name, _, e)| ((*name).to_owned(), vec![e.layers[0].picture.as_ref()])).collect();
    page.maps(&["layer 1".to_owned()], &maps);
    page.heading("The distance from contour to zigzag");
    page.text(
        "Too far, and pores appear where the zigzag turns away from the contour; too near, and metal piles up there. \
         The paper's 0.591 w lies where pores have all but gone and humps are still low.",
    );
    page.svg(&plot(&sweep).svg());
    Ok(Reproduced { page, lines: lines(&specimens, &sweep), files: Vec::new() })
}

fn entry_of(strategy: &str, gap: f64, task: &Task) -> Result<Entry, ReproduceError> {
    let wrong = |e: &dyn std::fmt::Display| ReproduceError(e.to_string());
    let mut profile = Profile::built_in("plasma-304-cnc").map_err(|e| wrong(&e))?;
    profile.fill.contour_gap = gap;
    profile.fill.raster_angle = 90.0;
    profile.fill.raster_turn = RasterTurn::Fixed;
    let part = example::find("cross").ok_or_else(|| wrong(&"there is no example part called cross"))?;
    let mut mesh = part.mesh();
    // One layer is enough.
    let height = profile.layers.height;
    mesh.vertices.iter_mut().for_each(|v| v.z = v.z.min(height));
    let chosen = Some(BTreeSet::from([0]));
    let settings = plan::deposit_settings(&profile);
    compare::strategy(&mesh, &profile, strategy, settings, &chosen, task).map_err(|e| wrong(&e))
}

fn row(name: &str, words: &str, entry: &Entry) -> Vec<(String, bool)> {
    let f = &entry.figures;
    let percents = [f.void_percent(), f.low_percent(), f.overfill_percent(), f.outside_percent()];
    let texts = [name.to_owned(), words.to_owned()].into_iter().chain(percents.map(|v| format!("{v:.2}")));
    texts.chain([entry.totals.arc_starts.to_string()]).map(|text| (text, false)).collect()
}

fn plot(sweep: &[(f64, Entry)]) -> Plot {
    let curve = |name: &str, value: fn(&Entry) -> f64| Curve {
        name: name.to_owned(),
        points: sweep.iter().map(|(gap, entry)| DVec2::new(*gap, value(entry))).collect(),
    };
    Plot {
        title: "Pores and humps over the distance of contour and zigzag".to_owned(),
        x: "distance, bead widths".to_owned(),
        y: "% of the area".to_owned(),
        curves: vec![curve("void", |e| e.figures.void_percent()), curve("overfill", |e| e.figures.overfill_percent())],
        marks: vec![(PAPER, "0.591 w".to_owned()), (TANGENT, "0.738 w".to_owned())],
        ..Plot::default()
    }
}

fn lines(specimens: &[(&str, &str, Entry)], sweep: &[(f64, Entry)]) -> Vec<String> {
    let mut lines: Vec<String> = specimens
        .iter()
        .map(|(name, words, e)| {
            let f = &e.figures;
            format!(
                "{name:<20} void {:5.2} %  overfill {:5.2} %   paper: {words}",
                f.void_percent(),
                f.overfill_percent()
            )
        })
        .collect();
    if let [_, _, (_, _, far), (_, _, near)] = specimens {
        let (far, near) = (far.figures.void_percent(), near.figures.void_percent());
        lines.push(format!("void at 0.738 w over void at 0.591 w: {:.1}", far / near.max(1e-9)));
    }
    let without = sweep.iter().take_while(|(_, e)| e.figures.void_percent() < 0.1).last();
    lines.extend(without.map(|(gap, _)| format!("void stays under 0.1 % up to a distance of {gap:.2} w")));
    lines
}
