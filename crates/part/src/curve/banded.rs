//! Cholesky solver for symmetric positive definite systems with a band and, for closed curves, a border.
//!
//! The normal equations of a closed spline have a band and, where the last unknowns meet the first, corners. These last
//! unknowns are treated as a border and eliminated with the Schur complement; the rest stays a plain band.

use glam::DVec3;

/// Unknowns are numbered so that two in the same equation are at most `band` apart, except those of the border.
pub(super) struct Banded {
    band: usize,
    core: usize,
    /// Row i: the elements (i, i − band) to (i, i).
    rows: Vec<Vec<f64>>,
    /// Column c of the border: its elements coupling with the core.
    sides: Vec<Vec<f64>>,
    /// The border with itself.
    corner: Vec<Vec<f64>>,
}

impl Banded {
    /// A system of zeros whose last `border` unknowns may couple with all others.
    pub(super) fn new(unknowns: usize, band: usize, border: usize) -> Self {
        let core = unknowns - border;
        let rows = vec![vec![0.0; band + 1]; core];
        Self { band, core, rows, sides: vec![vec![0.0; core]; border], corner: vec![vec![0.0; border]; border] }
    }

    /// Adds to the element (i, j) and so to (j, i); call it once per pair.
    pub(super) fn add(&mut self, i: usize, j: usize, value: f64) {
        let (i, j) = (i.max(j), i.min(j));
        match (i.checked_sub(self.core), j.checked_sub(self.core)) {
            (None, _) => self.rows[i][self.band + j - i] += value,
            (Some(c), None) => self.sides[c][j] += value,
            (Some(c), Some(d)) => {
                self.corner[c][d] += value;
                if c != d {
                    self.corner[d][c] += value;
                }
            }
        }
    }

    /// Factors the system; `None` when it is singular.
    pub(super) fn factored(mut self) -> Option<Factored> {
        for i in 0..self.core {
            let first = i.saturating_sub(self.band);
            for j in first..=i {
                let sum: f64 = (first.max(j.saturating_sub(self.band))..j).map(|k| self.at(i, k) * self.at(j, k)).sum();
                let rest = self.at(i, j) - sum;
                let entry = if i == j { root(rest, self.at(i, i))? } else { rest / self.at(j, j) };
                self.rows[i][self.band + j - i] = entry;
            }
        }
        let solved: Vec<Vec<f64>> = self.sides.iter().map(|side| self.solve_core(side)).collect();
        for (c, side) in self.sides.iter().enumerate() {
            for (d, column) in solved.iter().enumerate() {
                self.corner[c][d] -= side.iter().zip(column).map(|(a, b)| a * b).sum::<f64>();
            }
        }
        cholesky(&mut self.corner)?;
        Some(Factored { system: self, solved })
    }

    fn at(&self, i: usize, j: usize) -> f64 {
        self.rows[i][self.band + j - i]
    }

    /// Solves with the factored band.
    fn solve_core<T: Element>(&self, right: &[T]) -> Vec<T> {
        let mut x = right[..self.core].to_vec();
        for i in 0..self.core {
            for k in i.saturating_sub(self.band)..i {
                x[i] = x[i] - x[k] * self.at(i, k);
            }
            x[i] = x[i] * (1.0 / self.at(i, i));
        }
        for i in (0..self.core).rev() {
            for k in i + 1..(i + self.band + 1).min(self.core) {
                x[i] = x[i] - x[k] * self.at(k, i);
            }
            x[i] = x[i] * (1.0 / self.at(i, i));
        }
        x
    }
}

/// A system ready for right-hand sides.
pub(super) struct Factored {
    system: Banded,
    /// The border's columns, solved with the core.
    solved: Vec<Vec<f64>>,
}

impl Factored {
    /// The solution for a right-hand side of points.
    pub(super) fn solve(&self, right: &[DVec3]) -> Vec<DVec3> {
        let mut core = self.system.solve_core(right);
        let across = |side: &Vec<f64>| side.iter().zip(&core).map(|(a, x)| *x * *a).sum::<DVec3>();
        let rest =
            self.system.sides.iter().zip(&right[self.system.core..]).map(|(side, b)| *b - across(side)).collect();
        let border = solve_dense(&self.system.corner, rest);
        for (column, value) in self.solved.iter().zip(&border) {
            for (x, share) in core.iter_mut().zip(column) {
                *x -= *value * *share;
            }
        }
        core.extend(border);
        core
    }
}

/// An element of a right-hand side: a number or a point.
trait Element: Copy + std::ops::Sub<Output = Self> + std::ops::Mul<f64, Output = Self> {}
impl Element for f64 {}
impl Element for DVec3 {}

/// Square root of the remainder of a diagonal element; `None` when only rounding error remains.
fn root(rest: f64, whole: f64) -> Option<f64> {
    (rest > 1e-14 * whole).then(|| rest.sqrt())
}

/// Replaces the lower triangle by its Cholesky factor.
fn cholesky(matrix: &mut [Vec<f64>]) -> Option<()> {
    for i in 0..matrix.len() {
        for j in 0..=i {
            let sum: f64 = (0..j).map(|k| matrix[i][k] * matrix[j][k]).sum();
            let rest = matrix[i][j] - sum;
            matrix[i][j] = if i == j { root(rest, matrix[i][i])? } else { rest / matrix[j][j] };
        }
    }
    Some(())
}

fn solve_dense(lower: &[Vec<f64>], mut x: Vec<DVec3>) -> Vec<DVec3> {
    for i in 0..x.len() {
        let sum: DVec3 = (0..i).map(|k| x[k] * lower[i][k]).sum();
        x[i] = (x[i] - sum) / lower[i][i];
    }
    for i in (0..x.len()).rev() {
        let sum: DVec3 = (i + 1..x.len()).map(|k| x[k] * lower[k][i]).sum();
        x[i] = (x[i] - sum) / lower[i][i];
    }
    x
}
