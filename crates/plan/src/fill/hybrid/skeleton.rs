//! The fill of the skeleton regions: the areas left between the contours.
//!
//! Let T be the contours and links already laid. The fill covers P₀ less everything within d2 of T, so that skeleton
//! fill and contours keep exactly d2. Narrow pieces get beads along their [medial axis](super::medial); wide ones, and
//! in the paper all, get a zigzag aligned with their smallest rectangle.

use super::{ScanAlong, medial};
use crate::fill::line_index::LineIndex;
use crate::fill::{FillSettings, Path, coverage, zigzag};
use crate::pass::Along;
use glam::DVec2;
use planar::polyline::{length, without_end};
use planar::{Join, Polygon, Region, buffer, min_area_rect};

/// The neighbourhood of contours is accurate to this fraction of a bead width.
const BUFFER: f64 = 0.01;
/// Rounds of filling: at forks and where the number of beads changes, the first round leaves space for more.
const ROUNDS: usize = 3;

/// The passes of all skeleton regions. `contours` are the joined contours, already laid.
pub fn fill(outermost: &Region, regions: &Region, contours: &[Path], settings: &FillSettings) -> Vec<Path> {
    let mut free = room(outermost, contours, settings);
    let mut laid = LineIndex::new(settings.stepover);
    contours.iter().for_each(|pass| laid.add_line(0, &pass.path()));
    let mut passes = Vec::new();
    for _ in 0..if settings.hybrid.literal { 1 } else { ROUNDS } {
        let more = fill_room(&free, outermost, regions, &mut laid, settings);
        if more.is_empty() {
            break;
        }
        free = room(&free, &more, settings);
        passes.extend(more);
    }
    passes
}

fn fill_room(
    free: &Region,
    outermost: &Region,
    regions: &Region,
    laid: &mut LineIndex,
    settings: &FillSettings,
) -> Vec<Path> {
    let mut passes = Vec::new();
    for piece in free.polygons() {
        // Thin walls leave long pieces with hardly any area.
        let long = piece.outer.length() >= 2.0 * settings.min_pass_length;
        if piece.area() < settings.hybrid.min_pocket_area && !long {
            continue;
        }
        if settings.hybrid.literal {
            // The paper fills only its regions.
            let near = regions.offset(settings.stepover, Join::ROUND).intersection(&piece.clone().into());
            near.polygons().iter().for_each(|p| passes.extend(scanned(p, settings)));
        } else if is_narrow(piece, settings) {
            passes.extend(medial::beads(piece, outermost, laid, settings));
        } else {
            // The zigzag keeps d2.
            let inner = piece.offset(settings.hybrid.least_gap - settings.hybrid.skeleton_gap, Join::ROUND);
            let scanned: Vec<Path> = inner.polygons().iter().flat_map(|p| scanned(p, settings)).collect();
            scanned.iter().for_each(|pass| laid.add_line(0, &pass.path()));
            passes.extend(scanned);
        }
    }
    passes
}

/// Distance of the fill from the contours.
fn gap(settings: &FillSettings) -> f64 {
    if settings.hybrid.literal { settings.hybrid.skeleton_gap } else { settings.hybrid.least_gap }
}

/// Where centre-lines of the fill may lie: the free region less the neighbourhood of the laid passes.
fn room(free: &Region, laid: &[Path], settings: &FillSettings) -> Region {
    let gap = gap(settings);
    let (closed, open): (Vec<&Path>, Vec<&Path>) = laid.iter().partition(|pass| pass.closed);
    let closed: Vec<Vec<DVec2>> = closed.into_iter().map(|pass| pass.points.clone()).collect();
    let open: Vec<Vec<DVec2>> =
        open.into_iter().map(|pass| shortened(&pass.points, settings.hybrid.end_overlap)).collect();
    let tolerance = BUFFER * settings.bead.width;
    free.difference(&buffer(&closed, true, gap, tolerance)).difference(&buffer(&open, false, gap, tolerance))
}

/// A line without its ends: the fill may come closer there.
fn shortened(points: &[DVec2], by: f64) -> Vec<DVec2> {
    if length(points) < 4.0 * by {
        return points.to_vec();
    }
    let mut line = without_end(points.to_vec(), by);
    line.reverse();
    without_end(line, by)
}

/// Whether a piece is nowhere wider than regions that get beads along their axis.
fn is_narrow(piece: &Polygon, settings: &FillSettings) -> bool {
    // The contours lie a gap beyond its edge on both sides.
    let inner = settings.hybrid.region_width / 2.0 - settings.hybrid.least_gap;
    !piece.holds_disc(inner.max(0.0))
}

/// A zigzag along the smallest rectangle of a piece.
fn scanned(piece: &Polygon, settings: &FillSettings) -> Vec<Path> {
    let Some(rect) = min_area_rect(piece.outer.points()) else { return Vec::new() };
    let x = rect.axis.to_angle();
    let (short, long) = if rect.size.x < rect.size.y { (x, x + 0.25 * TURN) } else { (x + 0.25 * TURN, x) };
    let at = |angle: f64| {
        let turned = FillSettings { raster_angle: angle, ..*settings };
        zigzag::zigzag(&piece.clone().into(), &turned)
    };
    match settings.hybrid.scan_along {
        ScanAlong::Short | ScanAlong::Auto if settings.hybrid.literal => varied(at, short, piece, settings),
        ScanAlong::Long if settings.hybrid.literal => varied(at, long, piece, settings),
        ScanAlong::Short => at(short),
        ScanAlong::Long => at(long),
        ScanAlong::Auto => {
            let (a, b) = (at(short), at(long));
            let cost = |passes: &[Path]| (passes.len(), passes.iter().map(|p| p.points.len()).sum::<usize>());
            if cost(&a) <= cost(&b) { a } else { b }
        }
    }
}

/// Angles between the zigzags that are compared and the side of the rectangle, °.
const LEANS: [f64; 9] = [0.0, -5.0, 5.0, -10.0, 10.0, -15.0, 15.0, -20.0, 20.0];
/// How many of the best alternate from layer to layer.
const TAKE_TURNS: usize = 3;
/// A bead is higher than 0.35 of its height, the deposit model's limit for a void, over this fraction of its width.
const HIGH: f64 = 0.8;

/// A zigzag roughly parallel to a side, at a different angle on successive layers: turns and ends above each other on
/// all layers would grow into towers. Of those with the fewest passes, the ones that leave least bare alternate.
fn varied(zigzag: impl Fn(f64) -> Vec<Path>, side: f64, piece: &Polygon, settings: &FillSettings) -> Vec<Path> {
    let high = HIGH * settings.bead.width;
    // The beads of the contours end here.
    let open = piece.offset(settings.hybrid.skeleton_gap - high / 2.0, Join::ROUND);
    let bare = |passes: &[Path]| {
        let narrow = passes.iter().map(|pass| Path { width: Along::Same(high), ..pass.clone() }).collect::<Vec<_>>();
        coverage::bare(&narrow.iter().collect::<Vec<_>>(), &open, settings.bead.width).area
    };
    let angles = LEANS.iter().flat_map(|lean| [0.0, 0.5 * TURN].map(|back| side + lean.to_radians() + back));
    let mut tried: Vec<(usize, f64, Vec<Path>)> =
        angles.map(&zigzag).map(|passes| (passes.len(), bare(&passes), passes)).collect();
    tried.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let fewest = tried.iter().take_while(|(count, ..)| *count == tried[0].0).count();
    tried.swap_remove(settings.layer % TAKE_TURNS.min(fewest)).2
}

const TURN: f64 = std::f64::consts::TAU;
