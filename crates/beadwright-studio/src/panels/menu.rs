//! Menus, and the bar below them: strategy, views, progress.

use crate::actions::{self, Action};
use crate::jobs::Ask;
use crate::studio::Studio;
use crate::text::Language;
use crate::theme;
use crate::view::{Mode, Side};
use beadwright::example;
use beadwright::fill::StrategyName;
use beadwright::task::Stage;
use eframe::egui::{Button, ComboBox, MenuBar, ProgressBar, Ui};

pub(super) fn show(studio: &mut Studio, ui: &mut Ui) {
    MenuBar::new().ui(ui, |ui| {
        ui.menu_button(studio.t("file"), |ui| {
            items(studio, ui, &[Action::Open]);
            ui.menu_button(studio.t("recent"), |ui| recent(studio, ui));
            scan(studio, ui);
            ui.separator();
            items(studio, ui, &[Action::Save, Action::SaveAs, Action::ExportProgram]);
            // A page is closed by its browser.
            if !cfg!(target_arch = "wasm32") {
                ui.separator();
                items(studio, ui, &[Action::Quit]);
            }
        });
        ui.menu_button(studio.t("edit"), |ui| {
            items(studio, ui, &[Action::Undo, Action::Redo, Action::PlaceTool, Action::Plan, Action::Stop]);
        });
        ui.menu_button(studio.t("view"), |ui| {
            items(studio, ui, &[Action::Solid, Action::Layer, Action::Compare]);
            ui.separator();
            items(studio, ui, &[Action::Fit, Action::Top, Action::Front, Action::Right, Action::Corner]);
            ui.separator();
            items(studio, ui, &[Action::Up, Action::Down, Action::Play]);
            ui.separator();
            items(studio, ui, &[Action::Theme]);
            ui.menu_button(studio.t("language"), |ui| languages(studio, ui));
        });
        ui.menu_button(studio.t("examples"), |ui| examples(studio, ui));
        ui.menu_button(studio.t("help"), |ui| items(studio, ui, &[Action::Keys]));
    });
    if studio.project().source.is_some() {
        ui.horizontal(|ui| bar(studio, ui));
    }
}

fn items(studio: &mut Studio, ui: &mut Ui, wanted: &[Action]) {
    for entry in wanted.iter().filter_map(actions::find) {
        let enabled = match entry.action {
            Action::Undo => studio.open.project.can_undo(),
            Action::Redo => studio.open.project.can_redo(),
            Action::ExportProgram | Action::Play => studio.plans.own.summary.is_some(),
            Action::Save | Action::SaveAs | Action::Plan | Action::PlaceTool => studio.project().source.is_some(),
            Action::Stop => studio.plans.own.is_busy(),
            _ => true,
        };
        let key = entry.key.map(|key| ui.ctx().format_shortcut(&key)).unwrap_or_default();
        if ui.add_enabled(enabled, Button::new(studio.t(entry.text)).shortcut_text(key)).clicked() {
            studio.request(entry.action.clone());
            ui.close();
        }
    }
}

/// A scan can be opened once there is a part to compare it with.
fn scan(studio: &mut Studio, ui: &mut Ui) {
    let solid = studio.plans.own.part.as_ref().is_some_and(|part| part.mesh().is_some());
    let entry = ui.add_enabled(solid, Button::new(studio.t("open-scan"))).on_hover_text(studio.t("scan-hint"));
    if entry.on_disabled_hover_text(studio.t("scan-needs-part")).clicked() {
        studio.request(Action::Ask(Ask::OpenScan));
        ui.close();
    }
}

fn recent(studio: &mut Studio, ui: &mut Ui) {
    if studio.window.settings.recent.is_empty() {
        ui.weak(studio.t("no-recent"));
    }
    for path in studio.window.settings.recent.clone() {
        let name = path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
        if ui.button(name).on_hover_text(path.display().to_string()).clicked() {
            studio.request(Action::OpenFile(path));
            ui.close();
        }
    }
}

fn examples(studio: &mut Studio, ui: &mut Ui) {
    for example in example::ALL {
        if ui.button(example.name).on_hover_text(example.about).clicked() {
            studio.request(Action::OpenExample(example.name));
            ui.close();
        }
    }
}

fn languages(studio: &mut Studio, ui: &mut Ui) {
    for (language, name) in Language::ALL {
        let possible = studio.window.chinese || language == Language::English;
        // Without a Chinese font, the name 中文 could not be shown either.
        let name = if possible { name } else { "Chinese" };
        let button = ui.add_enabled(possible, Button::selectable(studio.language() == language, name));
        if button.on_disabled_hover_text(studio.t("no-chinese")).clicked() {
            studio.request(Action::Speak(language));
            ui.close();
        }
    }
}

fn bar(studio: &mut Studio, ui: &mut Ui) {
    let now = studio.parsed().map(|parsed| parsed.profile.fill.strategy);
    let label = ui.label(studio.t("strategy"));
    let mut chosen = now;
    let combo =
        ComboBox::from_id_salt("strategy").selected_text(now.map_or("", StrategyName::name)).show_ui(ui, |ui| {
            for &strategy in StrategyName::ALL {
                ui.selectable_value(&mut chosen, Some(strategy), strategy.name());
            }
        });
    combo.response.labelled_by(label.id);
    if let Some(chosen) = chosen.filter(|_| chosen != now) {
        studio.request(Action::SetValue("fill.strategy".to_owned(), format!("\"{chosen}\"")));
    }
    ui.separator();
    for (mode, key) in [(Mode::Solid, "view-solid"), (Mode::Layer, "view-layer"), (Mode::Compare, "view-compare")] {
        if ui.selectable_label(studio.view.mode == mode, studio.t(key)).clicked() {
            studio.view.switch(mode);
        }
    }
    ui.separator();
    match studio.plans.own.progress {
        Some((stage, fraction)) => {
            ui.add(ProgressBar::new(fraction as f32).desired_width(180.0).text(studio.t(stage_text(stage))));
            if ui.button(studio.t("stop")).clicked() {
                studio.request(Action::Stop);
            }
        }
        None if studio.plans.own.is_complete() => done(studio, ui),
        None if studio.plans.own.failure.is_none() && studio.plans.own.part.is_some() => {
            ui.label(studio.t("stopped"));
            if ui.button(studio.t("plan")).clicked() {
                studio.request(Action::Plan);
            }
        }
        None => {}
    }
}

/// That the plan is complete, and how much the checks found; a click shows it.
fn done(studio: &mut Studio, ui: &mut Ui) {
    let count = studio.plans.own.findings.as_ref().map_or(0, Vec::len);
    let good = theme::good(ui.visuals().dark_mode);
    let warn = ui.visuals().warn_fg_color;
    ui.colored_label(if count > 0 { warn } else { good }, studio.t("ready"));
    if count > 0 && ui.link(format!("{}: {count}", studio.t("findings"))).clicked() {
        studio.view.side = Side::Findings;
    }
}

fn stage_text(stage: Stage) -> &'static str {
    match stage {
        Stage::Import => "stage-import",
        Stage::Heat => "stage-heat",
        Stage::Slice => "stage-slice",
        Stage::Plan => "stage-plan",
        Stage::Deposit => "stage-deposit",
    }
}
