//! What depends on the raster angle, as plots: turns, length of the scan lines, area laid twice at the turns
//! (Han et al. 2018, figures of 3.1).

use super::plot::{Curve, Plot};
use crate::fill::angle::{self, Curves};
use crate::fill::{self, FillSettings};
use crate::profile::{Profile, RasterTurn};
use planar::Polygon;

/// The plots; each has the angle in degrees below. `mark` is the angle that is laid, °.
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
pub(super) fn section(middle: &(usize, Vec<Polygon>), profile: &Profile) -> String {
    let (layer, islands) = middle;
    let Some(strategy) = fill::strategy(&profile.fill.strategy) else { return String::new() };
    let settings: FillSettings = profile.fill_settings(*layer);
    let curves = angle::curves(strategy, islands, &settings);
    if curves.turns.is_empty() {
        return String::new();
    }
    let laid = match profile.fill.raster_turn {
        RasterTurn::Best => angle::best(strategy, &[&islands[..]], &settings),
        _ => Some(settings.raster_angle),
    };
    let plots = plots(&curves, laid.map(|a| a.to_degrees().rem_euclid(180.0)));
    let pictures: String = plots.iter().map(Plot::svg).collect();
    format!(
        "<section class=\"card\"><h2>Raster angle, layer {}</h2>\n<div class=\"plots\">{pictures}</div>\n</section>",
        layer + 1
    )
}
