//! The clock of the whole program: where the torch is in it, what is left, and what the time is spent on.

use super::layers::slider;
use crate::known::{Known, View};
use crate::shares::Shares;
use eframe::egui::{Slider, Ui};

pub(super) fn show(known: Known<'_>, view: &mut View<'_>, ui: &mut Ui) {
    let scene = &known.plans.own.scene;
    let (total, mut now) = (scene.total_seconds(), view.state.now(scene));
    ui.horizontal(|ui| {
        let time = Slider::new(&mut now, 0.0..=total).custom_formatter(|s, _| clock(s)).custom_parser(seconds);
        if slider(ui, known.t("clock"), 2, time) {
            view.state.go_to(now, scene);
        }
        // What is done and what is left add up as they are shown.
        let left = total.round() - now.round();
        ui.label(format!("/ {}, {} {}", clock(total), known.t("clock-left"), clock(left)));
        if let Some(summary) = &known.plans.own.summary {
            ui.separator();
            shares(known, ui, &Shares::of(scene, &summary.metrics));
        }
    });
}

/// What the time is spent on, %.
fn shares(known: Known<'_>, ui: &mut Ui, shares: &Shares) {
    let percent = |seconds: f64| format!("{:.0} %", 100.0 * seconds / shares.total.max(f64::MIN_POSITIVE));
    let arc: f64 = shares.arc.iter().map(|(_, seconds)| seconds).sum();
    let parts = [
        ("share-arc", arc),
        ("share-starts", shares.starts),
        ("share-travel", shares.travel),
        ("share-wait", shares.wait),
    ];
    let kinds = shares.arc.iter().map(|(kind, seconds)| (known.language().word("kind", kind.name()), *seconds));
    let texts = parts.map(|(key, seconds)| format!("{} {}", known.worded(key), percent(seconds)));
    let hint = kinds.map(|(kind, seconds)| format!("{kind} {}, {}", percent(seconds), clock(seconds)));
    ui.label(texts.join(" · ")).on_hover_text(hint.collect::<Vec<_>>().join("\n"));
}

/// A time as hours, minutes and seconds.
pub(super) fn clock(seconds: f64) -> String {
    let whole = seconds.max(0.0).round() as u64;
    format!("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60)
}

/// The seconds of a time such as 1:02:03, 2:03 or 3.
fn seconds(text: &str) -> Option<f64> {
    text.split(':').try_fold(0.0, |sum, part| Some(60.0 * sum + part.trim().parse::<f64>().ok()?))
}
