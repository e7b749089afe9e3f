//! Messages on what went wrong or was done; they stay until they are closed.

use crate::actions::Action;
use crate::planner::Failure;
use crate::studio::Studio;
use crate::theme;
use eframe::egui::style::ScrollStyle;
use eframe::egui::{RichText, ScrollArea, Ui};

/// Height of the messages, points: three lines; longer lists scroll.
pub(super) const HEIGHT: f32 = 70.0;

/// Whether there is anything to say.
pub(super) fn any(studio: &Studio) -> bool {
    let failed = matches!(studio.plans.own.failure, Some(Failure::Sentence(_)));
    failed || !studio.window.messages.is_empty() || !warnings(studio).is_empty()
}

pub(super) fn show(studio: &mut Studio, ui: &mut Ui) {
    let failure = match &studio.plans.own.failure {
        Some(Failure::Sentence(text)) => Some(text.clone()),
        _ => None,
    };
    let (warnings, close) = (warnings(studio), studio.t("close"));
    let nothing = (!any(studio)).then(|| studio.t("no-messages"));
    // A bar that is always there shows that there is more below.
    ui.spacing_mut().scroll = ScrollStyle::solid();
    // A list that claims more than the panel has would let the panel above cover its beginning.
    ScrollArea::vertical().min_scrolled_height(0.0).auto_shrink(false).show(ui, |ui| {
        if let Some(text) = nothing {
            ui.weak(text);
        }
        if let Some(text) = failure {
            line(ui, &text, true, || studio.plans.own.failure = None, close);
        }
        let mut closed = None;
        for (i, message) in studio.window.messages.iter().enumerate().rev() {
            line(ui, &message.text, message.error, || closed = Some(i), close);
        }
        closed.into_iter().for_each(|i| {
            studio.request(Action::Dismiss(i));
        });
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
fn warnings(studio: &Studio) -> Vec<String> {
    let part = studio.plans.own.part.iter().flat_map(|part| part.repair().sentences());
    let plan = studio.plans.own.summary.iter().flat_map(|summary| {
        let events = summary.warnings.summaries().map(|warning| warning.sentence());
        events.chain(summary.notes.iter().cloned()).collect::<Vec<_>>()
    });
    part.chain(plan).collect()
}
