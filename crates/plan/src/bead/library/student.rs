//! Student's t for intervals.

use std::f64::consts::FRAC_PI_2;

/// The t that a Student variable with `degrees` degrees of freedom exceeds in absolute value with a probability of 5 %.
/// Found by bisection on the finite sums of Abramowitz & Stegun 26.7.3 and 26.7.4; error below 1e-9. Above 1000
/// degrees, the value for 1000 (1.962) is used.
pub fn t_95(degrees: usize) -> f64 {
    let degrees = degrees.clamp(1, 1000);
    let (mut low, mut high) = (0.0, 20.0);
    while high - low > 1e-10 {
        let middle = 0.5 * (low + high);
        *(if inside(middle, degrees) < 0.95 { &mut low } else { &mut high }) = middle;
    }
    0.5 * (low + high)
}

/// The probability of a value between −t and t.
fn inside(t: f64, degrees: usize) -> f64 {
    let theta = (t / (degrees as f64).sqrt()).atan();
    let (sine, cosine) = theta.sin_cos();
    let odd = degrees % 2 == 1;
    let (mut term, mut sum) = if odd { (cosine, 0.0) } else { (1.0, 0.0) };
    for k in (if odd { 1 } else { 0 }..degrees.saturating_sub(1)).step_by(2) {
        sum += term;
        let k = k as f64;
        term *= cosine * cosine * (k + 1.0) / (k + 2.0);
    }
    if odd { (theta + sine * sum) / FRAC_PI_2 } else { sine * sum }
}

#[cfg(test)]
mod tests {
    use super::t_95;

    #[test]
    fn agrees_with_the_printed_tables() {
        for (degrees, t) in
            [(1, 12.706), (2, 4.303), (3, 3.182), (4, 2.776), (5, 2.571), (10, 2.228), (30, 2.042), (120, 1.980)]
        {
            assert!((t_95(degrees) - t).abs() < 5.1e-4, "{degrees}: {}", t_95(degrees));
        }
    }
}
