//! Before a part is open: where to drop one, process and robot, the examples, recent files.

use super::process;
use crate::actions::Action;
use crate::known::{Known, Queue, View};
use crate::thumbnail::SIZE;
use beadwright::example::{self, Example};
use eframe::egui::{
    Align2, Button, Color32, FontId, Frame, Rect, RichText, Role, ScrollArea, Sense, Stroke, TextureId, Ui, Vec2,
    WidgetInfo, pos2, vec2,
};

/// Maximum number of recent files listed.
const RECENT: usize = 6;

pub(super) fn show(known: Known<'_>, view: &View<'_>, queue: &mut Queue, ui: &mut Ui) {
    // One in a frame, so that none takes long.
    if known.window.pictures.len() < example::ALL.len() {
        queue.push(Action::DrawExample);
    }
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        ui.spacing_mut().item_spacing = vec2(10.0, 10.0);
        drop_zone(known, queue, ui);
        ui.add_space(6.0);
        ui.strong(known.t("start-process"));
        ui.horizontal_wrapped(|ui| {
            process::profile(known, queue, ui);
            ui.separator();
            process::cell(known, view, queue, ui);
        });
        if let Some(parsed) = known.parsed() {
            ui.weak(&parsed.profile.description);
        }
        ui.add_space(6.0);
        recent(known, queue, ui);
        ui.add_space(6.0);
        ui.strong(known.t("start-examples"));
        ui.horizontal_wrapped(|ui| examples(known, queue, ui));
    });
}

fn drop_zone(known: Known<'_>, queue: &mut Queue, ui: &mut Ui) {
    let visuals = ui.visuals().clone();
    let hovers = ui.input(|input| !input.raw.hovered_files.is_empty());
    let (fill, ink) = if hovers {
        (visuals.selection.bg_fill.gamma_multiply(0.4), visuals.selection.bg_fill)
    } else {
        (visuals.faint_bg_color, visuals.weak_text_color())
    };
    Frame::new().fill(fill).stroke(Stroke::new(1.5, ink)).corner_radius(8.0).inner_margin(26.0).show(ui, |ui| {
        ui.vertical_centered(|ui| {
            ui.heading(RichText::new(known.t("start-drop")).strong());
            ui.weak(known.t("start-formats"));
            if ui.add(Button::new(known.t("open")).min_size(vec2(120.0, 30.0))).clicked() {
                queue.push(Action::Open);
            }
        });
    });
}

fn examples(known: Known<'_>, queue: &mut Queue, ui: &mut Ui) {
    for (i, example) in example::ALL.iter().enumerate() {
        let picture = known.window.pictures.get(i).map(|texture| texture.id());
        if tile(ui, example, picture) {
            queue.push(Action::OpenExample(example.name));
        }
    }
}

/// An example with its picture, name and size; whether it was clicked.
fn tile(ui: &mut Ui, example: &Example, picture: Option<TextureId>) -> bool {
    let size = Vec2::from(SIZE.map(|length| length as f32));
    let (rect, response) = ui.allocate_exact_size(size + vec2(8.0, 44.0), Sense::click());
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, example.name));
    let look = ui.style().interact(&response);
    let ink = look.text_color();
    ui.painter().rect(rect, 6.0, look.weak_bg_fill, look.bg_stroke, eframe::egui::StrokeKind::Inside);
    let place = Rect::from_min_size(rect.min + vec2(4.0, 4.0), size);
    if let Some(picture) = picture {
        ui.painter().image(picture, place, Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0)), Color32::WHITE);
    }
    let line = |up: f32, text: &str, size: f32| {
        let at = rect.center_bottom() - vec2(0.0, up);
        ui.painter().text(at, Align2::CENTER_BOTTOM, text, FontId::proportional(size), ink);
    };
    line(20.0, example.name, 14.0);
    // The line about an example ends with its size.
    line(5.0, example.about.rsplit(", ").next().unwrap_or_default(), 11.0);
    response.on_hover_text(example.about).clicked()
}

fn recent(known: Known<'_>, queue: &mut Queue, ui: &mut Ui) {
    if known.window.settings.recent.is_empty() {
        return;
    }
    ui.strong(known.t("start-recent"));
    for path in known.window.settings.recent.iter().take(RECENT).cloned().collect::<Vec<_>>() {
        let name = path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
        let folder = path.parent().map_or_else(String::new, |folder| folder.display().to_string());
        ui.horizontal(|ui| {
            if ui.link(name).clicked() {
                queue.push(Action::OpenFile(path));
            }
            ui.weak(folder);
        });
    }
}
