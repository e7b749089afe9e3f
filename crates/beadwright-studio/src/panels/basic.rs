//! The basic parameters: the ten that change a part the most, each with its unit and why one would change it.

use super::parameters::Form;
use crate::form;
use eframe::egui::{Grid, RichText, Ui};

/// Width of the names, points.
const NAMES: f32 = 120.0;

pub(super) fn show(form: &mut Form<'_>, ui: &mut Ui) {
    for key in form::BASIC {
        let Some(field) = form::field(key).filter(|_| form.has(key)) else { continue };
        let language = form.known.language();
        let name = language.word("basic", key);
        Grid::new(key).num_columns(2).min_col_width(NAMES).show(ui, |ui| form.row(ui, field, name));
        ui.label(RichText::new(language.word("why", key)).small().weak());
        ui.add_space(4.0);
    }
}
