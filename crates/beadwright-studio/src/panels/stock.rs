//! The part within its preform in 3-D, coloured by how much metal is milled off, and what that comes to.

use super::solid;
use crate::studio::Studio;
use crate::view3d::{Colour, palette};
use eframe::egui::Ui;

pub(super) fn show(studio: &mut Studio, ui: &mut Ui) {
    if !studio.has_stock() {
        return;
    }
    let [shown, hint, none] = ["stock", "stock-hint", "stock-none"].map(|key| studio.t(key));
    ui.horizontal_wrapped(|ui| {
        ui.checkbox(&mut studio.view.stock, shown).on_hover_text(hint);
        let range = studio.plans.own.scene.scan().map(|part| part.range());
        if let Some(range) = range.filter(|_| studio.view.stock) {
            ui.label(none);
            // The lower half of the colours is for metal that is missing.
            solid::scale(ui, |part| palette::at(Colour::HeightError, 0.5 + 0.5 * part, true));
            ui.label(format!("{range:.1} mm"));
        }
    });
}
