//! Parts that are welded as several bodies: each as a part of its own would be, on metal that is there, with ways between them that
//! touch nothing.

use crate::common;

use beadwright::as_built::as_built;
use beadwright::layer::Layer;
use beadwright::model::{Mesh, Object, Part, solid::Solid};
use beadwright::plan::{self, Plan, PlanError};
use beadwright::planar::{Polygon, Ring};
use beadwright::profile::{Body, Profile};
use beadwright::program::Instruction;
use beadwright::task::Task;
use beadwright::warning::WarningKind;
use beadwright::{check, example, plan_file};
use common::{imported, profile};
use glam::{DMat3, DVec2, DVec3};
use std::convert::Infallible;

fn with_bodies(bodies: &str) -> Profile {
    let mut profile = profile("cmt-al2319-kuka");
    profile.layers.bodies = Body::read(bodies).unwrap();
    profile
}

fn y_tube() -> (Mesh, Profile) {
    let example = example::find("y-tube").unwrap();
    (example.mesh(), with_bodies(&example.bodies().unwrap()))
}

fn planned(mesh: &Mesh, profile: &Profile) -> Result<Plan, PlanError<Infallible>> {
    common::planned_once("part", mesh, profile)
}

/// A box from its lowest to its highest corner.
fn block(low: DVec3, high: DVec3) -> Solid {
    let corners = [(low.x, low.y), (high.x, low.y), (high.x, high.y), (low.x, high.y)];
    let outline = Polygon::simple(Ring::new(corners.map(|(x, y)| DVec2::new(x, y)).to_vec()));
    Solid::loft(&outline, &[low.z, high.z], |p, _| p)
}

/// A plate, a block that reaches into it, and one that stands on it.
#[test]
fn a_body_is_the_solid_that_it_names() {
    let solids = [
        block(DVec3::ZERO, DVec3::new(100.0, 60.0, 12.0)),
        block(DVec3::new(10.0, 10.0, 8.0), DVec3::new(40.0, 50.0, 40.0)),
        block(DVec3::new(60.0, 10.0, 12.0), DVec3::new(90.0, 50.0, 36.0)),
    ];
    let Part::Mesh(mut import) = imported(mesh_of(&solids)) else { unreachable!() };
    let at = vec![DVec3::new(75.0, 30.0, 36.0)];
    import.objects = vec![Object { name: "block".to_owned(), triangles: 12, at }];
    let text = "[[body]]\nname = \"plate\"\nsolids = [\"50/30/0\"]\n\n\
                [[body]]\nname = \"bar\"\nwithin = [\"up=0/0/1,through=0/0/12\"]\nsolids = [\"25/30/40\"]\n\n\
                [[body]]\nname = \"block\"\nsolids = [\"block\"]\n";
    assert_eq!(Body::read(&Body::write(&Body::read(text).unwrap())).unwrap(), Body::read(text).unwrap());
    let part = Part::Mesh(import);
    let chosen = plan::choice::choose(&part, &with_bodies(text), true, &Task::new()).unwrap().profile;
    let plan = plan::plan("part", &part, &chosen, &Task::new()).unwrap();
    let volume = |body: usize| -> f64 {
        let layers = plan.layers.iter().filter(|layer| layer.body == body);
        layers.map(|layer| layer.height * layer.islands.iter().map(Polygon::area).sum::<f64>()).sum()
    };
    for (body, expected) in [100.0 * 60.0 * 12.0, 30.0 * 40.0 * 28.0, 30.0 * 40.0 * 24.0].into_iter().enumerate() {
        assert!((volume(body) / expected - 1.0).abs() < 0.01, "body {body}: {} of {expected} mm³", volume(body));
    }
    let built = as_built(&plan.layers, &chosen, part.mesh().unwrap(), &Task::new()).unwrap();
    assert!(built.agreement() > 0.95, "{}", built.agreement());

    let unknown = with_bodies(&text.replace("solids = [\"block\"]", "solids = [\"blok\"]"));
    let unknown = plan::choice::choose(&part, &unknown, true, &Task::new()).unwrap().profile;
    let refused = plan::plan("part", &part, &unknown, &Task::new()).unwrap_err().to_string();
    assert!(refused.contains("body block") && refused.contains("named \"blok\""), "{refused}");
}

/// A block beside a lower one: from the lower one's top on, its layers reach over that.
#[test]
fn a_body_may_grow_over_one_welded_before() {
    let solids = [
        block(DVec3::ZERO, DVec3::new(30.0, 60.0, 20.0)),
        block(DVec3::new(30.0, 0.0, 0.0), DVec3::new(60.0, 60.0, 20.0)),
        block(DVec3::new(0.0, 0.0, 20.0), DVec3::new(60.0, 60.0, 40.0)),
    ];
    let bodies = |up: DVec3, side: DVec3| {
        let plane = |up: DVec3, p: DVec3| format!("\"up={}/{}/{},through={}/{}/{}\"", up.x, up.y, up.z, p.x, p.y, p.z);
        let corner = 30.0 * side + 20.0 * up;
        let chart = format!("chart = \"plane:up={}/{}/{}\"", up.x, up.y, up.z);
        format!(
            "[[body]]\nname = \"low\"\n{chart}\nwithin = [{}, {}]\n\n[[body]]\nname = \"high\"\n{chart}\non_stock = true\n",
            plane(-up, corner),
            plane(-side, corner)
        )
    };
    for turn in
        [DMat3::IDENTITY, DMat3::from_rotation_z(0.6), DMat3::from_rotation_x(0.2) * DMat3::from_rotation_z(0.6)]
    {
        let mut mesh = mesh_of(&solids);
        mesh.vertices.iter_mut().for_each(|vertex| *vertex = turn * *vertex);
        // What is not low is high: the blocks without what is welded already.
        let low = bodies(turn * DVec3::Z, turn * DVec3::X);
        let mut profile = with_bodies(&low);
        profile.torch = None;
        profile.layers.bodies[1].solids = [DVec3::new(60.0, 30.0, 10.0), DVec3::new(60.0, 30.0, 30.0)]
            .map(|p| beadwright::profile::Solid::At(turn * p))
            .to_vec();
        let plan = planned(&mesh, &profile).unwrap();
        assert!(plan.summary.forbidden.is_empty(), "{:?}", plan.summary.forbidden);
        let warned = |kind| plan.summary.warnings.summaries().any(|warning| warning.kind == kind);
        assert!(!warned(WarningKind::InTheAir) && !warned(WarningKind::Overhang), "{:?}", plan.summary.warnings);
        let settings = plan::deposit_settings(&profile);
        let found = check::check(&plan.layers, &profile, settings, &Task::new()).unwrap();
        assert!(found.iter().all(|finding| finding.kind != "overhang"), "{found:?}");
        // Without the low body there is nothing below.
        profile.layers.bodies.remove(0);
        let alone = planned(&mesh, &profile).unwrap();
        assert!(!alone.summary.forbidden.is_empty());
    }
}

fn mesh_of(solids: &[Solid]) -> Mesh {
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for solid in solids {
        let first = vertices.len() as u32;
        vertices.extend(&solid.vertices);
        triangles.extend(solid.triangles.iter().map(|corners| corners.map(|corner| corner + first)));
    }
    Mesh::from_triangles(vertices, triangles).0
}

/// Beads of a layer in space.
fn beads<'a>(layer: &'a Layer, profile: &'a Profile) -> impl Iterator<Item = DVec3> + 'a {
    let sheet = profile.layers.sheet(layer);
    layer.passes.iter().flat_map(|pass| &pass.points).map(move |p| sheet.map_or(*p, |sheet| sheet.at(*p).place))
}

/// The layer in view, which is planned first, is none of the part's level layers.
#[test]
fn a_part_of_several_bodies_has_no_preview() {
    let (mesh, profile) = y_tube();
    let seen =
        |profile: &Profile| beadwright::plan::preview(&imported(mesh.clone()), profile, 3, &Task::new()).unwrap();
    assert!(seen(&profile).is_none());
    let mut level = profile.clone();
    level.layers.bodies.clear();
    assert!(seen(&level).is_some_and(|layer| layer.index == 3));
}

#[test]
fn a_forked_tube_is_welded_whole_at_any_angle() {
    let (mesh, given) = y_tube();
    for degrees in [0.0_f64, 37.0, 90.0, 201.0] {
        let turn = DMat3::from_rotation_z(degrees.to_radians());
        let (mut turned, mut profile) = (mesh.clone(), given.clone());
        turned.vertices.iter_mut().for_each(|p| *p = turn * *p);
        for body in &mut profile.layers.bodies {
            let planes = |text: String| -> String {
                let mut plane: beadwright::chart::Plane = text.parse().unwrap();
                (plane.up, plane.origin) = (turn * plane.up, turn * plane.origin);
                plane.to_string()
            };
            body.within.iter_mut().for_each(|plane| *plane = planes(plane.to_string()).parse().unwrap());
            if !body.chart.is_level() {
                body.chart = format!("plane:{}", planes(body.chart.to_string())).parse().unwrap();
            }
        }
        let plan = planned(&turned, &profile).unwrap();
        assert!(plan.summary.forbidden.is_empty(), "{degrees}: {:?}", plan.summary.forbidden);
        let of = |body: usize| plan.layers.iter().filter(move |layer| layer.body == body);
        assert!(plan.layers.is_sorted_by_key(|layer| layer.body) && (0..3).all(|body| of(body).count() > 20));
        let metrics = &plan.summary.metrics;
        let (laid, part) = (metrics.deposited_volume_mm3, turned.volume());
        assert!((laid / part - 1.0).abs() < 0.02, "{degrees}: {laid} of {part}");
        assert!((metrics.mesh_volume_mm3.unwrap() / part - 1.0).abs() < 1e-3);
        assert!(metrics.arc_starts <= metrics.layers + 6, "{} starts", metrics.arc_starts);
        // The arms are mirror images of one another.
        let [right, left] = [1, 2].map(|body| of(body).map(|layer| layer.slice_area * layer.height).sum::<f64>());
        assert!((right / left - 1.0).abs() < 0.01, "{right} {left}");
        // Every bead lies in its body.
        for layer in &plan.layers {
            let body = &profile.layers.bodies[layer.body];
            let outside = |p: &DVec3| body.within.iter().any(|bound| bound.height(*p) < -3.0);
            assert_eq!(beads(layer, &profile).find(outside), None, "{degrees}: layer {}", layer.index + 1);
        }
    }
}

/// The torch, on its way with the arc off, stays clear of what is welded.
#[test]
fn ways_between_bodies_touch_nothing() {
    let (mesh, profile) = y_tube();
    let plan = planned(&mesh, &profile).unwrap();
    let (mut programmer, mut laid, mut at, mut long) = (profile.programmer(), Vec::<DVec3>::new(), None, 0);
    for layer in &plan.layers {
        let changes = layer.index > 0 && plan.layers[layer.index - 1].body != layer.body;
        for instruction in programmer.layer(layer).instructions {
            let Some(to) = instruction.target() else { continue };
            let from = at.replace(to).unwrap_or(to);
            match instruction {
                Instruction::Weld { .. } => laid.push(to),
                Instruction::Travel { .. } if changes => {
                    let steps = from.distance(to).ceil() as usize;
                    // The last move goes down to where the arc is struck.
                    let near = |p: DVec3| laid.iter().map(|metal| metal.distance(p)).fold(f64::INFINITY, f64::min);
                    let close = (0..=steps).map(|k| from.lerp(to, k as f64 / steps.max(1) as f64)).map(near);
                    let last = to.distance(beads(layer, &profile).next().unwrap()) < 0.01;
                    assert!(
                        last || close.fold(f64::INFINITY, f64::min) > 0.45 * profile.travel.clearance,
                        "{from} {to}"
                    );
                    long += 1;
                }
                _ => {}
            }
        }
    }
    assert!(long >= 8, "{long} travels");
}

#[test]
fn bodies_are_read_back_from_plan_json() {
    let (mesh, profile) = y_tube();
    let plan = planned(&mesh, &profile).unwrap();
    let layers = plan.layers.iter().map(|layer| plan_file::layer(layer, profile.layers.sheet(layer).as_ref()));
    let text = plan_file::head(&plan.header, &profile) + &layers.collect::<String>() + plan_file::tail();
    let again = plan_file::read(&text).unwrap();
    assert_eq!(again.profile.as_ref().unwrap().layers.bodies, profile.layers.bodies);
    for (a, b) in plan.layers.iter().zip(&again.layers) {
        assert_eq!((a.body, a.index, a.passes.len()), (b.body, b.index, b.passes.len()));
        let points = |layer: &Layer| layer.passes.iter().flat_map(|pass| pass.points.clone()).collect::<Vec<_>>();
        assert!(points(a).iter().zip(points(b)).all(|(a, b)| a.distance(b) < 2e-4), "layer {}", a.index + 1);
    }
    let missing = text.replace("\"body\":2", "\"body\":3");
    assert!(plan_file::read(&missing).unwrap_err().to_string().contains("layers.bodies"));
}

/// A post with a bracket on its side: the bracket stands on the post or on nothing.
#[test]
fn a_body_on_nothing_is_refused() {
    let post = || block(DVec3::new(-20.0, -20.0, 0.0), DVec3::new(20.0, 20.0, 80.0));
    let arm = |from: f64| block(DVec3::new(from, -15.0, 40.0), DVec3::new(60.0, 15.0, 70.0));
    let bodies = |from: f64, more: &str| {
        with_bodies(&format!(
            "[[body]]\nname = \"post\"\nwithin = [\"up=-1/0/0,through=20/0/0\"]\n\n\
             [[body]]\nname = \"arm\"\nchart = \"plane:up=x,through={from}/0/0\"\n{more}"
        ))
    };
    let plan = |from: f64, more: &str| planned(&mesh_of(&[post(), arm(from)]), &bodies(from, more)).unwrap();
    assert!(plan(20.0, "").summary.forbidden.is_empty());
    let hanging = plan(30.0, "");
    assert!(hanging.summary.warnings.summaries().any(|w| w.kind == WarningKind::InTheAir));
    assert!(hanging.summary.forbidden[0].contains("nothing"), "{:?}", hanging.summary.forbidden);
    assert!(plan(30.0, "on_stock = true\n").summary.forbidden.is_empty());
}

#[test]
fn a_torch_that_would_hit_a_finished_body_is_found() {
    let (low, high) = (DVec3::new(-50.0, -20.0, 0.0), DVec3::new(50.0, 20.0, 20.0));
    let tower = |x: f64| block(DVec3::new(x - 15.0, -15.0, 20.0), DVec3::new(x + 15.0, 15.0, 120.0));
    let bodies = |gap: f64| {
        with_bodies(&format!(
            "[[body]]\nname = \"foot\"\nwithin = [\"up=-z,through=0/0/20\"]\n\n\
             [[body]]\nname = \"first\"\nchart = \"plane:through=0/0/20\"\nwithin = [\"up=-x,through={gap}/0/0\"]\n\n\
             [[body]]\nname = \"second\"\nchart = \"plane:through=0/0/20\"\nwithin = [\"up=x,through={gap}/0/0\"]\n"
        ))
    };
    let found = |apart: f64| {
        let mesh = mesh_of(&[block(low.with_x(-300.0), high.with_x(300.0)), tower(-apart), tower(apart)]);
        planned(&mesh, &bodies(0.0)).unwrap().summary.forbidden
    };
    let close = found(25.0);
    assert!(
        close.iter().any(|text| text.starts_with("The torch would hit \"first\" while it welds \"second\"")),
        "{close:?}"
    );
    assert_eq!(found(200.0), Vec::<String>::new());
}

#[test]
fn what_belongs_to_no_body_or_to_two_is_said() {
    let (mesh, mut profile) = y_tube();
    profile.layers.bodies.pop();
    let notes = planned(&mesh, &profile).unwrap().summary.notes;
    assert!(notes.iter().any(|note| note.contains("belong to no body")), "{notes:?}");
    profile.layers.bodies[1].within.clear();
    let (_, whole) = y_tube();
    profile.layers.bodies.push(whole.layers.bodies[2].clone());
    let forbidden = planned(&mesh, &profile).unwrap().summary.forbidden;
    let twice = "Bodies \"right arm\" and \"left arm\" have";
    assert!(forbidden[0].starts_with(twice) && forbidden[0].contains("welded twice"), "{forbidden:?}");
}

/// A body that begins below the top of the one before it would drive the torch into finished metal.
#[test]
fn bodies_that_overlap_are_refused_and_those_that_meet_are_not() {
    let (mesh, mut profile) = y_tube();
    let bodies = |from: f64| {
        let text = format!(
            "[[body]]\nname = \"low\"\nwithin = [\"up=-z,through=0/0/30\"]\n\n[[body]]\nname = \"high\"\nwithin = [\"up=-z,through=0/0/60\"]\n\
             chart = \"plane:up=z,through=0/0/{from}\"\n"
        );
        Body::read(&text).unwrap()
    };
    for (from, overlaps) in [(30.0, false), (29.0, true), (20.0, true)] {
        profile.layers.bodies = bodies(from);
        let forbidden = planned(&mesh, &profile).unwrap().summary.forbidden;
        let said = forbidden.iter().any(|text| text.starts_with("Bodies \"low\" and \"high\" have"));
        assert_eq!(said, overlaps, "from {from} mm: {forbidden:?}");
    }
}

#[test]
fn errors_name_the_body() {
    let (mesh, mut profile) = y_tube();
    profile.layers.bodies[1].within.push("up=z,through=0/0/900".parse().unwrap());
    let error = planned(&mesh, &profile).unwrap_err().to_string();
    assert!(error.starts_with("body right arm (layers.bodies): nothing of the part"), "{error}");
    let text = "[[body]]\nname = \"a\"\n\n[[body]]\nchart = \"plane\"\n";
    let error = Body::read(text).unwrap_err().to_string();
    assert!(error.contains("name") && error.contains('4'), "{error}");
    let error = Body::read("[[body]]\nname = \"a\"\nwithin = [\"cone:angle=30\"]\n").unwrap_err().to_string();
    assert!(error.contains("bounds nothing"), "{error}");
}

/// Checks look at each body by itself, as they look at a part.
#[test]
fn the_checks_of_a_plan_of_bodies_are_those_of_its_bodies() {
    let (mesh, profile) = y_tube();
    let plan = planned(&mesh, &profile).unwrap();
    let settings = plan::deposit_settings(&profile);
    let whole = check::check(&plan.layers, &profile, settings, &Task::new()).unwrap();
    assert!(whole.iter().all(|f| !["layers", "overhang", "air", "crossing"].contains(&f.kind)), "{whole:?}");
    let mut each = Vec::new();
    for k in 0..profile.layers.bodies.len() {
        let own = profile.of_body(k);
        let layers: Vec<&Layer> = plan.layers.iter().filter(|layer| layer.body == k).collect();
        each.extend(check::check(&layers, &own, settings, &Task::new()).unwrap());
    }
    let texts = |found: &[beadwright::Finding]| found.iter().map(|f| f.text.clone()).collect::<Vec<_>>();
    assert_eq!(texts(&whole), texts(&each));
}

#[test]
fn caps_and_cladding_follow_their_surface() {
    for (name, layers) in [("dome", 6), ("clad", 3)] {
        let example = example::find(name).unwrap();
        let (mesh, profile) = (example.mesh(), with_bodies(&example.bodies().unwrap()));
        let plan = planned(&mesh, &profile).unwrap();
        let metrics = &plan.summary.metrics;
        assert!(plan.summary.forbidden.is_empty(), "{name}: {:?}", plan.summary.forbidden);
        assert_eq!((metrics.layers, metrics.arc_starts), (layers, layers), "{name}");
        assert!((metrics.deposited_volume_mm3 / mesh.volume() - 1.0).abs() < 0.02, "{name}");
        let found = check::check(&plan.layers, &profile, plan::deposit_settings(&profile), &Task::new()).unwrap();
        assert!(found.iter().all(|f| !["off-level", "void", "overfill"].contains(&f.kind)), "{name}: {found:?}");
        // The metal of each pass is that of the program: time × speed in space holds what the plan says.
        let (mut programmer, mut seconds, mut at) = (profile.programmer().unfitted(), 0.0, DVec3::ZERO);
        for instruction in plan.layers.iter().flat_map(|layer| programmer.layer(layer).instructions) {
            let Some(to) = instruction.target() else { continue };
            if let Instruction::Weld { speed, .. } = instruction {
                seconds += at.distance(to) / speed;
            }
            at = to;
        }
        let process = &profile.process;
        let planned: f64 = plan.layers.iter().flat_map(|layer| &layer.passes).map(|pass| pass.seconds(process)).sum();
        assert!((seconds / planned - 1.0).abs() < 2e-3, "{name}: {seconds} {planned}");
    }
}

/// A part on a base, wherever both lie.
#[test]
fn a_part_on_a_base_must_lie_on_it() {
    let base = mesh_of(&[block(DVec3::new(-60.0, -40.0, 0.0), DVec3::new(60.0, 40.0, 25.0))]);
    let part = |x: f64| mesh_of(&[block(DVec3::new(x - 20.0, -15.0, 25.0), DVec3::new(x + 20.0, 15.0, 37.0))]);
    let plan = |x: f64| {
        let mesh = part(x);
        let model = imported(mesh.clone());
        let choice = plan::choice::choose(&model, &profile("cmt-al2319-kuka"), true, &Task::new()).unwrap();
        let solid = beadwright::model::PartRef::from(&mesh).onto(&base);
        (plan::plan("part", solid, &choice.profile, &Task::new()).unwrap(), choice.profile)
    };
    let (on_it, profile) = plan(0.0);
    assert!(on_it.summary.forbidden.is_empty(), "{:?}", on_it.summary.forbidden);
    let low = on_it.layers.iter().flat_map(|layer| beads(layer, &profile)).map(|p| p.z).fold(f64::INFINITY, f64::min);
    assert!(low > 25.0 && low < 28.0, "{low}");
    let (beside, _) = plan(75.0);
    assert!(
        beside.summary.warnings.summaries().any(|w| w.kind == WarningKind::InTheAir),
        "{:?}",
        beside.summary.forbidden
    );
}

/// A block on a wider base: every layer of the tilted one reaches the base where it is the lowest.
#[test]
fn tilted_layers_stand_on_the_base_all_the_way_up() {
    let mesh = mesh_of(&[
        block(DVec3::new(-30.0, -20.0, 0.0), DVec3::new(130.0, 60.0, 12.0)),
        block(DVec3::new(0.0, 0.0, 12.0), DVec3::new(100.0, 40.0, 42.0)),
    ]);
    for degrees in [5.0_f64, 10.0, 14.0] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let profile = with_bodies(&format!(
            "[[body]]\nname = \"base\"\nwithin = [\"up=-z,through=0/0/12\"]\n\n[[body]]\nname = \"wedge\"\n\
             chart = \"plane:up={sin}/0/{cos},through=0/0/12\"\nwithin = [\"up=z,through=0/0/12\"]\n"
        ));
        let plan = planned(&mesh, &profile).unwrap();
        assert_eq!(plan.summary.forbidden, Vec::<String>::new(), "{degrees}");
        let hanging = plan.summary.warnings.summaries().filter(|w| w.kind == WarningKind::Overhang).count();
        assert_eq!(hanging, 0, "{degrees}");
    }
}

#[test]
fn a_body_on_one_that_is_welded_after_it_is_refused() {
    let column = |x: f64| block(DVec3::new(x, 0.0, 0.0), DVec3::new(x + 30.0, 30.0, 60.0));
    let mesh = mesh_of(&[column(0.0), column(150.0)]);
    let upper = "[[body]]\nname = \"up\"\nchart = \"plane:up=z,through=0/0/30\"\n";
    let lower = "[[body]]\nname = \"low\"\nwithin = [\"up=-z,through=0/0/30\"]\n";
    let refused = planned(&mesh, &with_bodies(&format!("{upper}{lower}"))).unwrap_err().to_string();
    assert!(refused.contains("up") && refused.contains("lies on \"low\", which is welded after it"), "{refused}");
    let plan = planned(&mesh, &with_bodies(&format!("{lower}{upper}"))).unwrap();
    assert_eq!(plan.summary.forbidden, Vec::<String>::new());
}

/// Walls have more metal on the first layer of a body: on that of every body, wherever it comes in the plan.
#[test]
fn first_layers_of_walls_fit_their_wire_on_every_body() {
    let mesh = mesh_of(&[block(DVec3::ZERO, DVec3::new(100.0, 7.0, 60.0))]);
    let mut profile = with_bodies(
        "[[body]]\nname = \"low\"\nwithin = [\"up=-z,through=0/0/30\"]\nstrategy = \"wall\"\n\n\
         [[body]]\nname = \"up\"\nchart = \"plane:up=z,through=0/0/30\"\nstrategy = \"wall\"\n",
    );
    profile.layers.predict = beadwright::profile::Predict::Always;
    let plan = planned(&mesh, &profile).unwrap();
    let found = check::check(&plan.layers, &profile, plan::deposit_settings(&profile), &Task::new()).unwrap();
    assert!(found.iter().all(|finding| finding.kind != "wire-balance"), "{found:?}");
}

#[test]
fn two_bodies_of_one_name_are_refused() {
    let text = "[[body]]\nname = \"a\"\n\n[[body]]\nname = \"a\"\nwithin = [\"up=z,through=0/0/9\"]\n";
    let refused = Body::read(text).unwrap_err().to_string();
    assert!(refused.starts_with("line 4: another body is named \"a\""), "{refused}");
}

/// A blade of one bead is welded by `wall`, unless its body asks for something else.
#[test]
fn a_strategy_named_by_a_body_is_kept() {
    let solid = block(DVec3::ZERO, DVec3::new(100.0, 7.0, 40.0));
    let part = imported(mesh_of(&[solid]));
    for (named, expected) in [("", "wall"), ("strategy = \"contour\"\n", "contour")] {
        let text = format!(
            "[[body]]\nname = \"low\"\nwithin = [\"up=-z,through=0/0/20\"]\n{named}\n[[body]]\nname = \"up\"\nchart = \"plane:up=z,through=0/0/20\"\n"
        );
        let chosen = plan::choice::choose(&part, &with_bodies(&text), false, &Task::new()).unwrap().profile;
        let strategy = |k: usize| chosen.layers.bodies[k].strategy.map(|strategy| strategy.to_string());
        assert_eq!((strategy(0).as_deref(), strategy(1).as_deref()), (Some(expected), Some("wall")));
    }
}

/// The report does not speak of a loop where there is none.
#[test]
fn a_plan_whose_bodies_are_all_walls_names_wall_as_its_strategy() {
    let mesh = common::tube(30.0, 7.0, 40.0, 0.0);
    let halves = "[[body]]\nname = \"lower\"\nchart = \"plane:up=0/0/1,through=0/0/0\"\n\
                  [[body]]\nname = \"upper\"\nchart = \"plane:up=0/0/1,through=0/0/20\"\n";
    let profile = with_bodies(halves);
    let choice = plan::choice::choose(&imported(mesh.clone()), &profile, false, &Task::new()).unwrap();
    assert!(choice.note.is_some_and(|note| note.contains("lower, upper")));
    let plan = planned(&mesh, &choice.profile).unwrap();
    assert_eq!(plan.header.strategy, "wall");
    // One body of another strategy, and the plan keeps its own.
    let mut mixed = profile;
    mixed.layers.bodies[0].strategy = Some("contour".parse().unwrap());
    let choice = plan::choice::choose(&imported(mesh), &mixed, false, &Task::new()).unwrap();
    assert_eq!(choice.profile.fill.strategy, mixed.fill.strategy);
}
