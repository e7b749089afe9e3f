//! What the checks found; a click goes there.

use super::words;
use crate::studio::Studio;
use crate::view::Mode;
use beadwright::check::{CHECKS, Finding};
use eframe::egui::{CollapsingHeader, Response, RichText, Ui};

/// Checks whose findings are about metal in the wrong place, a torch that is dragged over it, or a program that stops.
const SERIOUS: [&str; 8] = ["points", "layers", "air", "crossing", "retraced", "clearance", "low-travel", "towers"];

/// Checks about what the deposit model computes.
const FIGURES: [&str; 4] = ["void", "overfill", "outside", "towers"];

/// Most findings listed for one check.
const LISTED: usize = 100;

pub(super) fn show(studio: &mut Studio, ui: &mut Ui) {
    let Some(findings) = studio.plans.own.findings.clone() else {
        ui.weak(studio.t("findings-wait"));
        return;
    };
    if findings.is_empty() {
        ui.label(studio.t("no-findings"));
    }
    for check in &CHECKS {
        let found: Vec<&Finding> = findings.iter().filter(|finding| finding.check == check.name).collect();
        if found.is_empty() {
            continue;
        }
        let serious = SERIOUS.contains(&check.name);
        let word = studio.t(if serious { "serious" } else { "remark" });
        let colour = if serious { ui.visuals().error_fg_color } else { ui.visuals().warn_fg_color };
        let title = format!("{} ({}, {word})", check.name, found.len());
        let title = CollapsingHeader::new(RichText::new(title).color(colour)).id_salt(check.name);
        let opened = title.default_open(true).show(ui, |ui| {
            for (key, text) in [("why", check.why), ("remedy", check.remedy)] {
                explained(studio, ui.weak(format!("{}: {text}.", studio.t(key))), check.name, text);
            }
            let groups = grouped(&found);
            for group in groups.iter().take(LISTED) {
                listed(studio, ui, group);
            }
            if groups.len() > LISTED {
                ui.weak(format!("… {}", groups.len() - LISTED));
            }
        });
        explained(studio, opened.header_response, check.name, check.name);
    }
}

/// One finding, or many that say the same: the first of them, and the others on request.
fn listed(studio: &mut Studio, ui: &mut Ui, group: &[&Finding]) {
    let [first, rest @ ..] = group else { return };
    one(studio, ui, first);
    if let Some(last) = rest.last() {
        let title = format!("{} {}{}", group.len(), studio.t("alike"), layers(studio, first, last));
        CollapsingHeader::new(title).id_salt((first.check, first.layer, first.pass, &first.text)).show(ui, |ui| {
            rest.iter().take(LISTED).for_each(|finding| one(studio, ui, finding));
        });
    }
}

fn one(studio: &mut Studio, ui: &mut Ui, finding: &Finding) {
    let text = sentence(finding);
    if finding.layer.is_none() {
        explained(studio, ui.label(&text), finding.check, &text);
        return;
    }
    let link = ui.link(&text).on_hover_text(studio.t("go-there"));
    if explained(studio, link, finding.check, &text).clicked() {
        go_to(studio, finding);
    }
}

/// The words of a text explained, where its check is about the figures of the deposit: elsewhere they are plain English.
fn explained(studio: &Studio, response: Response, check: &str, text: &str) -> Response {
    if FIGURES.contains(&check) { words::explained(studio, response, text) } else { response }
}

/// Findings that follow each other and differ in their numbers only.
fn grouped<'a, 'b>(findings: &'b [&'a Finding]) -> Vec<&'b [&'a Finding]> {
    let words = |finding: &Finding| finding.text.replace(|c: char| c.is_ascii_digit() || c == '.', "");
    findings.chunk_by(|a, b| a.layer.is_some() == b.layer.is_some() && words(a) == words(b)).collect()
}

/// The layers from one finding to another, counted from 1, in brackets.
fn layers(studio: &Studio, first: &Finding, last: &Finding) -> String {
    match (first.layer, last.layer) {
        (Some(a), Some(b)) if a != b => format!(" ({} {}–{})", studio.t("total layers"), a + 1, b + 1),
        (Some(a), _) => format!(" ({} {})", studio.t("layer"), a + 1),
        _ => String::new(),
    }
}

/// The finding as a sentence, starting with a capital letter.
fn sentence(finding: &Finding) -> String {
    let text = finding.sentence();
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// Shows the place of a finding: its layer, with the bead chosen.
fn go_to(studio: &mut Studio, finding: &Finding) {
    let Some(layer) = finding.layer else { return };
    studio.view.look_at(layer);
    studio.view.mode = Mode::Layer;
    studio.view.chosen = finding.pass.map(|pass| (layer, pass, 0));
    if FIGURES.contains(&finding.check) {
        studio.view.show.heights = true;
    }
    if let Some(place) = finding.place {
        studio.flat.look_at(place.truncate());
    }
}
