//! Damage: where a scan of a part lacks metal, and what is milled and welded to replace it.
//!
//! Metal is missing where the scan lies deeper inside the part than a tolerance. Damage is looked at along the direction in which it is
//! open: what is missing is the part's height less that of the scan. Layers follow the floor of the damage; where that floor is steeper
//! than layers can follow, or narrower than a bead, a groove is milled first ([`groove`]).

mod found;
mod groove;

use crate::chart::warp::{self, WarpError};
use crate::chart::{Chart, SurfaceError};
use crate::deviation;
use crate::model::Mesh;
use crate::task::{Cancelled, Task};
use found::Found;
use glam::DVec3;
use groove::Groove;

/// What counts as damage, and how it is welded; lengths in mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Direction from which all damage is seen and along which layers are stacked; each damage's own if `None`.
    pub up: Option<DVec3>,
    /// Spacing of the grid on which heights are sampled.
    pub step: f64,
    /// Metal is missing where the scan lies deeper inside the part than this.
    pub tolerance: f64,
    /// Metal that is welded above the part's surface, at most, to be milled off; at least a layer.
    pub allowance: f64,
    /// Height of a layer.
    pub layer: f64,
    /// Width of a bead.
    pub bead: f64,
}

/// A damaged place, and the metal that replaces what is missing.
#[derive(Debug, Clone, PartialEq)]
pub struct Damage {
    /// Metal to be welded, closed, mm.
    pub mesh: Mesh,
    /// Layers over the floor of the damage, or of the groove.
    pub chart: Chart,
    /// Its deepest place, on the scan, mm.
    pub place: DVec3,
    /// How far the scan lies inside the part there, mm.
    pub depth: f64,
    /// What is missing of the part, mm³.
    pub missing: f64,
    /// What is milled off the damaged part before it is welded, mm³.
    pub milled: f64,
}

/// A damaged place that is not welded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Left {
    /// Its deepest place, on the scan, mm.
    pub place: DVec3,
    /// How far the scan lies inside the part there, mm.
    pub depth: f64,
    /// Why.
    pub reason: Reason,
}

/// Why a damaged place is not welded.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum Reason {
    /// No bead fits.
    #[error("it is narrower than a bead")]
    Narrow,
    /// Something of the damaged part lies over it.
    #[error("the damaged part itself hides it along the direction of welding")]
    Hidden,
    /// Layers cannot follow the part.
    #[error("the surface there slopes by more than 17.7° against the direction of welding")]
    Steep,
}

/// All damage of a part.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Repair {
    /// What is welded, the largest first.
    pub damages: Vec<Damage>,
    /// What is not, the deepest first.
    pub left: Vec<Left>,
    /// The damaged part once its grooves are milled, mm.
    pub base: Mesh,
}

/// Why damage cannot be found.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum DamageError {
    /// The part has no surface.
    #[error("the part has no triangle with an area, so there is no surface to compare the scan with")]
    NoSurface,
    /// The scan has no faces.
    #[error(
        "the scan is a cloud of points without faces. Make a surface of it with the scanner's program (STL or PLY)"
    )]
    NoFaces,
    /// The scan and the part lie apart.
    #[error(
        "half of the scan lies more than {0:.1} mm from the part, so they do not lie in the same coordinates: align the scan with the part \
         first"
    )]
    Apart(f64),
    /// Too many heights.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
    /// Stopped by the caller.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Finds what a scan of a part lacks. Both lie in the same coordinates, mm; the scan has faces, but need not be closed.
///
/// ```
/// use bead_part::damage::{Settings, repair};
/// use bead_part::model::{Mesh, solid::Solid};
/// use bead_part::task::Task;
/// use glam::{DVec2, DVec3};
///
/// // A disc, and the same disc with a shallow dish in its top: a ring at radius 40 mm remains.
/// let mesh = |section: &[[f64; 2]]| {
///     let section: Vec<DVec2> = section.iter().map(|p| DVec2::from_array(*p)).collect();
///     let Solid { vertices, triangles } = Solid::revolve(&section, 90);
///     Mesh::from_triangles(vertices, triangles).0
/// };
/// let part = mesh(&[[0.0, 0.0], [60.0, 0.0], [60.0, 20.0], [0.0, 20.0]]);
/// let scan = mesh(&[[0.0, 0.0], [60.0, 0.0], [60.0, 20.0], [40.0, 20.0], [0.0, 14.0]]);
/// let settings = Settings { up: None, step: 2.0, tolerance: 0.5, allowance: 2.0, layer: 2.0, bead: 6.0 };
/// let found = repair(&part, &scan, settings, &Task::new())?;
/// let [dish] = &found.damages[..] else { return Err("one dish".into()) };
/// assert!((dish.missing - (part.volume() - scan.volume())).abs() < 0.02 * dish.missing);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`DamageError`].
pub fn repair(part: &Mesh, scan: &Mesh, settings: Settings, task: &Task) -> Result<Repair, DamageError> {
    let surface = deviation::Surface::of(part).ok_or(DamageError::NoSurface)?;
    if scan.triangles.is_empty() {
        return Err(DamageError::NoFaces);
    }
    let mut repair = Repair { base: scan.clone(), ..Repair::default() };
    for found in found::all(&surface, part, scan, settings, task)? {
        match filled(part, &repair.base, &found, settings, task) {
            Ok((damage, base)) => {
                repair.damages.push(damage);
                repair.base = base;
            }
            Err(Unfilled::Left(reason)) => repair.left.push(Left { place: found.place, depth: found.depth, reason }),
            Err(Unfilled::Error(error)) => return Err(error),
        }
    }
    repair.damages.sort_by(|a, b| b.missing.total_cmp(&a.missing));
    repair.left.sort_by(|a, b| b.depth.total_cmp(&a.depth));
    Ok(repair)
}

enum Unfilled {
    Left(Reason),
    Error(DamageError),
}

impl From<Cancelled> for Unfilled {
    fn from(cancelled: Cancelled) -> Self {
        Self::Error(cancelled.into())
    }
}

impl From<SurfaceError> for Unfilled {
    fn from(error: SurfaceError) -> Self {
        Self::Error(error.into())
    }
}

impl From<WarpError> for Unfilled {
    fn from(error: WarpError) -> Self {
        match error {
            WarpError::Cancelled(cancelled) => cancelled.into(),
            WarpError::Steep { .. } | WarpError::Torn(_) => Self::Left(Reason::Steep),
        }
    }
}

/// The metal for one damaged place, and the damaged part with its groove milled.
fn filled(
    part: &Mesh,
    base: &Mesh,
    found: &Found,
    settings: Settings,
    task: &Task,
) -> Result<(Damage, Mesh), Unfilled> {
    let up = settings.up.unwrap_or(found.open);
    let groove = Groove::under(found, part, base, up, settings)?;
    if groove.is_hidden(found, settings.tolerance) {
        return Err(Unfilled::Left(Reason::Hidden));
    }
    let polygons = groove.outline(part, settings, task)?;
    if polygons.is_empty() {
        return Err(Unfilled::Left(Reason::Narrow));
    }
    warp::check_slope(&groove.floor, groove.places(&polygons))?;
    let mesh = groove.metal(&polygons, settings, task)?;
    let (missing, milled) = groove.volumes(&polygons);
    let base = groove.milled(base, &polygons, settings, task)?;
    let chart = groove.chart();
    Ok((Damage { mesh, chart, place: found.place, depth: found.depth, missing, milled }, base))
}
