//! Connected voids and overfilled patches with their positions, and the causes of the peaks.

use super::field::{Band, Grid, Height};
use super::ridges::Ridges;
use super::stroke::Nominal;
use super::tiles::Square;
use super::{Mask, OVERFILL, VOID};
use crate::layer::Layer;
use crate::pass::{Pass, PassKind};
use glam::DVec2;
use planar::PerRow;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// Why metal piles up.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Cause {
    /// A pass begins here, on other metal.
    Start,
    /// A pass ends here, on other metal.
    End,
    /// A pass turns sharply.
    Corner,
    /// Scan lines are joined here.
    Link,
    /// Several passes meet.
    Junction,
    /// One pass runs too close to itself.
    Closeness,
}

impl Cause {
    /// The name used in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Start => "start",
            Self::End => "end",
            Self::Corner => "corner",
            Self::Link => "link",
            Self::Junction => "junction",
            Self::Closeness => "closeness",
        }
    }
}

/// A connected void or overfilled patch.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Patch {
    /// Index of the layer, from 0.
    pub layer: usize,
    /// Its lowest (void) or highest (peak) point, mm.
    pub place: DVec2,
    /// The height there, mm.
    pub height: f64,
    /// Its area, mm².
    pub area: f64,
    /// What caused it; only peaks have a cause.
    pub cause: Option<Cause>,
}

/// Consecutive points of a row that are all void, or all overfilled.
#[derive(Debug, Clone, Default)]
pub(super) struct Run {
    pub(super) overfilled: bool,
    pub(super) row: u32,
    pub(super) columns: Range<u32>,
    /// The least or greatest height, mm, and the column where it occurs.
    pub(super) extreme: f64,
    pub(super) at: u32,
}

/// Points tested together for any void or overfill.
const LOOK: usize = 16;

/// Adds the runs of a band, row by row.
pub(super) fn find<H: Height>(band: &Band<'_, H>, mask: &Mask, nominal: &Nominal, runs: &mut Vec<Run>) {
    let (void, overfill) = (H::of(VOID * nominal.bead.height), H::of(OVERFILL * nominal.bead.height));
    let stands_out = |height: &H| (*height < void) | (*height > overfill);
    let any = |heights: &[H]| heights.iter().fold(false, |any, height| any | stands_out(height));
    for (row, heights) in band.rows() {
        for columns in band.parts(mask.core(row)) {
            let begun = runs.len();
            for (k, heights) in heights[columns.clone()].chunks(LOOK).enumerate() {
                // With a fixed length they are tested in parallel.
                if !heights.first_chunk::<LOOK>().map_or_else(|| any(heights), |all| any(all)) {
                    continue;
                }
                let first = band.columns.start + columns.start + k * LOOK;
                let places = heights.iter().enumerate().filter(|(_, height)| stands_out(height));
                places.for_each(|(k, &height)| extend(runs, begun, (row, first + k), height.mm(), height > overfill));
            }
        }
    }
}

/// Adds the runs of a square of ridges; those of a row come from left to right.
pub(super) fn find_between(ridges: &Ridges, square: &Square, grid: &Grid, runs: &mut Vec<Run>) {
    let middle = |range: &Range<usize>| 0.5 * (range.start + range.end - 1) as f64;
    let (rows, columns) = (square.rows.start, square.columns.start);
    let along = square.along * grid.step;
    let from_middle = DVec2::new(columns as f64 - middle(&square.columns), rows as f64 - middle(&square.rows));
    let places = (along.perp_dot(from_middle), -along.y, along.x);
    ridges.stripes(places, (square.rows.len(), square.columns.len()), |overfilled, row, points, at, extreme| {
        let columns_of = (columns + points.start) as u32..(columns + points.end) as u32;
        runs.push(Run {
            overfilled,
            row: (rows + row) as u32,
            columns: columns_of,
            extreme,
            at: (columns + at) as u32,
        });
    });
}

/// Adds a point to the last run if that began at index `begun` or later and is adjacent, or begins a new one.
fn extend(runs: &mut Vec<Run>, begun: usize, (row, at): (usize, usize), height: f64, overfilled: bool) {
    let (row, at) = (row as u32, at as u32);
    match runs[begun..].last_mut() {
        Some(run) if run.overfilled == overfilled && run.columns.end == at => {
            run.columns.end = at + 1;
            if (height > run.extreme) == overfilled {
                (run.extreme, run.at) = (height, at);
            }
        }
        _ => runs.push(Run { overfilled, row, columns: at..at + 1, extreme: height, at }),
    }
}

/// The runs of all sections of a layer, in the order of its rows. The sections come by rows of squares, each from left
/// to right, and the runs of a row in each section from left to right.
pub(super) fn in_order<'r>(parts: impl Iterator<Item = &'r Run> + Clone, rows: usize) -> Vec<Run> {
    PerRow::grouped(rows, parts.map(|run| (run.row as usize, run.clone()))).into_items()
}

/// Runs, given in the order of the rows, joined where they touch: voids, the largest first, and peaks, the highest
/// first.
pub(super) fn patches(runs: &[Run], grid: &Grid, layer: &Layer, nominal: &Nominal) -> (Vec<Patch>, Vec<Patch>) {
    let mut parents: Vec<u32> = (0..runs.len() as u32).collect();
    // Both rows are traversed once: each run is compared with those of the row before, up to the last that overlaps it.
    let (mut row_start, mut last_row) = (0, 0..0);
    for i in 0..runs.len() {
        if runs[i].row != runs[row_start].row {
            let touching = runs[row_start].row + 1 == runs[i].row;
            last_row = if touching { row_start..i } else { i..i };
            row_start = i;
        }
        while last_row.start < last_row.end && runs[last_row.start].columns.end < runs[i].columns.start {
            last_row.start += 1;
        }
        // The previous run continues in this one if a section of the layer ends between them.
        let before = (row_start < i && runs[i - 1].columns.end == runs[i].columns.start).then(|| i - 1);
        let above = last_row.clone().take_while(|&j| runs[j].columns.start <= runs[i].columns.end);
        for j in before.into_iter().chain(above) {
            if runs[j].overfilled == runs[i].overfilled {
                let (a, b) = (root(&mut parents, i), root(&mut parents, j));
                parents[a.max(b)] = a.min(b) as u32;
            }
        }
    }
    let cell = grid.step * grid.step;
    // The first run of a patch is its root.
    let mut found: Vec<(bool, Patch)> = Vec::new();
    let mut patch_of = vec![0; runs.len()];
    for (i, run) in runs.iter().enumerate() {
        let area = run.columns.len() as f64 * cell;
        let (place, height) = (grid.place(run.at as usize, run.row as usize), run.extreme);
        let first = root(&mut parents, i);
        if first == i {
            patch_of[i] = found.len();
            found.push((run.overfilled, Patch { layer: layer.index, place, height, area, cause: None }));
            continue;
        }
        let (overfilled, known) = &mut found[patch_of[first]];
        known.area += area;
        if (height > known.height) == *overfilled {
            (known.place, known.height) = (place, height);
        }
    }
    let (mut peaks, mut voids): (Vec<_>, Vec<_>) = found.into_iter().partition(|(overfilled, _)| *overfilled);
    voids.sort_by(|a, b| b.1.area.total_cmp(&a.1.area));
    peaks.sort_by(|a, b| b.1.height.total_cmp(&a.1.height));
    let plain = |(_, patch)| patch;
    let explained = |(_, patch): (bool, Patch)| Patch { cause: cause(patch.place, &layer.passes, nominal), ..patch };
    // Causes are looked up only for the peaks that are reported.
    let rest = peaks.split_off(peaks.len().min(TOLD_PEAKS));
    let peaks = peaks.into_iter().map(explained).chain(rest.into_iter().map(plain)).collect();
    (voids.into_iter().map(plain).collect(), peaks)
}

/// How many of the highest peaks of a layer get a cause.
const TOLD_PEAKS: usize = 32;

fn root(parents: &mut [u32], i: usize) -> usize {
    let mut i = i as u32;
    while parents[i as usize] != i {
        let parent = parents[parents[i as usize] as usize];
        parents[i as usize] = parent;
        i = parent;
    }
    i as usize
}

/// A turn sharper than this piles up metal on its inner side: cos 30°.
const SHARP: f64 = 0.866;

/// The nearest start, end or sharp turn within half a bead; otherwise, whether one or several passes come that near.
fn cause(place: DVec2, passes: &[Pass], nominal: &Nominal) -> Option<Cause> {
    let reach = nominal.bead.width / 2.0;
    let mut nearest = (reach, None);
    let mut near = |p: DVec2, cause: Cause| {
        let distance = p.distance(place);
        if distance < nearest.0 {
            nearest = (distance, Some(cause));
        }
    };
    let mut passes_near = 0;
    for pass in passes {
        let beside = pass.segments().any(|s| {
            let (a, b) = (s.from.truncate(), s.to.truncate());
            // Nearly all pieces are farther away than that in y alone.
            (a.y.min(b.y) - reach..a.y.max(b.y) + reach).contains(&place.y)
                && planar::polyline::distance_squared_to_segment(place, a, b) < reach * reach
        });
        if !beside {
            continue;
        }
        let points: Vec<DVec2> = pass.points.iter().map(|p| p.truncate()).collect();
        passes_near += 1;
        if !pass.closed {
            points.first().into_iter().for_each(|p| near(*p, Cause::Start));
            points.last().into_iter().for_each(|p| near(*p, Cause::End));
        }
        let turn = if pass.kind == PassKind::Infill { Cause::Link } else { Cause::Corner };
        for corner in points.windows(3) {
            let (a, b) = ((corner[1] - corner[0]).normalize_or_zero(), (corner[2] - corner[1]).normalize_or_zero());
            if a.dot(b) < SHARP {
                near(corner[1], turn);
            }
        }
    }
    nearest.1.or(match passes_near {
        0 => None,
        1 => Some(Cause::Closeness),
        _ => Some(Cause::Junction),
    })
}
