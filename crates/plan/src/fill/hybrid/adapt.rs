//! Widths adapted to the available space: where neighbours lie farther apart or closer than a stepover, each bead takes
//! half the distance to its neighbour on either side, within the limits of the process. Metal is laid where there is
//! space for it, and small gaps close without a bead of their own.

use crate::fill::line_index::{LineIndex, Sight};
use crate::fill::{FillSettings, Path};
use crate::pass::{Along, PassKind};
use glam::DVec2;
use planar::Polygon;

/// Neighbours are searched for up to this far away, in stepovers; a side without one counts as a stepover.
const SIGHT: f64 = 1.6;
/// Distance between the points at which the width is set, in bead widths.
const STEP: f64 = 0.35;
/// Widths are multiples of this fraction of a bead width, so that the speed changes seldom.
const GRAIN: f64 = 0.05;
/// Represents the outline among the numbers of the passes.
const OUTLINE: usize = usize::MAX;

/// Gives every pass the widths for which its neighbours leave space; no bead reaches beyond the island and its
/// allowance.
pub fn widths(passes: &mut [Path], island: &Polygon, settings: &FillSettings) {
    let mut near = LineIndex::new(SIGHT * settings.stepover);
    for (number, pass) in passes.iter().enumerate() {
        near.add_line(number, &pass.path());
    }
    for ring in island.rings() {
        near.add_line(OUTLINE, &closed(ring.points()));
    }
    for (number, pass) in passes.iter_mut().enumerate() {
        adapt(number, pass, &near, settings);
    }
}

fn closed(points: &[DVec2]) -> Vec<DVec2> {
    points.iter().chain(points.first()).copied().collect()
}

fn adapt(number: usize, pass: &mut Path, near: &LineIndex, settings: &FillSettings) {
    let d = settings.stepover;
    let path = pass.path();
    let (mut points, mut widths) = (Vec::new(), Vec::new());
    for (k, pair) in path.windows(2).enumerate() {
        let (a, b) = (pair[0], pair[1]);
        let Some(way) = (b - a).try_normalize() else { continue };
        let count = (a.distance(b) / (STEP * settings.bead.width)).ceil().max(1.0) as usize;
        for i in 0..count {
            let middle = a.lerp(b, (i as f64 + 0.5) / count as f64);
            let (low, mut high) = settings.hybrid.width_limits;
            let mut room = 0.0;
            let seen = [way.perp(), -way.perp()].map(|normal| near.sight(middle, normal, (number, k)));
            let at_edge = seen.iter().flatten().any(|sight| sight.line == OUTLINE);
            for sight in seen {
                room += match sight {
                    Some(Sight { line: OUTLINE, distance, .. }) => {
                        // A bead may reach up to the outline and its allowance; one in a thin wall does.
                        let reach = distance + settings.machining_allowance;
                        high = high.min(2.0 * reach + 1e-3);
                        if pass.kind == PassKind::Skeleton { reach * d / settings.bead.width } else { d / 2.0 }
                    }
                    // Both legs of a sharp corner share the space between them; at the edge, the tip would stay bare.
                    Some(Sight { line, piece, .. }) if at_edge && line == number && piece.abs_diff(k) <= 1 => d / 2.0,
                    Some(Sight { distance, .. }) => distance / 2.0,
                    None => d / 2.0,
                };
            }
            let grain = GRAIN * settings.bead.width;
            let width = ((settings.bead.width * room / d / grain).round() * grain).max(low).min(high);
            // Pieces of one line with the same width are merged.
            if i > 0 && widths.last() == Some(&width) {
                continue;
            }
            points.push(a.lerp(b, i as f64 / count as f64));
            widths.push(width);
        }
    }
    let Some(&last) = widths.last() else { return };
    if !pass.closed {
        points.extend(path.last());
        widths.push(last);
    }
    pass.points = points;
    pass.width = if widths.iter().all(|&w| w == last) { Along::Same(last) } else { Along::Each(widths) };
}
