//! Layers that do not lie on each other.

use super::{Check, Finding, Subject};
use crate::slice::Half;

pub(super) const CHECK: Check = Check {
    name: "layers",
    what: "layers without passes although the part continues, layers out of order, and gaps between them",
    why: "the next layer is welded into the air, or the torch runs into the part",
    example: "layer 7: it begins 2.00 mm above the top of the layer below.",
    remedy: "plan with beads that fit the part, and keep the layers in order",
    find,
};

/// Gaps and overlaps above this share of a layer's thickness count.
const TOLERANCE: f64 = 0.25;

fn find(subject: &Subject<'_>) -> Vec<Finding> {
    let mut findings = Vec::new();
    // Underside and top of the layer below.
    let (mut underside, mut below) = (0.0, 0.0);
    // A tip too thin for a bead ends the part.
    let end = subject.layers.iter().rposition(|layer| !layer.passes.is_empty()).map_or(0, |last| last + 1);
    for layer in &subject.layers[..end] {
        let bottom = layer.z - layer.height;
        // A layer may begin on the plate again: that of another part.
        let on = if layer.half == Some(Half::Upper) { underside } else { below };
        let gap = if bottom.abs() < TOLERANCE * layer.height { bottom } else { bottom - on };
        if gap.is_nan() || gap.abs() > TOLERANCE * layer.height {
            let way = if gap < 0.0 { "inside" } else { "above" };
            let text = format!("it begins {:.2} mm {way} the top of the layer below.", gap.abs());
            findings.push(CHECK.of_layer(layer, None, text).sized(gap.abs()));
        }
        if layer.passes.is_empty() {
            findings.push(CHECK.of_layer(layer, None, "nothing is welded here.".to_owned()));
        }
        (underside, below) = (bottom, layer.z);
    }
    findings
}
