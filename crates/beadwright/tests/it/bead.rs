//! The bead's formulas against integrals and the numbers of the papers.

use beadwright::bead::{Bead, MassBalance, Overlap, wire_area};
use std::f64::consts::PI;

fn check(found: f64, expect: f64) {
    assert!((found - expect).abs() <= 1e-9 * expect.abs(), "{found} is not {expect}");
}

fn beads() -> impl Iterator<Item = Bead> {
    [(7.54, 2.145), (5.0, 1.5), (3.0, 1.0), (0.4, 0.2)].into_iter().map(|(width, height)| Bead::parabola(width, height))
}

#[test]
fn area_is_the_integral_of_the_parabola() {
    for bead in beads() {
        // Simpson's rule is exact for a parabola.
        let height = |x: f64| bead.height * (1.0 - (2.0 * x / bead.width).powi(2));
        let (n, step) = (200, bead.width / 200.0);
        let at = |i: usize| -bead.width / 2.0 + i as f64 * step;
        let simpson = |i: usize| step / 6.0 * (height(at(i)) + 4.0 * height(at(i) + step / 2.0) + height(at(i) + step));
        check(bead.area(), (0..n).map(simpson).sum());
    }
}

#[test]
fn rise_spreads_the_area_over_the_stepover() {
    for bead in beads() {
        for ratio in [0.5, 0.715, 0.738, 1.0] {
            check(bead.rise(ratio * bead.width) * ratio * bead.width, bead.area());
        }
    }
}

#[test]
fn for_rise_is_the_inverse_of_rise() {
    for bead in beads() {
        let stepover = 0.7 * bead.width;
        let again = bead.for_rise(stepover, bead.rise(stepover));
        check(again.height, bead.height);
        check(bead.for_rise(stepover, 2.0).rise(stepover), 2.0);
    }
}

#[test]
fn overlap_ratios_are_those_of_the_papers() {
    assert_eq!(Overlap::Tangent.ratio(), Some(0.738));
    assert_eq!(Overlap::InclinedFlatTop.ratio(), Some(0.715));
    assert_eq!(Overlap::Free.ratio(), None);
}

#[test]
fn mass_balance_weighs_wire_against_bead() {
    let bead = Bead::parabola(6.0, 2.0);
    // 6 m/min are 100 mm/s; a bead of 8 mm² at 10 mm/s takes 80 mm³/s.
    let balance = MassBalance::new(bead, 6.0, 1.2, 0.9, 10.0);
    check(wire_area(1.2), PI * 0.36);
    check(balance.wire, 100.0 * PI * 0.36 * 0.9);
    check(balance.bead, 80.0);
    check(balance.ratio(), 100.0 * PI * 0.36 * 0.9 / 80.0);
    check(balance.fitting_speed, 100.0 * PI * 0.36 * 0.9 / 8.0);
    check(MassBalance::new(bead, 6.0, 1.2, 0.9, balance.fitting_speed).ratio(), 1.0);
}

#[test]
fn five_per_cent_are_tolerated_and_no_more() {
    let bead = Bead::parabola(6.0, 2.0);
    let fitting = MassBalance::new(bead, 6.0, 1.2, 1.0, 1.0).fitting_speed;
    for (ratio, warns) in [(0.94, true), (0.951, false), (1.0, false), (1.049, false), (1.06, true)] {
        let warning = MassBalance::new(bead, 6.0, 1.2, 1.0, fitting / ratio).warning();
        assert_eq!(warning.is_some(), warns, "{ratio}: {warning:?}");
        assert!(warning.is_none_or(|w| w.contains(&format!("{fitting:.2} mm/s would fit"))));
    }
}
