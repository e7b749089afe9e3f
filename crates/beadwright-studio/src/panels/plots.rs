//! Plots: figures for every layer, measured beads, the robot's joints and the positioner's axes.

use super::{process, robot, words};
use crate::actions::Action;
use crate::jobs::Ask;
use crate::known::{Known, Queue, View};
use crate::theme::ink;
use beadwright::palette::CURVES;
use beadwright::program::PositionerAxis;
use beadwright::report::{bead_window, plot as page};
use beadwright::robot::{Pose, Reach, Stop, Suggestion};
use eframe::egui::{Rangef, Response, Ui};
use egui_plot::{AxisHints, HLine, Legend, Line, LineStyle, Plot, PlotPoints};

/// Maximum number of points drawn for a curve.
const POINTS: usize = 2000;

/// Spacing of the numbers on an axis in screen points, from barely visible to clear; the plots are small here.
const SPACING: Rangef = Rangef { min: 25.0, max: 40.0 };

/// Limits no farther than this from an angle are drawn, °.
const HALF_TURN: f64 = 180.0;

/// Height of a plot, points.
const HEIGHT: f32 = 140.0;

pub(super) fn show(known: Known<'_>, view: &View<'_>, queue: &mut Queue, ui: &mut Ui) {
    let (x, none) = (known.t("axis-layer"), known.t("no-values"));
    let judged = |value: fn(&beadwright::deposit::Figures) -> f64| -> Vec<[f64; 2]> {
        let figures = known.plans.own.judgements.iter().enumerate();
        figures.map(|(i, judgement)| [i as f64 + 1.0, value(&judgement.figures)]).collect()
    };
    let limits = known.plans.own.profile.as_ref().map(|profile| &profile.check);
    let most = |limit: Option<f64>| limit.map(|limit| (limit, known.t("plot-limit")));
    let label =
        curve(ui, known.t("plot-void"), [x, none], judged(|f| f.void_percent()), most(limits.map(|l| l.max_void)));
    words::explained(known, label, "void");
    let overfill = most(limits.map(|l| l.max_overfill));
    let label = curve(ui, known.t("plot-overfill"), [x, none], judged(|f| f.overfill_percent()), overfill);
    words::explained(known, label, "overfill");
    let planned = |value: &dyn Fn(usize) -> f64| -> Vec<[f64; 2]> {
        (0..known.plans.own.layers.len()).map(|i| [i as f64 + 1.0, value(i)]).collect()
    };
    let starts = planned(&|i| known.plans.own.layers[i].passes.len() as f64);
    curve(ui, known.worded("plot-starts"), [x, none], starts, None);
    let seconds = |i: usize| known.plans.own.scene.layer(i).map_or(0.0, |beads| beads.seconds());
    curve(ui, known.t("plot-time"), [x, none], planned(&seconds), None);
    ui.separator();
    beads(known, queue, ui);
    ui.separator();
    joints(known, view, queue, ui);
}

/// Width/height of a bead library over its inputs.
fn beads(known: Known<'_>, queue: &mut Queue, ui: &mut Ui) {
    if ui.button(known.t("open-beads")).clicked() {
        queue.push(Action::Ask(Ask::OpenBeads));
    }
    let Some(library) = &known.jobs.beads else { return };
    let found = bead_window::plot(library);
    ui.label(known.t("plot-lambda")).on_hover_text(&found.title);
    drawn(ui, "lambda", &found);
}

/// Draws a plot that the library makes for its pages.
fn drawn(ui: &mut Ui, id: &str, found: &page::Plot) {
    let plot = Plot::new(id).height(1.5 * HEIGHT).legend(Legend::default()).allow_scroll(false);
    plot.x_axis_label(&*found.x).y_axis_label(&*found.y).show(ui, |plot| {
        for curve in &found.curves {
            let points: PlotPoints<'_> = curve.points.iter().map(|p| [p.x, p.y]).collect();
            plot.line(Line::new(curve.name.clone(), points));
        }
        for (low, high, word) in &found.bands {
            plot.hline(HLine::new(word.clone(), *low).style(LineStyle::dashed_loose()));
            plot.hline(HLine::new(word.clone(), *high).style(LineStyle::dashed_loose()));
        }
    });
}

/// A curve under its title, which is returned; with a limit, and what it is called, as a dashed line.
fn curve(
    ui: &mut Ui,
    title: &'static str,
    [x, none]: [&'static str; 2],
    points: Vec<[f64; 2]>,
    limit: Option<(f64, &str)>,
) -> Response {
    let label = ui.label(limit.map_or_else(|| title.to_owned(), |(limit, name)| format!("{title}; {name} {limit} %")));
    if points.is_empty() {
        ui.weak(none);
        return label;
    }
    let step = points.len().div_ceil(POINTS).max(1);
    let points: PlotPoints<'_> = points.into_iter().step_by(step).collect();
    let axis = AxisHints::new_x().label(x).label_spacing(SPACING);
    Plot::new(title).height(HEIGHT).custom_x_axes(vec![axis]).include_y(0.0).allow_scroll(false).show(ui, |plot| {
        plot.line(Line::new(title, points));
        if let Some((limit, name)) = limit {
            plot.hline(HLine::new(name, limit).style(LineStyle::dashed_loose()));
        }
    });
    label
}

fn joints(known: Known<'_>, view: &View<'_>, queue: &mut Queue, ui: &mut Ui) {
    ui.horizontal(|ui| process::cell(known, view, queue, ui));
    robot::misfits(known, ui);
    let ready = known.plans.own.is_planned() && known.jobs.reach_job.is_none();
    if ui.add_enabled(ready, eframe::egui::Button::new(known.t("reach-run"))).clicked() {
        queue.push(Action::Reach);
    }
    if known.jobs.reach_job.is_some() {
        ui.spinner();
    }
    let Some(reach) = &known.jobs.reach else { return };
    match reach.least_margin() {
        Some(margin) => ui.label(format!("{}: {margin:.1}°", known.t("reach-margin"))),
        None => ui.label("–"),
    };
    for finding in &reach.findings {
        ui.colored_label(ui.visuals().warn_fg_color, finding.sentence());
    }
    suggestion(known, queue, ui);
    ui.label(known.t("plot-joints"));
    let plot = Plot::new("joints").height(2.0 * HEIGHT).legend(Legend::default()).x_axis_label(known.t("axis-time"));
    plot.allow_scroll(false).show(ui, |plot| {
        for joint in 0..6 {
            let angle = |_: &Stop, pose: Option<&Pose>| Some(pose?.joints[joint]);
            plot.line(Line::new(format!("J{}", joint + 1), PlotPoints::from(timed(reach, angle))));
        }
    });
    positioner(known, reach, ui);
}

/// Looks for a place of the part that the cell reaches better, and says where it is.
fn suggestion(known: Known<'_>, queue: &mut Queue, ui: &mut Ui) {
    let ready = known.jobs.suggest_job.is_none() && known.jobs.cell.is_some();
    let button = ui.add_enabled(ready, eframe::egui::Button::new(known.t("suggest")));
    if button.on_hover_text(known.t("suggest-hint")).clicked() {
        queue.push(Action::Suggest);
    }
    if known.jobs.suggest_job.is_some() {
        ui.spinner();
    }
    match &known.jobs.suggested {
        Some(Some(Suggestion { place, margin, now, .. })) => {
            let [x, y, z] = place.position;
            let now = now.map_or(String::new(), |now| format!(" ({} {now:.1}°)", known.t("suggest-now")));
            let text = known.t("suggest-place");
            let turn = place.rotation;
            ui.label(format!("{text} x {x:.0} y {y:.0} z {z:.0} mm, {turn:.0}°: {margin:.1}°{now}"));
        }
        Some(None) => drop(ui.colored_label(ui.visuals().warn_fg_color, known.t("suggest-none"))),
        None => {}
    }
}

/// The angles of the positioner's axes, with their limits.
fn positioner(known: Known<'_>, reach: &Reach, ui: &mut Ui) {
    if known.axes().is_empty() {
        return;
    }
    ui.label(known.t("plot-positioner"));
    for (number, axis) in known.axes().iter().enumerate() {
        ui.weak(format!("{}: {}", robot::axis_name(known, number), robot::limits(axis)));
    }
    let time = AxisHints::new_x().label(known.t("axis-time")).label_spacing(SPACING);
    let plot = Plot::new("positioner").height(1.5 * HEIGHT).legend(Legend::default()).custom_x_axes(vec![time]);
    let plot = plot.custom_y_axes(vec![AxisHints::new_y().label_spacing(SPACING)]);
    plot.allow_scroll(false).show(ui, |plot| {
        for (number, (axis, colour)) in known.axes().iter().zip(&CURVES[1..]).enumerate() {
            let colour = ink(*colour);
            let points = timed(reach, |stop, _| Some(stop.attitude.held?.angles[number]));
            let name = robot::axis_name(known, number);
            for limit in near_limits(axis, &points) {
                plot.hline(HLine::new(name.clone(), limit).color(colour).style(LineStyle::dashed_loose()));
            }
            plot.line(Line::new(name, PlotPoints::from(points)).color(colour));
        }
    });
}

/// The limits that can be drawn without flattening the curve.
fn near_limits(axis: &PositionerAxis, points: &[[f64; 2]]) -> Vec<f64> {
    let angles = points.iter().map(|point| point[1]);
    let (least, most) = angles.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), angle| (a.min(angle), b.max(angle)));
    let room = (most - least).max(HALF_TURN);
    axis.limits.into_iter().filter(|limit| (least - room..=most + room).contains(limit)).collect()
}

/// A value over the time of the track.
fn timed(reach: &Reach, value: impl Fn(&Stop, Option<&Pose>) -> Option<f64>) -> Vec<[f64; 2]> {
    let step = reach.poses.len().div_ceil(POINTS).max(1);
    let mut seconds = 0.0;
    let points = reach.poses.iter().filter_map(|(stop, pose)| {
        seconds += stop.seconds;
        Some([seconds, value(stop, pose.as_ref())?])
    });
    points.step_by(step).collect()
}
