//! The robot's arm in the 3-D view; its cell, its joints and the axes of the positioner in one line.

use super::process;
use crate::actions::Action;
use crate::known::{Known, Queue, View};
use beadwright::profile::Misfit;
use beadwright::program::PositionerAxis;
use eframe::egui::{Label, RichText, TextWrapMode, Ui};

/// The switch that shows the arm; the poses that it needs are computed in the background.
pub(super) fn switch(known: Known<'_>, view: &mut View<'_>, queue: &mut Queue, ui: &mut Ui) {
    let (robot, waits) = (known.t("show-robot"), known.t("show-robot-waits"));
    let ready = known.plans.own.is_planned();
    let shown = ui.add_enabled_ui(ready, |ui| ui.checkbox(&mut view.state.robot, robot)).inner;
    if shown.on_disabled_hover_text(waits).changed() {
        view.solid.fit();
    }
    let known = known.jobs.reach.is_some() || known.jobs.reach_job.is_some();
    if view.state.robot && ready && !known {
        queue.push(Action::Reach);
    }
}

/// The cell, and the joints of its arm in its present pose.
pub(super) fn joints(known: Known<'_>, view: &View<'_>, queue: &mut Queue, ui: &mut Ui) {
    // A bent shape is shown without the arm.
    if !view.state.robot || known.bent(view.state).is_some() {
        return;
    }
    ui.horizontal_wrapped(|ui| {
        // Lines break between angles, not within them.
        ui.style_mut().wrap_mode = Some(TextWrapMode::Extend);
        process::cell(known, view, queue, ui);
        misfits(known, ui);
        if known.jobs.reach.is_none() {
            ui.weak(known.t("reach-runs"));
            return;
        }
        axes(known, view, ui);
        let Some(arm) = known.arm(view.state) else {
            ui.colored_label(ui.visuals().warn_fg_color, known.t("out-of-reach"));
            return;
        };
        for (i, angle) in arm.joints.iter().enumerate() {
            ui.label(format!("J{} {angle:.1}°", i + 1));
        }
        ui.weak(format!("{}: {:.1}°", known.t("margin-here"), arm.margin));
    });
}

/// In what the cell does not fit the profile.
pub(super) fn misfits(known: Known<'_>, ui: &mut Ui) {
    let Some((cell, profile)) = known.jobs.cell.as_ref().zip(known.plans.own.profile.as_ref()) else { return };
    for misfit in profile.misfits(cell) {
        let text = match &misfit {
            Misfit::Dialect { reads, written } => {
                known.t("misfit-dialect").replace("{written}", written).replace("{reads}", reads)
            }
            Misfit::NoPositioner => known.t("misfit-no-positioner").to_owned(),
            Misfit::IdlePositioner => known.t("misfit-idle-positioner").to_owned(),
            Misfit::NoTable => known.t("misfit-no-table").to_owned(),
            Misfit::NoLinearAxis => known.t("misfit-no-linear-axis").to_owned(),
        };
        let label = Label::new(RichText::new(text).color(ui.visuals().warn_fg_color)).wrap();
        ui.add(label).on_hover_text(misfit.sentence());
    }
}

/// The angles of the positioner's axes now, and their limits.
fn axes(known: Known<'_>, view: &View<'_>, ui: &mut Ui) {
    let Some(held) = known.held(view.state) else { return };
    for (number, (axis, angle)) in known.axes().iter().zip(held.angles).enumerate() {
        ui.label(format!("{} {angle:.1}° ({})", axis_name(known, number), limits(axis)));
    }
}

/// What an axis of the positioner is called, counted from 0.
pub(super) fn axis_name(known: Known<'_>, axis: usize) -> String {
    format!("{} {}", known.t("positioner-axis"), axis + 1)
}

/// The limits of an axis, °.
pub(super) fn limits(axis: &PositionerAxis) -> String {
    let [least, most] = axis.limits;
    format!("{least:.0} … {most:.0}°")
}
