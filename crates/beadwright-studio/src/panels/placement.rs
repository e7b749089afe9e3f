//! How the part is placed: units, scale, turn, shift; and whether its preform is planned.

use super::directions;
use crate::actions;
use crate::actions::Action;
use crate::known::{Known, Queue, View};
use crate::view::Mode;
use beadwright::model::{Part, Placement, Units};
use eframe::egui::{Button, CollapsingHeader, ComboBox, DragValue, Grid, Ui};

pub(super) fn show(known: Known<'_>, view: &mut View<'_>, queue: &mut Queue, ui: &mut Ui) {
    let Some(source) = known.project().source.clone() else { return };
    ui.strong(source.label());
    CollapsingHeader::new(known.t("placement")).show(ui, |ui| {
        let mut placement = known.project().placement;
        Grid::new("placement").num_columns(2).show(ui, |ui| {
            units(known, ui, &mut placement);
            ui.end_row();
            number(ui, known.t("scale"), &mut placement.scale, 1e-6..=1e6, 0.01, "");
            for (key, axis) in [("turn-x", 0), ("turn-y", 1), ("turn-z", 2)] {
                number(ui, known.t(key), &mut placement.turn[axis], -360.0..=360.0, 1.0, "°");
            }
            for (key, axis) in [("move-x", 0), ("move-y", 1)] {
                number(ui, known.t(key), &mut placement.shift[axis], -20_000.0..=20_000.0, 1.0, " mm");
            }
        });
        ui.checkbox(&mut placement.centre, known.t("centre"));
        ui.horizontal_wrapped(|ui| {
            if ui.button(known.t("lay-flat")).clicked() {
                placement.turn = laid_flat(known, &placement);
            }
            let text = known.t(if known.project().preform { "orient-preform" } else { "orient" });
            let oriented = ui.add_enabled(known.jobs.orient_job.is_none(), Button::new(text));
            if oriented.on_hover_text(known.t("orient-hint")).clicked() {
                queue.push(Action::Orient);
            }
            directions::find(known, view, queue, ui);
            let (by_face, solid) = (known.t("lay-by-face"), known.plans.own.scene.mesh().is_some());
            if ui.add_enabled(solid, Button::selectable(view.state.laying, by_face)).clicked() {
                view.state.laying = !view.state.laying;
                view.state.switch(Mode::Solid);
            }
            if ui.button(known.t("reset")).clicked() {
                placement = Placement { units: placement.units, ..Placement::default() };
            }
        });
        if placement != known.project().placement {
            queue.push(Action::Place(placement));
        }
    });
    let (mut preform, hint) = (known.project().preform, known.t("preform-hint"));
    if ui.checkbox(&mut preform, known.t("preform")).on_hover_text(hint).changed() {
        queue.push(Action::Preform(preform));
    }
}

/// The turn that lays the part in view flat.
fn laid_flat(known: Known<'_>, placement: &Placement) -> glam::DVec3 {
    match known.plans.own.part.as_deref() {
        Some(Part::Mesh(import)) => {
            placement.laid_flat(import.milled.as_ref().map_or(&import.mesh, |milled| &milled.mesh))
        }
        _ => placement.turn,
    }
}

fn units(known: Known<'_>, ui: &mut Ui, placement: &mut Placement) {
    let name = |units: Option<Units>| match units {
        Some(units) => Units::ALL.iter().find(|(_, u)| *u == units).map_or("mm", |(name, _)| *name),
        None => known.t("units-guess"),
    };
    let label = ui.label(known.t("units"));
    let combo = ComboBox::from_id_salt("units").selected_text(name(placement.units)).show_ui(ui, |ui| {
        ui.selectable_value(&mut placement.units, None, name(None));
        for (word, units) in Units::ALL {
            ui.selectable_value(&mut placement.units, Some(units), word);
        }
    });
    combo.response.labelled_by(label.id);
}

fn number(ui: &mut Ui, name: &str, value: &mut f64, range: std::ops::RangeInclusive<f64>, speed: f64, unit: &str) {
    let (label, before) = (ui.label(name), *value);
    let drag = DragValue::new(value).update_while_editing(false).range(range).speed(speed).suffix(unit);
    ui.add(drag).labelled_by(label.id);
    if actions::escaped(ui.ctx()) {
        *value = before;
    }
    ui.end_row();
}
