//! Plots: figures for every layer, measured beads, the robot's joints.

use super::{process, words};
use crate::actions::Action;
use crate::jobs::Ask;
use crate::known::{Known, Queue, View};
use beadwright::report::{bead_window, plot as page};
use beadwright::robot::Reach;
use eframe::egui::{Rangef, Response, Ui};
use egui_plot::{AxisHints, HLine, Legend, Line, LineStyle, Plot, PlotPoints};

/// Most points drawn for a curve.
const POINTS: usize = 2000;

/// Spacing of the numbers on an axis in screen points, from barely visible to clear; the plots are small here.
const SPACING: Rangef = Rangef { min: 25.0, max: 40.0 };

/// Height of a plot, points.
const HEIGHT: f32 = 140.0;

pub(super) fn show(known: Known<'_>, view: &View<'_>, queue: &mut Queue, ui: &mut Ui) {
    let (x, none) = (known.t("axis-layer"), known.t("no-values"));
    let judged = |value: fn(&beadwright::deposit::Figures) -> f64| -> Vec<[f64; 2]> {
        let figures = known.plans.own.judgements.iter().enumerate();
        figures.map(|(i, judgement)| [i as f64 + 1.0, value(&judgement.figures)]).collect()
    };
    let label = curve(ui, known.t("plot-void"), x, none, judged(|f| f.void_percent()));
    words::explained(known, label, "void");
    let label = curve(ui, known.t("plot-overfill"), x, none, judged(|f| f.overfill_percent()));
    words::explained(known, label, "overfill");
    let planned = |value: &dyn Fn(usize) -> f64| -> Vec<[f64; 2]> {
        (0..known.plans.own.layers.len()).map(|i| [i as f64 + 1.0, value(i)]).collect()
    };
    curve(ui, known.worded("plot-starts"), x, none, planned(&|i| known.plans.own.layers[i].passes.len() as f64));
    let seconds = |i: usize| known.plans.own.scene.layer(i).map_or(0.0, |beads| beads.seconds());
    curve(ui, known.t("plot-time"), x, none, planned(&seconds));
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

/// A curve under its title, which is returned.
fn curve(ui: &mut Ui, title: &'static str, x: &'static str, none: &'static str, points: Vec<[f64; 2]>) -> Response {
    let label = ui.label(title);
    if points.is_empty() {
        ui.weak(none);
        return label;
    }
    let step = points.len().div_ceil(POINTS).max(1);
    let points: PlotPoints<'_> = points.into_iter().step_by(step).collect();
    let axis = AxisHints::new_x().label(x).label_spacing(SPACING);
    Plot::new(title).height(HEIGHT).custom_x_axes(vec![axis]).include_y(0.0).allow_scroll(false).show(ui, |plot| {
        plot.line(Line::new(title, points));
    });
    label
}

fn joints(known: Known<'_>, view: &View<'_>, queue: &mut Queue, ui: &mut Ui) {
    ui.horizontal(|ui| process::cell(known, view, queue, ui));
    let ready = known.plans.own.summary.is_some() && known.jobs.reach_job.is_none();
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
    ui.label(known.t("plot-joints"));
    let plot = Plot::new("joints").height(2.0 * HEIGHT).legend(Legend::default()).x_axis_label(known.t("axis-time"));
    plot.allow_scroll(false).show(ui, |plot| {
        for joint in 0..6 {
            plot.line(Line::new(format!("J{}", joint + 1), joint_curve(reach, joint)));
        }
    });
}

fn joint_curve(reach: &Reach, joint: usize) -> PlotPoints<'static> {
    let step = reach.poses.len().div_ceil(POINTS).max(1);
    let mut seconds = 0.0;
    let timed = reach.poses.iter().map(|(stop, pose)| {
        seconds += stop.seconds;
        (seconds, pose)
    });
    let points = timed.filter_map(|(seconds, pose)| Some([seconds, pose.as_ref()?.joints[joint]]));
    points.step_by(step).collect::<Vec<_>>().into()
}
