//! The table of several models: how far each has come, its figures, and the worst that was found.

use super::findings;
use crate::actions::Action;
use crate::batch::{Come, Figures, Row, Verdict};
use crate::jobs::Ask;
use crate::known::{Known, Queue, View};
use crate::theme;
use eframe::egui::{Button, Grid, Label, ProgressBar, ScrollArea, Ui, Window};

/// So much of the worst finding is shown, in characters.
const SHOWN: usize = 64;

/// The entries of the menu: a folder is chosen, or the table shown again. A browser has no folders.
pub(super) fn entries(known: Known<'_>, view: &mut View<'_>, queue: &mut Queue, ui: &mut Ui) {
    if cfg!(target_arch = "wasm32") {
        return;
    }
    if ui.add(Button::new(known.t("batch-open"))).on_hover_text(known.t("batch-hint")).clicked() {
        queue.push(Action::Ask(Ask::BatchFolder));
        ui.close();
    }
    if known.jobs.batch.is_some() && ui.add(Button::new(known.t("batch"))).clicked() {
        view.state.batch = true;
        ui.close();
    }
}

/// The window with the table.
pub(super) fn show(known: Known<'_>, view: &mut View<'_>, queue: &mut Queue, ui: &Ui) {
    let Some(batch) = &known.jobs.batch else { return };
    let mut open = view.state.batch;
    let window = Window::new(known.t("batch")).open(&mut open).default_width(860.0).default_pos([24.0, 64.0]);
    window.show(ui.ctx(), |ui| {
        let (rows, runs) = (batch.rows(), batch.runs());
        ui.horizontal(|ui| {
            ui.label(format!("{}: {}", known.t("profile"), batch.profile));
            let done = rows.iter().filter(|row| row.is_done()).count();
            let bar = ProgressBar::new(done as f32 / rows.len().max(1) as f32).desired_width(180.0);
            ui.add(bar.text(format!("{done} / {}", rows.len())));
            if runs && ui.button(known.t("cancel")).clicked() {
                queue.push(Action::StopBatch);
            }
            if !runs && ui.button(known.t("batch-again")).on_hover_text(known.t("batch-again-hint")).clicked() {
                queue.push(Action::Batch(rows.iter().map(|row| row.path.clone()).collect()));
            }
        });
        ScrollArea::both().max_height(420.0).show(ui, |ui| table(known, queue, ui, &rows, runs));
    });
    view.state.batch = open;
}

fn table(known: Known<'_>, queue: &mut Queue, ui: &mut Ui, rows: &[Row], runs: bool) {
    Grid::new("batch").num_columns(6).spacing([14.0, 5.0]).striped(true).show(ui, |ui| {
        for key in ["batch-part", "batch-state", "wire", "duration", "batch-starts", "batch-worst"] {
            ui.strong(known.t(key));
        }
        ui.end_row();
        for row in rows {
            if ui.link(row.name()).on_hover_text(row.path.display().to_string()).clicked() {
                queue.push(Action::OpenFile(row.path.clone()));
            }
            match &row.come {
                Come::Planned(figures) => planned(known, ui, figures),
                Come::Failed(sentence) => {
                    ui.colored_label(ui.visuals().error_fg_color, known.t("batch-failed"));
                    (0..3).for_each(|_| drop(ui.label("–")));
                    worst(ui, sentence);
                }
                Come::Runs if runs => drop(ui.label(known.t("batch-runs"))),
                Come::Waits if runs => drop(ui.weak(known.t("batch-waits"))),
                Come::Runs | Come::Waits => drop(ui.weak(known.t("stopped"))),
            }
            ui.end_row();
        }
    });
}

fn planned(known: Known<'_>, ui: &mut Ui, figures: &Figures) {
    let Figures { mass, seconds, starts, verdict, worst: found } = figures;
    let visuals = ui.visuals();
    let (key, ink) = match verdict {
        Verdict::Good => ("batch-good", theme::good(visuals.dark_mode)),
        Verdict::Doubtful => ("batch-doubtful", visuals.warn_fg_color),
        Verdict::Serious => ("batch-serious", visuals.error_fg_color),
        Verdict::Forbidden => ("batch-forbidden", visuals.error_fg_color),
    };
    ui.colored_label(ink, known.t(key));
    ui.label(format!("{mass:.2} kg"));
    ui.label(format!("{:.2} h", seconds / 3600.0));
    ui.label(starts.to_string());
    worst(ui, &found.as_ref().map_or_else(|| "–".to_owned(), |finding| findings::said(known, finding)));
}

/// The beginning of a sentence; all of it as a hint.
fn worst(ui: &mut Ui, sentence: &str) {
    let (mut begin, long) = (sentence.chars().take(SHOWN).collect::<String>(), sentence.chars().count() > SHOWN);
    if long {
        begin.push('…');
    }
    ui.add(Label::new(begin).extend()).on_hover_text(sentence);
}
