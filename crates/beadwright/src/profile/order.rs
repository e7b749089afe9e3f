//! The section `[order]`.

use crate::order::{Method, Seam};
use serde::{Deserialize, Serialize};

/// Order of passes.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct OrderSection {
    /// How order and start points are found: `nearest`, `improved-nearest`, `ant-colony`, `local-search` or `exact`;
    /// default local-search.
    pub method: Method,
    /// Where closed passes begin: `nearest`, `aligned`, `rotate` (two bead widths further on every layer) or `spread` (as far
    /// as can be from the seams below); default nearest.
    pub seam: Seam,
    /// Whether passes run the other way on every second layer, so that ends come to lie over starts: closed passes turn
    /// round, open ones begin at their left end on one layer (least x, then least y) and at their right end on the next;
    /// default false.
    pub alternate: bool,
}
