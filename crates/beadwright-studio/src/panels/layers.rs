//! Below the views: which layers are shown, how much of the highest, and the playing torch.

use super::clock;
use crate::actions::Action;
use crate::known::{Known, Queue, View};
use crate::view::Mode;
use eframe::egui::{Slider, Ui};

pub(super) fn show(known: Known<'_>, view: &mut View<'_>, queue: &mut Queue, ui: &mut Ui) {
    let layers = known.plans.own.layer_count();
    if layers == 0 {
        return;
    }
    advance(known, view, ui);
    ui.horizontal(|ui| range(known, view, ui, layers));
    ui.horizontal(|ui| torch(known, view, queue, ui));
    clock::show(known, view, ui);
}

fn range(known: Known<'_>, view: &mut View<'_>, ui: &mut Ui, layers: usize) {
    let (mut first, mut last) = (view.state.first + 1, view.state.last + 1);
    // Views of a single layer have no lowest layer.
    let in_compare = view.state.mode == Mode::Compare && view.state.compare_solid;
    let solid = view.state.mode == Mode::Solid || in_compare;
    let texts = ["first-layer", "last-layer", "layer"].map(|key| known.t(key));
    if solid {
        ui.add_enabled_ui(last > 1, |ui| {
            if slider(ui, texts[0], 2, Slider::new(&mut first, 1..=last.max(2))) {
                view.state.first = first.min(last) - 1;
            }
        });
    }
    let text = if solid { texts[1] } else { texts[2] };
    if slider(ui, text, 1, Slider::new(&mut last, 1..=layers)) {
        view.state.look_at(last - 1);
    }
}

fn torch(known: Known<'_>, view: &mut View<'_>, queue: &mut Queue, ui: &mut Ui) {
    let playing = view.state.playing;
    let word = if playing { known.t("stop") } else { known.t("play") };
    if ui.button(format!("{} {word}", if playing { "■" } else { "▶" })).clicked() {
        queue.push(Action::Play);
    }
    let (rate, progress) = (known.t("rate"), known.t("progress"));
    slider(ui, rate, 3, Slider::new(&mut view.state.rate, 1.0..=1000.0).logarithmic(true).fixed_decimals(0));
    pass(known, view, ui);
    if slider(ui, progress, 1, Slider::new(&mut view.state.progress, 0.0..=1.0).show_value(false)) {
        view.state.playing = false;
        view.state.torch = None;
    }
}

/// The last pass shown of the highest layer.
fn pass(known: Known<'_>, view: &mut View<'_>, ui: &mut Ui) {
    let text = known.t("last-pass");
    let Some(beads) = known.plans.own.scene.layer(view.state.last).filter(|beads| !beads.is_empty()).cloned() else {
        ui.add_enabled_ui(false, |ui| slider(ui, text, 2, Slider::new(&mut 0, 0..=0)));
        return;
    };
    let shown = (view.state.progress * beads.len() as f64).round() as usize;
    let mut number = beads.pass_of(shown.max(1) - 1) + 1;
    if slider(ui, text, 2, Slider::new(&mut number, 1..=beads.passes().len()))
        && let Some(span) = beads.passes().get(number - 1)
    {
        view.state.progress = span.segments.end as f64 / beads.len() as f64;
        (view.state.playing, view.state.torch) = (false, None);
    }
}

/// A slider with its label, in `1 / share` of the remaining width; returns whether it was moved.
pub(super) fn slider(ui: &mut Ui, text: &str, share: usize, slider: Slider<'_>) -> bool {
    /// Room for the number after it.
    const NUMBER: f32 = 70.0;
    let room = ui.available_width() / share as f32;
    let label = ui.label(text);
    ui.spacing_mut().slider_width = (room - label.rect.width() - NUMBER).max(60.0);
    ui.add(slider).labelled_by(label.id).changed()
}

/// Advances the torch while it plays.
fn advance(known: Known<'_>, view: &mut View<'_>, ui: &Ui) {
    if !view.state.playing {
        return;
    }
    let passed = ui.input(|input| f64::from(input.stable_dt));
    view.state.advance(passed, &known.plans.own.scene);
    if view.state.playing {
        ui.ctx().request_repaint();
    }
}
