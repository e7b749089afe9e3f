//! Where the eye is. The camera turns about a target, with z up.
//!
//! A positioner may hold what is seen in another position than it lies in. The eye then stays where it is in the cell;
//! all answers of the camera are in the coordinates of what is seen.

use beadwright::robot::Frame;
use glam::{DMat4, DVec2, DVec3};

/// Half the angle of view from top to bottom: 17.5°.
const HALF_VIEW_TAN: f64 = 0.315_299;

/// The fraction of the picture that a fitted box fills at most.
const FILL: f64 = 0.92;

/// Radians turned per point of pointer movement.
const TURN_PER_POINT: f64 = 0.008;

/// Standard views.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StandardView {
    /// From above, y up.
    Top,
    /// From −y.
    Front,
    /// From +y.
    Back,
    /// From −x.
    Left,
    /// From +x.
    Right,
    /// From above, in front, on the right.
    Iso,
}

/// The eye. Sizes and positions in the picture are in screen points from its upper left corner, y down.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    /// What it turns about, mm in the cell.
    pub target: DVec3,
    /// From the eye to the target, mm.
    pub distance: f64,
    /// Direction of the eye about z, from x, radians.
    pub yaw: f64,
    /// Elevation of the eye, −π/2 to π/2.
    pub pitch: f64,
    /// Whether the projection is parallel.
    pub orthographic: bool,
    /// How what is seen is held in the cell: its frame.
    pub held: Frame,
}

impl Default for Camera {
    fn default() -> Self {
        let (target, held) = (DVec3::ZERO, Frame::IDENTITY);
        let mut camera = Self { target, distance: 500.0, yaw: 0.0, pitch: 0.0, orthographic: false, held };
        camera.set_view(StandardView::Iso);
        camera
    }
}

impl Camera {
    /// From the target to the eye, of length 1.
    pub fn back(&self) -> DVec3 {
        let (sin, cos) = self.pitch.sin_cos();
        self.seen(DVec3::new(cos * self.yaw.cos(), cos * self.yaw.sin(), sin))
    }

    /// To the right in the picture.
    pub fn right(&self) -> DVec3 {
        self.seen(DVec3::new(-self.yaw.sin(), self.yaw.cos(), 0.0))
    }

    /// Up in the picture.
    pub fn up(&self) -> DVec3 {
        self.back().cross(self.right())
    }

    /// Straight up in the cell.
    pub fn sky(&self) -> DVec3 {
        self.seen(DVec3::Z)
    }

    /// A direction of the cell in the coordinates of what is seen.
    fn seen(&self, way: DVec3) -> DVec3 {
        self.held.rotation.conjugate() * way
    }

    /// The target, mm.
    fn middle(&self) -> DVec3 {
        self.held.inverse().apply(self.target)
    }

    /// The eye, mm.
    pub fn eye(&self) -> DVec3 {
        self.middle() + self.back() * self.distance
    }

    /// Height of the picture at the target, mm.
    pub fn height(&self) -> f64 {
        2.0 * self.distance * HALF_VIEW_TAN
    }

    /// From space to the clip space of the graphics card, depth reversed: 1 near, 0 far.
    pub fn clip_from_world(&self, size: DVec2) -> DMat4 {
        let aspect = size.x / size.y;
        let near = self.distance / 100.0;
        let view = DMat4::look_to_rh(self.eye(), -self.back(), self.up());
        if self.orthographic {
            // As deep behind the eye as in front of it, so that nothing is clipped.
            let (half, reach) = (self.height() / 2.0, 100.0 * self.distance + 4.0 * self.target.length());
            return DMat4::orthographic_rh(-half * aspect, half * aspect, -half, half, reach, -reach) * view;
        }
        DMat4::perspective_infinite_reverse_rh(2.0 * HALF_VIEW_TAN.atan(), aspect, near) * view
    }

    /// Where a point is seen; `None` behind the eye.
    pub fn project(&self, point: DVec3, size: DVec2) -> Option<DVec2> {
        let from_target = point - self.middle();
        let depth = self.distance - from_target.dot(self.back());
        if !self.orthographic && depth <= 1e-6 * self.distance {
            return None;
        }
        let scale = size.y / 2.0 / (HALF_VIEW_TAN * if self.orthographic { self.distance } else { depth });
        let (x, y) = (from_target.dot(self.right()), from_target.dot(self.up()));
        Some(DVec2::new(size.x / 2.0 + x * scale, size.y / 2.0 - y * scale))
    }

    /// The line of sight through a point of the picture: its origin and its unit direction.
    pub fn ray(&self, at: DVec2, size: DVec2) -> (DVec3, DVec3) {
        let on_plane = self.unproject(at, size);
        if self.orthographic {
            let reach = 100.0 * self.distance;
            return (on_plane + self.back() * reach, -self.back());
        }
        (self.eye(), (on_plane - self.eye()).normalize_or(-self.back()))
    }

    /// The point in the plane of the target seen at a point of the picture, mm.
    pub fn unproject(&self, at: DVec2, size: DVec2) -> DVec3 {
        let scale = self.height() / size.y;
        let (x, y) = ((at.x - size.x / 2.0) * scale, (size.y / 2.0 - at.y) * scale);
        self.middle() + self.right() * x + self.up() * y
    }

    /// Turns about the target, following a drag by this many points.
    pub fn orbit(&mut self, drag: DVec2) {
        const UPRIGHT: f64 = std::f64::consts::FRAC_PI_2;
        self.yaw = (self.yaw - drag.x * TURN_PER_POINT).rem_euclid(std::f64::consts::TAU);
        self.pitch = (self.pitch + drag.y * TURN_PER_POINT).clamp(-UPRIGHT, UPRIGHT);
    }

    /// Moves so that the target follows a drag by this many points.
    pub fn pan(&mut self, drag: DVec2, size: DVec2) {
        let scale = self.height() / size.y;
        self.target += self.held.rotation * ((self.up() * drag.y - self.right() * drag.x) * scale);
    }

    /// Moves `factor` times closer to a point, which keeps its position in the picture.
    pub fn zoom(&mut self, factor: f64, towards: DVec3) {
        let distance = (self.distance / factor).clamp(0.5, 1e6);
        let towards = self.held.apply(towards);
        self.target = towards + (self.target - towards) * (distance / self.distance);
        self.distance = distance;
    }

    /// Looks from a standard side; the target stays.
    pub fn set_view(&mut self, view: StandardView) {
        let (yaw, pitch): (f64, f64) = match view {
            StandardView::Top => (-90.0, 90.0),
            StandardView::Front => (-90.0, 0.0),
            StandardView::Back => (90.0, 0.0),
            StandardView::Left => (180.0, 0.0),
            StandardView::Right => (0.0, 0.0),
            StandardView::Iso => (-60.0, 32.0),
        };
        (self.yaw, self.pitch) = (yaw.to_radians(), pitch.to_radians());
    }

    /// Moves so that a point (mm) is in the middle of a picture of this height (mm); the direction stays.
    pub fn frame(&mut self, point: DVec3, height: f64) {
        self.target = self.held.apply(point);
        self.distance = height / (2.0 * HALF_VIEW_TAN);
    }

    /// Moves so that a box (lowest and highest corner, mm) fills the picture; the direction stays.
    pub fn fit(&mut self, (low, high): (DVec3, DVec3), size: DVec2) {
        let corners: [DVec3; 8] = std::array::from_fn(|i| {
            let pick = |axis: usize| if i >> axis & 1 == 0 { low[axis] } else { high[axis] };
            DVec3::new(pick(0), pick(1), pick(2))
        });
        self.fit_points(&corners, size);
    }

    /// Moves so that points (mm) fill the picture; the direction stays.
    pub fn fit_points(&mut self, points: &[DVec3], size: DVec2) {
        let in_cell = points.iter().map(|&p| self.held.apply(p));
        let bounds = in_cell.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(a, b), p| (a.min(p), b.max(p)));
        if !(bounds.0 + bounds.1).is_finite() {
            return;
        }
        self.target = (bounds.0 + bounds.1) / 2.0;
        // In perspective, the middle of a body is not in the middle of its image.
        for _ in 0..4 {
            self.distance = self.distance_to_see(points, size);
            let seen = points.iter().filter_map(|&c| self.project(c, size));
            let (first, last) = seen.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(a, b), p| (a.min(p), b.max(p)));
            if first.is_finite() && last.is_finite() {
                self.pan(size / 2.0 - (first + last) / 2.0, size);
            }
        }
        self.distance = self.distance_to_see(points, size);
    }

    /// The least distance at which all points are in the picture, mm.
    fn distance_to_see(&self, points: &[DVec3], size: DVec2) -> f64 {
        let tan = DVec2::new(size.x / size.y, 1.0) * HALF_VIEW_TAN * FILL;
        let middle = self.middle();
        let needed = points.iter().map(|&point| {
            let p = point - middle;
            let across = (p.dot(self.right()).abs() / tan.x).max(p.dot(self.up()).abs() / tan.y);
            across + if self.orthographic { 0.0 } else { p.dot(self.back()) }
        });
        needed.fold(1.0, f64::max)
    }
}
