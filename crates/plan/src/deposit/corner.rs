//! The area that a bead covers twice where it turns (Han et al. 2018, eqs 10 and 11).

use crate::pass::Pass;
use std::f64::consts::{FRAC_PI_2, PI};

/// Doubly covered area, mm², at a turn whose legs enclose `angle` θ (radians, 0 to π): r² (cot(θ/2) + θ/2 − π/2), with
/// r half the bead width (mm). The same area is missed on the outer side. Zero at π, unbounded towards 0.
pub fn doubled_area(width: f64, angle: f64) -> f64 {
    let (r, half) = (width / 2.0, angle / 2.0);
    r * r * (1.0 / half.tan() + half - FRAC_PI_2)
}

/// The sum over the turns of a pass, mm². Where legs are shorter than the overlap, the area is limited to width × the
/// shorter leg.
pub fn doubled_area_of(pass: &Pass) -> f64 {
    let segments: Vec<_> = pass.segments().collect();
    let closing = pass.closed.then(|| segments.last().zip(segments.first())).flatten();
    let turns = segments.windows(2).map(|pair| (&pair[0], &pair[1])).chain(closing);
    let area = |(a, b): (&crate::pass::Segment, &crate::pass::Segment)| {
        let (back, on) = (a.from - a.to, b.to - b.from);
        let angle = if back.length() > 0.0 && on.length() > 0.0 { back.angle_between(on) } else { PI };
        let most = a.width * back.length().min(on.length());
        doubled_area(a.width, angle.max(1e-6)).min(most)
    };
    turns.map(area).sum()
}
