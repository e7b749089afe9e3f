//! Messages on what went wrong or was done; they stay until they are closed.

use super::findings::whole;
use crate::actions::Action;
use crate::known::{Known, Queue};
use crate::planner::Failure;
use crate::theme;
use beadwright::Finding;
use beadwright::check;
use beadwright::finding::Severity;
use eframe::egui::style::ScrollStyle;
use eframe::egui::{RichText, ScrollArea, Ui};

/// Height of the messages, points: three lines; longer lists scroll.
pub(super) const HEIGHT: f32 = 70.0;

/// Whether there is anything to say.
pub(super) fn any(known: Known<'_>) -> bool {
    let failed = matches!(known.plans.own.failure, Some(Failure::Sentence(_)));
    failed || !known.window.messages.is_empty() || !warnings(known).is_empty()
}

pub(super) fn show(known: Known<'_>, queue: &mut Queue, ui: &mut Ui) {
    let failure = match &known.plans.own.failure {
        Some(Failure::Sentence(text)) => Some(text.clone()),
        _ => None,
    };
    let (warnings, close) = (warnings(known), known.t("close"));
    let nothing = (!any(known)).then(|| known.t("no-messages"));
    // A bar that is always there shows that there is more below.
    ui.spacing_mut().scroll = ScrollStyle::solid();
    // A list that claims more than the panel has would let the panel above cover its beginning.
    ScrollArea::vertical().min_scrolled_height(0.0).auto_shrink(false).show(ui, |ui| {
        if let Some(text) = nothing {
            ui.weak(text);
        }
        if let Some(text) = failure {
            line(ui, &text, true, || queue.push(Action::DismissFailure), close);
        }
        for (i, message) in known.window.messages.iter().enumerate().rev() {
            line(ui, &message.text, message.error, || queue.push(Action::Dismiss(i)), close);
        }
        for finding in warnings {
            let text = RichText::new(format!("• {}", whole(known, finding)));
            let error = ui.visuals().error_fg_color;
            ui.label(if finding.severity == Severity::Serious { text.color(error) } else { text.weak() });
        }
    });
}

fn line(ui: &mut Ui, text: &str, error: bool, close: impl FnOnce(), hint: &str) {
    ui.horizontal_wrapped(|ui| {
        if ui.small_button("×").on_hover_text(hint).clicked() {
            close();
        }
        let visuals = ui.visuals();
        let colour = if error { visuals.error_fg_color } else { theme::good(visuals.dark_mode) };
        ui.colored_label(colour, text);
    });
}

/// What was repaired in the model, what the plan left out, and why it should not be welded; not what the checks found.
fn warnings(known: Known<'_>) -> Vec<&Finding> {
    known.plans.own.reported.iter().filter(|finding| check::by_name(finding.kind).is_none()).collect()
}
