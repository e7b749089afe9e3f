//! What the checks found; a click goes there.

use crate::studio::Studio;
use crate::view::Mode;
use beadwright::check::{CHECKS, Finding};
use eframe::egui::{CollapsingHeader, Ui};

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
        let title = format!("{} ({})", check.name, found.len());
        CollapsingHeader::new(title).id_salt(check.name).default_open(true).show(ui, |ui| {
            ui.weak(format!("{}: {}.", studio.t("why"), check.why));
            ui.weak(format!("{}: {}.", studio.t("remedy"), check.remedy));
            for finding in found.iter().take(LISTED) {
                let text = sentence(finding);
                if finding.layer.is_none() {
                    ui.label(text);
                } else if ui.link(text).on_hover_text(studio.t("go-there")).clicked() {
                    go_to(studio, finding);
                }
            }
            if found.len() > LISTED {
                ui.weak(format!("… {}", found.len() - LISTED));
            }
        });
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
    let heights = ["void", "overfill", "outside", "towers"];
    if heights.contains(&finding.check) {
        studio.view.show.heights = true;
    }
    if let Some(place) = finding.place {
        studio.flat.look_at(place.truncate());
    }
}
