//! The example parts are closed, wound outward, and as large as they say.

use beadwright::example::{ALL, Example, find};
use beadwright::model::{Import, import};
use beadwright::task::Task;
use glam::{DVec2, DVec3, Vec3};
use std::f64::consts::{PI, TAU};

fn imported(example: &Example) -> Import {
    import(&example.stl(), &Task::new()).unwrap()
}

fn volume(name: &str) -> f64 {
    imported(find(name).unwrap()).mesh.volume()
}

fn assert_close(found: f64, expected: f64, relative: f64) {
    assert!((found - expected).abs() <= expected * relative, "{found} is not {expected}");
}

/// The last three numbers of the sentence: `… 100 × 100 × 20 mm`.
fn promised_size(about: &str) -> DVec3 {
    let (_, size) = about.rsplit_once(", ").unwrap();
    let numbers: Vec<f64> = size.trim_end_matches(" mm").split(" × ").map(|n| n.parse().unwrap()).collect();
    DVec3::from_slice(&numbers)
}

/// Area of a circle as drawn: chords within 0.03 mm, their number a multiple of four.
fn disc(radius: f64) -> f64 {
    let chord = 2.0 * (1.0 - 0.03 / radius).acos();
    let count = 4.0 * (TAU / chord / 4.0).ceil();
    count / 2.0 * radius * radius * (TAU / count).sin()
}

fn vase_radius(z: f64) -> f64 {
    44.0 + 8.0 * (TAU * z / 120.0).sin()
}

/// Twice the first moment about the axis of the area between the axis and a polyline (radius, height).
fn second_power(line: &[DVec2]) -> f64 {
    line.windows(2).map(|w| (w[1].y - w[0].y) * (w[0].x.powi(2) + w[0].x * w[1].x + w[1].x.powi(2)) / 3.0).sum()
}

#[test]
fn names_are_sorted_and_found() {
    assert!(ALL.is_sorted_by_key(|e| e.name));
    for example in ALL {
        assert_eq!(find(example.name).unwrap().about, example.about);
    }
    assert!(find("teapot").is_none());
}

#[test]
fn every_part_is_one_clean_shell() {
    for example in ALL {
        let Import { mesh, repair, format, .. } = imported(example);
        println!("{}: {repair:?}", example.name);
        assert_eq!(format, "binary STL");
        assert!(repair.is_clean(), "{}: {:?}", example.name, repair.sentences());
        // The blades of the hub begin inside it.
        let shells = if example.name == "hub" { 5 } else { 1 };
        assert_eq!((repair.shells, repair.open_edges), (shells, 0), "{}", example.name);
        assert!(mesh.volume() > 0.0, "{}", example.name);
        assert_eq!(mesh.triangles.len(), repair.triangles_read, "{}", example.name);
    }
}

#[test]
fn every_part_stands_on_zero_and_has_the_size_it_promises() {
    for example in ALL {
        let mesh = imported(example).mesh;
        let off = (mesh.size() - promised_size(example.about)).abs().max_element();
        assert!(off < 0.051, "{}: {} but {}", example.name, mesh.size(), example.about);
        assert_eq!(mesh.bounds().0.z, 0.0, "{}", example.name);
    }
}

#[test]
fn mesh_and_stl_are_the_same_part() {
    for example in ALL {
        let (mesh, file) = (example.mesh(), imported(example).mesh);
        assert_eq!(mesh.triangles.len(), file.triangles.len(), "{}", example.name);
        assert_eq!(mesh.vertices.len(), file.vertices.len(), "{}", example.name);
        assert_close(mesh.volume(), file.volume(), 1e-6);
    }
}

#[test]
fn normals_have_length_one_and_point_outward() {
    for example in ALL {
        let bytes = example.stl();
        assert!(bytes.starts_with(format!("beadwright example {}\0", example.name).as_bytes()));
        for record in bytes[84..].as_chunks::<50>().0 {
            let numbers: Vec<f32> = record.as_chunks::<4>().0.iter().map(|b| f32::from_le_bytes(*b)).collect();
            let [normal, a, b, c] = [0, 3, 6, 9].map(|i| Vec3::from_slice(&numbers[i..]));
            assert!((normal.length() - 1.0).abs() < 1e-6, "{}: {normal}", example.name);
            let winding = (b - a).as_dvec3().cross((c - a).as_dvec3());
            assert!(winding.normalize().dot(normal.as_dvec3()) > 0.999_999, "{}: {a} {b} {c}", example.name);
        }
    }
}

#[test]
fn prisms_have_the_volume_of_their_formula() {
    assert_close(volume("cross"), (2.0 * 100.0 * 36.0 - 36.0 * 36.0) * 20.0, 1e-6);
    assert_close(volume("star"), 5.0 * 80.0 * 34.0 * (PI / 5.0).sin() * 20.0, 1e-6);
    assert_close(volume("tian"), (100.0 * 100.0 - 4.0 * 43.25 * 43.25) * 26.0, 1e-6);
}

#[test]
fn bracket_has_the_volume_of_its_formula() {
    let plates = 14.0 * 60.0 * 90.0 + 86.0 * 60.0 * 14.0;
    assert_close(volume("bracket"), plates + 12.0 * 50.0 * 50.0 / 2.0 - 4.0 * disc(7.0) * 14.0, 1e-6);
}

#[test]
fn plate_has_the_volume_of_its_formula() {
    let holes: f64 = [30.0, 22.0, 16.0, 12.0, 10.0].iter().map(|d| disc(d / 2.0)).sum();
    let rim = 120.0 * 80.0 - 4.0 * 12.0 * 12.0 + disc(12.0);
    assert_close(volume("plate"), (rim - holes) * 12.0, 1e-6);
}

#[test]
fn gear_has_the_volume_of_its_formula() {
    let half_angle = (9.0_f64 / 54.0).asin();
    let gap = PI / 6.0 - 2.0 * half_angle;
    let base_x = 54.0 * half_angle.cos();
    let tooth = (18.0 + 12.0) / 2.0 * (70.0 - base_x) + 9.0 * base_x;
    let sector = |chords: f64| chords / 2.0 * 54.0 * 54.0 * (gap / chords).sin();
    let chords = (gap / (2.0 * (1.0 - 0.03_f64 / 54.0).acos())).ceil();
    assert_close(volume("gear"), (12.0 * (tooth + sector(chords)) - disc(20.0)) * 20.0, 1e-6);
}

#[test]
fn vase_has_the_volume_of_its_formula() {
    let line = |from: u32, wall: f64| -> Vec<DVec2> {
        (from..=40).map(|k| 3.0 * f64::from(k)).map(|z| DVec2::new(vase_radius(z) - wall, z)).collect()
    };
    let round = second_power(&line(0, 0.0)) - second_power(&line(4, 14.0));
    assert_close(volume("vase"), 36.0 * (TAU / 72.0).sin() * round, 1e-6);
}

#[test]
fn propeller_keeps_its_area_while_it_turns() {
    let mesh = imported(find("propeller").unwrap()).mesh;
    let bottom = mesh.triangles.iter().map(|t| t.map(|i| mesh.vertices[i as usize]));
    let floor = bottom.filter(|t| t.iter().all(|v| v.z == 0.0));
    let area: f64 = floor.map(|[a, b, c]| (b - a).cross(c - a).length() / 2.0).sum();
    assert_close(mesh.volume(), area * 20.0, 1e-3);
    assert!((2000..9000).contains(&mesh.triangles.len()), "{}", mesh.triangles.len());
}

#[test]
fn propeller_reaches_its_full_size_at_the_four_tips() {
    let mesh = find("propeller").unwrap().mesh();
    assert_eq!(mesh.size(), DVec3::new(260.0, 260.0, 20.0));
    for tip in [DVec2::X, DVec2::Y, DVec2::NEG_X, DVec2::NEG_Y].map(|axis| (axis * 130.0).extend(10.0)) {
        assert!(mesh.vertices.iter().any(|v| v.distance(tip) < 1e-9), "{tip}");
    }
}
