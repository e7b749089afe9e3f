//! The scan in 3-D: what its deviation comes to, what its colours mean, and what is doubtful.

use super::solid;
use crate::actions::Action;
use crate::studio::Studio;
use crate::view3d::{Colour, palette};
use beadwright::deviation::Figures;
use eframe::egui::Ui;

pub(super) fn show(studio: &mut Studio, ui: &mut Ui) {
    if studio.jobs.scan_job.is_some() {
        ui.horizontal(|ui| {
            ui.spinner();
            ui.weak(studio.t("scan-runs"));
        });
    }
    if studio.scan().is_none() {
        return;
    }
    let [shown, hint, away] = ["scan", "scan-hint", "scan-away"].map(|key| studio.t(key));
    ui.horizontal_wrapped(|ui| {
        ui.checkbox(&mut studio.view.scan, shown).on_hover_text(hint);
        let Some(scan) = studio.scan() else { return };
        ui.strong(&scan.name);
        figures(studio, ui, &scan.deviation.figures);
        legend(studio, ui);
        if ui.button(away).clicked() {
            studio.request(Action::CloseScan);
        }
    });
    for doubt in studio.scan().iter().flat_map(|scan| &scan.deviation.doubts) {
        let sentence = doubt.to_string();
        ui.colored_label(ui.visuals().warn_fg_color, sentence.replacen("the", "The", 1));
    }
}

/// Mean, spread, the farthest points with their places, and how much lies within the allowance.
fn figures(studio: &Studio, ui: &mut Ui, figures: &Figures) {
    let Figures { mean, standard_deviation, highest, lowest, allowance, .. } = figures;
    let farthest = [("scan-outside", highest), ("scan-inside", lowest)];
    let percent = |part: f64| 100.0 * part;
    ui.label(format!("{} {mean:+.2} ± {standard_deviation:.2} mm", studio.t("scan-mean")));
    for (key, extreme) in farthest {
        let at = extreme.at;
        let place = format!("x {:.1} y {:.1} z {:.1} mm", at.x, at.y, at.z);
        ui.weak("·");
        ui.label(format!("{} {:+.2} mm", studio.t(key), extreme.distance)).on_hover_text(place);
    }
    if *allowance > 0.0 {
        ui.weak("·");
        ui.label(format!("{} 0–{allowance} mm: {:.0} %", studio.t("scan-within"), percent(figures.within)));
    }
    ui.weak("·");
    ui.label(format!("{}: {:.0} %", studio.t("scan-below"), percent(figures.below)));
}

fn legend(studio: &Studio, ui: &mut Ui) {
    let Some(range) = studio.plans.own.scene.scan().map(|scan| scan.range()) else { return };
    ui.label(format!("{:.2} mm", -range));
    solid::scale(ui, |part| palette::at(Colour::HeightError, part, true));
    ui.label(format!("+{range:.2} mm"));
}
