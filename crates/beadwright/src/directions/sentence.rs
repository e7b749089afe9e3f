//! Divisions in sentences.

use super::{Division, Found, Outcome, Tried};
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
            Outcome::Refused { .. } => Some(format!("It cannot be welded: {}", self.refusal()?)),
        }
    }

    /// Why it cannot be welded, and what was tried; `None` if it can be, or was not planned.
    pub fn refusal(&self) -> Option<String> {
        let Outcome::Refused { reason, orders, .. } = &self.outcome else { return None };
        Some(match orders {
            0 => reason.clone(),
            1 => format!("{reason} The other order was tried, too."),
            orders => format!("{reason} {orders} other orders were tried, too."),
        })
    }
}

impl Found {
    /// What could be welded if its layers may lie farther from level ([`Found::tilted`]), as a sentence.
    pub fn about_tilted(&self) -> Option<String> {
        let Tried { division, bodies, .. } = self.tilted.as_ref()?;
        let (tilt, pieces) = (division.tilt.ceil(), bodies.len());
        Some(format!("As {pieces} bodies it could be welded with --tilt {tilt}, if the part can be turned so far."))
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
