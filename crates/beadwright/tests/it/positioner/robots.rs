//! Robots with a positioner.

use super::machines::{a_machine_welds_it, machine};
use super::{
    FREE, about, along, axis, cell, chuck, in_all_dialects, off_plumb, on_part, planned, planned_at, read, same_path,
    tilting, turned_by,
};
use crate::common::profile;
use crate::readers::{Weld, distance};
use crate::{common, readers};
use beadwright::chart::{Chart, Cylinder};
use beadwright::directions::{Settings, divisions};
use beadwright::layer::Layer;
use beadwright::pass::{Along, Pass, PassKind};
use beadwright::profile::{Body, Profile};
use beadwright::program::{Positioner, PositionerAxis, Turning};
use beadwright::task::Task;
use beadwright::{dialect, example, model, plan};
use glam::{DMat3, DQuat, DVec3};
use std::f64::consts::TAU;

/// A Universal Robot has no axes for the part: it goes home, its statements turn the part, and the part's frame follows.
#[test]
fn a_robot_without_axes_for_the_part_has_it_turned_while_the_torch_is_at_home() {
    let mut positioner = tilting(Turning::IndexAtHome);
    (positioner.axes[0].through, positioner.axes[1].through) = ([0.0, 0.0, -80.0], [15.0, 0.0, 0.0]);
    for (name, restart) in [("y-tube", false), ("elbow", false), ("elbow", true)] {
        let (layers, mut plain) = planned(name);
        plain.program.restart = restart;
        let mut turned = turned_by(&plain, &positioner);
        let own = turned.dialects.urscript.as_mut().unwrap();
        own.turn = vec!["turn_part({{positioner_1}}, {{positioner_2}})".to_owned()];
        own.part_frame = [500.0, -200.0, 100.0, 0.0, 0.0, 0.5];
        let (by_torch, by_part) = (read("urscript", &layers, &plain), read("urscript", &layers, &turned));
        same_path(name, &by_torch.welds, &by_part.welds);
        let worst = by_part.welds.iter().map(|weld| off_plumb(weld, &positioner)).fold(0.0, f64::max);
        assert!(worst <= 0.05, "{name}: {worst}°");
        assert!(by_part.welds.iter().all(|weld| weld.axes.iter().all(|axes| *axes == weld.axes[0])), "{name}");
        // The frame after each turn, about the lines of the axes.
        let text = dialect::write("urscript", &layers, &turned.job("demo")).unwrap().into_values().next().unwrap();
        let turns: Vec<&str> = text.lines().map(str::trim).skip_while(|line| !line.starts_with("turn_part(")).collect();
        let (mut angles, mut frames) = ([0.0; 2], 0);
        for line in turns {
            if let Some(given) = line.strip_prefix("turn_part(").and_then(|rest| rest.strip_suffix(')')) {
                let given: Vec<f64> = given.split(", ").map(|angle| angle.parse().unwrap()).collect();
                angles = [given[0], given[1]];
            } else if let Some(frame) = line.strip_prefix("global part_frame = p[") {
                let frame: Vec<f64> = frame.trim_end_matches(']').split(',').map(|v| v.parse().unwrap()).collect();
                let p = DVec3::new(40.0, -30.0, 120.0);
                let (tilt, turn) = (about(DVec3::X, angles[0]), about(DVec3::Z, angles[1]));
                let (below, beside) = (DVec3::new(0.0, 0.0, -80.0), DVec3::new(15.0, 0.0, 0.0));
                let held = tilt * (turn * (p - beside) + beside - below) + below;
                let expected = about(DVec3::Z, 0.5_f64.to_degrees()) * held + DVec3::new(500.0, -200.0, 100.0);
                let own = DQuat::from_scaled_axis(DVec3::new(frame[3], frame[4], frame[5]));
                let found = own * p + DVec3::new(frame[0], frame[1], frame[2]) * 1000.0;
                assert!(found.distance(expected) < 0.005, "{name}: {found} {expected}");
                frames += 1;
            }
        }
        assert!(frames > 3, "{name}: {frames}");
        // It is read back to the path on the part.
        let program = dialect::read(&text, &mut |_| None, &turned.reading_options(None, Some("urscript"))).unwrap();
        let own: f64 = program.layers().iter().flat_map(|layer| &layer.passes).map(|pass| along(&pass.points)).sum();
        let length: f64 =
            by_torch.welds.iter().flat_map(|weld| weld.points.windows(2)).map(|p| distance(p[0], p[1])).sum();
        assert!((own / length - 1.0).abs() < 1e-3, "{name}: {own} mm read, {length} mm welded");
    }
    let (layers, plain) = planned("y-tube");
    let refused = |positioner: &Positioner| {
        let profile = turned_by(&plain, positioner);
        dialect::write("urscript", &layers, &profile.job("demo")).unwrap_err().to_string()
    };
    assert!(refused(&positioner).contains("urscript.turn"), "{}", refused(&positioner));
}

/// Parts with their positioners, and how far the wire may hang from plumb, °: where a normal passes close by the axis of the table,
/// that would have to spin, and the pool leans a little instead.
fn cases() -> [(&'static str, Positioner, f64); 8] {
    [
        ("hub", chuck(), 0.05),
        ("shaft", chuck(), 0.05),
        ("hub", tilting(Turning::Follow), 0.05),
        ("elbow", tilting(Turning::Follow), 0.05),
        ("elbow", tilting(Turning::Index), 0.05),
        ("y-tube", tilting(Turning::Index), 0.05),
        ("dome", tilting(Turning::Follow), 5.0),
        ("clad", tilting(Turning::Follow), 5.0),
    ]
}

#[test]
fn the_wire_hangs_straight_down_on_the_planned_path() {
    for (name, positioner, allowed) in cases() {
        let (layers, plain) = planned(name);
        robots_weld_it(name, &layers, &plain, &positioner, allowed);
    }
}

/// A foreign propeller, whose hub is found: its blades are welded around the hub by all that can.
#[test]
#[cfg_attr(no_models, ignore = "no shared models")]
fn a_propeller_from_elsewhere_is_welded_around_its_hub() {
    let mut mesh = model::import(&common::model("propeller_on_hub.stl"), &Task::new()).unwrap().mesh;
    mesh.place(4.0, DVec3::ZERO);
    let mut profile = profile("cmt-al2319-kuka");
    let settings = Settings { lean: 45.0, tilt: 90.0, bead: profile.bead.width };
    let found = divisions(&mesh, settings, &Task::new()).unwrap();
    // The hub lies along x; its axis becomes that of the chuck and of the machine.
    let Chart::Cylinder(hub) = &found[0].pieces[0].chart else { panic!("{:?}", found[0]) };
    assert!(hub.axis.abs().distance(DVec3::X) < 1e-3, "{}", hub.axis);
    mesh.vertices.iter_mut().for_each(|p| *p -= hub.through);
    profile.layers.bodies = Body::of_division("propeller", &found[0]);
    profile.layers.bodies[0].chart = Chart::Cylinder(Cylinder { through: DVec3::ZERO, ..*hub });
    let plan = plan::plan("propeller", &mesh, &profile, &Task::new()).unwrap();
    assert!(plan.summary.metrics.passes > 300, "{:?}", plan.summary.metrics);
    let layers: Vec<Layer> = plan.layers.into_iter().step_by(20).collect();
    let plain = in_all_dialects(profile);
    let lying = Positioner { turning: Turning::Follow, axes: vec![axis([1.0, 0.0, 0.0], FREE)], up: [0.0, 0.0, 1.0] };
    robots_weld_it("propeller_on_hub", &layers, &plain, &lying, 0.05);
    a_machine_welds_it("propeller_on_hub", &layers, &plain, (&lying, &["A"]), 0.05);
}

/// However the part lies in its own space, beside the axes and turned about z, robots and machines weld what was planned, with the wire
/// straight down and within the limits.
#[test]
fn a_part_that_lies_elsewhere_is_welded_alike() {
    let shift = DVec3::new(35.0, -20.0, 12.0);
    for (name, degrees) in [("elbow", 37), ("elbow", 200), ("hub", 37), ("hub", 200)] {
        let (layers, plain) = planned_at(name, degrees, shift);
        let by_torch = read("krl", &layers, &plain).welds;
        let as_it_was = planned(name);
        let expected =
            about(DVec3::Z, f64::from(degrees)) * centre(&read("krl", &as_it_was.0, &as_it_was.1).welds) + shift;
        assert!(centre(&by_torch).distance(expected) < 3.0, "{name} {degrees}: {} {expected}", centre(&by_torch));
        let positioner = tilting(Turning::Follow);
        let mut turned = plain.clone();
        turned.program.positioner = Some(positioner.clone());
        let robot = read("krl", &layers, &turned).welds;
        same_path(&format!("{name} {degrees}° krl"), &by_torch, &robot);
        let files = dialect::write("gcode", &layers, &machine(&plain, &positioner, &["A", "C"]).job("demo")).unwrap();
        let cnc = readers::gcode::run(&files.into_values().next().unwrap(), 3, 5).welds;
        same_path(&format!("{name} {degrees}° gcode"), &by_torch, &cnc);
        let (mut worst, mut reached) = (0.0_f64, [[f64::MAX, f64::MIN]; 2]);
        for (weld, other) in robot.iter().zip(&by_torch).chain(cnc.iter().zip(&by_torch)) {
            let tools = weld.tools.iter().zip(&other.tools);
            worst = tools.map(|(a, b)| (*a * DVec3::Z).angle_between(*b * DVec3::Z).to_degrees()).fold(worst, f64::max);
        }
        worst = robot.iter().map(|weld| off_plumb(weld, &positioner)).fold(worst, f64::max);
        for axes in robot.iter().flat_map(|weld| &weld.axes) {
            for (range, angle) in reached.iter_mut().zip(axes) {
                *range = [range[0].min(angle.unwrap()), range[1].max(angle.unwrap())];
            }
        }
        println!("{name} turned by {degrees}°: the wire is off by {worst:.4}°, axes {reached:.1?}°");
        assert!(worst <= 0.05, "{name} {degrees}: {worst}°");
        let within =
            |(range, axis): (&[f64; 2], &PositionerAxis)| axis.limits[0] <= range[0] && range[1] <= axis.limits[1];
        assert!(reached.iter().zip(&positioner.axes).all(within), "{name} {degrees}: {reached:?}");
    }
}

/// The middle of all that is welded.
fn centre(welds: &[Weld]) -> DVec3 {
    let (mut middle, mut length) = (DVec3::ZERO, 0.0);
    for pair in welds.iter().flat_map(|weld| weld.points.windows(2)) {
        let [from, to] = [0, 1].map(|k| DVec3::from(pair[k]));
        middle += (from + to) / 2.0 * from.distance(to);
        length += from.distance(to);
    }
    middle / length
}

/// Each arm of the fork is welded in one position, and the trunk in another.
#[test]
fn an_indexed_part_is_turned_once_for_each_body() {
    let (layers, mut profile) = planned("y-tube");
    profile.program.positioner = Some(tilting(Turning::Index));
    let welds = read("krl", &layers, &profile).welds;
    let mut poses: Vec<[Option<f64>; 2]> = welds.iter().map(|weld| weld.axes[0]).collect();
    poses.dedup();
    assert_eq!(poses.len(), 3, "{poses:?}");
}

/// The part is turned so that the torch need not: its turn in the cell stays what it was, but for rounding.
#[test]
fn the_torch_does_not_turn_with_the_part() {
    let (layers, mut profile) = planned("shaft");
    profile.program.positioner = Some(chuck());
    for weld in read("krl", &layers, &profile).welds {
        let tool = |k: usize| cell(&chuck(), weld.axes[k]) * DMat3::from_quat(weld.tools[k]);
        let first = tool(0);
        let off = (0..weld.tools.len()).map(|k| (tool(k).x_axis).angle_between(first.x_axis)).fold(0.0, f64::max);
        assert!(off.to_degrees() < 0.05, "{}°", off.to_degrees());
    }
}

/// `reach` follows the part as it turns, about the lines of the axes: the tool's tip is where the part has been turned to, and the wire
/// hangs straight down all the way.
#[test]
fn a_robot_finds_the_part_where_the_positioner_holds_it() {
    let (layers, mut profile) = planned("elbow");
    let mut positioner = tilting(Turning::Follow);
    let through = [DVec3::new(0.0, 20.0, -150.0), DVec3::new(30.0, -10.0, 0.0)];
    positioner.axes.iter_mut().zip(through).for_each(|(axis, through)| axis.through = through.to_array());
    profile.program.positioner = Some(positioner.clone());
    let track = profile.track(&layers);
    let (mut turned, mut last) = (0, None);
    for stop in track.stops.iter().filter(|stop| stop.arc) {
        let held = stop.attitude.held.unwrap();
        // About the axis next to the part first.
        let mut place = stop.at;
        for k in [1, 0] {
            let direction = DVec3::from(positioner.axes[k].direction);
            place = about(direction, held.angles[k]) * (place - through[k]) + through[k];
        }
        let tool = stop.tool(0.0);
        assert!(tool.position.distance(place) < 0.2, "{} {place}", tool.position);
        assert!((tool.rotation * DVec3::Z).angle_between(-DVec3::Z).to_degrees() < 0.1);
        turned += usize::from(last != Some(held.angles));
        last = Some(held.angles);
    }
    assert!(turned >= 4, "each of the layers has a position of its own: {turned}");
}

/// Rings that all run the same way turn the part on and on; a chuck that cannot is wound back between passes, above the part, and
/// never passes its limits.
#[test]
fn a_chuck_is_wound_back_between_passes() {
    let (_, mut profile) = planned("shaft");
    let (radius, height) = (30.0, profile.layers.height);
    profile.layers.bodies.clear();
    profile.layers.chart = "cylinder:axis=z,radius=30".parse().unwrap();
    let around = 1.05 * TAU * (radius + height / 2.0);
    let ring = |k: usize| Pass {
        kind: PassKind::Contour,
        closed: false,
        points: (0..=8).map(|i| DVec3::new(around * f64::from(i) / 8.0, 5.0 * k as f64, height)).collect(),
        width: Along::Same(profile.bead.width),
        pace: Along::Same(profile.process.deposition_speed),
        wait: 0.0,
    };
    let layers = [Layer { z: height, height, passes: (0..6).map(ring).collect(), ..Layer::default() }];
    let plain = read("krl", &layers, &profile).welds;
    for limits in [FREE, [-400.0, 400.0]] {
        let mut chuck = chuck();
        chuck.axes[0].limits = limits;
        profile.program.positioner = Some(chuck.clone());
        for post in ["krl", "rapid", "fanuc"] {
            let welds = read(post, &layers, &profile).welds;
            same_path(post, &plain, &welds);
            let angles = |weld: &Weld| weld.axes.iter().map(|axes| axes[0].unwrap()).collect::<Vec<_>>();
            assert!(welds.iter().flat_map(angles).all(|angle| (limits[0]..=limits[1]).contains(&angle)), "{post}");
            let jumps = |pair: &[Weld]| (angles(&pair[1])[0] - angles(&pair[0]).last().unwrap()).abs() > 180.0;
            let wound = welds.windows(2).filter(|pair| jumps(pair)).count();
            assert_eq!(wound > 0, limits != FREE, "{post}: wound back {wound} times");
            let worst = welds.iter().map(|weld| off_plumb(weld, &chuck)).fold(0.0, f64::max);
            assert!(worst <= 0.05, "{post}: {worst}°");
        }
    }
}

/// Every robot that turns the part welds the path that it welds with the part held still, the wire as it stood on the part, straight down
/// within some degrees, and the axes within their limits.
fn robots_weld_it(name: &str, layers: &[Layer], plain: &Profile, positioner: &Positioner, allowed: f64) {
    let mut turned = turned_by(plain, positioner);
    for (post, on_part) in [("krl", true), ("rapid", true), ("fanuc", true), ("inform", true), ("inform", false)] {
        turned.dialects.inform.as_mut().unwrap().frame_turns = Some(on_part);
        let case = format!("{name} {post} {:?}", positioner.turning);
        let (by_torch, by_part) = (read(post, layers, plain), read(post, layers, &turned));
        same_path(&case, &by_torch.welds, &by_part.welds);
        let worst = by_part.welds.iter().map(|weld| off_plumb(weld, positioner)).fold(0.0, f64::max);
        println!("{case}: {} welds, the wire is off plumb by {worst:.4}°", by_part.welds.len());
        assert!(worst <= allowed, "{case}: {worst}°");
        for (weld, other) in by_part.welds.iter().zip(&by_torch.welds) {
            // The wire stands on the part as it did.
            let along = weld.tools.iter().zip(&other.tools);
            let off = along.map(|(a, b)| (*a * DVec3::Z).angle_between(*b * DVec3::Z).to_degrees()).fold(0.0, f64::max);
            assert!(off < 0.05, "{case}: {off}°");
            let within = |axes: &[Option<f64>; 2]| {
                let mut each = positioner.axes.iter().zip(axes);
                each.all(|(axis, at)| at.is_some_and(|at| (axis.limits[0]..=axis.limits[1]).contains(&at)))
            };
            assert!(weld.axes.iter().all(within), "{case}");
            if positioner.turning == Turning::Index {
                assert!(weld.axes.iter().all(|axes| *axes == weld.axes[0]), "{case}: it turns under the arc");
            }
        }
    }
}

/// To a Yaskawa a table that keeps the arc on its side is a station with one axis, in both kinds of frames.
#[test]
fn a_table_is_a_station_with_one_axis() {
    let mut plain = in_all_dialects(profile("cmt-al2319-kuka"));
    let layers = plan::plan("cross", &example::find("cross").unwrap().mesh(), &plain, &Task::new()).unwrap().layers;
    let (layers, up) = (&layers[..1], [0.0, 0.0, 1.0]);
    let by_torch = readers::inform::run(&dialect::write("inform", layers, &plain.job("demo")).unwrap(), "DEMO");
    plain.program.table_side = Some(-90.0);
    let table = Positioner { turning: Turning::Follow, axes: vec![axis([0.0, 0.0, 1.0], FREE)], up };
    for on_the_part in [true, false] {
        plain.dialects.inform.as_mut().unwrap().frame_turns = Some(on_the_part);
        let files = dialect::write("inform", layers, &plain.job("demo")).unwrap();
        let by_part = readers::inform::run_turned(&files, "DEMO", &|stand| on_part(stand, &table, !on_the_part));
        same_path(&format!("table {on_the_part}"), &by_torch.welds, &by_part.welds);
        let turned = by_part.welds.iter().flat_map(|weld| &weld.axes).map(|axes| axes[0].unwrap());
        let (least, most) = turned.fold((f64::MAX, f64::MIN), |(least, most), at| (least.min(at), most.max(at)));
        assert!(most - least > 180.0, "{least} to {most}");
        // Our own reader brings both back to the part.
        let options = plain.reading_options(None, Some("inform"));
        let main = files["DEMO.jbi"].clone();
        let program = dialect::read(&main, &mut |name| files.get(&format!("{name}.jbi")).cloned(), &options).unwrap();
        // Only home, in pulses, is a place that it does not know.
        assert!(program.notes.iter().all(|note| note.starts_with("a motion to a place")), "{:?}", program.notes);
        let own: f64 = program.layers().iter().flat_map(|layer| &layer.passes).map(|pass| along(&pass.points)).sum();
        let welded = by_torch.welds.iter().flat_map(|weld| weld.points.windows(2));
        let length: f64 = welded.map(|p| distance(p[0], p[1])).sum();
        assert!((own / length - 1.0).abs() < 1e-3, "{own} mm read, {length} mm welded");
    }
}
