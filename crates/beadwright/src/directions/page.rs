//! The page of the divisions of a part: each in 3-D with its bodies in colours, and the figures of all.

use super::sentence::layers;
use super::{Found, Metal, Outcome, Tried, metal};
use crate::model::Mesh;
use crate::number::fixed;
use crate::palette;
use crate::profile::Body;
use crate::report::coloured::Coloured;
use crate::report::sheet::{Row, Sheet};

/// What the picture of a division is called.
const PICTURE: &str = "The part in its bodies";

/// The page; `mesh` is the part that was divided.
pub fn page(name: &str, mesh: &Mesh, found: &Found) -> Sheet {
    let any = |is: fn(&Tried) -> bool| found.divisions.iter().any(is);
    let how = if any(Tried::is_planned) {
        "Each division was planned for trial: what can be welded comes first, the best by price and overhang at the top"
    } else if any(|tried| tried.outcome != Outcome::Untried) {
        "Each division was planned for trial, and none can be welded as it is"
    } else {
        "The divisions as they were found, not planned for trial"
    };
    let lead = format!("{how}. In level layers, {:.1} cm² of the part overhang.", found.level / 100.0);
    let mut sheet = Sheet::new(&format!("Directions: {name}"), &lead);
    let head = [
        "division",
        "bodies",
        "overhang, cm²",
        "steepest layers, °",
        "result",
        "time, h",
        "wire, kg",
        "price",
        "covered, %",
    ];
    let offered: Vec<&Tried> = found.offered().collect();
    let rows: Vec<Row> = offered.iter().enumerate().map(|(k, tried)| row(k + 1, tried)).collect();
    sheet.table(&head, &rows);
    for (k, tried) in offered.iter().enumerate() {
        sheet.heading(&format!("{}. {}", k + 1, tried.about()));
        if let Some(verdict) = tried.verdict() {
            sheet.text(&verdict);
        }
        sheet.coloured(PICTURE, &coloured(mesh, &tried.bodies));
    }
    // It has no number, since it cannot be chosen without more tilt.
    if let (Some(tilted), Some(sentence)) = (&found.tilted, found.about_tilted()) {
        sheet.heading(&format!("Tilted farther: {}", tilted.about())).text(&sentence);
        sheet.coloured(PICTURE, &coloured(mesh, &tilted.bodies));
    }
    sheet
}

/// The figures of a division; those of the first are marked if it can be welded.
fn row(number: usize, tried: &Tried) -> Row {
    let none = ["–"; 4].map(str::to_owned);
    let (result, figures) = match &tried.outcome {
        Outcome::Planned(metrics) => {
            let price = metrics.cost.map_or("–".to_owned(), |cost| format!("{cost:.0} {}", metrics.currency));
            let [hours, mass] = [metrics.total_time_s / 3600.0, metrics.wire_mass_kg].map(|figure| fixed(figure, 2));
            ("can be welded", [hours, mass, price, fixed(100.0 * metrics.coverage(), 1)])
        }
        Outcome::Refused { .. } => ("cannot be welded", none),
        Outcome::Untried => ("not planned", none),
    };
    let found = [
        number.to_string(),
        tried.bodies.len().to_string(),
        fixed(tried.division.hanging / 100.0, 1),
        fixed(tried.division.tilt, 0),
        result.to_owned(),
    ];
    let is_best = number == 1 && tried.is_planned();
    found.into_iter().chain(figures).map(|text| (text, is_best)).collect()
}

/// The part with each body in a colour of its own, and grey what must be there already.
fn coloured(mesh: &Mesh, bodies: &[Body]) -> Coloured {
    let mut surfaces = Coloured::default();
    for Metal { mesh, body, stock } in metal(mesh, bodies) {
        if stock {
            surfaces.add("already there", &mesh, palette::missing(false));
        } else {
            let Body { name, chart, .. } = &bodies[body];
            surfaces.add(&format!("{name}: {}", layers(chart)), &mesh, palette::body(body));
        }
    }
    surfaces
}
