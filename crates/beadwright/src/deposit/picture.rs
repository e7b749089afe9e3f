//! The height field as a small picture, for pages and for the studio.

use super::field::{Band, Grid};
use super::stroke::Nominal;
use super::{Mask, VOID};
use glam::DVec2;

/// A pixel without metal outside the outline.
pub const EMPTY: u8 = 0;
/// A pixel that holds a void.
pub const VOID_PIXEL: u8 = 1;
/// The lowest value that stands for a height; the highest, 255, is [`FULL_SCALE`] times the nominal bead height.
pub const FIRST_HEIGHT: u8 = 2;
/// The greatest height shown, in nominal bead heights.
pub const FULL_SCALE: f64 = 2.0;

/// One byte per pixel, the lowest row first: [`EMPTY`], [`VOID_PIXEL`], or a height from [`FIRST_HEIGHT`] on.
#[derive(Debug, Clone, PartialEq)]
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

/// Puts bands into a picture: each pixel is the mean of the grid points in it, void if one of them is.
pub(super) struct Canvas {
    grid: Grid,
    /// Grid points along a side of a pixel.
    side: usize,
}

/// Up to this height, mm, a grid point counts as without metal.
const NO_METAL: f64 = 1e-6;

impl Canvas {
    pub(super) fn new(grid: &Grid, pixels: usize) -> Self {
        Self { grid: *grid, side: grid.columns.max(grid.rows).div_ceil(pixels.max(1)).max(1) }
    }

    /// One byte for each grid point of a band.
    pub(super) fn paint(&self, band: &Band<'_>, mask: &Mask, nominal: &Nominal) -> Vec<u8> {
        let (h, columns) = (nominal.bead.height, band.grid.columns);
        let steps = f64::from(u8::MAX - FIRST_HEIGHT);
        let scale = steps / (h * FULL_SCALE);
        let value = |height: f64| FIRST_HEIGHT + (height * scale + 0.5).min(steps) as u8;
        let mut values: Vec<u8> =
            band.heights.iter().map(|&height| if height > NO_METAL { value(height) } else { EMPTY }).collect();
        for (row, heights) in band.rows() {
            let start = (row - band.first) * columns;
            for range in mask.core(band.grid, row) {
                let target = &mut values[start + range.start..start + range.end];
                for (value, _) in target.iter_mut().zip(&heights[range]).filter(|(_, height)| **height < VOID * h) {
                    *value = VOID_PIXEL;
                }
            }
        }
        values
    }

    /// The picture from the bands, the lowest first.
    pub(super) fn picture(&self, bands: impl Iterator<Item = Vec<u8>>) -> Picture {
        let (side, columns) = (self.side, self.grid.columns);
        let (width, height) = (columns.div_ceil(side), self.grid.rows.div_ceil(side));
        let mut sums = vec![(0_u32, 0_u32, false); width * height];
        for (row, values) in
            bands.flat_map(|band| band.chunks(columns.max(1)).map(<[u8]>::to_vec).collect::<Vec<_>>()).enumerate()
        {
            let line = &mut sums[row / side * width..][..width];
            for (points, (sum, count, void)) in values.chunks(side).zip(line) {
                for &value in points {
                    *void |= value == VOID_PIXEL;
                    *count += u32::from(value >= FIRST_HEIGHT);
                    *sum += u32::from(value.max(FIRST_HEIGHT) - FIRST_HEIGHT);
                }
            }
        }
        let pixel = |(sum, count, void): (u32, u32, bool)| match (void, count) {
            (true, _) => VOID_PIXEL,
            (false, 0) => EMPTY,
            _ => FIRST_HEIGHT + (sum / count) as u8,
        };
        let low = self.grid.place(0, 0) - self.grid.step / 2.0;
        let values = sums.into_iter().map(pixel).collect();
        Picture { low, pixel: side as f64 * self.grid.step, width, height, values }
    }
}
