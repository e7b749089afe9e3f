//! The program as text: the line at which the torch is, and a click on a line takes the torch there.

use super::export;
use crate::actions::Action;
use crate::known::{Known, Queue, View};
use crate::listing::{File, Listing};
use eframe::egui::{Button, ComboBox, RichText, ScrollArea, TextStyle, TextWrapMode, Ui};

pub(super) fn show(known: Known<'_>, view: &mut View<'_>, queue: &mut Queue, ui: &mut Ui) {
    export::dialect(known, view, ui);
    let own = &known.plans.own;
    if own.summary.is_none() || !own.is_of_last_request() {
        ui.weak(known.t("not-complete"));
        return;
    }
    match &known.jobs.listing {
        Some((dialect, Ok(listing))) if *dialect == view.state.dialect => listed(known, view, listing, ui),
        Some((dialect, Err(sentence))) if *dialect == view.state.dialect => {
            ui.colored_label(ui.visuals().warn_fg_color, sentence);
        }
        _ => {
            ui.spinner();
            if known.jobs.listing_job.is_none() {
                queue.push(Action::List);
            }
        }
    }
}

fn listed(known: Known<'_>, view: &mut View<'_>, listing: &Listing, ui: &mut Ui) {
    let (scene, now) = (&known.plans.own.scene, at_line(known, view, listing));
    let Some(file) = file(known, view, listing, now, ui) else { return };
    if now.is_none() {
        ui.weak(known.t("listing-alone"));
    }
    if let Some(line) = rows(view, file, now, ui)
        && let Some(seconds) = listing.seconds(scene, line)
    {
        view.state.go_to(seconds, scene);
        // The line that was clicked stays where it is.
        view.state.listed = at_line(known, view, listing);
    }
}

/// The file that is shown: the one that the torch is in, until another is chosen.
fn file<'a>(
    known: Known<'_>,
    view: &mut View<'_>,
    listing: &'a Listing,
    now: Option<usize>,
    ui: &mut Ui,
) -> Option<&'a File> {
    let of_torch = listing.file(now.unwrap_or_default())?;
    let chosen = |file: Option<usize>| file.and_then(|i| listing.files().get(i)).unwrap_or(of_torch);
    if listing.files().len() == 1 {
        ui.strong(&of_torch.name).on_hover_text(known.t("listing-hint"));
        return Some(of_torch);
    }
    ui.horizontal(|ui| {
        let label = ui.label(known.t("program-file")).on_hover_text(known.t("listing-hint"));
        let combo = ComboBox::from_id_salt("program-file").selected_text(&chosen(view.state.file).name);
        let combo = combo.show_ui(ui, |ui| {
            ui.selectable_value(&mut view.state.file, None, known.t("program-follows"));
            for (i, file) in listing.files().iter().enumerate() {
                ui.selectable_value(&mut view.state.file, Some(i), &file.name);
            }
        });
        combo.response.labelled_by(label.id);
    });
    Some(chosen(view.state.file))
}

/// The line at which the torch is.
fn at_line(known: Known<'_>, view: &View<'_>, listing: &Listing) -> Option<usize> {
    let scene = &known.plans.own.scene;
    listing.line(scene, &scene.at_time(view.state.now(scene))?)
}

/// The lines of a file, the present one marked and in view; returns the one that was clicked.
fn rows(view: &mut View<'_>, file: &File, now: Option<usize>, ui: &mut Ui) -> Option<usize> {
    let (lines, height) = (file.lines(), ui.text_style_height(&TextStyle::Monospace));
    let mut area = ScrollArea::both().auto_shrink(false).id_salt(&file.name);
    if let Some(line) = now.filter(|line| now != view.state.listed && lines.contains(line)) {
        let pitch = height + ui.spacing().item_spacing.y;
        let above = pitch * (line - lines.start) as f32 - ui.available_height() / 2.0;
        area = area.vertical_scroll_offset(above.max(0.0));
        view.state.listed = now;
    }
    let mut clicked = None;
    area.show_rows(ui, height, lines.len(), |ui, shown| {
        ui.style_mut().wrap_mode = Some(TextWrapMode::Extend);
        for line in shown.map(|row| lines.start + row) {
            let text = format!("{:>5}  {}", line - lines.start + 1, file.line(line));
            if ui.add(Button::selectable(now == Some(line), RichText::new(text).monospace()).small()).clicked() {
                clicked = Some(line);
            }
        }
    });
    clicked
}
