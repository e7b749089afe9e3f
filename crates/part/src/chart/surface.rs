//! Layers that follow a surface: cladding, hard-facing, layers over a mould. The surface is given by its heights along
//! one direction on a square grid, joined smoothly by cubic splines.
//!
//! (u, v) is the position seen along that direction, h the height above the surface along it. So one mm of u × v × h is
//! one mm³, and all layers are alike; where the surface slopes, beads lie farther apart than planned, by the ratio of
//! the length on the slope to its projection ([`Surface::stretch`]).

use super::At;
use crate::model::Mesh;
use glam::{DMat3, DQuat, DVec2, DVec3};

/// A surface that layers follow.
#[derive(Debug, Clone, PartialEq)]
pub struct Surface {
    up: DVec3,
    from: DVec2,
    step: f64,
    columns: usize,
    heights: Vec<f64>,
    /// Control points of the splines, mm.
    control: Vec<f64>,
}

/// Why heights do not define a surface.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SurfaceError {
    /// Too few or too many heights, or not a whole number of rows.
    #[error(
        "{heights} heights in rows of {columns} give no surface: write whole rows, at least {LEAST} of at least {LEAST} heights, at most \
         {MOST} in all"
    )]
    Grid {
        /// How many heights there are.
        heights: usize,
        /// How many a row has.
        columns: usize,
    },
    /// A mesh of which no face is visible along the direction.
    #[error("nothing of the model is seen along the direction of the surface")]
    Nothing,
}

/// Fewest heights per row, and fewest rows.
const LEAST: usize = 4;
/// Most heights in all.
const MOST: usize = 250_000;

impl Surface {
    /// The surface through heights (mm) along `up`, row by row: `step` (mm) apart, the first at `from` (mm), in the
    /// coordinates of the [`Plane`](super::Plane) square to `up` through the origin.
    ///
    /// ```
    /// use bead_part::chart::Surface;
    /// use glam::{DVec2, DVec3};
    ///
    /// // A ramp that rises by 1 mm in 10.
    /// let heights = (0..25).map(|k| f64::from(k % 5)).collect();
    /// let ramp = Surface::new(DVec3::Z, DVec2::ZERO, 10.0, 5, heights)?;
    /// assert!((ramp.stretch(DVec2::splat(17.0)) - 1.01_f64.sqrt()).abs() < 1e-12);
    /// # Ok::<(), bead_part::chart::SurfaceError>(())
    /// ```
    ///
    /// # Errors
    /// [`SurfaceError::Grid`].
    pub fn new(up: DVec3, from: DVec2, step: f64, columns: usize, heights: Vec<f64>) -> Result<Self, SurfaceError> {
        let rows = heights.len() / columns.max(1);
        if columns < LEAST || rows < LEAST || rows * columns != heights.len() || heights.len() > MOST {
            return Err(SurfaceError::Grid { heights: heights.len(), columns });
        }
        // Control points of splines through the heights, up to the fourth power of the step.
        let bent = |k: usize, at: usize, count: usize, by: usize| {
            if at == 0 || at + 1 == count { 0.0 } else { heights[k - by] - 2.0 * heights[k] + heights[k + by] }
        };
        let control = (0..heights.len())
            .map(|k| heights[k] - (bent(k, k % columns, columns, 1) + bent(k, k / columns, rows, columns)) / 6.0)
            .collect();
        Ok(Self { up, from, step, columns, heights, control })
    }

    /// The topmost surface of a mesh seen along `up`, on a grid of `step` (mm), with roughness finer than the grid evened
    /// out. Beside the mesh and over its openings the surface continues straight for a few steps, then level.
    ///
    /// # Errors
    /// [`SurfaceError`].
    pub fn of_mesh(mesh: &Mesh, up: DVec3, step: f64) -> Result<Self, SurfaceError> {
        Self::of_faces(mesh, up, step, |_| true)
    }

    /// The same, from only those grid points that are kept; beside them the surface continues as beside the mesh.
    ///
    /// # Errors
    /// [`SurfaceError`].
    pub(crate) fn of_faces(
        mesh: &Mesh,
        up: DVec3,
        step: f64,
        kept: impl Fn(DVec2) -> bool,
    ) -> Result<Self, SurfaceError> {
        let seen = |p: &DVec3| seen(up, *p);
        let corner = |least: DVec2, p: DVec3| least.min(p.truncate());
        let low = mesh.vertices.iter().map(seen).fold(DVec2::INFINITY, corner);
        let high = -mesh.vertices.iter().map(|p| -seen(p)).fold(DVec2::INFINITY, corner);
        let grid = Grid::over(up, step, low, high)?;
        let tops = grid.evened(mesh).into_iter().enumerate();
        grid.surface(tops.map(|(k, top)| top.filter(|_| kept(grid.place(k)))).collect())
    }

    /// The same surface with heights rounded to four decimals of a mm, as in files.
    pub fn rounded(&self) -> Self {
        const PLACES: f64 = 1e4;
        let heights = self.heights.iter().map(|height| (height * PLACES).round() / PLACES + 0.0).collect();
        Self::new(self.up, self.from, self.step, self.columns, heights).unwrap_or_else(|_| self.clone())
    }

    /// Direction along which heights are measured.
    pub fn up(&self) -> DVec3 {
        self.up
    }

    /// Position of the first height, mm.
    pub fn from(&self) -> DVec2 {
        self.from
    }

    /// Spacing of the heights, mm.
    pub fn step(&self) -> f64 {
        self.step
    }

    /// Number of heights per row.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Heights along `up`, row by row, mm.
    pub fn heights(&self) -> &[f64] {
        &self.heights
    }

    /// The control points of the cubic splines, row by row like the heights, mm.
    pub fn control(&self) -> &[f64] {
        &self.control
    }

    /// The length of the steepest path on the surface at a point, over its length seen along `up`.
    pub fn stretch(&self, p: DVec2) -> f64 {
        (1.0 + self.at_place(p).1.length_squared()).sqrt()
    }

    /// The same surface, `by` mm lower.
    pub(super) fn lowered(&self, by: f64) -> Self {
        let lower = |heights: &[f64]| heights.iter().map(|height| height - by).collect();
        Self { heights: lower(&self.heights), control: lower(&self.control), ..*self }
    }

    pub(crate) fn coordinates(&self, p: DVec3) -> DVec3 {
        let seen = seen(self.up, p);
        seen.with_z(seen.z - self.at_place(seen.truncate()).0)
    }

    pub(crate) fn at(&self, p: DVec3) -> At {
        let turn = turn(self.up);
        let (height, slope) = self.at_place(p.truncate());
        let normal = DVec3::new(-slope.x, -slope.y, 1.0).normalize();
        let along = DVec3::new(1.0, 0.0, slope.x).normalize();
        let place = turn * p.with_z(p.z + height);
        At { place, along: [turn * along, turn * normal.cross(along)], normal: turn * normal }
    }

    /// Height along `up` at a place, mm.
    pub(crate) fn height(&self, p: DVec2) -> f64 {
        self.at_place(p).0
    }

    /// Height (mm) and slope of the surface at a point; beyond the grid it continues straight.
    fn at_place(&self, p: DVec2) -> (f64, DVec2) {
        let rows = self.heights.len() / self.columns;
        let last = DVec2::new((self.columns - 1) as f64, (rows - 1) as f64);
        let place = (p - self.from) / self.step;
        let on_grid = place.clamp(DVec2::ZERO, last);
        let cell = on_grid.floor().min(last - 1.0);
        let part = on_grid - cell;
        let (x, y) = (Basis::at(part.x), Basis::at(part.y));
        let (mut height, mut slope) = (0.0, DVec2::ZERO);
        for j in 0..4 {
            for i in 0..4 {
                let control = self.control_at(cell.x as isize + i as isize - 1, cell.y as isize + j as isize - 1);
                height += control * x.value[i] * y.value[j];
                slope += control * DVec2::new(x.slope[i] * y.value[j], x.value[i] * y.slope[j]) / self.step;
            }
        }
        (height + slope.dot((place - on_grid) * self.step), slope)
    }

    /// Beyond the edge, control points are extrapolated linearly.
    fn control_at(&self, column: isize, row: isize) -> f64 {
        let rows = (self.control.len() / self.columns) as isize;
        let columns = self.columns as isize;
        if column < 0 {
            return 2.0 * self.control_at(0, row) - self.control_at(1, row);
        }
        if column >= columns {
            return 2.0 * self.control_at(columns - 1, row) - self.control_at(columns - 2, row);
        }
        if row < 0 {
            return 2.0 * self.control_at(column, 0) - self.control_at(column, 1);
        }
        if row >= rows {
            return 2.0 * self.control_at(column, rows - 1) - self.control_at(column, rows - 2);
        }
        self.control[(row * columns + column) as usize]
    }
}

/// A point as it is seen along `up`: its place as x and y, its height as z, mm.
pub(crate) fn seen(up: DVec3, p: DVec3) -> DVec3 {
    turn(up).conjugate() * p
}

fn turn(up: DVec3) -> DQuat {
    DQuat::from_rotation_arc(DVec3::Z, up)
}

/// The four cubic splines over a cell, and their slopes.
struct Basis {
    value: [f64; 4],
    slope: [f64; 4],
}

impl Basis {
    fn at(t: f64) -> Self {
        let s = 1.0 - t;
        let value = [s * s * s, 4.0 - 6.0 * t * t + 3.0 * t * t * t, 4.0 - 6.0 * s * s + 3.0 * s * s * s, t * t * t];
        let slope = [-s * s, 3.0 * t * t - 4.0 * t, 4.0 * s - 3.0 * s * s, t * t];
        Self { value: value.map(|v| v / 6.0), slope: slope.map(|v| v / 2.0) }
    }
}

/// A square grid of places seen along a direction, on which heights are measured.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Grid {
    up: DVec3,
    /// Its first place, mm.
    pub(crate) from: DVec2,
    /// Distance of its places, mm.
    pub(crate) step: f64,
    pub(crate) columns: usize,
    pub(crate) rows: usize,
}

impl Grid {
    /// The grid over a box, mm, with one step of margin, so that all of a part lies on it.
    ///
    /// # Errors
    /// [`SurfaceError`].
    pub(crate) fn over(up: DVec3, step: f64, low: DVec2, high: DVec2) -> Result<Self, SurfaceError> {
        if !(low.is_finite() && high.is_finite()) {
            return Err(SurfaceError::Nothing);
        }
        let from = ((low / step).floor() - 1.0) * step;
        let counts = ((high - from) / step).ceil() + 2.0;
        let [columns, rows] = [counts.x as usize, counts.y as usize].map(|count| count.max(LEAST));
        if columns * rows > MOST {
            return Err(SurfaceError::Grid { heights: columns * rows, columns });
        }
        Ok(Self { up, from, step, columns, rows })
    }

    /// A point with its place on the grid as x and y and its height as z, mm.
    pub(crate) fn seen(&self, p: DVec3) -> DVec3 {
        seen(self.up, p)
    }

    /// The direction along which it is seen.
    pub(crate) fn up(&self) -> DVec3 {
        self.up
    }

    pub(crate) fn place(&self, k: usize) -> DVec2 {
        self.from + DVec2::new((k % self.columns) as f64, (k / self.columns) as f64) * self.step
    }

    /// The topmost heights of a mesh, row by row, mm; none where nothing of it is seen.
    pub(crate) fn tops(&self, mesh: &Mesh) -> Vec<Option<f64>> {
        let seen: Vec<DVec3> = mesh.vertices.iter().map(|p| self.seen(*p)).collect();
        let mut tops = vec![None; self.columns * self.rows];
        for corners in &mesh.triangles {
            self.raise(&mut tops, corners.map(|corner| seen[corner as usize]));
        }
        tops
    }

    /// The topmost heights of a mesh as [`Self::tops`] has them, but each that of the plane that fits the mesh best within a
    /// step, where near places count more: the noise of a scan makes no slopes.
    fn evened(&self, mesh: &Mesh) -> Vec<Option<f64>> {
        const REACH: usize = FINE - 1;
        let step = self.step / FINE as f64;
        let [columns, rows] = [self.columns, self.rows].map(|count| (count - 1) * FINE + 1 + 2 * REACH);
        let fine = Self { from: self.from - REACH as f64 * step, step, columns, rows, ..*self };
        let tops = fine.tops(mesh);
        let evened = |k: usize| {
            let (column, row) = (k % self.columns * FINE, k / self.columns * FINE);
            let top = |i: usize, j: usize| tops[(row + j) * columns + column + i];
            let place = |i: usize, j: usize| (DVec2::new(i as f64, j as f64) - REACH as f64) / FINE as f64;
            let near = (0..=2 * REACH).flat_map(|j| (0..=2 * REACH).map(move |i| (i, j)));
            let near: Vec<(DVec2, f64)> = near.filter_map(|(i, j)| Some((place(i, j), top(i, j)?))).collect();
            // A gap in a scan is no edge.
            let is_within = 2 * near.len() > (2 * REACH + 1).pow(2);
            let mean = || near.iter().map(|(_, height)| height).sum::<f64>() / near.len() as f64;
            let own = top(REACH, REACH).or_else(|| is_within.then(mean))?;
            let near = near.iter().map(|(place, height)| (*place, height - own));
            // What lies beyond a step is another face.
            Some(own + in_middle(near.filter(|(_, by)| by.abs() <= self.step)))
        };
        (0..self.columns * self.rows).map(evened).collect()
    }

    /// The surface through heights; where there are none, it goes on straight for a few steps, then level.
    ///
    /// # Errors
    /// [`SurfaceError`].
    pub(crate) fn surface(&self, tops: Vec<Option<f64>>) -> Result<Surface, SurfaceError> {
        let heights = spread(tops, self.columns).ok_or(SurfaceError::Nothing)?;
        Surface::new(self.up, self.from, self.step, self.columns, heights)
    }

    /// Raises the heights that a triangle covers.
    fn raise(&self, tops: &mut [Option<f64>], [a, b, c]: [DVec3; 3]) {
        let [p, q, r] = [a, b, c].map(|corner| (corner.truncate() - self.from) / self.step);
        let area = (q - p).perp_dot(r - p);
        let longest = [(p, q), (q, r), (r, p)].map(|(p, q)| p.distance_squared(q)).into_iter().fold(0.0, f64::max);
        if area.abs() <= UPRIGHT * longest {
            return;
        }
        let (low, high) = (p.min(q).min(r) - EDGE, p.max(q).max(r) + EDGE);
        let (low, high) = (low.ceil().max(DVec2::ZERO), high.floor());
        let within = |low: f64, high: f64, count: usize| low as usize..((high + 1.0).max(0.0) as usize).min(count);
        for row in within(low.y, high.y, self.rows) {
            for column in within(low.x, high.x, self.columns) {
                let at = DVec2::new(column as f64, row as f64);
                let parts = [(q - at).perp_dot(r - at), (r - at).perp_dot(p - at), (p - at).perp_dot(q - at)]
                    .map(|part| part / area);
                if parts.iter().any(|part| *part < -EDGE) {
                    continue;
                }
                let height = parts[0] * a.z + parts[1] * b.z + parts[2] * c.z;
                let top = &mut tops[row * self.columns + column];
                *top = Some(top.map_or(height, |top: f64| top.max(height)));
            }
        }
    }
}

/// Height at the origin of the plane that fits heights best, in their unit; 0 where they define no plane. Places lie within 1 of the origin
/// in x and y, and count less the farther away they are.
fn in_middle(heights: impl Iterator<Item = (DVec2, f64)>) -> f64 {
    let (mut squares, mut right) = (DMat3::ZERO, DVec3::ZERO);
    for (place, height) in heights {
        let weight = (1.0 - place * place).element_product();
        let row = DVec3::new(1.0, place.x, place.y);
        squares += DMat3::from_cols(row, row * place.x, row * place.y) * weight;
        right += row * height * weight;
    }
    if squares.determinant() > FLAT { (squares.inverse() * right).x } else { 0.0 }
}

/// Heights that are evened out are measured at this many places per step.
const FINE: usize = 4;
/// Places whose determinant is smaller lie on one line.
const FLAT: f64 = 1e-6;
/// Points outside a triangle by less than this fraction count as on its edge.
const EDGE: f64 = 1e-9;
/// A triangle whose projection is smaller than this fraction of a grid square is seen edge-on: rounding would decide
/// its height.
const UPRIGHT: f64 = 1e-9;

/// Fills in missing heights: the surface continues straight for a few steps, then level.
fn spread(mut tops: Vec<Option<f64>>, columns: usize) -> Option<Vec<f64>> {
    tops.iter().any(Option::is_some).then_some(())?;
    let mut straight = STRAIGHT;
    while tops.iter().any(Option::is_none) {
        let top = |column: isize, row: isize| {
            let column = usize::try_from(column).ok().filter(|column| *column < columns)?;
            tops.get(usize::try_from(row).ok()? * columns + column).copied().flatten()
        };
        let mean = |k: usize| {
            let (column, row) = ((k % columns) as isize, (k / columns) as isize);
            let from = |(x, y): (isize, isize)| {
                let near = top(column + x, row + y)?;
                Some(top(column + 2 * x, row + 2 * y).filter(|_| straight > 0).map_or(near, |far| 2.0 * near - far))
            };
            let near: Vec<f64> = [(-1, 0), (1, 0), (0, -1), (0, 1)].into_iter().filter_map(from).collect();
            (!near.is_empty()).then(|| near.iter().sum::<f64>() / near.len() as f64)
        };
        tops = (0..tops.len()).map(|k| tops[k].or_else(|| mean(k))).collect();
        straight -= 1;
    }
    tops.into_iter().collect()
}

/// Steps for which a surface continues straight beside its mesh.
const STRAIGHT: i32 = 3;
