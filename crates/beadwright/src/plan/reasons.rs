//! Sentences about a whole plan: why its volume differs from the part's, where it ends, and why it may be empty.

use super::Summary;
use crate::model::Mesh;
use crate::slice::{self, LayerFit, Slab};
use crate::warning::{WarningKind, WarningSummary};

/// Why the volume of the slices differs from the mesh's, as a sentence; `None` where that does not matter. `left` says
/// whether the layers end elsewhere than the part.
pub(super) fn other_volume(summary: &Summary, mesh: f64, left: bool) -> Option<String> {
    /// Fraction of the mesh's volume.
    const WORTH_TELLING: f64 = 0.01;
    let slices = summary.metrics.part_volume_mm3;
    let more = slices / mesh - 1.0;
    if more.abs() <= WORTH_TELLING || mesh <= 0.0 {
        return None;
    }
    let had = |kind| summary.warnings.summaries().any(|w| w.kind == kind);
    let why = if summary.metrics.mesh_volume_mm3.is_none() {
        "the surface is not closed, so the mesh's volume is a guess"
    } else if had(WarningKind::ContoursUnited) && more < 0.0 {
        "shells overlap, and the mesh counts twice what the slices count once"
    } else if had(WarningKind::OpenContourDropped) {
        "contours that are not closed were dropped"
    } else if left {
        "the layers do not end where the part does"
    } else {
        "each layer has the part's shape at its middle; thinner layers follow the part more closely"
    };
    let percent = 100.0 * more;
    Some(format!("The slices hold {:.2} cm³, the mesh {:.2} cm³ ({percent:+.1} %): {why}.", slices / 1e3, mesh / 1e3))
}

/// Why a solid gives no passes: what was dropped on the way, or that it is too narrow for
/// beads of some width, mm.
pub(super) fn why_empty(summary: &Summary, mesh: &Mesh, width: f64) -> String {
    let warned = |kind| summary.warnings.summaries().find(|w| w.kind == kind).map(WarningSummary::sentence);
    let size = mesh.size();
    let part = format!("the part is {:.1} × {:.1} × {:.1} mm", size.x, size.y, size.z);
    if summary.metrics.slice_area_mm2 == 0.0 {
        return match warned(WarningKind::OpenContourDropped) {
            Some(open) => format!("the surface of the model is not closed. {open}"),
            None => warned(WarningKind::Sliver).or(warned(WarningKind::ContoursUnited)).map_or_else(
                || format!("the slices are empty ({part}). Opposite surfaces cancel: check that the model is solid."),
                |lost| format!("the slices are empty. {lost}"),
            ),
        };
    }
    let remedy = "Use a narrower bead or a larger part, or check the unit of the file.";
    match warned(WarningKind::PassTooShort) {
        Some(short) => {
            format!(
                "what is wide enough for a bead of {width} mm gives passes too short to weld ({part}). {short} {remedy}"
            )
        }
        None => format!("no part of the slices is wide enough for a bead of {width} mm ({part}). {remedy}"),
    }
}

/// How far the last layer ends below or above the part, as a sentence; `None` where that does not matter. A
/// usual layer is `height` (mm) high.
pub(super) fn left_over(mesh: &Mesh, slabs: &[Slab], height: f64) -> Option<String> {
    /// Fraction of the height.
    const WORTH_TELLING: f64 = 0.005;
    let (top, last) = (mesh.bounds().1.z, slabs.last()?.z);
    let (left, percent) = ((top - last).abs(), 100.0 * (top - last).abs() / top);
    if left <= WORTH_TELLING * top {
        return None;
    }
    let layers = if slabs.len() == 1 { "its layer ends".to_owned() } else { format!("its {} layers end", slabs.len()) };
    let ends = format!("The part is {top:.2} mm high, but {layers} at {last:.2} mm");
    // Layers of walls are as high as their metal, whatever layers.fit is.
    let as_set = slabs.iter().all(|slab| (slab.height - height).abs() < 1e-6);
    Some(if last < top && !as_set {
        format!("{ends}: the upper {left:.2} mm ({percent:.1} %) are not built.")
    } else if last < top {
        let even = slice::fitted_slabs(mesh, height, LayerFit::Even);
        let each = even.first().map_or(0.0, |slab| slab.height);
        format!(
            "{ends}: the upper {left:.2} mm ({percent:.1} %) are not built. layers.fit = \"last\" adds a layer, \"even\" \
             makes {} layers of {each:.3} mm.",
            even.len()
        )
    } else {
        format!("{ends}: {left:.2} mm ({percent:.1} %) above it.")
    })
}
