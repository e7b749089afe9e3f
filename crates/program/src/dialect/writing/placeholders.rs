//! The placeholders of templates, and their values.

use super::{Job, restart};
use crate::number::fixed;
use crate::program::LayerProgram;
use crate::template;
use bead_plan::process::Process;
use bead_plan::weld::retract_time;

/// A placeholder's name, and its value at the beginning of a program.
pub(super) type Placeholder = (&'static str, fn(&Job<'_>) -> String);

/// All placeholders. Those of the part, the layer, the pass, waits and the wire feed change as the program proceeds.
pub const PLACEHOLDERS: [Placeholder; 32] = [
    ("program", |job| job.part.clone()),
    ("layer", |_| String::new()),
    ("pass", |_| String::new()),
    ("pass_number", |_| String::new()),
    ("job", |job| job.weld.process.job.to_string()),
    ("layers", |_| String::new()),
    ("z", |_| String::new()),
    ("arc_timeout", |job| job.safety.arc_timeout.to_string()),
    ("arc_timeout_ms", |job| milliseconds(job.safety.arc_timeout)),
    ("arc_tries", |job| job.safety.arc_tries.to_string()),
    ("gas_halt", |job| gas_halt(job).to_string()),
    ("gas_halt_ms", |job| milliseconds(gas_halt(job))),
    ("wire_feed_speed", |job| job.weld.process.wire_feed_speed.to_string()),
    ("deposition_speed", |job| job.weld.process.deposition_speed.to_string()),
    ("arc_start_delay", |job| job.weld.process.arc_start_delay.to_string()),
    ("arc_end_delay", |job| job.weld.process.arc_end_delay.to_string()),
    ("gas_preflow", |job| job.weld.process.gas_preflow.to_string()),
    ("gas_postflow", |job| job.weld.process.gas_postflow.to_string()),
    ("gas_flow", |job| job.weld.process.gas_flow.to_string()),
    ("arc_start_delay_ms", |job| milliseconds(job.weld.process.arc_start_delay)),
    ("arc_end_delay_ms", |job| milliseconds(job.weld.process.arc_end_delay)),
    ("gas_preflow_ms", |job| milliseconds(job.weld.process.gas_preflow)),
    ("gas_postflow_ms", |job| milliseconds(job.weld.process.gas_postflow)),
    ("positioner_1", |_| fixed(0.0, 4)),
    ("positioner_2", |_| fixed(0.0, 4)),
    ("dwell", |_| "0".to_owned()),
    ("dwell_ms", |_| "0".to_owned()),
    ("wire_feed", |job| fixed(job.weld.process.wire_feed_speed, 3)),
    ("wire_feed_ratio", |_| fixed(1.0, 4)),
    ("wire_retract", |job| job.weld.ends.wire_retract.to_string()),
    ("wire_retract_time", |job| ((retract(job) * 100.0).round() / 100.0).to_string()),
    ("wire_retract_time_ms", |job| milliseconds(retract(job))),
];

fn gas_halt(job: &Job<'_>) -> f64 {
    job.safety.gas_halt.unwrap_or(job.weld.process.gas_postflow)
}

fn milliseconds(seconds: f64) -> String {
    (seconds * 1000.0).round().to_string()
}

fn retract(job: &Job<'_>) -> f64 {
    retract_time(&job.weld.ends, &job.weld.process)
}

/// The values of the placeholders as a program proceeds.
pub(in crate::dialect) struct Values {
    values: Vec<(&'static str, String)>,
    process: Process,
    /// Index of the layer.
    layer: usize,
}

impl Values {
    /// The values at the beginning; `program` is the name of the program in the dialect.
    pub(in crate::dialect) fn new(program: &str, job: &Job<'_>) -> Self {
        let values = PLACEHOLDERS.iter().map(|(name, value)| (*name, value(job))).collect();
        let mut values = Self { values, process: job.weld.process.clone(), layer: 0 };
        values.set("program", program);
        values
    }

    /// Sets number, height and job of the layer.
    pub(in crate::dialect) fn set_layer(&mut self, layer: &LayerProgram) {
        self.layer = layer.index;
        self.set("layer", layer.index + 1);
        self.set("z", fixed(layer.z, 3));
        self.set("job", self.process.at_layer(layer.index).job);
    }

    /// Sets the pass and returns its number for `program.restart`.
    pub(in crate::dialect) fn set_pass(&mut self, pass: usize) -> usize {
        let number = restart::number(self.layer, pass);
        self.set("pass", pass);
        self.set("pass_number", number);
        number
    }

    /// The number up to which the layer has something to weld.
    pub(in crate::dialect) fn last_number(&self) -> usize {
        restart::number(self.layer, usize::MAX)
    }

    /// Sets the angles of the axes that turn the part, °.
    pub(in crate::dialect) fn set_turned(&mut self, [first, second]: [f64; 2]) {
        self.set("positioner_1", fixed(first, 4));
        self.set("positioner_2", fixed(second, 4));
    }

    /// Sets the wait for the next templates, s.
    pub(in crate::dialect) fn set_dwell(&mut self, seconds: f64) {
        self.set("dwell", fixed(seconds, 3));
        self.set("dwell_ms", fixed(seconds * 1000.0, 0));
    }

    /// Sets the wire feed as a fraction (`ratio`) of the nominal one.
    pub(in crate::dialect) fn set_wire_feed(&mut self, ratio: f64, nominal: f64) {
        self.set("wire_feed_ratio", fixed(ratio, 4));
        self.set("wire_feed", fixed(ratio * nominal, 3));
    }

    pub(in crate::dialect) fn set(&mut self, name: &str, value: impl ToString) {
        for (_, v) in self.values.iter_mut().filter(|(known, _)| *known == name) {
            *v = value.to_string();
        }
    }

    pub(in crate::dialect) fn expand<'a>(&'a self, lines: &'a [String]) -> impl Iterator<Item = String> + 'a {
        lines.iter().map(|line| template::expand(line, &self.values))
    }
}
