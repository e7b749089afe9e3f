//! The section `[layers]`.

use crate::limit::{Limit, limits};
use serde::{Deserialize, Serialize};

/// The layers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LayersSection {
    /// Thickness, mm; of walls only where their height is not foretold.
    pub height: f64,
    /// Whether the layers lie where the wall's beads will be (Li et al., eqs 5 to 8) instead of one thickness apart:
    /// `auto` for the strategy `wall`, `always` or `never`; default auto.
    #[serde(default)]
    pub foretell: Foretell,
}

/// When the heights of layers are foretold from the bead.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Foretell {
    /// For the strategy `wall`.
    #[default]
    Auto,
    /// For every strategy.
    Always,
    /// Layers are one thickness apart.
    Never,
}

impl LayersSection {
    /// What the numbers can be.
    pub(super) fn limits(&self) -> Vec<Limit> {
        limits! {
            "layers.height": self.height, 0.01, 50.0, "mm", "a layer is as high as its beads rise";
        }
    }
}
