//! Help: first steps, the book, the list of keys, and what this program is.

use crate::actions::{Action, ENTRIES};
use crate::known::{Known, View};
use eframe::egui::{Align2, Button, Grid, Ui, Window, vec2};

/// The book.
const BOOK: &str = concat!(env!("CARGO_PKG_REPOSITORY"), "/blob/main/docs/README.md");

/// The way from a part to its program.
const STEPS: [&str; 5] = ["begin-open", "begin-process", "begin-look", "begin-findings", "begin-export"];

/// The entries of the menu before the list of keys.
pub(super) fn menu(known: Known<'_>, view: &mut View<'_>, ui: &mut Ui) {
    if ui.add(Button::new(known.t("first-steps"))).clicked() {
        view.state.first_steps = true;
        ui.close();
    }
    ui.hyperlink_to(known.t("book"), BOOK);
    if ui.add(Button::new(known.t("about"))).clicked() {
        view.state.about = true;
        ui.close();
    }
}

/// The windows that are open.
pub(super) fn show(known: Known<'_>, view: &mut View<'_>, ui: &Ui) {
    keys(known, view, ui);
    let opened = |title: &'static str, open: &mut bool, content: &dyn Fn(&mut Ui)| {
        let window = Window::new(known.t(title)).open(open).collapsible(false).max_width(460.0);
        window.pivot(Align2::CENTER_CENTER).default_pos(ui.ctx().content_rect().center()).show(ui.ctx(), |ui| {
            ui.spacing_mut().item_spacing = vec2(8.0, 8.0);
            content(ui);
        });
    };
    opened("first-steps", &mut view.state.first_steps, &|ui| {
        for (number, step) in (1..).zip(STEPS) {
            ui.label(format!("{number}. {}", known.t(step)));
        }
        ui.hyperlink_to(known.t("more-in-book"), BOOK);
    });
    opened("about", &mut view.state.about, &|ui| {
        ui.heading(concat!("Beadwright ", env!("CARGO_PKG_VERSION")));
        ui.label(known.t("about-text"));
        ui.label(format!("{}: {}", known.t("licence"), env!("CARGO_PKG_LICENSE")));
        ui.hyperlink(env!("CARGO_PKG_REPOSITORY"));
    });
}

fn keys(known: Known<'_>, view: &mut View<'_>, ui: &Ui) {
    let mut open = view.state.keys;
    Window::new(known.t("keys")).open(&mut open).show(ui.ctx(), |ui| {
        Grid::new("keys").num_columns(2).striped(true).show(ui, |ui| {
            let page = cfg!(target_arch = "wasm32");
            for entry in ENTRIES.iter().filter(|entry| !page || entry.action != Action::Quit) {
                ui.label(known.t(entry.text));
                ui.monospace(entry.key.map(|key| ui.ctx().format_shortcut(&key)).unwrap_or_default());
                ui.end_row();
            }
        });
    });
    view.state.keys = open;
}
