//! The panels around the views, one file each.

mod basic;
mod bead;
mod centre;
mod compare;
mod export;
mod findings;
mod layers;
mod menu;
mod messages;
mod parameters;
mod place;
mod placement;
mod plots;
mod process;
mod questions;
mod robot;
mod scan;
mod section;
pub(crate) mod solid;
mod start;
mod stock;
mod totals;
mod words;

use crate::studio::Studio;
use crate::view::{Mode, Side};
use eframe::egui::{Button, CentralPanel, Panel, ScrollArea, TextStyle, Ui, Vec2, vec2};

/// The whole window.
pub(crate) fn show(studio: &mut Studio, ui: &mut Ui) {
    Panel::top("menu").show(ui, |ui| menu::show(studio, ui));
    let open = studio.project().source.is_some();
    // Always there and of one height once a part is open, so that the views do not move when there is something to say.
    if messages::any(studio) || open {
        Panel::bottom("messages").exact_size(messages::HEIGHT).show(ui, |ui| messages::show(studio, ui));
    }
    if open {
        around(studio, ui);
        centre::show(studio, ui);
    } else {
        CentralPanel::default().show(ui, |ui| start::show(studio, ui));
    }
    questions::show(studio, ui);
}

/// What is around the view of a part.
fn around(studio: &mut Studio, ui: &mut Ui) {
    if studio.plans.own.layer_count() > 0 {
        Panel::bottom("layers").show(ui, |ui| layers::show(studio, ui));
    }
    // As wide as the window, so that nothing is cut off.
    if studio.view.mode == Mode::Compare && studio.plans.other.is_some() {
        Panel::bottom("differences").show(ui, |ui| compare::differences(studio, ui));
    }
    Panel::left("parameters").default_size(300.0).show(ui, |ui| {
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            placement::show(studio, ui);
            parameters::show(studio, ui);
        });
    });
    Panel::right("side").default_size(330.0).show(ui, |ui| side(studio, ui));
}

/// The size of a button with this text, so that the buttons next to it stay where they are when its own text changes.
fn room(ui: &Ui, text: String) -> Vec2 {
    let ink = ui.visuals().text_color();
    let galley = ui.painter().layout_no_wrap(text, TextStyle::Button.resolve(ui.style()), ink);
    vec2(galley.size().x + 2.0 * ui.spacing().button_padding.x, 0.0)
}

fn side(studio: &mut Studio, ui: &mut Ui) {
    let tabs =
        [(Side::Totals, "totals"), (Side::Findings, "findings"), (Side::Plots, "plots"), (Side::Export, "export")];
    ui.horizontal(|ui| {
        for (side, key) in tabs {
            let count = studio.plans.own.findings.as_ref().filter(|_| side == Side::Findings).map_or(0, Vec::len);
            let text = if count > 0 { format!("{} ({count})", studio.t(key)) } else { studio.t(key).to_owned() };
            let widest = if side == Side::Findings { format!("{} (999)", studio.t(key)) } else { text.clone() };
            let button = Button::selectable(studio.view.side == side, text).min_size(room(ui, widest));
            if ui.add(button).clicked() {
                studio.view.side = side;
            }
        }
    });
    ui.separator();
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| match studio.view.side {
        Side::Totals => totals::show(studio, ui),
        Side::Findings => findings::show(studio, ui),
        Side::Plots => plots::show(studio, ui),
        Side::Export => export::show(studio, ui),
    });
}
