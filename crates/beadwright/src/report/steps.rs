//! The steps of strategies on one layer as pictures: of the hybrid (figure 4 of Zhao et al. 2023) and of the loop.

use super::sketch::Sketch;
use crate::fill::FillSettings;
use crate::fill::hybrid::Steps;
use crate::fill::one_loop::{self, line::Line};
use crate::palette::{Rgb, SLICE, STEP, kind};
use crate::pass::PassKind;
use glam::DVec2;
use planar::{Bounds, Polygon, Region};

const CONTOUR: Rgb = kind(PassKind::Contour);
/// Pockets that are filled along their middle, and all else that is.
const KEPT: Rgb = kind(PassKind::Skeleton);
/// Pockets that are left to the contours.
const DROPPED: Rgb = [196, 201, 209];
/// Beads below the lines in their middle.
const BEAD: Rgb = [185, 210, 243];

/// Sketches with nothing but the slice, and the width of a thin line in them, mm.
fn begun(islands: &[Polygon], titles: [&'static str; 4]) -> ([Sketch; 4], f64) {
    let slice = Region::from_normalised(islands.to_vec());
    let bounds = slice.bounds().unwrap_or(Bounds { min: DVec2::ZERO, max: DVec2::ONE });
    let mut sketches = titles.map(|title| Sketch::new(bounds, title));
    for sketch in &mut sketches {
        sketch.region(&slice, SLICE);
    }
    (sketches, 0.004 * bounds.size().max_element())
}

/// Contours with their pockets (green: those that are kept), skeleton regions, the contours left (pink: those that
/// were cut), and the passes.
pub(crate) fn sketches(islands: &[Polygon], settings: &FillSettings) -> [Sketch; 4] {
    let titles = ["1. Contours and their pockets", "2. Skeleton regions", "3. Contours, cut", "4. Passes"];
    let (mut sketches, thin) = begun(islands, titles);
    for island in islands {
        draw(&Steps::of(island, settings), &mut sketches, thin);
    }
    sketches
}

fn draw(steps: &Steps, sketches: &mut [Sketch; 4], thin: f64) {
    let [pockets, regions, cut, passes] = sketches;
    for level in &steps.levels {
        for (kept, colour) in [(false, DROPPED), (true, KEPT)] {
            let chosen = level.pockets.iter().filter(|p| p.kept == kept).map(|p| p.shape.clone());
            pockets.region(&Region::from_normalised(chosen.collect()), colour);
        }
        for ring in level.region.rings() {
            pockets.line(ring.points(), true, CONTOUR, thin / 2.0);
        }
    }
    regions.region(&steps.regions, KEPT);
    for (_, ring) in &steps.contours.complete {
        cut.line(ring.points(), true, CONTOUR, thin);
    }
    for piece in &steps.contours.incomplete {
        cut.line(&piece.points, false, STEP, thin);
    }
    for (list, colour) in [(&steps.skeleton, KEPT), (&steps.chains, CONTOUR)] {
        for pass in list {
            passes.line(&pass.points, pass.closed, colour, thin);
        }
    }
}

/// Rings and single-bead walls, rings joined (with the places of their flips), the relaxed lines, and the passes at
/// their true width.
pub(crate) fn loop_sketches(islands: &[Polygon], settings: &FillSettings) -> [Sketch; 4] {
    let titles = ["1. Rings, and walls for one bead", "2. Rings joined by flips", "3. Relaxed", "4. Passes"];
    let (mut sketches, thin) = begun(islands, titles);
    for (steps, middle) in islands.iter().flat_map(|island| one_loop::steps(island, settings)) {
        draw_loop(&steps, middle, &mut sketches, thin);
    }
    sketches
}

fn draw_loop(steps: &one_loop::Steps, middle: DVec2, sketches: &mut [Sketch; 4], thin: f64) {
    let placed = |points: &[DVec2]| points.iter().map(|p| *p + middle).collect::<Vec<_>>();
    let [rings, joined, relaxed, laid] = sketches;
    for ring in &steps.rings {
        rings.line(&placed(&ring.points), true, CONTOUR, thin);
    }
    for wall in &steps.split.thin {
        let points: Vec<DVec2> = wall.nodes.iter().map(|node| node.at).collect();
        rings.line(&placed(&points), false, KEPT, thin);
    }
    let all = |sketch: &mut Sketch, lines: &[Line]| {
        for line in lines {
            sketch.line(&placed(&line.points), line.closed, CONTOUR, thin);
        }
    };
    all(joined, &steps.joined);
    for flip in &steps.flips {
        joined.line(&placed(&[*flip - DVec2::X * thin, *flip + DVec2::X * thin]), false, STEP, 4.0 * thin);
    }
    all(relaxed, &steps.relaxed);
    for (a, b, width) in steps.lines.iter().flat_map(Line::pieces) {
        laid.line(&placed(&[a, b]), false, BEAD, width);
    }
    all(laid, &steps.lines);
}
