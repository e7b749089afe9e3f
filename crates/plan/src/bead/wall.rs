//! How high a wall with one bead per layer grows (Li et al., section 1.2).
//!
//! The first bead is a cap of width B₁ and height h₁, cut from a circle of radius R. Every further bead has the same
//! area: a full circle of the same R less what it shares with the circle below. The distance between the two centres is
//! the rise h_n of a layer.
//!
//! Every ratio λ = B₁/h₁ > 0 has exactly one h_n. Eq (7) prints θ₁ = asin(4h₁B₁/(4h₁² + B₁²)), which is the half angle
//! of the cap only for λ ≥ 2; θ₁ = 2 atan(2h₁/B₁) is the same there, and right for higher beads too. For λ above
//! 2.62 the second bead reaches below the foot of the first; that does not affect the wall above it.
//!
//! The wire decides: [`WallBead::for_wall`] takes the area of a bead and the thickness of the wall, so that the metal
//! fed is the metal of the wall, and finds B₁ and h₁. The wall's mean thickness is 0.98 to 1.03 B₁ for λ from 2 to 2.7.

use std::f64::consts::FRAC_PI_2;

/// A bead on the substrate, and the wall of such beads on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WallBead {
    width: f64,
    height: f64,
    rise: f64,
}

/// Why the height of a wall cannot be predicted.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum WallError {
    /// Width or height is zero, negative or not a number.
    #[error("a bead of width {width} mm and height {height} mm is impossible: both must be above 0 mm.")]
    Size {
        /// Width B₁, mm.
        width: f64,
        /// Height h₁, mm.
        height: f64,
    },
    /// No bead has this ratio of width to height.
    #[error(
        "a bead of width {width} mm and height {height} mm has width/height {ratio:.3}; a wall can be predicted from \
         {min} to {max}. Check the units: both are in mm.", min = WallBead::RATIOS.0, max = WallBead::RATIOS.1
    )]
    Ratio {
        /// Width B₁, mm.
        width: f64,
        /// Height h₁, mm.
        height: f64,
        /// λ = B₁/h₁.
        ratio: f64,
    },
    /// No bead of this width gives layers of this height.
    #[error(
        "beads of width {width} mm give layers of {least:.3} to {most:.1} mm, not of {rise} mm. Check the units: both \
         are in mm."
    )]
    Rise {
        /// Width B₁, mm.
        width: f64,
        /// Wanted h_n, mm.
        rise: f64,
        /// Least possible h_n, mm.
        least: f64,
        /// Greatest possible h_n, mm.
        most: f64,
    },
    /// No bead of this area makes a wall of this thickness.
    #[error(
        "beads of {area} mm² do not make a wall {thickness} mm thick: its layers would be {rise:.3} mm high, but at most \
         {most:.1} mm is possible. Check the units: bead.width and bead.height are in mm."
    )]
    Thickness {
        /// Wanted mean thickness, mm.
        thickness: f64,
        /// Area of a bead, mm².
        area: f64,
        /// Height of a layer of that metal, mm.
        rise: f64,
        /// Greatest possible height of a layer, mm.
        most: f64,
    },
    /// A layer leans so far that it would not rise.
    #[error("layer {layer} of the wall leans {degrees:.1}° from the build direction; below 90° a layer rises.")]
    Lean {
        /// Number of the layer, from 1.
        layer: usize,
        /// Its lean, degrees.
        degrees: f64,
    },
}

impl WallBead {
    /// Least and greatest λ = B₁/h₁ that is accepted. The equations have one solution for every λ above 0, but a λ
    /// outside this range comes from a mistaken unit, not from a bead.
    pub const RATIOS: (f64, f64) = (0.05, 50.0);

    /// The wall that begins with a bead of `width` B₁ and `height` h₁ (mm).
    ///
    /// # Errors
    /// [`WallError::Size`] and [`WallError::Ratio`].
    pub fn new(width: f64, height: f64) -> Result<Self, WallError> {
        let possible = |v: f64| v.is_finite() && v > 0.0;
        if !possible(width) || !possible(height) {
            return Err(WallError::Size { width, height });
        }
        let ratio = width / height;
        if !(Self::RATIOS.0..=Self::RATIOS.1).contains(&ratio) {
            return Err(WallError::Ratio { width, height, ratio });
        }
        Ok(Self::solved(width, height))
    }

    fn solved(width: f64, height: f64) -> Self {
        let mut bead = Self { width, height, rise: 0.0 };
        // 2R cos θn, where the cosine of an angle near π/2 would lose the digits of a flat bead.
        bead.rise = 2.0 * bead.radius() * lens_complement(unit_cap(bead.cap_angle())).sin();
        bead
    }

    /// The wall of beads of `width` B₁ (mm) whose vertical layers rise by `rise` h_n (mm).
    ///
    /// # Errors
    /// [`WallError::Size`] for an impossible width, [`WallError::Rise`] where no accepted λ gives that rise.
    pub fn for_rise(width: f64, rise: f64) -> Result<Self, WallError> {
        if !(width.is_finite() && width > 0.0) {
            return Err(WallError::Size { width, height: rise });
        }
        let of_ratio = |ratio: f64| Self::solved(width, width / ratio);
        let (most, least) = (of_ratio(Self::RATIOS.0).rise, of_ratio(Self::RATIOS.1).rise);
        if !(least..=most).contains(&rise) {
            return Err(WallError::Rise { width, rise, least, most });
        }
        Ok(of_ratio(ratio_where(|ratio| of_ratio(ratio).rise <= rise)))
    }

    /// The wall of mean `thickness` (mm) made of beads of `area` (mm²): the metal of a bead fills the rise of a layer,
    /// so its layers are `area`/`thickness` high.
    ///
    /// ```
    /// use bead_plan::bead::wall::WallBead;
    ///
    /// let wall = WallBead::for_wall(6.0, 12.0)?;
    /// assert!((wall.thickness() - 6.0).abs() < 1e-9 && (wall.rise() - 2.0).abs() < 1e-9);
    /// assert_eq!(wall.total(3), wall.height() + 2.0 * wall.rise());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`WallError::Size`] for impossible values, [`WallError::Thickness`] where no accepted λ makes such a wall.
    pub fn for_wall(thickness: f64, area: f64) -> Result<Self, WallError> {
        let possible = |v: f64| v.is_finite() && v > 0.0;
        if !possible(thickness) || !possible(area) {
            return Err(WallError::Size { width: thickness, height: area / thickness });
        }
        // Thickness over rise depends on λ alone and increases with it.
        let slender = |ratio: f64| Self::solved(1.0, 1.0 / ratio).slenderness();
        let (wanted, least) = (thickness * thickness / area, slender(Self::RATIOS.0));
        if !(least..=slender(Self::RATIOS.1)).contains(&wanted) {
            return Err(WallError::Thickness { thickness, area, rise: area / thickness, most: thickness / least });
        }
        let ratio = ratio_where(|ratio| slender(ratio) >= wanted);
        let width = (area / Self::solved(1.0, 1.0 / ratio).area()).sqrt();
        Ok(Self::solved(width, width / ratio))
    }

    /// Width B₁ of the first bead, mm.
    pub fn width(&self) -> f64 {
        self.width
    }

    /// Height h₁ of the first bead, mm.
    pub fn height(&self) -> f64 {
        self.height
    }

    /// λ = B₁/h₁.
    pub fn ratio(&self) -> f64 {
        self.width / self.height
    }

    /// Mean thickness of the wall above the first bead, mm, averaged over the waves of its sides: area of a bead over
    /// rise of a layer.
    pub fn thickness(&self) -> f64 {
        self.area() / self.rise
    }

    /// Mean thickness of the wall over the rise of a layer.
    fn slenderness(&self) -> f64 {
        self.thickness() / self.rise
    }

    /// Radius R of the circle, mm (eq 7). The wall above the first bead is 2R wide.
    pub fn radius(&self) -> f64 {
        (4.0 * self.height * self.height + self.width * self.width) / (8.0 * self.height)
    }

    /// Half angle θ₁ of the first bead's cap, radians (eq 7, for every λ).
    pub fn cap_angle(&self) -> f64 {
        2.0 * (2.0 * self.height).atan2(self.width)
    }

    /// Half angle θn of the lens that two circles share, radians (eq 6).
    pub fn overlap_angle(&self) -> f64 {
        FRAC_PI_2 - lens_complement(unit_cap(self.cap_angle()))
    }

    /// Area of the cross-section of every bead, mm².
    pub fn area(&self) -> f64 {
        self.radius().powi(2) * unit_cap(self.cap_angle())
    }

    /// h_n, mm: the rise of every layer after the first in a vertical wall (eq 5).
    pub fn rise(&self) -> f64 {
        self.rise
    }

    /// Rise of layer `index` (from 0) of this thickness (mm) in the wall, mm. The first layer is thicker than its rise:
    /// the bead on the substrate is a cap, higher than the others but of the same area.
    pub fn rise_of_layer(&self, index: usize, thickness: f64) -> f64 {
        if index == 0 { self.rise } else { thickness }
    }

    /// Rise of a layer, mm, where the wall leans by `lean` (radians) from the build direction: h_n cos φ. The paper's
    /// eq (8) prints h_n sin α, which is the same with α measured from the horizontal.
    pub fn rise_leaning(&self, lean: f64) -> f64 {
        self.rise * lean.cos()
    }

    /// Height of `layers` vertical layers, mm: h₁ + (n − 1) h_n.
    pub fn total(&self, layers: usize) -> f64 {
        if layers == 0 { 0.0 } else { self.height + (layers - 1) as f64 * self.rise }
    }

    /// The number of vertical layers, at least one, whose total height is nearest to `height` (mm).
    pub fn layers_for(&self, height: f64) -> usize {
        (1.0 + ((height - self.height) / self.rise).round()).max(1.0) as usize
    }

    /// Tops of the layers, mm: the first is h₁ high, each further one rises by h_n cos φ. `leans` holds the lean φ
    /// (radians) of every layer after the first, so there is one layer more than leans.
    ///
    /// # Errors
    /// [`WallError::Lean`] where a layer leans by 90° or more.
    pub fn positions(&self, leans: &[f64]) -> Result<Vec<f64>, WallError> {
        let mut tops = vec![self.height];
        let mut top = self.height;
        for (k, lean) in leans.iter().enumerate() {
            if lean.is_nan() || lean.abs() >= FRAC_PI_2 {
                return Err(WallError::Lean { layer: k + 2, degrees: lean.to_degrees() });
            }
            top += self.rise_leaning(*lean);
            tops.push(top);
        }
        Ok(tops)
    }
}

/// The least accepted λ from which on `reached` holds.
fn ratio_where(reached: impl Fn(f64) -> bool) -> f64 {
    let (mut low, mut high) = WallBead::RATIOS;
    while high - low > 2.0 * f64::EPSILON * high {
        let middle = 0.5 * (low + high);
        *(if reached(middle) { &mut high } else { &mut low }) = middle;
    }
    high
}

/// Area of the cap with half angle θ on the unit circle.
fn unit_cap(theta: f64) -> f64 {
    theta - theta.sin() * theta.cos()
}

/// δ = π/2 − θn from eq (6), which reads 2δ + sin 2δ = `area`, for areas from 0 to π. Newton's steps within a bracket:
/// the left side increases throughout, with slope 0 only at its end. Accurate to a few roundings of δ, however flat the
/// bead.
fn lens_complement(area: f64) -> f64 {
    let (mut low, mut high) = (0.0, FRAC_PI_2);
    let mut delta = (area / 4.0).min(high);
    for _ in 0..100 {
        let miss = 2.0 * delta + (2.0 * delta).sin() - area;
        *(if miss > 0.0 { &mut high } else { &mut low }) = delta;
        let step = delta - miss / (2.0 + 2.0 * (2.0 * delta).cos());
        let next = if (low..=high).contains(&step) { step } else { 0.5 * (low + high) };
        if (next - delta).abs() <= 4.0 * f64::EPSILON * next || miss.abs() <= 2.0 * f64::EPSILON * area {
            return next;
        }
        delta = next;
    }
    delta
}
