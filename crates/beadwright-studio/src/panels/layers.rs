//! Below the views: which layers are shown, how much of the highest, and the torch that runs.

use crate::actions::Action;
use crate::app::Studio;
use eframe::egui::{Slider, Ui};

pub(super) fn show(studio: &mut Studio, ui: &mut Ui) {
    let layers = studio.plan.layer_count();
    if layers == 0 {
        return;
    }
    advance(studio, ui);
    let (mut first, mut last) = (studio.view.first + 1, studio.view.last + 1);
    ui.horizontal(|ui| {
        ui.spacing_mut().slider_width = (ui.available_width() / 2.0 - 190.0).max(60.0);
        let low = ui.add(Slider::new(&mut first, 1..=last).text(studio.t("first-layer")));
        let high = ui.add(Slider::new(&mut last, 1..=layers).text(studio.t("last-layer")));
        if high.changed() {
            studio.view.look_at(last - 1);
        }
        if low.changed() {
            studio.view.first = first - 1;
        }
    });
    ui.horizontal(|ui| {
        let playing = studio.view.playing;
        let word = if playing { studio.t("stop") } else { studio.t("play") };
        if ui.button(format!("{} {word}", if playing { "■" } else { "▶" })).clicked() {
            studio.act(Action::Play);
        }
        ui.spacing_mut().slider_width = (ui.available_width() / 2.0 - 190.0).max(60.0);
        let (rate, progress) = (studio.t("rate"), studio.t("progress"));
        ui.add(Slider::new(&mut studio.view.rate, 1.0..=1000.0).logarithmic(true).text(rate));
        let progress = Slider::new(&mut studio.view.progress, 0.0..=1.0).show_value(false).text(progress);
        if ui.add(progress).changed() {
            studio.view.playing = false;
            studio.view.torch = None;
        }
    });
}

/// Moves the torch on while it plays.
fn advance(studio: &mut Studio, ui: &Ui) {
    if !studio.view.playing {
        return;
    }
    let passed = ui.input(|input| f64::from(input.stable_dt));
    studio.view.advance(passed, &studio.plan.scene);
    if studio.view.playing {
        ui.ctx().request_repaint();
    }
}
