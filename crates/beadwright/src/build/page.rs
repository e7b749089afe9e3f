//! The page of a build: the error of the height layer by layer, as curves and from above, for each kind of feedback.

use super::{Built, Settings};
use crate::adapt::Feedback;
use crate::adapt::page::cells;
use crate::deposit::Picture;
use crate::number::fixed;
use crate::report::plot::{Curve, Plot};
use crate::report::sheet::{Row, Sheet};
use glam::DVec2;

/// The name of a kind of feedback, for people.
pub fn name(by: Feedback) -> &'static str {
    match by {
        Feedback::None => "open loop",
        Feedback::Mean => "mean height",
        Feedback::Place => "by place",
    }
}

/// The page of a part that was built in different ways.
pub fn page(part: &str, builds: &[Built], settings: &Settings) -> Sheet {
    let errors = &settings.errors;
    let lost = errors.lost.map_or("no pass lost".to_owned(), |pass| format!("pass {pass} lost"));
    let lead = format!(
        "Welded in the height model: ±{} % from pass to pass, ±{} % along them over {} mm, {:+} % over the build, {lost}; \
         scans with ±{} mm; seed {}.",
        100.0 * errors.pass,
        100.0 * errors.along,
        errors.correlation,
        100.0 * errors.drift,
        errors.scan,
        errors.seed
    );
    let mut sheet = Sheet::new(&format!("Build: {part}"), &lead);
    let head =
        ["feedback", "layers", "pieces clipped", "mean mm", "RMS mm", "lowest mm", "highest mm", "RMS in layers"];
    let best = builds.iter().map(Built::rms).fold(f64::INFINITY, f64::min);
    let row = |built: &Built| -> Row {
        let clipped = format!("{} of {}", built.clipped, built.pieces);
        let begin = [name(built.by).to_owned(), built.layers.len().to_string(), clipped].map(|text| (text, false));
        let rms = (fixed(built.rms(), 3), built.rms() == best);
        begin.into_iter().chain(cells(&built.end)).chain([rms]).collect()
    };
    sheet
        .heading("The final top, against the end of the plan")
        .table(&head, &builds.iter().map(row).collect::<Vec<_>>());
    sheet.heading("Layer by layer");
    sheet.text(
        "Height of the top against its target: the plan, or with feedback the height aimed at after the scan below.",
    );
    sheet.svg(
        &plot("Error of the height (RMS)", builds, |built, i| built.layers[i].error.rms / built.layer_height).svg(),
    );
    sheet.svg(
        &plot("Mean error of the height", builds, |built, i| built.layers[i].error.mean / built.layer_height).svg(),
    );
    pictures(&mut sheet, builds);
    sheet
}

fn plot(title: &str, builds: &[Built], value: impl Fn(&Built, usize) -> f64) -> Plot {
    let curve = |built: &Built| Curve {
        name: name(built.by).to_owned(),
        points: (0..built.layers.len()).map(|i| DVec2::new((i + 1) as f64, value(built, i))).collect(),
    };
    Plot {
        title: title.to_owned(),
        x: "layer".to_owned(),
        y: "layer heights".to_owned(),
        curves: builds.iter().map(curve).collect(),
        ..Plot::default()
    }
}

/// The tops after layers, against their targets.
fn pictures(sheet: &mut Sheet, builds: &[Built]) {
    let count = builds.iter().map(|built| built.layers.len()).max().unwrap_or_default();
    let shown: Vec<usize> = (0..count).filter(|&i| builds.iter().any(|built| picture(built, i).is_some())).collect();
    let labels: Vec<String> = shown.iter().map(|i| format!("layer {}", i + 1)).collect();
    let columns: Vec<(String, Vec<Option<&Picture>>)> = builds
        .iter()
        .map(|built| (name(built.by).to_owned(), shown.iter().map(|&i| picture(built, i)).collect()))
        .collect();
    let most = builds.first().map_or(1.0, |built| built.layer_height);
    sheet.heading("The top after a layer, against its target").heights(most, &labels, &columns);
}

fn picture(built: &Built, layer: usize) -> Option<&Picture> {
    built.layers.get(layer)?.picture.as_ref()
}
