//! The chosen bead in one line, the same over every view.

use super::place;
use crate::studio::Studio;
use crate::view::Mode;
use eframe::egui::Ui;

pub(super) fn show(studio: &Studio, ui: &mut Ui) {
    // Always one line, so that the view stays where it is.
    if studio.view.laying {
        ui.strong(studio.t("lay-hint"));
        return;
    }
    if studio.view.placing && studio.view.mode == Mode::Solid {
        ui.strong(place::told(studio));
        return;
    }
    ui.horizontal(|ui| match figures(studio) {
        Some(figures) => {
            ui.strong(studio.t("chosen"));
            for (i, text) in figures.into_iter().enumerate() {
                if i > 0 {
                    ui.weak("·");
                }
                ui.label(text);
            }
        }
        None => drop(ui.weak(studio.t("nothing-chosen"))),
    });
}

/// Layer, pass, kind, width, speed, time and temperature of the chosen bead.
fn figures(studio: &Studio) -> Option<Vec<String>> {
    let (layer, pass, piece) = studio.view.chosen?;
    let (plan, scene) = (&studio.plans.own, &studio.plans.own.scene);
    let beads = scene.layer(layer)?;
    let (span, found) = (beads.passes().get(pass)?, plan.layer(layer)?.passes.get(pass)?);
    let segment = span.segments.start + piece;
    let seconds = scene.seconds_before(layer) + beads.times(segment)?.0;
    let mut figures = vec![
        format!("{} {}", studio.t("layer"), layer + 1),
        format!("{} {} / {}", studio.t("pass"), pass + 1, beads.passes().len()),
        studio.language().word("kind", found.kind.name()),
        format!("{} {:.2} mm", studio.t("width"), beads.beads().get(segment)?.width()),
        format!("{:.2} mm/s", beads.speed(segment)?),
        format!("{} {}", studio.t("at-time"), clock(seconds)),
    ];
    figures.extend(scene.temperature(layer, pass).map(|degrees| format!("{degrees:.0} °C")));
    Some(figures)
}

/// A time as hours, minutes and seconds.
fn clock(seconds: f64) -> String {
    let whole = seconds.round() as u64;
    format!("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60)
}
