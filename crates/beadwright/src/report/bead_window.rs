//! The process window of a bead library: width/height over one input, a curve for every value of a second one
//! (Li et al., Fig. 4).

use super::plot::{Curve, Plot};
use crate::bead::library::{BeadLibrary, Input, PREFERRED_RATIOS, Sample};
use glam::DVec2;

/// Points of a curve.
const POINTS: usize = 121;
/// Maximum number of curves: as many as can be distinguished.
const CURVES: usize = 6;

/// λ over the first input, by values of the second; further inputs are held at the middle of their range. A curve is drawn
/// only where the library gives an answer; dots are the measured beads on it.
pub fn plot(library: &BeadLibrary) -> Plot {
    let Some(first) = library.inputs.first() else { return Plot::default() };
    let second = library.inputs.get(1);
    let values = second.map_or(vec![0.0], |_| levels(library));
    let curves = values.iter().map(|&value| Curve {
        name: second.map_or("λ".to_owned(), |input| format!("{} {}", short(value), input.unit)),
        points: curve(library, first, value),
    });
    let held: Vec<String> =
        library.inputs.iter().skip(2).map(|i| format!("{} {} {}", i.name, short(middle(i)), i.unit)).collect();
    let held = if held.is_empty() { String::new() } else { format!(", at {}", held.join(", ")) };
    let by = second.map_or(String::new(), |i| format!(" by {}", i.name.replace('_', " ")));
    let warning = if library.synthetic { " (SYNTHETIC data, not measured)" } else { "" };
    let (low, high) = PREFERRED_RATIOS;
    Plot {
        title: format!("Width/height λ over {}{by}{held}{warning}", first.name.replace('_', " ")),
        x: axis(first),
        y: "λ = width / height".to_owned(),
        curves: curves.collect(),
        bands: vec![(low, high, format!("good beads, λ {low} to {high}"))],
        dots: values.iter().map(|&value| dots(library, value)).collect(),
        floating: true,
        ..Plot::default()
    }
}

/// The measured values of the second input, or evenly spaced ones where there are too many.
fn levels(library: &BeadLibrary) -> Vec<f64> {
    let mut values: Vec<f64> = library.measured.iter().map(|s| s.inputs[1]).collect();
    values.sort_by(f64::total_cmp);
    values.dedup();
    if values.len() > CURVES {
        let Input { min, max, .. } = library.inputs[1];
        values = (0..CURVES - 1).map(|k| min + (max - min) * k as f64 / (CURVES - 2) as f64).collect();
    }
    values
}

fn curve(library: &BeadLibrary, first: &Input, value: f64) -> Vec<DVec2> {
    let at = |k: usize| first.min + (first.max - first.min) * k as f64 / (POINTS - 1) as f64;
    let point = |x: f64| {
        let rest = library.inputs.iter().enumerate().map(|(i, input)| if i == 1 { value } else { middle(input) });
        let inputs: Vec<f64> = std::iter::once(x).chain(rest.skip(1)).collect();
        library.predict(&inputs).ok().map(|found| DVec2::new(x, found.ratio()))
    };
    // The last point may miss the greatest value by rounding.
    (0..POINTS).filter_map(|k| point(at(k).min(first.max))).collect()
}

/// The measured beads on a curve; any inputs after the second must lie at the middle of their range too.
fn dots(library: &BeadLibrary, value: f64) -> Vec<DVec2> {
    let on = |s: &&Sample| {
        let held =
            library.inputs.iter().zip(&s.inputs).skip(2).all(|(i, v)| (v - middle(i)).abs() <= 1e-9 * (i.max - i.min));
        held && s.inputs.get(1).is_none_or(|v| *v == value)
    };
    library.measured.iter().filter(on).map(|s| DVec2::new(s.inputs[0], s.width / s.height)).collect()
}

fn middle(input: &Input) -> f64 {
    0.5 * (input.min + input.max)
}

fn axis(input: &Input) -> String {
    let name = input.name.replace('_', " ");
    if input.unit.is_empty() { name } else { format!("{name}, {}", input.unit) }
}

/// Four significant digits at most.
fn short(value: f64) -> String {
    format!("{value:.3e}").parse::<f64>().unwrap_or(value).to_string()
}
