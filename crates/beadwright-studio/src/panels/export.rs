//! What can be exported.

use crate::actions::Action;
use crate::export::Export;
use crate::jobs::Ask;
use crate::studio::Studio;
use beadwright::dialect;
use beadwright::files::{METRICS, PLAN, REPORT};
use eframe::egui::{Button, ComboBox, TextEdit, Ui};

pub(super) fn show(studio: &mut Studio, ui: &mut Ui) {
    ui.horizontal(|ui| {
        let label = ui.label(studio.t("dialect"));
        let now = studio.view.dialect.clone();
        let combo = ComboBox::from_id_salt("dialect").selected_text(now).show_ui(ui, |ui| {
            for name in dialect::names() {
                ui.selectable_value(&mut studio.view.dialect, name.to_owned(), name);
            }
        });
        combo.response.labelled_by(label.id);
    });
    // A browser itself asks where downloads go.
    if cfg!(not(target_arch = "wasm32")) {
        let label = ui.label(studio.t("folder"));
        let hint = studio.t("folder-hint");
        let edit = TextEdit::singleline(&mut studio.view.folder).hint_text(hint).desired_width(f32::INFINITY);
        ui.add(edit).labelled_by(label.id);
    }
    let (planned, judged) = (
        studio.plans.own.summary.is_some() && studio.plans.own.is_of_last_request(),
        studio.plans.own.total.is_some() && studio.plans.own.is_of_last_request(),
    );
    if !judged {
        ui.weak(studio.t("not-complete"));
    }
    let rows = [
        ("export-program", Export::Program(studio.view.dialect.clone()), planned),
        ("export-plan", Export::File(PLAN), judged),
        ("export-report", Export::File(REPORT), judged),
        ("export-metrics", Export::File(METRICS), judged),
        ("export-all", Export::All, judged),
    ];
    for (key, what, enabled) in rows {
        if ui.add_enabled(enabled, Button::new(studio.t(key))).clicked() {
            studio.request(Action::Export(what));
        }
    }
    // Browsers do not let a program wait for its pictures; they save what they show themselves.
    let pictured = studio.window.render_state.is_some() && studio.plans.own.layer_count() > 0;
    if cfg!(not(target_arch = "wasm32")) && ui.add_enabled(pictured, Button::new(studio.t("export-picture"))).clicked()
    {
        studio.request(Action::Ask(Ask::SavePicture));
    }
}
