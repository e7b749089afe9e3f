//! Charts: their closed forms, meshes in their coordinates, and slices of parts around an axis.

use bead_part::chart::{Chart, warp};
use bead_part::model::Mesh;
use bead_part::model::solid::Solid;
use bead_part::slice::{Slice, SliceOptions, Slicer};
use bead_part::task::Task;
use glam::{DQuat, DVec3};
use planar::{DVec2, Polygon, Ring};
use std::f64::consts::{PI, TAU};

fn charts() -> Vec<Chart> {
    let texts = [
        "plane",
        "plane:up=1/2/3,through=5/-4/7",
        "cylinder:axis=z,radius=36",
        "cylinder:axis=-0.3/0.2/1,through=3/4/5,radius=20,seam=40",
        "cylinder:axis=x,radius=80,side=inner",
        "cone:axis=-z,tip=0/0/90,angle=30",
        "cone:axis=1/1/0.2,tip=3/4/5,angle=62,seam=-100",
    ];
    texts.iter().map(|text| text.parse().unwrap()).collect()
}

/// Places on and over a layer of a chart.
fn places() -> impl Iterator<Item = DVec3> {
    let grid =
        |k: i32| DVec3::new(f64::from(k % 7 - 3) * 9.0, f64::from(k / 7 % 5) * 4.0 + 31.0, f64::from(k / 35) * 2.5);
    (0..140).map(grid)
}

#[test]
fn charts_are_read_as_they_were_written() {
    for chart in charts() {
        assert_eq!(chart.to_string().parse(), Ok(chart));
    }
    assert!("plane".parse::<Chart>().unwrap().is_level());
}

#[test]
fn what_goes_to_space_comes_back() {
    for chart in charts() {
        for p in places() {
            let sheet = chart.sheet(3.0);
            let at = sheet.at(p);
            let again = sheet.coordinates(at.place, p.truncate());
            assert!(again.distance(p) < 1e-9, "{chart:?}: {p} came back as {again}");
        }
    }
}

/// The frame is that of the coordinates: unit vectors, u × v = normal, and a small step along each goes where it says. On the
/// middle of the layer, u and v are true lengths.
#[test]
fn frames_are_those_of_the_coordinates() {
    for chart in charts() {
        for p in places() {
            let sheet = chart.sheet(p.z);
            let at = sheet.at(p);
            let step = 1e-5;
            let towards = |way: DVec3| (sheet.at(p + way * step).place - sheet.at(p - way * step).place) / (2.0 * step);
            assert!(at.along[0].cross(at.along[1]).distance(at.normal) < 1e-9, "{chart:?}");
            for (way, direction) in [(DVec3::X, at.along[0]), (DVec3::Y, at.along[1]), (DVec3::Z, at.normal)] {
                assert!(towards(way).distance(direction) < 1e-8, "{chart:?} at {p}: {} {direction}", towards(way));
            }
        }
    }
}

#[test]
fn divided_lines_stay_within_the_tolerance() {
    let chart: Chart = "cylinder:radius=20".parse().unwrap();
    let sheet = chart.sheet(1.0);
    let (from, to) = (DVec3::new(-60.0, 0.0, 2.0), DVec3::new(50.0, 30.0, 2.0));
    let points: Vec<DVec3> = std::iter::once(from).chain(sheet.divided(from, to, 0.01, 0.2)).collect();
    assert_eq!(points.last(), Some(&to));
    for ends in points.windows(2) {
        let [a, b] = [ends[0], ends[1]].map(|p| sheet.at(p));
        let middle = sheet.at(ends[0].midpoint(ends[1])).place;
        assert!(middle.distance(a.place.midpoint(b.place)) <= 0.01 && a.normal.angle_between(b.normal) <= 0.2);
    }
    // On a cone a line bends most where it passes the tip.
    let cone: Chart = "cone:axis=-z,angle=30".parse().unwrap();
    let (sheet, from, to) = (cone.sheet(1.0), DVec3::new(-80.0, 6.0, 1.0), DVec3::new(80.0, 6.0, 1.0));
    let line: Vec<DVec3> = std::iter::once(from).chain(sheet.divided(from, to, 0.01, 0.2)).collect();
    for ends in line.windows(2) {
        let middle = sheet.at(ends[0].midpoint(ends[1])).place;
        let [a, b] = [ends[0], ends[1]].map(|p| sheet.at(p).place);
        assert!(middle.distance(a.midpoint(b)) <= 0.01);
    }
    // A chord that turns by an angle a lies r (1 - cos(a / 2)) within: less than twice as many pieces as needed.
    let needed = 110.0 / 21.0 / (2.0 * (1.0 - 0.01 / 22.0_f64).acos());
    assert!((points.len() as f64) < 2.0 * needed, "{}", points.len());
}

fn mesh(solid: Solid) -> Mesh {
    Mesh::from_triangles(solid.vertices, solid.triangles).0
}

/// A shaft of 20 mm radius with two flanges, about z.
fn shaft() -> Mesh {
    let profile = [[0.0, 0.0], [20.0, 0.0], [20.0, 30.0], [46.0, 30.0], [46.0, 50.0], [20.0, 50.0], [20.0, 90.0]];
    let end = [[32.0, 90.0], [32.0, 120.0], [0.0, 120.0]];
    let points: Vec<DVec2> = profile.iter().chain(&end).map(|&p| p.into()).collect();
    mesh(Solid::revolve(&points, 360))
}

fn slices(chart: &Chart, mesh: &Mesh, height: f64) -> Vec<Slice> {
    let task = Task::new();
    let options = SliceOptions { layer_height: height, close_gap: 0.1, simplify: 0.01 };
    let unrolled = warp::warped(chart, mesh, 0.01, &task).unwrap();
    assert!(unrolled.neighbours.iter().flatten().all(|across| *across != u32::MAX), "the unrolled mesh is closed");
    Slicer::new(&unrolled, options, &task).unwrap().on(chart).all(&task).unwrap()
}

/// Metal outside the shaft, by Pappus; and each layer is a band of the flange's width that goes all around.
#[test]
fn flanges_unroll_to_bands() {
    let chart: Chart = "cylinder:axis=z,radius=20".parse().unwrap();
    let unrolled = warp::warped(&chart, &shaft(), 0.005, &Task::new()).unwrap();
    let volume = PI * ((46.0_f64.powi(2) - 400.0) * 20.0 + (32.0_f64.powi(2) - 400.0) * 30.0);
    assert!((unrolled.volume() / volume - 1.0).abs() < 1e-3, "{} instead of {volume}", unrolled.volume());
    for slice in slices(&chart, &shaft(), 2.0) {
        let radius = 20.0 + slice.z - 1.0;
        let widths: f64 = if radius < 32.0 { 20.0 + 30.0 } else { 20.0 };
        let area = TAU * radius * widths;
        assert!((slice.area() / area - 1.0).abs() < 1e-3, "{}: {} instead of {area}", slice.z, slice.area());
        assert_eq!(slice.islands.len(), if radius < 32.0 { 2 } else { 1 }, "{}", slice.z);
    }
}

/// Where a band is cut open, no cut lies near those of the layers below.
#[test]
fn cuts_move_from_layer_to_layer() {
    let chart: Chart = "cylinder:axis=z,radius=20,seam=70".parse().unwrap();
    let start = |slice: &Slice| {
        let ring = &slice.islands[0].outer;
        let sheet = chart.sheet(slice.z - 1.0);
        let first = ring.points().iter().copied().min_by(|a, b| a.x.total_cmp(&b.x)).unwrap();
        let at = sheet.at(first.extend(slice.z - 1.0)).place;
        at.y.atan2(at.x)
    };
    let cuts: Vec<f64> = slices(&chart, &shaft(), 2.0).iter().map(start).collect();
    for (k, cut) in cuts.iter().enumerate() {
        let apart = |other: &f64| ((cut - other) / TAU - ((cut - other) / TAU).round()).abs() * 360.0;
        assert!(cuts[k.saturating_sub(4)..k].iter().all(|other| apart(other) > 30.0), "layer {k}: {cuts:?}");
    }
}

/// Where the chart is turned about its axis, the seam lies elsewhere, and bosses are the same islands; none is cut by it.
#[test]
fn bosses_are_whole_wherever_the_seam_lies() {
    let hub = Solid::revolve(&[[0.0, 0.0], [30.0, 0.0], [30.0, 60.0], [0.0, 60.0]].map(DVec2::from_array), 180);
    let mut part = mesh(hub);
    let square = [[-8.0, -8.0], [8.0, -8.0], [8.0, 8.0], [-8.0, 8.0]].map(DVec2::from_array);
    for k in 0..3 {
        let base = Polygon::simple(Ring::new(square.to_vec()));
        let mut boss = mesh(Solid::extrude(&base, 20.0, 50.0));
        let turn = DQuat::from_rotation_z(f64::from(k) * TAU / 3.0) * DQuat::from_rotation_y(PI / 2.0);
        boss.vertices.iter_mut().for_each(|p| *p = turn * *p + DVec3::Z * 30.0);
        part.add(boss);
    }
    for seam in [0.0, 45.0, 120.0, 180.0, 237.0] {
        let chart: Chart = format!("cylinder:radius=30,seam={seam}").parse().unwrap();
        for slice in slices(&chart, &part, 2.0) {
            assert_eq!(slice.islands.len(), 3, "seam {seam}, layer {}", slice.index);
            let radius = 30.0 + slice.z - 1.0;
            // Across, a boss is 16 mm wide: as long around as the angle that it fills.
            let area = 16.0 * 2.0 * radius * (8.0 / radius).asin();
            let all_alike = slice.islands.iter().all(|island| (island.area() / area - 1.0).abs() < 2e-3);
            let areas: Vec<f64> = slice.islands.iter().map(Polygon::area).collect();
            assert!(all_alike, "seam {seam}, {}: {areas:?} instead of {area}", slice.z);
        }
    }
}

/// A shell between two cones of the same angle has layers whose area is that of the cones between, and whose points lie within
/// one turn of the axis: nothing lies on anything else.
#[test]
fn cone_shells_unroll_to_sectors() {
    for degrees in [20.0_f64, 30.0, 45.0, 75.0] {
        let (angle, thick) = (degrees.to_radians(), 6.0);
        // Over the cone with its tip at z = 90: the outer cone's tip lies farther up.
        let radius = |z: f64, over: f64| (90.0 + over / angle.sin() - z) * angle.tan();
        let corner = |z: f64, over: f64| DVec2::new(radius(z, over), z);
        let profile = [corner(0.0, 0.0), corner(0.0, thick), corner(60.0, thick), corner(60.0, 0.0)];
        let shell = mesh(Solid::revolve(&profile, 720));
        let chart: Chart = format!("cone:axis=-z,tip=0/0/90,angle={degrees}").parse().unwrap();
        let slices = slices(&chart, &shell, 2.0);
        assert_eq!(slices.len(), 3, "{degrees}°");
        for slice in slices {
            let over = slice.z - 1.0;
            let [low, high] = [0.0, 60.0].map(|z| radius(z, over) / angle.sin());
            let area = PI * angle.sin() * (low * low - high * high);
            assert!((slice.area() / area - 1.0).abs() < 1e-3, "{degrees}°: {} instead of {area}", slice.area());
            let sheet = chart.sheet(over);
            let islands = slice.islands.iter().flat_map(Polygon::rings).flat_map(Ring::points);
            for p in islands {
                let again = sheet.coordinates(sheet.at(p.extend(over)).place, *p).truncate();
                assert!(again.distance(*p) < 1e-6, "{degrees}°: {p} {again}");
            }
        }
    }
}

/// A bar of the radius on which the build begins is cut off exactly at its skin, wherever the seam lies.
#[test]
fn bars_of_the_first_radius_are_cut_off_at_their_skin() {
    for seam in [3, 23, 77, 143, 165, 203, 219, 300] {
        let chart: Chart = format!("cylinder:radius=20,seam={seam}").parse().unwrap();
        let unrolled = warp::warped(&chart, &shaft(), 0.01, &Task::new()).unwrap();
        assert!(unrolled.neighbours.iter().flatten().all(|across| *across != u32::MAX), "seam {seam}");
        let volume = PI * ((46.0_f64.powi(2) - 400.0) * 20.0 + (32.0_f64.powi(2) - 400.0) * 30.0);
        assert!((unrolled.volume() / volume - 1.0).abs() < 2e-3, "seam {seam}: {} of {volume}", unrolled.volume());
    }
}

#[test]
fn bad_charts_are_refused_with_the_key() {
    for (text, said) in [
        ("sphere", "no kind of layers"),
        ("cylinder:axis=z", "needs radius"),
        ("cylinder:axis=w,radius=5", "axis=w"),
        ("cylinder:axis=0/0/0,radius=5", "axis=0/0/0"),
        ("cylinder:radius=-3", "radius=-3"),
        ("cylinder:radius=30,width=3", "no \"width\""),
        ("cone:angle=95", "angle=95"),
        ("plane:up", "no KEY=VALUE"),
    ] {
        let error = text.parse::<Chart>().unwrap_err().to_string();
        assert!(error.contains(said), "{text}: {error}");
    }
}
