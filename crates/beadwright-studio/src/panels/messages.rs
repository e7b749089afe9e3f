//! Messages on what went wrong or was done; they stay until they are closed.

use crate::actions::Action;
use crate::known::{Known, Queue};
use crate::planner::Failure;
use crate::theme;
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
        for text in warnings {
            ui.label(RichText::new(format!("• {text}")).weak());
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

/// What was repaired in the model, and what the plan left out.
fn warnings(known: Known<'_>) -> Vec<String> {
    let part = known.plans.own.part.iter().flat_map(|part| part.repair().sentences());
    let plan = known.plans.own.summary.iter().flat_map(|summary| {
        let events = summary.warnings.summaries().map(|warning| warning.sentence());
        events.chain(summary.notes.iter().cloned()).collect::<Vec<_>>()
    });
    part.chain(plan).collect()
}
