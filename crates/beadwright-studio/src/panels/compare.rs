//! Two strategies side by side, in layers or in 3-D: where one view goes, the other follows.

use super::centre::{bar, flat, look_closer, words};
use super::{bead, solid, totals};
use crate::actions::Action;
use crate::planner::Failure;
use crate::studio::Studio;
use crate::view3d::Style;
use beadwright::fill::StrategyName;
use eframe::egui::{ComboBox, Grid, Ui};

pub(super) fn show(studio: &mut Studio, ui: &mut Ui) {
    ui.horizontal(|ui| {
        choose(studio, ui);
        let text = studio.t("compare-solid");
        if ui.checkbox(&mut studio.view.compare_solid, text).changed() {
            studio.solid.fit();
        }
    });
    let solid = studio.view.compare_solid;
    if solid {
        ui.horizontal_wrapped(|ui| solid::bar(studio, ui));
        ui.horizontal(|ui| solid::colours(studio, ui));
    } else {
        bar(studio, ui);
    }
    bead::show(studio, ui);
    ui.columns(2, |columns| {
        let [left, right] = columns else { return };
        left.strong(studio.plans.own.header.as_ref().map_or("", |header| &header.strategy));
        if let Some(other) = &studio.plans.other {
            if let Some(Failure::Sentence(text)) = &other.plan.failure {
                right.colored_label(right.visuals().error_fg_color, text);
            }
            right.strong(other.strategy.name());
        }
        if solid { in_solid(studio, left, right) } else { in_layers(studio, left, right) }
    });
}

/// One layer of both: when one view is moved, the other follows.
fn in_layers(studio: &mut Studio, left: &mut Ui, right: &mut Ui) {
    look_closer(studio);
    let [own, theirs] = ["view-2d-label", "view-2d-other"].map(|key| words(studio, key));
    let before = studio.flat.eye();
    if let Some(picked) = flat(&studio.plans.own, &mut studio.flat, left, &studio.view, &studio.jobs.looked, own, None)
    {
        studio.view.chosen = picked.map(|(pass, piece)| (studio.view.last, pass, piece));
    }
    let Some(other) = &mut studio.plans.other else { return };
    if studio.flat.eye() != before {
        other.flat.follow(&studio.flat);
    }
    let before = other.flat.eye();
    flat(&other.plan, &mut other.flat, right, &studio.view, &other.looked, theirs, None);
    if other.flat.eye() != before {
        studio.flat.follow(&other.flat);
    }
}

/// All layers of both, with one camera.
fn in_solid(studio: &mut Studio, left: &mut Ui, right: &mut Ui) {
    let [own, theirs] = ["view-3d-label", "view-3d-other"].map(|key| studio.t(key));
    // A bead of one plan is not one of the other's.
    let style = studio.style();
    let plain = Style { segments_of_last: None, highlight: None, torch: None, arm: Vec::new(), ..style.clone() };
    solid::view(studio, left, &style, own);
    let (camera, state) = (studio.solid.camera, studio.window.render_state.as_ref());
    let Some(other) = &mut studio.plans.other else { return };
    other.solid.camera = camera;
    other.solid.caption.clone_from(&studio.solid.caption);
    other.solid.no_adapter.clone_from(&studio.solid.no_adapter);
    other.solid.hold();
    other.solid.show(right, state, &other.plan.scene, &plain, theirs);
    if other.solid.camera != camera {
        studio.solid.camera = other.solid.camera;
        right.ctx().request_repaint();
    }
}

fn choose(studio: &mut Studio, ui: &mut Ui) {
    let now = studio.plans.other.as_ref().map(|other| other.strategy);
    let mut chosen = None;
    let label = ui.label(studio.t("other-strategy"));
    let combo =
        ComboBox::from_id_salt("other-strategy").selected_text(now.map_or("–", StrategyName::name)).show_ui(ui, |ui| {
            for &strategy in StrategyName::ALL {
                if ui.selectable_label(now == Some(strategy), strategy.name()).clicked() {
                    chosen = Some(strategy);
                }
            }
        });
    combo.response.labelled_by(label.id);
    if let Some(strategy) = chosen.filter(|_| chosen != now) {
        studio.request(Action::CompareWith(strategy));
    }
}

/// Totals of both plans side by side.
pub(super) fn differences(studio: &Studio, ui: &mut Ui) {
    let Some(other) = &studio.plans.other else { return };
    let (own, theirs) = (totals::rows_of(&studio.plans.own), totals::rows_of(&other.plan));
    let names = [studio.plans.own.header.as_ref().map_or("", |header| header.strategy.as_str()), other.strategy.name()];
    // As many tables side by side as fit leave more room for the views.
    const WIDTH: f32 = 400.0;
    let tables = ((ui.available_width() / WIDTH) as usize).clamp(1, own.len().max(1));
    let rows = own.len().div_ceil(tables).max(1);
    ui.columns(tables, |columns| {
        columns.iter_mut().zip(own.chunks(rows)).for_each(|(ui, rows)| table(studio, ui, names, rows, &theirs));
    });
}

/// Some of the totals: their name, and the value of each plan.
fn table(studio: &Studio, ui: &mut Ui, names: [&str; 2], own: &[Row], theirs: &[Row]) {
    Grid::new(("differences", own.first())).num_columns(3).spacing([12.0, 2.0]).striped(true).show(ui, |ui| {
        ui.label("");
        names.into_iter().for_each(|name| drop(ui.strong(name)));
        ui.end_row();
        for (name, value) in own {
            totals::named(studio, ui, name);
            ui.label(value);
            ui.label(theirs.iter().find(|(n, _)| n == name).map_or("…", |(_, value)| value));
            ui.end_row();
        }
    });
}

/// A total: its name and its value.
type Row = (&'static str, String);
