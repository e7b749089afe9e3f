//! Cholesky factors of a sparse matrix within its envelope, for the coarsest level.

/// A pivot below this fraction of its diagonal belongs to a motion without stiffness, and is left out.
const NO_STIFFNESS: f64 = 1e-9;

/// A symmetric matrix: each row holds the columns from its first non-zero one to the diagonal.
#[derive(Debug, Clone, Default)]
pub(crate) struct Envelope {
    firsts: Vec<usize>,
    starts: Vec<usize>,
    values: Vec<f64>,
}

impl Envelope {
    /// Zeros; `firsts` has the first column of each row.
    pub(crate) fn new(firsts: Vec<usize>) -> Self {
        let mut starts = vec![0];
        for (row, first) in firsts.iter().enumerate() {
            starts.push(starts[row] + row + 1 - first);
        }
        let values = vec![0.0; starts[firsts.len()]];
        Self { firsts, starts, values }
    }

    /// Multiplications that [`Self::factor`] takes with these first columns.
    pub(crate) fn cost(firsts: &[usize]) -> f64 {
        firsts.iter().enumerate().map(|(row, first)| 0.5 * ((row - first) as f64).powi(2)).sum()
    }

    /// Adds to the entry at a row and a column, which must not lie above the diagonal.
    pub(crate) fn add(&mut self, row: usize, column: usize, value: f64) {
        self.values[self.starts[row] + column - self.firsts[row]] += value;
    }

    /// Number of rows.
    pub(crate) fn rows(&self) -> usize {
        self.firsts.len()
    }

    fn row(&self, row: usize) -> &[f64] {
        &self.values[self.starts[row]..self.starts[row + 1]]
    }

    /// Replaces the matrix by its Cholesky factor.
    pub(crate) fn factor(&mut self) {
        for row in 0..self.firsts.len() {
            let (before, rest) = self.values.split_at_mut(self.starts[row]);
            let (first, current) = (self.firsts[row], &mut rest[..self.starts[row + 1] - self.starts[row]]);
            for column in first..row {
                let other = &before[self.starts[column]..self.starts[column + 1]];
                let from = first.max(self.firsts[column]);
                let (a, b) = (&current[from - first..column - first], &other[from - self.firsts[column]..]);
                let value = current[column - first] - dot(a, b);
                let pivot = other[column - self.firsts[column]];
                current[column - first] = if pivot > 0.0 { value / pivot } else { 0.0 };
            }
            let (own, left) = (row - first, &current[..row - first]);
            let pivot = current[own] - dot(left, left);
            // A pivot of zero marks a row that is left out.
            current[own] = if pivot > NO_STIFFNESS * current[own] { pivot.sqrt() } else { 0.0 };
        }
    }

    /// Solves with the factor, in place.
    pub(crate) fn solve(&self, values: &mut [f64]) {
        for row in 0..self.firsts.len() {
            let (first, entries) = (self.firsts[row], self.row(row));
            let pivot = entries[row - first];
            let rest = values[row] - dot(&entries[..row - first], &values[first..row]);
            values[row] = if pivot > 0.0 { rest / pivot } else { 0.0 };
        }
        for row in (0..self.firsts.len()).rev() {
            let (first, entries) = (self.firsts[row], self.row(row));
            let pivot = entries[row - first];
            let value = if pivot > 0.0 { values[row] / pivot } else { 0.0 };
            values[row] = value;
            values[first..row].iter_mut().zip(entries).for_each(|(v, e)| *v -= e * value);
        }
    }
}

/// A scalar product in eight interleaved sums.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 8];
    let (a, b) = (a.chunks_exact(8), b[..a.len()].chunks_exact(8));
    let rest: f64 = a.remainder().iter().zip(b.remainder()).map(|(x, y)| x * y).sum();
    for (x, y) in a.zip(b) {
        (0..8).for_each(|i| sums[i] += x[i] * y[i]);
    }
    sums.iter().sum::<f64>() + rest
}
