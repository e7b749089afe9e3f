//! A remedy can be tried: what it changes, the plan before and after, keep it or go back.

use super::parameters::unit;
use crate::actions::Action;
use crate::form;
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
    let parsed = known.parsed();
    let limit = parsed.as_deref().and_then(|parsed| form::limit(&parsed.limits, change.key));
    let text = format!("{} {from} → {} {}", known.step(change.key), plain(&change.value), limit.map_or("", unit));
    text.trim_end().to_owned()
}

/// The change that is tried, with what it does to the plan.
pub(super) fn show(known: Known<'_>, queue: &mut Queue, ui: &mut Ui) {
    let Some(Trial { change, from, before, .. }) = known.trial() else { return };
    ui.group(|ui| {
        ui.strong(format!("{}: {}", known.t("tried"), sentence(known, change, from.as_deref())));
        match trial::figures(&known.plans.own) {
            Some(after) => differences(known, ui, before, &after),
            None if known.plans.own.is_busy() => drop(ui.weak(known.t("tried-waits"))),
            None => drop(ui.weak(known.t("not-complete"))),
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

/// The figures that differ, those that only one of the plans has included.
fn differences(known: Known<'_>, ui: &mut Ui, before: &Rows, after: &Rows) {
    Grid::new("trial").num_columns(3).striped(true).show(ui, |ui| {
        ui.label("");
        ["before", "after"].into_iter().for_each(|key| drop(ui.strong(known.t(key))));
        ui.end_row();
        let gone = before.iter().filter(|(name, _)| !after.iter().any(|(other, _)| other == name));
        for (name, _) in after.iter().chain(gone) {
            let [was, is] = [before, after].map(|rows| value(rows, name));
            if was != is {
                super::totals::named(known, ui, name);
                ui.label(was);
                ui.label(is);
                ui.end_row();
            }
        }
    });
}

/// The value of this name, or a dash.
fn value<'a>(rows: &'a Rows, name: &str) -> &'a str {
    rows.iter().find(|(other, _)| *other == name).map_or("–", |(_, value)| value)
}
