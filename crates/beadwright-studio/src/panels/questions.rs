//! Questions that must be answered before work continues.

use super::findings::whole;
use crate::actions::Action;
use crate::known::{Known, Queue, View};
use crate::planner::Failure;
use crate::view::Side;
use beadwright::Finding;
use beadwright::model::{Placement, Units};
use eframe::egui::{Align2, Button, DragValue, Key, TextEdit, Ui, Window, vec2};

pub(super) fn show(known: Known<'_>, view: &mut View<'_>, queue: &mut Queue, ui: &Ui) {
    lost(known, queue, ui);
    match known.plans.own.failure.clone() {
        Some(Failure::Units(text, sizes)) => units(known, queue, ui, &text, &sizes),
        Some(Failure::Damaged(text)) => damaged(known, queue, ui, &text),
        Some(Failure::Height(text)) => height(known, queue, ui, &text),
        _ => {}
    }
    closing(known, queue, ui);
    undoing(known, queue, ui);
    doubted(known, view, queue, ui);
    path(known, view, queue, ui);
}

/// A path to be typed, where the desktop has no file dialogs.
fn path(known: Known<'_>, view: &mut View<'_>, queue: &mut Queue, ui: &Ui) {
    if known.jobs.typed.is_none() {
        return;
    }
    let text = &mut view.state.typed;
    let mut answer = None;
    window(known.t("path-title")).show(ui.ctx(), |ui| {
        ui.label(known.t("path-text"));
        let label = ui.label(known.t("path"));
        let field = ui.add(TextEdit::singleline(text).desired_width(f32::INFINITY)).labelled_by(label.id);
        // Asked first: a field that is given the focus again has not lost it.
        let entered = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        if ui.memory(|memory| memory.focused().is_none()) {
            field.request_focus();
        }
        ui.horizontal(|ui| {
            if ui.add_enabled(!text.trim().is_empty(), Button::new(known.t("take"))).clicked() || entered {
                answer = Some(true);
            }
            if ui.button(known.t("cancel")).clicked() {
                answer = Some(false);
            }
        });
    });
    if let Some(taken) = answer {
        let path = text.trim();
        queue.push(Action::Answer((taken && !path.is_empty()).then(|| path.into())));
    }
}

fn closing(known: Known<'_>, queue: &mut Queue, ui: &Ui) {
    if !known.window.closing {
        return;
    }
    window(known.t("closing-title")).show(ui.ctx(), |ui| {
        ui.label(known.t("closing-text"));
        ui.horizontal(|ui| {
            if ui.button(known.t("save")).clicked() {
                queue.push(Action::GoOn);
                queue.push(Action::Save);
            }
            if ui.button(known.t("close-anyway")).clicked() {
                queue.push(Action::Leave);
            }
            if ui.button(known.t("go-on")).clicked() {
                queue.push(Action::GoOn);
            }
        });
    });
}

/// Asks before an undo closes the part.
fn undoing(known: Known<'_>, queue: &mut Queue, ui: &Ui) {
    if !known.open.asks_undo {
        return;
    }
    window(known.t("undoing-title")).show(ui.ctx(), |ui| {
        ui.label(known.t("undoing-text"));
        ui.horizontal(|ui| {
            for (text, goes_on) in [("close-part", true), ("cancel", false)] {
                if ui.button(known.t(text)).clicked() {
                    queue.push(Action::DecideUndo(goes_on));
                }
            }
        });
    });
}

/// Asks before a program with serious findings is exported.
fn doubted(known: Known<'_>, view: &mut View<'_>, queue: &mut Queue, ui: &Ui) {
    const SHOWN: usize = 3;
    if !known.jobs.doubted {
        return;
    }
    window(known.t("doubted-title")).show(ui.ctx(), |ui| {
        let serious: Vec<&Finding> = known.plans.own.serious().collect();
        serious.iter().take(SHOWN).for_each(|finding| drop(ui.label(whole(known, finding))));
        if serious.len() > SHOWN {
            ui.weak(format!("… {}", serious.len() - SHOWN));
        }
        ui.horizontal(|ui| {
            if ui.button(known.t("show-findings")).clicked() {
                view.state.side = Side::Findings;
                queue.push(Action::DecideExport(false));
            }
            if ui.button(known.t("export-anyway")).clicked() {
                queue.push(Action::DecideExport(true));
            }
            if ui.button(known.t("cancel")).clicked() {
                queue.push(Action::DecideExport(false));
            }
        });
    });
}

/// Asks whether the rest of a damaged model is to be used.
fn damaged(known: Known<'_>, queue: &mut Queue, ui: &Ui, text: &str) {
    window(known.t("damaged-title")).show(ui.ctx(), |ui| {
        ui.label(text);
        ui.horizontal(|ui| {
            if ui.button(known.t("skip-damaged")).clicked() {
                queue.push(Action::AcceptDamaged);
            }
            if ui.button(known.t("cancel")).clicked() {
                queue.push(Action::DismissFailure);
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

fn lost(known: Known<'_>, queue: &mut Queue, ui: &Ui) {
    let Some(project) = known.open.lost.clone() else { return };
    window(known.t("lost-title")).show(ui.ctx(), |ui| {
        ui.label(known.t("lost-text"));
        ui.label(project.source.as_ref().map(|source| source.label()).unwrap_or_default());
        ui.horizontal(|ui| {
            if ui.button(known.t("bring-back")).clicked() {
                queue.push(Action::BringBack);
            }
            if ui.button(known.t("let-go")).clicked() {
                queue.push(Action::LetGo);
            }
        });
    });
}

fn units(known: Known<'_>, queue: &mut Queue, ui: &Ui, text: &str, sizes: &[String; 4]) {
    window(known.t("units-title")).show(ui.ctx(), |ui| {
        // The buttons say the rest.
        ui.label(text.split(" Say which").next().unwrap_or(text));
        ui.vertical(|ui| {
            for ((name, units), size) in Units::ALL.into_iter().zip(sizes) {
                if ui.button(format!("{name}: {size} mm")).clicked() {
                    queue.push(Action::Place(Placement { units: Some(units), ..known.project().placement }));
                }
            }
        });
    });
}

fn height(known: Known<'_>, queue: &mut Queue, ui: &Ui, text: &str) {
    const USUAL: f64 = 50.0;
    window(known.t("height-title")).show(ui.ctx(), |ui| {
        ui.label(text.split(';').next().unwrap_or(text));
        let mut height = known.project().height.unwrap_or(USUAL);
        ui.horizontal(|ui| {
            let label = ui.label(known.t("height"));
            let id = ui.make_persistent_id("height");
            height = ui.data_mut(|data| *data.get_temp_mut_or(id, height));
            ui.add(DragValue::new(&mut height).range(0.1..=20_000.0).suffix(" mm")).labelled_by(label.id);
            ui.data_mut(|data| data.insert_temp(id, height));
            if ui.button(known.t("take")).clicked() {
                queue.push(Action::Height(height));
            }
        });
    });
}
