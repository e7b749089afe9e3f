//! The arm in the 3-D view reaches to where the torch is.

use beadwright::model::Model;
use beadwright::profile::Profile;
use beadwright::program::{MACHINES, Machine, Positioner, Turning};
use beadwright::robot::body::Solid;
use beadwright::robot::{self, Cell, Frame};
use beadwright::task::Task;
use beadwright_studio::arm::stand;
use beadwright_studio::holding::{Come, Place};
use beadwright_studio::machine;
use beadwright_studio::view3d::{Camera, Floor, Look, Scene, Shape, Stance, StandardView, Style, View3d, headless};
use glam::{DVec2, DVec3};

#[test]
fn the_wire_tip_of_every_arm_is_at_the_bead() {
    let profile = Profile::built_in("cmt-al2319-kuka").unwrap();
    let model = Model::read(&beadwright::example::find("star").unwrap().stl(), &Task::new()).unwrap();
    let part = model.place(&Default::default(), None, profile.bead.width).unwrap();
    let plan = beadwright::plan::plan("star", part.mesh().unwrap(), &profile, &Task::new()).unwrap();
    let track = profile.track(&plan.layers);
    for (name, _) in robot::cell::BUILT_IN {
        let cell = Cell::built_in(name).unwrap();
        let reach = robot::reach(&cell, cell.part, &track);
        let (arm, base_from_part) = (cell.arm(), cell.part.base_from_part());
        let mut stood = 0;
        for layer in plan.layers.iter().step_by(3) {
            for (pass, of) in layer.passes.iter().enumerate() {
                for segment in of.segments().step_by(7) {
                    let at = (segment.from + segment.to) / 2.0;
                    let (come, torch) = (Come::Along(0.0), Stance::upright(at));
                    let place = Place { layer: layer.index, pass, come, torch };
                    let Some(found) = stand(&cell, &reach, &place) else { continue };
                    stood += 1;
                    // Forward kinematics, along the torch to the wire's tip.
                    let flange = arm.forward(&found.joints);
                    let tip = flange.apply(cell.flange_from_tool().position);
                    let wanted = base_from_part.apply(at);
                    assert!(tip.distance(wanted) < 0.01, "{name}: {tip} instead of {wanted}");
                    // The torch stands straight over the bead, and the base on the floor of the cell.
                    let end = found.links.iter().rfind(|link| link.solid == Solid::Torch).unwrap().ends[1];
                    let beside = (end - at).truncate().length();
                    assert!(beside < 0.01 && end.z > at.z, "{name}: the nozzle is {beside} mm beside the bead");
                    let base = found.links.iter().find(|link| link.solid == Solid::Base).unwrap();
                    assert!(base_from_part.apply(base.ends[0]).distance(DVec3::ZERO) < 0.01, "{name}");
                }
            }
        }
        assert!(stood > 20, "{name}: the arm is shown at {stood} beads only");
    }
}

#[test]
fn no_arm_is_shown_where_there_is_no_pass() {
    let profile = Profile::built_in("cmt-al2319-kuka").unwrap();
    let cell = Cell::built_in("kuka-kr20-r1810").unwrap();
    let reach = robot::reach(&cell, cell.part, &profile.track::<beadwright::layer::Layer>(&[]));
    let (come, torch) = (Come::Towards(0.5), Stance::upright(DVec3::ZERO));
    assert_eq!(stand(&cell, &reach, &Place { layer: 0, pass: 0, come, torch }), None);
}

#[test]
fn joints_are_drawn_about_their_axes_and_links_between_them() {
    for (name, _) in robot::cell::BUILT_IN {
        let cell = Cell::built_in(name).unwrap();
        let arm = cell.arm();
        for joints in [cell.home.as_ref().unwrap().joints, [20.0, -60.0, 50.0, 40.0, 35.0, -70.0]] {
            let flange = arm.forward(&joints);
            let axes = arm.axes(&joints);
            // A joint moves what lies beyond it about its axis: the flange keeps its distance from that.
            for (joint, axis) in axes.iter().enumerate() {
                assert!((axis.along.length() - 1.0).abs() < 1e-9, "{name}");
                let mut turned = joints;
                turned[joint] += 25.0;
                // Joint 3 of an arm with a parallelogram shows the angle to the floor, so joint 2 alone does not turn the forearm.
                if let (1, robot::Shape::Opw(table)) = (joint, &cell.arm.shape)
                    && table.parallelogram
                {
                    turned[2] += 25.0 * f64::from(table.signs[1] * table.signs[2]);
                }
                let moved = arm.forward(&turned);
                let [before, after] = [flange.position, moved.position].map(|place| place - axis.nearest(place));
                assert!((before.length() - after.length()).abs() < 1e-3, "{name}: joint {}", joint + 1);
                let along = (moved.position - flange.position).dot(axis.along);
                assert!(along.abs() < 1e-3, "{name}: joint {} moves the flange along its axis by {along}", joint + 1);
            }
            let shapes = machine::arm(&cell, &joints);
            let drawn = |line: &robot::Axis| {
                shapes.iter().any(|shape| {
                    let Shape::Turned { from, axis, look, .. } = shape else { return false };
                    let on = line.nearest(*from).distance(*from) < 1e-6;
                    on && axis.cross(line.along).length() < 1e-6 && (*look == Look::Joint || line == &axes[3])
                })
            };
            for joint in [0, 1, 2, 3, 4, 5] {
                assert!(drawn(&axes[joint]), "{name}: joint {} is not drawn", joint + 1);
            }
            // The hand ends on the flange, the foot on the floor.
            let lowest = shapes.iter().flat_map(Shape::bounds).map(|place| place.z).fold(f64::MAX, f64::min);
            assert!(lowest > -400.0 && shapes[0].bounds().iter().any(|place| place.z.abs() < 1e-6), "{name}: {lowest}");
            let reaches = shapes.iter().flat_map(Shape::bounds).map(|place| place.distance(flange.position));
            assert!(reaches.fold(f64::MAX, f64::min) < 1e-6, "{name}");
        }
    }
}

/// The plate carries the part, what tilts turns with its axis, and stands reach the floor, whatever the angles.
#[test]
fn a_positioner_is_drawn_as_it_holds_the_part() {
    for (name, _) in MACHINES {
        let Machine { axes, up, .. } = Machine::built_in(name).unwrap();
        let positioner = Positioner { turning: Turning::Follow, axes, up };
        for angles in [[0.0, 0.0], [40.0, 0.0], [-60.0, 120.0]] {
            let (held, floor) = (positioner.held(angles), 900.0);
            let shapes = machine::positioner(&positioner, &held, [20.0, floor, 150.0]);
            let Shape::Turned { from, axis, rings, look } = &shapes[0] else { panic!("{name}: no plate") };
            assert!(*look == Look::Table && axis.z.abs() > 0.999, "{name}");
            let top = from.z + rings.iter().map(|ring| ring[0]).fold(f64::MIN, f64::max);
            assert!((top + 20.0).abs() < 1e-6, "{name}: the plate ends at {top}");
            // In the cell, the lowest of all is what stands on the floor.
            let cell = Frame::from(held);
            let lowest =
                shapes.iter().flat_map(Shape::bounds).map(|place| cell.apply(place).z).fold(f64::MAX, f64::min);
            assert!((lowest + floor).abs() < 1e-6, "{name} at {angles:?}: {lowest}");
        }
    }
}

/// The floor is seen where it lies, with a line every 100 mm; without it there is the grid below the part alone.
#[test]
fn the_floor_has_a_grid() {
    let Ok(state) = headless() else {
        println!("pictures are skipped: there is nothing to draw with");
        return;
    };
    let scene = Scene::default();
    let mut view = View3d::default();
    view.camera = Camera { orthographic: true, ..Camera::default() };
    view.camera.set_view(StandardView::Top);
    let frame = Frame { position: DVec3::new(0.0, 0.0, -500.0), ..Frame::IDENTITY };
    view.camera.fit((DVec3::splat(-300.0), DVec3::splat(300.0)), DVec2::splat(400.0));
    let mut seen = |floor: Option<Floor>| {
        let style = Style { floor, ..Style::default() };
        let (width, _, pixels) = view.picture(&state, &scene, &style, [400, 400]).unwrap();
        [[150.0, 150.0], [200.0, 150.0]].map(|[x, y]| {
            let place = view.camera.project(DVec3::new(x, y, -500.0), DVec2::splat(400.0)).unwrap();
            let first = 4 * (place.y as usize * width as usize + place.x as usize);
            DVec3::from_array([0, 1, 2].map(|c| f64::from(pixels[first + c])))
        })
    };
    let [between, on_line] = seen(Some(Floor { frame, half: 2000.0 }));
    let [nothing, also_nothing] = seen(None);
    assert!(nothing.distance(also_nothing) < 1.0 && nothing.distance(between) > 15.0, "{nothing} {between}");
    assert!(on_line.distance(between) > 8.0, "{between} {on_line}");
}
