//! The scan in 3-D: figures of its deviation, what its colours mean, and what is doubtful.

use super::solid;
use crate::actions::Action;
use crate::known::{Known, Queue, View};
use crate::view3d::{Colour, palette};
use beadwright::deviation::Figures;
use eframe::egui::Ui;

pub(super) fn show(known: Known<'_>, view: &mut View<'_>, queue: &mut Queue, ui: &mut Ui) {
    if known.jobs.scan_job.is_some() {
        ui.horizontal(|ui| {
            ui.spinner();
            ui.weak(known.t("scan-runs"));
        });
    }
    if known.scan().is_none() {
        return;
    }
    let [shown, hint, away] = ["scan", "scan-hint", "scan-away"].map(|key| known.t(key));
    ui.horizontal_wrapped(|ui| {
        ui.checkbox(&mut view.state.scan, shown).on_hover_text(hint);
        let Some(scan) = known.scan() else { return };
        ui.strong(&scan.name);
        figures(known, ui, &scan.deviation.figures);
        legend(known, ui);
        if ui.button(away).clicked() {
            queue.push(Action::CloseScan);
        }
    });
    for doubt in known.scan().iter().flat_map(|scan| &scan.deviation.doubts) {
        let sentence = doubt.to_string();
        ui.colored_label(ui.visuals().warn_fg_color, sentence.replacen("the", "The", 1));
    }
}

/// Mean, spread, the farthest points with their places, and how much lies within the allowance.
fn figures(known: Known<'_>, ui: &mut Ui, figures: &Figures) {
    let Figures { mean, standard_deviation, highest, lowest, allowance, .. } = figures;
    let farthest = [("scan-outside", highest), ("scan-inside", lowest)];
    let percent = |part: f64| 100.0 * part;
    ui.label(format!("{} {mean:+.2} ± {standard_deviation:.2} mm", known.t("scan-mean")));
    for (key, extreme) in farthest {
        let at = extreme.at;
        let place = format!("x {:.1} y {:.1} z {:.1} mm", at.x, at.y, at.z);
        ui.weak("·");
        ui.label(format!("{} {:+.2} mm", known.t(key), extreme.distance)).on_hover_text(place);
    }
    if *allowance > 0.0 {
        ui.weak("·");
        ui.label(format!("{} 0–{allowance} mm: {:.0} %", known.t("scan-within"), percent(figures.within)));
    }
    ui.weak("·");
    ui.label(format!("{}: {:.0} %", known.t("scan-below"), percent(figures.below)));
}

fn legend(known: Known<'_>, ui: &mut Ui) {
    let Some(range) = known.plans.own.scene.scan().map(|scan| scan.range()) else { return };
    ui.label(format!("{:.2} mm", -range));
    solid::scale(ui, |part| palette::at(Colour::HeightError, part));
    ui.label(format!("+{range:.2} mm"));
}
