//! Seeded random numbers (SplitMix64): the same input gives the same result everywhere.

/// A generator.
pub struct Random(u64);

impl Random {
    /// The same seed gives the same numbers.
    ///
    /// ```
    /// use bead_plan::random::Random;
    ///
    /// let (mut one, mut other) = (Random::new(7), Random::new(7));
    /// assert!((0..100).all(|_| one.bits() == other.bits()));
    /// assert!((0..100).all(|_| one.below(6) < 6));
    /// ```
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// A random number of 64 bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// A random number in 0..n.
    pub fn below(&mut self, n: usize) -> usize {
        ((u128::from(self.bits()) * n as u128) >> 64) as usize
    }

    /// A random number in 0.0..1.0.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A random number from the standard normal distribution (Box and Muller 1958).
    pub fn normal(&mut self) -> f64 {
        // In the interval (0, 1], since the logarithm of 0 is not finite.
        let (radius, turn) = (1.0 - self.unit(), self.unit());
        (-2.0 * radius.ln()).sqrt() * (std::f64::consts::TAU * turn).cos()
    }
}
