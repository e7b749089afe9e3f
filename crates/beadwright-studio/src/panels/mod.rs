//! The panels around the views, one file each.

mod centre;
mod export;
mod findings;
mod layers;
mod menu;
mod messages;
mod parameters;
mod placement;
mod plots;
mod questions;
pub(crate) mod solid;
mod totals;

use crate::studio::Studio;
use crate::view::Side;
use eframe::egui::{Panel, ScrollArea, Ui};

/// The whole window.
pub(crate) fn show(studio: &mut Studio, ui: &mut Ui) {
    Panel::top("menu").show(ui, |ui| menu::show(studio, ui));
    if messages::any(studio) {
        Panel::bottom("messages").show(ui, |ui| messages::show(studio, ui));
    }
    if studio.plans.own.layer_count() > 0 {
        Panel::bottom("layers").show(ui, |ui| layers::show(studio, ui));
    }
    Panel::left("parameters").default_size(300.0).show(ui, |ui| {
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            placement::show(studio, ui);
            parameters::show(studio, ui);
        });
    });
    Panel::right("side").default_size(330.0).show(ui, |ui| side(studio, ui));
    centre::show(studio, ui);
    questions::show(studio, ui);
}

fn side(studio: &mut Studio, ui: &mut Ui) {
    let tabs =
        [(Side::Totals, "totals"), (Side::Findings, "findings"), (Side::Plots, "plots"), (Side::Export, "export")];
    ui.horizontal(|ui| {
        for (side, key) in tabs {
            let count = studio.plans.own.findings.as_ref().filter(|_| side == Side::Findings).map_or(0, Vec::len);
            let text = if count > 0 { format!("{} ({count})", studio.t(key)) } else { studio.t(key).to_owned() };
            ui.selectable_value(&mut studio.view.side, side, text);
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
