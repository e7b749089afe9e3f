//! Linear least squares by the normal equations: the unknowns, and what the residuals leave uncertain.

use super::CalibrateError;

/// An unknown is determined if its pivot is more than this fraction of its column.
const SINGULAR: f64 = 1e-10;

/// Equations `row · x = right`, all of the same weight.
pub(super) struct Equations {
    unknowns: usize,
    matrix: Vec<Vec<f64>>,
    right: Vec<f64>,
    squares: f64,
    count: usize,
}

/// The solution of equations.
pub(super) struct Solution {
    pub(super) values: Vec<f64>,
    /// Half the widths of the intervals that hold the true values with 95 % probability; infinite without spare
    /// equations.
    pub(super) within: Vec<f64>,
    /// Inverse of the normal matrix.
    inverse: Vec<Vec<f64>>,
    /// Standard error of a right side, times Student's t.
    scale: f64,
    pub(super) spare: usize,
}

impl Equations {
    pub(super) fn new(unknowns: usize) -> Self {
        Self {
            unknowns,
            matrix: vec![vec![0.0; unknowns]; unknowns],
            right: vec![0.0; unknowns],
            squares: 0.0,
            count: 0,
        }
    }

    pub(super) fn add(&mut self, row: &[f64], right: f64) {
        for (i, a) in row.iter().enumerate() {
            row.iter().zip(&mut self.matrix[i]).for_each(|(b, sum)| *sum += a * b);
            self.right[i] += a * right;
        }
        self.squares += right * right;
        self.count += 1;
    }

    /// # Errors
    /// [`CalibrateError::Undetermined`] with this remedy.
    pub(super) fn solve(&self, remedy: &'static str) -> Result<Solution, CalibrateError> {
        let inverse = inverse(&self.matrix).ok_or(CalibrateError::Undetermined(remedy))?;
        let values: Vec<f64> = inverse.iter().map(|row| dot(row, &self.right)).collect();
        let left = (self.squares - dot(&values, &self.right)).max(0.0);
        let spare = self.count.saturating_sub(self.unknowns);
        let scale = if spare == 0 { f64::INFINITY } else { (left / spare as f64).sqrt() * student(spare) };
        let within = (0..self.unknowns).map(|k| scale * inverse[k][k].max(0.0).sqrt()).collect();
        Ok(Solution { values, within, inverse, scale, spare })
    }
}

impl Solution {
    /// The same for a value that depends on the unknowns by these derivatives.
    pub(super) fn within_of(&self, derivatives: &[f64]) -> f64 {
        let rows = self.inverse.iter().map(|row| dot(row, derivatives));
        self.scale * rows.zip(derivatives).map(|(a, b)| a * b).sum::<f64>().max(0.0).sqrt()
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The inverse of a symmetric positive matrix (Gauss-Jordan); `None` if it is singular.
fn inverse(matrix: &[Vec<f64>]) -> Option<Vec<Vec<f64>>> {
    let count = matrix.len();
    let unit = |i: usize| (0..count).map(move |k| f64::from(u8::from(i == k)));
    let mut rows: Vec<Vec<f64>> =
        matrix.iter().enumerate().map(|(i, row)| row.iter().copied().chain(unit(i)).collect()).collect();
    for k in 0..count {
        let pivot = rows[k][k];
        if pivot <= SINGULAR * matrix[k][k] || !pivot.is_finite() {
            return None;
        }
        rows[k].iter_mut().for_each(|value| *value /= pivot);
        let own = rows[k].clone();
        for (_, row) in rows.iter_mut().enumerate().filter(|(i, _)| *i != k) {
            let factor = row[k];
            row.iter_mut().zip(&own).for_each(|(value, own)| *value -= factor * own);
        }
    }
    Some(rows.into_iter().map(|row| row[count..].to_vec()).collect())
}

/// The quantile 0.975 of Student's t with `spare` degrees of freedom (Abramowitz and Stegun 26.7.5, from 3 on within
/// 0.5 %).
fn student(spare: usize) -> f64 {
    let (z, n) = (1.959_964_f64, spare as f64);
    match spare {
        1 => 12.706,
        2 => 4.303,
        _ => {
            z + (z.powi(3) + z) / (4.0 * n)
                + (5.0 * z.powi(5) + 16.0 * z.powi(3) + 3.0 * z) / (96.0 * n * n)
                + (3.0 * z.powi(7) + 19.0 * z.powi(5) + 17.0 * z.powi(3) - 15.0 * z) / (384.0 * n.powi(3))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_those_of_the_tables() {
        for (spare, expected) in [(1, 12.706), (2, 4.303), (3, 3.182), (5, 2.571), (10, 2.228), (30, 2.042)] {
            assert!((student(spare) / expected - 1.0).abs() < 0.01, "{spare}: {}", student(spare));
        }
    }

    #[test]
    fn a_line_through_points_has_the_errors_of_the_textbook() {
        let mut equations = Equations::new(2);
        let points = [(0.0, 1.1), (1.0, 2.9), (2.0, 5.2), (3.0, 6.8)];
        points.iter().for_each(|(x, y)| equations.add(&[1.0, *x], *y));
        let line = equations.solve("").unwrap();
        assert!((line.values[1] - 1.94).abs() < 1e-12 && (line.values[0] - 1.09).abs() < 1e-12, "{:?}", line.values);
        // The standard error of the slope is the root of the variance over the sum of squares about the mean, here 5.
        let residuals = points.map(|(x, y)| y - 1.09 - 1.94 * x);
        let variance = residuals.iter().map(|r| r * r).sum::<f64>() / 2.0;
        assert!((line.within[1] - 4.303 * (variance / 5.0).sqrt()).abs() < 1e-9);
        let mut alike = Equations::new(2);
        (0..5).for_each(|_| alike.add(&[1.0, 2.0], 3.0));
        assert!(alike.solve("").is_err());
    }
}
