//! A scan as it is drawn: its points, each with the colour of its deviation; and the part in the colours of its bodies.

use super::palette::STEPS;
use beadwright::directions::Metal;
use beadwright::model::Milled;
use glam::DVec3;

/// Fraction of the points whose deviation the colours resolve; those beyond get the colour at the end, so that a little
/// spatter does not use up the colours.
const SHARE: f64 = 0.99;

/// The place in the colour map of what has no colour of its own (`scan.wgsl`).
const NONE: f32 = -1.0;

/// The smallest deviation that an end of the colours stands for, mm.
const FINEST_MM: f64 = 0.01;

/// A scan, with how far each of its points lies from the part.
#[derive(Debug)]
pub struct Scanned {
    /// x, y, z, mm, and the position in the colour map, 0 to 1; 0.5 lies on the surface.
    pub(super) points: Vec<[f32; 4]>,
    /// Triangles between them; empty for a cloud of points.
    pub(super) triangles: Vec<[u32; 3]>,
    /// The deviation that the ends of the colours stand for, mm.
    range: f64,
}

impl Scanned {
    /// `None` without points. `distances` are those of the points from the part, mm.
    pub fn new(points: &[DVec3], triangles: &[[u32; 3]], distances: &[f64]) -> Option<Self> {
        let mut far: Vec<f64> = distances.iter().map(|distance| distance.abs()).collect();
        let index = (SHARE * far.len().checked_sub(1)? as f64).round() as usize;
        let range = far.select_nth_unstable_by(index, f64::total_cmp).1.max(FINEST_MM);
        let coloured = |(at, distance): (&DVec3, &f64)| {
            let part = (0.5 + 0.5 * distance / range).clamp(0.0, 1.0);
            at.as_vec3().extend(part as f32).into()
        };
        let points = points.iter().zip(distances).map(coloured).collect();
        Some(Self { points, triangles: triangles.to_vec(), range })
    }

    /// The part within a preform, each triangle coloured by the metal over it.
    pub fn stock(part: &Milled) -> Option<Self> {
        let Milled { mesh, stock } = part;
        let corner = |&corner: &u32| mesh.vertices[corner as usize];
        let points: Vec<DVec3> = mesh.triangles.iter().flatten().map(corner).collect();
        let triangles: Vec<[u32; 3]> =
            (0..mesh.triangles.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
        let over: Vec<f64> = stock.iter().flat_map(|stock| [*stock; 3]).collect();
        Self::new(&points, &triangles, &over)
    }

    /// The metal of a part, each body in its own colour and stock without one; `None` if there is none.
    pub fn pieces(metal: &[Metal]) -> Option<Self> {
        let (mut points, mut triangles) = (Vec::new(), Vec::new());
        for Metal { mesh, body, stock } in metal {
            let first = points.len() as u32;
            let colour = if *stock { NONE } else { (body % STEPS) as f32 / (STEPS - 1) as f32 };
            points.extend(mesh.vertices.iter().map(|at| <[f32; 4]>::from(at.as_vec3().extend(colour))));
            triangles.extend(mesh.triangles.iter().map(|corners| corners.map(|corner| corner + first)));
        }
        (!triangles.is_empty()).then_some(Self { points, triangles, range: 0.0 })
    }

    /// The deviation that the ends of the colours stand for, mm.
    pub fn range(&self) -> f64 {
        self.range
    }
}
