//! Height prediction of walls against integrals and closed forms.

use beadwright::bead::wall::{WallBead, WallError};
use proptest::prelude::*;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_3, PI};

fn wall(width: f64, height: f64) -> WallBead {
    WallBead::new(width, height).unwrap()
}

/// The area between the upper circle and the lower one, by Simpson's rule over the height, split where widths kink.
fn crescent(radius: f64, rise: f64) -> f64 {
    let width = |z: f64| 2.0 * (radius * radius - z * z).max(0.0).sqrt();
    let added = |z: f64| (width(z - rise) - width(z)).max(0.0);
    let cuts = [rise / 2.0, radius.min(rise + radius), rise + radius];
    cuts.windows(2).map(|w| integral(added, w[0], w[1])).sum()
}

/// ∫ f over [a, b] with the substitution z = m − h cos t, which takes the roots out of the ends.
fn integral(f: impl Fn(f64) -> f64, a: f64, b: f64) -> f64 {
    let (middle, half, n) = ((a + b) / 2.0, (b - a) / 2.0, 4000);
    let g = |t: f64| f(middle - half * t.cos()) * half * t.sin();
    let step = PI / f64::from(n);
    let at = |i: i32| f64::from(i) * step;
    (0..n).map(|i| step / 6.0 * (g(at(i)) + 4.0 * g(at(i) + step / 2.0) + g(at(i) + step))).sum()
}

#[test]
fn every_further_bead_has_the_area_of_the_first() {
    for ratio in [0.3, 1.0, 1.9, 2.0, 2.1, 2.5, 3.0, 6.0, 20.0] {
        let bead = wall(4.0, 4.0 / ratio);
        let (r, centre) = (bead.radius(), bead.height() - bead.radius());
        let cap = integral(|z| 2.0 * (r * r - (z - centre).powi(2)).max(0.0).sqrt(), 0.0, bead.height());
        assert!((cap - bead.area()).abs() < 1e-6 * cap, "{ratio}: {cap} {}", bead.area());
        assert!((crescent(r, bead.rise()) - cap).abs() < 1e-6 * cap, "{ratio}: {} {cap}", crescent(r, bead.rise()));
    }
}

#[test]
fn half_a_circle_has_a_closed_form() {
    // λ = 2: eq (6) becomes x + sin x = π/2 with x = 2δ, solved by π/2 less the fixed point of the cosine.
    let mut dottie: f64 = 0.7;
    for _ in 0..200 {
        dottie = dottie.cos();
    }
    let bead = wall(4.0, 2.0);
    assert!((bead.radius() - 2.0).abs() < 1e-15 && (bead.cap_angle() - FRAC_PI_2).abs() < 1e-15);
    assert!((bead.rise() - 4.0 * ((FRAC_PI_2 - dottie) / 2.0).sin()).abs() < 1e-14);
}

#[test]
fn a_flat_bead_rises_as_its_enlargement_does() {
    // The first two once lost digits, through the cosine of an angle near π/2.
    let cases = (0..4000).map(|step| (0.2 + 0.01 * f64::from(step), 49.9 - 0.01 * f64::from(step)));
    let found = [(18.412292986942457, 3.821226067792077_f64.exp()), (9.316604270137224, 3.2265252049767947_f64.exp())];
    for (width, ratio) in found.into_iter().chain(cases) {
        let (bead, scaled) = (wall(width, width / ratio), wall(3.0 * width, 3.0 * (width / ratio)));
        let off = scaled.rise() / (3.0 * bead.rise()) - 1.0;
        assert!(off.abs() < 1e-13, "width {width} mm, ratio {ratio}: {off:e}");
    }
}

#[test]
fn the_papers_angle_is_ours_where_it_holds() {
    for ratio in [2.0, 2.5, 3.0, 10.0, 50.0] {
        let (b, h): (f64, f64) = (4.0, 4.0 / ratio);
        let printed = (4.0 * h * b / (4.0 * h * h + b * b)).min(1.0).asin();
        assert!((wall(b, h).cap_angle() - printed).abs() < 1e-7, "{ratio}");
    }
}

#[test]
fn leaning_layers_rise_less() {
    let bead = wall(4.0, 1.6072);
    let tops = bead.positions(&[0.0, FRAC_PI_3, -FRAC_PI_3]).unwrap();
    let expect = [bead.height(), bead.total(2), bead.total(2) + bead.rise() / 2.0, bead.total(3)];
    assert!(tops.iter().zip(expect).all(|(a, b)| (a - b).abs() < 1e-12), "{tops:?}");
    let refused = bead.positions(&[0.0, 1.6]).unwrap_err();
    assert!(refused.to_string().starts_with("layer 3 of the wall leans 91.7°"), "{refused}");
    assert!(bead.positions(&[f64::NAN]).is_err());
}

#[test]
fn what_is_no_bead_is_refused() {
    for (width, height) in [(0.0, 1.0), (1.0, -1.0), (f64::NAN, 1.0), (1.0, f64::INFINITY)] {
        assert!(matches!(WallBead::new(width, height), Err(WallError::Size { .. })));
    }
    for (width, height) in [(4.0, 0.01), (0.1, 4.0), (1e-300, 1e300)] {
        let refused = WallBead::new(width, height).unwrap_err();
        assert!(refused.to_string().contains("from 0.05 to 50"), "{refused}");
    }
    for (thickness, area) in [(0.0, 1.0), (4.0, f64::NAN), (4.0, 0.0), (4.0, 1e-5), (4.0, 21.0)] {
        assert!(WallBead::for_wall(thickness, area).is_err(), "{thickness} {area}");
    }
    let refused = WallBead::for_wall(4.0, 24.0).unwrap_err().to_string();
    assert!(refused.contains("its layers would be 6.000 mm high"), "{refused}");
    assert!(WallBead::for_rise(4.0, 1e3).is_err() && WallBead::for_rise(4.0, f64::NAN).is_err());
}

proptest! {
    #[test]
    fn every_ratio_solves_the_equations(width in 0.2f64..40.0, exponent in -2.9f64..3.9) {
        let bead = wall(width, width / exponent.exp());
        let (t1, tn) = (bead.cap_angle(), bead.overlap_angle());
        let miss = PI - 2.0 * tn + 2.0 * tn.sin() * tn.cos() - (t1 - t1.sin() * t1.cos());
        prop_assert!(miss.abs() < 1e-14, "{miss}");
        prop_assert!(bead.rise() > 0.0 && bead.rise() < 2.0 * bead.radius());
        // A higher bead of the same width rises more; the scale does not matter.
        prop_assert!(wall(width, bead.height() * 1.01).rise() > bead.rise());
        prop_assert!((wall(3.0 * width, 3.0 * bead.height()).rise() - 3.0 * bead.rise()).abs() < 1e-12 * bead.rise());
        let again = WallBead::for_rise(width, bead.rise()).unwrap();
        prop_assert!((again.height() - bead.height()).abs() < 1e-10 * bead.height());
        // The metal of a bead and the thickness of its wall determine the bead.
        let again = WallBead::for_wall(bead.thickness(), bead.area()).unwrap();
        prop_assert!((again.width() / width - 1.0).abs() < 1e-9 && (again.height() / bead.height() - 1.0).abs() < 1e-9);
        prop_assert!((again.rise() * bead.thickness() / bead.area() - 1.0).abs() < 1e-9);
    }
}
