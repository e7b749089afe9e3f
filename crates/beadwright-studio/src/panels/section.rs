//! The section through the 3-D view: its axis, its position, and the side that is cut away.

use crate::known::{Known, View};
use crate::view3d::Section;
use eframe::egui::{ComboBox, Slider, Ui};

/// The axes, by the number of a section.
const AXES: [&str; 3] = ["x", "y", "z"];

pub(super) fn show(known: Known<'_>, view: &mut View<'_>, ui: &mut Ui) {
    let Some((low, high)) = known.plans.own.scene.bounds() else { return };
    let (mut section, off) = (view.state.section, known.t("section-off"));
    let label = ui.label(known.t("section"));
    let now = section.map_or(off, |section| AXES[section.axis]);
    let combo = ComboBox::from_id_salt("section").width(50.0).selected_text(now).show_ui(ui, |ui| {
        if ui.selectable_label(section.is_none(), off).clicked() {
            section = None;
        }
        for (axis, name) in AXES.into_iter().enumerate() {
            if ui.selectable_label(section.is_some_and(|section| section.axis == axis), name).clicked() {
                // The side nearer to the viewer is cut away, so that the section is seen.
                let lower = view.solid.camera.back()[axis] < 0.0;
                section = Some(Section { axis, at: (low[axis] + high[axis]) / 2.0, lower });
            }
        }
    });
    combo.response.labelled_by(label.id);
    if let Some(section) = &mut section {
        let label = ui.label(known.t("section-at"));
        let range = low[section.axis]..=high[section.axis];
        ui.add(Slider::new(&mut section.at, range).suffix(" mm").fixed_decimals(1)).labelled_by(label.id);
        ui.checkbox(&mut section.lower, known.t("section-lower"));
    }
    view.state.section = section;
}
