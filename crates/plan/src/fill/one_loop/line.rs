//! Centre-lines with a width for each of their pieces.

use super::LoopSettings;
use super::room::Room;
use glam::DVec2;

/// Extra distance that beads keep from the outline, in bead widths, to allow for what the lattice does not resolve.
const MARGIN: f64 = 5e-4;
/// A bead edge closer to the outline than this, in bead widths, is moved onto it.
const SNAP: f64 = 0.05;
/// Greatest move of an edge at a time, in bead widths.
const MOST: f64 = 0.2;

/// A centre-line.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Line {
    /// Its points; the first one of a closed line is not repeated.
    pub points: Vec<DVec2>,
    /// Bead width of the piece after each point, mm; the last value of an open line is unused.
    pub widths: Vec<f64>,
    /// Whether the piece after each point lies in a wall for one bead.
    pub thin: Vec<bool>,
    /// Whether it ends where it began.
    pub closed: bool,
}

impl Line {
    /// A ring whose widths are not known yet.
    pub fn ring(points: Vec<DVec2>) -> Self {
        let (widths, thin) = (vec![0.0; points.len()], vec![false; points.len()]);
        Self { points, widths, thin, closed: true }
    }

    /// Number of pieces.
    pub fn count(&self) -> usize {
        if self.closed { self.points.len() } else { self.points.len().saturating_sub(1) }
    }

    /// Index of the point before `i`; at the first point of an open line, `i` itself.
    pub fn before(&self, i: usize) -> usize {
        match i.checked_sub(1) {
            Some(before) => before,
            None if self.closed => self.points.len() - 1,
            None => 0,
        }
    }

    /// Index of the point after `i`; at the last point of an open line, `i` itself.
    pub fn behind(&self, i: usize) -> usize {
        match i + 1 {
            behind if behind < self.points.len() => behind,
            _ if self.closed => 0,
            _ => i,
        }
    }

    /// Whether the point is an end of an open line.
    pub fn is_end(&self, i: usize) -> bool {
        !self.closed && (i == 0 || i + 1 == self.points.len())
    }

    /// The pieces: from, to, width.
    pub fn pieces(&self) -> impl Iterator<Item = (DVec2, DVec2, f64)> + '_ {
        (0..self.count()).map(|i| (self.points[i], self.points[self.behind(i)], self.widths[i]))
    }

    /// Length, mm.
    pub fn length(&self) -> f64 {
        self.pieces().fold(0.0, |sum, (a, b, _)| sum + a.distance(b))
    }

    /// Half the width of the wider of the pieces before and after a point, mm.
    pub fn half_width(&self, i: usize) -> f64 {
        let last = self.count().saturating_sub(1);
        self.widths[i.min(last)].max(self.widths[self.before(i).min(last)]) / 2.0
    }

    /// The direction of the line at a point.
    pub fn way(&self, i: usize) -> DVec2 {
        (self.points[self.behind(i)] - self.points[self.before(i)]).normalize_or_zero()
    }

    /// The same line with its points evenly spaced, about `step` (mm) apart.
    #[must_use]
    pub fn resampled(&self, step: f64) -> Self {
        let length = self.length();
        let pieces = ((length / step).round() as usize).max(if self.closed { 6 } else { 1 });
        let count = if self.closed { pieces } else { pieces + 1 };
        let mut line = Self { closed: self.closed, ..Self::default() };
        let size = |i: usize| self.points[i].distance(self.points[self.behind(i)]);
        let (mut along, mut i) = (0.0, 0);
        for k in 0..count {
            let at = length * k as f64 / pieces as f64;
            while i + 1 < self.count() && along + size(i) < at {
                along += size(i);
                i += 1;
            }
            let share = if size(i) > 0.0 { ((at - along) / size(i)).clamp(0.0, 1.0) } else { 0.0 };
            line.points.push(self.points[i].lerp(self.points[self.behind(i)], share));
            line.widths.push(self.widths[i]);
            line.thin.push(self.thin[i]);
        }
        line
    }

    /// Each value averaged with its two neighbours along the line, weighted 1 : 2 : 1.
    pub fn smoothed<T>(&self, values: &[T]) -> Vec<T>
    where
        T: Copy + std::ops::Add<Output = T> + std::ops::Mul<f64, Output = T>,
    {
        (0..values.len()).map(|i| values[i] * 0.5 + (values[self.before(i)] + values[self.behind(i)]) * 0.25).collect()
    }

    /// Widths of the pieces, averaged over `length` (mm) along the line.
    pub fn smooth_widths(&self, length: f64) -> Vec<f64> {
        let (n, count) = (self.points.len(), self.count());
        let mean = self.length() / count.max(1) as f64;
        let half = ((length / 2.0 / mean).round() as usize).min(count / 3);
        let smooth = |i: usize| {
            let around = |k: usize| match self.closed {
                true => self.widths[(i + 2 * n + k - half) % n],
                false => self.widths[(i + k).saturating_sub(half).min(count - 1)],
            };
            (0..=2 * half).map(around).sum::<f64>() / (2 * half + 1) as f64
        };
        (0..count).map(smooth).collect()
    }

    /// The points, the first one repeated at the end of a closed line.
    pub fn path(&self) -> Vec<DVec2> {
        self.points.iter().copied().chain(self.points.first().copied().filter(|_| self.closed)).collect()
    }

    /// Pulls every point by the fraction `part` towards the midpoint of its neighbours; ends are fixed.
    pub fn tighten(&mut self, part: f64) {
        let middle = |i: usize| (self.points[self.before(i)] + self.points[self.behind(i)]) / 2.0;
        let drawn = |i: usize| if self.is_end(i) { self.points[i] } else { self.points[i].lerp(middle(i), part) };
        self.points = (0..self.points.len()).map(drawn).collect();
    }

    /// Moves points inwards if they are too close to the outline for the narrowest bead; in a wall, for half of the
    /// thinnest one.
    pub fn keep_inside(&mut self, room: &Room, settings: &LoopSettings) {
        for i in 0..self.points.len() {
            let narrowest = if self.thin[i] { settings.thinnest } else { settings.width_limits.0 };
            let least = narrowest / 2.0 + MARGIN * settings.bead_width;
            for _ in 0..4 {
                let lack = least - room.at(self.points[i]);
                if lack <= 0.0 {
                    break;
                }
                let inwards = room.inwards(self.points[i]);
                self.points[i] += inwards * lack.min(MOST * settings.bead_width);
            }
        }
    }

    /// Moves bead edges that extend beyond the outline, or just miss it, onto it; the other edge stays in place.
    pub fn meet_outline(&mut self, room: &Room, settings: &LoopSettings) {
        let w = settings.bead_width;
        let excess: Vec<f64> = (0..self.points.len())
            .map(|i| self.half_width(i) + MARGIN * w - room.at(self.points[i]))
            .map(|excess| if excess < -SNAP * w { 0.0 } else { excess.min(MOST * w) })
            .collect();
        for (point, excess) in self.points.iter_mut().zip(&excess).filter(|(_, excess)| **excess != 0.0) {
            *point += room.inwards(*point) * *excess / 2.0;
        }
        for i in 0..self.count() {
            let (low, high) = settings.limits(self.thin[i]);
            self.widths[i] = (self.widths[i] - (excess[i] + excess[self.behind(i)]) / 2.0).clamp(low, high);
        }
    }

    /// Narrows beads that would extend beyond the outline.
    pub fn fit_inside(&mut self, room: &Room, settings: &LoopSettings) {
        let room_at = |p: &DVec2| 2.0 * (room.at(*p) - MARGIN * settings.bead_width);
        let rooms: Vec<f64> = self.points.iter().map(room_at).collect();
        for i in 0..self.count() {
            let (low, high) = settings.limits(self.thin[i]);
            self.widths[i] = self.widths[i].min(rooms[i]).min(rooms[self.behind(i)]).clamp(low, high);
        }
    }
}
