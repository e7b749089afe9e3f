//! Sums and changes of long vectors in chunks of one size, so that results do not depend on the number of threads.

use crate::real::Field;
use rayon::prelude::*;

/// Nodes in a chunk.
const CHUNK: usize = 4096;

/// The sum of a value over all nodes.
pub(crate) fn sum<V: Sync>(values: &[V], of: impl Fn(&V) -> f64 + Sync) -> f64 {
    let parts: Vec<f64> = values.par_chunks(CHUNK).map(|chunk| chunk.iter().map(&of).sum()).collect();
    parts.iter().sum()
}

/// The scalar product of two vectors.
pub(crate) fn dot(a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
    let of = |(a, b): (&[[f64; 3]], &[[f64; 3]])| -> f64 {
        a.iter().zip(b).map(|(a, b)| a[0] * b[0] + a[1] * b[1] + a[2] * b[2]).sum()
    };
    let parts: Vec<f64> = a.par_chunks(CHUNK).zip(b.par_chunks(CHUNK)).map(of).collect();
    parts.iter().sum()
}

/// A new value for each.
pub(crate) fn map<V: Sync, W: Send>(values: &[V], of: impl Fn(&V) -> W + Sync + Send) -> Vec<W> {
    values.par_iter().with_min_len(CHUNK).map(of).collect()
}

/// Changes each entry by that of another vector.
pub(crate) fn each2<V: Send, W: Sync>(values: &mut [V], other: &[W], change: impl Fn(&mut V, &W) + Sync + Send) {
    let chunks = values.par_chunks_mut(CHUNK).zip(other.par_chunks(CHUNK));
    chunks.for_each(|(values, other)| values.iter_mut().zip(other).for_each(|(v, o)| change(v, o)));
}

/// Changes each entry by those of two other vectors.
pub(crate) fn each3<V: Send, A: Sync, B: Sync>(
    values: &mut [V],
    first: &[A],
    second: &[B],
    change: impl Fn(&mut V, &A, &B) + Sync + Send,
) {
    let chunks = values.par_chunks_mut(CHUNK).zip(first.par_chunks(CHUNK)).zip(second.par_chunks(CHUNK));
    chunks.for_each(|((values, first), second)| {
        values.iter_mut().zip(first).zip(second).for_each(|((v, a), b)| change(v, a, b));
    });
}

/// A vector of zeros.
pub(crate) fn zeros(nodes: usize) -> Field<f64> {
    vec![[0.0; 3]; nodes]
}
