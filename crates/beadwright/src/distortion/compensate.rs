//! A part bent beforehand, so that it comes out straight.
//!
//! A place *X* of the part goes to *X* + *c*. What is built there deviates by *u*(*X* + *c*), without the motion of the whole part
//! as a rigid body, and *c* = −*u* brings it to *X*. As *u* changes a little with the part that is planned, this is repeated: a
//! fixed point. What stands on the plate stays on it. The part is raised so far that there is metal under all of it; what
//! lies between it and the plate is cut off with the plate.

use crate::chart::warp;
use crate::model::Mesh;
use crate::task::{Cancelled, Task};
use distort::{Bending, DVec3, Deviation};

/// Displacement may change by this much per length, mm/mm: the model is one of small displacements.
pub const STEEPEST: f64 = 0.1;
/// Vertices this close to the plate stand on it, mm.
const ON_PLATE: f64 = 1e-3;

/// Why a part cannot be compensated.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CompensateError {
    /// The plan lays no metal there.
    #[error(
        "Near x {:.1}, y {:.1}, z {:.1} mm of the part the plan lays no metal: the plan is that of another part, or of one placed \
         elsewhere.",
        .0.x, .0.y, .0.z
    )]
    NoMetal(DVec3),
    /// Beyond small displacements.
    #[error(
        "Near x {:.1}, y {:.1}, z {:.1} mm the part bends by {steepest:.2} mm per mm, and the model only holds up to {STEEPEST} mm \
         per mm: a part that bends so much cannot be compensated by it. Use a thicker plate or less heat.",
        .at.x, .at.y, .at.z
    )]
    TooSteep {
        /// Where, mm.
        at: DVec3,
        /// Change of the displacement per length, mm/mm.
        steepest: f64,
    },
    /// Stopped by the caller.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// A part, and where each of its places goes.
#[derive(Debug, Clone, PartialEq)]
pub struct Compensation {
    /// The part, with edges short enough to follow its bending.
    part: Mesh,
    /// Where its vertices go, mm; at first where they are.
    bent: Vec<DVec3>,
    /// Largest displacement beforehand, mm.
    pub largest: f64,
    /// Where it is largest, mm.
    pub at: DVec3,
    /// Largest change of the displacement per length, mm/mm.
    pub steepest: f64,
    /// Metal that is cut off with the plate beneath the part, mm.
    pub raised: f64,
}

impl Compensation {
    /// A part that is not bent yet, standing on z = 0, with edges no longer than `edge` (mm).
    ///
    /// # Errors
    /// [`CompensateError::Cancelled`].
    pub fn new(part: &Mesh, edge: f64, task: &Task) -> Result<Self, CompensateError> {
        let divided = warp::divided(part, edge, task).map_err(|_| Cancelled)?;
        let part = Mesh::from_triangles(divided.vertices, divided.triangles).0;
        Ok(Self { bent: part.vertices.clone(), part, largest: 0.0, at: DVec3::ZERO, steepest: 0.0, raised: 0.0 })
    }

    /// The part bent against what this one, planned and built, does.
    ///
    /// # Errors
    /// The part has places without metal, or bends too much for the model.
    pub fn against(&self, bending: &Bending) -> Result<Self, CompensateError> {
        let moved = self.moved(bending)?;
        let before = |i: usize| -moved[i];
        let (steepest, at) = self.steepest(before);
        if steepest > STEEPEST {
            return Err(CompensateError::TooSteep { at, steepest });
        }
        let places = || self.part.vertices.iter().enumerate();
        let lowest = places().map(|(i, place)| place.z + before(i).z).fold(0.0, f64::min);
        let bent = |(i, place): (usize, &DVec3)| {
            let bent = place + before(i) - lowest * DVec3::Z;
            if stands(place) { bent.with_z(place.z) } else { bent }
        };
        let (largest, at) = places().map(|(i, &place)| (before(i).length(), place)).fold((0.0, DVec3::ZERO), larger);
        Ok(Self { part: self.part.clone(), bent: places().map(bent).collect(), largest, at, steepest, raised: -lowest })
    }

    /// The bent part.
    pub fn mesh(&self) -> Mesh {
        Mesh { vertices: self.bent.clone(), ..self.part.clone() }
    }

    /// How far the part is off where it was meant to be, once this one is built and deviates so: as the deviation of a shape,
    /// without the motion of the whole part, and without what stands on the plate.
    ///
    /// # Errors
    /// The part has places without metal.
    pub fn left(&self, bending: &Bending) -> Result<Deviation, CompensateError> {
        let moved = self.moved(bending)?;
        let built = self.part.vertices.iter().zip(self.bent.iter().zip(moved));
        let free = built.filter(|(place, _)| !stands(place));
        Ok(Deviation::of(free.map(|(&place, (bent, moved))| (place, bent + moved - place))))
    }

    /// Displacement of the vertices as they are built.
    fn moved(&self, bending: &Bending) -> Result<Vec<DVec3>, CompensateError> {
        let places = self.part.vertices.iter().zip(&self.bent);
        places.map(|(&place, &bent)| bending.at(bent).ok_or(CompensateError::NoMetal(place))).collect()
    }

    /// The largest change of a displacement along an edge, mm/mm, and where it is.
    fn steepest(&self, moved: impl Fn(usize) -> DVec3) -> (f64, DVec3) {
        let edges = self.part.triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
        let slope = |edge: [u32; 2]| {
            let [a, b] = edge.map(|end| end as usize);
            let (from, to) = (self.part.vertices[a], self.part.vertices[b]);
            (moved(a).distance(moved(b)) / from.distance(to).max(f64::MIN_POSITIVE), from.midpoint(to))
        };
        edges.map(slope).fold((0.0, DVec3::ZERO), larger)
    }
}

/// Whether a place of the part stands on the plate.
fn stands(place: &DVec3) -> bool {
    place.z < ON_PLATE
}

/// The larger of two values with their places.
fn larger(a: (f64, DVec3), b: (f64, DVec3)) -> (f64, DVec3) {
    if b.0 > a.0 { b } else { a }
}
