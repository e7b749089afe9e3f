//! The section `[safety]` of a profile.

use crate::limit::{Broken, Limit, limits};
use serde::{Deserialize, Serialize};

/// What the cell must supply so that the programs may run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Safety {
    /// What the cell must supply, as sentences: inputs, interlocks, extraction. They stand at the head of every program.
    pub supplies: Vec<String>,
    /// How long programs wait for the arc to burn before they stop, s: `{{arc_timeout}}` in templates. Default 3.
    pub arc_timeout: f64,
}

impl Default for Safety {
    fn default() -> Self {
        Self { supplies: Vec::new(), arc_timeout: 3.0 }
    }
}

impl Safety {
    pub(crate) fn limits(&self) -> Vec<Limit> {
        limits! {
            "safety.arc_timeout": self.arc_timeout, 0.1, 60.0, "s", "values outside this range make no sense";
        }
    }

    /// The first sentence that a comment in a program cannot hold.
    pub(crate) fn broken(&self) -> Option<Broken> {
        let legal = |text: &&String| text.bytes().all(|b| b.is_ascii_graphic() || b == b' ');
        let odd = self.supplies.iter().find(|text| !legal(text))?;
        Some(Broken::text("safety.supplies", odd, "comments in programs hold printable ASCII characters only."))
    }
}
