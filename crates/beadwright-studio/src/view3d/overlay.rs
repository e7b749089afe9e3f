//! What is painted over the picture: the axes, a scale bar and the mark of a place.

use super::camera::Camera;
use crate::theme;
use beadwright::palette::AXES;
use eframe::egui::{Align2, Color32, FontId, Painter, Pos2, Rect, Stroke, Vec2, pos2, vec2};
use glam::DVec3;

/// Length of the axes, points.
const AXIS: f32 = 26.0;

/// Greatest length of the scale bar, points.
const LONGEST_BAR: f64 = 140.0;

/// Paints axes at the lower left, a caption next to them, and a scale bar at the lower right.
pub(super) fn paint(painter: &Painter, rect: Rect, camera: &Camera, caption: &str, dark: bool) {
    if rect.width() < 160.0 || rect.height() < 120.0 {
        return;
    }
    let ink = if dark { Color32::from_gray(200) } else { Color32::from_gray(60) };
    let corner = pos2(rect.left() + 48.0, rect.bottom() - 48.0);
    let ground = if dark { Color32::from_black_alpha(110) } else { Color32::from_white_alpha(150) };
    painter.circle_filled(corner, 40.0, ground);
    axes(painter, corner, camera, ink);
    let beside = pos2(rect.left() + 100.0, rect.bottom() - 12.0);
    // Elsewhere it would run into the scale bar.
    if rect.width() > 560.0 {
        painter.text(beside, Align2::LEFT_BOTTOM, caption, FontId::proportional(12.0), ink);
    }
    scale_bar(painter, rect, camera, ink);
}

/// Marks a place with a ring.
pub fn ring(painter: &Painter, at: Pos2, colour: Color32) {
    const RADIUS: f32 = 16.0;
    painter.circle_stroke(at, RADIUS, Stroke::new(5.0, Color32::from_black_alpha(140)));
    painter.circle_stroke(at, RADIUS, Stroke::new(3.0, colour));
}

fn axes(painter: &Painter, origin: Pos2, camera: &Camera, ink: Color32) {
    let mut axes = [
        (DVec3::X, "x", theme::ink(AXES[0])),
        (DVec3::Y, "y", theme::ink(AXES[1])),
        (DVec3::Z, "z", theme::ink(AXES[2])),
    ];
    // Nearest last, so that it is on top.
    axes.sort_by(|a, b| a.0.dot(camera.back()).total_cmp(&b.0.dot(camera.back())));
    for (axis, name, colour) in axes {
        let seen = vec2(axis.dot(camera.right()) as f32, -axis.dot(camera.up()) as f32);
        let tip = origin + seen * AXIS;
        painter.line_segment([origin, tip], Stroke::new(2.0, colour));
        painter.circle_filled(tip, 2.5, colour);
        // The name of an axis that points at the viewer is placed next to it.
        let beside = if seen.length() > 0.3 { seen.normalized() * 10.0 } else { vec2(9.0, -9.0) };
        painter.text(tip + beside, Align2::CENTER_CENTER, name, FontId::proportional(12.0), ink);
    }
}

fn scale_bar(painter: &Painter, rect: Rect, camera: &Camera, ink: Color32) {
    let per_point = camera.height() / f64::from(rect.height());
    let length = round_length(LONGEST_BAR * per_point);
    let points = (length / per_point) as f32;
    let right = pos2(rect.right() - 18.0, rect.bottom() - 18.0);
    let left = right - vec2(points, 0.0);
    let stroke = Stroke::new(1.5, ink);
    painter.line_segment([left, right], stroke);
    for end in [left, right] {
        painter.line_segment([end - Vec2::Y * 4.0, end + Vec2::Y * 4.0], stroke);
    }
    let text = if length >= 1000.0 { format!("{} m", length / 1000.0) } else { format!("{length} mm") };
    painter.text(left + vec2(points / 2.0, -5.0), Align2::CENTER_BOTTOM, text, FontId::proportional(12.0), ink);
}

/// The largest of 1, 2, 5, 10, 20 … that is not larger.
pub(super) fn round_length(length: f64) -> f64 {
    let power = 10.0_f64.powf(length.max(1e-9).log10().floor());
    let first = [5.0, 2.0, 1.0].into_iter().find(|first| first * power <= length).unwrap_or(1.0);
    if power < 1.0 { first / (1.0 / power).round() } else { first * power }
}
