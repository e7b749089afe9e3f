//! The section `[order]`.

use crate::order::{Method, Seam};
use serde::{Deserialize, Serialize};

/// Order of passes.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct OrderSection {
    /// How the order and the start points of passes are found: `nearest`, `improved-nearest`, `ant-colony`,
    /// `local-search` or `exact`; default local-search.
    pub method: Method,
    /// Where closed passes begin: `nearest`, `aligned`, `rotate` (two bead widths further along on each layer) or
    /// `spread` (as far as possible from the seams below); default nearest. All but `aligned` stay half a bead away from the
    /// starts of the five layers below.
    pub seam: Seam,
    /// Whether passes run in the opposite direction on every second layer, so that ends lie over starts: closed passes
    /// are reversed; open ones begin at their left end (least x, then least y) on one layer and at their right end on
    /// the next; default false.
    pub alternate: bool,
    /// Whether islands and passes of a layer are laid so that heat stays around the middle of the plate, against bending to one
    /// side: their order, directions and starts; default false. Travels may take longer by 5 % of the time of the arc.
    pub distortion: bool,
}
