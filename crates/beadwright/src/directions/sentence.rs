//! Divisions in sentences.

use super::{Division, Outcome, Tried};
use crate::chart::Chart;
use glam::DVec3;

impl Tried {
    /// What the part is divided into, without a full stop.
    pub fn about(&self) -> String {
        let Division { pieces, hanging, tilt, lean } = &self.division;
        let bodies = match &pieces[..] {
            [_] if self.is_level() => return "level layers".to_owned(),
            [piece] => format!("1 body, {}", layers(&piece.chart)),
            pieces => format!("{} bodies", pieces.len()),
        };
        let stock =
            if self.needs_stock() { ", on metal that is there already (the hub, turned from bar stock)" } else { "" };
        let leans = lean.map_or(String::new(), |lean| {
            format!(
                ", walls that lean by up to {lean:.0}° (square to them, layers would begin with no room for a bead)"
            )
        });
        format!("{bodies}{stock}: {:.1} cm² overhang, layers at up to {tilt:.0}° from level{leans}", hanging / 100.0)
    }

    /// What came of planning it, as a sentence; `None` if it was not planned.
    pub fn verdict(&self) -> Option<String> {
        match &self.outcome {
            Outcome::Untried => None,
            Outcome::Planned(metrics) => {
                let price = metrics.cost.map_or(String::new(), |cost| format!(", {cost:.0} {}", metrics.currency));
                let hours = metrics.total_time_s / 3600.0;
                Some(format!("It can be welded: {hours:.2} h, {:.2} kg of wire{price}.", metrics.wire_mass_kg))
            }
            Outcome::Refused { reason, orders, .. } => {
                let tried = match orders {
                    0 => String::new(),
                    1 => " The other order was tried, too.".to_owned(),
                    orders => format!(" {orders} other orders were tried, too."),
                };
                Some(format!("It cannot be welded: {reason}{tried}"))
            }
        }
    }
}

/// How layers lie, in a few words.
pub(super) fn layers(chart: &Chart) -> String {
    match chart {
        chart if chart.is_level() => "level layers".to_owned(),
        Chart::Plane(plane) => format!("flat layers, {:.0}° from level", plane.up.angle_between(DVec3::Z).to_degrees()),
        Chart::Cylinder(around) => format!("layers around a cylinder of {:.1} mm radius", around.radius),
        Chart::Guide(guide) => format!("layers along its middle line, {:.0} mm long", guide.length()),
        chart => format!("layers on {chart}"),
    }
}
