//! Divides a model by planes into pieces, each built square to a direction of its own, so that as little as possible
//! overhangs.
//!
//! Planes take off what lies above them, from the top down, as clipping planes do in Wu et al. 2018 (*General
//! support-effective decomposition for multi-directional 3-D printing*, arXiv 1812.00606): a plane is worth the
//! overhang that it spares what remains. What is taken off may be several pieces; each gets the direction that suits it
//! best, and stands on the cut. The most promising divisions are pursued in parallel (a beam search). Only the surface
//! is examined, so broken meshes do not matter.
//!
//! | file | what it does |
//! | --- | --- |
//! | `around` | blades on a hub: layers around an axis |
//! | `tubes` | straight tubes that branch, each along its axis |
//! | `samples` | the surface as many small samples |
//! | `ways` | candidate directions, and the best one for a piece |
//! | `cut` | a plane takes off what lies above it |
//! | `between` | a plane that separates two pieces |

mod around;
mod between;
mod cut;
mod samples;
mod tubes;
mod ways;

use crate::chart::{Bound, Chart, Guide, Plane};
use crate::middle_line::{NoMiddleLine, middle_line};
use crate::model::Mesh;
use crate::task::{Cancelled, Task};
use glam::DVec3;
use rayon::prelude::*;
use samples::{Sample, area, samples};
use std::sync::Arc;
use ways::Judge;

/// Limits for dividing a part.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Largest angle between a wall and the direction in which it is built, °.
    pub lean: f64,
    /// Largest angle between a build direction and the vertical, °. Layers around a hub need 90, because the part turns
    /// about the hub's axis; more than that hangs the part over.
    pub tilt: f64,
    /// Width of a bead, mm: overhangs of a few beads are ignored.
    pub bead: f64,
}

impl Settings {
    /// What [`Settings::lean`] usually is, °.
    pub const LEAN: f64 = 45.0;
    /// What [`Settings::tilt`] usually is, °.
    pub const TILT: f64 = 90.0;

    /// The usual limits, with a bead of this width, mm.
    pub fn usual(bead: f64) -> Self {
        Self { lean: Self::LEAN, tilt: Self::TILT, bead }
    }
}

/// A way to divide a part.
#[derive(Debug, Clone, PartialEq)]
pub struct Division {
    /// The pieces, in build order.
    pub pieces: Vec<Piece>,
    /// Area that still overhangs, or is so near the table that a torch of 25 mm radius would touch it, mm².
    pub hanging: f64,
    /// Largest angle between a direction and the vertical, °.
    pub tilt: f64,
    /// Largest angle between a wall and the direction in which it is built, °, where a tube has no better layers than those
    /// from which it leans more than [`Settings::lean`].
    pub lean: Option<f64>,
}

/// A piece of a part.
#[derive(Debug, Clone, PartialEq)]
pub struct Piece {
    /// The shape of its layers; the first begins at its lowest point.
    pub chart: Chart,
    /// The piece is what lies within these bounds and above the start of its first layer.
    pub within: Vec<Bound>,
    /// What lies within all bounds of one of these belongs to it, too.
    pub also: Vec<Vec<Bound>>,
    /// Whether its first layer lies on metal that is there already, such as a turned hub.
    pub on_stock: bool,
}

/// Divisions pursued in parallel, and planes tried on each.
const BEAM: usize = 3;
const TRIES: usize = 80;
/// Most cuts of a part.
const CUTS: usize = 6;
/// Directions that differ by less than this are alike, rad: about 10°.
const ALIKE: f64 = 0.17;
/// Most divisions that are offered.
const OFFERED: usize = 3;
/// Divisions are offered if they leave at most this fraction of what overhangs in level layers.
const BETTER: f64 = 0.7;
/// A cut must spare at least this fraction of the surface from overhanging.
const WORTH: f64 = 0.004;
/// What a piece, and a tilt of 90°, cost as overhang, as fractions of the surface.
const PIECE: f64 = 0.002;
const TILT: f64 = 0.01;
/// What a cut costs at 45° to the layers beside it, as a fraction of its area: both pieces end there in wedges, too thin for a
/// bead at their tips.
const SKEW: f64 = 1.0;
/// A part branches if some of its surface is farther from the middle line than this many times the mean distance.
const BRANCHES: f64 = 2.5;
/// A middle line within this of horizontal, °, counts as horizontal.
const SLACK: f64 = 2.0;

/// A division that may be cut further.
#[derive(Clone)]
struct State {
    /// What remains below the cuts.
    trunk: Mesh,
    samples: Vec<Sample>,
    /// The cuts, each with the remaining part above it.
    cuts: Vec<Plane>,
    /// What was taken off, the highest first.
    pieces: Vec<Piece>,
    /// Overhang of the trunk, and of the pieces, mm².
    hanging: [f64; 2],
    /// What it costs that cuts lie at an angle to layers, as an area, mm².
    skew: f64,
    cost: f64,
}

/// Ways to divide a part that stands on the table: along a tube or around a hub, or, if that leaves overhangs, by
/// planes, the best first. The part as one piece comes last, and alone if nothing overhangs.
///
/// ```
/// use bead_part::directions::{Settings, divisions};
/// use bead_part::{example, task::Task};
///
/// // Blades on a hub: layers around the hub's axis.
/// let hub = example::find("hub").ok_or("no such example")?.mesh();
/// let found = divisions(&hub, Settings { lean: 45.0, tilt: 90.0, bead: 7.0 }, &Task::new())?;
/// let chart = found[0].pieces[0].chart.to_string();
/// assert!(chart.starts_with("cylinder:axis=0/0/1,through=0/0/0,radius=40"), "{chart}");
/// assert!(found[0].hanging < 0.1 * found.last().ok_or("nothing found")?.hanging);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`Cancelled`].
pub fn divisions(mesh: &Mesh, settings: Settings, task: &Task) -> Result<Vec<Division>, Cancelled> {
    let samples = samples(mesh, mesh.size().length());
    let judge = Judge::new(mesh, &samples, settings);
    let whole = State::whole(mesh, samples, &judge);
    if whole.hanging[0] <= judge.nothing {
        return Ok(vec![whole.division()]);
    }
    let recognized = tube(mesh, &judge, &whole, task)?.into_iter().chain(tubes::tubes(&whole, &judge));
    let mut offered: Vec<Division> = recognized.chain(around::around(&whole, &judge)).collect();
    if !offered.iter().any(|division| division.hanging <= judge.nothing) {
        search(&whole, &judge, &mut offered, task)?;
    }
    offered.push(whole.division());
    Ok(offered)
}

/// The divisions by planes alone, the best first, whatever else the part may be.
///
/// # Errors
/// [`Cancelled`].
pub fn by_planes(mesh: &Mesh, settings: Settings, task: &Task) -> Result<Vec<Division>, Cancelled> {
    let samples = samples(mesh, mesh.size().length());
    let judge = Judge::new(mesh, &samples, settings);
    let mut offered = Vec::new();
    search(&State::whole(mesh, samples, &judge), &judge, &mut offered, task)?;
    Ok(offered)
}

/// Adds divisions by planes to those that are offered, searched by beams.
fn search(whole: &State, judge: &Judge, offered: &mut Vec<Division>, task: &Task) -> Result<(), Cancelled> {
    let (mut open, mut ended) = (vec![whole.clone()], Vec::new());
    for _ in 0..CUTS {
        let mut next: Vec<State> = Vec::new();
        for state in &open {
            let planes = ways::planes(&state.samples, judge);
            let cut = |plane| task.check().map(|()| cut::cut(state, plane, judge));
            let cut = planes.into_par_iter().map(cut).collect::<Result<Vec<_>, Cancelled>>()?;
            let better = |other: &State| other.cost < state.cost - judge.surface * WORTH;
            next.extend(cut.into_iter().flatten().filter(better));
        }
        next.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        // Cuts at an angle spare more at once, cuts along and square to layers leave no wedges: both are pursued.
        let (mut all, mut square) = (0..BEAM, 0..BEAM);
        next.retain(|state| all.next().is_some() || state.skew <= judge.nothing && square.next().is_some());
        ended.extend(next.iter().cloned());
        open = next.into_iter().filter(|state| state.hanging[0] > judge.nothing).collect();
        if open.is_empty() {
            break;
        }
    }
    ended.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    let better = |state: &State| state.hanging.iter().sum::<f64>() < BETTER * whole.hanging[0];
    for division in ended.into_iter().filter(better).map(State::division) {
        if offered.len() < OFFERED && !offered.iter().any(|other| division.is_like(other)) {
            offered.push(division);
        }
    }
    Ok(())
}

/// A bent tube or bar as one piece along its middle line.
fn tube(mesh: &Mesh, judge: &Judge, whole: &State, task: &Task) -> Result<Option<Division>, Cancelled> {
    let guide = match middle_line(mesh, task) {
        Ok(guide) => Guide::through(guide.points()).unwrap_or(guide),
        Err(NoMiddleLine::Cancelled(cancelled)) => return Err(cancelled),
        Err(_) => return Ok(None),
    };
    // The whole part must follow the line: neither reach past its ends nor branch off it.
    let lies: Vec<Along> = whole.samples.iter().map(|sample| Along::of(guide.points(), sample.place)).collect();
    let usual = lies.iter().map(|along| along.away).sum::<f64>() / lies.len() as f64;
    if lies.iter().any(|along| along.away > BRANCHES * usual || along.beyond > usual) {
        return Ok(None);
    }
    let hangs =
        |(sample, along): &(&Sample, &Along)| judge.hangs(sample, along.way) && !judge.stands(sample, judge.table());
    let hanging = area(whole.samples.iter().zip(&lies).filter(hangs).map(|(sample, _)| sample));
    let along = guide.points().windows(2).map(|pair| (pair[1] - pair[0]).normalize_or_zero());
    let tilt = along.map(ways::lies).fold(0.0, f64::max);
    // The ends of a middle line are slightly inaccurate.
    let tilt = if (tilt - 90.0).abs() < SLACK { 90.0 } else { tilt };
    let chart = Chart::Guide(Arc::new(guide));
    let piece = Piece { chart, within: Vec::new(), also: Vec::new(), on_stock: false };
    let fits = tilt <= judge.settings.tilt && hanging < BETTER * whole.hanging[0];
    Ok(fits.then(|| Division { pieces: vec![piece], hanging, tilt, lean: None }))
}

/// Position of a point relative to a line through points.
struct Along {
    /// Distance from the line, mm.
    away: f64,
    /// Distance beyond an end of the line, mm.
    beyond: f64,
    /// Direction of the line there.
    way: DVec3,
}

impl Along {
    fn of(line: &[DVec3], p: DVec3) -> Self {
        let to = |pair: &[DVec3]| {
            let (from, along) = (p - pair[0], pair[1] - pair[0]);
            let part = from.dot(along) / along.length_squared();
            let beyond = (part - 1.0).max(-part).max(0.0) * along.length();
            let away = (from - along * part.clamp(0.0, 1.0)).length();
            Self { away, beyond, way: along.normalize_or_zero() }
        };
        let nearest = line.windows(2).map(to).min_by(|a, b| a.away.total_cmp(&b.away));
        nearest.unwrap_or(Self { away: f64::MAX, beyond: 0.0, way: DVec3::Z })
    }
}

impl State {
    fn whole(mesh: &Mesh, samples: Vec<Sample>, judge: &Judge) -> Self {
        let hanging = judge.hanging(&samples, DVec3::Z, judge.table());
        let trunk = mesh.clone();
        Self { trunk, samples, cuts: Vec::new(), pieces: Vec::new(), hanging: [hanging, 0.0], skew: 0.0, cost: hanging }
    }

    fn division(self) -> Division {
        let tilt = self.pieces.iter().map(Piece::tilt).fold(0.0, f64::max);
        let within = self.cuts.into_iter().map(Bound::Plane).collect();
        let trunk = Piece { chart: Chart::default(), within, also: Vec::new(), on_stock: false };
        let pieces = std::iter::once(trunk).chain(self.pieces.into_iter().rev()).collect();
        Division { pieces, hanging: self.hanging.iter().sum(), tilt, lean: None }
    }
}

impl Division {
    /// Whether it has as many pieces as another, along the same directions, in whatever order.
    fn is_like(&self, other: &Self) -> bool {
        let up = |piece: &Piece| match &piece.chart {
            Chart::Plane(plane) => plane.up,
            _ => DVec3::ZERO,
        };
        let mut left: Vec<&Piece> = other.pieces.iter().collect();
        let is_there = |a: &Piece| {
            let same = left.iter().position(|b| up(a).distance(up(b)) < ALIKE);
            same.map(|k| left.swap_remove(k)).is_some()
        };
        self.pieces.len() == other.pieces.len() && self.pieces.iter().all(is_there)
    }
}

impl Piece {
    /// Whether a point lies in it, or no farther than `over` (mm) outside.
    fn has(&self, p: DVec3, over: f64) -> bool {
        let within = |bounds: &Vec<Bound>| bounds.iter().all(|bound| bound.height(p) >= -over);
        self.chart.coordinates(p).z >= -over && (within(&self.within) || self.also.iter().any(within))
    }

    /// Angle between its direction and the vertical, °.
    fn tilt(&self) -> f64 {
        match &self.chart {
            Chart::Plane(plane) => ways::lies(plane.up),
            _ => 0.0,
        }
    }
}
