//! The views in the middle of the window.

use super::{bead, compare, solid};
use crate::actions::Action;
use crate::state::PlanState;
use crate::studio::Studio;
use crate::view::Mode;
use crate::view2d::{Drawing, View2d};
use beadwright::fill::hybrid::Steps;
use eframe::egui::{CentralPanel, Panel, Ui};

pub(super) fn show(studio: &mut Studio, ui: &mut Ui) {
    if studio.view.mode == Mode::Compare {
        Panel::bottom("differences").show(ui, |ui| compare::differences(studio, ui));
    }
    CentralPanel::default().show(ui, |ui| match studio.view.mode {
        Mode::Solid => solid::show(studio, ui),
        Mode::Layer => layer(studio, ui),
        Mode::Compare => compare::show(studio, ui),
    });
}

fn layer(studio: &mut Studio, ui: &mut Ui) {
    bar(studio, ui);
    bead::show(studio, ui);
    look_closer(studio);
    let words = Words { label: studio.t("view-2d-label"), nothing: studio.t("nothing-laid") };
    let scale = Some(studio.t("bead-heights"));
    let steps = steps(studio);
    let layer = studio.view.last;
    if let Some(picked) =
        flat(&studio.plans.own, &mut studio.flat, ui, &studio.view, steps.as_deref().unwrap_or_default(), words, scale)
    {
        studio.view.chosen = picked.map(|(pass, piece)| (layer, pass, piece));
    }
    // A layer without islands has no steps; an empty list is kept so that they are not computed again.
    studio.jobs.steps = steps.map(|steps| (layer, steps));
}

/// The steps of the layer in view, taken out of the program while they are drawn.
fn steps(studio: &mut Studio) -> Option<Vec<Steps>> {
    studio.jobs.steps.take().filter(|(of, _)| *of == studio.view.last).map(|(_, steps)| steps)
}

/// What the view of a layer is called, and what is said of an empty one.
#[derive(Clone, Copy)]
pub(super) struct Words {
    pub(super) label: &'static str,
    pub(super) nothing: &'static str,
}

/// A layer of a plan; what was picked, if the view was clicked.
pub(super) fn flat(
    plan: &PlanState,
    view: &mut View2d,
    ui: &mut Ui,
    state: &crate::view::ViewState,
    steps: &[Steps],
    words: Words,
    scale: Option<&str>,
) -> Option<Option<(usize, usize)>> {
    let layer = plan.layer(state.last)?;
    let count: usize = layer.passes.iter().map(|pass| pass.segments().count()).sum();
    let subject = Drawing {
        layer,
        judgement: plan.judgements.get(state.last),
        steps,
        pieces: (state.progress * count as f64).ceil() as usize,
        scale,
        nothing: words.nothing,
        chosen: state.chosen.filter(|(of, ..)| *of == state.last).map(|(_, pass, piece)| (pass, piece)),
    };
    view.show(ui, subject, state.show, words.label).picked
}

/// What is shown of a layer.
pub(super) fn bar(studio: &mut Studio, ui: &mut Ui) {
    ui.horizontal_wrapped(|ui| {
        let texts = ["show-beads", "show-paths", "show-travels", "show-starts", "show-heights", "show-regions"];
        let [beads, paths, travels, starts, heights, regions] = texts.map(|key| studio.t(key));
        let show = &mut studio.view.show;
        ui.checkbox(&mut show.beads, beads);
        ui.checkbox(&mut show.paths, paths);
        ui.checkbox(&mut show.travels, travels);
        ui.checkbox(&mut show.starts, starts);
        ui.checkbox(&mut show.heights, heights);
        ui.checkbox(&mut show.regions, regions);
        let measure = studio.t("measure");
        if ui.toggle_value(&mut studio.flat.measuring, measure).changed() {
            studio.flat.clear_measure();
        }
        if let Some(length) = studio.flat.measured() {
            ui.label(format!("{length:.2} mm"));
        }
    });
}

/// Has the pockets and skeleton regions of the layer in view computed when they are to be shown.
fn look_closer(studio: &mut Studio) {
    let known = studio.jobs.steps.as_ref().is_some_and(|(of, _)| *of == studio.view.last);
    if studio.view.show.regions && !known && studio.jobs.steps_job.is_none() {
        studio.request(Action::LookCloser);
    }
}
