//! What can be exported.

use crate::actions::Action;
use crate::export::Export;
use crate::jobs::Ask;
use crate::known::{Known, Queue, View};
use beadwright::dialect;
use beadwright::files::{METRICS, PLAN, REPORT};
use eframe::egui::{Button, ComboBox, TextEdit, Ui};

/// The dialect in which the program is written.
pub(super) fn dialect(known: Known<'_>, view: &mut View<'_>, ui: &mut Ui) {
    ui.horizontal(|ui| {
        let label = ui.label(known.t("dialect"));
        let now = view.state.dialect.clone();
        let combo = ComboBox::from_id_salt("dialect").selected_text(now).show_ui(ui, |ui| {
            for name in dialect::names() {
                ui.selectable_value(&mut view.state.dialect, name.to_owned(), name);
            }
        });
        combo.response.labelled_by(label.id);
    });
}

pub(super) fn show(known: Known<'_>, view: &mut View<'_>, queue: &mut Queue, ui: &mut Ui) {
    dialect(known, view, ui);
    // A browser itself asks where downloads go.
    if cfg!(not(target_arch = "wasm32")) {
        let label = ui.label(known.t("folder"));
        let hint = known.t("folder-hint");
        let edit = TextEdit::singleline(&mut view.state.folder).hint_text(hint).desired_width(f32::INFINITY);
        ui.add(edit).labelled_by(label.id);
    }
    let (planned, judged) = (
        known.plans.own.summary.is_some() && known.plans.own.is_of_last_request(),
        (known.plans.own.total.is_some() || known.plans.own.adapted.is_some()) && known.plans.own.is_of_last_request(),
    );
    if !judged {
        ui.weak(known.t("not-complete"));
    }
    if let Some(adapted) = &known.plans.own.adapted {
        ui.label(known.t("adapt-export").replace("{layer}", &(adapted.number + 1).to_string()));
    }
    let reasons = known.plans.own.forbidden();
    if !reasons.is_empty() {
        ui.colored_label(ui.visuals().error_fg_color, known.t("may-not-be-written"));
        reasons.iter().for_each(|reason| drop(ui.label(reason)));
        ui.weak(known.t("export-refused-help"));
    }
    let rows = [
        ("export-program", Export::Program(view.state.dialect.clone()), planned),
        ("export-plan", Export::File(PLAN), judged),
        ("export-report", Export::File(REPORT), judged),
        ("export-metrics", Export::File(METRICS), judged),
        ("export-all", Export::All, judged),
    ];
    for (key, what, enabled) in rows {
        if ui.add_enabled(enabled, Button::new(known.t(key))).clicked() {
            queue.push(Action::Export(what));
        }
    }
    // Browsers do not let a program wait for its pictures; they save what they show themselves.
    let pictured = known.window.render_state.is_some() && known.plans.own.layer_count() > 0;
    if cfg!(not(target_arch = "wasm32")) && ui.add_enabled(pictured, Button::new(known.t("export-picture"))).clicked() {
        queue.push(Action::Ask(Ask::SavePicture));
    }
}
