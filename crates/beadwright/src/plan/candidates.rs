//! Fills an island that its strategy cannot fill: with the one of several strategies that the deposit model finds best.

use super::filled::Filling;
use crate::deposit::Judge;
use crate::fill::contour::Contour;
use crate::fill::fermat::Fermat;
use crate::fill::hybrid::Hybrid;
use crate::fill::mat::Mat;
use crate::fill::one_loop::OneLoop;
use crate::fill::spiral::Spiral;
use crate::fill::{Fill, FillSettings, Strategy};
use crate::layer::Layer;
use planar::Polygon;

/// Strategies that are tried; the first of equally good ones is taken. Scan lines are not tried: they leave outlines
/// ragged.
const TRIED: [&dyn Strategy; 6] = [&OneLoop, &Spiral, &Fermat, &Mat, &Hybrid, &Contour];
/// An arc start counts as much as a void or a hump of this area, in squared bead widths.
const START: f64 = 0.5;

/// Low area counts as this fraction of void area.
const LOW: f64 = 0.5;

/// The first of the strategy's own simpler fills that can be welded, as `is_sound` tells.
pub(super) fn simpler(
    strategy: &dyn Strategy,
    island: &Polygon,
    settings: &FillSettings,
    is_sound: impl Fn(&Fill) -> bool,
) -> Option<Fill> {
    let fill = |settings: FillSettings| strategy.fill(island, &settings);
    strategy.simpler(settings).into_iter().map(fill).find(|fill| is_sound(fill))
}

/// The best fill that can be welded by any strategy.
pub(super) fn best(
    island: &Polygon,
    settings: &FillSettings,
    filling: &Filling,
    is_sound: impl Fn(&Fill) -> bool,
) -> Option<Fill> {
    let fills = TRIED.iter().filter_map(|strategy| {
        let fill = Some(strategy.fill(island, settings)).filter(&is_sound);
        fill.or_else(|| simpler(*strategy, island, settings, &is_sound))
    });
    let rated = fills.map(|fill| (cost(&fill, island, settings, filling), fill));
    rated.min_by(|(a, _), (b, _)| a.total_cmp(b)).map(|(_, fill)| fill)
}

/// Voids, low area, humps and metal outside, plus the area that arc starts count for, mm².
fn cost(fill: &Fill, island: &Polygon, settings: &FillSettings, filling: &Filling) -> f64 {
    let (z, height, index) = (filling.height, filling.height, settings.layer);
    let passes = filling.laying.passes(vec![fill.clone()], index, (z, height), &mut None);
    let starts = passes.len() as f64;
    let layer = Layer { index, z, height, islands: vec![island.clone()], passes, ..Layer::default() };
    let figures = Judge::new(filling.deposit).without_patches().layer(&layer).figures;
    figures.void + LOW * figures.low + figures.overfill + figures.outside + START * starts * settings.bead.width.powi(2)
}
