//! The panels around the views, one file each.

mod adapt;
mod basic;
mod batch;
mod bead;
mod centre;
mod clock;
mod compare;
mod directions;
mod distortion;
mod export;
mod findings;
mod help;
mod layers;
mod menu;
mod messages;
mod parameters;
mod place;
mod placement;
mod plots;
mod process;
mod program;
mod questions;
mod robot;
mod scan;
mod section;
pub(crate) mod solid;
mod start;
mod stock;
mod totals;
mod trial;
mod words;

use crate::known::{Known, Queue, View};
use crate::view::{Mode, Side};
use eframe::egui::{Button, CentralPanel, Panel, ScrollArea, TextStyle, Ui, Vec2, vec2};

/// The fraction of the window that a panel at its side takes at most.
const WIDEST: f32 = 0.36;

/// The whole window.
pub(crate) fn show(known: Known<'_>, view: &mut View<'_>, queue: &mut Queue, ui: &mut Ui) {
    Panel::top("menu").show(ui, |ui| menu::show(known, view, queue, ui));
    let open = known.project().source.is_some();
    // Always there and of one height once a part is open, so that the views do not move when there is something to say.
    if messages::any(known) || open {
        Panel::bottom("messages").exact_size(messages::HEIGHT).show(ui, |ui| messages::show(known, queue, ui));
    }
    if open {
        around(known, view, queue, ui);
        centre::show(known, view, queue, ui);
    } else {
        CentralPanel::default().show(ui, |ui| start::show(known, view, queue, ui));
    }
    questions::show(known, view, queue, ui);
    help::show(known, view, ui);
    batch::show(known, view, queue, ui);
}

/// The panels around the view of a part.
fn around(known: Known<'_>, view: &mut View<'_>, queue: &mut Queue, ui: &mut Ui) {
    if known.plans.own.layer_count() > 0 {
        Panel::bottom("layers").show(ui, |ui| layers::show(known, view, queue, ui));
    }
    // As wide as the window, so that nothing is cut off.
    if view.state.mode == Mode::Compare && known.plans.other.is_some() {
        Panel::bottom("differences").show(ui, |ui| compare::differences(known, ui));
    }
    // Beside the panels there must be room for the view, with large text too.
    let widest = WIDEST * ui.available_width();
    Panel::left("parameters").default_size(300.0).max_size(widest).show(ui, |ui| {
        scrolled(ui, |ui| {
            placement::show(known, view, queue, ui);
            parameters::show(known, view, queue, ui);
        });
    });
    Panel::right("side").default_size(330.0).max_size(widest).show(ui, |ui| side(known, view, queue, ui));
}

/// The contents of a panel. They scroll both ways, since a panel grows with whatever is wider than it.
fn scrolled(ui: &mut Ui, contents: impl FnOnce(&mut Ui)) {
    ScrollArea::both().auto_shrink(false).show(ui, contents);
}

/// The size of a button with this text, so that the buttons next to it do not move when its own text changes.
fn room(ui: &Ui, text: String) -> Vec2 {
    let ink = ui.visuals().text_color();
    let galley = ui.painter().layout_no_wrap(text, TextStyle::Button.resolve(ui.style()), ink);
    vec2(galley.size().x + 2.0 * ui.spacing().button_padding.x, 0.0)
}

fn side(known: Known<'_>, view: &mut View<'_>, queue: &mut Queue, ui: &mut Ui) {
    let mut tabs = vec![
        (Side::Totals, "totals"),
        (Side::Findings, "findings"),
        (Side::Plots, "plots"),
        (Side::Program, "program"),
        (Side::Export, "export"),
    ];
    if known.jobs.dividing.is_some() || view.state.side == Side::Directions {
        tabs.push((Side::Directions, "directions"));
    }
    if view.state.adapt.is_some() || known.project().adapted.is_some() || view.state.side == Side::Adapt {
        tabs.push((Side::Adapt, "adapt"));
    }
    ui.horizontal_wrapped(|ui| {
        for (side, key) in tabs {
            let count = if side == Side::Findings { known.plans.own.found() } else { 0 };
            let text = if count > 0 { format!("{} ({count})", known.t(key)) } else { known.t(key).to_owned() };
            let widest = if side == Side::Findings { format!("{} (999)", known.t(key)) } else { text.clone() };
            let button = Button::selectable(view.state.side == side, text).min_size(room(ui, widest));
            if ui.add(button).clicked() {
                view.state.side = side;
            }
        }
    });
    ui.separator();
    if view.state.side == Side::Program {
        // It scrolls by itself, since only the lines in view are laid out.
        program::show(known, view, queue, ui);
        return;
    }
    scrolled(ui, |ui| match view.state.side {
        Side::Totals => totals::show(known, view, ui),
        Side::Findings => findings::show(known, view, queue, ui),
        Side::Plots => plots::show(known, view, queue, ui),
        Side::Program => {}
        Side::Adapt => adapt::show(known, view, queue, ui),
        Side::Directions => directions::show(known, view, queue, ui),
        Side::Export => export::show(known, view, queue, ui),
    });
}
