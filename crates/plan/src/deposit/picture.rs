//! The height field as a small picture, for reports and the studio.

use super::field::{Band, Grid, Height};
use super::patch::Run;
use super::ridges::Ridges;
use super::stroke::Nominal;
use super::tiles::Square;
use glam::DVec2;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// A pixel without metal outside the outline.
pub const EMPTY: u8 = 0;
/// A pixel that holds a void.
pub const VOID_PIXEL: u8 = 1;
/// The lowest value that represents a height; the highest, 255, is [`FULL_SCALE`] times the nominal bead height.
pub const FIRST_HEIGHT: u8 = 2;
/// The greatest height shown, in nominal bead heights.
pub const FULL_SCALE: f64 = 2.0;

/// One byte per pixel, the lowest row first: [`EMPTY`], [`VOID_PIXEL`], or a height from [`FIRST_HEIGHT`] on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Picture {
    /// Lower left corner of the lowest pixel, mm.
    pub low: DVec2,
    /// Side of a pixel, mm.
    pub pixel: f64,
    /// Pixels in x.
    pub width: usize,
    /// Pixels in y.
    pub height: usize,
    /// The pixels.
    pub values: Vec<u8>,
}

/// Renders a layer into a picture: each pixel is the mean of its grid points with metal, or void if any of them is.
pub(super) struct Canvas {
    grid: Grid,
    /// Grid points along a side of a pixel.
    side: usize,
    /// Height per unit of a pixel's value, mm.
    unit: f64,
}

/// Up to this height, mm, a grid point counts as empty.
const NO_METAL: f64 = 1e-6;
/// Number of height values of a pixel, above [`FIRST_HEIGHT`].
const STEPS: f32 = (u8::MAX - FIRST_HEIGHT) as f32;

/// A pixel being accumulated.
#[derive(Debug, Clone, Copy, Default)]
struct Pixel {
    /// Sum of the heights, in units of the canvas.
    sum: f32,
    points: u32,
    void: bool,
}

impl Canvas {
    pub(super) fn new(grid: &Grid, pixels: usize, nominal: &Nominal) -> Self {
        let side = grid.columns.max(grid.rows).div_ceil(pixels.max(1)).max(1);
        Self { grid: *grid, side, unit: nominal.bead.height * FULL_SCALE / f64::from(STEPS) }
    }

    /// Grid points along a side of a pixel.
    pub(super) fn side(&self) -> usize {
        self.side
    }

    fn width(&self) -> usize {
        self.grid.columns.div_ceil(self.side)
    }

    /// The pixels covering some rows, still empty.
    pub(super) fn strip(&self, rows: Range<usize>) -> Strip {
        let lines = rows.start / self.side..rows.end.div_ceil(self.side);
        Strip { pixels: vec![Pixel::default(); lines.len() * self.width()], first: lines.start }
    }

    /// Adds the points of a band, and the voids in it.
    pub(super) fn paint<H: Height>(&self, strip: &mut Strip, band: &Band<'_, H>, runs: &[Run]) {
        let (metal, scale, width) = (H::of(NO_METAL), (1.0 / self.unit) as f32, band.columns.len());
        let rows = band.first..band.first + band.heights.len() / width.max(1);
        let (mut sums, mut points) = (vec![0.0_f32; width], vec![0_u32; width]);
        for (_, lines) in self.pixels(&rows) {
            // Down the columns first: these sums run in parallel.
            sums.fill(0.0);
            points.fill(0);
            for heights in lines.clone().map(|row| &band.heights[(row - band.first) * width..][..width]) {
                for ((sum, points), &height) in sums.iter_mut().zip(&mut points).zip(heights) {
                    *sum += (height.mm() as f32 * scale).min(STEPS);
                    *points += u32::from(height > metal);
                }
            }
            let line = self.line(strip, lines.start);
            for (pixel, columns) in self.pixels(&band.columns) {
                let columns = columns.start - band.columns.start..columns.end - band.columns.start;
                line[pixel].sum += sums[columns.clone()].iter().sum::<f32>();
                line[pixel].points += points[columns].iter().sum::<u32>();
            }
        }
        self.paint_voids(strip, runs);
    }

    fn paint_voids(&self, strip: &mut Strip, runs: &[Run]) {
        for run in runs.iter().filter(|run| !run.overfilled) {
            let line = self.line(strip, run.row as usize);
            let columns = run.columns.start as usize..run.columns.end as usize;
            self.pixels(&columns).for_each(|(pixel, _)| line[pixel].void = true);
        }
    }

    /// Adds a square of ridges, and the voids in it.
    pub(super) fn paint_ridges(&self, strip: &mut Strip, square: &Square, ridges: &Ridges, runs: &[Run]) {
        self.paint_voids(strip, runs);
        let middle = |range: &Range<usize>| 0.5 * (range.start + range.end - 1) as f64;
        let center = DVec2::new(middle(&square.columns), middle(&square.rows));
        let (mean, scale) = (ridges.means(self.side as f64 * self.grid.step), (1.0 / self.unit) as f32);
        for (_, rows) in self.pixels(&square.rows) {
            let line = self.line(strip, rows.start);
            for (pixel, columns) in self.pixels(&square.columns) {
                let from_center = DVec2::new(middle(&columns), middle(&rows)) - center;
                let across = square.along.perp_dot(from_center) * self.grid.step;
                let points = rows.len() * columns.len();
                line[pixel].sum += points as f32 * (mean(across) * scale).min(STEPS);
                line[pixel].points += points as u32;
            }
        }
    }

    fn line<'a>(&self, strip: &'a mut Strip, row: usize) -> &'a mut [Pixel] {
        let at = (row / self.side - strip.first) * self.width();
        &mut strip.pixels[at..at + self.width()]
    }

    /// The pixels that cover some rows or columns of the grid, each with the range that it covers.
    fn pixels(&self, points: &Range<usize>) -> impl Iterator<Item = (usize, Range<usize>)> + use<> {
        let (side, points) = (self.side, points.clone());
        let within = move |pixel: usize| (pixel * side).max(points.start)..(pixel * side + side).min(points.end);
        let pixels = points.start / side..points.end.div_ceil(side);
        pixels.map(move |pixel| (pixel, within(pixel)))
    }

    /// The picture from strips, the lowest first.
    pub(super) fn picture(&self, strips: impl Iterator<Item = Strip>) -> Picture {
        let (width, height) = (self.width(), self.grid.rows.div_ceil(self.side));
        let mut pixels = vec![Pixel::default(); width * height];
        for strip in strips {
            for (pixel, more) in pixels[strip.first * width..].iter_mut().zip(strip.pixels) {
                pixel.sum += more.sum;
                pixel.points += more.points;
                pixel.void |= more.void;
            }
        }
        let value = |pixel: Pixel| match (pixel.void, pixel.points) {
            (true, _) => VOID_PIXEL,
            (false, 0) => EMPTY,
            (false, points) => FIRST_HEIGHT + (pixel.sum / points as f32 + 0.5).min(STEPS) as u8,
        };
        let low = self.grid.place(0, 0) - self.grid.step / 2.0;
        let values = pixels.into_iter().map(value).collect();
        Picture { low, pixel: self.side as f64 * self.grid.step, width, height, values }
    }
}

/// Some rows of a picture being accumulated.
pub(super) struct Strip {
    pixels: Vec<Pixel>,
    /// The picture row of the first pixel.
    first: usize,
}
