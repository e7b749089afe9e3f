//! Walls given by curves: read from IGES, lofted, leaning, and the same as those given by a solid.

use beadwright::bead::Overlap;
use beadwright::curve::Nurbs;
use beadwright::example;
use beadwright::fill::StrategyName;
use beadwright::layer::Layer;
use beadwright::model::iges::{self, IgesFile, WriteOptions};
use beadwright::model::wall_curves::{CurvesAre, WallCurves, WallCurvesError};
use beadwright::model::{Model, Part, PartError, PartRef, Placement};
use beadwright::pass::Pass;
use beadwright::plan;
use beadwright::planar::polyline;
use beadwright::profile::Profile;
use beadwright::slice::Surface;
use beadwright::task::Task;
use glam::{DAffine3, DVec2, DVec3};
use std::f64::consts::FRAC_PI_2;

fn profile(width: f64, height: f64) -> Profile {
    let mut profile = Profile::built_in("cmt-steel-abb").unwrap();
    profile.fill.strategy = StrategyName::Wall;
    (profile.bead.width, profile.bead.height) = (width, height);
    (profile.fill.overlap, profile.fill.stepover) = (Overlap::Free, Some(width));
    profile
}

/// Curves through a file and back.
fn curves(nurbs: &[Nurbs]) -> Result<WallCurves, WallCurvesError> {
    let named: Vec<(&str, &Nurbs)> = nurbs.iter().map(|n| ("wall", n)).collect();
    let file = iges::read(iges::write(&named, &WriteOptions::default()).as_bytes()).unwrap();
    WallCurves::of_iges(&file, &DAffine3::IDENTITY)
}

fn of_example(name: &str) -> WallCurves {
    let text = example::find(name).unwrap().iges().unwrap();
    WallCurves::of_iges(&iges::read(text.as_bytes()).unwrap(), &DAffine3::IDENTITY).unwrap()
}

fn layers(curves: &WallCurves, height: f64, profile: &Profile) -> Vec<Layer> {
    plan::plan("wall", PartRef::Curves(curves, height), profile, &Task::new()).unwrap().layers
}

fn circle(radius: f64, z: f64) -> Nurbs {
    Nurbs::circle(DVec3::new(0.0, 0.0, z), DVec3::X * radius, DVec3::Y * radius).unwrap()
}

#[test]
fn curves_and_solid_give_the_same_wall() {
    for (name, width, height, top) in
        [("tian", 4.5, 2.128, 26.0), ("blade", 3.5, 2.05, 100.0), ("gourd", 4.0, 1.98, 200.0)]
    {
        let profile = profile(width, height);
        let by_curves = layers(&of_example(name), top, &profile);
        let by_mesh = plan::plan(name, &example::find(name).unwrap().mesh(), &profile, &Task::new()).unwrap().layers;
        assert!(by_curves.len().abs_diff(by_mesh.len()) <= 1, "{name}: {} {}", by_curves.len(), by_mesh.len());
        for (a, b) in by_curves.iter().zip(&by_mesh) {
            assert_eq!(a.passes.len(), b.passes.len(), "{name}");
            // Of a solid both sides count, and the one that leans more decides: within 1 % of the height.
            assert!((a.z - b.z).abs() < 0.01 * top, "{name}: {} {}", a.z, b.z);
        }
        // How much wall there is: lengths of the paths times heights of the layers.
        let wall = |layers: &[Layer]| -> f64 {
            layers.iter().map(|l| l.height * l.passes.iter().map(Pass::length).sum::<f64>()).sum()
        };
        // The mesh of the blade ends half a bead before its mean line does.
        let least = wall(&by_mesh) / wall(&by_curves);
        assert!((0.95..1.01).contains(&least), "{name}: {least}");
    }
}

#[test]
fn a_leaning_wall_rises_by_the_cosine() {
    let (angle, profile) = (30.0_f64.to_radians(), profile(4.0, 1.8));
    let wall = profile.single_wall().unwrap();
    let cone = curves(&[circle(30.0, 0.0), circle(30.0 + 100.0 * angle.tan(), 100.0)]).unwrap();
    let laid = layers(&cone, 100.0, &profile);
    assert_eq!(laid[0].height, wall.height());
    for layer in &laid[1..laid.len() - 1] {
        assert!((layer.height - wall.rise() * angle.cos()).abs() < 1e-5, "{}", layer.height);
        // A level cut through the wall is 4 mm / cos 30° wide, so the bead keeps its metal and its speed.
        for s in layer.passes[0].segments() {
            assert!((s.width - 4.0 / angle.cos()).abs() < 0.03 && (s.pace / 8.0 - 1.0).abs() < 0.01, "{s:?}");
        }
        // The centre-line is that at the middle of the layer.
        let radius = 30.0 + (layer.z - layer.height / 2.0) * angle.tan();
        for point in &layer.passes[0].points {
            assert!((point.truncate().length() - radius).abs() < 0.03, "{point} for {radius}");
        }
    }
    assert!((laid.last().unwrap().z - 100.0).abs() <= wall.rise() / 2.0);
}

#[test]
fn an_upright_wall_rises_by_h_n_and_its_layers_end_where_they_should() {
    let ring = curves(&[circle(40.0, 7.0)]).unwrap();
    let profile = profile(4.0, 1.81);
    let wall = profile.single_wall().unwrap();
    // The area of the bead over the thickness of the wall.
    assert!((wall.rise() - 1.81 * 2.0 / 3.0).abs() < 1e-12);
    let laid = layers(&ring, wall.total(66), &profile);
    assert_eq!(laid.len(), 66);
    assert!((laid[65].z - wall.total(66)).abs() < 1e-9);
    assert!(laid.iter().all(|l| l.passes.len() == 1 && l.passes[0].closed));
}

#[test]
fn between_two_heights_the_way_is_straight_wherever_the_curves_begin() {
    let turned = |radius: f64, z: f64, by: f64| {
        let (u, v) = (DVec3::new(by.cos(), by.sin(), 0.0), DVec3::new(by.sin(), -by.cos(), 0.0));
        Nurbs::circle(DVec3::new(0.0, 0.0, z), u * radius, v * radius).unwrap()
    };
    // The upper circle begins elsewhere and runs the other way round.
    let wall = curves(&[circle(20.0, 0.0), turned(40.0, 50.0, 2.0)]).unwrap();
    for section in wall.at(25.0, 0.01) {
        assert!(section.closed);
        for point in section.points {
            assert!((point.length() - 30.0).abs() < 0.6, "{point}");
        }
    }
    // 20 mm outwards on 50 mm upwards, at every point.
    for (at, lean) in wall.leans(20.0, 30.0) {
        assert!((lean - 0.4_f64.atan()).abs() < 0.01 && (at.length() - 30.0).abs() < 0.6, "{at}: {lean}");
    }
}

#[test]
fn what_is_no_wall_is_refused_with_the_place() {
    let slanted = Nurbs::line(DVec3::ZERO, DVec3::new(10.0, 0.0, 3.0)).unwrap();
    assert!(matches!(curves(&[slanted]), Err(WallCurvesError::NotLevel { entry: 1, .. })));
    let uneven = [circle(20.0, 0.0), circle(10.0, 0.0), circle(20.0, 30.0)];
    assert!(matches!(curves(&uneven), Err(WallCurvesError::Uneven { lower: 2, upper: 1, .. })));
    let nothing = WallCurves::of_iges(&IgesFile::default(), &DAffine3::IDENTITY);
    assert_eq!(nothing, Err(WallCurvesError::None { curves: 0 }));
}

/// The two sides of a wall of a thickness (mm) along a line that bends, and its middle.
fn two_sides(thickness: f64, closed: bool) -> ([Nurbs; 2], Nurbs) {
    let half = thickness / 2.0;
    if closed {
        return ([circle(30.0 - half, 0.0), circle(30.0 + half, 0.0)], circle(30.0, 0.0));
    }
    // A quarter of a turn between two straight stretches.
    let line = |by: f64| {
        let bend = (0..=60).map(|k| {
            let (y, x) = (f64::from(k) / 60.0 * FRAC_PI_2).sin_cos();
            DVec3::new(-(20.0 + by) * x, (20.0 + by) * y, 0.0)
        });
        let ends = [DVec3::new(-20.0 - by, -40.0, 0.0), DVec3::new(50.0, 20.0 + by, 0.0)];
        Nurbs::polyline(std::iter::once(ends[0]).chain(bend).chain([ends[1]]).collect()).unwrap()
    };
    ([line(-half), line(half)], line(0.0))
}

#[test]
fn two_sides_are_planned_as_one_wall_along_their_middle() {
    for closed in [false, true] {
        for thickness in [3.0, 3.5, 4.0] {
            let (sides, middle) = two_sides(thickness, closed);
            let mut profile = profile(3.5, 2.0);
            let plan = |given: &WallCurves, profile: &Profile| {
                plan::plan("wall", PartRef::Curves(given, 20.0), profile, &Task::new())
            };
            let given = curves(&sides).unwrap();
            assert!(
                matches!(plan(&given, &profile), Err(plan::PlanError::SideBySide(_))),
                "{thickness} was not asked about"
            );
            profile.wall.curves = Some(CurvesAre::Sides);
            let [by_sides, by_middle] = [
                plan(&given, &profile).unwrap(),
                plan(&curves(&[middle]).unwrap(), &{
                    let mut alone = profile.clone();
                    alone.wall.curves = None;
                    alone
                })
                .unwrap(),
            ];
            assert_eq!(by_sides.summary.notes.iter().any(|note| note.contains("apart")), thickness != 3.5);
            assert_eq!(by_sides.layers.len(), by_middle.layers.len());
            for (a, b) in by_sides.layers.iter().zip(&by_middle.layers) {
                assert_eq!((a.passes.len(), b.passes.len()), (1, 1));
                let (a, b) = (a.passes[0].line(), b.passes[0].line());
                let away = a.iter().map(|p| {
                    let squares = b.windows(2).map(|ends| polyline::distance_squared_to_segment(*p, ends[0], ends[1]));
                    squares.fold(f64::INFINITY, f64::min).sqrt()
                });
                assert!(away.fold(0.0, f64::max) < 0.03, "{thickness}");
            }
            profile.wall.curves = Some(CurvesAre::Centre);
            assert!(plan(&given, &profile).unwrap().layers[0].passes.len() > 1);
        }
    }
}

#[test]
fn curves_that_are_no_pairs_are_refused_as_sides() {
    let mut profile = profile(4.0, 2.0);
    let rings = curves(&[circle(20.0, 0.0), circle(23.5, 0.0), circle(27.0, 0.0)]).unwrap();
    let plan = |profile: &Profile| plan::plan("wall", PartRef::Curves(&rings, 10.0), profile, &Task::new());
    assert!(
        matches!(plan(&profile), Err(plan::PlanError::SideBySide(sides)) if (sides.thickness.0 - 3.5).abs() < 0.02)
    );
    profile.wall.curves = Some(CurvesAre::Sides);
    assert!(matches!(plan(&profile), Err(plan::PlanError::NoSides { within }) if within == 8.0));
    // Far apart, they are centre-lines without a word.
    profile.wall.curves = None;
    let apart = curves(&[circle(20.0, 0.0), circle(40.0, 0.0)]).unwrap();
    assert!(plan::plan("wall", PartRef::Curves(&apart, 10.0), &profile, &Task::new()).is_ok());
}

/// Edges through a file, as a part.
fn between(edges: &[Nurbs]) -> Result<Part, PartError> {
    let named: Vec<(&str, &Nurbs)> = edges.iter().map(|n| ("edge", n)).collect();
    let text = iges::write(&named, &WriteOptions::default());
    Model::read(text.as_bytes(), &Task::new())?.place(&Placement::default(), None, 4.0)
}

/// The layers of a wall between edges.
fn laid_between(edges: &[Nurbs], profile: &Profile) -> Vec<Layer> {
    let part = between(edges).unwrap();
    let mut profile = profile.clone();
    profile.slice.surface = Some(Surface::Wall);
    plan::plan("wall", &part, &profile, &Task::new()).unwrap().layers
}

/// The left end of a wall leans along it, the right end also across: at a height z its level cut is the straight line between
/// both, and there the right end leans by the angle whose tangent is its way across that line, over z (Li et al., eq 8).
#[test]
fn a_wall_between_two_rising_edges_is_cut_level() {
    let ends = |z: f64| [DVec2::new(z / 6.0, 0.0), DVec2::new(80.0 - z / 6.0, 0.4 * z)];
    let edge = |k: usize| {
        let at = |z: f64| ends(z)[k].extend(z);
        Nurbs::line(at(0.0), at(60.0)).unwrap()
    };
    let profile = profile(4.0, 1.8);
    let laid = laid_between(&[edge(0), edge(1)], &profile);
    let rise = profile.single_wall().unwrap().rise();
    for layer in &laid {
        assert_eq!(layer.passes.len(), 1, "layer {}", layer.index);
        let [a, b] = ends(layer.z - layer.height / 2.0);
        let way = (b - a).normalize();
        for p in layer.passes[0].points.iter().map(|p| p.truncate()) {
            let off = way.perp_dot(p - a).abs();
            assert!(off < 0.05 && (-0.05..=(b - a).length() + 0.05).contains(&way.dot(p - a)), "{}: {off}", layer.z);
        }
        let most = way.perp_dot(DVec2::new(-1.0 / 6.0, 0.4)).abs().atan();
        let whole = layer.index > 0 && layer.index + 1 < laid.len();
        // The very end is not asked: the bead ends before it.
        assert!(
            !whole || (0.998..1.015).contains(&(layer.height / (rise * most.cos()))),
            "{}: {}",
            layer.z,
            layer.height
        );
    }
    // Whichever comes first, and whichever way they run.
    for edges in [[edge(1), edge(0)], [edge(0).reversed(), edge(1)]] {
        let again = laid_between(&edges, &profile);
        assert_eq!(again.len(), laid.len());
        for (a, b) in again.iter().zip(&laid) {
            let length = |layer: &Layer| layer.passes.iter().map(Pass::length).sum::<f64>();
            assert!((a.z - b.z).abs() < 1e-6 && (length(a) - length(b)).abs() < 0.05, "{}", a.z);
        }
    }
}

/// A lower edge on the plate and an upper one that rises: every layer runs as far as the wall is that high.
#[test]
fn a_wall_under_a_rising_edge_ends_where_the_edge_does() {
    let line = |a, b| Nurbs::line(DVec3::from(a), DVec3::from(b)).unwrap();
    let laid = laid_between(
        &[line((0.0, 0.0, 0.0), (100.0, 0.0, 0.0)), line((0.0, 0.0, 20.0), (100.0, 0.0, 60.0))],
        &profile(4.0, 1.8),
    );
    assert!(laid.len() > 25, "{}", laid.len());
    for layer in laid {
        let z = layer.z - layer.height / 2.0;
        let first = (z - 20.0).max(0.0) / 40.0 * 100.0;
        // What is left of it at the tip is too short to be welded.
        if first > 90.0 {
            continue;
        }
        let xs = || layer.passes.iter().flat_map(|pass| &pass.points).map(|p| p.x);
        let (low, high) = (xs().fold(f64::INFINITY, f64::min), xs().fold(0.0, f64::max));
        assert!((low - first).abs() < 0.5 && (high - 100.0).abs() < 0.5, "at {z}: {low} to {high}, not from {first}");
    }
}

/// Nothing is guessed: what a wall between edges stands for is asked, three curves that are not level are refused.
#[test]
fn edges_are_asked_about() {
    let edge = |x: f64| Nurbs::line(DVec3::new(x, 0.0, 0.0), DVec3::new(x, 5.0, 40.0)).unwrap();
    let part = between(&[edge(0.0), edge(50.0)]).unwrap();
    let Part::Mesh(import) = &part else { panic!("a surface") };
    assert!(import.notes.iter().any(|note| note.contains("edges of a wall")), "{:?}", import.notes);
    let asked = plan::plan("wall", &part, &profile(4.0, 1.8), &Task::new()).unwrap_err().to_string();
    assert!(asked.contains("slice.surface"), "{asked}");
    let three = between(&[edge(0.0), edge(50.0), edge(90.0)]);
    assert!(matches!(three, Err(PartError::Curves(WallCurvesError::NotLevel { entry: 1, .. }))), "{three:?}");
}
