//! The views in the middle of the window.

use super::{bead, compare, solid};
use crate::actions::Action;
use crate::state::PlanState;
use crate::steps::Looked;
use crate::studio::Studio;
use crate::view::Mode;
use crate::view2d::{Drawing, Named, View2d};
use eframe::egui::{CentralPanel, Ui};

pub(super) fn show(studio: &mut Studio, ui: &mut Ui) {
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
    let words = words(studio, "view-2d-label");
    let (scale, looked, layer) = (Some(studio.t("bead-heights")), &studio.jobs.looked, studio.view.last);
    if let Some(picked) = flat(&studio.plans.own, &mut studio.flat, ui, &studio.view, looked, words, scale) {
        studio.view.chosen = picked.map(|(pass, piece)| (layer, pass, piece));
    }
}

/// The words of a view with this name.
pub(super) fn words(studio: &Studio, label: &'static str) -> Words {
    let hybrid = ["pocket-kept", "pocket-left", "skeleton-region"].map(|key| studio.t(key));
    let steps = Named { hybrid, one_loop: ["rings", "flips"].map(|key| studio.t(key)) };
    Words { label: studio.t(label), nothing: studio.t("nothing-laid"), steps }
}

/// What the view of a layer is called, what is said of an empty one, and what the steps of strategies are called.
#[derive(Clone, Copy)]
pub(super) struct Words {
    pub(super) label: &'static str,
    pub(super) nothing: &'static str,
    pub(super) steps: Named,
}

/// A layer of a plan; what was picked, if the view was clicked.
pub(super) fn flat(
    plan: &PlanState,
    view: &mut View2d,
    ui: &mut Ui,
    state: &crate::view::ViewState,
    looked: &Looked,
    words: Words,
    scale: Option<&str>,
) -> Option<Option<(usize, usize)>> {
    let layer = plan.layer(state.last)?;
    let count: usize = layer.passes.iter().map(|pass| pass.segments().count()).sum();
    let subject = Drawing {
        layer,
        judgement: plan.judgements.get(state.last),
        steps: (looked.of(state.last), words.steps),
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
        let hint = studio.t("show-regions-hint");
        let show = &mut studio.view.show;
        ui.checkbox(&mut show.beads, beads);
        ui.checkbox(&mut show.paths, paths);
        ui.checkbox(&mut show.travels, travels);
        ui.checkbox(&mut show.starts, starts);
        ui.checkbox(&mut show.heights, heights);
        ui.checkbox(&mut show.regions, regions).on_hover_text(hint);
        let measure = studio.t("measure");
        if ui.toggle_value(&mut studio.flat.measuring, measure).changed() {
            studio.flat.clear_measure();
        }
        if let Some(length) = studio.flat.measured() {
            ui.label(format!("{length:.2} mm"));
        }
    });
}

/// Has the steps of the strategies in view computed when they are to be shown.
pub(super) fn look_closer(studio: &mut Studio) {
    let layer = studio.view.last;
    let others = studio.plans.other.as_ref().filter(|_| studio.view.mode == Mode::Compare);
    let known = studio.jobs.looked.knows(layer) && others.is_none_or(|other| other.looked.knows(layer));
    if studio.view.show.regions && !known {
        studio.request(Action::LookCloser);
    }
}
