//! The profile as a form: units, ranges and meaning of every key.

use super::{basic, process};
use crate::actions;
use crate::actions::Action;
use crate::form::{self, Field, Kind, Parsed, Section};
use crate::jobs::Ask;
use crate::known::{Known, Queue, View};
use crate::text::Language;
use beadwright::limit::Limit;
use beadwright::profile::Profile;
use eframe::egui::{CollapsingHeader, Color32, ComboBox, DragValue, Grid, Label, Response, RichText, TextEdit, Ui};

pub(super) fn show(known: Known<'_>, view: &mut View<'_>, queue: &mut Queue, ui: &mut Ui) {
    ui.separator();
    ui.heading(known.t("parameters"));
    let Some(parsed) = known.parsed() else { return };
    ui.horizontal(|ui| process::profile(known, queue, ui));
    if ui.button(known.t("profile-file")).clicked() {
        queue.push(Action::Ask(Ask::OpenProfile));
    }
    let label = ui.label(known.t("search"));
    ui.add(TextEdit::singleline(&mut view.state.search).desired_width(f32::INFINITY)).labelled_by(label.id);
    let mut all = known.window.settings.all_parameters;
    if ui.checkbox(&mut all, known.t("all-parameters")).changed() {
        queue.push(Action::AllParameters(all));
    }
    // A search covers all parameters.
    let all = all || !view.state.search.is_empty();
    let shown = |key: &str| form::field(key).is_some() && (all || form::BASIC.contains(&key));
    if let Some((key, reason)) = known.open.refused.clone().filter(|(key, _)| !shown(key)) {
        ui.colored_label(ui.visuals().error_fg_color, format!("{} {key}: {reason}", known.t("impossible")));
    }
    let (search, Parsed { profile, values, limits, .. }) = (view.state.search.to_lowercase(), &*parsed);
    let mut form = Form { known, search, queue, profile, values, limits };
    if all {
        form::sections().iter().for_each(|section| form.section(ui, section));
    } else {
        basic::show(&mut form, ui);
    }
}

/// The profile while it is shown.
pub(super) struct Form<'a> {
    pub(super) known: Known<'a>,
    /// What is searched for, in lower case.
    search: String,
    pub(super) queue: &'a mut Queue,
    profile: &'a Profile,
    values: &'a toml::Table,
    limits: &'a [Limit],
}

impl Form<'_> {
    fn section(&mut self, ui: &mut Ui, section: &Section) {
        let search = &*self.search;
        let found = |f: &&Field| search.is_empty() || self.says(section, f, search);
        let fields: Vec<&Field> = section.fields.iter().filter(found).collect();
        if fields.is_empty() || !self.has_section(&section.key) {
            return;
        }
        let title = match &*section.key {
            "" => self.known.t("profile").to_owned(),
            key => self.known.language().word("section", key),
        };
        let open = (section.key == "fill" || !search.is_empty()).then_some(!search.is_empty());
        CollapsingHeader::new(title)
            .id_salt(&section.key)
            .default_open(section.key == "fill")
            .open(open.filter(|open| *open))
            .show(ui, |ui| {
                if !section.about.is_empty() {
                    ui.weak(&section.about);
                }
                self.reset(ui, section);
                Grid::new(&section.key).num_columns(2).show(ui, |ui| {
                    fields.into_iter().for_each(|field| self.field(ui, field));
                });
            });
    }

    /// Whether the profile has this section: a dialect that is not written has no values to show.
    fn has_section(&self, section: &str) -> bool {
        section.is_empty() || form::value(self.values, section).is_some()
    }

    /// Whether the profile has the section of this key.
    pub(super) fn has(&self, key: &str) -> bool {
        self.has_section(key.rsplit_once('.').map_or("", |(section, _)| section))
    }

    /// Whether a text occurs in a field's key, its meaning, the reason for its range, or its name in either language.
    fn says(&self, section: &Section, field: &Field, search: &str) -> bool {
        let name = |(language, _): (Language, _)| {
            let words = [("name", &field.name), ("section", &section.key)];
            words.map(|(kind, word)| language.word(kind, word)).join(" ")
        };
        let reason = form::limit(self.limits, &field.key).map_or("", |limit| limit.reason);
        let texts = [field.key.clone(), field.about.clone(), reason.to_owned()];
        texts.into_iter().chain(Language::ALL.map(name)).any(|text| text.to_lowercase().contains(search))
    }

    /// A button that removes from the profile the values of a section that have a default.
    fn reset(&mut self, ui: &mut Ui, section: &Section) {
        let own = |field: &&Field| field.optional && form::value(self.values, &field.key).is_some();
        let keys: Vec<String> = section.fields.iter().filter(own).map(|field| field.key.clone()).collect();
        let (text, hint) = (self.known.t("defaults"), keys.join(", "));
        if !keys.is_empty() && !section.key.is_empty() && ui.small_button(text).on_hover_text(hint).clicked() {
            self.queue.push(Action::ResetValues(keys));
        }
    }

    fn field(&mut self, ui: &mut Ui, field: &Field) {
        let name = self.known.language().word("name", &field.name);
        self.row(ui, field, name);
    }

    /// A row of a grid: a name, and the widget of its field.
    pub(super) fn row(&mut self, ui: &mut Ui, field: &Field, name: String) {
        let value = form::value(self.values, &field.key);
        let limit = form::limit(self.limits, &field.key);
        let hint = self.hint(field, limit);
        let refused = self.known.open.refused.as_ref().is_some_and(|(key, _)| *key == field.key);
        let mut name = RichText::new(name);
        let unusual = limit.filter(|_| value.is_some()).and_then(|limit| self.unusual(limit));
        if refused {
            name = name.color(ui.visuals().error_fg_color);
        } else if unusual.is_some() {
            name = name.color(ui.visuals().warn_fg_color);
        }
        let label = ui.label(name).on_hover_text(&hint);
        ui.horizontal(|ui| {
            let (response, changed) = widget(ui, field, value.as_ref(), limit);
            response.labelled_by(label.id).on_hover_text(&hint);
            if let Some(text) = changed {
                self.queue.push(Action::SetValue(field.key.clone(), text));
            }
            if field.optional
                && value.is_some()
                && ui.small_button("↺").on_hover_text(self.known.t("default")).clicked()
            {
                self.queue.push(Action::ResetValue(field.key.clone()));
            }
        });
        ui.end_row();
        // Shown right where the value was typed, so that it is noticed.
        if let Some((_, reason)) = self.known.open.refused.as_ref().filter(|(key, _)| *key == field.key) {
            let text = format!("{} {reason}", self.known.t("impossible"));
            below(ui, text, ui.visuals().error_fg_color);
        } else if let Some(text) = unusual {
            below(ui, text, ui.visuals().warn_fg_color);
        }
    }

    /// What a number usually is, if it is something else.
    fn unusual(&self, limit: &Limit) -> Option<String> {
        let (least, most) = self.profile.usual(limit.key)?;
        let (usual, to) = (self.known.t("usual"), self.known.t("to"));
        let text = || format!("{usual} {least} {to} {most} {}", unit(limit));
        (!(least..=most).contains(&limit.value)).then(text)
    }

    /// What the key means, which values it can have, and why.
    fn hint(&self, field: &Field, limit: Option<&Limit>) -> String {
        let range = limit.map(|l| {
            let (from, to) = (self.known.t("from"), self.known.t("to"));
            format!("\n{from} {} {to} {} {}: {}.", l.least, l.greatest, l.unit, l.reason)
        });
        let words = match &field.kind {
            Kind::Choice(words) => words.iter().filter(|(_, about)| !about.is_empty()).collect(),
            _ => Vec::new(),
        };
        let words: String = words.iter().map(|(word, about)| format!("\n• {word}: {about}")).collect();
        format!("{}\n{}{}{words}", field.key, field.about, range.unwrap_or_default())
    }
}

/// A sentence in a row of its own below a field.
fn below(ui: &mut Ui, text: String, colour: Color32) {
    ui.label("");
    ui.add(Label::new(RichText::new(text).color(colour)).wrap());
    ui.end_row();
}

/// The widget of a field, and the new value as TOML if it was changed.
fn widget(
    ui: &mut Ui,
    field: &Field,
    value: Option<&toml::Value>,
    limit: Option<&Limit>,
) -> (Response, Option<String>) {
    match &field.kind {
        Kind::Number { whole } => number(ui, *whole, value, limit),
        Kind::Switch => {
            let mut on = value.and_then(toml::Value::as_bool).unwrap_or_default();
            let response = ui.checkbox(&mut on, "");
            let changed = response.changed().then(|| on.to_string());
            (response, changed)
        }
        Kind::Choice(words) => choice(ui, &field.key, words, value),
        Kind::Text => {
            let mut text = value.and_then(toml::Value::as_str).unwrap_or_default().to_owned();
            let width = room(ui).min(180.0);
            let response = ui.add(TextEdit::singleline(&mut text).desired_width(width));
            let changed = response.changed().then(|| quoted(&text));
            (response, changed)
        }
        Kind::Lines => lines(ui, value),
        Kind::Numbers(count) => numbers(ui, *count, value),
    }
}

fn number(ui: &mut Ui, whole: bool, value: Option<&toml::Value>, limit: Option<&Limit>) -> (Response, Option<String>) {
    let as_toml = |number: f64| if whole { format!("{number:.0}") } else { format!("{number:?}") };
    let now = value.and_then(|v| v.as_float().or(v.as_integer().map(|i| i as f64)));
    let Some(mut number) = now else {
        // The key is left out: a click starts with a valid value.
        let response = ui.small_button("+");
        let changed = response.clicked().then(|| as_toml(limit.map_or(1.0, |l| l.value.clamp(l.least, l.greatest))));
        return (response, changed);
    };
    let (least, greatest) = limit.map_or((f64::MIN, f64::MAX), |l| (l.least, l.greatest));
    let speed = if whole { 0.1 } else { (number.abs() * 0.01).clamp(0.001, 1.0) };
    // A bracket in the unit says what the range depends on, which belongs in the hint.
    let unit = limit.map_or("", |l| unit(l));
    // A typed value is taken once it is complete, and refused with the reason if invalid; dragging stops at the limits.
    let drag = DragValue::new(&mut number).update_while_editing(false).speed(speed).suffix(format!(" {unit}"));
    let drag = if whole { drag.fixed_decimals(0) } else { drag.max_decimals(4) };
    let response = ui.add(drag);
    if response.dragged() {
        number = number.max(least).min(greatest);
    }
    let changed =
        response.changed().then(|| as_toml(number)).filter(|_| Some(number) != now && !actions::escaped(ui.ctx()));
    (response, changed)
}

/// The unit shown after a number; empty if the key already names it. A bracket in it says what the range depends on and
/// belongs in the hint.
pub(super) fn unit(limit: &Limit) -> &'static str {
    let unit = limit.unit.split('(').next().unwrap_or_default().trim();
    if limit.key.split(['.', '_']).any(|word| word == unit) { "" } else { unit }
}

fn choice(
    ui: &mut Ui,
    key: &str,
    words: &[(String, String)],
    value: Option<&toml::Value>,
) -> (Response, Option<String>) {
    let now = value.and_then(toml::Value::as_str).unwrap_or_default();
    let mut chosen = None;
    let combo = ComboBox::from_id_salt(key).selected_text(now).show_ui(ui, |ui| {
        for (word, about) in words {
            let item = ui.selectable_label(word == now, word);
            let item = if about.is_empty() { item } else { item.on_hover_text(about) };
            if item.clicked() && word != now {
                chosen = Some(quoted(word));
            }
        }
    });
    (combo.response, chosen)
}

/// Width for a text field in its row, which ends with the button that removes its value.
fn room(ui: &Ui) -> f32 {
    const LEAST: f32 = 80.0;
    (ui.available_width() - ui.spacing().interact_size.x).max(LEAST)
}

fn lines(ui: &mut Ui, value: Option<&toml::Value>) -> (Response, Option<String>) {
    let now: Vec<&str> =
        value.and_then(toml::Value::as_array).into_iter().flatten().filter_map(|v| v.as_str()).collect();
    let mut text = now.join("\n");
    let rows = now.len().max(1);
    let width = room(ui);
    let edit = TextEdit::multiline(&mut text).code_editor().desired_rows(rows).desired_width(width);
    let response = ui.add(edit);
    let changed = response.changed().then(|| {
        let quoted: Vec<String> = text.lines().map(quoted).collect();
        format!("[{}]", quoted.join(", "))
    });
    (response, changed)
}

fn numbers(ui: &mut Ui, count: usize, value: Option<&toml::Value>) -> (Response, Option<String>) {
    let now = value.and_then(toml::Value::as_array).into_iter().flatten();
    let mut numbers: Vec<f64> = now.filter_map(|v| v.as_float().or(v.as_integer().map(|i| i as f64))).collect();
    numbers.resize(count, 0.0);
    let group = ui.horizontal(|ui| {
        let drags = numbers.iter_mut().map(|number| ui.add(DragValue::new(number).speed(0.1)).changed());
        drags.fold(false, |any, changed| any | changed)
    });
    let changed = group.inner.then(|| format!("{numbers:?}"));
    (group.response, changed)
}

fn quoted(text: &str) -> String {
    toml::Value::from(text).to_string()
}
