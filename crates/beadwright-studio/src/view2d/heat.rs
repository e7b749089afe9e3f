//! The colours of heights.

use crate::theme::ink;
use beadwright::deposit::{Picture, picture};
use beadwright::palette;
use eframe::egui::{Color32, ColorImage};

/// The colour of a void.
pub(super) const VOID: Color32 = ink(palette::VOID);

/// The colour of a height, in nominal bead heights.
pub fn heat(height: f64) -> Color32 {
    ink(palette::height(height))
}

/// The height in a pixel, in nominal bead heights; `None` where there is no metal, or a void.
pub fn height(value: u8) -> Option<f64> {
    let step = picture::FULL_SCALE / f64::from(u8::MAX - picture::FIRST_HEIGHT);
    value.checked_sub(picture::FIRST_HEIGHT).map(|v| f64::from(v) * step)
}

/// A picture of heights; empty where there is no metal.
pub(crate) fn image(map: &Picture) -> ColorImage {
    let pixel = |value: u8| match value {
        picture::EMPTY => Color32::TRANSPARENT,
        picture::VOID_PIXEL => VOID,
        value => height(value).map_or(Color32::TRANSPARENT, heat),
    };
    // The height picture starts with its lowest row, an image with its highest.
    let rows = map.values.chunks(map.width.max(1)).rev();
    ColorImage::new([map.width, map.height], rows.flatten().map(|v| pixel(*v)).collect())
}
