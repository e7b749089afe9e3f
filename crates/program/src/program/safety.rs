//! The section `[safety]` of a profile.

use bead_plan::limit::{Broken, Limit, limits};
use serde::{Deserialize, Serialize};

/// What the cell must supply so that the programs may run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Safety {
    /// What the cell must supply, as sentences: inputs, interlocks, extraction. They are written at the head of every program.
    pub supplies: Vec<String>,
    /// How long programs wait for the arc to burn at each try, s: `{{arc_timeout}}` in templates. Default 3.
    pub arc_timeout: f64,
    /// How often programs strike the arc before they halt with wire and gas off: `{{arc_tries}}` in templates. Default 3.
    pub arc_tries: u32,
    /// How long the gas keeps flowing in a halt before it is switched off, s: `{{gas_halt}}` in templates. Default:
    /// `process.gas_postflow`.
    pub gas_halt: Option<f64>,
}

impl Default for Safety {
    fn default() -> Self {
        Self { supplies: Vec::new(), arc_timeout: 3.0, arc_tries: 3, gas_halt: None }
    }
}

impl Safety {
    /// The limits of its numbers.
    pub fn limits(&self) -> Vec<Limit> {
        limits! {
            "safety.arc_timeout": self.arc_timeout, 0.1, 60.0, "s", "values outside this range make no sense";
            "safety.arc_tries": self.arc_tries.into(), 1.0, 20.0, "tries", "a wire that is fed on without an arc bends and sticks";
            "safety.gas_halt": self.gas_halt.unwrap_or(0.0), 0.0, 600.0, "s", "values outside this range make no sense";
        }
    }

    /// The first sentence that cannot be written in a program's comment.
    pub fn broken(&self) -> Option<Broken> {
        let legal = |text: &&String| text.bytes().all(|b| b.is_ascii_graphic() || b == b' ');
        let odd = self.supplies.iter().find(|text| !legal(text))?;
        Some(Broken::text("safety.supplies", odd, "comments in programs hold printable ASCII characters only."))
    }
}
