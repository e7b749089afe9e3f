//! Positioners in the programs: seen from the cell, the pool is level and the torch hangs as it always does, and on the part the path
//! is the one of the plan. The cell is computed here from the axes that independent readers find.

use crate::common;
use crate::readers;

use beadwright::dialect;
use beadwright::example;
use beadwright::layer::Layer;
use beadwright::pass::{Along, Pass, PassKind};
use beadwright::plan;
use beadwright::profile::{Body, Profile};
use beadwright::program::{Positioner, PositionerAxis, Turning};
use beadwright::task::Task;
use common::{profile, with_all_dialects};
use glam::{DMat3, DVec3};
use readers::{Motion, Weld, distance};
use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::sync::{Arc, Mutex};

const FREE: [f64; 2] = [-1e5, 1e5];

fn axis(direction: [f64; 3], limits: [f64; 2]) -> PositionerAxis {
    PositionerAxis { direction, through: [0.0; 3], limits, speed: 90.0 }
}

/// A chuck whose axis lies level and carries the part by its lower face.
fn chuck() -> Positioner {
    Positioner { turning: Turning::Follow, axes: vec![axis([0.0, 0.0, 1.0], FREE)], up: [1.0, 0.0, 0.0] }
}

/// A table that tilts about x and turns about its own axis.
fn tilting(turning: Turning) -> Positioner {
    let axes = vec![axis([1.0, 0.0, 0.0], [-135.0, 135.0]), axis([0.0, 0.0, 1.0], FREE)];
    Positioner { turning, axes, up: [0.0, 0.0, 1.0] }
}

/// The first layers of each body of an example, planned once, with a profile for all dialects.
fn planned(name: &'static str) -> (Arc<Vec<Layer>>, Profile) {
    static PLANS: Mutex<BTreeMap<&str, Arc<Vec<Layer>>>> = Mutex::new(BTreeMap::new());
    let example = example::find(name).unwrap();
    let mut profile = profile("cmt-al2319-kuka");
    profile.layers.bodies = Body::read(&example.bodies().unwrap()).unwrap();
    let layers = Arc::clone(PLANS.lock().unwrap().entry(name).or_insert_with(|| {
        let plan = plan::plan(name, &example.mesh(), &profile, &Task::new()).unwrap();
        let of = |body: usize| plan.layers.iter().filter(move |layer| layer.body == body && !layer.passes.is_empty());
        let bodies = profile.layers.bodies.len();
        Arc::new((0..bodies).flat_map(|body| of(body).step_by(1 + of(body).count() / 4)).cloned().collect())
    }));
    let all = with_all_dialects("cmt-steel-robots");
    profile.dialects = all.dialects;
    profile.dialects.krl.as_mut().unwrap().max_megabytes = 1000.0;
    profile.dialects.rapid.as_mut().unwrap().speed_step = 0.001;
    profile.dialects.fanuc.as_mut().unwrap().table_group = Some(2);
    (layers, profile)
}

fn read(post: &str, layers: &[Layer], profile: &Profile) -> Motion {
    let files = dialect::write(post, layers, &profile.job("demo")).unwrap();
    match post {
        "krl" => readers::krl::run(&files, "DEMO", "$OUT[2]"),
        "fanuc" => readers::fanuc::run(&files, "DEMO"),
        _ => readers::rapid::run(&files, "demo", ""),
    }
}

/// A turn about a unit vector (Rodrigues).
fn about(axis: DVec3, degrees: f64) -> DMat3 {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let cross = DMat3::from_cols(axis.cross(DVec3::X), axis.cross(DVec3::Y), axis.cross(DVec3::Z));
    DMat3::IDENTITY + cross * sin + cross * cross * (1.0 - cos)
}

/// What takes the part's directions to the cell where up is up.
fn cell(positioner: &Positioner, axes: [Option<f64>; 2]) -> DMat3 {
    positioner.axes.iter().zip(axes).fold(DMat3::IDENTITY, |all, (axis, angle)| {
        all * about(DVec3::from(axis.direction).normalize(), angle.unwrap())
    })
}

/// Along a weld, how far the wire hangs from straight down in the cell at most, °.
fn off_plumb(weld: &Weld, positioner: &Positioner) -> f64 {
    let places = weld.tools.iter().zip(&weld.axes);
    let lean = places.map(|(tool, axes)| {
        let wire = cell(positioner, *axes) * (*tool * DVec3::Z);
        wire.angle_between(-DVec3::from(positioner.up)).to_degrees()
    });
    lean.fold(0.0, f64::max)
}

fn same_path(case: &str, a: &[Weld], b: &[Weld]) {
    assert!(!a.is_empty() && a.len() == b.len(), "{case}: {} {}", a.len(), b.len());
    for (a, b) in a.iter().zip(b) {
        assert_eq!((a.points.len(), a.speeds.len()), (b.points.len(), b.speeds.len()), "{case}");
        let off = a.points.iter().zip(&b.points).map(|(p, q)| distance(*p, *q)).fold(0.0, f64::max);
        let slower = a.speeds.iter().zip(&b.speeds).map(|(v, w)| (v / w - 1.0).abs()).fold(0.0, f64::max);
        assert!(off <= 0.01 && slower <= 0.005, "{case}: {off} mm, {slower}");
    }
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
        let mut turned = plain.clone();
        turned.program.positioner = Some(positioner.clone());
        for post in ["krl", "rapid", "fanuc"] {
            let case = format!("{name} {post} {:?}", positioner.turning);
            let (by_torch, by_part) = (read(post, &layers, &plain), read(post, &layers, &turned));
            same_path(&case, &by_torch.welds, &by_part.welds);
            let worst = by_part.welds.iter().map(|weld| off_plumb(weld, &positioner)).fold(0.0, f64::max);
            assert!(worst <= allowed, "{case}: {worst}°");
            for (weld, other) in by_part.welds.iter().zip(&by_torch.welds) {
                // The wire stands on the part as it did.
                let along = weld.tools.iter().zip(&other.tools);
                let off =
                    along.map(|(a, b)| (*a * DVec3::Z).angle_between(*b * DVec3::Z).to_degrees()).fold(0.0, f64::max);
                assert!(off < 0.05, "{case}: {off}°");
                let within = |axes: &[Option<f64>; 2]| {
                    positioner
                        .axes
                        .iter()
                        .zip(axes)
                        .all(|(axis, at)| at.is_some_and(|at| (axis.limits[0]..=axis.limits[1]).contains(&at)))
                };
                assert!(weld.axes.iter().all(within), "{case}");
                if positioner.turning == Turning::Index {
                    assert!(weld.axes.iter().all(|axes| *axes == weld.axes[0]), "{case}: it turns under the arc");
                }
            }
        }
    }
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

fn kinds(layers: &[Layer], profile: &Profile) -> Vec<(&'static str, String)> {
    let settings = plan::deposit_settings(profile);
    let found = beadwright::check(layers, profile, settings, &Task::new()).unwrap();
    let known = ["off-level", "positioner-speed"];
    found.into_iter().filter(|finding| known.contains(&finding.kind)).map(|f| (f.kind, f.text)).collect()
}

#[test]
fn checks_judge_the_part_as_the_positioner_holds_it() {
    let (layers, mut profile) = planned("shaft");
    let found = |profile: &Profile| kinds(&layers, profile);
    assert_eq!(found(&profile)[0].0, "off-level");
    profile.program.positioner = Some(chuck());
    assert_eq!(found(&profile), []);
    // It cannot turn all around.
    profile.program.positioner.as_mut().unwrap().axes[0].limits = [-90.0, 90.0];
    let limited = found(&profile);
    assert!(limited[0].0 == "off-level" && limited[0].1.contains("as the positioner holds the part"), "{limited:?}");
    profile.program.positioner = Some(chuck());
    profile.program.positioner.as_mut().unwrap().axes[0].speed = 1.0;
    let slow = found(&profile);
    assert!(slow.len() == 1 && slow[0].0 == "positioner-speed" && slow[0].1.contains("its speed is 1°/s"), "{slow:?}");
    // Between passes only, a ring cannot be kept level.
    profile.program.positioner = Some(Positioner { turning: Turning::Index, ..chuck() });
    assert_eq!(found(&profile)[0].0, "off-level");
}

#[test]
fn what_a_positioner_cannot_be_is_refused() {
    let wrong = |change: fn(&mut Positioner)| {
        let (mut profile, mut positioner) = (profile("cmt-al2319-kuka"), tilting(Turning::Follow));
        change(&mut positioner);
        profile.program.positioner = Some(positioner);
        Profile::parse(&profile.toml_text().unwrap()).unwrap_err().to_string()
    };
    assert!(wrong(|p| p.axes.clear()).contains("one axis or two"));
    assert!(wrong(|p| p.axes[1].direction = [3.0, 0.0, 0.1]).contains("turn the part in the same way"));
    assert!(wrong(|p| p.axes[0].limits = [90.0, -90.0]).contains("the least angle comes first"));
    assert!(wrong(|p| p.axes[0].direction = [0.0; 3]).contains("needs a direction"));
    assert!(wrong(|p| p.axes[0].speed = 0.0).contains("program.positioner.axes.speed"));
    let (layers, mut profile) = planned("dome");
    profile.program.positioner = Some(tilting(Turning::Follow));
    for post in ["inform", "urscript"] {
        let refused = dialect::write(post, &layers, &profile.job("demo")).unwrap_err().to_string();
        assert!(refused.contains("program.positioner") && refused.contains("krl"), "{refused}");
    }
    (profile.dialects.krl.as_mut().unwrap().table_machine, profile.dialects.fanuc.as_mut().unwrap().table_group) =
        (None, None);
    for (post, key) in [("krl", "krl.table_machine"), ("fanuc", "fanuc.table_group")] {
        let refused = dialect::write(post, &layers, &profile.job("demo")).unwrap_err().to_string();
        assert!(refused.contains(key) && refused.contains("program.positioner"), "{refused}");
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
