//! The views in the middle of the window.

use super::{bead, compare, solid};
use crate::actions::Action;
use crate::known::{Known, Queue, View};
use crate::state::PlanState;
use crate::steps::Looked;
use crate::view::Mode;
use crate::view2d::{Drawing, Named, View2d};
use crate::view3d::LayerBeads;
use beadwright::plan::Bands;
use eframe::egui::{CentralPanel, Ui};

pub(super) fn show(known: Known<'_>, view: &mut View<'_>, queue: &mut Queue, ui: &mut Ui) {
    CentralPanel::default().show(ui, |ui| match view.state.mode {
        Mode::Solid => solid::show(known, view, queue, ui),
        Mode::Layer => layer(known, view, queue, ui),
        Mode::Compare => compare::show(known, view, queue, ui),
    });
}

fn layer(known: Known<'_>, view: &mut View<'_>, queue: &mut Queue, ui: &mut Ui) {
    bar(known, view, ui);
    bead::show(known, view, ui);
    look_closer(known, view, queue);
    let words = words(known, "view-2d-label");
    let (scale, looked, layer) = (Some(known.t("bead-heights")), &known.jobs.looked, view.state.last);
    if let Some(picked) = flat(&known.plans.own, view.flat, ui, view.state, looked, words, scale) {
        view.state.chosen = picked.map(|(pass, piece)| (layer, pass, piece));
    }
}

/// The words of a view with this name.
pub(super) fn words(known: Known<'_>, label: &'static str) -> Words {
    let hybrid = ["pocket-kept", "pocket-left", "skeleton-region"].map(|key| known.t(key));
    let steps = Named { hybrid, one_loop: ["rings", "flips"].map(|key| known.t(key)) };
    Words { label: known.t(label), nothing: known.t("nothing-laid"), steps }
}

/// What the view of a layer is called, what an empty one says, and what the steps of strategies are called.
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
    let shown = |beads: &LayerBeads| beads.pieces_of((state.progress * beads.len() as f64).ceil() as usize);
    let bands = plan.profile.as_ref().and_then(|profile| Bands::of_layer(layer, profile));
    let subject = Drawing {
        layer,
        bands: bands.as_ref(),
        judgement: plan.judgements.get(state.last),
        steps: (looked.of(state.last), words.steps),
        pieces: plan.scene.layer(state.last).map_or(0, |beads| shown(beads)),
        scale,
        nothing: words.nothing,
        chosen: state.chosen.filter(|(of, ..)| *of == state.last).map(|(_, pass, piece)| (pass, piece)),
    };
    view.pin = state.pin.as_ref().filter(|pin| pin.layer == state.last).map(|pin| pin.on_layer);
    view.show(ui, subject, state.show, words.label).picked
}

/// What is shown of a layer.
pub(super) fn bar(known: Known<'_>, view: &mut View<'_>, ui: &mut Ui) {
    ui.horizontal_wrapped(|ui| {
        let texts = ["show-beads", "show-paths", "show-travels", "show-starts", "show-heights", "show-regions"];
        let [beads, paths, travels, starts, heights, regions] = texts.map(|key| known.t(key));
        let hint = known.t("show-regions-hint");
        let show = &mut view.state.show;
        ui.checkbox(&mut show.beads, beads);
        ui.checkbox(&mut show.paths, paths);
        ui.checkbox(&mut show.travels, travels);
        ui.checkbox(&mut show.starts, starts);
        ui.checkbox(&mut show.heights, heights);
        ui.checkbox(&mut show.regions, regions).on_hover_text(hint);
        let measure = known.t("measure");
        if ui.toggle_value(&mut view.flat.measuring, measure).changed() {
            view.flat.clear_measure();
        }
        if let Some(length) = view.flat.measured() {
            ui.label(format!("{length:.2} mm"));
        }
    });
}

/// Has the steps of the strategies in view computed when they are to be shown.
pub(super) fn look_closer(known: Known<'_>, view: &View<'_>, queue: &mut Queue) {
    let layer = view.state.last;
    let others = known.plans.other.as_ref().filter(|_| view.state.mode == Mode::Compare);
    let known = known.jobs.looked.knows(layer) && others.is_none_or(|other| other.looked.knows(layer));
    if view.state.show.regions && !known {
        queue.push(Action::LookCloser);
    }
}
