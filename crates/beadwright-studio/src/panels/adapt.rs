//! A scan of the unfinished build: how far it is from the plan, and the layers that follow.

use super::solid;
use crate::actions::Action;
use crate::adaptation::{Adaptation, Follows};
use crate::jobs::Ask;
use crate::known::{Known, Queue, View};
use crate::view2d;
use crate::view3d::{Colour, palette};
use beadwright::adapt::{Adapted, Align, Rules};
use beadwright::deposit::Picture;
use eframe::egui::{Button, ComboBox, DragValue, Id, Image, Role, TextureHandle, TextureOptions, Ui, WidgetInfo, vec2};
use std::ops::RangeInclusive;
use std::sync::Arc;

/// The ways of aligning a scan, with their texts.
const ALIGNS: [(Align, &str); 3] =
    [(Align::AsIs, "align-as-is"), (Align::Plate, "align-plate"), (Align::Fit, "align-fit")];

/// The entry of the menu that chooses a scan.
pub(super) fn entry(known: Known<'_>, queue: &mut Queue, ui: &mut Ui) {
    // Another scan cannot take the place of one that the layers follow.
    let reason = known.unadaptable().or(known.project().adapted.as_ref().map(|_| "adapt-taken"));
    let button =
        ui.add_enabled(reason.is_none(), Button::new(known.t("adapt-open"))).on_hover_text(known.t("adapt-hint"));
    if button.on_disabled_hover_text(known.t(reason.unwrap_or("adapt-hint"))).clicked() {
        queue.push(Action::Ask(Ask::OpenBuildScan));
        ui.close();
    }
}

pub(super) fn show(known: Known<'_>, view: &mut View<'_>, queue: &mut Queue, ui: &mut Ui) {
    ui.weak(known.t("adapt-hint"));
    let taken = known.project().adapted.is_some();
    if ui.add_enabled(!taken, Button::new(known.t("adapt-open"))).clicked() {
        queue.push(Action::Ask(Ask::OpenBuildScan));
    }
    let Some(settings) = known.adaptation(view.state).cloned() else { return };
    let mut chosen = settings.clone();
    ui.add_enabled_ui(!taken, |ui| inputs(known, ui, &mut chosen));
    if chosen != settings && !taken && known.plans.own.is_complete() {
        view.state.adapt = Some(chosen);
        return;
    }
    let adapting = known.jobs.adapting.as_ref().filter(|adapting| adapting.settings == settings);
    match adapting.map(|adapting| &adapting.run.result) {
        None => drop(ui.weak(known.t(known.unadaptable().unwrap_or("adapt-waits")))),
        Some(None) => {
            ui.horizontal(|ui| {
                ui.spinner();
                ui.weak(known.t("adapt-runs"));
            });
        }
        Some(Some(Err(sentence))) => {
            ui.colored_label(ui.visuals().error_fg_color, sentence);
            away(known, queue, ui);
        }
        Some(Some(Ok(follows))) => found(known, queue, ui, follows, taken),
    }
}

/// What can be chosen: the layer, how the scan is aligned, how much metal may be asked for.
fn inputs(known: Known<'_>, ui: &mut Ui, settings: &mut Adaptation) {
    ui.strong(settings.name()).on_hover_text(settings.scan.display().to_string());
    let Adaptation { after_layer, align, window, .. } = settings;
    let planned = known.plans.own.header.as_ref().map_or(1, |header| header.extent.layers.max(1));
    ui.horizontal(|ui| {
        ui.label(known.t("adapt-after"));
        let field = DragValue::new(after_layer).range(1..=planned).clamp_existing_to_range(false);
        let field = field.update_while_editing(false);
        let field = ui.add(field);
        field.widget_info(|| WidgetInfo::labeled(Role::SpinButton, true, known.t("adapt-after")));
    });
    ui.horizontal(|ui| {
        let label = ui.label(known.t("adapt-align"));
        let text = ALIGNS.iter().find(|(known, _)| known == align).map_or("", |(_, key)| known.t(key));
        let combo = ComboBox::from_id_salt("align").selected_text(text).show_ui(ui, |ui| {
            for (way, key) in ALIGNS {
                ui.selectable_value(align, way, known.t(key));
            }
        });
        combo.response.labelled_by(label.id);
    });
    ui.horizontal(|ui| {
        ui.label(known.t("adapt-window")).on_hover_text(known.t("adapt-window-hint"));
        let end = |ui: &mut Ui, value: &mut f64, key: &'static str, range: RangeInclusive<f64>| {
            let field = DragValue::new(value).range(range).speed(0.01).fixed_decimals(2).update_while_editing(false);
            ui.add(field).widget_info(|| WidgetInfo::labeled(Role::SpinButton, true, known.t(key)));
        };
        let [least, most] = window;
        let [lowest, highest] = Rules::LIMITS;
        end(ui, least, "adapt-least", lowest);
        end(ui, most, "adapt-most", highest);
    });
}

/// The scan beside the plan, what follows from it, and the buttons that take it over or write it.
fn found(known: Known<'_>, queue: &mut Queue, ui: &mut Ui, follows: &Follows, taken: bool) {
    for sentence in follows.adapted.sentences() {
        ui.label(sentence);
    }
    if taken {
        ui.weak(known.t("adapt-taken"));
    } else {
        let any = !follows.layers.is_empty();
        if ui.add_enabled(any, Button::new(known.t("adapt-use"))).on_hover_text(known.t("adapt-use-hint")).clicked() {
            queue.push(Action::Adapt);
        }
    }
    away(known, queue, ui);
    ui.separator();
    let reliefs = &follows.reliefs;
    ui.horizontal(|ui| {
        ui.label(format!("{:.2} mm", -reliefs.most));
        solid::scale(ui, |part| palette::at(Colour::HeightError, part));
        ui.label(format!("+{:.2} mm", reliefs.most));
    });
    let pictures = [
        ("adapt-difference", &reliefs.difference),
        ("adapt-measured", &reliefs.measured),
        ("adapt-predicted", &reliefs.predicted),
    ];
    for (key, picture) in pictures {
        relief(ui, known.t(key), picture, &follows.adapted);
    }
}

/// The button that puts the scan away, and brings the plan back where its layers follow the scan.
fn away(known: Known<'_>, queue: &mut Queue, ui: &mut Ui) {
    if ui.button(known.t("scan-away")).clicked() {
        queue.push(Action::CloseBuildScan);
    }
}

/// A picture of heights under its name, sent to the graphics card once for each scan that is compared.
fn relief(ui: &mut Ui, name: &'static str, picture: &Picture, of: &Arc<Adapted>) {
    ui.label(name);
    let id = Id::unique(name);
    let known = ui.ctx().data(|data| data.get_temp::<(Arc<Adapted>, TextureHandle)>(id));
    let known = known.filter(|(shown, _)| Arc::ptr_eq(shown, of)).map(|(_, texture)| texture);
    let texture = known.unwrap_or_else(|| {
        let texture = ui.ctx().load_texture(name, view2d::image(picture), TextureOptions::NEAREST);
        ui.ctx().data_mut(|data| data.insert_temp(id, (of.clone(), texture.clone())));
        texture
    });
    let [width, height] = [picture.width, picture.height].map(|pixels| pixels.max(1) as f32);
    let wide = ui.available_width().clamp(80.0, 300.0);
    let tall = (wide * height / width).min(300.0);
    let image = Image::new(&texture).fit_to_exact_size(vec2(tall * width / height, tall));
    let response = ui.add(image);
    response.widget_info(|| WidgetInfo::labeled(Role::Image, true, name));
}
