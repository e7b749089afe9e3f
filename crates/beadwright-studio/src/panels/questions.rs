//! Questions that must be answered before work continues, and the list of keys.

use crate::actions::{Action, ENTRIES};
use crate::planner::Failure;
use crate::studio::Studio;
use beadwright::model::{Placement, Units};
use eframe::egui::{Align2, Button, DragValue, Grid, Key, TextEdit, Ui, Window, vec2};

pub(super) fn show(studio: &mut Studio, ui: &Ui) {
    lost(studio, ui);
    match studio.plans.own.failure.clone() {
        Some(Failure::Units(text)) => units(studio, ui, &text),
        Some(Failure::Height(text)) => height(studio, ui, &text),
        _ => {}
    }
    closing(studio, ui);
    path(studio, ui);
    keys(studio, ui);
}

/// A path to be typed, where the desktop has no file dialogs.
fn path(studio: &mut Studio, ui: &Ui) {
    let Some((what, mut text)) = studio.jobs.typed.clone() else { return };
    let mut answer = None;
    window(studio.t("path-title")).show(ui.ctx(), |ui| {
        ui.label(studio.t("path-text"));
        let label = ui.label(studio.t("path"));
        let field = ui.add(TextEdit::singleline(&mut text).desired_width(f32::INFINITY)).labelled_by(label.id);
        // Asked first: a field that is given the focus again has not lost it.
        let entered = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        if ui.memory(|memory| memory.focused().is_none()) {
            field.request_focus();
        }
        ui.horizontal(|ui| {
            if ui.add_enabled(!text.trim().is_empty(), Button::new(studio.t("take"))).clicked() || entered {
                answer = Some(true);
            }
            if ui.button(studio.t("cancel")).clicked() {
                answer = Some(false);
            }
        });
    });
    studio.jobs.typed = answer.is_none().then(|| (what, text.clone()));
    if answer == Some(true) && !text.trim().is_empty() {
        studio.request(Action::Answer(what, text.trim().into()));
    }
}

fn closing(studio: &mut Studio, ui: &Ui) {
    if !studio.window.closing {
        return;
    }
    window(studio.t("closing-title")).show(ui.ctx(), |ui| {
        ui.label(studio.t("closing-text"));
        ui.horizontal(|ui| {
            if ui.button(studio.t("save")).clicked() {
                studio.request(Action::GoOn);
                studio.request(Action::Save);
            }
            if ui.button(studio.t("close-anyway")).clicked() {
                studio.request(Action::Leave);
            }
            if ui.button(studio.t("go-on")).clicked() {
                studio.request(Action::GoOn);
            }
        });
    });
}

fn window<'a>(title: &'a str) -> Window<'a> {
    Window::new(title)
        .min_width(420.0)
        .collapsible(false)
        .resizable(false)
        .anchor(Align2::CENTER_CENTER, vec2(0.0, 0.0))
}

fn lost(studio: &mut Studio, ui: &Ui) {
    let Some(project) = studio.open.lost.clone() else { return };
    window(studio.t("lost-title")).show(ui.ctx(), |ui| {
        ui.label(studio.t("lost-text"));
        ui.label(project.source.as_ref().map(|source| source.label()).unwrap_or_default());
        ui.horizontal(|ui| {
            if ui.button(studio.t("bring-back")).clicked() {
                studio.request(Action::BringBack);
            }
            if ui.button(studio.t("let-go")).clicked() {
                studio.request(Action::LetGo);
            }
        });
    });
}

fn units(studio: &mut Studio, ui: &Ui, text: &str) {
    window(studio.t("units-title")).show(ui.ctx(), |ui| {
        // After the first sentences the text names the command's options; here the buttons replace them.
        ui.label(text.split(" Say which").next().unwrap_or(text));
        ui.horizontal(|ui| {
            for (name, units) in Units::ALL {
                if ui.button(name).clicked() {
                    studio.request(Action::Place(Placement { units: Some(units), ..studio.project().placement }));
                }
            }
        });
    });
}

fn height(studio: &mut Studio, ui: &Ui, text: &str) {
    const USUAL: f64 = 50.0;
    window(studio.t("height-title")).show(ui.ctx(), |ui| {
        ui.label(text.split(';').next().unwrap_or(text));
        let mut height = studio.project().height.unwrap_or(USUAL);
        ui.horizontal(|ui| {
            let label = ui.label(studio.t("height"));
            let id = ui.make_persistent_id("height");
            height = ui.data_mut(|data| *data.get_temp_mut_or(id, height));
            ui.add(DragValue::new(&mut height).range(0.1..=20_000.0).suffix(" mm")).labelled_by(label.id);
            ui.data_mut(|data| data.insert_temp(id, height));
            if ui.button(studio.t("take")).clicked() {
                studio.request(Action::Height(height));
            }
        });
    });
}

fn keys(studio: &mut Studio, ui: &Ui) {
    let mut open = studio.view.keys;
    Window::new(studio.t("keys")).open(&mut open).show(ui.ctx(), |ui| {
        Grid::new("keys").num_columns(2).striped(true).show(ui, |ui| {
            let page = cfg!(target_arch = "wasm32");
            for entry in ENTRIES.iter().filter(|entry| !page || entry.action != Action::Quit) {
                ui.label(studio.t(entry.text));
                ui.monospace(entry.key.map(|key| ui.ctx().format_shortcut(&key)).unwrap_or_default());
                ui.end_row();
            }
        });
    });
    studio.view.keys = open;
}
