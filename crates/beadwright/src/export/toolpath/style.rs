//! The profiles of a file: one for each kind of pass, thickness of layer and pair of waits.
//!
//! What changes along passes is written as a factor between the least and the greatest value of the whole plan, as the
//! extension asks: a machine that cannot cover that range knows before it begins.

use super::super::walk::Run;
use crate::number::fixed;
use crate::pass::PassKind;
use std::collections::BTreeMap;
use uuid::Uuid;

/// Microseconds in a second: the unit of waits and times.
pub(super) const MICROSECONDS: f64 = 1e6;

/// A value that changes along passes.
struct Modifier {
    /// The letter of its factors.
    factor: char,
    /// The attribute of the profile that it changes.
    attribute: &'static str,
    /// Its unmodified value.
    nominal: f64,
    low: f64,
    high: f64,
}

/// The values of a line: width (mm), speed (mm/s), pace of the plan (mm/s), wire feed (ratio).
pub(super) type Values = [f64; 4];

const NAMES: [(char, &str); 4] = [('e', "beadwidth"), ('f', "depositionspeed"), ('g', "bw:pace"), ('h', "bw:wirefeed")];

/// What is constant along a pass.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Style {
    kind: &'static str,
    /// Thickness of the layer, µm.
    height: u64,
    /// Waits before and after, µs.
    waits: [u64; 2],
}

impl Style {
    pub(super) fn of(run: &Run<'_>) -> Self {
        let whole = |value: f64, scale: f64| (value * scale).round() as u64;
        let waits = [run.pause + run.before, run.after].map(|seconds| whole(seconds, MICROSECONDS));
        Self { kind: PassKind::name(run.pass.kind), height: whole(run.layer.height, 1e3), waits }
    }

    /// Its name, unique within the file.
    fn name(&self) -> String {
        let mut name = format!("{} {} mm", self.kind, fixed(self.height as f64 / 1e3, 3));
        for (wait, when) in self.waits.iter().zip(["before", "after"]).filter(|(wait, _)| **wait > 0) {
            name.push_str(&format!(", {} s {when}", fixed(*wait as f64 / MICROSECONDS, 6)));
        }
        name
    }
}

/// All profiles of a file.
pub(super) struct Styles {
    modifiers: [Modifier; 4],
    styles: BTreeMap<Style, Uuid>,
    /// Whether points carry the torch's orientation.
    pub(super) leaning: bool,
}

impl Styles {
    /// The profiles for passes whose lines have these values; `nominal` gives those of the nominal bead.
    pub(super) fn new(runs: &[Run<'_>], lines: &[Vec<Values>], nominal: Values, file: Uuid) -> Self {
        let modifier = |k: usize| {
            let values = || lines.iter().flatten().map(|values| values[k]);
            let (low, high) = (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
            // Once rounded to 6 decimals, the range must still hold every value.
            let (low, high) = ((low * 1e6).floor() / 1e6, (high * 1e6).ceil() / 1e6);
            let (factor, attribute) = NAMES[k];
            let steady = high - low < 2e-6;
            let nominal = if steady { high } else { nominal[k] };
            Modifier { factor, attribute, nominal, low, high: if steady { low } else { high } }
        };
        let uuid = |style: &Style| Uuid::new_v5(&file, style.name().as_bytes());
        let styles = runs.iter().map(Style::of).map(|style| (style, uuid(&style))).collect();
        let leaning = runs.iter().any(|run| !run.leans.is_empty());
        Self { modifiers: std::array::from_fn(modifier), styles, leaning }
    }

    /// The number of a profile within every layer, and its UUID.
    pub(super) fn number(&self, style: &Style) -> Option<(usize, Uuid)> {
        let mut numbered = (1..).zip(&self.styles);
        numbered.find(|(_, (known, _))| *known == style).map(|(number, (_, uuid))| (number, *uuid))
    }

    /// Appends the factors of a line as attributes.
    pub(super) fn factors(&self, text: &mut String, values: &Values) {
        for (m, value) in self.modifiers.iter().zip(values).filter(|(m, _)| m.changes()) {
            let factor = ((value - m.low) / (m.high - m.low)).clamp(0.0, 1.0);
            text.push_str(&format!(" {}=\"{}\"", m.factor, fixed(factor, 9)));
        }
    }

    /// The element `toolpathprofiles`.
    pub(super) fn xml(&self) -> String {
        let mut text = String::from("<tp:toolpathprofiles>\n");
        for (style, uuid) in &self.styles {
            text.push_str(&format!("<tp:toolpathprofile uuid=\"{uuid}\" name=\"{}\"", style.name()));
            for m in &self.modifiers {
                text.push_str(&format!(" {}=\"{}\"", m.attribute, fixed(m.nominal, 6)));
            }
            text.push_str(&format!(
                " beadheight=\"{}\" bw:kind=\"{}\"",
                fixed(style.height as f64 / 1e3, 3),
                style.kind
            ));
            for (wait, key) in style.waits.iter().zip(["prewaittime", "postwaittime"]).filter(|(wait, _)| **wait > 0) {
                text.push_str(&format!(" {key}=\"{wait}\""));
            }
            text.push_str(">\n");
            self.modifiers.iter().filter(|m| m.changes()).for_each(|m| m.write(&mut text));
            text.push_str("</tp:toolpathprofile>\n");
        }
        text.push_str("</tp:toolpathprofiles>\n");
        text
    }
}

impl Modifier {
    fn changes(&self) -> bool {
        self.high > self.low
    }

    fn write(&self, text: &mut String) {
        let (low, high) = (fixed(self.low, 6), fixed(self.high, 6));
        text.push_str(&format!(
            "<tp:modifier attribute=\"{}\" type=\"constant\" minvalue=\"{low}\" maxvalue=\"{high}\" factor=\"{}\"/>\n",
            self.attribute, self.factor
        ));
    }
}
