//! What records of builds say about the values of a profile: values with their intervals, and a page that compares them.
//!
//! A value is the mean over undisturbed passes, without those that lie far from the others; its interval is that of the mean (Student's t,
//! 95 %). It holds the scatter from pass to pass, not the error of the meters. What was measured over what was planned is multiplied by the
//! value of the profile with which the part was planned, which the record holds: a profile that was corrected since is not corrected twice.

use super::Quantity;
use super::sealed::{Broken, verify};
use crate::bead::library::{median, t_95};
use crate::heat::HeatSection;
use crate::number::fixed;
use crate::process::{Follow, Process};
use crate::profile::Profile;
use crate::report::sheet::{Row, Sheet};
use serde::{Deserialize, Serialize};

/// A pass as it was welded.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct AsWelded {
    /// Layer, from 1.
    pub layer: usize,
    /// Pass in its layer, from 1.
    pub pass: usize,
    seconds: [Option<f64>; 2],
    burned: f64,
    arcs: usize,
    tries: usize,
    before: [Option<f64>; 2],
    quantities: Vec<(Quantity, Option<f64>, Option<Mean>)>,
    /// Of the profile with which it was planned.
    #[serde(skip)]
    values: Values,
}

/// Values of the profile with which a part was planned, by the names of their keys.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub(super) struct Values {
    wire_feed_speed: Option<f64>,
    current: Option<f64>,
    voltage: Option<f64>,
    arc_efficiency: Option<f64>,
}

impl Values {
    pub(super) fn of(profile: &Profile) -> Self {
        let process = &profile.process;
        Self {
            wire_feed_speed: Some(process.wire_feed_speed),
            current: process.current,
            voltage: process.voltage,
            arc_efficiency: profile.heat.as_ref().map(|heat| heat.arc_efficiency),
        }
    }

    fn quantity(&self, quantity: Quantity) -> Option<f64> {
        match quantity {
            Quantity::Feed => self.wire_feed_speed,
            Quantity::Current => self.current,
            Quantity::Voltage => self.voltage,
            _ => None,
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
struct Mean {
    mean: f64,
}

impl AsWelded {
    /// What was measured of a quantity, as a mean.
    pub fn measured(&self, quantity: Quantity) -> Option<f64> {
        self.of(quantity)?.2.map(|measured| measured.mean)
    }

    fn planned(&self, quantity: Quantity) -> Option<f64> {
        self.of(quantity)?.1
    }

    fn of(&self, quantity: Quantity) -> Option<&(Quantity, Option<f64>, Option<Mean>)> {
        self.quantities.iter().find(|(own, ..)| *own == quantity)
    }

    /// Measured over planned.
    fn ratio(&self, quantity: Quantity) -> Option<f64> {
        Some(self.measured(quantity)? / self.planned(quantity).filter(|planned| *planned > 0.0)?)
    }

    /// What the profile should have said, so that what was measured would have been planned. Without a plan, it is what was measured.
    fn corrected(&self, quantity: Quantity) -> Option<f64> {
        match self.planned(quantity) {
            Some(_) => Some(self.ratio(quantity)? * self.values.quantity(quantity)?),
            None => self.measured(quantity),
        }
    }

    /// Welded in one go, and long enough to be steady.
    fn is_undisturbed(&self) -> bool {
        self.arcs == 1 && self.tries == 0 && self.burned >= STEADY
    }
}

/// Shortest pass that counts, s.
const STEADY: f64 = 3.0;
/// Passes that a value needs.
const LEAST: usize = 5;
/// Values further from the median than this many deviations (1.48 × the median deviation) are left out.
const FAR: f64 = 4.0;
/// Feeds must differ by this much of their mean for a line through them.
const SPREAD: f64 = 0.1;
/// Passes count for the heat where the metal below is this much hotter than its surroundings, K.
const WARM: f64 = 30.0;

/// The passes of a record, from the text of its `record.json`.
///
/// # Errors
/// [`Broken`] if it is none, or was changed since it was sealed.
pub fn as_welded(text: &str) -> Result<Vec<AsWelded>, Broken> {
    #[derive(Deserialize)]
    struct File {
        #[serde(default)]
        values: Values,
        passes: Vec<Line>,
    }
    #[derive(Deserialize)]
    struct Line {
        pass: AsWelded,
    }
    let mut others = |_: &str| None;
    let changed = verify(text, None, &mut others).into_iter().find(|broken| !matches!(broken, Broken::Missing(_)));
    if let Some(broken) = changed {
        return Err(broken);
    }
    let file: File = serde_json::from_str(text).map_err(|_| Broken::Form)?;
    let values = file.values;
    Ok(file.passes.into_iter().map(|line| AsWelded { values, ..line.pass }).collect())
}

/// A mean with its 95 % interval.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Estimate {
    /// The mean.
    pub value: f64,
    /// Half width of its interval.
    pub plus_minus: f64,
    /// Passes that it is the mean of.
    pub passes: usize,
}

impl Estimate {
    /// The mean of values, without those far from their median; `None` of too few.
    fn of(values: impl Iterator<Item = f64>) -> Option<Self> {
        let all: Vec<f64> = values.filter(|value| value.is_finite()).collect();
        let middle = median(all.clone());
        let far = FAR * 1.48 * median(all.iter().map(|value| (value - middle).abs()).collect());
        let is_near = |value: &f64| (value - middle).abs() <= far + 1e-9 * middle.abs();
        let near: Vec<f64> = all.into_iter().filter(is_near).collect();
        let count = near.len();
        if count < LEAST {
            return None;
        }
        let mean = near.iter().sum::<f64>() / count as f64;
        let squares: f64 = near.iter().map(|value| (value - mean).powi(2)).sum();
        let error = (squares / (count - 1) as f64 / count as f64).sqrt();
        Some(Self { value: mean, plus_minus: t_95(count - 1) * error, passes: count })
    }

    fn times(self, factor: f64) -> Self {
        Self { value: self.value * factor, plus_minus: self.plus_minus * factor, ..self }
    }
}

/// A value of the profile, and what the records say of it.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Lesson {
    /// The key.
    pub key: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// What the profile says.
    pub before: Option<f64>,
    /// What the records say.
    pub after: Estimate,
    /// Whether the profile lies outside the interval, so that the value should be changed.
    pub changes: bool,
}

impl Lesson {
    fn new(key: &'static str, unit: &'static str, before: Option<f64>, after: Estimate) -> Self {
        let changes =
            before.is_none_or(|before| (before - after.value).abs() > after.plus_minus.max(1e-3 * before.abs()));
        Self { key, unit, before, after, changes }
    }
}

/// What records say.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Learnt {
    /// Passes in all records.
    pub passes: usize,
    /// Those that were welded undisturbed.
    pub undisturbed: usize,
    /// Values of the profile.
    pub lessons: Vec<Lesson>,
    /// What else was seen, in sentences.
    pub seen: Vec<String>,
    /// What could not be learnt, and why, in sentences.
    pub unknown: Vec<String>,
}

impl Learnt {
    /// What passes say about a profile.
    pub fn of(passes: &[AsWelded], profile: &Profile) -> Self {
        let used: Vec<&AsWelded> = passes.iter().filter(|pass| pass.is_undisturbed()).collect();
        let mut learnt = Self {
            passes: passes.len(),
            undisturbed: used.len(),
            lessons: Vec::new(),
            seen: Vec::new(),
            unknown: Vec::new(),
        };
        learnt.feed(&used, &profile.process);
        learnt.electric(&used, &profile.process);
        learnt.speed(&used);
        learnt.heat(&used, profile.heat.as_ref());
        learnt
            .unknown
            .push("Width and height of beads: logs do not see them. Give the sheet of the trial beads too.".into());
        learnt
    }

    fn feed(&mut self, used: &[&AsWelded], process: &Process) {
        // Programs command it: another value would move the command, not the feeder.
        if process.follow == Follow::WireFeed {
            match Estimate::of(used.iter().filter_map(|pass| pass.ratio(Quantity::Feed))) {
                None => self.unknown.push(lacks("Wire feed", "wire_feed_speed")),
                Some(ratio) => self.seen.push(format!(
                    "The wire was fed at {} % of what the programs set. Calibrate the feeder; the profile is not changed.",
                    shown(ratio.times(100.0), 1)
                )),
            }
            return;
        }
        match Estimate::of(used.iter().filter_map(|pass| pass.corrected(Quantity::Feed))) {
            None => self.unknown.push(lacks("Wire feed", "wire_feed_speed")),
            Some(after) => {
                let before = process.wire_feed_speed;
                self.lessons.push(Lesson::new("process.wire_feed_speed", "m/min", Some(before), after));
            }
        }
    }

    fn electric(&mut self, used: &[&AsWelded], process: &Process) {
        let mean = |quantity| Estimate::of(used.iter().filter_map(|pass| pass.corrected(quantity)));
        for (key, quantity, before) in [
            ("process.current", Quantity::Current, process.current),
            ("process.voltage", Quantity::Voltage, process.voltage),
        ] {
            match mean(quantity) {
                Some(after) => self.lessons.push(Lesson::new(key, quantity.unit(), before, after)),
                None => self.unknown.push(lacks(key, quantity.name())),
            }
        }
        let point = |pass: &&AsWelded| Some([pass.measured(Quantity::Feed)?, pass.measured(Quantity::Current)?]);
        let points: Vec<[f64; 2]> = used.iter().filter_map(point).collect();
        if let Some([slope, within]) = slope(&points) {
            self.seen.push(format!(
                "Synergic line: the current grows by {} ± {} A for each m/min of wire feed.",
                fixed(slope, 1),
                fixed(within, 1)
            ));
        }
    }

    /// How much slower the robot was than planned.
    fn speed(&mut self, used: &[&AsWelded]) {
        let paced = |pass: &&AsWelded| Some(pass.seconds[0]? / pass.seconds[1].filter(|seconds| *seconds > 0.0)?);
        let logged = Estimate::of(used.iter().filter_map(|pass| pass.ratio(Quantity::Speed)));
        let ratio = logged.or_else(|| Estimate::of(used.iter().filter_map(paced)));
        if let Some(ratio) = ratio.filter(|ratio| (ratio.value - 1.0).abs() > ratio.plus_minus.max(5e-3)) {
            self.seen.push(format!(
                "The torch moved at {} % of the planned speed. Check the override and motion.acceleration; the profile is not changed.",
                shown(ratio.times(100.0), 1)
            ));
        }
    }

    /// Metal warms in proportion to the heat that reaches it.
    fn heat(&mut self, used: &[&AsWelded], heat: Option<&HeatSection>) {
        let Some(heat) = heat else {
            self.unknown.push("Heat: the profile has no section [heat].".into());
            return;
        };
        let efficiency = |pass: &&AsWelded| {
            let [planned, measured] = pass.before;
            let [planned, measured] = [planned? - heat.ambient, measured? - heat.ambient];
            (planned >= WARM).then_some(measured / planned * pass.values.arc_efficiency?)
        };
        match Estimate::of(used.iter().filter_map(efficiency)) {
            None => self.unknown.push(
                "Efficiency of the arc: it needs a pyrometer in the logs, and records made with --temperatures.".into(),
            ),
            Some(after) => {
                let before = heat.arc_efficiency;
                if (0.05..=1.0).contains(&after.value) {
                    self.lessons.push(Lesson::new("heat.arc_efficiency", "", Some(before), after));
                } else {
                    self.unknown.push(format!(
                        "Efficiency of the arc: it would be {}. Check the pyrometer, its emissivity, and the values in [heat] and [material].",
                        fixed(after.value, 2)
                    ));
                }
            }
        }
    }

    /// The page.
    pub fn page(&self, profile: &str, records: &[String]) -> Sheet {
        let lead = format!(
            "{} of {} passes were welded undisturbed, in {}.",
            self.undisturbed,
            self.passes,
            records.join(", ")
        );
        let mut sheet = Sheet::new(&format!("What records say about {profile}"), &lead);
        let row = |lesson: &Lesson| -> Row {
            let cells = [
                lesson.key.to_owned(),
                lesson.before.map(|before| fixed(before, 3)).unwrap_or_default(),
                shown(lesson.after, 3),
                lesson.unit.to_owned(),
                lesson.after.passes.to_string(),
                if lesson.changes { "changed" } else { "holds" }.to_owned(),
            ];
            cells.into_iter().map(|cell| (cell, false)).collect()
        };
        if !self.lessons.is_empty() {
            let rows: Vec<Row> = self.lessons.iter().map(row).collect();
            sheet.heading("Values").table(&["key", "before", "after", "unit", "passes", "the profile"], &rows);
            sheet.text(
                "After ± is the mean over the passes with its 95 % interval: the scatter from pass to pass, without the error of the \
                 meters. A value is changed where the profile lies outside. The efficiency of the arc is what makes the heat model as \
                 warm as the pyrometer saw; it takes up whatever is wrong with [heat] and [material].",
            );
        }
        for (heading, sentences) in [("What else was seen", &self.seen), ("What could not be learnt", &self.unknown)] {
            if !sentences.is_empty() {
                sheet.heading(heading);
                sentences.iter().for_each(|sentence| _ = sheet.text(sentence));
            }
        }
        sheet
    }
}

fn lacks(what: &str, column: &str) -> String {
    format!("{what}: fewer than {LEAST} undisturbed passes have it. It needs a column {column} in the logs.")
}

/// `181.5 ± 0.4`.
fn shown(estimate: Estimate, digits: usize) -> String {
    format!("{} ± {}", fixed(estimate.value, digits), fixed(estimate.plus_minus, digits))
}

/// The slope of a line, and half of its 95 % interval; `None` where its points are too few or too close.
fn slope(points: &[[f64; 2]]) -> Option<[f64; 2]> {
    let count = points.len();
    if count < LEAST {
        return None;
    }
    let [x, y] = [0, 1].map(|axis| points.iter().map(|point| point[axis]).sum::<f64>() / count as f64);
    let wide: f64 = points.iter().map(|point| (point[0] - x).powi(2)).sum();
    if (wide / count as f64).sqrt() < SPREAD * x {
        return None;
    }
    let slope = points.iter().map(|point| (point[0] - x) * (point[1] - y)).sum::<f64>() / wide;
    let apart: f64 = points.iter().map(|point| (point[1] - y - slope * (point[0] - x)).powi(2)).sum();
    let error = (apart / (count - 2) as f64 / wide).sqrt();
    Some([slope, t_95(count - 2) * error])
}
