//! The steps of a strategy, drawn over its beads.

use super::pen::Pen;
use crate::steps::Steps;
use crate::theme::ink;
use beadwright::fill::{hybrid, one_loop};
use beadwright::palette;
use beadwright::pass::PassKind;
use eframe::egui::{Align2, Color32, FontId, Pos2, Rect, Shape, Stroke, vec2};
use glam::DVec2;

/// Pockets; those that are filled in their own way have a thick outline.
const POCKET: Color32 = ink(palette::STEP);
/// Skeleton regions.
const REGION: Color32 = ink(palette::kind(PassKind::Skeleton));
/// Rings before they are joined.
const RING: Color32 = ink(palette::STEP);
/// Places where two rings become one.
const FLIP: Color32 = ink(palette::FLIP);

/// What the colours mean.
#[derive(Debug, Clone, Copy, Default)]
pub struct Named {
    /// Pockets that the plan keeps, pockets that it leaves to the contours, skeleton regions.
    pub hybrid: [&'static str; 3],
    /// Rings, flips.
    pub one_loop: [&'static str; 2],
}

impl Pen<'_> {
    pub(super) fn steps(&self, steps: &[Steps], named: &Named) {
        for steps in steps {
            match steps {
                Steps::Hybrid(steps) => self.regions(steps),
                Steps::Loop(steps, middle) => self.rings(steps, *middle),
            }
        }
        match steps.first() {
            Some(Steps::Hybrid(_)) => {
                let [kept, left, region] = named.hybrid;
                self.legend(&[(POCKET, 2.0, kept), (POCKET, 0.8, left), (REGION, 2.0, region)]);
            }
            Some(Steps::Loop(..)) => {
                let [rings, flips] = named.one_loop;
                self.legend(&[(RING, 1.5, rings), (FLIP, 6.0, flips)]);
            }
            None => {}
        }
    }

    fn regions(&self, steps: &hybrid::Steps) {
        for pocket in steps.levels.iter().flat_map(|level| &level.pockets) {
            let stroke = Stroke::new(if pocket.kept { 2.0 } else { 0.8 }, POCKET);
            self.ring(pocket.shape.outer.points(), stroke);
        }
        for ring in steps.regions.rings() {
            self.ring(ring.points(), Stroke::new(2.0, REGION));
        }
    }

    fn rings(&self, steps: &one_loop::Steps, middle: DVec2) {
        for ring in &steps.rings {
            let points: Vec<DVec2> = ring.points.iter().map(|point| *point + middle).collect();
            self.ring(&points, Stroke::new(1.5, RING));
        }
        for wall in &steps.split.thin {
            let points: Vec<Pos2> = wall.nodes.iter().map(|node| self.at(node.at + middle)).collect();
            self.painter.add(Shape::line(points, Stroke::new(1.5, RING)));
        }
        for flip in &steps.flips {
            self.painter.circle(self.at(*flip + middle), 4.0, FLIP, Stroke::new(1.0, Color32::BLACK));
        }
    }

    /// Lines of a colour and a width with their meaning, at the upper right.
    fn legend(&self, lines: &[(Color32, f32, &str)]) {
        const LINE: f32 = 16.0;
        let ink = self.ui.visuals().text_color();
        for (i, (colour, width, text)) in lines.iter().enumerate() {
            let right = self.rect.right_top() + vec2(-8.0, 14.0 + LINE * i as f32);
            let galley = self.painter.layout_no_wrap((*text).to_owned(), FontId::proportional(12.0), ink);
            let place = Align2::RIGHT_CENTER.anchor_size(right, galley.size());
            let ground = Rect::from_min_max(place.min - vec2(28.0, 1.0), place.max + vec2(4.0, 1.0));
            self.painter.rect_filled(ground, 0.0, self.ui.visuals().panel_fill.gamma_multiply(0.8));
            let from = place.left_center() - vec2(24.0, 0.0);
            self.painter.line_segment([from, from + vec2(18.0, 0.0)], Stroke::new(*width, *colour));
            self.painter.galley(place.min, galley, ink);
        }
    }
}
