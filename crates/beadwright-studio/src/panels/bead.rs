//! The chosen bead in one line, the same over every view.

use super::clock::clock;
use super::place;
use crate::known::{Known, View};
use crate::view::Mode;
use eframe::egui::Ui;

pub(super) fn show(known: Known<'_>, view: &View<'_>, ui: &mut Ui) {
    // Always one line, so that the view stays where it is.
    if view.state.laying {
        ui.strong(known.t("lay-hint"));
        return;
    }
    if view.state.placing && view.state.mode == Mode::Solid {
        ui.strong(place::moved(known, view));
        return;
    }
    ui.horizontal(|ui| match figures(known, view) {
        Some(figures) => {
            ui.strong(known.t("chosen"));
            for (i, text) in figures.into_iter().enumerate() {
                if i > 0 {
                    ui.weak("·");
                }
                ui.label(text);
            }
        }
        None => drop(ui.weak(known.t("nothing-chosen"))),
    });
}

/// Layer, pass, kind, width, speed, time and temperature of the chosen bead.
fn figures(known: Known<'_>, view: &View<'_>) -> Option<Vec<String>> {
    let (layer, pass, piece) = view.state.chosen?;
    let (plan, scene) = (&known.plans.own, &known.plans.own.scene);
    let beads = scene.layer(layer)?;
    let found = plan.layer(layer)?.passes.get(pass)?;
    let segment = known.pick((layer, pass, piece))?.segment;
    let seconds = scene.seconds_before(layer) + beads.times(segment)?.0;
    let mut figures = vec![
        format!("{} {}", known.t("layer"), layer + 1),
        format!("{} {} / {}", known.t("pass"), pass + 1, beads.passes().len()),
        known.language().word("kind", found.kind.name()),
        format!("{} {:.2} mm", known.t("width"), beads.beads().get(segment)?.width()),
        format!("{:.2} mm/s", beads.speed(segment)?),
        format!("{} {}", known.t("at-time"), clock(seconds)),
    ];
    figures.extend(scene.temperature(layer, pass).map(|degrees| format!("{degrees:.0} °C")));
    Some(figures)
}
