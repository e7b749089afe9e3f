//! Handles at the foot of the part that move it on its plate and turn it about the vertical.

use super::camera::Camera;
use glam::{DVec2, DVec3};

/// Axes nearer to the line of sight than this (cosine of the angle to it) cannot be dragged: a pixel would be many mm.
const STEEPEST: f64 = 0.97;

/// Planes seen at a flatter angle than this (sine of the line of sight to them) cannot be dragged on.
const FLATTEST: f64 = 0.1;

/// A handle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Handle {
    /// Moves along x.
    X,
    /// Moves along y.
    Y,
    /// Turns about z.
    Turn,
}

/// How far a part is moved and turned.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Moved {
    /// Along x and y, mm.
    pub shift: DVec2,
    /// About the vertical through the foot, °, counterclockwise from above.
    pub turn: f64,
}

/// Where the handles are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gizmo {
    /// The middle of the part's extent, on its plate, mm.
    pub foot: DVec3,
    /// From there to the handles, mm.
    pub reach: f64,
    /// How far the part is turned, °.
    pub turn: f64,
}

/// A handle that is being dragged.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grip {
    /// The handle.
    pub handle: Handle,
    /// Where it was grabbed in the picture, points.
    pub from: DVec2,
    /// The motion so far.
    pub moved: Moved,
}

impl Handle {
    /// All handles.
    pub const ALL: [Self; 3] = [Self::X, Self::Y, Self::Turn];

    /// The axis along which it moves, or about which it turns.
    pub fn axis(self) -> DVec3 {
        match self {
            Self::X => DVec3::X,
            Self::Y => DVec3::Y,
            Self::Turn => DVec3::Z,
        }
    }

    /// The motion by an amount, mm or °.
    pub fn by(self, amount: f64) -> Moved {
        match self {
            Self::X | Self::Y => Moved { shift: self.axis().truncate() * amount, turn: 0.0 },
            Self::Turn => Moved { shift: DVec2::ZERO, turn: amount },
        }
    }
}

impl Gizmo {
    /// The handles of a part with this extent, mm: just outside it.
    pub fn around((low, high): (DVec3, DVec3)) -> Self {
        let foot = ((low + high) / 2.0).with_z(low.z);
        Self { foot, reach: 1.15 * (high - low).truncate().length() / 2.0, turn: 0.0 }
    }

    /// Where a handle is, mm.
    pub fn tip(&self, handle: Handle) -> DVec3 {
        let way = match handle {
            Handle::Turn => DVec2::from_angle((self.turn - 135.0).to_radians()).extend(0.0),
            _ => handle.axis(),
        };
        self.foot + way * self.reach
    }

    /// The handles of the part once it is moved.
    pub fn moved(&self, moved: Moved) -> Self {
        Self { foot: self.foot + moved.shift.extend(0.0), turn: self.turn + moved.turn, ..*self }
    }

    /// Places around the foot at the distance of the handles, mm; the last is the first again.
    pub fn ring(&self) -> impl Iterator<Item = DVec3> {
        const PIECES: u32 = 72;
        let angles = (0..=PIECES).map(|i| std::f64::consts::TAU * f64::from(i) / f64::from(PIECES));
        angles.map(|angle| self.foot + (DVec2::from_angle(angle) * self.reach).extend(0.0))
    }

    /// Whether a handle can be dragged with the camera where it is.
    pub fn can(&self, handle: Handle, camera: &Camera) -> bool {
        let tip = self.tip(handle);
        let way = if camera.orthographic { camera.back() } else { (camera.eye() - tip).normalize_or(camera.back()) };
        match handle {
            Handle::Turn => way.z.abs() > FLATTEST,
            _ => way.dot(handle.axis()).abs() < STEEPEST,
        }
    }

    /// The motion of a handle dragged from one line of sight to another (origin and direction); `None` where they do
    /// not determine it.
    pub fn dragged(&self, handle: Handle, from: (DVec3, DVec3), to: (DVec3, DVec3)) -> Option<Moved> {
        let amount = match handle {
            Handle::Turn => {
                let [a, b] = [from, to].map(|sight| self.on_plate(sight));
                a?.angle_to(b?).to_degrees()
            }
            _ => self.along(handle.axis(), to)? - self.along(handle.axis(), from)?,
        };
        amount.is_finite().then(|| handle.by(amount))
    }

    /// The place on a line through the foot that is nearest to a line of sight, mm from the foot.
    fn along(&self, axis: DVec3, (origin, way): (DVec3, DVec3)) -> Option<f64> {
        let (cos, apart) = (axis.dot(way), self.foot - origin);
        let sin2 = 1.0 - cos * cos;
        (sin2 > 1.0 - STEEPEST).then(|| (cos * way.dot(apart) - axis.dot(apart)) / sin2)
    }

    /// Where a line of sight meets the plane of the foot, mm from the foot.
    fn on_plate(&self, (origin, way): (DVec3, DVec3)) -> Option<DVec2> {
        let far = (self.foot.z - origin.z) / way.z;
        (far.is_finite() && far > 0.0).then(|| (origin + way * far - self.foot).truncate())
    }
}
