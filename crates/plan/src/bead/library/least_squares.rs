//! Least squares by Householder reflections, adding columns one after another.
//!
//! A column that depends linearly on earlier ones is left out and reported, so a design with too few measurements in
//! some direction is fitted with fewer terms instead of wild coefficients.

/// A column depends on the earlier ones when less than this fraction of its length is independent of them.
const DEPENDENT: f64 = 1e-7;

/// Q·R of a matrix given by columns.
#[derive(Debug, Clone)]
pub(crate) struct Factored {
    /// Numbers of the columns that were kept, ascending.
    pub(super) kept: Vec<usize>,
    /// Columns of the upper triangle R: column j has j + 1 entries.
    pub(super) triangle: Vec<Vec<f64>>,
    reflectors: Vec<Vec<f64>>,
}

impl Factored {
    /// Factors `columns`; all have the same length, which is at least the number of columns.
    pub(crate) fn new(columns: &[Vec<f64>]) -> Self {
        let mut done = Self { kept: Vec::new(), triangle: Vec::new(), reflectors: Vec::new() };
        for (number, column) in columns.iter().enumerate() {
            done.take(number, column);
        }
        done
    }

    /// The standard error of a coefficient (its number among the kept columns) where values scatter by 1.
    pub(crate) fn error_of(&self, coefficient: usize) -> f64 {
        let row: Vec<f64> = (0..self.kept.len()).map(|k| f64::from(u8::from(k == coefficient))).collect();
        leverage(&self.triangle, &row).sqrt()
    }

    fn take(&mut self, number: usize, column: &[f64]) {
        let mut rest = column.to_vec();
        self.reflect(&mut rest);
        let k = self.kept.len();
        let length = norm(&rest[k..]);
        if length <= DEPENDENT * norm(column) {
            return;
        }
        let diagonal = if rest[k] > 0.0 { -length } else { length };
        let mut reflector = rest[k..].to_vec();
        reflector[0] -= diagonal;
        let scale = norm(&reflector);
        reflector.iter_mut().for_each(|v| *v /= scale);
        rest.truncate(k);
        rest.push(diagonal);
        self.kept.push(number);
        self.triangle.push(rest);
        self.reflectors.push(reflector);
    }

    /// Qᵀ·y, in place.
    fn reflect(&self, y: &mut [f64]) {
        for (k, reflector) in self.reflectors.iter().enumerate() {
            let along = 2.0 * dot(reflector, &y[k..]);
            y[k..].iter_mut().zip(reflector).for_each(|(y, v)| *y -= along * v);
        }
    }

    /// The coefficients with which the kept columns best approximate `y`.
    pub(crate) fn solve(&self, y: &[f64]) -> Vec<f64> {
        let mut x = y.to_vec();
        self.reflect(&mut x);
        x.truncate(self.kept.len());
        for j in (0..x.len()).rev() {
            let column = &self.triangle[j];
            x[j] /= column[j];
            let (above, here) = x.split_at_mut(j);
            above.iter_mut().zip(column).for_each(|(x, r)| *x -= here[0] * r);
        }
        x
    }
}

/// Leverage of a row of terms: rowᵀ (XᵀX)⁻¹ row, from the triangle R of X.
pub(super) fn leverage(triangle: &[Vec<f64>], row: &[f64]) -> f64 {
    let u = whitened(triangle, row);
    dot(&u, &u)
}

/// R⁻ᵀ row: products of two such vectors are those of the rows by (XᵀX)⁻¹.
pub(super) fn whitened(triangle: &[Vec<f64>], row: &[f64]) -> Vec<f64> {
    let mut u: Vec<f64> = Vec::with_capacity(row.len());
    for (column, value) in triangle.iter().zip(row) {
        let rest = value - dot(&column[..u.len()], &u);
        u.push(rest / column[u.len()]);
    }
    u
}

pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn norm(v: &[f64]) -> f64 {
    dot(v, v).sqrt()
}
