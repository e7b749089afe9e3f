//! Which process and which robot: the profile, and the cell.

use crate::actions::Action;
use crate::studio::Studio;
use beadwright::profile::{BUILT_IN, Profile};
use beadwright::robot::cell;
use eframe::egui::{ComboBox, Ui};

/// The profile, to be chosen from the built-in ones.
pub(super) fn profile(studio: &mut Studio, ui: &mut Ui) {
    let Some(parsed) = studio.parsed() else { return };
    let label = ui.label(studio.t("profile"));
    let combo = ComboBox::from_id_salt("profile").selected_text(&parsed.profile.name).show_ui(ui, |ui| {
        for (name, text) in BUILT_IN {
            let line = ui.selectable_label(parsed.profile.name == name, name);
            if line.on_hover_ui(|ui| drop(ui.label(about(text)))).clicked() {
                studio.request(Action::SetProfile(text));
            }
        }
    });
    combo.response.labelled_by(label.id).on_hover_text(&parsed.profile.description);
}

/// What the profile of this text says of itself.
fn about(text: &str) -> String {
    Profile::parse(text).map_or_else(|error| error.to_string(), |profile| profile.description)
}

/// The robot cell, to be chosen from the built-in ones.
pub(super) fn cell(studio: &mut Studio, ui: &mut Ui) {
    let label = ui.label(studio.t("cell"));
    let now = studio.view.cell.clone();
    let combo = ComboBox::from_id_salt("cell").selected_text(&now).show_ui(ui, |ui| {
        for (name, _) in cell::BUILT_IN {
            if ui.selectable_label(now == name, name).clicked() {
                studio.request(Action::TakeCell(name));
            }
        }
    });
    combo.response.labelled_by(label.id);
}
