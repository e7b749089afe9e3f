//! Reverses passes on every second layer, so that the low ends of beads lie over the high starts below them.

use super::OrderSettings;
use crate::fill::{Fill, Path};

/// Reverses open passes, where allowed, so that they begin at their left end on even layers and at their right end on
/// odd ones, and fixes that direction. Ordering alone cannot do this: it would lay the same line the shortest way on
/// every layer.
pub(super) fn settle_open(islands: &mut [Fill], settings: &OrderSettings) {
    if !settings.alternate {
        return;
    }
    let odd = settings.layer % 2 == 1;
    let open = islands.iter_mut().flat_map(|fill| &mut fill.stages).flatten();
    for pass in open.filter(|pass| !pass.closed && pass.reversible) {
        if runs_left(pass) != odd {
            pass.points.reverse();
            pass.width.reverse();
        }
        pass.reversible = false;
    }
}

/// Reverses closed passes on odd layers; their starts stay in place. Must be done last, since moving seams are measured
/// along the path as the strategy laid it.
pub(super) fn turn_closed(passes: &mut [Path], settings: &OrderSettings) {
    if !settings.alternate || settings.layer.is_multiple_of(2) {
        return;
    }
    for pass in passes.iter_mut().filter(|pass| pass.closed && !pass.points.is_empty()) {
        pass.points.reverse();
        pass.width.reverse();
        let start = pass.points.len() - 1;
        pass.points.rotate_left(start);
        pass.width.rotate_left(start);
    }
}

/// Whether a pass ends further left than it begins (or lower, if it runs along y).
fn runs_left(pass: &Path) -> bool {
    let (Some(first), Some(last)) = (pass.points.first(), pass.points.last()) else { return false };
    let across = last.x - first.x;
    // Lines along y have no left end.
    if across.abs() > 1e-6 { across < 0.0 } else { last.y < first.y }
}
