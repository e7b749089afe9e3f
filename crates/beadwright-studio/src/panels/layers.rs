//! Below the views: which layers are shown, how much of the highest, and the playing torch.

use crate::actions::Action;
use crate::studio::Studio;
use crate::view::Mode;
use eframe::egui::{Slider, Ui};

pub(super) fn show(studio: &mut Studio, ui: &mut Ui) {
    let layers = studio.plans.own.layer_count();
    if layers == 0 {
        return;
    }
    advance(studio, ui);
    ui.horizontal(|ui| range(studio, ui, layers));
    ui.horizontal(|ui| torch(studio, ui));
}

fn range(studio: &mut Studio, ui: &mut Ui, layers: usize) {
    let (mut first, mut last) = (studio.view.first + 1, studio.view.last + 1);
    // Views of a single layer have no lowest layer.
    let in_compare = studio.view.mode == Mode::Compare && studio.view.compare_solid;
    let solid = studio.view.mode == Mode::Solid || in_compare;
    let texts = ["first-layer", "last-layer", "layer"].map(|key| studio.t(key));
    if solid {
        ui.add_enabled_ui(last > 1, |ui| {
            if slider(ui, texts[0], 2, Slider::new(&mut first, 1..=last.max(2))) {
                studio.view.first = first.min(last) - 1;
            }
        });
    }
    let text = if solid { texts[1] } else { texts[2] };
    if slider(ui, text, 1, Slider::new(&mut last, 1..=layers)) {
        studio.view.look_at(last - 1);
    }
}

fn torch(studio: &mut Studio, ui: &mut Ui) {
    let playing = studio.view.playing;
    let word = if playing { studio.t("stop") } else { studio.t("play") };
    if ui.button(format!("{} {word}", if playing { "■" } else { "▶" })).clicked() {
        studio.request(Action::Play);
    }
    let (rate, progress) = (studio.t("rate"), studio.t("progress"));
    slider(ui, rate, 3, Slider::new(&mut studio.view.rate, 1.0..=1000.0).logarithmic(true).fixed_decimals(0));
    pass(studio, ui);
    if slider(ui, progress, 1, Slider::new(&mut studio.view.progress, 0.0..=1.0).show_value(false)) {
        studio.view.playing = false;
        studio.view.torch = None;
    }
}

/// The last pass shown of the highest layer.
fn pass(studio: &mut Studio, ui: &mut Ui) {
    let text = studio.t("last-pass");
    let Some(beads) = studio.plans.own.scene.layer(studio.view.last).filter(|beads| !beads.is_empty()).cloned() else {
        ui.add_enabled_ui(false, |ui| slider(ui, text, 2, Slider::new(&mut 0, 0..=0)));
        return;
    };
    let shown = (studio.view.progress * beads.len() as f64).round() as usize;
    let mut number = beads.pass_of(shown.max(1) - 1) + 1;
    if slider(ui, text, 2, Slider::new(&mut number, 1..=beads.passes().len()))
        && let Some(span) = beads.passes().get(number - 1)
    {
        studio.view.progress = span.segments.end as f64 / beads.len() as f64;
        (studio.view.playing, studio.view.torch) = (false, None);
    }
}

/// A slider with its label, in `1 / share` of the remaining width; returns whether it was moved.
fn slider(ui: &mut Ui, text: &str, share: usize, slider: Slider<'_>) -> bool {
    /// Room for the number after it.
    const NUMBER: f32 = 70.0;
    let room = ui.available_width() / share as f32;
    let label = ui.label(text);
    ui.spacing_mut().slider_width = (room - label.rect.width() - NUMBER).max(60.0);
    ui.add(slider).labelled_by(label.id).changed()
}

/// Advances the torch while it plays.
fn advance(studio: &mut Studio, ui: &Ui) {
    if !studio.view.playing {
        return;
    }
    let passed = ui.input(|input| f64::from(input.stable_dt));
    studio.view.advance(passed, &studio.plans.own.scene);
    if studio.view.playing {
        ui.ctx().request_repaint();
    }
}
