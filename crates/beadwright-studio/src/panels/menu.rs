//! Menus, and the bar below them: strategy, views, progress.

use super::{adapt, batch, help};
use crate::actions::{self, Action};
use crate::jobs::Ask;
use crate::known::{Known, Queue, View};
use crate::settings::{TEXT_PERCENT, text_percent};
use crate::text::Language;
use crate::theme;
use crate::view::{Mode, Side};
use beadwright::example;
use beadwright::fill::StrategyName;
use beadwright::task::Stage;
use eframe::egui::{Button, ComboBox, MenuBar, ProgressBar, RichText, Ui};

pub(super) fn show(known: Known<'_>, view: &mut View<'_>, queue: &mut Queue, ui: &mut Ui) {
    MenuBar::new().ui(ui, |ui| {
        ui.menu_button(known.t("file"), |ui| {
            items(known, queue, ui, &[Action::Open]);
            ui.menu_button(known.t("recent"), |ui| recent(known, queue, ui));
            batch::entries(known, view, queue, ui);
            scan(known, queue, ui);
            adapt::entry(known, queue, ui);
            ui.separator();
            items(known, queue, ui, &[Action::Save, Action::SaveAs, Action::ExportProgram]);
            // A page is closed by its browser.
            if !cfg!(target_arch = "wasm32") {
                ui.separator();
                items(known, queue, ui, &[Action::Quit]);
            }
        });
        ui.menu_button(known.t("edit"), |ui| {
            items(known, queue, ui, &[Action::Undo, Action::Redo, Action::PlaceTool, Action::Plan, Action::Stop]);
        });
        ui.menu_button(known.t("view"), |ui| {
            items(known, queue, ui, &[Action::Solid, Action::Layer, Action::Compare]);
            ui.separator();
            items(known, queue, ui, &[Action::Fit, Action::Top, Action::Front, Action::Right, Action::Corner]);
            ui.separator();
            items(known, queue, ui, &[Action::Up, Action::Down, Action::Play]);
            ui.separator();
            items(known, queue, ui, &[Action::Theme]);
            ui.menu_button(known.t("text-size"), |ui| text_sizes(queue, ui));
            ui.menu_button(known.t("language"), |ui| languages(known, queue, ui));
        });
        ui.menu_button(known.t("examples"), |ui| examples(queue, ui));
        ui.menu_button(known.t("help"), |ui| {
            help::menu(known, view, ui);
            items(known, queue, ui, &[Action::Keys]);
        });
    });
    if known.project().source.is_some() {
        ui.horizontal_wrapped(|ui| bar(known, view, queue, ui));
    }
}

fn items(known: Known<'_>, queue: &mut Queue, ui: &mut Ui, wanted: &[Action]) {
    for entry in wanted.iter().filter_map(actions::find) {
        let enabled = match entry.action {
            Action::Undo => known.open.project.undoes().is_some(),
            Action::Redo => known.open.project.redoes().is_some(),
            Action::ExportProgram | Action::Play => known.plans.own.summary.is_some(),
            Action::Save | Action::SaveAs | Action::Plan | Action::PlaceTool => known.project().source.is_some(),
            Action::Stop => known.plans.own.is_busy(),
            _ => true,
        };
        let key = entry.key.map(|key| ui.ctx().format_shortcut(&key)).unwrap_or_default();
        let text = named(known, &entry.action, known.t(entry.text));
        if ui.add_enabled(enabled, Button::new(text).shortcut_text(key)).clicked() {
            queue.push(entry.action.clone());
            ui.close();
        }
    }
}

/// The text of an entry; undo and redo say of what.
fn named(known: Known<'_>, action: &Action, text: &str) -> String {
    let about = match action {
        Action::Undo => known.open.project.undoes(),
        Action::Redo => known.open.project.redoes(),
        _ => None,
    };
    about.map_or_else(|| text.to_owned(), |about| format!("{text}: {}", known.step(about)))
}

/// A scan can be opened once there is a part to compare it with.
fn scan(known: Known<'_>, queue: &mut Queue, ui: &mut Ui) {
    let solid = known.plans.own.part.as_ref().is_some_and(|part| part.mesh().is_some());
    let entry = ui.add_enabled(solid, Button::new(known.t("open-scan"))).on_hover_text(known.t("scan-hint"));
    if entry.on_disabled_hover_text(known.t("scan-needs-part")).clicked() {
        queue.push(Action::Ask(Ask::OpenScan));
        ui.close();
    }
}

fn recent(known: Known<'_>, queue: &mut Queue, ui: &mut Ui) {
    if known.window.settings.recent.is_empty() {
        ui.weak(known.t("no-recent"));
    }
    for path in known.window.settings.recent.clone() {
        let name = path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
        if ui.button(name).on_hover_text(path.display().to_string()).clicked() {
            queue.push(Action::OpenFile(path));
            ui.close();
        }
    }
}

fn examples(queue: &mut Queue, ui: &mut Ui) {
    for example in example::ALL {
        if ui.button(example.name).on_hover_text(example.about).clicked() {
            queue.push(Action::OpenExample(example.name));
            ui.close();
        }
    }
}

fn languages(known: Known<'_>, queue: &mut Queue, ui: &mut Ui) {
    for (language, name) in Language::ALL {
        let possible = known.window.chinese || language == Language::English;
        // Without a Chinese font, the name 中文 could not be shown either.
        let name = if possible { name } else { "Chinese" };
        let button = ui.add_enabled(possible, Button::selectable(known.language() == language, name));
        if button.on_disabled_hover_text(known.t("no-chinese")).clicked() {
            queue.push(Action::Speak(language));
            ui.close();
        }
    }
}

fn text_sizes(queue: &mut Queue, ui: &mut Ui) {
    let now = text_percent(ui.ctx());
    for percent in TEXT_PERCENT {
        if ui.selectable_label(now == percent, format!("{percent} %")).clicked() {
            queue.push(Action::TextSize(percent));
            ui.close();
        }
    }
}

fn bar(known: Known<'_>, view: &mut View<'_>, queue: &mut Queue, ui: &mut Ui) {
    let now = known.parsed().map(|parsed| parsed.profile.fill.strategy);
    let label = ui.label(known.t("strategy"));
    let mut chosen = now;
    let combo =
        ComboBox::from_id_salt("strategy").selected_text(now.map_or("", StrategyName::name)).show_ui(ui, |ui| {
            for &strategy in StrategyName::ALL {
                ui.selectable_value(&mut chosen, Some(strategy), strategy.name());
            }
        });
    combo.response.labelled_by(label.id);
    if let Some(chosen) = chosen.filter(|_| chosen != now) {
        queue.push(Action::SetValue("fill.strategy".to_owned(), format!("\"{chosen}\"")));
    }
    ui.separator();
    for (mode, key) in [(Mode::Solid, "view-solid"), (Mode::Layer, "view-layer"), (Mode::Compare, "view-compare")] {
        if ui.selectable_label(view.state.mode == mode, known.t(key)).clicked() {
            view.state.switch(mode);
        }
    }
    ui.separator();
    match known.plans.own.progress {
        Some((stage, fraction)) => {
            ui.add(ProgressBar::new(fraction as f32).desired_width(180.0).text(known.t(stage_text(stage))));
            if ui.button(known.t("stop")).clicked() {
                queue.push(Action::Stop);
            }
        }
        None if known.plans.own.is_complete() => done(known, ui),
        None if known.plans.own.failure.is_none() && known.plans.own.part.is_some() => {
            ui.label(known.t("stopped"));
            if ui.button(known.t("plan")).clicked() {
                queue.push(Action::Plan);
            }
        }
        None => {}
    }
    verdict(known, view, ui);
}

/// Shows that the plan is complete, and how good it is by its colour.
fn done(known: Known<'_>, ui: &mut Ui) {
    let (own, visuals) = (&known.plans.own, ui.visuals());
    let colour = match own.found() {
        _ if own.serious().next().is_some() => visuals.error_fg_color,
        0 => theme::good(visuals.dark_mode),
        _ => visuals.warn_fg_color,
    };
    ui.colored_label(colour, known.t("ready"));
}

/// Says, as soon as it is known, that a program may not be written, and how much was found; a click opens the findings.
fn verdict(known: Known<'_>, view: &mut View<'_>, ui: &mut Ui) {
    let own = &known.plans.own;
    let error = ui.visuals().error_fg_color;
    let (serious, found) = (own.serious().map(|finding| finding.count).sum::<usize>(), own.found());
    if !own.forbidden().is_empty() {
        let text = RichText::new(known.t("may-not-be-written")).color(error).strong();
        ui.label(text).on_hover_text(own.forbidden().join("\n\n"));
    } else if serious > 0 {
        ui.colored_label(error, format!("{}: {serious}", known.t("serious-count")));
    }
    let counts = own.is_of_last_request() && found > 0;
    if counts && ui.link(format!("{}: {found}", known.t("findings"))).clicked() {
        view.state.side = Side::Findings;
    }
}

pub(super) fn stage_text(stage: Stage) -> &'static str {
    match stage {
        Stage::Import => "stage-import",
        Stage::Directions => "stage-directions",
        Stage::Heat => "stage-heat",
        Stage::Distort => "stage-distort",
        Stage::Slice => "stage-slice",
        Stage::Plan => "stage-plan",
        Stage::Deposit => "stage-deposit",
    }
}
