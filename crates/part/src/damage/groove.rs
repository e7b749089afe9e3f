//! The groove of one damaged place, and what is welded in it.
//!
//! Its floor is the highest surface under the scan whose sides are no steeper than allowed. It ends where the part does, and at steps of
//! the part, so that no wall beside the damage is milled. Layers follow a floor that is flat enough; otherwise they are level.

use super::beside::{away, beyond, neighbours};
use super::found::Found;
use super::mouth::{self, Face};
use super::{Reason, Settings, Unfilled, tips};
use crate::chart::surface::{self, Grid};
use crate::chart::warp::{self, WarpError};
use crate::chart::{Chart, Plane, Surface, SurfaceError};
use crate::model::Mesh;
use crate::model::solid::Solid;
use crate::task::Task;
use glam::{DVec2, DVec3};
use planar::isolines::isolines;
use planar::{Bounds, FillRule, Join, Lattice, Polygon, Region, Ring};
use std::sync::Arc;

/// Steepest slope of a floor that layers follow: less than they could, since splines through its corners are a little steeper.
const GENTLE: f64 = 0.22;
/// Layers are taken to follow a floor on which beads lie no farther apart than by this factor: less than what is refused, since
/// roughness between the points that are looked at makes it steeper.
const FOLLOWED: f64 = 1.04;
/// The part has a step where it rises by more than this.
const STEP: f64 = 1.0;
/// A side of a groove that would be lower by less than this stays as it is, mm.
const LEAST: f64 = 0.01;
/// Heights are measured for this many steps of the grid beside a groove.
const BESIDE: usize = 2;
/// Faces are divided this many steps beyond a box. Edges that lie beside the box by rounding alone, such as those of a part with round
/// measures beside a grid, would stay as they are, and what meets them would be divided without end.
pub(super) const RIM: f64 = 0.37;
/// Chord tolerance, mm.
const TOLERANCE: f64 = 0.02;
/// Faces of the part that lean more than this are not seen: the cosine.
const FACING: f64 = 0.05;
/// Faces of the damaged part that lean more than 75° are sides of the damage or of the part, and no floor: the cosine of that.
const SIDE: f64 = 0.26;

/// Faces of a place that are asked whether something lies over them.
const ASKED: usize = 50;
/// Faces of the damaged part that lean more are upright: the cosine.
const UPRIGHT: f64 = 1e-3;

/// How a groove is shaped and filled.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Shape {
    /// Layers follow the floor.
    Followed,
    /// Layers are level. The groove's floor is as wide as a bead, and its sides rise by this much, mm per mm.
    Level(f64),
}

impl Shape {
    /// Rise of the sides.
    fn rise(self) -> f64 {
        match self {
            Self::Followed => GENTLE,
            Self::Level(rise) => rise,
        }
    }
}

/// A groove, seen along the direction in which it is open.
pub(super) struct Groove {
    grid: Grid,
    shape: Shape,
    up: DVec3,
    /// The damaged part, where it is seen, on the grid, mm.
    ground: Vec<Option<f64>>,
    /// Whether metal is missing or milled, on the grid.
    open: Vec<bool>,
    /// The part's surface.
    top: Surface,
    /// The same, raised around tips narrower than a bead: up to here metal is welded.
    raised: Surface,
    /// What is welded on.
    floor: Arc<Surface>,
}

impl Groove {
    /// The groove of a place.
    ///
    /// # Errors
    /// [`Unfilled`].
    pub(super) fn under(
        found: &Found,
        part: &Mesh,
        base: &Mesh,
        (up, shape): (DVec3, Shape),
        settings: Settings,
    ) -> Result<Self, Unfilled> {
        let Settings { step, tolerance, bead, .. } = settings;
        let seen = || found.corners().map(|p| surface::seen(up, *p).truncate());
        let beside = bead + (BESIDE + 1) as f64 * step;
        let (low, high) = bounds(seen());
        let (first, last) = bounds(part.vertices.iter().map(|p| surface::seen(up, *p).truncate()));
        let margin = found.depth / shape.rise() + beside;
        let grid = Grid::over(up, step, (low - margin).max(first - beside), (high + margin).min(last + beside))?;
        let is_floor = |[a, b, c]: &[DVec3; 3]| (b - a).cross(c - a).normalize_or_zero().dot(up) > SIDE;
        let (top, floors) = (grid.tops(part), grid.tops(&base.only(is_floor)));
        // A side begins where the part does.
        let side: Vec<bool> = floors.iter().map(Option::is_none).collect();
        let ground: Vec<Option<f64>> = floors.into_iter().zip(&top).map(|(floor, top)| floor.or(*top)).collect();
        // What backs a hole lies outside the part, so that it is no damaged place, but it lies under the mouth.
        let near = near(&grid, seen());
        let is_deep = |k: usize| near[k] && matches!((top[k], ground[k]), (Some(t), Some(g)) if t - g > tolerance);
        let (open, void) = ((0..top.len()).map(is_deep).collect(), void(&grid, &top, base, bead));
        let mut dug = Dug { grid: &grid, top: &top, void: &void, floor: ground.clone(), open };
        if matches!(shape, Shape::Level(_)) {
            dug.widen(bead / 2.0);
        }
        dug.dig(shape.rise());
        if !dug.open.contains(&true) {
            return Err(Unfilled::Left(missed(found, base, up, tolerance)));
        }
        let (floor, kept) = dug.beside(&side, shape.rise());
        let Dug { open, .. } = dug;
        // Heights above what layers are parallel to.
        let level = |k: usize| if shape == Shape::Followed { floor[k] } else { Some(0.0) };
        let heights: Vec<Option<f64>> = (0..top.len()).map(|k| Some(top[k]? - level(k)?)).collect();
        let raised = tips::widened(&grid, &heights, &open, bead).into_iter().enumerate();
        let raised: Vec<Option<f64>> = raised.map(|(k, height)| Some(height? + level(k)?)).collect();
        let only =
            |heights: Vec<Option<f64>>| heights.into_iter().zip(&kept).map(|(h, kept)| h.filter(|_| *kept)).collect();
        let floor = grid.surface(extended(&grid, only(floor), shape.rise()))?;
        let (top, raised) = (grid.surface(only(top))?, grid.surface(only(raised))?);
        Ok(Self { grid, shape, up, ground, open, top, raised, floor: Arc::new(floor.rounded()) })
    }

    /// Whether most of a place is hidden by what lies over it.
    pub(super) fn is_hidden(&self, found: &Found, tolerance: f64) -> bool {
        let over = |p: &&DVec3| {
            let seen = self.grid.seen(**p);
            let Some(k) = self.nearest(seen.truncate()) else { return false };
            // Beside a steep side some places lie on its upper rim.
            let around = neighbours(&self.grid, k).map(|(n, _)| n).chain([k]).filter_map(|k| self.ground[k]);
            around.fold(f64::INFINITY, f64::min) > seen.z + tolerance
        };
        2 * found.points().filter(over).count() > found.points().count()
    }

    /// What is welded, seen along the direction, mm: no narrower than a bead.
    ///
    /// # Errors
    /// [`WarpError::Cancelled`].
    pub(super) fn outline(&self, part: &Mesh, settings: Settings, task: &Task) -> Result<Vec<Polygon>, WarpError> {
        let Settings { step, tolerance, bead, .. } = settings;
        let rim = tolerance / 2.0;
        let (low, high) = self.bounds();
        let lattice = Lattice::covering(&Bounds { min: low, max: high }, step, step / 2.0, 1);
        let value = |k: usize| {
            let (column, row) = (k % lattice.columns, k / lattice.columns);
            let is_rim = column == 0 || row == 0 || column + 1 == lattice.columns || row + 1 == lattice.rows;
            // Only where it is as deep as its rim matters.
            if is_rim { 0.0 } else { (self.depth(lattice.place_of(k)) / rim).clamp(0.0, 1.5) as f32 }
        };
        let deep: Vec<f32> = (0..lattice.len()).map(value).collect();
        let lines = isolines(&lattice, &deep).into_iter().map(|line| Ring::new(line.points));
        let deep = Region::from_rings(&lines.collect::<Vec<_>>(), FillRule::NonZero);
        let of_part = self.shadow(part, task)?;
        let half = bead / 2.0;
        let open = deep.intersection(&of_part).offset(-half, Join::ROUND).offset(half, Join::ROUND);
        let polygons = open.intersection(&of_part).simplified(TOLERANCE).into_polygons().into_iter();
        Ok(polygons.filter(|polygon| polygon.area() > bead * bead).collect())
    }

    /// The part's surface around the groove, seen along the direction.
    fn shadow(&self, part: &Mesh, task: &Task) -> Result<Region, WarpError> {
        let step = self.grid.step;
        let pieces = self.divided(part, step, task)?;
        let ring = |corners: &[u32; 3]| {
            let [a, b, c] = corners.map(|corner| self.grid.seen(pieces.vertices[corner as usize]));
            let middle = (a + b + c) / 3.0;
            let faces_up = (b - a).cross(c - a).normalize_or_zero().z > FACING;
            let is_top = (middle.z - self.top.height(middle.truncate())).abs() < STEP * step;
            let is_near = faces_up && is_top && self.is_open(middle.truncate());
            is_near.then(|| Ring::new([a, b, c].map(|p| p.truncate()).to_vec()))
        };
        let rings: Vec<Ring> = pieces.triangles.iter().filter_map(ring).collect();
        Ok(Region::from_rings(&rings, FillRule::NonZero))
    }

    /// What is welded: from the floor up to the part's surface, more around its tips, and what is to be milled off, closed, mm; and
    /// how much of it lies around tips, beside the part, mm³.
    ///
    /// # Errors
    /// [`WarpError`].
    pub(super) fn metal(
        &self,
        polygons: &[Polygon],
        settings: Settings,
        task: &Task,
    ) -> Result<(Mesh, f64), WarpError> {
        let over = settings.over();
        let (mut metal, mut beside) = (Mesh::default(), 0.0);
        for polygon in polygons {
            let Solid { vertices, triangles } = Solid::extrude(polygon, 0.0, 1.0);
            let mut flat = warp::divided(&Mesh { vertices, triangles, ..Mesh::default() }, self.grid.step, task)?;
            let over_floor = |surface: &Surface, p: DVec2| (surface.height(p) - self.floor.height(p)).max(0.0);
            for corners in flat.triangles.iter().map(|corners| corners.map(|corner| flat.vertices[corner as usize])) {
                let [a, b, c] = corners.map(DVec3::truncate);
                let more = |p: DVec2| over_floor(&self.raised, p) - over_floor(&self.top, p);
                let is_top = corners.iter().all(|corner| corner.z > 0.5);
                let area = if is_top { (b - a).perp_dot(c - a) / 2.0 } else { 0.0 };
                beside += area * (more(a) + more(b) + more(c)) / 3.0;
            }
            flat.vertices.iter_mut().for_each(|p| p.z *= over_floor(&self.raised, p.truncate()) + over);
            let is_steep = |p: &&DVec3| self.floor.stretch(p.truncate()) > FOLLOWED;
            if let Some(p) = flat.vertices.iter().find(is_steep).filter(|_| self.shape == Shape::Followed) {
                let stretch = self.floor.stretch(p.truncate());
                return Err(WarpError::Steep { place: self.floor.at(*p).place, stretch });
            }
            // Its edges are no longer than a step of the grid, so that between its corners it is as good as straight.
            let places = flat.vertices.iter().map(|p| self.floor.at(*p).place).collect();
            metal.add(Mesh::from_triangles(places, flat.triangles).0);
        }
        if self.shape == Shape::Followed {
            // Between the corners of a rough floor a plan finds steeper places.
            warp::warped(&Chart::Surface(Arc::clone(&self.floor)), &metal, TOLERANCE, task)?;
        }
        Ok((metal, beside))
    }

    /// The fraction of a place that no metal covers: of its mouth, seen along the direction, or of the scan's faces if that is not seen.
    pub(super) fn bare(&self, found: &Found, polygons: &[Polygon]) -> f64 {
        let is_bare = |face: &&Face| {
            let place = self.grid.seen(mouth::middle(face)).truncate();
            !polygons.iter().any(|polygon| polygon.contains(place))
        };
        let faces: Vec<&Face> = facing(&found.mouth, self.up).collect();
        let faces = if faces.is_empty() { found.faces.iter().collect() } else { faces };
        let area = |face: &Face| mouth::vector(face).dot(self.up).abs();
        let bare: f64 = faces.iter().copied().filter(is_bare).map(area).sum();
        bare / faces.into_iter().map(area).sum::<f64>().max(f64::MIN_POSITIVE)
    }

    /// The damaged part with the groove milled, and how much is milled off, mm³.
    ///
    /// # Errors
    /// [`WarpError::Cancelled`].
    pub(super) fn milled(
        &self,
        base: &Mesh,
        polygons: &[Polygon],
        settings: Settings,
        task: &Task,
    ) -> Result<(Mesh, f64), WarpError> {
        let mut milled = self.divided(base, self.grid.step, task)?;
        let cut = |p: &DVec3| {
            let seen = self.grid.seen(*p);
            let place = seen.truncate();
            let over = seen.z - self.floor.height(place);
            let is_metal = over > 0.0 && seen.z < self.top.height(place) + settings.allowance;
            let is_within = || self.is_open(place) && polygons.iter().any(|polygon| polygon.contains(place));
            if is_metal && is_within() { over } else { 0.0 }
        };
        let cuts: Vec<f64> = milled.vertices.iter().map(cut).collect();
        let volume = |corners: &[u32; 3]| {
            let [cut_a, cut_b, cut_c] = corners.map(|corner| cuts[corner as usize]);
            let [a, b, c] = corners.map(|corner| self.grid.seen(milled.vertices[corner as usize]).truncate());
            (b - a).perp_dot(c - a) / 2.0 * (cut_a + cut_b + cut_c) / 3.0
        };
        let volume = milled.triangles.iter().map(volume).sum();
        milled.vertices.iter_mut().zip(&cuts).for_each(|(vertex, cut)| *vertex -= self.up * *cut);
        Ok((milled, volume))
    }

    /// How the layers of what is welded lie.
    pub(super) fn chart(&self, polygons: &[Polygon]) -> Chart {
        if self.shape == Shape::Followed {
            return Chart::Surface(Arc::clone(&self.floor));
        }
        let lowest = self.places(polygons).map(|p| self.floor.height(p)).fold(f64::INFINITY, f64::min);
        Chart::Plane(Plane { origin: self.up * lowest, up: self.up })
    }

    /// Places of the grid within polygons, mm.
    fn places(&self, polygons: &[Polygon]) -> impl Iterator<Item = DVec2> {
        let places = (0..self.open.len()).map(|k| self.grid.place(k));
        places.filter(|p| polygons.iter().any(|polygon| polygon.contains(*p)))
    }

    /// How much lies between the floor and the part's surface at a place, mm.
    fn depth(&self, p: DVec2) -> f64 {
        self.top.height(p) - self.floor.height(p)
    }

    fn bounds(&self) -> (DVec2, DVec2) {
        (self.grid.place(0), self.grid.place(self.open.len() - 1))
    }

    /// A mesh whose edges in the groove are no longer than this, mm.
    fn divided(&self, mesh: &Mesh, longest: f64, task: &Task) -> Result<Mesh, WarpError> {
        let (low, high) = self.bounds();
        let (low, high) = (low - RIM * self.grid.step, high + RIM * self.grid.step);
        warp::divided_where(mesh, longest, task, |a, b| {
            let [a, b] = [a, b].map(|p| self.grid.seen(p).truncate());
            a.min(b).cmple(high).all() && a.max(b).cmpge(low).all()
        })
    }

    /// The number of the grid's place nearest to a place, where it lies on the grid.
    fn nearest(&self, p: DVec2) -> Option<usize> {
        nearest(&self.grid, p)
    }

    /// Whether metal is missing or milled at a corner of the cell around a place.
    fn is_open(&self, p: DVec2) -> bool {
        let half = self.grid.step / 2.0;
        let corners = [(-half, -half), (-half, half), (half, -half), (half, half)];
        corners.into_iter().any(|(x, y)| self.nearest(p + DVec2::new(x, y)).is_some_and(|k| self.open[k]))
    }
}

fn nearest(grid: &Grid, p: DVec2) -> Option<usize> {
    let at = ((p - grid.from) / grid.step).round();
    let is_on_it = at.cmpge(DVec2::ZERO).all() && at.x < grid.columns as f64 && at.y < grid.rows as f64;
    is_on_it.then(|| at.y as usize * grid.columns + at.x as usize)
}

fn bounds(places: impl Iterator<Item = DVec2>) -> (DVec2, DVec2) {
    places.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)))
}

/// Those of some faces that are seen along a direction.
fn facing(faces: &[Face], up: DVec3) -> impl Iterator<Item = &Face> {
    faces.iter().filter(move |face| mouth::vector(face).normalize_or_zero().dot(up) > FACING)
}

/// Why no place of a grid lies in some damage.
fn missed(found: &Found, base: &Mesh, up: DVec3, tolerance: f64) -> Reason {
    let is_floor = |face: &&Face| mouth::vector(face).normalize_or_zero().dot(up) > SIDE;
    let floors: Vec<&Face> = found.faces.iter().filter(is_floor).collect();
    if floors.is_empty() {
        let seen = found.faces.iter().filter(|face| mouth::vector(face).normalize_or_zero().dot(up) > FACING).count();
        return if 2 * seen > found.faces.len() { Reason::Steep } else { Reason::Hidden };
    }
    let asked: Vec<DVec3> =
        floors.iter().step_by(floors.len().div_ceil(ASKED)).map(|face| mouth::middle(face)).collect();
    let covered = asked.iter().filter(|p| is_covered(surface::seen(up, **p), base, up, tolerance)).count();
    if 2 * covered > asked.len() { Reason::Hidden } else { Reason::Coarse }
}

/// Whether a mesh has a face over a place, both seen along a direction.
fn is_covered(place: DVec3, base: &Mesh, up: DVec3, tolerance: f64) -> bool {
    let p = place.truncate();
    base.triangles.iter().any(|corners| {
        let [a, b, c] = corners.map(|corner| surface::seen(up, base.vertices[corner as usize]));
        let [q, r, s] = [a, b, c].map(|corner| corner.truncate());
        let parts = [(r - p).perp_dot(s - p), (s - p).perp_dot(q - p), (q - p).perp_dot(r - p)];
        let area: f64 = parts.iter().sum();
        let height = (parts[0] * a.z + parts[1] * b.z + parts[2] * c.z) / area;
        parts.iter().all(|part| part * area > 0.0) && height > place.z + tolerance
    })
}

/// Those missing faces of the part, seen along a direction, under which the damaged part has no face that is seen as well.
pub(super) fn bottomless(
    found: &Found,
    part: &Mesh,
    base: &Mesh,
    up: DVec3,
    settings: Settings,
) -> Result<Vec<Face>, SurfaceError> {
    let (low, high) = bounds(found.corners().map(|p| surface::seen(up, *p).truncate()));
    let grid = Grid::over(up, settings.step, low, high)?;
    let void = void(&grid, &grid.tops(part), base, settings.bead);
    let is_void = |face: &&Face| nearest(&grid, grid.seen(mouth::middle(face)).truncate()).is_some_and(|k| void[k]);
    Ok(facing(&found.mouth, up).filter(is_void).copied().collect())
}

/// Where the part lies on a grid, but nothing of the damaged part, over more than a small gap of the scan: a quarter of a bead's square, mm.
fn void(grid: &Grid, top: &[Option<f64>], base: &Mesh, bead: f64) -> Vec<bool> {
    let faces_up = |[a, b, c]: &[DVec3; 3]| (b - a).cross(c - a).normalize_or_zero().dot(grid.up()) > UPRIGHT;
    let floors = grid.tops(&base.only(faces_up));
    let empty: Vec<bool> = floors.iter().zip(top).map(|(floor, top)| floor.is_none() && top.is_some()).collect();
    let (mut void, mut seen) = (vec![false; empty.len()], vec![false; empty.len()]);
    for first in (0..empty.len()).filter(|k| empty[*k]) {
        if std::mem::replace(&mut seen[first], true) {
            continue;
        }
        let (mut region, mut next) = (vec![first], 0);
        while let Some(k) = region.get(next).copied() {
            next += 1;
            for (n, _) in neighbours(grid, k).filter(|(n, _)| empty[*n]) {
                if !std::mem::replace(&mut seen[n], true) {
                    region.push(n);
                }
            }
        }
        if region.len() as f64 * grid.step * grid.step > bead * bead / 4.0 {
            region.into_iter().for_each(|k| void[k] = true);
        }
    }
    void
}

/// Where a grid lies within two steps of places, which are no farther apart than that.
fn near(grid: &Grid, places: impl Iterator<Item = DVec2>) -> Vec<bool> {
    let mut near = vec![false; grid.columns * grid.rows];
    places.filter_map(|p| nearest(grid, p)).for_each(|k| near[k] = true);
    for _ in 0..2 {
        let beside = |k: usize| neighbours(grid, k).any(|(n, _)| near[n]);
        near = (0..near.len()).map(|k| near[k] || beside(k)).collect();
    }
    near
}

/// A groove that is being dug.
struct Dug<'a> {
    grid: &'a Grid,
    /// The part.
    top: &'a [Option<f64>],
    /// Where it is not known that there is metal under it, so that nothing is dug.
    void: &'a [bool],
    floor: Vec<Option<f64>>,
    /// Whether metal is missing or milled.
    open: Vec<bool>,
}

impl Dug<'_> {
    /// Whether a groove may reach from one place to another.
    fn is_beside(&self, from: usize, to: usize, away: f64) -> bool {
        is_even(self.top, from, to, away) && !self.void[to]
    }

    /// Makes the floor as low within a radius (mm) of each open place as it is there.
    fn widen(&mut self, radius: f64) {
        let steps = (radius / self.grid.step).ceil() as isize;
        let before = self.floor.clone();
        let ways = (-steps..=steps).flat_map(|y| (-steps..=steps).map(move |x| (x, y)));
        let ways: Vec<(isize, isize)> = ways.filter(|way| away(*way, self.grid.step) <= radius).collect();
        for k in (0..before.len()).filter(|k| self.open[*k]).collect::<Vec<_>>() {
            let Some(low) = before[k] else { continue };
            for (n, away) in ways.iter().filter_map(|way| beyond(self.grid, k, *way)) {
                if self.is_beside(k, n, away) && self.floor[n].is_some_and(|floor| floor > low) {
                    (self.floor[n], self.open[n]) = (Some(low), true);
                }
            }
        }
    }

    /// Cuts away what rises more steeply from open places, mm per mm, in sweeps over the grid until nothing changes.
    fn dig(&mut self, rise: f64) {
        let mut changed = true;
        while changed {
            changed = false;
            for k in sweeps(self.open.len()) {
                let Some(low) = self.floor[k].filter(|_| self.open[k]) else { continue };
                for (n, away) in neighbours(self.grid, k) {
                    let highest = low + rise * away;
                    if self.is_beside(k, n, away) && self.floor[n].is_some_and(|floor| floor > highest + LEAST) {
                        (self.floor[n], self.open[n], changed) = (Some(highest), true, true);
                    }
                }
            }
        }
    }

    /// The floor with what lies around it up to steps and sides of the part, and where that is. Where the part falls away steeply
    /// beside the groove, the floor falls no more than its sides rise, mm per mm.
    fn beside(&self, side: &[bool], rise: f64) -> (Vec<Option<f64>>, Vec<bool>) {
        let (mut floor, mut kept) = (self.floor.clone(), self.open.clone());
        for _ in 0..BESIDE {
            let lowest = |k: usize| {
                let around = neighbours(self.grid, k).filter(|(n, away)| kept[*n] && is_even(self.top, k, *n, *away));
                around.filter_map(|(n, away)| Some(floor[n]? - rise * away)).max_by(f64::total_cmp)
            };
            let beside = (0..kept.len()).filter(|k| !kept[*k] && !side[*k]);
            let ring: Vec<(usize, f64)> = beside.filter_map(|k| Some((k, floor[k]?.max(lowest(k)?)))).collect();
            for (k, height) in ring {
                (floor[k], kept[k]) = (Some(height), true);
            }
        }
        (floor, kept)
    }
}

/// A floor with heights everywhere, which slopes no more than where they are known: midway between the lowest and the highest one
/// (the extension of McShane and Whitney, 1934).
fn extended(grid: &Grid, floor: Vec<Option<f64>>, rise: f64) -> Vec<Option<f64>> {
    let cone = |sign: f64| {
        let (mut heights, mut changed) = (floor.clone(), true);
        while changed {
            changed = false;
            for k in sweeps(heights.len()) {
                let Some(height) = heights[k] else { continue };
                for (n, away) in neighbours(grid, k).filter(|(n, _)| floor[*n].is_none()) {
                    let reached = height + sign * rise * away;
                    if heights[n].is_none_or(|known| sign * (known - reached) > LEAST) {
                        (heights[n], changed) = (Some(reached), true);
                    }
                }
            }
        }
        heights
    };
    cone(1.0).into_iter().zip(cone(-1.0)).map(|(high, low)| Some(f64::midpoint(high?, low?))).collect()
}

/// All places of a grid there and back, so that what spreads from place to place takes few sweeps.
fn sweeps(count: usize) -> impl Iterator<Item = usize> {
    (0..count).chain((0..count).rev())
}

/// Whether the part has no step between two places.
fn is_even(top: &[Option<f64>], a: usize, b: usize, away: f64) -> bool {
    matches!((top[a], top[b]), (Some(a), Some(b)) if (a - b).abs() <= STEP * away)
}
