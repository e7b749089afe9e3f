//! Totals of the plan, and the values of the chosen bead.

use super::words;
use crate::known::{Known, View};
use crate::state::PlanState;
use crate::theme;
use eframe::egui::{Grid, Ui};

pub(super) fn show(known: Known<'_>, view: &View<'_>, ui: &mut Ui) {
    if let Some(part) = &known.plans.own.part {
        let (low, high) = part.bounds();
        let size = high - low;
        ui.label(format!("{}: {:.1} × {:.1} × {:.1} mm", known.t("size"), size.x, size.y, size.z));
        ui.separator();
    }
    let rows = known.plans.own.totals();
    Grid::new("totals").num_columns(2).spacing([24.0, 4.0]).striped(true).show(ui, |ui| {
        for (name, value) in &rows {
            named(known, ui, name);
            match keeps_limits(&known.plans.own, name) {
                Some(true) => {
                    let good = theme::good(ui.visuals().dark_mode);
                    ui.colored_label(good, format!("✔ {value}")).on_hover_text(known.t(limits_of(name)))
                }
                Some(false) => ui.colored_label(ui.visuals().error_fg_color, format!("✖ {value}")),
                None => ui.label(value),
            };
            ui.end_row();
        }
    });
    ui.separator();
    chosen(known, view, ui);
}

/// Whether every layer keeps the limits of what a row says, where there are any and the checks are done.
fn keeps_limits(plan: &PlanState, name: &str) -> Option<bool> {
    let kinds: &[&str] = match name {
        "void / low area" => &["void"],
        "overfill / outside" => &["overfill", "outside"],
        _ => return None,
    };
    let findings = plan.findings.as_ref()?;
    Some(!findings.iter().any(|finding| kinds.contains(&finding.kind)))
}

/// The text on the limits that a row keeps.
fn limits_of(name: &str) -> &'static str {
    if name == "void / low area" { "keeps-void" } else { "keeps-overfill" }
}

/// A row's name, with its meaning as a hint.
pub(super) fn named(known: Known<'_>, ui: &mut Ui, name: &'static str) {
    words::explained(known, ui.label(name_of(known, name)), name);
}

/// A row's name in the language of the window.
fn name_of(known: Known<'_>, name: &'static str) -> &'static str {
    let key = format!("total {name}");
    let printed = known.prints().then(|| known.language().find(&format!("fdm {key}"))).flatten();
    printed.or_else(|| known.language().find(&key)).unwrap_or_else(|| known.t(name))
}

fn chosen(known: Known<'_>, view: &View<'_>, ui: &mut Ui) {
    ui.strong(known.t("chosen"));
    let Some((layer, pass, piece)) = view.state.chosen else {
        ui.weak(known.t("nothing-chosen"));
        return;
    };
    let found = known.plans.own.layer(layer).and_then(|layer| layer.passes.get(pass));
    let (Some(found), Some(profile)) = (found, &known.plans.own.profile) else { return };
    let Some(segment) = found.segments().nth(piece) else { return };
    let process = &profile.process.at_layer(layer);
    let metal: f64 = found.segments().map(|s| s.length() / s.pace).sum();
    let wire = process.wire_feed_speed / 60.0 * metal;
    let heat = process.heat_at(segment.pace);
    let values = [
        ("layer", format!("{}", layer + 1)),
        ("pass", format!("{}", pass + 1)),
        ("kind", known.language().word("kind", found.kind.name())),
        ("length", format!("{:.2} mm", found.length())),
        ("speed", format!("{:.2} mm/s", process.speed_at(segment.pace))),
        ("width", format!("{:.2} mm", segment.width)),
        ("wire", format!("{wire:.2} m")),
        ("duration", format!("{:.1} s", found.seconds(process))),
    ];
    Grid::new("chosen").num_columns(2).spacing([24.0, 4.0]).striped(true).show(ui, |ui| {
        let heat = heat.map(|heat| ("heat-input", format!("{heat:.0} J/mm")));
        for (key, value) in values.into_iter().chain(heat) {
            ui.label(known.worded(key));
            ui.label(value);
            ui.end_row();
        }
    });
}
