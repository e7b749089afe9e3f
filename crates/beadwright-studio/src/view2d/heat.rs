//! The colours of heights.

use beadwright::deposit::{Picture, picture};
use eframe::egui::{Color32, ColorImage};

/// The colour of a void.
pub(super) const VOID: Color32 = Color32::from_rgb(232, 0, 150);

/// Height in nominal bead heights, and its colour: as in the report.
const HEAT: [(f64, [f64; 3]); 7] = [
    (0.0, [38.0, 43.0, 92.0]),
    (0.35, [45.0, 104.0, 190.0]),
    (0.75, [150.0, 196.0, 226.0]),
    (1.0, [238.0, 240.0, 234.0]),
    (1.3, [250.0, 176.0, 84.0]),
    (1.6, [214.0, 62.0, 42.0]),
    (2.0, [110.0, 0.0, 22.0]),
];

/// The colour of a height, in nominal bead heights.
pub fn heat(height: f64) -> Color32 {
    let above = HEAT.iter().position(|(at, _)| *at >= height).unwrap_or(HEAT.len() - 1).max(1);
    let ((low, a), (high, b)) = (HEAT[above - 1], HEAT[above]);
    let part = ((height - low) / (high - low)).clamp(0.0, 1.0);
    let [r, g, b] = [0, 1, 2].map(|i| (a[i] + (b[i] - a[i]) * part).round() as u8);
    Color32::from_rgb(r, g, b)
}

/// The height in a pixel, in nominal bead heights; `None` where there is no metal, or a void.
pub fn height(value: u8) -> Option<f64> {
    let step = picture::FULL_SCALE / f64::from(u8::MAX - picture::FIRST_HEIGHT);
    value.checked_sub(picture::FIRST_HEIGHT).map(|v| f64::from(v) * step)
}

pub(super) fn image(map: &Picture) -> ColorImage {
    let pixel = |value: u8| match value {
        picture::EMPTY => Color32::TRANSPARENT,
        picture::VOID_PIXEL => VOID,
        value => height(value).map_or(Color32::TRANSPARENT, heat),
    };
    // The height picture starts with its lowest row, an image with its highest.
    let rows = map.values.chunks(map.width.max(1)).rev();
    ColorImage::new([map.width, map.height], rows.flatten().map(|v| pixel(*v)).collect())
}
