//! Cladding is metal of the thickness asked for, where it is asked for, on the surface of its base.

use bead_part::chart::{Chart, Cylinder, Side};
use bead_part::cladding::{CladdingError, around, over};
use bead_part::model::{Mesh, solid::Solid};
use bead_part::task::Task;
use glam::{DQuat, DVec2, DVec3};
use planar::{Polygon, Region, Ring};
use std::f64::consts::PI;

/// A block of 160 × 100 mm whose top is a saddle.
fn saddle(up: DVec3) -> Mesh {
    let height = |p: DVec2| 30.0 + p.x * p.x / 900.0 - p.y * p.y / 500.0;
    let (columns, rows) = (64, 40);
    let place = |i: usize, j: usize| DVec2::new(2.5 * i as f64 - 80.0, 2.5 * j as f64 - 50.0);
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for (j, i) in (0..=rows).flat_map(|j| (0..=columns).map(move |i| (j, i))) {
        let p = place(i, j);
        vertices.extend([p.extend(height(p)), p.extend(0.0)]);
    }
    let top = |i: usize, j: usize| 2 * (j * (columns + 1) + i) as u32;
    for (j, i) in (0..rows).flat_map(|j| (0..columns).map(move |i| (j, i))) {
        let [a, b, c, d] = [top(i, j), top(i + 1, j), top(i + 1, j + 1), top(i, j + 1)];
        triangles.extend([[a, b, c], [a, c, d], [a + 1, c + 1, b + 1], [a + 1, d + 1, c + 1]]);
    }
    let mut side = |a: u32, b: u32| triangles.extend([[a, a + 1, b + 1], [a, b + 1, b]]);
    (0..columns).for_each(|i| {
        side(top(i, 0), top(i + 1, 0));
        side(top(i + 1, rows), top(i, rows));
    });
    (0..rows).for_each(|j| {
        side(top(columns, j), top(columns, j + 1));
        side(top(0, j + 1), top(0, j));
    });
    let turn = DQuat::from_rotation_arc(DVec3::Z, up);
    Mesh::from_triangles(vertices.into_iter().map(|p| turn * p).collect(), triangles).0
}

#[test]
fn a_surface_is_covered_evenly_whichever_way_it_faces() {
    for up in [DVec3::Z, DVec3::X, DVec3::new(0.3, -0.5, 0.81).normalize()] {
        let cladding = over(&saddle(up), up, 5.0, None, 4.0, &Task::new()).unwrap();
        let volume = cladding.mesh.volume();
        assert!((volume / (160.0 * 100.0 * 4.0) - 1.0).abs() < 0.005, "{up}: {volume}");
        let heights: Vec<f64> = cladding.mesh.vertices.iter().map(|p| cladding.chart.coordinates(*p).z).collect();
        assert!(heights.iter().all(|height| (-0.01..=4.01).contains(height)), "{up}");
    }
}

#[test]
fn an_area_limits_what_is_clad() {
    let square = |from: f64, to: f64| {
        let corners = [(from, from), (to, from), (to, to), (from, to)].map(DVec2::from);
        Region::from(Polygon::simple(Ring::new(corners.to_vec())))
    };
    let base = saddle(DVec3::Z);
    let clad = |area: &Region| over(&base, DVec3::Z, 5.0, Some(area), 4.0, &Task::new());
    assert!((clad(&square(-20.0, 30.0)).unwrap().mesh.volume() / (2500.0 * 4.0) - 1.0).abs() < 0.005);
    // Only where there is something to lie on.
    assert!((clad(&square(20.0, 300.0)).unwrap().mesh.volume() / (60.0 * 30.0 * 4.0) - 1.0).abs() < 0.005);
    assert_eq!(clad(&square(200.0, 300.0)), Err(CladdingError::NoArea));
}

#[test]
fn a_pipe_is_covered_outside_and_inside() {
    let section = [[20.0, 10.0], [28.0, 10.0], [28.0, 90.0], [20.0, 90.0]].map(DVec2::from_array);
    let axis = DVec3::new(1.0, 2.0, -2.0) / 3.0;
    let (turn, through) = (DQuat::from_rotation_arc(DVec3::Z, axis), DVec3::new(5.0, -40.0, 12.0));
    let Solid { vertices, triangles } = Solid::revolve(&section, 90);
    let base = Mesh::from_triangles(vertices.iter().map(|p| turn * *p + through).collect(), triangles).0;
    let cylinder = |radius: f64, side: Side| Cylinder { axis, through, radius, side, seam: 180.0 };
    let volume = |near: f64, far: f64, length: f64| PI * (far * far - near * near).abs() * length;
    let outer = around(&base, cylinder(28.0, Side::Outer), [None; 2], 3.0).unwrap();
    assert!((outer.mesh.volume() / volume(28.0, 31.0, 80.0) - 1.0).abs() < 0.002);
    let inner = around(&base, cylinder(20.0, Side::Inner), [Some(30.0), Some(500.0)], 2.0).unwrap();
    assert!((inner.mesh.volume() / volume(20.0, 18.0, 60.0) - 1.0).abs() < 0.002);
    assert!(matches!(inner.chart, Chart::Cylinder(Cylinder { side: Side::Inner, .. })));
    let nothing = around(&base, cylinder(20.0, Side::Outer), [None; 2], 2.0).unwrap_err().to_string();
    assert!(nothing.contains("20 mm from the axis, facing outwards"), "{nothing}");
    let beside = around(&base, cylinder(28.0, Side::Outer), [Some(100.0), None], 2.0).unwrap_err().to_string();
    assert!(beside.contains("from 10.0 to 90.0 mm"), "{beside}");
    let narrow = around(&base, cylinder(20.0, Side::Inner), [None; 2], 20.0).unwrap_err().to_string();
    assert!(narrow.contains("has no room for 20 mm"), "{narrow}");
}

#[test]
fn a_shaft_with_flanges_is_clad_between_them() {
    let shaft = bead_part::example::find("shaft").unwrap().mesh();
    let bar = Cylinder { axis: DVec3::Z, through: DVec3::ZERO, radius: 25.0, side: Side::Outer, seam: 180.0 };
    let gaps = around(&shaft, bar, [None; 2], 2.0).unwrap_err();
    let [a, b, c] = [[0.0, 30.0], [60.0, 105.0], [127.0, 160.0]];
    assert_eq!(gaps, CladdingError::Gaps { stretches: vec![a, b, c] });
    let between = around(&shaft, bar, [Some(40.0), Some(110.0)], 2.0).unwrap().mesh.bounds();
    assert!((between.0.z - 60.0).abs() < 1e-9 && (between.1.z - 105.0).abs() < 1e-9, "{between:?}");
}

/// A step beside what is clad does not pull its edge down, and roughness of a scan is no slope.
#[test]
fn steps_are_left_out_and_rough_surfaces_are_not() {
    let block = |low: [f64; 3], high: [f64; 3]| {
        let corners = [(low[0], low[1]), (high[0], low[1]), (high[0], high[1]), (low[0], high[1])].map(DVec2::from);
        Solid::extrude(&Polygon::simple(Ring::new(corners.to_vec())), low[2], high[2])
    };
    let mut base = block([0.0, 0.0, 0.0], [150.0, 90.0, 10.0]);
    let tower = block([100.0, 0.0, 10.0], [150.0, 90.0, 40.0]);
    let first = base.vertices.len() as u32;
    base.vertices.extend(tower.vertices);
    base.triangles.extend(tower.triangles.iter().map(|corners| corners.map(|corner| corner + first)));
    let base = Mesh::from_triangles(base.vertices, base.triangles).0;
    let corners = [(5.0, 5.0), (90.0, 5.0), (90.0, 85.0), (5.0, 85.0)].map(DVec2::from);
    let area = Region::from(Polygon::simple(Ring::new(corners.to_vec())));
    let below = over(&base, DVec3::Z, 5.0, Some(&area), 2.0, &Task::new()).unwrap();
    assert!((below.mesh.volume() / (85.0 * 80.0 * 2.0) - 1.0).abs() < 0.005, "{}", below.mesh.volume());
    assert!(below.bare < 1.0, "{}", below.bare);
    let rough = |k: usize| 0.2 * ((k as f64 * 12.9898).sin() * 43758.5453).fract();
    let mut scan = saddle(DVec3::Z);
    scan.vertices.iter_mut().enumerate().filter(|(_, p)| p.z > 1.0).for_each(|(k, p)| p.z += rough(k));
    let rough = over(&scan, DVec3::Z, 5.0, None, 2.0, &Task::new()).unwrap();
    assert!((rough.mesh.volume() / (160.0 * 100.0 * 2.0) - 1.0).abs() < 0.02, "{}", rough.mesh.volume());
}

/// A scan of 1 mm between its points, each 0.2 mm off, with a wall below one edge: its slopes are those of the surface, and no face of
/// it is bare.
#[test]
fn the_noise_of_a_scan_makes_no_slopes_and_no_holes() {
    let height = |p: DVec2| (250.0 * 250.0 - p.length_squared()).sqrt() - 200.0;
    let side = 101;
    let place = |k: usize| DVec2::new((k % side) as f64, (k / side) as f64) - 50.0;
    let uniform = |k: usize| ((k as f64 * 12.9898).sin() * 43758.5453).rem_euclid(1.0).max(1e-9);
    // As far off as a normal distribution of 0.2 mm has it.
    let noise = |k: usize| 0.2 * (-2.0 * uniform(k).ln()).sqrt() * (2.0 * PI * uniform(k + side * side)).cos();
    let vertices = (0..side * side).map(|k| place(k).extend(height(place(k)) + noise(k))).collect();
    let mut scan = grid(vertices, side);
    let wall = |k: usize| {
        let edge = DVec2::new(50.0, place(k).x);
        edge.extend(height(edge) - 0.4 * (k / side) as f64) + DVec3::X * noise(k + side)
    };
    // Its points lie so close together that noise turns some of its faces upwards.
    scan.add(grid((0..side * 30).map(wall).collect(), side));
    let cladding = over(&scan, DVec3::Z, 5.0, None, 2.0, &Task::new()).unwrap();
    assert!((cladding.mesh.volume() / (100.0 * 100.0 * 2.0) - 1.0).abs() < 0.005, "{}", cladding.mesh.volume());
    assert!(cladding.bare < 1.0, "{}", cladding.bare);
    let Chart::Surface(surface) = &cladding.chart else { panic!("layers over the scan") };
    let off = |k: usize| (cladding.chart.coordinates(place(k).extend(height(place(k)))).z).abs();
    // Only at corners are there too few points around.
    let far = (0..side * side).filter(|k| off(*k) > 0.15).count();
    assert!(far < side * side / 200, "{far} places");
    let steepest = (0..side * side).map(|k| surface.stretch(place(k))).fold(0.0, f64::max);
    assert!(steepest < 1.05, "{steepest}");
}

/// Faces between points in rows of a length.
fn grid(vertices: Vec<DVec3>, row: usize) -> Mesh {
    let cell = |k: usize| [[k, k + 1, k + row + 1], [k, k + row + 1, k + row]].map(|t| t.map(|corner| corner as u32));
    let cells = (0..vertices.len() - row).filter(|k| k % row + 1 < row);
    Mesh { triangles: cells.flat_map(cell).collect(), vertices, ..Mesh::default() }
}
