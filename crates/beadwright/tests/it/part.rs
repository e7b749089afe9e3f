//! A model becomes a part, and a layer can be seen before the others.

use beadwright::example;
use beadwright::fill::StrategyName;
use beadwright::layer::Layer;
use beadwright::model::{Import, Mesh, Model, Part, PartError, Placement, Units};
use beadwright::plan;
use beadwright::profile::{Body, Predict, Profile, edit};
use beadwright::task::Task;
use glam::{DMat3, DVec2, DVec3};

fn solid(name: &str) -> Import {
    match Model::read(&example::find(name).unwrap().stl(), &Task::new()).unwrap() {
        Model::Mesh(import) => import,
        Model::Curves(_) | Model::Outlines(_) => panic!("{name} is a solid"),
    }
}

fn with(profile: &str, values: &[(&str, &str)]) -> Profile {
    let text = Profile::built_in_text(profile).unwrap().to_owned();
    Profile::parse(&values.iter().fold(text, |text, (k, v)| edit::with_value(&text, k, v).unwrap())).unwrap()
}

/// Points of a layer's passes in an order that does not depend on theirs.
fn points(layer: &Layer) -> Vec<[i64; 3]> {
    let all = layer.passes.iter().flat_map(|p| &p.points);
    let mut points: Vec<_> = all.map(|p| p.to_array().map(|v| (v * 1e6).round() as i64)).collect();
    points.sort_unstable();
    points
}

#[test]
fn a_preview_shows_the_layer_of_the_plan() {
    let part = Part::Mesh(Placement::default().solid(solid("propeller"), 7.54).unwrap());
    let (even, best) = (("fill.raster_turn", "alternate"), ("fill.raster_turn", "best"));
    let sparse = ("fill.infill_density", "0.3");
    for values in [
        &[("fill.strategy", "raster"), even, ("layers.level", "false")][..],
        &[("fill.strategy", "loop")],
        &[("fill.strategy", "zigzag"), best, ("layers.level", "false")],
        &[("fill.strategy", "compound"), even, sparse, ("fill.solid_layers", "2")],
        &[("fill.strategy", "wall")],
    ] {
        let profile = with("cmt-al2319-kuka", values);
        let Part::Mesh(import) = &part else { panic!("a solid") };
        let plan = plan::plan("propeller", &import.mesh, &profile, &Task::new()).unwrap();
        for index in [0, 1, 4, plan.layers.len() / 2 + 1, plan.layers.len() - 1] {
            let seen = plan::preview(&part, &profile, index, &Task::new()).unwrap().unwrap();
            let planned = &plan.layers[index];
            assert_eq!((seen.index, seen.z, seen.height), (planned.index, planned.z, planned.height), "{values:?}");
            assert_eq!(seen.islands, planned.islands);
            assert_eq!(seen.passes.len(), planned.passes.len());
            if profile.is_level() {
                // What is built below decides how much metal a place gets.
                continue;
            }
            // A closed pass may begin at a new point of its own.
            let [count, expected] = [points(&seen).len(), points(planned).len()];
            assert!(count.abs_diff(expected) <= planned.passes.len(), "{values:?}, layer {index}");
            let apart = points(&seen).iter().zip(&points(planned)).any(|(a, b)| a != b);
            // Where wall trails and closed passes begin may repeat a point; the metal is the same.
            let length = |layer: &Layer| layer.passes.iter().map(|p| p.length()).sum::<f64>();
            assert!(!apart || (length(&seen) - length(planned)).abs() < 1e-6, "{values:?}, layer {index}");
        }
        let beyond = plan::preview(&part, &profile, 10_000, &Task::new()).unwrap().unwrap();
        assert_eq!(beyond.index, plan.layers.len() - 1);
    }
}

#[test]
fn a_part_that_was_turned_is_laid_flat_again() {
    let flat = Placement::default().solid(solid("plate"), 7.54).unwrap();
    let height = flat.mesh.size().z;
    for turn in [DVec3::new(90.0, 0.0, 0.0), DVec3::new(-37.0, 61.0, 12.0), DVec3::new(0.0, 90.0, 45.0), DVec3::ZERO] {
        let mut model = solid("plate");
        model.mesh.place(1.0, turn);
        // The same from the part as it is placed.
        let placed = Placement { turn, ..Placement::default() };
        let again = placed.laid_flat(&placed.solid(solid("plate"), 7.54).unwrap().mesh);
        let again = Placement { turn: again, ..placed }.solid(solid("plate"), 7.54).unwrap().mesh.size();
        assert!((again.z - height).abs() < 1e-6, "turned by {turn}, again: {again}");
        let laid = Placement { turn: Placement::default().laid_flat(&model.mesh), ..Placement::default() };
        let size = laid.solid(model, 7.54).unwrap().mesh.size();
        assert!((size.z - height).abs() < 1e-6, "turned by {turn}: {size}");
    }
}

/// A turn about x, then y, then z, in degrees.
fn rotation(turn: DVec3) -> DMat3 {
    let turn = turn.map(f64::to_radians);
    DMat3::from_rotation_z(turn.z) * DMat3::from_rotation_y(turn.y) * DMat3::from_rotation_x(turn.x)
}

/// Both large faces of the plate are the same size: a shift, which rounds their corners anew, does not choose between them.
#[test]
fn a_shift_does_not_change_how_a_part_is_laid_flat() {
    for name in ["plate", "propeller", "gear"] {
        for turn in [DVec3::new(90.0, 0.0, 0.0), DVec3::new(0.0, 90.0, 0.0), DVec3::new(-37.0, 61.0, 12.0)] {
            let laid = |shift: DVec2| {
                let placed = Placement { turn, shift, ..Placement::default() };
                rotation(placed.laid_flat(&placed.solid(solid(name), 7.54).unwrap().mesh))
            };
            let still = laid(DVec2::ZERO);
            for shift in [(250.0, -40.0), (-7.25, 0.0), (1e3 / 3.0, 1e-3)].map(DVec2::from) {
                assert!(laid(shift).abs_diff_eq(still, 1e-6), "{name} {turn} by {shift}: {} for {still}", laid(shift));
            }
        }
    }
}

#[test]
fn the_turn_that_lays_flat_is_one_about_x_then_y_then_z() {
    let mut model = solid("propeller");
    model.mesh.place(1.0, DVec3::new(90.0, 0.0, 0.0));
    let matrix = rotation(Placement::default().laid_flat(&model.mesh));
    // The bottom of the propeller looks along +y after that turn.
    let down = matrix * DVec3::Y;
    assert!(down.abs_diff_eq(DVec3::NEG_Z, 1e-9) || (matrix * DVec3::NEG_Y).abs_diff_eq(DVec3::NEG_Z, 1e-9), "{down}");
}

#[test]
fn placements_scale_centre_and_ask_for_units() {
    let placed = |placement: Placement| placement.solid(solid("cross"), 7.54);
    let plain = placed(Placement::default()).unwrap().mesh;
    let inches = placed(Placement { units: Some(Units::Inch), centre: true, ..Placement::default() }).unwrap().mesh;
    assert!((inches.volume() / plain.volume() - 25.4_f64.powi(3)).abs() < 1e-6);
    let (low, high) = inches.bounds();
    assert!((low + high).truncate().length() < 1e-9 && low.z == 0.0);
    let tiny = Placement { scale: 0.01, ..Placement::default() };
    assert!(matches!(placed(tiny), Err(PartError::Units(_))));
}

#[test]
fn a_part_is_moved_and_turned_where_it_is() {
    let placed = |placement: &Placement| placement.solid(solid("propeller"), 7.54).unwrap().mesh;
    let middle = |mesh: &Mesh| ((mesh.bounds().0 + mesh.bounds().1) / 2.0).truncate();
    for (turn, angle) in [(DVec3::ZERO, 30.0), (DVec3::new(20.0, -50.0, 170.0), 100.0), (DVec3::X * 90.0, -200.0)] {
        let shift = DVec2::new(40.0, -7.5);
        let first = Placement { turn, shift: DVec2::new(300.0, 80.0), ..Placement::default() };
        let (before, foot) = (placed(&first), middle(&placed(&first)));
        let after = placed(&first.moved(shift, angle, foot));
        let way = DVec2::from_angle(f64::to_radians(angle));
        for (a, b) in before.vertices.iter().zip(&after.vertices) {
            let wanted = way.rotate(a.truncate() - foot) + foot + shift;
            assert!(b.truncate().distance(wanted) < 1e-5 && (a.z - b.z).abs() < 1e-9, "{wanted} became {b}");
        }
        // The middle of a centred part is where it was asked to be.
        let centred = Placement { centre: true, ..first };
        let after = placed(&centred.moved(shift, angle, middle(&placed(&centred))));
        assert!(middle(&after).distance(DVec2::new(340.0, 72.5)) < 1e-9, "{}", middle(&after));
    }
    let far = Placement { shift: DVec2::X * 1e5, ..Placement::default() };
    assert!(matches!(far.solid(solid("cross"), 7.54), Err(PartError::Import(_))));
}

#[test]
fn placements_survive_a_file() {
    let (units, turn, shift) = (Some(Units::Inch), DVec3::new(0.1, 1.0 / 3.0, -90.0), DVec2::new(12.5, -0.1));
    let placement = Placement { units, scale: 0.1, turn, centre: true, shift };
    for placement in [placement, Placement::default()] {
        let text = serde_json::to_string(&placement).unwrap();
        assert_eq!(serde_json::from_str::<Placement>(&text).unwrap(), placement, "{text}");
    }
}

#[test]
fn an_edit_keeps_the_comments() {
    let text = Profile::built_in_text("cmt-al2319-kuka").unwrap();
    let edited = edit::with_value(text, "fill.raster_angle", "45").unwrap();
    assert!(edited.contains("raster_angle = 45        # °"), "{edited}");
    assert_eq!(Profile::parse(&edited).unwrap().fill.raster_angle, 45.0);
    assert_eq!(edit::with_value(&edited, "fill.raster_angle", "0.0").unwrap(), text);
    let added = edit::with_value(text, "wall.corner_radius", "0.7").unwrap();
    assert_eq!(Profile::parse(&added).unwrap().wall.corner_radius, 0.7);
    let removed = edit::without_value(&added, "wall.corner_radius").unwrap();
    assert_eq!(Profile::parse(&removed).unwrap(), Profile::parse(text).unwrap());
    assert!(edit::with_value(text, "name.x", "1").is_err());
}

/// Bodies go into the section of layers, whatever follows it, replace those that are there, and leave no trace when they are taken out.
#[test]
fn bodies_are_written_into_the_text_of_a_profile() {
    let read = |name: &str| Body::read(&example::find(name).unwrap().bodies().unwrap()).unwrap();
    let mut odd = read("y-tube");
    (odd[0].strategy, odd[0].on_stock, odd[1].predict) = (Some(StrategyName::Wall), true, Some(Predict::Never));
    for name in ["cmt-al2319-kuka", "cmt-steel-abb"] {
        let text = Profile::built_in_text(name).unwrap();
        let mut written = text.to_owned();
        for bodies in [read("hub"), odd.clone()] {
            written = edit::with_bodies(&written, &bodies).unwrap();
            let mut wanted = Profile::parse(text).unwrap();
            wanted.layers.bodies = bodies;
            assert_eq!(Profile::parse(&written).unwrap(), wanted, "{written}");
        }
        assert!(text.lines().all(|line| written.contains(line)), "every comment is kept");
        assert_eq!(edit::with_bodies(&written, &[]).unwrap(), text);
    }
    assert!(edit::with_bodies("layers = 1", &odd).is_err() && edit::with_bodies("layers = {", &odd).is_err());
}

#[test]
fn the_least_overhang_is_found_from_any_side() {
    use beadwright::model::stand::overhang;
    // A vase stands on its foot or on its mouth, a pot only on its foot; both hang over where they lean out.
    for name in ["vase", "pot", "plate", "propeller"] {
        let upright = Placement::default().solid(solid(name), 7.54).unwrap().mesh;
        let least = overhang(&upright, -DVec3::Z);
        for turn in [DVec3::new(90.0, 0.0, 0.0), DVec3::new(0.0, 180.0, 0.0), DVec3::new(30.0, 50.0, 20.0)] {
            let placed = Placement { turn, ..Placement::default() };
            let mesh = placed.solid(solid(name), 7.54).unwrap().mesh;
            let again = Placement { turn: placed.least_overhang(&mesh), ..Placement::default() };
            let mesh = again.solid(solid(name), 7.54).unwrap().mesh;
            let found = overhang(&mesh, -DVec3::Z);
            assert!(found <= least + 0.02 * upright.volume().powf(2.0 / 3.0) + 1.0, "{name}: {found} mm² for {least}");
        }
    }
}
