//! Plots over the raster angle: turns, length of the scan lines, area laid twice at the turns (Han et al. 2018, figures
//! of 3.1).

use super::plot::{Curve, Plot};
use crate::fill::angle::{self, Curves};
use crate::fill::{FillSettings, Strategy};
use crate::layer::Layer;
use crate::pass::PassKind;

/// The plots; the x axis is the angle, °. `mark` is the angle that is laid, °.
pub fn plots(curves: &Curves, mark: Option<f64>) -> [Plot; 3] {
    let plot = |title: &str, y: &str, points: &Vec<glam::DVec2>| Plot {
        title: title.to_owned(),
        x: "raster angle, °".to_owned(),
        y: y.to_owned(),
        curves: vec![Curve { name: y.to_owned(), points: points.clone() }],
        marks: mark.iter().map(|angle| (*angle, format!("{angle:.1}°"))).collect(),
        floating: true,
        ..Plot::default()
    };
    [
        plot("Turns over the raster angle", "turns", &curves.turns),
        plot("Length of the scan lines over the raster angle", "mm", &curves.length),
        plot("Area laid twice at the turns over the raster angle", "mm²", &curves.corner_area),
    ]
}

/// The plots of one layer as a section of the report; nothing for strategies without scan lines.
pub(super) fn section(layer: &Layer, strategy: &dyn Strategy, settings: &FillSettings) -> String {
    let curves = angle::curves(strategy, &layer.islands, settings);
    if curves.turns.is_empty() {
        return String::new();
    }
    let pictures: String = plots(&curves, laid(layer)).iter().map(Plot::svg).collect();
    format!(
        "<section class=\"card\"><h2>Raster angle, layer {}</h2>\n<div class=\"plots\" role=\"group\" tabindex=\"0\" aria-label=\"Plots over the raster angle\">{pictures}</div>\n</section>",
        layer.index + 1
    )
}

/// The angle at which the scan lines of a layer were laid, °: that of the longest piece of infill.
fn laid(layer: &Layer) -> Option<f64> {
    let infill = layer.passes.iter().filter(|pass| pass.kind == PassKind::Infill);
    let longest = infill.flat_map(|pass| pass.segments()).max_by(|a, b| a.length().total_cmp(&b.length()))?;
    let degrees = (longest.to - longest.from).truncate().to_angle().to_degrees().rem_euclid(180.0);
    // Rounding must not turn 0° into 180°.
    Some(if degrees > 179.95 { 0.0 } else { degrees })
}
