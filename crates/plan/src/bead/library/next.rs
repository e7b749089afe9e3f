//! Which trial to weld next.

use super::least_squares::{dot, whitened};
use super::{BeadLibrary, Prediction};

/// Points tried along each input.
const ALONG: usize = 21;
/// Most points tried in all; with many inputs fewer lie along each.
const MOST: usize = 200_000;

/// The number of points along each input of a grid over this many of them.
pub(crate) fn along(inputs: usize) -> usize {
    (2..=ALONG).rev().find(|along| along.pow(inputs as u32) <= MOST).unwrap_or(2)
}

/// Points of a grid from −1 to 1 along each of this many inputs.
pub(crate) fn grid(inputs: usize) -> impl Iterator<Item = Vec<f64>> {
    let along = along(inputs);
    let point = move |mut number: usize| -> Vec<f64> {
        let next = |_| {
            let step = number % along;
            number /= along;
            2.0 * step as f64 / (along - 1) as f64 - 1.0
        };
        (0..inputs).map(next).collect()
    };
    (0..along.pow(inputs as u32)).map(point)
}

impl BeadLibrary {
    /// The bead of the measured range that tells most, with its prediction: about the bead at `wanted` (values of the inputs in
    /// the library's order), or where nothing is wanted, about the whole range.
    ///
    /// With one more bead at x, the variance at w falls by c² / (1 + l), where l is the leverage of x and c the product of w
    /// and x by (XᵀX)⁻¹ (c-optimal design; Elfving 1952, Ann. Math. Statist. 23). For the whole range, the bead is that of the
    /// largest leverage (Kiefer and Wolfowitz 1960, Canad. J. Math. 12). Both assume that the polynomial is right; repeats, and
    /// beads between, tell whether it is.
    pub fn next_trial(&self, wanted: Option<&[f64]>) -> (Vec<f64>, Prediction) {
        let toward = wanted.map(|wanted| whitened(&self.triangle, &self.row(&self.coded(wanted))));
        let tells = |coded: &[f64]| {
            let own = whitened(&self.triangle, &self.row(coded));
            let leverage = dot(&own, &own);
            toward.as_ref().map_or(leverage, |toward| dot(toward, &own).powi(2) / (1.0 + leverage))
        };
        let points = grid(self.inputs.len()).map(|point| (tells(&point), point));
        let none = (f64::NEG_INFINITY, vec![0.0; self.inputs.len()]);
        let (_, best) = points.fold(none, |best, own| if own.0 > best.0 { own } else { best });
        (self.inputs.iter().zip(&best).map(|(input, coded)| input.value(*coded)).collect(), self.at(&best))
    }
}
