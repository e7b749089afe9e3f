//! `reach.html`: joint angles and margins over the program, and what was found.

use super::plot::{Curve, Plot};
use super::sheet::{Row, Sheet};
use crate::robot::{Cell, Pose, Reach, Stop, Suggestion};
use glam::DVec2;

/// Maximum number of points of a curve: two for each stretch of the path, the least and the greatest value there.
const POINTS: usize = 1200;
/// Maximum number of layer marks.
const MARKS: usize = 12;

/// The page of a reach analysis.
pub fn page(part: &str, cell: &Cell, reach: &Reach, suggestion: Option<&Suggestion>) -> Sheet {
    let verdict = if reach.is_reachable() { "can be welded" } else { "cannot be welded" };
    let lead = format!(
        "{part} {verdict} by {} ({}) with the part's origin at {} and the torch straight down.",
        cell.name,
        cell.description,
        reach.place.sentence()
    );
    let mut sheet = Sheet::new(&format!("Reach: {part}"), &lead);
    if !reach.findings.is_empty() {
        sheet.heading("Findings");
        reach.findings.iter().for_each(|finding| {
            sheet.text(&finding.sentence());
        });
    }
    if let Some(suggestion) = suggestion {
        sheet.heading("A better place").text(&suggestion.sentence());
    }
    sheet.heading("Joints").table(
        &[
            "joint",
            "least °",
            "greatest °",
            "limits °",
            "margin °",
            "speed, arc on °/s",
            "speed, travel °/s",
            "limit °/s",
        ],
        &joint_rows(cell, reach),
    );
    sheet.heading("Over the program");
    let way = way(reach);
    for plot in [angles(reach, &way), margins(reach, &way), torch(reach, &way)] {
        sheet.svg(&plot.svg());
    }
    sheet
}

fn joint_rows(cell: &Cell, reach: &Reach) -> Vec<Row> {
    let row = |joint: usize| {
        let range = reach.joint(joint)?;
        let [low, high] = cell.arm.limits[joint];
        let number = |value: f64| format!("{value:.1}");
        let cells = [
            (joint + 1).to_string(),
            number(range.low),
            number(range.high),
            format!("{low:.0} … {high:.0}"),
            number(range.margin),
            number(range.arc_speed),
            number(range.travel_speed),
            format!("{:.0}", cell.arm.speeds[joint]),
        ];
        Some(cells.into_iter().map(|text| (text, false)).collect())
    };
    (0..6).filter_map(row).collect()
}

/// Distance of each stop from the start along the path, m.
fn way(reach: &Reach) -> Vec<f64> {
    let mut total = 0.0;
    let mut last = None;
    let add = |(stop, _): &(Stop, Option<Pose>)| {
        total += last.replace(stop.at).map_or(0.0, |from: glam::DVec3| from.distance(stop.at)) / 1e3;
        total
    };
    reach.poses.iter().map(add).collect()
}

fn angles(reach: &Reach, way: &[f64]) -> Plot {
    let curve = |j: usize| curve(&format!("J{}", j + 1), reach, way, |pose| pose.joints[j]);
    plot("Joint angles", "angle in °", reach, way, (0..6).map(curve).collect())
}

fn margins(reach: &Reach, way: &[f64]) -> Plot {
    let curves = vec![
        curve("nearest joint limit", reach, way, |pose| pose.margins.nearest_limit().1),
        curve("wrist singularity", reach, way, |pose| pose.margins.wrist),
        curve("straight arm", reach, way, |pose| pose.margins.elbow),
    ];
    plot("Margins", "distance in °", reach, way, curves)
}

fn torch(reach: &Reach, way: &[f64]) -> Plot {
    let curves = vec![curve("torch angle", reach, way, |pose| pose.torch_angle)];
    plot("Rotation of the torch about its axis", "angle in °", reach, way, curves)
}

fn plot(title: &str, y: &str, reach: &Reach, way: &[f64], curves: Vec<Curve>) -> Plot {
    let (title, y) = (title.to_owned(), y.to_owned());
    Plot { title, x: "path of the torch in m".to_owned(), y, curves, marks: layer_marks(reach, way), ..Plot::default() }
}

/// Where layers begin; if there are many, only every n-th.
fn layer_marks(reach: &Reach, way: &[f64]) -> Vec<(f64, String)> {
    let starts: Vec<(f64, usize)> = (0..way.len())
        .filter(|&i| i == 0 || reach.poses[i].0.layer != reach.poses[i - 1].0.layer)
        .map(|i| (way[i], reach.poses[i].0.layer))
        .collect();
    let every = starts.len().div_ceil(MARKS).max(1);
    starts.iter().step_by(every).map(|&(at, layer)| (at, format!("{}", layer + 1))).collect()
}

fn curve(name: &str, reach: &Reach, way: &[f64], value: impl Fn(&Pose) -> f64) -> Curve {
    let points: Vec<DVec2> =
        reach.poses.iter().zip(way).filter_map(|((_, pose), &x)| Some(DVec2::new(x, value(pose.as_ref()?)))).collect();
    let stretch = (2 * points.len()).div_ceil(POINTS).max(1);
    let ends = |stretch: &[DVec2]| {
        let by_y = |a: &&DVec2, b: &&DVec2| a.y.total_cmp(&b.y);
        let mut ends: Vec<DVec2> =
            stretch.iter().min_by(by_y).into_iter().chain(stretch.iter().max_by(by_y)).copied().collect();
        ends.sort_by(|a, b| a.x.total_cmp(&b.x));
        ends
    };
    Curve { name: name.to_owned(), points: points.chunks(stretch).flat_map(ends).collect() }
}
