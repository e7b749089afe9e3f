//! Layers that overhang.

use super::{Check, Finding, Subject};
use crate::layer::{Layer, overhang};
use crate::plan::charted::Across;
use glam::{DVec2, DVec3};
use planar::{Polygon, Region, buffer};

pub(super) const CHECK: Check = Check {
    name: "overhang",
    what: "parts of a layer that reach more than check.max_overhang beyond the layer below",
    why: "there is nothing to weld on: the bead drops off",
    example: "layer 20: 34.0 mm² overhang the layer below by more than 3.8 mm.",
    remedy: "reorient the part, or add stock below it to be machined away",
    find,
};

/// Beads of bodies welded earlier count as lying under a layer if their tops are this far above its underside, in layer
/// heights; metal that rises higher next to the layer begins below it.
const TOPS: std::ops::Range<f64> = -0.75..2.0;
/// Accuracy to which they are outlined, in bead widths.
const ACCURACY: f64 = 0.05;

fn find(subject: &Subject<'_>) -> Vec<Finding> {
    let width = subject.settings.bead_width;
    let reach = subject.settings.limits.max_overhang * width;
    let islands = |below: &Layer, layer: &Layer| match Across::layers(&subject.settings.layers.chart, below, layer) {
        Some(across) => across.islands(&below.islands),
        None => below.islands.clone(),
    };
    let hanging = |layer: &&Layer| {
        // Other bodies are looked at only where the layer reaches beyond its own.
        let below: Vec<Polygon> = subject.below(layer).iter().flat_map(|below| islands(below, layer)).collect();
        overhang(&below, &layer.islands, reach, width)?;
        let below = Region::from_normalised(below).union(&of_other_bodies(subject, layer)).into_polygons();
        let (area, place) = overhang(&below, &layer.islands, reach, width)?;
        let text = format!("{area:.1} mm² overhang the layer below by more than {reach:.1} mm.");
        Some(CHECK.of_layer(layer, Some(place.extend(layer.z)), text))
    };
    subject.layers.iter().skip(1).filter_map(hanging).collect()
}

/// Metal of bodies welded earlier under a layer, in that layer's unrolled coordinates.
fn of_other_bodies(subject: &Subject<'_>, layer: &Layer) -> Region {
    let corner = layer.islands.first().and_then(|island| island.outer.points().first().copied());
    let Some(near) = corner.filter(|_| !subject.earlier.is_empty()) else { return Region::default() };
    let sheet = subject.settings.layers.chart.sheet(layer.middle());
    let underside = layer.z - layer.height;
    let under = |p: DVec3| {
        let at = sheet.coordinates(p, near);
        TOPS.contains(&((at.z - underside) / layer.height)).then_some(at.truncate())
    };
    let width = subject.settings.bead_width;
    let mut lines: Vec<Vec<DVec2>> = Vec::new();
    for other in subject.earlier {
        let own = subject.whole.layers.sheet(other);
        let place = |p: DVec3| own.as_ref().map_or(p, |own| own.at(p).place);
        for piece in other.passes.iter().flat_map(|pass| pass.segments()) {
            let steps = (piece.from.distance(piece.to) / width).ceil().max(1.0) as usize;
            let points = (0..=steps).map(|k| under(place(piece.from.lerp(piece.to, k as f64 / steps as f64))));
            lines.extend(
                points.collect::<Vec<_>>().split(Option::is_none).map(|run| run.iter().flatten().copied().collect()),
            );
        }
    }
    // Where a line crosses the seam, its ends lie far apart.
    lines.retain(|line| !line.is_empty() && line.windows(2).all(|ends| ends[0].distance(ends[1]) < 2.0 * width));
    let turned = |turns: f64| {
        let line = move |line: &Vec<DVec2>| line.iter().map(|p| sheet.turned(*p, turns)).collect::<Option<Vec<_>>>();
        lines.iter().filter_map(line)
    };
    let around: Vec<Vec<DVec2>> = [-1.0, 1.0].into_iter().flat_map(turned).collect();
    lines.extend(around);
    buffer(&lines, false, width / 2.0, ACCURACY * width)
}
