//! Directions found for the pieces of a part: they are planned, and what is offered first can be welded.

use crate::common;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use beadwright::chart::Bound;
use beadwright::directions::{Found, Outcome, Settings, divisions, metal, page, tried, untried};
use beadwright::example;
use beadwright::layer::Layer;
use beadwright::model::{Mesh, solid::Solid};
use beadwright::plan::{Blocked, Plan, PlanError};
use beadwright::planar::{Polygon, Ring};
use beadwright::profile::{Body, Profile};
use beadwright::task::Task;
use common::{imported, profile};
use glam::{DMat3, DVec2, DVec3};
use std::collections::BTreeMap;
use std::convert::Infallible;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::io::Read;

fn planned(mesh: &Mesh, profile: &Profile) -> Result<Plan, PlanError<Infallible>> {
    common::planned_once("part", mesh, profile)
}

/// A round bar of this radius and length, mm.
fn bar(radius: f64, length: f64, turn: DMat3, from: DVec3) -> Mesh {
    let corner = |k: i32| DVec2::from_angle(TAU * f64::from(k) / 64.0) * radius;
    let outline = Polygon::simple(Ring::new((0..64).map(corner).collect()));
    let Solid { vertices, triangles } = Solid::extrude(&outline, 0.0, length);
    Mesh::from_triangles(vertices.into_iter().map(|p| from + turn * p).collect(), triangles).0
}

/// A trunk of 36 mm diameter and this height, mm, with branches of 24 mm: their angle from the vertical and around the trunk, °, the
/// height at which they begin and their length from the trunk's axis, mm.
fn tree(height: f64, branches: &[(f64, f64, f64, f64)]) -> Mesh {
    let mut mesh = bar(18.0, height, DMat3::IDENTITY, DVec3::ZERO);
    // A little into the trunk, so that they are one.
    let outside: Bound = "cylinder:axis=z,radius=17.5,side=outer".parse().unwrap();
    for &(lean, around, from, length) in branches {
        let turn = DMat3::from_rotation_z(around.to_radians()) * DMat3::from_rotation_y(lean.to_radians());
        mesh.add(outside.part_of(&bar(12.0, length, turn, DVec3::Z * from)));
    }
    mesh
}

fn beads<'a>(layer: &'a Layer, profile: &'a Profile) -> impl Iterator<Item = DVec3> + 'a {
    let sheet = profile.layers.sheet(layer);
    layer.passes.iter().flat_map(|pass| &pass.points).map(move |p| sheet.map_or(*p, |sheet| sheet.at(*p).place))
}

/// A trunk with two branches, found and welded: the first layer of a branch lies on the trunk, and all beads in their bodies.
#[test]
fn bars_that_branch_are_welded_on_the_bar_that_carries_them() {
    let settings = Settings { lean: 45.0, tilt: 90.0, bead: 7.54 };
    for turned in [0.0_f64, 64.0] {
        let branches = [(90.0, turned, 60.0, 90.0), (60.0, 150.0 + turned, 80.0, 90.0)];
        let mesh = tree(130.0, &branches);
        let found = divisions(&mesh, settings, &Task::new()).unwrap();
        let mut profile = profile("cmt-al2319-kuka");
        profile.layers.bodies = Body::of_division("tree", &found[0]);
        assert_eq!(profile.layers.bodies.len(), 3, "{turned}: {:?}", profile.layers.bodies);
        // As it is written and read.
        profile.layers.bodies = Body::read(&Body::write(&profile.layers.bodies)).unwrap();
        let plan = planned(&mesh, &profile).unwrap();
        assert!(plan.summary.forbidden.is_empty(), "{turned}: {:?}", plan.summary.forbidden);
        let metrics = &plan.summary.metrics;
        let (laid, part) = (metrics.deposited_volume_mm3, mesh.volume());
        assert!((laid / part - 1.0).abs() < 0.03, "{turned}: {laid} of {part}");
        for layer in &plan.layers {
            let body = &profile.layers.bodies[layer.body];
            let outside = |p: &DVec3| body.within.iter().any(|bound| bound.height(*p) < -3.0);
            assert_eq!(beads(layer, &profile).find(outside), None, "{turned}: layer {}", layer.index + 1);
        }
        for branch in [1, 2] {
            let first = plan.layers.iter().find(|layer| layer.body == branch && !layer.passes.is_empty()).unwrap();
            let away = |p: DVec3| p.truncate().length();
            let [near, far] = [f64::min, f64::max].map(|of| beads(first, &profile).map(away).reduce(of).unwrap());
            assert!(17.9 < near && far < 18.1 + first.height, "{turned}: {near} to {far} mm from the trunk's axis");
        }
    }
}

/// From a mesh alone: a hub with blades and a bent tube are planned in the directions that are found, as by the bodies that come with
/// the examples.
#[test]
fn directions_that_are_found_are_planned() {
    for (name, layers) in [("hub", 50), ("elbow", 125)] {
        let mesh = example::find(name).unwrap().mesh();
        let settings = Settings { lean: 45.0, tilt: 90.0, bead: 7.0 };
        let found = divisions(&mesh, settings, &Task::new()).unwrap();
        let text = Body::write(&Body::of_division(name, &found[0]));
        let mut own = profile("cmt-al2319-kuka");
        own.layers.bodies = Body::read(&text).unwrap();
        let plan = planned(&mesh, &own).unwrap();
        assert_eq!(plan.summary.forbidden, [] as [String; 0], "{name}");
        assert!(plan.summary.metrics.layers.abs_diff(layers) <= 1, "{name}: {}", plan.summary.metrics.layers);
        assert!(plan.summary.metrics.coverage() > 0.99, "{name}: {}", plan.summary.metrics.coverage());
    }
}

/// What is offered first can be welded, and what cannot says why: a post with two arms, and a bridge on two posts, which planes
/// cannot divide.
#[test]
fn directions_that_are_offered_first_can_be_welded() {
    let profile = profile("cmt-steel-abb");
    let settings = Settings::usual(profile.bead.width);
    // A sheet 40 mm thick with an outline in x and z, mm, turned about z.
    let found = |outline: &[[f64; 2]], degrees: f64| -> (Mesh, Found) {
        let turn = DMat3::from_rotation_z(degrees.to_radians()) * DMat3::from_rotation_x(FRAC_PI_2);
        let outline = Polygon::simple(Ring::new(outline.iter().copied().map(DVec2::from).collect()));
        let Solid { vertices, triangles } = Solid::extrude(&outline, 0.0, 40.0);
        let mesh = Mesh::from_triangles(vertices.into_iter().map(|p| turn * p).collect(), triangles).0;
        let found = tried("post", &imported(mesh.clone()), &profile, false, settings, &Task::new()).unwrap();
        (mesh, found)
    };
    let [left, right] = [
        [[-20.0, 90.0], [-20.0, 65.0], [-80.0, 65.0], [-80.0, 40.0], [-20.0, 40.0]],
        [[20.0, 60.0], [90.0, 60.0], [90.0, 90.0], [20.0, 90.0], [0.0, 90.0]],
    ];
    let arms = [&[[-20.0, 0.0], [20.0, 0.0]], &right[..], &left].concat();
    for degrees in [0.0, 37.0] {
        let (mesh, Found { divisions, tilted, .. }) = found(&arms, degrees);
        let (level, tried) = divisions.split_last().unwrap();
        assert!(tried[0].is_planned() && tried[0].bodies.len() == 3, "{degrees}°: {:?}", tried[0]);
        assert!(tried.is_sorted_by_key(|tried| !tried.is_planned()) && tilted.is_none(), "{degrees}°");
        assert_eq!(level.outcome, Outcome::Untried, "{degrees}°: not needed");
        let mut own = profile.clone();
        own.layers.bodies = Body::read(&Body::write(&tried[0].bodies)).unwrap();
        let plan = planned(&mesh, &own).unwrap();
        assert_eq!(plan.summary.forbidden, [] as [String; 0], "{degrees}°");
        let Outcome::Planned(metrics) = &tried[0].outcome else { unreachable!() };
        assert_eq!(**metrics, plan.summary.metrics, "{degrees}°: its figures are those of its plan");
        assert!(metrics.coverage() > 0.99, "{degrees}°: {}", metrics.coverage());
    }
    let posts = [
        [-60.0, 0.0],
        [-30.0, 0.0],
        [-30.0, 60.0],
        [30.0, 60.0],
        [30.0, 0.0],
        [60.0, 0.0],
        [60.0, 90.0],
        [-60.0, 90.0],
    ];
    let (_, Found { divisions, level, .. }) = found(&posts, 0.0);
    assert!((level - 60.0 * 40.0).abs() < 1.0, "{level}");
    for tried in divisions {
        let Outcome::Refused { reason, hangs, .. } = tried.outcome else { panic!("{:?}", tried.bodies) };
        assert!(reason.ends_with('.') && reason.contains("mm"), "{reason}");
        assert!(hangs || !tried.bodies[0].chart.is_level() || tried.bodies.len() > 1, "{reason}");
    }
}

/// Beside a long branch, the torch has no room for a short one near it, but it has for both in the other order, at any angle.
#[test]
fn branches_are_welded_in_an_order_in_which_the_torch_has_room() {
    let profile = profile("cmt-al2319-kuka");
    let settings = Settings::usual(profile.bead.width);
    for turned in [0.0, 64.0] {
        let mesh = tree(150.0, &[(90.0, turned, 50.0, 150.0), (90.0, turned + 20.0, 105.0, 60.0)]);
        let as_found = divisions(&mesh, settings, &Task::new()).unwrap().swap_remove(0);
        let mut own = profile.clone();
        own.layers.bodies = Body::of_division("tree", &as_found);
        let plan = planned(&mesh, &own).unwrap();
        assert_eq!(plan.summary.blocked, [Blocked { body: 2, by: 1 }], "{turned}: {:?}", plan.summary.forbidden);
        let part = imported(mesh.clone());
        let found = tried("tree", &part, &profile, false, settings, &Task::new()).unwrap().divisions.swap_remove(0);
        let Outcome::Planned(metrics) = &found.outcome else { panic!("{turned}: {:?}", found.outcome) };
        assert!(metrics.coverage() > 0.97, "{turned}: {}", metrics.coverage());
        let [trunk, long, short] = &as_found.pieces[..] else { panic!("{turned}: {:?}", as_found.pieces) };
        assert_eq!(found.division.pieces, [trunk.clone(), short.clone(), long.clone()], "{turned}");
    }
}

/// What goes on in the layers of the trunk ends there: on the other side, a branch below keeps all its metal.
#[test]
fn a_branch_takes_no_metal_from_behind_its_carrier() {
    let profile = profile("cmt-al2319-kuka");
    let settings = Settings::usual(profile.bead.width);
    for turned in [0.0_f64, 64.0] {
        let mesh = tree(150.0, &[(40.0, turned, 90.0, 90.0), (90.0, turned + 180.0, 40.0, 100.0)]);
        let division = divisions(&mesh, settings, &Task::new()).unwrap().swap_remove(0);
        let [trunk, branch] = &Body::of_division("tree", &division)[..] else { panic!("{:?}", division.pieces) };
        let away = DMat3::from_rotation_z(turned.to_radians()) * DVec3::NEG_X;
        let farthest = |body: &Body| {
            let Mesh { vertices, triangles, .. } = body.of_mesh(&mesh);
            triangles.iter().flatten().map(|corner| vertices[*corner as usize].dot(away)).fold(f64::MIN, f64::max)
        };
        assert!(farthest(trunk) < 18.1, "{turned}: {}", farthest(trunk));
        assert!((farthest(branch) - 100.0).abs() < 0.1, "{turned}: {}", farthest(branch));
    }
}

/// The page shows all metal of the part, each body in a colour of its own.
#[test]
fn the_page_of_divisions_shows_all_bodies() {
    let mesh = tree(150.0, &[(90.0, 0.0, 50.0, 90.0), (60.0, 150.0, 80.0, 90.0)]);
    let profile = profile("cmt-al2319-kuka");
    let settings = Settings::usual(profile.bead.width);
    let part = imported(mesh.clone());
    let found = untried("tree <1>", &part, settings, &Task::new()).unwrap();
    let html = page::page("tree <1>", &mesh, &found).html();
    assert!(html.contains("tree &lt;1&gt;") && html.contains("not planned for trial"));
    let cards: Vec<&str> = html.split("class=\"card coloured\"><script type=\"application/json\">").skip(1).collect();
    assert_eq!(cards.len(), found.offered().count());
    let card: serde_json::Value = serde_json::from_str(cards[0].split_once("</script>").unwrap().0).unwrap();
    let names: Vec<&str> = card["key"].as_array().unwrap().iter().map(|entry| entry[0].as_str().unwrap()).collect();
    let layers =
        ["level layers", "layers around a cylinder of 18.0 mm radius", "layers around a cylinder of 18.0 mm radius"];
    assert!(names.len() == 3 && names.iter().zip(layers).all(|(name, layers)| name.ends_with(layers)), "{names:?}");
    let mut bytes = Vec::new();
    let deflated = STANDARD.decode(card["surface"].as_str().unwrap()).unwrap();
    flate2::read::DeflateDecoder::new(&deflated[..]).read_to_end(&mut bytes).unwrap();
    let number = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
    let (nodes, corners) = (number(0), number(4));
    let float = |k: usize| f64::from(f32::from_bits(number(8 + 4 * k) as u32));
    let node = |k: usize| DVec3::new(float(3 * k), float(3 * k + 1), float(3 * k + 2));
    let corner = |k: usize| number(8 + 12 * nodes + 4 * k);
    let colour = |k: usize| &bytes[8 + 12 * nodes + 4 * corners + 3 * k..][..3];
    assert_eq!(bytes.len(), 8 + 12 * nodes + 4 * corners + 3 * nodes);
    let mut volumes = BTreeMap::<[u8; 3], f64>::new();
    for k in (0..corners).step_by(3) {
        let [a, b, c] = [corner(k), corner(k + 1), corner(k + 2)];
        assert!(colour(a) == colour(b) && colour(b) == colour(c), "a triangle has one colour");
        *volumes.entry(colour(a).try_into().unwrap()).or_default() += node(a).dot(node(b).cross(node(c))) / 6.0;
    }
    assert_eq!(volumes.len(), 3, "{volumes:?}");
    let (shown, whole) = (volumes.values().sum::<f64>(), mesh.volume());
    assert!((shown / whole - 1.0).abs() < 0.01, "{shown} of {whole} mm³");
    let trunk = volumes[&beadwright::palette::body(0)];
    assert!((trunk / (18.0_f64.powi(2) * 150.0 * PI) - 1.0).abs() < 0.01, "the trunk has {trunk} mm³");
    // Blades stand on a hub that is not welded.
    let hub = example::find("hub").unwrap().mesh();
    let found = untried("hub", &imported(hub.clone()), settings, &Task::new()).unwrap();
    assert!(page::page("hub", &hub, &found).html().contains("already there"));
    let blades = &found.divisions[0].bodies;
    let stock: f64 = metal(&hub, blades).iter().filter(|metal| metal.stock).map(|metal| metal.mesh.volume()).sum();
    assert!(stock > 0.1 * hub.volume(), "{stock} mm³ are there already");
}

/// What could be welded with more tilt is on the page, in the words of the command.
#[test]
fn the_page_says_what_more_tilt_would_allow() {
    let mesh = tree(150.0, &[(90.0, 0.0, 50.0, 90.0)]);
    let profile = profile("cmt-al2319-kuka");
    let settings = Settings::usual(profile.bead.width);
    let mut found = untried("tree", &imported(mesh.clone()), settings, &Task::new()).unwrap();
    let plain = page::page("tree", &mesh, &found).html();
    found.tilted = found.divisions.first().cloned();
    let sentence = found.about_tilted().unwrap();
    assert!(sentence.contains("--tilt") && !plain.contains(&sentence), "{sentence}");
    let html = page::page("tree", &mesh, &found).html();
    assert!(html.contains(&sentence));
    let pictures = |html: &str| html.matches("class=\"card coloured\"").count();
    assert_eq!(pictures(&html), pictures(&plain) + 1);
    // What was tried in vain is named with the reason, there and in the studio.
    for (orders, tried) in [(0, ""), (1, " The other order was tried, too."), (4, " 4 other orders were tried, too.")] {
        let division = &mut found.divisions[0];
        division.outcome = Outcome::Refused { reason: "No room.".to_owned(), hangs: false, orders };
        assert_eq!(division.refusal(), Some(format!("No room.{tried}")));
        assert_eq!(division.verdict(), Some(format!("It cannot be welded: No room.{tried}")));
    }
}
