//! The bent shape in 3-D: clamps, on them or released, how much it is exaggerated, and its figures.

use super::solid;
use crate::actions::Action;
use crate::distortion::{Distorted, Distorting, Figure};
use crate::known::{Known, Queue, View};
use crate::view3d::{Colour, palette};
use beadwright::distort::DVec3;
use beadwright::distortion::Clamps;
use eframe::egui::{Checkbox, ComboBox, ProgressBar, Slider, TextWrapMode, Ui};

/// Where clamps can be, with their texts.
const CLAMPS: [(Clamps, &str); 3] =
    [(Clamps::Corners, "clamps-corners"), (Clamps::Edge, "clamps-edge"), (Clamps::None, "clamps-none")];

/// The movement is drawn at most this many times as large as it is.
const MOST_TIMES: f64 = 500.0;

/// Parts with fewer segments follow the slider while it is dragged.
const FOLLOWS_BELOW: usize = 200_000;

/// The switch that shows the bent shape, which is computed in the background.
pub(super) fn switch(known: Known<'_>, view: &mut View<'_>, queue: &mut Queue, ui: &mut Ui) {
    let [bent, hint, waits] = ["show-bent", "show-bent-hint", "show-bent-waits"].map(|key| known.t(key));
    let own = &known.plans.own;
    let ready = own.summary.is_some() && own.is_of_last_request();
    let shown = ui.add_enabled(ready, Checkbox::new(&mut view.state.bend.shown, bent));
    shown.on_hover_text(hint).on_disabled_hover_text(waits);
    let bend = view.state.bend;
    let computed = known.jobs.distortion.as_ref().is_some_and(|distortion| distortion.clamps == bend.clamps);
    if bend.shown && ready && !computed {
        queue.push(Action::Distort);
    }
}

pub(super) fn show(known: Known<'_>, view: &mut View<'_>, queue: &mut Queue, ui: &mut Ui) {
    let Some(distortion) = known.jobs.distortion.as_ref().filter(|_| view.state.bend.shown) else { return };
    ui.horizontal_wrapped(|ui| {
        clamps(known, view, ui);
        match &distortion.run.result {
            None => progress(known, distortion, queue, ui),
            Some(Err(sentence)) => drop(ui.colored_label(ui.visuals().warn_fg_color, sentence)),
            Some(Ok(distorted)) => shape(known, view, distorted, ui),
        }
    });
    if let Some(Ok(distorted)) = &distortion.run.result {
        ui.horizontal_wrapped(|ui| {
            // Lines break between figures, not within them.
            ui.style_mut().wrap_mode = Some(TextWrapMode::Extend);
            legend(known, view, distorted, ui);
            figures(known, distorted, ui);
        });
    }
}

fn clamps(known: Known<'_>, view: &mut View<'_>, ui: &mut Ui) {
    let label = ui.label(known.t("clamps"));
    let text = |clamps| CLAMPS.iter().find(|(c, _)| *c == clamps).map_or("clamps-corners", |(_, key)| *key);
    let now = known.t(text(view.state.bend.clamps));
    let combo = ComboBox::from_id_salt("clamps").selected_text(now).show_ui(ui, |ui| {
        for (clamps, key) in CLAMPS {
            ui.selectable_value(&mut view.state.bend.clamps, clamps, known.t(key));
        }
    });
    combo.response.labelled_by(label.id);
}

fn progress(known: Known<'_>, distortion: &Distorting, queue: &mut Queue, ui: &mut Ui) {
    let done = distortion.run.progress().map_or(0.0, |progress| progress.done as f32);
    ui.weak(known.t("stage-distort"));
    ui.add(ProgressBar::new(done).desired_width(160.0).show_percentage());
    if ui.button(known.t("cancel")).clicked() {
        queue.push(Action::StopDistortion);
    }
}

/// Which shape is shown, and how large its movement is drawn.
fn shape(known: Known<'_>, view: &mut View<'_>, distorted: &Distorted, ui: &mut Ui) {
    let bend = &mut view.state.bend;
    // Without clamps nothing is released.
    if bend.clamps != Clamps::None {
        ui.selectable_value(&mut bend.clamped, true, known.t("bent-clamped"));
        ui.selectable_value(&mut bend.clamped, false, known.t("bent-released"));
    }
    let label = ui.label(known.t("bent-times")).on_hover_text(known.t("bent-times-hint"));
    let mut times = bend.times.unwrap_or(distorted.times);
    let slider = Slider::new(&mut times, 0.0..=MOST_TIMES).logarithmic(true).smallest_positive(1.0).step_by(1.0);
    let slider = ui.add(slider.suffix(" ×")).labelled_by(label.id);
    // A large part is bent once the slider rests: it would lag behind.
    let follows = !slider.dragged() || known.plans.own.scene.segments() < FOLLOWS_BELOW;
    if slider.changed() && follows {
        bend.times = Some(times);
    }
}

/// What the colours mean.
fn legend(known: Known<'_>, view: &View<'_>, distorted: &Distorted, ui: &mut Ui) {
    let figure = if view.state.bend.clamped { &distorted.clamped } else { &distorted.released };
    ui.label("0 mm");
    solid::scale(ui, |part| palette::at(Colour::Movement, part));
    ui.label(format!("{:.2} mm", figure.bent.most())).on_hover_text(known.t("bent-colours-hint"));
    ui.separator();
}

/// Lift of the plate and deviation of the part.
fn figures(known: Known<'_>, Distorted { clamped, released, .. }: &Distorted, ui: &mut Ui) {
    let lift = |figure: &Figure| (figure.lift.range, figure.lift.at);
    let deviation = |figure: &Figure| (figure.deviation.largest, figure.deviation.at);
    row(known, ["bent-lift", "bent-lift-hint"], [clamped, released].map(lift), ui);
    row(known, ["bent-deviation", "bent-deviation-hint"], [clamped, released].map(deviation), ui);
}

/// A figure clamped and released, mm, with its places as hints.
fn row(known: Known<'_>, [name, hint]: [&'static str; 2], [clamped, released]: [(f64, DVec3); 2], ui: &mut Ui) {
    let (on_clamps, free) = (known.t("bent-clamped"), known.t("bent-released"));
    let text = format!("{}: {on_clamps} {:.2} mm, {free} {:.2} mm", known.t(name), clamped.0, released.0);
    let place = |at: DVec3| format!("x {:.0} y {:.0} z {:.0} mm", at.x, at.y, at.z);
    let most = format!("{}: {on_clamps} {}, {free} {}", known.t("bent-most-at"), place(clamped.1), place(released.1));
    ui.label(text).on_hover_text(format!("{} {most}", known.t(hint)));
}
