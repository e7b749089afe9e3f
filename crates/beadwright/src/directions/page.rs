//! The page of the divisions of a part: each in 3-D with its bodies in colours, and the figures of all.

use super::{Found, Outcome, Tried};
use crate::chart::Chart;
use crate::model::Mesh;
use crate::number::fixed;
use crate::palette;
use crate::profile::Body;
use crate::report::coloured::Coloured;
use crate::report::sheet::{Row, Sheet};
use glam::DVec3;

/// The page; `mesh` is the part that was divided.
pub fn page(name: &str, mesh: &Mesh, found: &Found) -> Sheet {
    let tried = found.divisions.iter().any(|tried| tried.outcome != Outcome::Untried);
    let how = if tried {
        "Each division was planned for trial; what can be welded comes first, the cheapest at the top"
    } else {
        "The divisions as they were found, not planned for trial"
    };
    let lead = format!("{how}. In level layers, {:.1} cm² of the part overhang.", found.level / 100.0);
    let mut sheet = Sheet::new(&format!("Directions: {name}"), &lead);
    let head = ["division", "bodies", "overhang, cm²", "from level, °", "time, h", "wire, kg", "price", "covered, %"];
    let offered: Vec<&Tried> = found.offered().collect();
    let rows: Vec<Row> = offered.iter().enumerate().map(|(k, tried)| row(k + 1, tried)).collect();
    sheet.table(&head, &rows);
    for (k, tried) in offered.iter().enumerate() {
        sheet.heading(&format!("{}. {}", k + 1, tried.described()));
        if let Some(verdict) = tried.verdict() {
            sheet.text(&verdict);
        }
        sheet.coloured("The part in its bodies", &coloured(mesh, &tried.bodies));
    }
    sheet
}

/// The figures of a division; those of the first are marked if it can be welded.
fn row(number: usize, tried: &Tried) -> Row {
    let planned = match &tried.outcome {
        Outcome::Planned(metrics) => [
            fixed(metrics.total_time_s / 3600.0, 2),
            fixed(metrics.wire_mass_kg, 2),
            metrics.cost.map_or("–".to_owned(), |cost| format!("{cost:.0} {}", metrics.currency)),
            fixed(100.0 * metrics.coverage(), 1),
        ],
        Outcome::Refused { .. } => ["cannot be welded", "–", "–", "–"].map(str::to_owned),
        Outcome::Untried => ["not planned", "–", "–", "–"].map(str::to_owned),
    };
    let found = [
        number.to_string(),
        tried.bodies.len().to_string(),
        fixed(tried.division.hanging / 100.0, 1),
        fixed(tried.division.tilt, 0),
    ];
    let is_best = number == 1 && tried.is_planned();
    found.into_iter().chain(planned).map(|text| (text, is_best)).collect()
}

/// The part with each body in a colour of its own.
fn coloured(mesh: &Mesh, bodies: &[Body]) -> Coloured {
    let mut surfaces = Coloured::default();
    for (k, body) in bodies.iter().enumerate() {
        let name = format!("{}: {}", body.name, layers(&body.chart));
        surfaces.add(&name, &body.of_mesh(mesh), palette::body(k));
    }
    surfaces
}

/// How layers lie, in a few words.
fn layers(chart: &Chart) -> String {
    match chart {
        chart if chart.is_level() => "level layers".to_owned(),
        Chart::Plane(plane) => format!("flat layers, {:.0}° from level", plane.up.angle_between(DVec3::Z).to_degrees()),
        Chart::Cylinder(around) => format!("layers around a cylinder of {:.1} mm radius", around.radius),
        Chart::Guide(_) => "layers along its middle line".to_owned(),
        chart => format!("layers on {chart}"),
    }
}
