//! The frame of the part from touches of its sides: three points as controllers ask for them (origin, a point on the x
//! axis, a point above the x-y plane's x axis), or any number of touches on top, front and left.

use super::CalibrateError;
use super::place::{Calibrated, Known, Place, fitted};
use glam::{DMat3, DQuat, DVec3};

/// What a touched point lies on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Touch {
    /// The origin.
    Origin,
    /// The x axis, on its positive side.
    AlongX,
    /// The x-y plane: the top of the plate.
    Top,
    /// The x-z plane: the front, from which y grows.
    Front,
    /// The y-z plane: the left side, from which x grows.
    Left,
}

impl Touch {
    /// The name in files.
    ///
    /// ```
    /// use bead_robot::calibrate::Touch;
    ///
    /// assert_eq!(Touch::named("front"), Some(Touch::Front));
    /// ```
    pub fn named(name: &str) -> Option<Self> {
        Some(match name {
            "origin" => Self::Origin,
            "x" => Self::AlongX,
            "top" | "xy" => Self::Top,
            "front" => Self::Front,
            "left" => Self::Left,
            _ => return None,
        })
    }

    /// The coordinates that are 0 there.
    fn known(self) -> [Option<f64>; 3] {
        let [x, y, z] = match self {
            Self::Origin => [true, true, true],
            Self::AlongX => [false, true, true],
            Self::Top => [false, false, true],
            Self::Front => [false, true, false],
            Self::Left => [true, false, false],
        };
        [x, y, z].map(|is_known| is_known.then_some(0.0))
    }
}

const REMEDY: &str = "give three points on top that are far apart (origin, x and xy count), two on the x axis or the front, and one on the \
                      left or the origin.";

/// The frame in which all touched points lie where they should: z points up in the robot's base, and x from the left
/// towards the other points.
///
/// # Errors
/// [`CalibrateError::Undetermined`].
pub fn base(touches: &[(Touch, DVec3)]) -> Result<Calibrated, CalibrateError> {
    let undetermined = CalibrateError::Undetermined(REMEDY);
    let of = |wanted: &dyn Fn(Touch) -> bool| -> Vec<DVec3> {
        touches.iter().filter(|(touch, _)| wanted(*touch)).map(|(_, p)| *p).collect()
    };
    let top = of(&|touch| touch.known()[2].is_some());
    let front = of(&|touch| touch.known()[1].is_some());
    let left = of(&|touch| touch.known()[0].is_some());
    let middle = |points: &[DVec3]| points.iter().sum::<DVec3>() / points.len().max(1) as f64;
    let up = normal(&top).ok_or(undetermined)?;
    let up = if up.z < 0.0 { -up } else { up };
    let along = farthest(&front).ok_or(undetermined)?.reject_from_normalized(up).try_normalize().ok_or(undetermined)?;
    let left_at = left.first().copied().ok_or(undetermined)?;
    let all = || middle(&of(&|_| true));
    let ahead = touches.iter().find(|(touch, _)| *touch == Touch::AlongX).map_or_else(all, |(_, p)| *p);
    let along = if along.dot(ahead - left_at) < 0.0 { -along } else { along };
    let beside = up.cross(along);
    let (top_at, front_at) = (middle(&top), middle(&front));
    let at = up * up.dot(top_at) + beside * beside.dot(front_at) + along * along.dot(middle(&left));
    let guess = Place { at, turn: DQuat::from_mat3(&DMat3::from_cols(along, beside, up)) };
    let points: Vec<Known> = touches.iter().map(|(touch, p)| Known { outside: *p, inside: touch.known() }).collect();
    fitted(guess, &points, REMEDY)
}

/// The normal of the plane through points, from the triangle with the largest area.
fn normal(points: &[DVec3]) -> Option<DVec3> {
    let first = *points.first()?;
    let far = points.iter().copied().max_by(|a, b| a.distance(first).total_cmp(&b.distance(first)))?;
    let square = |p: &DVec3| (far - first).cross(*p - first);
    points.iter().map(square).max_by(|a, b| a.length().total_cmp(&b.length()))?.try_normalize()
}

/// The vector between the first point and the one farthest from it.
fn farthest(points: &[DVec3]) -> Option<DVec3> {
    let first = *points.first()?;
    points.iter().map(|p| *p - first).max_by(|a, b| a.length().total_cmp(&b.length())).filter(|v| v.length() > 0.0)
}
