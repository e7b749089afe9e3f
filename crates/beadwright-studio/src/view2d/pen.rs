//! Draws a layer in the coordinates of the part.

use super::heat::{VOID, heat};
use super::{Drawing, Eye, Show};
use crate::theme;
use crate::view3d::palette;
use beadwright::deposit::picture;
use beadwright::layer::Layer;
use beadwright::pass::{PassKind, Segment};
use eframe::egui::{Align2, Color32, FontId, Painter, Pos2, Rect, Shape, Stroke, Ui, pos2, vec2};
use glam::DVec2;

/// The colour of a kind of pass.
fn colour(kind: PassKind) -> Color32 {
    theme::ink(palette::kind(kind))
}

/// Draws in the coordinates of the part.
pub(super) struct Pen<'a> {
    pub(super) painter: &'a Painter,
    pub(super) eye: Eye,
    pub(super) rect: Rect,
    pub(super) ui: &'a Ui,
}

impl Pen<'_> {
    pub(super) fn at(&self, p: DVec2) -> Pos2 {
        self.eye.to_screen(p, self.rect)
    }

    pub(super) fn points(&self, length: f64) -> f32 {
        (length * self.eye.scale) as f32
    }

    /// A closed line, drawn as an open one that ends where it began: only those have limited mitres at their corners,
    /// and the sharp corners of slivers would otherwise become spikes across the view.
    pub(super) fn ring(&self, points: &[DVec2], stroke: Stroke) {
        /// Points closer than this on the screen are one: they have no direction.
        const SAME: f32 = 0.2;
        let mut line: Vec<Pos2> = points.iter().chain(points.first()).map(|p| self.at(*p)).collect();
        line.dedup_by(|b, a| a.distance(*b) < SAME);
        if let [only] = line[..] {
            self.painter.circle_filled(only, stroke.width / 2.0, stroke.color);
        }
        self.painter.add(Shape::line(line, stroke));
    }

    pub(super) fn outlines(&self, layer: &Layer) {
        let stroke = Stroke::new(1.2, self.ui.visuals().weak_text_color());
        for island in &layer.islands {
            self.ring(island.outer.points(), stroke);
            island.holes.iter().for_each(|hole| self.ring(hole.points(), stroke));
        }
    }

    /// The chosen pass along its path, and its piece, in the colour that they have in 3-D.
    pub(super) fn chosen(&self, subject: &Drawing<'_>) {
        let Some((pass, piece)) = subject.chosen else { return };
        let Some(pass) = subject.layer.passes.get(pass) else { return };
        let ink = theme::ink(palette::CHOSEN);
        let pieces = subject.pieces(pass).flat_map(|piece| [piece.from, piece.to]);
        let points = pieces.map(|p| self.at(p.truncate())).collect();
        self.painter.add(Shape::line(points, Stroke::new(2.5, ink)));
        if let Some(segment) = subject.pieces(pass).nth(piece) {
            let line = [segment.from, segment.to].map(|p| self.at(p.truncate()));
            self.painter.line_segment(line, Stroke::new(6.0, ink));
        }
    }

    pub(super) fn passes(&self, subject: &Drawing<'_>, show: Show) {
        let mut left = subject.pieces;
        let shown = subject.layer.passes.iter().map(|pass| {
            let pieces: Vec<_> = subject.pieces(pass).take(left).collect();
            left -= pieces.len();
            (pass.kind, pieces)
        });
        let shown: Vec<(PassKind, Vec<Segment>)> = shown.collect();
        // Beads would only hide the colours of the heights.
        if show.beads && !show.heights {
            for (i, (kind, pieces)) in shown.iter().enumerate() {
                self.bead(*kind, pieces, subject.chosen.is_some_and(|(pass, _)| pass == i));
            }
            self.outlines(subject.layer);
        }
        let (mut torch, weak) = (None, Stroke::new(1.0, self.ui.visuals().weak_text_color()));
        for (kind, pieces) in &shown {
            let (Some(first), Some(last)) = (pieces.first(), pieces.last()) else { break };
            let [start, end] = [first.from, last.to].map(|p| self.at(p.truncate()));
            if let (true, Some(from)) = (show.travels, torch) {
                self.painter.extend(Shape::dashed_line(&[from, start], weak, 5.0, 4.0));
            }
            if show.paths {
                let ink = if show.heights { Color32::BLACK } else { colour(*kind) };
                let points = pieces.iter().map(|s| s.to).map(|p| self.at(p.truncate()));
                self.painter.add(Shape::line([start].into_iter().chain(points).collect(), Stroke::new(1.5, ink)));
            }
            if show.starts {
                self.painter.circle_filled(start, 3.5, theme::ink(palette::START));
                self.painter.circle_filled(end, 2.5, theme::ink(palette::END));
            }
            torch = Some(end);
        }
    }

    /// A bead in a pale colour that hides what lies below, with round ends and corners.
    fn bead(&self, kind: PassKind, pieces: &[Segment], chosen: bool) {
        /// Cosine of the smallest turn at which a corner would show a gap.
        const GAP: f64 = 0.995;
        let ground = self.ui.visuals().panel_fill;
        let ink = ground.lerp_to_gamma(colour(kind), if chosen { 0.8 } else { 0.4 });
        let way = |s: &Segment| (s.to - s.from).normalize_or_zero();
        for (i, s) in pieces.iter().enumerate() {
            let line = [s.from, s.to].map(|p| self.at(p.truncate()));
            let width = self.points(s.width);
            self.painter.line_segment(line, Stroke::new(width, ink));
            let before = i.checked_sub(1).map(|before| &pieces[before]);
            if before.is_none_or(|before| way(before).dot(way(s)) < GAP) {
                self.painter.circle_filled(line[0], width / 2.0, ink);
            }
            if i + 1 == pieces.len() {
                self.painter.circle_filled(line[1], width / 2.0, ink);
            }
        }
    }

    /// A scale bar: a line of a round length.
    pub(super) fn scale_bar(&self) {
        let longest = f64::from(self.rect.width()) / 5.0 / self.eye.scale;
        let power = 10_f64.powf(longest.log10().floor());
        let length = [5.0, 2.0, 1.0].into_iter().map(|f| f * power).find(|l| *l <= longest).unwrap_or(power);
        let ink = self.ui.visuals().text_color();
        let from = self.rect.left_bottom() + vec2(12.0, -14.0);
        let to = from + vec2(self.points(length), 0.0);
        self.painter.line_segment([from, to], Stroke::new(2.0, ink));
        self.painter.text(from, Align2::LEFT_BOTTOM, format!("{length} mm"), FontId::proportional(12.0), ink);
    }

    /// What the colours of heights mean, in nominal bead heights.
    pub(super) fn heat_scale(&self, caption: &str) {
        const STEPS: usize = 50;
        const MARKS: [f64; 3] = [0.0, 1.0, 2.0];
        let ink = self.ui.visuals().text_color();
        let place = Rect::from_min_size(self.rect.left_top() + vec2(12.0, 26.0), vec2(12.0, 120.0));
        let y = |height: f64| place.bottom() - place.height() * (height / picture::FULL_SCALE) as f32;
        for i in 0..STEPS {
            let height = |i: usize| picture::FULL_SCALE * i as f64 / STEPS as f64;
            let strip = Rect::from_x_y_ranges(place.x_range(), y(height(i + 1))..=y(height(i)));
            self.painter.rect_filled(strip, 0.0, heat(height(i)));
        }
        let font = FontId::proportional(12.0);
        for mark in MARKS {
            let at = pos2(place.right() + 4.0, y(mark));
            self.painter.text(at, Align2::LEFT_CENTER, format!("{mark:.0}"), font.clone(), ink);
        }
        self.painter.text(place.left_top() - vec2(0.0, 8.0), Align2::LEFT_BOTTOM, caption, font.clone(), ink);
        let patch = Rect::from_min_size(place.left_bottom() + vec2(0.0, 8.0), vec2(12.0, 12.0));
        self.painter.rect_filled(patch, 0.0, VOID);
        self.painter.text(patch.right_center() + vec2(4.0, 0.0), Align2::LEFT_CENTER, "< 0.35", font, ink);
    }

    pub(super) fn note(&self, corner: Align2, text: &str) {
        let place = corner.pos_in_rect(&self.rect.shrink(8.0));
        self.painter.text(place, corner, text, FontId::monospace(12.0), self.ui.visuals().text_color());
    }
}
