//! Damage: where a scan of a part lacks metal, and what is milled and welded to replace it.
//!
//! Metal is missing where the scan lies deeper inside the part than a tolerance. Damage is looked at along the direction in which it is
//! open: what is missing is the part's height less that of the scan. Layers follow the floor of a shallow damage. Under others a groove is
//! milled first, as wide as a bead at least, and filled with level layers.

mod beside;
mod found;
mod groove;
mod mouth;
mod moved;
mod tips;

use crate::chart::warp::WarpError;
use crate::chart::{Chart, SurfaceError};
use crate::deviation;
use crate::model::Mesh;
use crate::task::{Cancelled, Task};
use found::{Found, Known};
use glam::DVec3;
use groove::{Groove, Shape};
pub use mouth::Stretch;
pub use moved::{Movement, moved};
use planar::{Join, Polygon, Region};

/// What counts as damage, and how it is welded; lengths in mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Direction from which all damage is seen and along which layers are stacked; each damage's own if `None`.
    pub up: Option<DVec3>,
    /// Spacing of the grid on which heights are sampled.
    pub step: f64,
    /// Metal is missing where the scan lies deeper inside the part than this.
    pub tolerance: f64,
    /// Metal that is welded above the part's surface, at most, to be milled off; at least a layer. Around edges and corners where no
    /// bead would have room more is welded, by up to a bead's width.
    pub allowance: f64,
    /// Height of a layer.
    pub layer: f64,
    /// Width of a bead.
    pub bead: f64,
    /// Angle between the sides of a groove and its floor where layers are level, degrees.
    pub sides: f64,
}

impl Settings {
    /// How far the solid to be welded reaches above the part, mm: a layer is welded where at least half of it lies in the solid.
    fn over(&self) -> f64 {
        self.allowance - self.layer / 2.0
    }
}

/// A damaged place, and the metal that replaces what is missing.
#[derive(Debug, Clone, PartialEq)]
pub struct Damage {
    /// Metal to be welded, closed, mm.
    pub mesh: Mesh,
    /// Layers over the floor of the damage, or level ones in a groove.
    pub chart: Chart,
    /// Direction along which they are stacked.
    pub up: DVec3,
    /// Its middle, on the part's surface, mm.
    pub place: DVec3,
    /// How far the scan lies under the part's surface where that is missing, mm.
    pub depth: f64,
    /// What is missing of the part, mm³.
    pub missing: f64,
    /// What is milled off the damaged part before it is welded, mm³.
    pub milled: f64,
    /// Fraction of the place that no metal covers, such as a neck narrower than a bead.
    pub bare: f64,
    /// What is missing by the faces of scan and part, mm³, if the grid is too coarse to measure it.
    pub unresolved: Option<f64>,
}

/// A damaged place that is not welded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Left {
    /// Its middle, on the part's surface, mm.
    pub place: DVec3,
    /// How far the scan lies under the part's surface where that is missing, mm.
    pub depth: f64,
    /// The direction along which it was to be welded.
    pub up: DVec3,
    /// Why.
    pub reason: Reason,
}

/// Why a damaged place is not welded.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum Reason {
    /// No bead fits.
    #[error("it is narrower than a bead")]
    Narrow,
    /// Something of the damaged part lies over it, or it has no floor.
    #[error("along that direction it lies under metal, or nothing lies under it")]
    Hidden,
    /// It goes right through the part.
    #[error("it goes right through the part, so along that direction nothing lies under it")]
    Through,
    /// No place of the grid lies in it, or too few to tell whether a bead fits.
    #[error("the grid is too coarse for so small a place")]
    Coarse,
    /// The scan shows its sides only.
    #[error("the scan does not show its floor")]
    Unseen,
    /// Layers cannot follow the part.
    #[error("along that direction the surface is too steep")]
    Steep,
}

/// All damage of a part.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Repair {
    /// What is welded, the largest first.
    pub damages: Vec<Damage>,
    /// What is not, the deepest first.
    pub left: Vec<Left>,
    /// Stretches of the part's surface under which damage goes right through the part, so that they stay bare; the largest first.
    pub through: Vec<Stretch>,
    /// Stretches of the part's surface of which the scan shows neither that they are there nor that they are missing, nor how deep damage
    /// is under them; the largest first.
    pub unseen: Vec<Stretch>,
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
/// let settings = Settings { up: None, step: 2.0, tolerance: 0.5, allowance: 2.0, layer: 2.0, bead: 6.0, sides: 45.0 };
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
    let Known { places: found, unseen } = found::all(&surface, part, scan, settings, task)?;
    let fill = |found| Place::filled(found, part, scan, settings, task);
    let mut places = found.into_iter().map(fill).collect::<Result<Vec<_>, _>>()?;
    while let Some([a, b]) = meeting(&places, settings.bead) {
        let other = places.swap_remove(b).found;
        let one = places.swap_remove(a).found;
        places.push(fill(one.and(other, &surface))?);
    }
    let mut repair = Repair { base: scan.clone(), unseen, ..Repair::default() };
    for Place { found, metal, bottomless } in places {
        match &bottomless {
            Some(Bottomless::Through(stretch)) => repair.through.push(*stretch),
            Some(Bottomless::Unseen(stretch)) => repair.unseen.push(*stretch),
            None => {}
        }
        match metal {
            Ok(Metal { groove, polygons, damage }) => {
                (repair.base, _) = groove.milled(&repair.base, &polygons, settings, task).map_err(cancelled)?;
                repair.damages.push(damage);
            }
            Err(reason) => {
                let reason = bottomless
                    .filter(|_| matches!(reason, Reason::Hidden | Reason::Steep))
                    .map_or(reason, |why| why.reason());
                let up = settings.up.unwrap_or(found.open);
                repair.left.push(Left { place: found.place, depth: found.depth, up, reason });
            }
        }
    }
    repair.damages.sort_by(|a, b| b.missing.total_cmp(&a.missing));
    repair.left.sort_by(|a, b| b.depth.total_cmp(&a.depth));
    repair.through.sort_by(|a, b| b.area.total_cmp(&a.area));
    repair.unseen.sort_by(|a, b| b.area.total_cmp(&a.area));
    Ok(repair)
}

/// A damaged place with the metal for it, or why there is none.
struct Place {
    found: Found,
    metal: Result<Metal, Reason>,
    bottomless: Option<Bottomless>,
}

/// Why nothing lies under a stretch of the part's surface.
#[derive(Clone, Copy)]
enum Bottomless {
    /// The damage goes right through the part.
    Through(Stretch),
    /// The scan has a gap there.
    Unseen(Stretch),
}

impl Bottomless {
    /// `None` if less than a bead lacks a floor.
    fn of(found: &Found, part: &Mesh, scan: &Mesh, settings: Settings) -> Result<Option<Self>, SurfaceError> {
        let up = settings.up.unwrap_or(found.open);
        let faces = groove::bottomless(found, part, scan, up, settings)?;
        let stretch = Stretch::of(&faces).filter(|stretch| stretch.area > settings.bead * settings.bead / 4.0);
        // A scan that ends inside the part does not show that there is nothing.
        let has_gap = found.ends > settings.bead;
        Ok(stretch.map(|stretch| if has_gap { Self::Unseen(stretch) } else { Self::Through(stretch) }))
    }

    fn reason(self) -> Reason {
        match self {
            Self::Through(_) => Reason::Through,
            Self::Unseen(_) => Reason::Unseen,
        }
    }
}

struct Metal {
    groove: Groove,
    /// What is welded, seen along its direction.
    polygons: Vec<Polygon>,
    damage: Damage,
}

impl Place {
    fn filled(found: Found, part: &Mesh, scan: &Mesh, settings: Settings, task: &Task) -> Result<Self, DamageError> {
        let bottomless = Bottomless::of(&found, part, scan, settings)?;
        match Metal::of(&found, part, scan, settings, task) {
            Ok(metal) => Ok(Self { found, metal: Ok(metal), bottomless }),
            Err(Unfilled::Left(reason)) => Ok(Self { found, metal: Err(reason), bottomless }),
            Err(Unfilled::Error(error)) => Err(error),
        }
    }
}

impl Metal {
    /// Whether another lies within some mm, if their boxes do.
    fn meets(&self, other: &Self, within: f64) -> bool {
        let region = |metal: &Self| Region::from_normalised(metal.polygons.clone());
        self.damage.up != other.damage.up
            || !region(self).offset(within, Join::ROUND).intersection(&region(other)).is_empty()
    }

    /// In layers that follow the damage if little is milled for them, otherwise in level ones.
    fn of(found: &Found, part: &Mesh, scan: &Mesh, settings: Settings, task: &Task) -> Result<Self, Unfilled> {
        let up = settings.up.unwrap_or(found.open);
        let shaped = |shape| {
            let groove = Groove::under(found, part, scan, (up, shape), settings)?;
            if groove.is_hidden(found, settings.tolerance) {
                return Err(Unfilled::Left(Reason::Hidden));
            }
            let polygons = groove.outline(part, settings, task)?;
            if polygons.is_empty() {
                let is_coarse = settings.step > FINE * settings.bead;
                return Err(Unfilled::Left(if is_coarse { Reason::Coarse } else { Reason::Narrow }));
            }
            let chart = groove.chart(&polygons);
            let (mesh, beside) = groove.metal(&polygons, settings, task)?;
            let (_, milled) = groove.milled(scan, &polygons, settings, task)?;
            let bare = groove.bare(found, &polygons);
            let over = settings.over() * polygons.iter().map(Polygon::area).sum::<f64>();
            let missing = (mesh.volume() - milled - over - beside).max(0.0);
            let unresolved = unresolved(found, up, (missing, bare), settings);
            let (place, depth) = (found.place, found.depth);
            let damage = Damage { mesh, chart, up, place, depth, missing, milled, bare, unresolved };
            Ok(Self { groove, polygons, damage })
        };
        match shaped(Shape::Followed) {
            Ok(metal) if metal.damage.milled > MILLED * metal.damage.missing => {}
            Err(Unfilled::Left(Reason::Steep | Reason::Narrow)) => {}
            other => return other,
        }
        shaped(Shape::Level(settings.sides.to_radians().tan()))
    }
}

/// What is missing by the faces of scan and part, mm³, if that on the grid differs so much that the grid is too coarse.
fn unresolved(found: &Found, up: DVec3, (on_grid, bare): (f64, f64), settings: Settings) -> Option<f64> {
    let missing = found.missing(up);
    // On the grid a damage begins at half the tolerance.
    let most = ROUGH * missing + settings.tolerance / 2.0 * found.mouth_area();
    let is_coarse = (missing - on_grid).abs() > most && (bare < BARE || settings.step > FINE * settings.bead);
    (is_coarse && found.ends <= settings.bead).then_some(missing)
}

/// A grid whose step is a greater fraction of a bead may miss where a bead fits.
const FINE: f64 = 0.5;
/// A grid is fine enough if what it measures is as true as this.
const ROUGH: f64 = 0.15;
/// Where more than this fraction of a place stays bare, less is welded for that reason.
const BARE: f64 = 0.05;

/// Layers are level where more than this fraction of what is missing would be milled so that they can follow the damage.
const MILLED: f64 = 0.5;

/// Two places whose metal lies within a bead (mm) of one another: they are welded as one. The second has the higher number.
fn meeting(places: &[Place], bead: f64) -> Option<[usize; 2]> {
    let metal: Vec<(usize, &Metal)> =
        places.iter().enumerate().filter_map(|(k, place)| Some((k, place.metal.as_ref().ok()?))).collect();
    let boxes: Vec<(DVec3, DVec3)> = metal.iter().map(|(_, metal)| metal.damage.mesh.bounds()).collect();
    let meet = |a: usize, b: usize| {
        let (low, high) = (boxes[a].0.max(boxes[b].0) - bead, boxes[a].1.min(boxes[b].1));
        low.cmple(high).all() && metal[a].1.meets(metal[b].1, bead)
    };
    let pairs = (0..metal.len()).flat_map(|b| (0..b).map(move |a| [a, b]));
    pairs.into_iter().find(|[a, b]| meet(*a, *b)).map(|pair| pair.map(|k| metal[k].0))
}

fn cancelled(_: WarpError) -> DamageError {
    // Dividing a mesh fails for no other reason.
    DamageError::Cancelled(Cancelled)
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
