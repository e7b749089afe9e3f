//! The page of a build: the error of the height layer by layer, and what the wall looks like in the end, for each kind of
//! feedback.

use super::{Built, Settings};
use crate::adapt::page::{cells, key, relief};
use crate::adapt::{Feedback, Surface};
use crate::number::fixed;
use crate::report::plot::{Curve, Plot};
use crate::report::sheet::{Row, Sheet};
use glam::DVec2;

/// What people call a kind of feedback.
pub fn name(by: Feedback) -> &'static str {
    match by {
        Feedback::None => "open loop",
        Feedback::Mean => "mean height",
        Feedback::Place => "by place",
    }
}

/// The page of a part that was built in several ways.
pub fn page(part: &str, builds: &[Built], settings: &Settings) -> Sheet {
    let errors = &settings.errors;
    let lost = errors.lost.map_or("no pass lost".to_owned(), |pass| format!("pass {pass} lost"));
    let lead = format!(
        "Welded in the model of height: ±{} % from pass to pass, ±{} % along them over {} mm, {:+} % over the build, {lost}; \
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
        .heading("The top in the end, against the end of the plan")
        .table(&head, &builds.iter().map(row).collect::<Vec<_>>());
    sheet.heading("Layer by layer");
    sheet.text("Height of the top against what it should be: without feedback the plan, with it the height aimed at after the scan below.");
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

/// The last surface of each build, against the end of the plan.
fn pictures(sheet: &mut Sheet, builds: &[Built]) {
    let most = builds
        .iter()
        .flat_map(|built| [built.end.low, built.end.high])
        .fold(0.1, |most: f64, error| most.max(error.abs()));
    let picture = |built: &Built| {
        let inside: &Surface = &built.surface;
        let off = built.above_end;
        relief(inside, most, |i| inside.error(i).map(|error| error + off))
    };
    let pictures: Vec<_> = builds.iter().map(|built| (name(built.by).to_owned(), picture(built))).collect();
    let columns: Vec<_> = pictures.iter().map(|(name, picture)| (name.clone(), vec![Some(picture)])).collect();
    sheet.heading("The last layer, above the end of the plan").heights(&key(most), &["top".to_owned()], &columns);
}
