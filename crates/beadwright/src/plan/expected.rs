//! Roughly how much a plan will contain, before anything is planned.

use crate::model::Mesh;
use crate::profile::Profile;

/// Path length of a layer, in bead widths, beyond which strategies that weigh every place of a layer (`loop`) take
/// minutes.
const LONG_LAYER: f64 = 25_000.0;
/// Path length of the whole plan, in bead widths, beyond which files take hundreds of megabytes.
const LONG_PLAN: f64 = 5e7;

/// Size of the plan of a solid, if beads fill it one stepover apart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Expected {
    /// Number of layers.
    pub layers: f64,
    /// Length of the beads of a layer, on average, mm.
    pub layer_length: f64,
    /// Whether the plan is so large that it is rarely intended.
    pub large: bool,
}

/// The expected plan of a solid; `None` where its volume is unknown because its surface is not closed.
///
/// ```
/// use beadwright::{Profile, example, plan::expected};
///
/// // Ten layers of 2 mm; in each, beads one stepover apart fill two arms of 100 × 36 mm that share a square.
/// let profile = Profile::built_in("cmt-al2319-kuka")?;
/// let cross = example::find("cross").ok_or("no such example")?.mesh();
/// let expected = expected(&cross, &profile).ok_or("not closed")?;
/// assert_eq!(expected.layers, 10.0);
/// assert!((expected.layer_length * profile.stepover() - (2.0 * 100.0 * 36.0 - 36.0 * 36.0)).abs() < 1e-6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn expected(mesh: &Mesh, profile: &Profile) -> Option<Expected> {
    let layers = (mesh.size().z / profile.layers.height).max(1.0).round();
    let length = Some(mesh.volume()).filter(|volume| *volume > 0.0)? / (profile.layers.height * profile.stepover());
    let widths = length / profile.bead.width;
    let large = widths > LONG_PLAN || widths > LONG_LAYER * layers;
    Some(Expected { layers, layer_length: length / layers, large })
}
