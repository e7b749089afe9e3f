//! What torch and hand hit while a part grows: the part itself, clamps, and nothing where there is room.

use crate::common;
use crate::robot::{hits, pass};

use beadwright::layer::Layer;
use beadwright::profile::Profile;
use beadwright::program::{Positioner, PositionerAxis, Turning};
use beadwright::robot::cell::BUILT_IN;
use beadwright::robot::{self, Cell, Fixture, Solid};
use common::profile;
use glam::{DVec2, DVec3};

/// A post is finished; what is welded at its foot afterwards brings the torch into it.
#[test]
fn the_part_as_far_as_it_is_welded_is_hit() {
    let full = Cell { home: None, ..Cell::built_in("kuka-kr20-r1810").unwrap() };
    let welded = |beside: f64, post_first: bool| {
        let line = |x: f64, z: f64| pass(vec![DVec3::new(x, -20.0, z), DVec3::new(x, 20.0, z)]);
        let (post, foot) = (line(0.0, 150.0), line(beside, 2.0));
        let passes = if post_first { vec![post, foot] } else { vec![foot, post] };
        let layer = Layer { index: 0, z: 150.0, height: 2.0, passes, ..Layer::default() };
        let track = profile("cmt-al2319-kuka").track(&[layer]);
        hits(&robot::reach(&full, full.part, &track))
    };
    let found = welded(20.0, true);
    assert!(found.iter().any(|(solids, _)| *solids == [Solid::Torch, Solid::Part]), "{found:?}");
    assert_eq!(welded(20.0, false), [], "the post is welded last");
    assert_eq!(welded(400.0, true), [], "the post is far away");
}

/// A layer with straight passes between these ends, mm.
fn straight(lines: &[[DVec3; 2]]) -> Layer {
    let passes = lines.iter().map(|ends| pass(ends.to_vec())).collect();
    Layer { height: 2.0, passes, ..Layer::default() }
}

/// What torch and hand hit of the part and of what holds it.
fn crashes(layers: &[Layer], cell: &Cell, profile: &Profile) -> Vec<[Solid; 2]> {
    let track = profile.track(layers);
    let found = hits(&robot::reach(cell, cell.part, &track)).into_iter().map(|(solids, _)| solids);
    found.filter(|[_, what]| [Solid::Part, Solid::Fixture].contains(what)).collect()
}

/// A wall that stands, of straight passes in layers of 2 mm.
fn wall(from: DVec3, to: DVec3, height: f64) -> Vec<Layer> {
    let layers = (height / 2.0) as usize;
    (1..=layers).map(|k| straight(&[[from, to].map(|at| at.with_z(2.0 * k as f64))])).collect()
}

/// Twenty parts whose torch crashes, and the same ones that leave room for it: a bead too near to a wall, a way through a wall that is
/// higher than the clearance, layers in the wrong order, a clamp.
#[test]
fn crashes_are_found_and_clean_builds_have_none() {
    let profile = profile("cmt-al2319-kuka");
    let crashes = |layers: &[Layer], cell: &Cell| crashes(layers, cell, &profile);
    let cells =
        ["kuka-kr20-r1810", "fanuc-arc-mate-100id", "yaskawa-ar2010", "abb-irb2600-12-165", "kuka-kr8-r1440-arc"];
    for (seed, name) in (0..).zip(cells) {
        let cell = Cell { home: None, ..Cell::built_in(name).unwrap() };
        let torch = cell.body.as_ref().unwrap().torch;
        let angle = 0.4 + 1.1 * f64::from(seed);
        let (way, aside) = (DVec2::from_angle(angle).extend(0.0), DVec2::from_angle(angle).perp().extend(0.0));
        let high = 60.0 + 10.0 * f64::from(seed);
        let stands = || wall(way * -40.0, way * 40.0, high);
        let (touching, clear) = (torch - 6.0, torch + 8.0);
        let beside = |by: f64| [stands(), wall(way * -40.0 + aside * by, way * 40.0 + aside * by, 6.0)].concat();
        let low = |by: f64| {
            // Across the wall, or past its end; the clearance is 20 mm.
            let [one, other] = [-70.0, 70.0].map(|across| way * by + aside * across + DVec3::Z * 2.0);
            [stands(), vec![straight(&[[one, one - aside * 20.0], [other, other + aside * 20.0]])]].concat()
        };
        let mut upside_down = stands();
        upside_down.reverse();
        let clamped = |by: f64| {
            let mut cell = cell.clone();
            let middle = way * 40.0 + aside * (by + 10.0);
            let (low, high) = (middle - DVec3::splat(10.0), (middle + DVec3::splat(10.0)).with_z(high));
            let fixtures = &mut cell.body.as_mut().unwrap().fixtures;
            // The box lies along x and y: its nearest place to the wall's end is a corner or a face.
            fixtures.push(Fixture { low: low.to_array(), high: high.to_array() });
            cell
        };
        for (what, found) in [
            ("a bead beside a wall", crashes(&beside(touching), &cell)),
            ("a way through a wall", crashes(&low(0.0), &cell)),
            ("layers in the wrong order", crashes(&upside_down, &cell)),
            ("a clamp", crashes(&stands(), &clamped(0.0))),
        ] {
            assert!(found.iter().any(|[by, _]| *by == Solid::Torch), "{what}, {name}: {found:?}");
        }
        for (what, found) in [
            ("a bead beside a wall", crashes(&beside(clear), &cell)),
            ("a way past a wall", crashes(&low(40.0 + clear), &cell)),
            ("layers in their order", crashes(&stands(), &cell)),
            ("a clamp", crashes(&stands(), &clamped(clear + 10.0))),
        ] {
            assert_eq!(found, Vec::<[Solid; 2]>::new(), "{what}, {name}");
        }
    }
    let (_, text) = BUILT_IN.iter().find(|(name, _)| *name == "kuka-kr20-r1810").unwrap();
    let refused = Cell::parse(&format!("{text}\nfixtures = [{{ low = [0, 0, 0], high = [1, -1, 1] }}]\n"));
    assert!(refused.unwrap_err().to_string().contains("body.fixtures"));
}

/// A part whose layers lean is held level by a positioner: its torch hits what it would hit of a level one.
#[test]
fn a_part_that_is_turned_level_is_hit_like_a_level_one() {
    let cell = Cell { home: None, ..Cell::built_in("kuka-kr20-r1810").unwrap() };
    let torch = cell.body.as_ref().unwrap().torch;
    for (lean, along) in [(30.0_f64, DVec3::X), (-50.0, DVec3::X), (40.0, DVec3::Y)] {
        let up = DVec3::Z.rotate_axis(along, lean.to_radians());
        let mut profile = profile("cmt-al2319-kuka");
        profile.layers.chart = format!("plane:up={}/{}/{}", up.x, up.y, up.z).parse().unwrap();
        let axis = |direction: DVec3, limits| PositionerAxis {
            direction: direction.to_array(),
            through: [0.0; 3],
            limits,
            speed: 90.0,
        };
        let axes = vec![axis(along, [-90.0, 90.0]), axis(DVec3::Z, [-360.0, 360.0])];
        profile.program.positioner = Some(Positioner { turning: Turning::Follow, axes, up: [0.0, 0.0, 1.0] });
        for seed in 0..4 {
            let way = DVec2::from_angle(0.3 + 0.8 * f64::from(seed)).extend(0.0);
            let aside = way.truncate().perp().extend(0.0);
            let stands = || wall(way * -40.0, way * 40.0, 80.0);
            let beside = |by: f64| [stands(), wall(way * -40.0 + aside * by, way * 40.0 + aside * by, 6.0)].concat();
            let mut upside_down = stands();
            upside_down.reverse();
            let place = format!("leaning by {lean}° about {along}, {seed}");
            for layers in [beside(torch - 6.0), upside_down] {
                let found = crashes(&layers, &cell, &profile);
                assert!(found.iter().any(|[by, _]| *by == Solid::Torch), "{place}: {found:?}");
            }
            for layers in [beside(torch + 8.0), stands()] {
                assert_eq!(crashes(&layers, &cell, &profile), Vec::<[Solid; 2]>::new(), "{place}");
            }
        }
    }
}
