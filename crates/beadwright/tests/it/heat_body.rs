//! The heat model's voxels against closed forms: sources in an infinite body, Rosenthal's moving source, a wall cooled at
//! its end, and the balance of energy. Sources: Carslaw & Jaeger, Conduction of Heat in Solids (1959), chapter 10;
//! Rosenthal, Trans. ASME 68 (1946), 849.

use beadwright::glam::{DVec3, dvec3};
use beadwright::heat::{Air, Body, Grid, Stuff};
use std::f64::consts::PI;

/// Steel: J/(mm³·K), W/(mm·K).
const STEEL: Stuff = Stuff { capacity: 0.0045, conductivity: 0.044 };

/// Diffusivity, mm²/s.
fn diffusivity(stuff: Stuff) -> f64 {
    stuff.conductivity / stuff.capacity
}

/// A block of `counts` voxels of `size` (mm) around the origin, full of steel at 20 °C, which loses nothing.
fn block(size: f64, counts: [usize; 3], air: Air) -> Body {
    let low = -0.5 * size * DVec3::from(counts.map(|n| n as f64));
    let grid = Grid::even(low, DVec3::splat(size), counts);
    let mut body = Body::new(grid, vec![STEEL; counts[2]], air);
    body.fill(counts[2], air.ambient);
    body
}

/// Lets `seconds` pass in `steps` steps.
fn pass(body: &mut Body, seconds: f64, steps: usize) {
    (0..steps).for_each(|_| body.step(seconds / steps as f64));
}

/// Largest error over all voxels, as a fraction of the largest true rise.
fn worst(body: &Body, truth: impl Fn(DVec3) -> f64) -> f64 {
    let rises = (0..body.grid().len()).map(|v| (body.temperature(v) - 20.0, truth(body.grid().middle(v))));
    let (error, most) =
        rises.fold((0.0_f64, 0.0_f64), |(e, m), (ours, truth)| (e.max((ours - truth).abs()), m.max(truth)));
    error / most
}

/// Heats the voxels along a line (an axis, or a point) at once, lets it spread, and compares.
fn spread(axes: usize, size: f64, steps: usize) -> f64 {
    const HEAT: f64 = 5000.0;
    const SECONDS: f64 = 4.0;
    let across = (62.0 / size) as usize | 1;
    let counts = [0, 1, 2].map(|a| if a < axes { across } else { 1 });
    let mut body = block(size, counts, Air::none(20.0));
    let middle = body.grid().column(0.0, 0.0, counts[2] / 2);
    // A line source has its heat for every mm of the line, a plane source for every mm².
    body.heat(middle, HEAT * size.powi(3 - axes as i32));
    pass(&mut body, SECONDS, steps);
    let a = diffusivity(STEEL);
    let wide = 4.0 * a * SECONDS;
    worst(&body, |at| {
        let far = (0..axes).map(|axis| at[axis].powi(2)).sum::<f64>();
        HEAT / STEEL.capacity / (PI * wide).powf(axes as f64 / 2.0) * (-far / wide).exp()
    })
}

#[test]
fn sources_spread_as_in_an_infinite_body() {
    for (axes, name) in [(1, "plane"), (2, "line"), (3, "point")] {
        let errors = [(4.0, 8), (2.0, 32), (1.0, 128)].map(|(size, steps)| spread(axes, size, steps));
        println!("{name} source: error {errors:.4?} of the peak at voxels of 4, 2, 1 mm");
        assert!(errors[1] < 0.4 * errors[0] && errors[2] < 0.4 * errors[1], "{name}: {errors:?} falls too slowly");
        assert!(errors[2] < 0.005 * axes as f64, "{name}: {errors:?}");
    }
}

#[test]
fn a_moving_source_is_rosenthals() {
    /// Power, W, and speed, mm/s.
    const POWER: f64 = 400.0;
    const SPEED: f64 = 6.0;
    /// Steps in a voxel.
    const PARTS: usize = 6;
    let a = diffusivity(STEEL);
    let ambient = 20.0;
    for (thin, name) in [(true, "thin plate"), (false, "thick plate")] {
        let error_at = |size: f64| {
            let (length, wide) = (160.0, if thin { 100.0 } else { 60.0 });
            let counts =
                [(length / size) as usize, (wide / size) as usize | 1, if thin { 1 } else { (36.0 / size) as usize }];
            let mut body = block(size, counts, Air::none(ambient));
            let top = counts[2] - 1;
            let (from, to) = (-60.0, 50.0);
            let mut x: f64 = from;
            while x < to - 1e-9 {
                let voxel = body.grid().column(x + size / 2.0, 0.0, top);
                for _ in 0..PARTS {
                    body.heat(voxel, POWER * size / SPEED / PARTS as f64);
                    body.step(size / SPEED / PARTS as f64);
                }
                x += size;
            }
            let last = body.grid().middle(body.grid().column(x - size / 2.0, 0.0, top));
            // Quasi-stationary: 8 mm beside the source and behind it.
            let mut worst: f64 = 0.0;
            for (behind, beside) in [(0.0, 8.0), (10.0, 8.0), (20.0, 0.0), (20.0, 12.0), (30.0, 4.0)] {
                let near = body.grid().column(last.x - behind, last.y + beside, top);
                let at = body.grid().middle(near) - last;
                // The voxel took its heat while the source crossed it; now the source stands at its far side.
                let xi = at.x - size / 2.0;
                let truth = if thin {
                    let r = at.y.hypot(xi);
                    POWER / (2.0 * PI * STEEL.conductivity * size)
                        * (-SPEED * xi / (2.0 * a)).exp()
                        * bessel_k0(SPEED * r / (2.0 * a))
                } else {
                    // The surface of a half-space carries the source and its mirror image; ours lies half a voxel deep.
                    let r = dvec3(xi, at.y, 0.0).length();
                    POWER / (2.0 * PI * STEEL.conductivity * r) * (-SPEED * (xi + r) / (2.0 * a)).exp()
                };
                worst = worst.max((body.temperature(near) - ambient - truth).abs() / truth);
            }
            worst
        };
        let errors = [error_at(4.0), error_at(2.0), error_at(1.0)];
        println!("{name}: error {errors:.4?} at voxels of 4, 2, 1 mm");
        assert!(errors[2] < errors[0] && errors[2] < 0.06, "{name}: {errors:?}");
    }
}

/// The modified Bessel function K0 by its integral, ∫ exp(-x cosh t) dt from 0 on.
fn bessel_k0(x: f64) -> f64 {
    let (steps, end) = (4000, 12.0);
    let f = |i: usize| (-x * (end * i as f64 / steps as f64).cosh()).exp();
    let inner: f64 = (1..steps).map(f).sum();
    (0.5 * (f(0) + f(steps)) + inner) * end / steps as f64
}

#[test]
fn a_wall_cools_through_its_end() {
    // A bar at 520 °C whose end is kept at 20 °C by a large film: 1-D series of Carslaw & Jaeger, section 3.3.
    const LENGTH: f64 = 40.0;
    let error_at = |size: f64, steps: usize| {
        let count = (LENGTH / size) as usize;
        let air = Air { contact: 1e3, ..Air::none(20.0) };
        let grid = Grid::even(DVec3::ZERO, DVec3::splat(size), [1, 1, count]);
        let mut body = Body::new(grid, vec![STEEL; count], air);
        body.fill(count, 520.0);
        pass(&mut body, 30.0, steps);
        let truth = |z: f64| {
            let term = |n: usize| {
                let odd = (2 * n + 1) as f64 * PI / (2.0 * LENGTH);
                4.0 / PI / (2 * n + 1) as f64 * (odd * z).sin() * (-diffusivity(STEEL) * odd * odd * 30.0).exp()
            };
            500.0 * (0..200).map(term).sum::<f64>()
        };
        // The film acts on the lowest voxels' middles: half a voxel of steel is left out there.
        (0..count)
            .map(|v| (body.temperature(v) - 20.0 - truth(body.grid().middle(v).z - size / 2.0)).abs())
            .fold(0.0, f64::max)
            / 500.0
    };
    let errors = [error_at(4.0, 30), error_at(2.0, 120), error_at(1.0, 480)];
    println!("cooled wall: error {errors:.4?} of the first rise at voxels of 4, 2, 1 mm");
    assert!(errors[2] < 0.02 && errors[2] < 0.5 * errors[0], "{errors:?}");
}

#[test]
fn a_bare_cube_cools_as_a_lump() {
    // Of high conductivity, a cube has one temperature, which falls as its faces lose heat: exp(-hAt/C).
    let air = Air { convection: 1e-4, ..Air::none(20.0) };
    let stuff = Stuff { conductivity: 1e3, ..STEEL };
    let mut body = Body::new(Grid::even(DVec3::ZERO, DVec3::splat(2.0), [5, 5, 5]), vec![stuff; 5], air);
    body.fill(5, 520.0);
    pass(&mut body, 60.0, 600);
    // Five faces: the sixth lies on a table that takes nothing.
    let truth = 500.0 * (-1e-4 * 500.0 * 60.0 / (STEEL.capacity * 1000.0)).exp();
    let ours = body.temperature(62) - 20.0;
    assert!((ours / truth - 1.0).abs() < 1e-3, "{ours} {truth}");
}

#[test]
fn no_heat_is_lost_or_made() {
    let air = Air { ambient: 20.0, convection: 2e-5, emissivity: 0.4, contact: 2e-4 };
    let mut body = block(3.0, [15, 11, 7], air);
    for (i, seconds) in [0.1, 0.5, 2.0, 7.0, 30.0, 0.3].iter().cycle().take(60).enumerate() {
        body.heat((i * 97) % body.grid().len(), 900.0);
        body.step(*seconds);
    }
    let missing = body.supplied() - body.lost() - body.energy();
    println!("energy balance: {:.1e} of {:.0} J", missing.abs() / body.supplied(), body.supplied());
    assert!(body.lost() > 0.05 * body.supplied(), "the faces lose heat");
    assert!(missing.abs() <= 1e-9 * body.supplied(), "{missing} J");
}

#[test]
fn steps_of_any_length_make_no_new_extremes() {
    let mut body = block(2.0, [9, 9, 9], Air { convection: 1e-4, ..Air::none(20.0) });
    body.heat(364, 300.0);
    let hottest = body.temperature(364);
    for seconds in [0.01, 1.0, 100.0, 1e4] {
        body.step(seconds);
        for voxel in 0..body.grid().len() {
            let temperature = body.temperature(voxel);
            assert!((20.0 - 1e-9..=hottest).contains(&temperature), "{seconds} s: {temperature} °C");
        }
    }
}

#[test]
fn the_same_bytes_with_any_number_of_threads() {
    let run = |threads: usize| {
        let pool = rayon_pool(threads);
        pool.install(|| {
            let mut body =
                block(1.0, [40, 30, 20], Air { ambient: 20.0, convection: 1e-4, emissivity: 0.5, contact: 1e-4 });
            body.heat(12_345, 1e4);
            pass(&mut body, 20.0, 25);
            (0..body.grid().len())
                .map(|v| body.temperature(v).to_bits())
                .chain([body.lost().to_bits()])
                .collect::<Vec<_>>()
        })
    };
    assert_eq!(run(1), run(2));
    assert_eq!(run(1), run(5));
}

fn rayon_pool(threads: usize) -> rayon::ThreadPool {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap()
}
