//! What the checks found; a click shows the place.

use super::{trial, words};
use crate::chinese::{self, Chinese};
use crate::known::{Known, Queue, View};
use crate::text::Language;
use crate::view::{Mode, Pin};
use beadwright::Finding;
use beadwright::check::{self, Check};
use beadwright::finding::{Severity, lacks_metal_below};
use eframe::egui::{CollapsingHeader, Color32, Response, RichText, Ui};

/// Checks about what the deposit model computes.
const FIGURES: [&str; 4] = ["void", "overfill", "outside", "towers"];

/// The height of the picture of a place, bead widths; twice as much in 3-D.
const ROOM: f64 = 12.0;

/// Maximum number of findings listed for one check.
const LISTED: usize = 100;

pub(super) fn show(known: Known<'_>, view: &mut View<'_>, queue: &mut Queue, ui: &mut Ui) {
    trial::show(known, queue, ui);
    let own = &known.plans.own;
    match &own.findings {
        None => drop(ui.weak(known.t("findings-wait"))),
        Some(_) if own.reported.is_empty() => drop(ui.label(known.t("no-findings"))),
        Some(_) => {}
    }
    let findings = own.findings.as_deref().unwrap_or_default();
    for finding in &own.reported {
        let visuals = ui.visuals();
        let colour = match finding.severity {
            Severity::Serious => visuals.error_fg_color,
            Severity::Doubt => visuals.warn_fg_color,
            Severity::Note => visuals.weak_text_color(),
        };
        match check::by_name(finding.kind) {
            Some(check) => checked(known, view, queue, ui, check, findings, colour),
            None => {
                let count = if finding.count > 1 { format!("{}, ", finding.count) } else { String::new() };
                let title = format!("{} ({count}{})", name(known, finding.kind), known.t(word(finding.severity)));
                ui.colored_label(colour, title);
                one(known, view, ui, finding);
                if let Some(chinese) = in_chinese(known, finding.kind) {
                    ui.weak(format!("{}：{}。", known.t("remedy"), chinese.remedy));
                }
            }
        }
    }
}

/// The key of the word for how much a finding matters.
fn word(severity: Severity) -> &'static str {
    if severity == Severity::Serious { "serious" } else { "remark" }
}

/// A kind of findings in Chinese, where that is the language of the window.
fn in_chinese(known: Known<'_>, kind: &str) -> Option<&'static Chinese> {
    chinese::of(kind).filter(|_| known.language() == Language::Chinese)
}

/// The name of a kind in the language of the window.
fn name(known: Known<'_>, kind: &'static str) -> &'static str {
    in_chinese(known, kind).map_or(kind, |chinese| &chinese.name)
}

/// What a finding says in the language of the window; in English where the table of the other lacks it.
pub(super) fn said(known: Known<'_>, finding: &Finding) -> String {
    let chinese = in_chinese(known, finding.kind).and_then(|chinese| chinese.say(&finding.text));
    chinese.unwrap_or_else(|| sentence(&finding.text))
}

/// The same, with what to do.
pub(super) fn whole(known: Known<'_>, finding: &Finding) -> String {
    match in_chinese(known, finding.kind) {
        Some(chinese) => format!("{}{}。", said(known, finding), chinese.remedy),
        None => sentence(&finding.sentence()),
    }
}

/// All that one check found.
fn checked(
    known: Known<'_>,
    view: &mut View<'_>,
    queue: &mut Queue,
    ui: &mut Ui,
    check: &Check,
    findings: &[Finding],
    colour: Color32,
) {
    let found: Vec<&Finding> = findings.iter().filter(|finding| finding.kind == check.name).collect();
    let title = format!(
        "{} ({}, {})",
        name(known, check.name),
        found.len(),
        known.t(word(found.iter().map(|f| f.severity).min().unwrap_or(check.severity())))
    );
    let title = CollapsingHeader::new(RichText::new(title).color(colour)).id_salt(check.name);
    let opened = title.default_open(true).show(ui, |ui| {
        match in_chinese(known, check.name) {
            Some(chinese) => {
                for (key, text) in [("why", &chinese.why), ("remedy", &chinese.remedy)] {
                    ui.weak(format!("{}：{text}。", known.t(key)));
                }
            }
            None => {
                for (key, text) in [("why", check.why), ("remedy", check.remedy)] {
                    explained(known, ui.weak(format!("{}: {text}.", known.t(key))), check.name, text);
                }
            }
        }
        if let Some(first) = found.first() {
            trial::offer(known, queue, ui, first);
        }
        let groups = grouped(&found);
        for group in groups.iter().take(LISTED) {
            listed(known, view, ui, group);
        }
        if groups.len() > LISTED {
            ui.weak(format!("… {}", groups.len() - LISTED));
        }
    });
    explained(known, opened.header_response, check.name, check.name);
}

/// One finding, or many that say the same: the first of them, and the others on request.
fn listed(known: Known<'_>, view: &mut View<'_>, ui: &mut Ui, group: &[&Finding]) {
    let [first, rest @ ..] = group else { return };
    one(known, view, ui, first);
    if let Some(last) = rest.last() {
        let title = format!("{} {}{}", group.len(), known.t("alike"), layers(known, first, last));
        CollapsingHeader::new(title).id_salt((first.kind, first.layer, first.pass, &first.text)).show(ui, |ui| {
            rest.iter().take(LISTED).for_each(|finding| one(known, view, ui, finding));
        });
    }
}

fn one(known: Known<'_>, view: &mut View<'_>, ui: &mut Ui, finding: &Finding) {
    let text = said(known, finding);
    if finding.layer.is_none() {
        explained(known, ui.label(&text), finding.kind, &text);
        return;
    }
    let pinned = view.state.pin.as_ref().is_some_and(|pin| pin.text == finding.text);
    let words = if pinned { RichText::new(&text).strong() } else { RichText::new(&text) };
    let link = ui.link(words).on_hover_text(known.t("go-there"));
    if explained(known, link, finding.kind, &text).clicked() {
        go_to(known, view, finding);
    }
}

/// Explains the words of a text, if its check is about the figures of the deposit model: elsewhere they are plain
/// English.
fn explained(known: Known<'_>, response: Response, check: &str, text: &str) -> Response {
    if FIGURES.contains(&check) { words::explained(known, response, text) } else { response }
}

/// Consecutive findings that differ only in their numbers.
fn grouped<'a, 'b>(findings: &'b [&'a Finding]) -> Vec<&'b [&'a Finding]> {
    let words = |finding: &Finding| finding.text.replace(|c: char| c.is_ascii_digit() || ".-".contains(c), "");
    findings.chunk_by(|a, b| a.layer.is_some() == b.layer.is_some() && words(a) == words(b)).collect()
}

/// The layers from one finding to another, counted from 1, in brackets.
fn layers(known: Known<'_>, first: &Finding, last: &Finding) -> String {
    match (first.layer, last.layer) {
        (Some(a), Some(b)) if a != b => format!(" ({} {}–{})", known.t("total layers"), a + 1, b + 1),
        (Some(a), _) => format!(" ({} {})", known.t("layer"), a + 1),
        _ => String::new(),
    }
}

/// A sentence, starting with a capital letter.
fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// Shows the place of a finding, framed, with its bead chosen, and marks it until another one is shown.
fn go_to(known: Known<'_>, view: &mut View<'_>, finding: &Finding) {
    let Some(layer) = finding.layer else { return };
    view.state.look_at(layer);
    view.state.chosen = finding.pass.map(|pass| (layer, pass, 0));
    view.state.pin = pin(known, finding, layer);
    let deep = view.state.pin.is_some() && known.window.render_state.is_some() && is_between_layers(finding.kind);
    view.state.mode = if deep { Mode::Solid } else { Mode::Layer };
    if FIGURES.contains(&finding.kind) {
        view.state.show.heights = true;
    }
    let bead = known.plans.own.profile.as_ref().map_or(1.0, |profile| profile.bead.width);
    match &view.state.pin {
        Some(pin) => {
            view.flat.frame(pin.on_layer, ROOM * bead);
            view.solid.frame(pin.at, 2.0 * ROOM * bead);
        }
        None => view.flat.fit(),
    }
}

/// Whether what is wrong is seen from the side rather than on a layer.
fn is_between_layers(kind: &str) -> bool {
    lacks_metal_below(kind) || ["towers", "built-height"].contains(&kind)
}

/// Where a finding is: its own place, or the start of its pass.
fn pin(known: Known<'_>, finding: &Finding, layer: usize) -> Option<Pin> {
    let plan = &known.plans.own;
    let own = plan.layer(layer)?;
    let place = finding.place.or_else(|| own.passes.get(finding.pass?)?.start())?;
    let sheet = plan.profile.as_ref().and_then(|profile| profile.layers.sheet(own));
    let at = sheet.map_or(place, |sheet| sheet.at(place).place);
    Some(Pin { layer, on_layer: place.truncate(), at, text: finding.text.clone() })
}
