//! The part within its preform in 3-D, coloured by how much metal is milled off, and the figures of that.

use super::solid;
use crate::known::{Known, View};
use crate::view3d::{Colour, palette};
use eframe::egui::Ui;

pub(super) fn show(known: Known<'_>, view: &mut View<'_>, ui: &mut Ui) {
    if !known.has_stock() {
        return;
    }
    let [shown, hint, none] = ["stock", "stock-hint", "stock-none"].map(|key| known.t(key));
    ui.horizontal_wrapped(|ui| {
        ui.checkbox(&mut view.state.stock, shown).on_hover_text(hint);
        let range = known.plans.own.scene.scan().map(|part| part.range());
        if let Some(range) = range.filter(|_| view.state.stock) {
            ui.label(none);
            // The lower half of the colours is for metal that is missing.
            solid::scale(ui, |part| palette::at(Colour::HeightError, 0.5 + 0.5 * part));
            ui.label(format!("{range:.1} mm"));
        }
    });
}
