//! Bodies whose displacement is known from a formula.

use distort::{Body, DVec3, Elastic, Grid, Solved};

const STEEL: Elastic = Elastic { young: 210e3, poisson: 0.3 };
/// Without contraction across, formulas of beams and strips hold exactly.
const PLAIN: Elastic = Elastic { young: 210e3, poisson: 0.0 };

fn full(counts: [usize; 3], sides: DVec3, elastic: Elastic) -> Body {
    let size = sides / DVec3::new(counts[0] as f64, counts[1] as f64, counts[2] as f64);
    let mut body = Body::new(Grid { counts, size, low: DVec3::ZERO }, elastic).unwrap();
    body.fill_all();
    body
}

/// Holds three corners so that the body can neither move nor turn, and nothing else.
fn on_three_points(body: &mut Body) {
    let [nx, ny, _] = body.grid().counts;
    let k = 1e5;
    for (at, stiffness) in
        [([0, 0, 0], DVec3::splat(k)), ([nx, 0, 0], DVec3::new(0.0, k, k)), ([0, ny, 0], DVec3::new(0.0, 0.0, k))]
    {
        let node = body.grid().node(at);
        body.hold(node, stiffness);
    }
}

/// Curvature 1/mm of the line y = 0, z = 0 about y, by the sagitta of the middle half.
fn curvature(body: &Body, solved: &Solved) -> f64 {
    let nx = body.grid().counts[0];
    let z = |i: usize| solved.at(body.grid().node([i, 0, 0])).unwrap().z;
    let span = body.grid().size.x * (nx / 2) as f64;
    let (a, b, c) = (nx / 4, nx / 2, nx / 4 + nx / 2);
    assert_eq!(c - b, b - a);
    (z(a) - 2.0 * z(b) + z(c)) / (span / 2.0).powi(2)
}

/// A cantilever with a force at its end: F L³/3EI and the shear of a rectangle, 6/5 F L/(G A).
#[test]
fn cantilever() {
    let (length, width, height, force) = (100.0, 10.0, 10.0, 1000.0);
    let mut errors = Vec::new();
    for n in [1usize, 2, 4] {
        let mut body = full([10 * n, n, n], DVec3::new(length, width, height), PLAIN);
        let grid = *body.grid();
        let share = |k: usize, n: usize| if k == 0 || k == n { 0.5 / n as f64 } else { 1.0 / n as f64 };
        for j in 0..=n {
            for k in 0..=n {
                body.hold(grid.node([0, j, k]), DVec3::splat(1e10));
                let part = share(j, n) * share(k, n);
                body.push(grid.node([10 * n, j, k]), DVec3::Z * force * part);
            }
        }
        let solved = body.solve(1e-10).unwrap();
        let tip = solved.at(grid.node([10 * n, 0, 0])).unwrap().z;
        let (inertia, shear) = (width * height.powi(3) / 12.0, PLAIN.young / 2.0);
        let exact =
            force * length.powi(3) / (3.0 * PLAIN.young * inertia) + 1.2 * force * length / (shear * width * height);
        errors.push((tip / exact - 1.0).abs());
        println!(
            "cantilever, {n} through the height: {tip:.6} mm, exact {exact:.6}, error {:.3} %, {} iterations",
            100.0 * (tip / exact - 1.0),
            solved.iterations
        );
    }
    assert!(errors[0] < 0.005 && errors[1] < 0.6 * errors[0] && errors[2] < 0.4 * errors[1], "{errors:?}");
}

/// A body that is warmer everywhere grows and has no stress.
#[test]
fn free_expansion() {
    let mut body = full([7, 5, 3], DVec3::new(70.0, 40.0, 12.0), STEEL);
    on_three_points(&mut body);
    let strain = 12e-6 * 500.0;
    for voxel in 0..body.grid().voxels() {
        body.strain(voxel, [strain, strain, strain, 0.0, 0.0, 0.0]).unwrap();
    }
    let solved = body.solve(1e-12).unwrap();
    for (&node, moved) in solved.nodes.iter().zip(&solved.moved) {
        assert!((*moved - strain * body.grid().place(node)).length() < 1e-10, "{moved}");
    }
    let stress = solved.stresses.iter().flat_map(|(_, s)| *s).fold(0.0, |a: f64, s| a.max(s.abs()));
    let blocked = STEEL.young * strain / (1.0 - 2.0 * STEEL.poisson);
    println!(
        "free expansion: largest stress {stress:.1e} MPa, {blocked:.0} if it were held; energy {:.1e}",
        solved.energy
    );
    assert!(stress < 1e-9 * blocked);
}

/// Timoshenko 1925: a strip of two metals, warmer by ΔT.
fn bimetal(elastic: Elastic, layers: usize) -> f64 {
    let (lower, upper, expansion, young_ratio) = (4.0, 4.0, 1e-3, 0.5);
    let mut body = full([20 * layers, layers, 2 * layers], DVec3::new(160.0, 4.0, lower + upper), elastic);
    on_three_points(&mut body);
    for voxel in 0..body.grid().voxels() {
        if body.grid().voxel_at(voxel)[2] < layers {
            body.strain(voxel, [expansion, expansion, expansion, 0.0, 0.0, 0.0]).unwrap();
        } else {
            body.fill(voxel, young_ratio).unwrap();
        }
    }
    let solved = body.solve(1e-11).unwrap();
    let (m, n, h) = (lower / upper, 1.0 / young_ratio, lower + upper);
    let stiffness = 3.0 * (1.0 + m).powi(2) + (1.0 + m * n) * (m * m + 1.0 / (m * n));
    let exact = 6.0 * expansion * (1.0 + m).powi(2) / (h * stiffness);
    let error = curvature(&body, &solved).abs() / exact - 1.0;
    println!("bimetal strip, ν {}: {layers} voxels per metal, error {:.5} %", elastic.poisson, 100.0 * error);
    error.abs()
}

#[test]
fn bimetal_strip() {
    // One voxel per metal is enough, since each bends exactly.
    assert!([1, 2, 4].map(|layers| bimetal(PLAIN, layers)).into_iter().all(|error| error < 1e-5));
    // With contraction across, the strip also bends across near the seam, which the formula leaves out.
    assert!([1, 2, 4].map(|layers| bimetal(STEEL, layers)).into_iter().all(|error| error < 0.02));
}

/// Thin plates, blocks and walls take about as many iterations.
#[test]
fn iterations() {
    for (counts, sides) in [
        ([100, 100, 3], [300.0, 300.0, 9.0]),
        ([50, 50, 50], [150.0, 150.0, 150.0]),
        ([100, 2, 60], [300.0, 6.0, 180.0]),
        ([30, 30, 3], [90.0, 90.0, 9.0]),
    ] {
        let mut body = full(counts, DVec3::from_array(sides), STEEL);
        on_three_points(&mut body);
        for i in 10..30 {
            let voxel = body.grid().voxel([i, counts[1] / 2, counts[2] - 1]);
            body.strain(voxel, [-0.002, -0.001, 0.0, 0.0, 0.0, 0.0]).unwrap();
        }
        let solved = body.solve(1e-9).unwrap();
        println!("{counts:?}: {} iterations, residual {:.1e}", solved.iterations, solved.residual);
        assert!(solved.iterations < 30 && solved.residual < 2e-9);
        let load: DVec3 = solved.reactions.iter().sum();
        assert!(load.length() < 1e-4 && solved.spring_energy < 1e-8 * solved.energy, "three points carry nothing");
    }
}
