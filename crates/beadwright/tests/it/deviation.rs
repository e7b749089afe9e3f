//! Distances of a scan from its part are those of closed forms, at any angle and for whatever the scan saw.

use crate::solids;

use beadwright::adapt::scan;
use beadwright::deviation::{Deviation, DeviationError, Doubt, deviation};
use beadwright::model::Units;
use beadwright::{Mesh, Task, example};
use glam::{DMat3, DVec2, DVec3};
use solids::{binary, cuboid, imported, moved, prism, sphere, split};

fn compared(part: &Mesh, points: &[DVec3]) -> Deviation {
    deviation(part, points, 1.0, &Task::new()).unwrap()
}

fn turn(degrees: [f64; 3]) -> DMat3 {
    let [x, y, z] = degrees.map(f64::to_radians);
    DMat3::from_rotation_z(z) * DMat3::from_rotation_y(y) * DMat3::from_rotation_x(x)
}

const TURNS: [[f64; 3]; 4] = [[0.0; 3], [0.0, 0.0, 33.0], [17.0, -48.0, 5.0], [90.0, 45.0, 211.0]];

fn turned(mesh: &Mesh, by: DMat3) -> Mesh {
    Mesh { vertices: mesh.vertices.iter().map(|v| by * *v).collect(), ..mesh.clone() }
}

fn ball(radius: f64) -> Mesh {
    imported(&moved(&sphere(radius, 40), DVec3::new(0.0, 0.0, -radius))).mesh
}

#[test]
fn a_ball_half_a_millimetre_larger_lies_half_a_millimetre_outside() {
    for by in TURNS.map(turn) {
        let part = turned(&ball(20.0), by);
        let figures = compared(&part, &turned(&ball(20.5), by).vertices).figures;
        // A corner of the larger ball is nearest to that of the smaller one: files have 24 bits.
        assert!((figures.mean - 0.5).abs() < 1e-5 && figures.standard_deviation < 1e-5, "{figures:?}");
        assert_eq!((figures.within, figures.above, figures.below), (1.0, 0.0, 0.0));
        // The flat faces of the larger one lie within the ball by 20 (1 − cos 2.25°) and another as much at most.
        let figures = compared(&part, &turned(&ball(19.5), by).vertices).figures;
        let sagitta = 2.0 * 20.0 * (1.0 - 2.25_f64.to_radians().cos());
        assert!(figures.lowest.distance > -0.5 && figures.highest.distance < sagitta - 0.5, "{figures:?}");
        assert_eq!((figures.within, figures.above, figures.below), (0.0, 0.0, 1.0));
    }
}

/// Signed distance from a ring, mm: above 0 outside.
fn from_ring(ring: &[(f64, f64)], p: DVec2) -> f64 {
    let edges = || ring.iter().zip(ring.iter().cycle().skip(1)).map(|(a, b)| (DVec2::from(*a), DVec2::from(*b)));
    let far = |(a, b): (DVec2, DVec2)| {
        let part = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
        p.distance(a.lerp(b, part))
    };
    let crossed =
        edges().filter(|(a, b)| (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x));
    let distance = edges().map(far).fold(f64::INFINITY, f64::min);
    if crossed.count() % 2 == 1 { -distance } else { distance }
}

/// Signed distance from what stands on a ring: the nearest of walls and caps, and over an edge that to it.
fn from_prism(ring: &[(f64, f64)], height: f64, p: DVec3) -> f64 {
    let apart = DVec2::new(from_ring(ring, p.truncate()), (p.z - height / 2.0).abs() - height / 2.0);
    apart.max(DVec2::ZERO).length() + apart.max_element().min(0.0)
}

const BOX: [(f64, f64); 4] = [(0.0, 0.0), (40.0, 0.0), (40.0, 30.0), (0.0, 30.0)];
const ANGLE: [(f64, f64); 6] = [(0.0, 0.0), (40.0, 0.0), (40.0, 12.0), (15.0, 12.0), (15.0, 30.0), (0.0, 30.0)];
const WEDGE: [(f64, f64); 3] = [(0.0, 0.0), (40.0, 0.0), (38.0, 7.0)];

/// Points in and around a part 40 × 30 × 20 mm: a lattice that is aligned with nothing.
fn cloud() -> Vec<DVec3> {
    let point = |i: u32| {
        let at = DVec3::new(0.754_877, 0.569_840, 0.618_034) * f64::from(i);
        (at - at.floor()) * DVec3::new(60.0, 50.0, 40.0) - DVec3::splat(10.0)
    };
    (0..4000).map(point).collect()
}

#[test]
fn every_point_has_the_distance_of_the_closed_form_inside_and_outside() {
    for ring in [&BOX[..], &ANGLE, &WEDGE] {
        let part = imported(&split(&prism(ring, 20.0))).mesh;
        for by in TURNS.map(turn) {
            let points: Vec<DVec3> = cloud().iter().map(|p| by * *p).collect();
            let distances = compared(&turned(&part, by), &points).distances;
            for (p, distance) in cloud().iter().zip(distances) {
                let expected = from_prism(ring, 20.0, *p);
                assert!((distance - expected).abs() < 1e-5, "{p}: {distance}, not {expected}");
            }
        }
    }
}

#[test]
fn a_shifted_box_is_as_far_off_as_it_was_shifted() {
    let box_of = |x: f64| imported(&split(&split(&split(&cuboid([x, 0.0, 0.0], [x + 40.0, 30.0, 20.0]))))).mesh;
    let (part, shift) = (box_of(0.0), 0.75);
    for by in TURNS.map(turn) {
        let scan = turned(&box_of(shift), by).vertices;
        let Deviation { figures, doubts, .. } = compared(&turned(&part, by), &scan);
        assert!((figures.highest.distance - shift).abs() < 1e-5 && (figures.lowest.distance + shift).abs() < 1e-5);
        let (high, low) = (by.transpose() * figures.highest.at, by.transpose() * figures.lowest.at);
        assert!((high.x - 40.75).abs() < 1e-5 && (low.x - 0.75).abs() < 1e-5, "{high}, {low}");
        assert_eq!(doubts, []);
        // The face in front lies outside, the inside of the one behind inside, all others on the surface.
        let inside =
            box_of(shift).vertices.iter().filter(|v| v.x == shift && v.y % 30.0 != 0.0 && v.z % 20.0 != 0.0).count();
        assert!(inside > 20 && (figures.below - inside as f64 / scan.len() as f64).abs() < 1e-12, "{figures:?}");
    }
}

#[test]
fn an_open_scan_of_the_upper_face_is_read_and_compared() {
    let part = imported(&cuboid([0.0; 3], [40.0, 30.0, 20.0])).mesh;
    let upper = |z: f64| {
        let at = |x: f64, y: f64| DVec3::new(x, y, z);
        [[at(0.0, 0.0), at(40.0, 0.0), at(40.0, 30.0)], [at(0.0, 0.0), at(40.0, 30.0), at(0.0, 30.0)]]
    };
    let facets = split(&split(&split(&upper(20.3))));
    let obj = facets.iter().flatten().fold(String::new(), |text, v| text + &format!("v {} {} {}\n", v.x, v.y, v.z));
    let obj =
        (0..facets.len()).map(|i| 3 * i).fold(obj, |text, i| text + &format!("f {} {} {}\n", i + 1, i + 2, i + 3));
    let cloud: String = facets.iter().flatten().map(|v| format!("{},{},{}\n", v.x, v.y, v.z)).collect();
    for (bytes, triangles) in
        [(binary(b"scan", &facets), facets.len()), (obj.into_bytes(), facets.len()), (cloud.into_bytes(), 0)]
    {
        let scan = scan::read(&bytes, &Task::new()).unwrap();
        assert_eq!(scan.triangles.len(), triangles, "{}", scan.format);
        let Deviation { figures, doubts, .. } = compared(&part, &scan.points);
        assert!((figures.mean - 0.3).abs() < 1e-5 && figures.standard_deviation < 1e-5, "{}: {figures:?}", scan.format);
        assert_eq!((doubts, figures.within), (vec![], 1.0));
    }
    let figures = deviation(&part, &[DVec3::new(3.0, 4.0, 20.3)], 0.2, &Task::new()).unwrap().figures;
    assert_eq!((figures.within, figures.above, figures.below), (0.0, 1.0, 0.0));
}

#[test]
fn the_plate_around_a_part_is_none_of_it() {
    let part = imported(&split(&split(&cuboid([0.0; 3], [40.0, 30.0, 20.0])))).mesh;
    let scan: Vec<DVec3> = part.vertices.iter().filter(|v| v.z > 0.6).map(|v| v + DVec3::new(0.0, 0.0, 0.2)).collect();
    let alone = compared(&part, &scan);
    // A plate of 200 × 200 mm with the scanner's noise, up to the part's foot.
    let noise = |i: i32, k: i32| f64::from((7 * i + 13 * k).rem_euclid(11) - 5) * 0.05;
    let plate = (-80..=120).flat_map(|i| (-85..=115).map(move |k| (i, k)));
    let beside = plate.filter(|(i, k)| !(-1..=41).contains(i) || !(-1..=31).contains(k));
    let plate: Vec<DVec3> = beside.map(|(i, k)| DVec3::new(f64::from(i), f64::from(k), noise(i, k))).collect();
    let both = compared(&part, &[&scan[..], &plate].concat());
    assert_eq!((both.plate, both.figures), (plate.len(), alone.figures));
    assert_eq!((alone.plate, both.doubts), (0, vec![]));
    // A scan of the plate alone is no scan of this part.
    let nothing_else = compared(&part, &plate);
    assert!(nothing_else.plate == 0 && !nothing_else.doubts.is_empty());
}

#[test]
fn wrong_units_and_a_wrong_place_are_doubted() {
    let part = example::find("propeller").unwrap().mesh();
    let scaled = |factor: f64| part.vertices.iter().map(|v| *v * factor).collect::<Vec<_>>();
    for (factor, doubt) in [
        (1.0, vec![]),
        (1.0 / 25.4, vec![Doubt::ScanUnit(Units::Inch)]),
        (0.001, vec![Doubt::ScanUnit(Units::Metre)]),
        (25.4, vec![Doubt::PartUnit(Units::Inch)]),
        (1000.0, vec![Doubt::PartUnit(Units::Metre)]),
    ] {
        assert_eq!(compared(&part, &scaled(factor)).doubts, doubt, "× {factor}");
    }
    let aside: Vec<DVec3> = part.vertices.iter().map(|v| v + DVec3::new(400.0, 0.0, 0.0)).collect();
    let doubts = compared(&part, &aside).doubts;
    assert!(matches!(doubts[..], [Doubt::Off(half)] if half > 100.0), "{doubts:?}");
    let open = imported(&cuboid([0.0; 3], [40.0, 30.0, 20.0])[2..]).mesh;
    let doubts = compared(&open, &open.vertices).doubts;
    assert!(matches!(doubts[..], [Doubt::Open(edges)] if edges > 2), "{doubts:?}");
}

#[test]
fn nothing_to_compare_is_said() {
    let (part, task) = (ball(20.0), Task::new());
    assert_eq!(deviation(&part, &[], 0.0, &task), Err(DeviationError::NoPoints));
    assert_eq!(deviation(&Mesh::default(), &part.vertices, 0.0, &task), Err(DeviationError::NoSurface));
    task.cancel();
    assert!(matches!(deviation(&part, &part.vertices, 0.0, &task), Err(DeviationError::Cancelled(_))));
}
