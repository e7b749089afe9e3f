//! Charts: their closed forms, meshes in their coordinates, and slices of parts around an axis.

use bead_part::chart::warp::{self, WarpError};
use bead_part::chart::{Chart, Guide, Surface};
use bead_part::example;
use bead_part::middle_line::{NoMiddleLine, middle_line};
use bead_part::model::Mesh;
use bead_part::model::solid::Solid;
use bead_part::slice::{Slab, Slice, SliceOptions, Slicer};
use bead_part::task::Task;
use glam::{DQuat, DVec3};
use planar::{DVec2, Polygon, Ring};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

fn charts() -> Vec<Chart> {
    let texts = [
        "plane",
        "plane:up=1/2/3,through=5/-4/7",
        "cylinder:axis=z,radius=36",
        "cylinder:axis=-0.3/0.2/1,through=3/4/5,radius=20,seam=40",
        "cylinder:axis=x,radius=80,side=inner",
        "cone:axis=-z,tip=0/0/90,angle=30",
        "cone:axis=1/1/0.2,tip=3/4/5,angle=62,seam=-100",
        "guide:points=0/0/0:0/0/140:140/0/140,radius=120",
        "guide:points=5/4/-60:10/0/20:40/160/30:150/180/190,radius=70:110",
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

/// A pipe along a bent guide: seen in the chart it is straight, its metal is that of Pappus, and its layers are alike.
#[test]
fn a_bent_pipe_is_straight_along_its_guide() {
    for (corner, length) in [(90.0_f64, 400.0), (60.0, 300.0), (150.0, 500.0)] {
        let leg = DVec3::new(0.3, -0.2, 0.9).normalize() * length;
        let away = DQuat::from_axis_angle(leg.normalize().any_orthonormal_vector(), corner.to_radians()) * leg;
        let points =
            vec![DVec3::new(7.0, 8.0, 9.0), DVec3::new(7.0, 8.0, 9.0) + leg, DVec3::new(7.0, 8.0, 9.0) + leg + away];
        let guide = Guide::new(points, vec![100.0]).unwrap();
        let bend = 100.0 * corner.to_radians();
        let straight = 2.0 * (length - 100.0 * (corner.to_radians() / 2.0).tan());
        assert!((guide.length() - straight - bend).abs() < 1e-9, "{} {}", guide.length(), straight + bend);
        let chart = Chart::Guide(Arc::new(guide.clone()));
        let ring =
            |radius: f64| Ring::new((0..200).map(|k| DVec2::from_angle(TAU * f64::from(k) / 200.0) * radius).collect());
        let section = Polygon { outer: ring(40.0), holes: vec![ring(25.0).reversed()] };
        let levels: Vec<f64> = (0..=300).map(|k| guide.length() * f64::from(k) / 300.0).collect();
        let mut pipe = mesh(Solid::loft(&section, &levels, |p, _| p));
        pipe.vertices.iter_mut().for_each(|p| *p = chart.sheet(p.z).at(*p).place);
        let unrolled = warp::warped(&chart, &pipe, 0.01, &Task::new()).unwrap();
        let (low, high) = unrolled.bounds();
        assert!(low.distance(DVec3::new(-40.0, -40.0, 0.0)) < 0.02, "{low}");
        assert!(high.distance(DVec3::new(40.0, 40.0, guide.length())) < 0.02, "{high}");
        let volume = section.area() * guide.length();
        assert!((chart.volume(&unrolled) / pipe.volume() - 1.0).abs() < 1e-9);
        assert!((pipe.volume() / volume - 1.0).abs() < 2e-4, "{} {volume}", pipe.volume());
        for slice in slices(&chart, &pipe, 2.0) {
            assert!((slice.area() / section.area() - 1.0).abs() < 1e-3, "{}: {}", slice.z, slice.area());
        }
    }
}

/// Of a layer that would be too thick on the outer side of a bend, the lower half lies there alone.
#[test]
fn part_layers_lie_where_layers_are_thick() {
    let chart: Chart = "guide:points=0/0/0:0/0/200:200/0/200,radius=100".parse().unwrap();
    let block = mesh(Solid::extrude(
        &Polygon::simple(Ring::new(
            [[-50.0, -20.0], [50.0, -20.0], [50.0, 20.0], [-50.0, 20.0]].map(DVec2::from_array).to_vec(),
        )),
        0.0,
        250.0,
    ));
    // In the bend from 100 mm on, rise = 1 - x / 100: layers of 2 mm are thicker than 2.4 mm where x < -20.
    let slabs = [(99.0, 2.0), (151.0, 1.0), (152.0, 2.0)].map(|(z, height)| Slab { z, height });
    let options = SliceOptions { layer_height: 2.0, close_gap: 0.1, simplify: 0.01 };
    let slicer = Slicer::of_slabs(&block, slabs.to_vec(), options, &Task::new()).unwrap();
    let slices = slicer.on(&chart).no_thicker_than(2.4).all(&Task::new()).unwrap();
    for (slice, area) in slices.iter().zip([4000.0, 30.0 * 40.0, 4000.0]) {
        assert!((slice.area() - area).abs() < 1e-6, "{}: {}", slice.z, slice.area());
    }
    assert!(slices[1].islands[0].outer.points().iter().all(|p| p.x < -20.0 + 1e-9));
}

#[test]
fn guides_that_cannot_be_are_refused() {
    let said = |text: &str| text.parse::<Chart>().unwrap_err().to_string();
    assert!(said("guide:points=0/0/0").contains("two points"));
    assert!(said("guide:points=0/0/0:0/0/50:50/0/50,radius=60").contains("from point 1 to point 2 it is 50.000 mm"));
    assert!(said("guide:points=0/0/0:0/0/50:0/0/10").contains("turns back"));
    assert!(said("guide:points=0/0/0:0/0/50:50/0/50,radius=10:20").contains("2 radii are given for 1 corners"));
    assert!(said("guide:radius=10").contains("needs points"));
}

/// Metal that is as near to one stretch of a guide as to another belongs to neither.
#[test]
fn parts_between_two_stretches_of_a_guide_are_refused() {
    let chart: Chart = "guide:points=0/0/0:0/0/200:200/0/200:200/0/0,radius=100".parse().unwrap();
    let base = [[-20.0, -20.0], [220.0, -20.0], [220.0, 20.0], [-20.0, 20.0]].map(DVec2::from_array);
    let block = mesh(Solid::extrude(&Polygon::simple(Ring::new(base.to_vec())), 0.0, 60.0));
    let Err(WarpError::Torn(at)) = warp::warped(&chart, &block, 0.02, &Task::new()) else { panic!() };
    assert!((at.x - 100.0).abs() < 5.0, "{at}");
}

/// The guide that is found in a bent bar is the one it was made from, however it lies and however thick it is.
#[test]
fn middle_lines_of_bent_bars_are_found() {
    for (text, radius) in [
        ("guide:points=0/0/0:0/0/145:145/0/145,radius=120", 30.0),
        ("guide:points=10/-20/0:10/-20/80:60/90/180:150/100/300,radius=90:70", 18.0),
        ("guide:points=0/0/0:0/0/160:0/200/160:0/200/20,radius=100", 25.0),
    ] {
        let chart: Chart = text.parse().unwrap();
        let Chart::Guide(guide) = &chart else { panic!() };
        let ring = Ring::new((0..90).map(|k| DVec2::from_angle(TAU * f64::from(k) / 90.0) * radius).collect());
        let levels: Vec<f64> = (0..=400).map(|k| guide.length() * f64::from(k) / 400.0).collect();
        let mut bar = mesh(Solid::loft(&Polygon::simple(ring), &levels, |p, _| p));
        bar.vertices.iter_mut().for_each(|p| *p = chart.sheet(p.z).at(*p).place);
        let found = middle_line(&bar, &Task::new()).unwrap();
        assert!((found.length() - guide.length()).abs() < 0.01 * radius, "{} {}", found.length(), guide.length());
        let tightest = guide.tightest().unwrap();
        assert!((found.tightest().unwrap() / tightest - 1.0).abs() < 0.08, "{:?} {tightest}", found.tightest());
        let found = Chart::Guide(Arc::new(found));
        for k in 0..=200 {
            let h = guide.length() * f64::from(k) / 200.0;
            let on_it = found.coordinates(chart.sheet(h).at(DVec3::Z * h).place);
            assert!(on_it.truncate().length() < 0.01 * radius, "{text}: {on_it} at {h}");
            let [known, here] = [chart.sheet(h).at(DVec3::Z * h), found.sheet(h).at(DVec3::Z * h)];
            assert!(known.normal.angle_between(here.normal) < 0.03, "{text} at {h}");
        }
    }
}

#[test]
fn parts_without_a_middle_line_are_refused() {
    let block = |x: f64| {
        Polygon::simple(Ring::new(
            [[x, 0.0], [x + 20.0, 0.0], [x + 20.0, 20.0], [x, 20.0]].map(DVec2::from_array).to_vec(),
        ))
    };
    let flat = mesh(Solid::extrude(&block(0.0), 0.0, 10.0));
    assert!(matches!(middle_line(&flat, &Task::new()), Err(NoMiddleLine::Short { .. })));
    let (mut two, more) = (Solid::extrude(&block(0.0), 0.0, 100.0), Solid::extrude(&block(50.0), 0.0, 100.0));
    let first = two.vertices.len() as u32;
    two.vertices.extend(more.vertices);
    two.triangles.extend(more.triangles.iter().map(|t| t.map(|i| i + first)));
    assert_eq!(middle_line(&mesh(two), &Task::new()), Err(NoMiddleLine::Start(2)));
}

/// A guide of many short arcs unrolls a part as its own few do, into triangles that are not many more: edges are cut where arcs meet.
#[test]
fn guides_of_many_points_divide_a_mesh_no_further_than_need_be() {
    let exact: Chart = "guide:points=0/0/0:0/0/145:145/0/145,radius=120".parse().unwrap();
    let elbow = example::find("elbow").unwrap().mesh();
    let Chart::Guide(guide) = &exact else { panic!() };
    // Unevenly spaced, as a drawing's curve is.
    let heights = (0..=60).map(|k| guide.length() * (f64::from(k) + 0.3 * f64::from(k % 3)) / 60.6);
    let points = heights.map(|h| exact.sheet(h).at(DVec3::Z * h).place).collect();
    let dense = Chart::Guide(Arc::new(Guide::new(points, vec![]).unwrap()));
    let [few, many] = [&exact, &dense].map(|chart| warp::warped(chart, &elbow, 0.02, &Task::new()).unwrap());
    assert!(many.triangles.len() < 6 * few.triangles.len(), "{} {}", many.triangles.len(), few.triangles.len());
    assert!((dense.volume(&many) / elbow.volume() - 1.0).abs() < 1e-3);
}

/// Above a layer, a travel is as high as it is asked to be, on the inner side of a bend, too.
#[test]
fn travels_over_a_wedge_keep_their_height() {
    let chart: Chart = "guide:points=0/0/0:0/0/145:145/0/145,radius=120".parse().unwrap();
    let sheet = chart.sheet(120.0);
    for x in [-45.0, 0.0, 45.0] {
        let at = |z: f64| sheet.at(DVec3::new(x, 5.0, z)).place;
        let [top, above] = [at(121.0), at(141.0)];
        assert!((top.distance(at(119.0)) - 2.0 * (1.0 - x / 120.0)).abs() < 1e-9, "{x}");
        assert!(above.distance(top) > 19.3, "{x}: {}", above.distance(top));
    }
}

/// Heights of a saddle on a grid, along a direction.
fn saddle(up: DVec3, step: f64, half: i32, height: impl Fn(DVec2) -> f64) -> Surface {
    let at = |i: i32, j: i32| DVec2::new(f64::from(i), f64::from(j)) * step;
    let heights = (-half..=half).flat_map(|j| (-half..=half).map(move |i| at(i, j))).map(height).collect();
    Surface::new(up, at(-half, -half), step, 2 * half as usize + 1, heights).unwrap()
}

#[test]
fn surfaces_go_through_their_heights() {
    let wavy = |p: DVec2| 4.0 * (p.x / 30.0).sin() + 3.0 * (p.y / 40.0).cos();
    // Halving the step makes the error smaller by its fourth power.
    let off = |step: f64| {
        let half = (90.0 / step) as i32;
        let chart = Chart::Surface(Arc::new(saddle(DVec3::Z, step, half, wavy)));
        let places = (0..400).map(|k| DVec2::new(f64::from(k % 20) - 10.0, f64::from(k / 20) - 10.0) * 5.1);
        places.map(|p| (chart.sheet(0.0).at(p.extend(0.0)).place.z - wavy(p)).abs()).fold(0.0, f64::max)
    };
    let (coarse, fine) = (off(10.0), off(5.0));
    assert!(coarse < 0.01 && fine < coarse / 10.0, "{coarse} {fine}");
}

#[test]
fn what_lies_over_a_surface_comes_back() {
    let ramp = |p: DVec2| 0.1 * p.x - 0.05 * p.y + p.x * p.y / 3000.0;
    for up in [DVec3::Z, DVec3::new(0.3, -0.2, 1.0).normalize(), DVec3::NEG_X] {
        let surface = saddle(up, 8.0, 9, ramp);
        let chart = Chart::Surface(Arc::new(surface.clone()));
        assert_eq!(chart.to_string().parse(), Ok(chart.clone()));
        for p in places() {
            let sheet = chart.sheet(3.0);
            let at = sheet.at(p);
            assert!(sheet.coordinates(at.place, p.truncate()).distance(p) < 1e-9);
            assert!(at.along[0].cross(at.along[1]).distance(at.normal) < 1e-9);
            // Neighbours on the layer lie square to the normal, as far apart as the stretch says at most.
            let step = 1e-4;
            for way in [DVec3::X, DVec3::Y, DVec3::new(0.6, 0.8, 0.0)] {
                let moved = (sheet.at(p + way * step).place - sheet.at(p - way * step).place) / (2.0 * step);
                assert!(moved.dot(at.normal).abs() < 1e-6);
                assert!(moved.length() > 1.0 - 1e-9 && moved.length() <= chart.stretch(p.truncate()) + 1e-6);
            }
        }
    }
}

/// What lies over a surface has the metal that it has in space, and a part seen from above gives its surface.
#[test]
fn examples_over_surfaces_keep_their_volume() {
    for (name, thickness) in [("dome", 12.0), ("clad", 5.6)] {
        let example = example::find(name).unwrap();
        let bodies = example.bodies().unwrap();
        let chart: Chart = bodies.split("chart = \"").nth(1).unwrap().split('"').next().unwrap().parse().unwrap();
        let mesh = example.mesh();
        let unrolled = warp::warped(&chart, &mesh, 0.02, &Task::new()).unwrap();
        assert!((unrolled.volume() / mesh.volume() - 1.0).abs() < 2e-3, "{name}");
        assert!((unrolled.bounds().1.z - thickness).abs() < 0.03, "{name}: {}", unrolled.bounds().1.z);
        let seen = Chart::Surface(Arc::new(Surface::of_mesh(&mesh, DVec3::Z, 5.0).unwrap()));
        for p in [DVec2::ZERO, DVec2::new(30.0, -20.0), DVec2::new(-41.0, 22.0)] {
            let [top, under] = [&seen, &chart].map(|chart| chart.sheet(0.0).at(p.extend(0.0)).place.z);
            assert!((top - under - thickness).abs() < 0.03, "{name}: {top} {under}");
        }
    }
    let cross = example::find("cross").unwrap().mesh();
    let steep = Chart::Surface(Arc::new(saddle(DVec3::Z, 10.0, 9, |p| 0.5 * p.x - 100.0)));
    assert!(warp::warped(&steep, &cross, 0.02, &Task::new()).unwrap_err().to_string().contains("17.7°"));
    // What is only lain on may be as steep as it likes.
    let unrolled = warp::unrolled(&steep, &cross, 0.02, &Task::new()).unwrap();
    assert!((unrolled.volume() / cross.volume() - 1.0).abs() < 1e-6, "{}", unrolled.volume());
}

#[test]
fn heights_that_give_no_surface_are_refused() {
    let error = |text: &str| text.parse::<Chart>().unwrap_err().to_string();
    assert!(error("surface:from=0/0,step=5,columns=4,heights=0:0:0").contains("give no surface"));
    assert!(error("surface:from=0/0,step=5,columns=4,heights=0:x").contains("write numbers"));
    assert!(error("surface:from=0,step=5,columns=4,heights=0").contains("x/y"));
    assert!(error("surface:step=5").contains("needs heights"));
}
