//! What goes wrong with beads: too much or too little metal, varying from pass to pass, along a pass and over the
//! build.

use crate::adapt::pieces;
use crate::layer::Layer;
use crate::pass::{Along, Pass};
use crate::random::Random;

/// Errors of the metal per length, as fractions of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Errors {
    /// Standard deviation from pass to pass.
    pub pass: f64,
    /// Standard deviation along a pass.
    pub along: f64,
    /// Distance along a pass over which the correlation of its error falls to 1/e, mm.
    pub correlation: f64,
    /// Relative growth of the metal from the first to the last layer.
    pub drift: f64,
    /// Number of the pass that is lost because its arc does not burn, counted from 1 over the build.
    pub lost: Option<usize>,
    /// Standard deviation of a point of a scan, mm.
    pub scan: f64,
    /// Seed of the random numbers.
    pub seed: u64,
}

/// Least and greatest metal of a bead that is laid at all, as fractions of what is commanded.
const METAL: (f64, f64) = (0.2, 2.0);
/// Metal of a lost pass, as a fraction: too little to matter, but its path is kept.
const LOST: f64 = 1e-6;
/// Number of pieces per correlation length; within each the error is constant.
const PIECES: f64 = 8.0;

impl Errors {
    /// A layer as it comes out, when a `share` (0 to 1) of the build and `done` passes of it are laid.
    pub(super) fn layer(&self, layer: &Layer, share: f64, done: usize) -> Layer {
        let pass = |(i, pass): (usize, &Pass)| {
            if self.lost == Some(done + i + 1) {
                return Pass { pace: pass.pace.map(|pace| pace / LOST), ..pass.clone() };
            }
            self.pass(pass, share, self.random([layer.index, i + 1]))
        };
        Layer { passes: layer.passes.iter().enumerate().map(pass).collect(), ..layer.clone() }
    }

    /// A pass as it comes out. Along it the error is a normally distributed Markov chain; its correlation falls as
    /// e^(−s/length).
    fn pass(&self, pass: &Pass, share: f64, mut random: Random) -> Pass {
        let mut pass = pieces(pass, self.correlation / PIECES);
        let whole = (1.0 + self.pass * random.normal()) * (1.0 + self.drift * share);
        let mut along = random.normal();
        let mut lay = |(length, pace): (f64, f64)| {
            let metal = whole * (1.0 + self.along * along);
            let kept = (-length / self.correlation).exp();
            along = kept * along + (1.0 - kept * kept).sqrt() * random.normal();
            pace / metal.clamp(METAL.0, METAL.1)
        };
        let segments: Vec<(f64, f64)> = pass.segments().map(|s| (s.length(), s.pace)).collect();
        let mut paces: Vec<f64> = segments.into_iter().map(&mut lay).collect();
        paces.extend(paces.last().copied().filter(|_| !pass.closed));
        pass.pace = Along::Each(paces);
        pass
    }

    /// The noise of the scan after a layer, mm.
    pub(super) fn scan(&self, layer: usize) -> impl FnMut() -> f64 + use<> {
        let (mut random, deviation) = (self.random([layer, 0]), self.scan);
        move || deviation * random.normal()
    }

    /// A random generator for each pass, so that every build with the same seed meets the same errors.
    fn random(&self, [layer, pass]: [usize; 2]) -> Random {
        let mut random = Random::new(self.seed);
        let seed = [layer as u64, pass as u64]
            .into_iter()
            .fold(random.bits(), |seed, number| Random::new(seed ^ number.wrapping_mul(0x9E37_79B9_7F4A_7C15)).bits());
        Random::new(seed)
    }
}
