//! Which process and which robot: the profile, and the cell.

use crate::actions::Action;
use crate::known::{Known, Queue, View};
use beadwright::profile::{BUILT_IN, Profile};
use beadwright::robot::cell;
use eframe::egui::{ComboBox, Ui};

/// The profile, to be chosen from the built-in ones.
pub(super) fn profile(known: Known<'_>, queue: &mut Queue, ui: &mut Ui) {
    let Some(parsed) = known.parsed() else { return };
    let label = ui.label(known.t("profile"));
    let combo = ComboBox::from_id_salt("profile").selected_text(&parsed.profile.name).show_ui(ui, |ui| {
        for (name, text) in BUILT_IN {
            let line = ui.selectable_label(parsed.profile.name == name, name);
            if line.on_hover_ui(|ui| drop(ui.label(about(text)))).clicked() {
                queue.push(Action::SetProfile(text));
            }
        }
    });
    combo.response.labelled_by(label.id).on_hover_text(&parsed.profile.description);
}

/// The description in the profile of this text.
fn about(text: &str) -> String {
    Profile::parse(text).map_or_else(|error| error.to_string(), |profile| profile.description)
}

/// The robot cell, to be chosen from the built-in ones.
pub(super) fn cell(known: Known<'_>, view: &View<'_>, queue: &mut Queue, ui: &mut Ui) {
    let label = ui.label(known.t("cell"));
    let now = view.state.cell.clone();
    let combo = ComboBox::from_id_salt("cell").selected_text(&now).show_ui(ui, |ui| {
        for (name, _) in cell::BUILT_IN {
            if ui.selectable_label(now == name, name).clicked() {
                queue.push(Action::TakeCell(name));
            }
        }
    });
    combo.response.labelled_by(label.id);
}
