//! The robot's arm in the 3-D view; its cell and its joints in one line.

use super::process;
use crate::actions::Action;
use crate::studio::Studio;
use eframe::egui::Ui;

/// The switch that shows the arm; what it needs is computed in the background.
pub(super) fn switch(studio: &mut Studio, ui: &mut Ui) {
    let (robot, waits) = (studio.t("show-robot"), studio.t("show-robot-waits"));
    let ready = studio.plans.own.summary.is_some();
    let shown = ui.add_enabled_ui(ready, |ui| ui.checkbox(&mut studio.view.robot, robot)).inner;
    if shown.on_disabled_hover_text(waits).changed() {
        studio.solid.fit();
    }
    let known = studio.jobs.reach.is_some() || studio.jobs.reach_job.is_some();
    if studio.view.robot && ready && !known {
        studio.request(Action::Reach);
    }
}

/// The cell, and the joints of its arm in its present pose.
pub(super) fn joints(studio: &mut Studio, ui: &mut Ui) {
    if !studio.view.robot {
        return;
    }
    ui.horizontal_wrapped(|ui| {
        process::cell(studio, ui);
        if studio.jobs.reach.is_none() {
            ui.weak(studio.t("reach-runs"));
            return;
        }
        let Some(arm) = studio.arm() else {
            ui.colored_label(ui.visuals().warn_fg_color, studio.t("out-of-reach"));
            return;
        };
        for (i, angle) in arm.joints.iter().enumerate() {
            ui.label(format!("J{} {angle:.1}°", i + 1));
        }
        ui.weak(format!("{}: {:.1}°", studio.t("margin-here"), arm.margin));
    });
}
