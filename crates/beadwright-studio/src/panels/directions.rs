//! Divisions of the part into bodies with build directions of their own: looked for, compared, shown in 3-D, used.

use super::menu::stage_text;
use crate::actions::Action;
use crate::computing::Progress;
use crate::directions::{Way, Ways};
use crate::known::{Known, Queue, View};
use crate::theme;
use crate::view::{Mode, Side};
use crate::view3d::palette;
use beadwright::directions::Outcome;
use eframe::egui::{Button, Grid, ProgressBar, RichText, Sense, Ui, vec2};

/// A division with its place among those that were found.
type Placed<'a> = (usize, &'a Way);

/// The button that looks for divisions.
pub(super) fn find(known: Known<'_>, view: &mut View<'_>, queue: &mut Queue, ui: &mut Ui) {
    let (reason, runs) = (known.undivided(), progress(known).is_some());
    let button = ui.add_enabled(reason.is_none() && !runs, Button::new(known.t("find-directions")));
    let button = button.on_hover_text(known.t("directions-hint"));
    if button.on_disabled_hover_text(known.t(reason.unwrap_or("directions-hint"))).clicked() {
        queue.push(Action::FindDirections);
        view.state.side = Side::Directions;
    }
}

pub(super) fn show(known: Known<'_>, view: &mut View<'_>, queue: &mut Queue, ui: &mut Ui) {
    find(known, view, queue, ui);
    if let Some(Progress { done, stage }) = progress(known) {
        ui.horizontal(|ui| {
            ui.add(ProgressBar::new(done as f32).desired_width(200.0).text(known.t(stage_text(stage))));
            if ui.button(known.t("cancel")).clicked() {
                queue.push(Action::StopDirections);
            }
        });
    }
    match known.jobs.dividing.as_ref().map(|dividing| &dividing.run.result) {
        None => drop(ui.weak(known.t(known.undivided().unwrap_or("directions-hint")))),
        Some(None) => {}
        Some(Some(Err(sentence))) => drop(ui.colored_label(ui.visuals().error_fg_color, sentence)),
        Some(Some(Ok(ways))) => found(known, view, queue, ui, ways),
    }
}

/// How far the search has come, while it is under way.
fn progress(known: Known<'_>) -> Option<Progress> {
    known.jobs.dividing.as_ref()?.run.progress()
}

fn found(known: Known<'_>, view: &mut View<'_>, queue: &mut Queue, ui: &mut Ui, Ways { level, ways }: &Ways) {
    ui.label(format!("{}: {}", known.t("overhang-level"), area(*level)));
    if let [only] = &ways[..]
        && only.tried.is_level()
    {
        ui.label(known.t("directions-none"));
    }
    let all = || ways.iter().enumerate();
    let (best, farther): (Vec<Placed<'_>>, Vec<Placed<'_>>) =
        all().filter(|(_, way)| way.tried.is_planned()).partition(|(_, way)| !way.farther);
    table(known, view, ui, "best", &best);
    let refused: Vec<Placed<'_>> =
        all().filter(|(_, way)| matches!(way.tried.outcome, Outcome::Refused { .. })).collect();
    if !refused.is_empty() {
        ui.separator();
        ui.strong(known.t("cannot-be-welded"));
        refused.iter().for_each(|way| one_refused(known, view, ui, *way));
    }
    if !farther.is_empty() {
        ui.separator();
        ui.strong(known.t("directions-farther"));
        table(known, view, ui, "farther", &farther);
    }
    if let Some((number, way)) = view.state.division.and_then(|chosen| Some((chosen, ways.get(chosen)?))) {
        ui.separator();
        chosen(known, queue, ui, (number, way));
    }
}

/// Divisions that can be welded, with what they cost.
fn table(known: Known<'_>, view: &mut View<'_>, ui: &mut Ui, id: &str, ways: &[Placed<'_>]) {
    if ways.is_empty() {
        return;
    }
    Grid::new(id).num_columns(5).spacing([12.0, 4.0]).striped(true).show(ui, |ui| {
        ui.label("");
        ["overhang", "wire", "duration", "price"].into_iter().for_each(|key| drop(ui.strong(known.t(key))));
        ui.end_row();
        for &(number, way) in ways {
            let Outcome::Planned(metrics) = &way.tried.outcome else { continue };
            name(known, view, ui, (number, way));
            ui.label(area(way.tried.division.hanging));
            ui.label(format!("{:.2} kg", metrics.wire_mass_kg));
            ui.label(format!("{:.2} h", metrics.total_time_s / 3600.0));
            ui.label(metrics.cost.map_or("–".to_owned(), |cost| format!("{cost:.0} {}", metrics.currency)));
            ui.end_row();
        }
    });
}

/// A division that cannot be welded, and why.
fn one_refused(known: Known<'_>, view: &mut View<'_>, ui: &mut Ui, (number, way): Placed<'_>) {
    ui.horizontal(|ui| {
        name(known, view, ui, (number, way));
        ui.label(format!("{} {}", known.t("overhang"), area(way.tried.division.hanging)));
    });
    ui.label(RichText::new(way.tried.refusal().unwrap_or_default()).weak());
}

/// The number of its bodies; a click shows them in 3-D, another one the beads again.
fn name(known: Known<'_>, view: &mut View<'_>, ui: &mut Ui, (number, way): Placed<'_>) {
    let is_chosen = view.state.division == Some(number);
    let used = known.parsed().is_some_and(|parsed| way.is_of(&parsed.profile.layers.bodies));
    let text = format!("{}. {}{}", number + 1, bodies(known, way), if used { " ✔" } else { "" });
    if ui.add(Button::selectable(is_chosen, text)).on_hover_text(way.tried.about()).clicked() {
        view.state.division = (!is_chosen).then_some(number);
        view.state.switch(Mode::Solid);
    }
}

fn bodies(known: Known<'_>, way: &Way) -> String {
    match way.tried.bodies.len() {
        _ if way.tried.is_level() => known.t("level-layers").to_owned(),
        1 => format!("1 {}", known.t("body")),
        count => format!("{count} {}", known.t("bodies")),
    }
}

/// The chosen division: how it is divided, the colours of its bodies, and the button that takes it.
fn chosen(known: Known<'_>, queue: &mut Queue, ui: &mut Ui, (number, way): Placed<'_>) {
    ui.label(format!("{}. {}", number + 1, way.tried.about()));
    ui.horizontal_wrapped(|ui| {
        let bodies = way.tried.bodies.iter().map(|body| &*body.name).zip((0..).map(palette::body));
        let grey = palette::missing(!known.window.settings.light);
        for (name, colour) in bodies.chain(way.stock.then(|| (known.t("already-there"), grey))) {
            let (place, _) = ui.allocate_exact_size(vec2(12.0, 12.0), Sense::hover());
            ui.painter().rect_filled(place, 2.0, theme::ink(colour));
            ui.label(name);
        }
    });
    let used = known.parsed().is_some_and(|parsed| way.is_of(&parsed.profile.layers.bodies));
    let button = ui.add_enabled(!used, Button::new(known.t("use-division")));
    if button.on_hover_text(known.t("use-division-hint")).on_disabled_hover_text(known.t("division-used")).clicked() {
        queue.push(Action::Divide(number));
    }
}

fn area(mm2: f64) -> String {
    format!("{:.1} cm²", mm2 / 100.0)
}
