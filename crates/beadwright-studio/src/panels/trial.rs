//! A remedy can be tried: what it changes, the plan before and after, keep it or go back.

use crate::actions::Action;
use crate::known::{Known, Queue};
use crate::remedy::{self, Change};
use crate::state::Rows;
use crate::trial::{self, Trial};
use beadwright::Finding;
use eframe::egui::{Button, Grid, Ui};

/// Offers the change that usually helps against a finding.
pub(super) fn offer(known: Known<'_>, queue: &mut Queue, ui: &mut Ui, finding: &Finding) {
    let own = &known.plans.own;
    let Some(change) = own.profile.as_ref().and_then(|profile| remedy::change(finding, profile)) else { return };
    let text = format!("{}: {}", known.t("try"), sentence(known, &change, known.value_now(change.key).as_deref()));
    let ready = own.is_complete() && own.is_of_last_request();
    if ui.add_enabled(ready, Button::new(text)).on_hover_text(known.t("try-hint")).clicked() {
        queue.push(Action::Try(change));
    }
}

/// A change in words: its name, the value now, and the one that replaces it.
fn sentence(known: Known<'_>, change: &Change, from: Option<&str>) -> String {
    let plain = |text: &str| text.trim_matches('"').to_owned();
    let from = from.map_or_else(|| known.t("default").to_owned(), plain);
    format!("{} {from} → {}", known.step(change.key), plain(&change.value))
}

/// The change that is tried, with what it does to the plan.
pub(super) fn show(known: Known<'_>, queue: &mut Queue, ui: &mut Ui) {
    let Some(Trial { change, from, before, .. }) = known.trial() else { return };
    ui.group(|ui| {
        ui.strong(format!("{}: {}", known.t("tried"), sentence(known, change, from.as_deref())));
        match trial::figures(&known.plans.own) {
            Some(after) => differences(known, ui, before, &after),
            None => drop(ui.weak(known.t("tried-waits"))),
        }
        ui.horizontal(|ui| {
            for (text, keeps) in [("keep", true), ("take-back", false)] {
                if ui.button(known.t(text)).clicked() {
                    queue.push(Action::EndTrial(keeps));
                }
            }
        });
    });
}

/// The figures that differ.
fn differences(known: Known<'_>, ui: &mut Ui, before: &Rows, after: &Rows) {
    Grid::new("trial").num_columns(3).striped(true).show(ui, |ui| {
        ui.label("");
        ["before", "after"].into_iter().for_each(|key| drop(ui.strong(known.t(key))));
        ui.end_row();
        for ((name, was), (_, is)) in before.iter().zip(after).filter(|(was, is)| was != is) {
            super::totals::named(known, ui, name);
            ui.label(was);
            ui.label(is);
            ui.end_row();
        }
    });
}
