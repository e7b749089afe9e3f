//! Colours as people see them, with normal sight and without the red, green or blue cones; for tests of the pages and of the
//! studio.
#![allow(dead_code, unreachable_pub, reason = "each test file uses some of it")]

/// Red, green, blue, 0 to 255, as on the screen.
pub type Rgb = [u8; 3];

/// What is seen of linear red, green and blue: with normal sight, and by protanopes, deuteranopes and tritanopes
/// (Machado, Oliveira and Fernandes 2009, severity 1.0).
pub const SIGHTS: [[[f64; 3]; 3]; 4] = [
    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
    [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
    [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]],
    [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900]],
];

/// A colour as CIELAB (D65), as somebody sees it.
pub fn lab(rgb: Rgb, sight: &[[f64; 3]; 3]) -> [f64; 3] {
    let linear = rgb
        .map(|c| f64::from(c) / 255.0)
        .map(|c| if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) });
    let times = |row: &[f64; 3], v: &[f64; 3]| row.iter().zip(v).map(|(a, b)| a * b).sum::<f64>();
    let seen = sight.map(|row| times(&row, &linear).clamp(0.0, 1.0));
    let white = [[0.4124, 0.3576, 0.1805, 0.95047], [0.2126, 0.7152, 0.0722, 1.0], [0.0193, 0.1192, 0.9505, 1.08883]];
    let [x, y, z] = white
        .map(|[r, g, b, w]| times(&[r, g, b], &seen) / w)
        .map(|t| if t > 0.008856 { t.cbrt() } else { 7.787 * t + 16.0 / 116.0 });
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// How different two colours look to somebody: the distance in CIELAB.
pub fn difference(a: Rgb, b: Rgb, sight: &[[f64; 3]; 3]) -> f64 {
    let (a, b) = (lab(a, sight), lab(b, sight));
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
}
