//! Two strategies side by side, in layers or in 3-D: when one view moves, the other follows.

use super::centre::{bar, flat, look_closer, words};
use super::{bead, solid, totals};
use crate::actions::Action;
use crate::known::{Known, Queue, View};
use crate::planner::Failure;
use crate::view3d::Style;
use beadwright::fill::StrategyName;
use eframe::egui::{ComboBox, Grid, Ui};

pub(super) fn show(known: Known<'_>, view: &mut View<'_>, queue: &mut Queue, ui: &mut Ui) {
    ui.horizontal(|ui| {
        choose(known, queue, ui);
        let text = known.t("compare-solid");
        if ui.checkbox(&mut view.state.compare_solid, text).changed() {
            view.solid.fit();
        }
    });
    let solid = view.state.compare_solid;
    if solid {
        ui.horizontal_wrapped(|ui| solid::bar(known, view, queue, ui));
        ui.horizontal_wrapped(|ui| {
            solid::colours(known, view, queue, ui);
            solid::legend(known, view, ui);
        });
    } else {
        bar(known, view, ui);
    }
    bead::show(known, view, ui);
    ui.columns(2, |columns| {
        let [left, right] = columns else { return };
        left.strong(known.plans.own.header.as_ref().map_or("", |header| &header.strategy));
        if let Some(other) = &known.plans.other {
            if let Some(Failure::Sentence(text)) = &other.plan.failure {
                right.colored_label(right.visuals().error_fg_color, text);
            }
            right.strong(other.strategy.name());
        }
        if solid { in_solid(known, view, queue, left, right) } else { in_layers(known, view, queue, left, right) }
    });
}

/// One layer of both: when one view is moved, the other follows.
fn in_layers(known: Known<'_>, view: &mut View<'_>, queue: &mut Queue, left: &mut Ui, right: &mut Ui) {
    look_closer(known, view, queue);
    let [own, theirs] = ["view-2d-label", "view-2d-other"].map(|key| words(known, key));
    let before = view.flat.eye();
    if let Some(picked) = flat(&known.plans.own, view.flat, left, view.state, &known.jobs.looked, own, None) {
        view.state.chosen = picked.map(|(pass, piece)| (view.state.last, pass, piece));
    }
    let Some(other) = &known.plans.other else { return };
    if view.flat.eye() != before {
        view.their_flat.follow(view.flat);
    }
    let before = view.their_flat.eye();
    flat(&other.plan, view.their_flat, right, view.state, &other.looked, theirs, None);
    if view.their_flat.eye() != before {
        view.flat.follow(view.their_flat);
    }
}

/// All layers of both, with one camera.
fn in_solid(known: Known<'_>, view: &mut View<'_>, queue: &mut Queue, left: &mut Ui, right: &mut Ui) {
    let [own, theirs] = ["view-3d-label", "view-3d-other"].map(|key| known.t(key));
    // A bead of one plan does not exist in the other.
    let style = known.style(view.state);
    let plain = Style {
        segments_of_last: None,
        highlight: None,
        torch: None,
        around: Vec::new(),
        floor: None,
        ..style.clone()
    };
    solid::picture(known, view, queue, left, &style, own);
    let (camera, state) = (view.solid.camera, known.window.render_state.as_ref());
    let Some(other) = &known.plans.other else { return };
    view.their_solid.camera = camera;
    view.their_solid.caption.clone_from(&view.solid.caption);
    view.their_solid.no_adapter.clone_from(&view.solid.no_adapter);
    view.their_solid.hold();
    view.their_solid.show(right, state, &other.plan.scene, &plain, theirs);
    if view.their_solid.camera != camera {
        view.solid.camera = view.their_solid.camera;
        right.ctx().request_repaint();
    }
}

fn choose(known: Known<'_>, queue: &mut Queue, ui: &mut Ui) {
    let now = known.plans.other.as_ref().map(|other| other.strategy);
    let mut chosen = None;
    let label = ui.label(known.t("other-strategy"));
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
        queue.push(Action::CompareWith(strategy));
    }
}

/// Totals of both plans side by side.
pub(super) fn differences(known: Known<'_>, ui: &mut Ui) {
    let Some(other) = &known.plans.other else { return };
    let (own, theirs) = (known.plans.own.totals(), other.plan.totals());
    let names = [known.plans.own.header.as_ref().map_or("", |header| header.strategy.as_str()), other.strategy.name()];
    // As many tables side by side as fit leave more room for the views.
    const WIDTH: f32 = 400.0;
    let tables = ((ui.available_width() / WIDTH) as usize).clamp(1, own.len().max(1));
    let rows = own.len().div_ceil(tables).max(1);
    ui.columns(tables, |columns| {
        columns.iter_mut().zip(own.chunks(rows)).for_each(|(ui, rows)| table(known, ui, names, rows, &theirs));
    });
}

/// Some of the totals: their name, and the value of each plan.
fn table(known: Known<'_>, ui: &mut Ui, names: [&str; 2], own: &[Row], theirs: &[Row]) {
    Grid::new(("differences", own.first())).num_columns(3).spacing([12.0, 2.0]).striped(true).show(ui, |ui| {
        ui.label("");
        names.into_iter().for_each(|name| drop(ui.strong(name)));
        ui.end_row();
        for (name, value) in own {
            totals::named(known, ui, name);
            ui.label(value);
            ui.label(theirs.iter().find(|(n, _)| n == name).map_or("…", |(_, value)| value));
            ui.end_row();
        }
    });
}

/// A total: its name and its value.
type Row = (&'static str, String);
