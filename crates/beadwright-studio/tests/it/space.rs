//! Layers that are not level, in the 3-D view: beads, torch, clock and clicks are where the layers lie in space.

use crate::section::from_middle;
use beadwright::plan::{Plan, plan};
use beadwright::profile::{Body, Profile};
use beadwright::task::Task;
use beadwright::weld::Torch;
use beadwright::{example, glam::DVec2, glam::DVec3};
use beadwright_studio::view3d::{Camera, LayerBeads, Pick, Scene, Style, View3d, headless, pick};
use std::path::PathBuf;
use std::sync::Arc;

const SIZE: DVec2 = DVec2::new(900.0, 700.0);

/// A profile with the chart or the bodies of an example.
fn profile(name: &str) -> Profile {
    let (example, mut profile) = (example::find(name).unwrap(), Profile::built_in("cmt-al2319-kuka").unwrap());
    if let Some(chart) = example.chart {
        profile.layers.chart = chart.parse().unwrap();
    }
    profile.layers.bodies = example.bodies().map(|text| Body::read(&text).unwrap()).unwrap_or_default();
    profile
}

/// The scene of a plan.
fn scene(plan: &Plan, profile: &Profile) -> Scene {
    let mut torch = Torch::of(&profile.weld_settings());
    let mut scene = Scene::default();
    plan.layers.iter().for_each(|l| scene.set_layer(l.index, Arc::new(LayerBeads::of(l, &mut torch))));
    scene
}

/// An example as it is meant to be welded, and its scene.
pub(crate) fn planned(name: &str) -> (Plan, Profile, Scene) {
    let (mesh, profile) = (example::find(name).unwrap().mesh(), profile(name));
    let plan = plan(name, &mesh, &profile, &Task::default()).unwrap();
    let mut scene = scene(&plan, &profile);
    scene.set_mesh(Some(Arc::new(mesh)));
    (plan, profile, scene)
}

#[test]
fn beads_lie_around_the_shaft_and_stand_out_from_it() {
    let (plan, profile, scene) = planned("shaft");
    let (low, high) = scene.mesh().unwrap().bounds();
    let bead = DVec3::splat(profile.bead.width);
    let beads = || scene.layers().iter().flatten().flat_map(|layer| layer.beads());
    for bead_of in beads() {
        for at in [bead_of.from(), bead_of.to()].map(|at| at.as_dvec3()) {
            assert!((low - bead).cmple(at).all() && (high + bead).cmpge(at).all(), "{at} lies beside the part");
            let (off_axis, up) = (at.with_z(0.0), bead_of.up().as_dvec3());
            assert!((25.0..61.001).contains(&off_axis.length()), "{at}");
            // Normals are those of the middles of segments, along which the layer turns by no more than 0.1.
            assert!(up.dot(off_axis.normalize()) > 0.05_f64.cos() - 1e-4, "the bead at {at} points along {up}");
        }
    }
    let (low, high) = scene.bounds().unwrap();
    assert!(high.z - low.z < 200.0 && (high - low).truncate().max_element() < 2.0 * 61.0 + 1.0, "{low} to {high}");
    // Segments are parts of the plan's pieces, and follow each other.
    for (layer, beads) in plan.layers.iter().zip(scene.layers().iter().flatten()) {
        let pieces: usize = layer.passes.iter().map(|pass| pass.segments().count()).sum();
        assert_eq!(beads.pieces_of(beads.len()), pieces);
        assert!((0..pieces).all(|piece| beads.segments_of(piece).all(|segment| beads.piece(segment) == piece)));
        let met = |w: &[beadwright_studio::view3d::Bead]| w[0].to() == w[1].from();
        for pass in beads.passes() {
            assert!(beads.beads()[pass.segments.clone()].windows(2).all(met));
        }
        for segment in 1..beads.len() {
            assert!(beads.times(segment).unwrap().0 >= beads.times(segment - 1).unwrap().1 - 1e-3);
        }
    }
}

#[test]
fn beads_of_level_layers_are_the_pieces_of_the_plan() {
    let (plan, _, scene) = planned("star");
    for (layer, beads) in plan.layers.iter().zip(scene.layers().iter().flatten()) {
        let pieces: Vec<_> = layer.passes.iter().flat_map(|pass| pass.segments()).collect();
        assert_eq!(pieces.len(), beads.len());
        for (i, (piece, bead)) in pieces.iter().zip(beads.beads()).enumerate() {
            assert_eq!((bead.from(), bead.to()), (piece.from.as_vec3(), piece.to.as_vec3()));
            assert_eq!((bead.up(), bead.height()), (DVec3::Z.as_vec3(), layer.height as f32));
            assert_eq!((beads.piece(i), beads.segments_of(i)), (i, i..i + 1));
        }
        let above = layer.passes.iter().flat_map(|pass| &pass.points).map(|p| p.z);
        let top = above.fold(f64::NEG_INFINITY, f64::max);
        assert!((beads.bounds().unwrap().1.z - top as f32).abs() < 1e-4);
    }
}

#[test]
fn beads_of_a_bend_are_as_thick_as_it_makes_them() {
    let (plan, profile, scene) = planned("elbow");
    let (mut least, mut most) = (1.0_f32, 1.0_f32);
    for (layer, beads) in plan.layers.iter().zip(scene.layers().iter().flatten()) {
        let normal = profile.layers.sheet(layer).unwrap().at(DVec3::ZERO).normal;
        assert!(beads.beads().iter().all(|bead| bead.up().as_dvec3().distance(normal) < 1e-4));
        let heights = || beads.beads().iter().map(|bead| bead.height() / layer.height as f32);
        (least, most) = (heights().fold(least, f32::min), heights().fold(most, f32::max));
    }
    assert!(least < 0.85 && most > 1.15, "{least} to {most} of the height");
}

#[test]
fn beads_of_a_dome_stand_out_of_it() {
    let (plan, profile, scene) = planned("dome");
    let steepest = plan.layers.iter().zip(scene.layers().iter().flatten()).map(|(layer, beads)| {
        let sheet = profile.layers.sheet(layer).unwrap();
        let leans = beads.beads().iter().map(|bead| {
            let up = sheet.at(sheet.coordinates(bead.torch(0.5).at, DVec2::ZERO)).normal;
            assert!(bead.up().as_dvec3().distance(up) < 0.01);
            // Layers over a surface are as thick as planned along its z.
            assert!((bead.height() / layer.height as f32 - bead.up().z).abs() < 0.01);
            bead.up().z
        });
        leans.fold(1.0, f32::min)
    });
    let steepest = steepest.fold(1.0, f32::min);
    assert!((0.9..0.99).contains(&steepest), "{steepest}");
}

#[test]
fn the_clock_agrees_with_the_metrics_in_space() {
    for name in ["shaft", "y-tube"] {
        let (plan, profile, scene) = planned(name);
        let mut torch = Torch::of(&profile.weld_settings());
        plan.layers.iter().for_each(|layer| drop(LayerBeads::of(layer, &mut torch)));
        let expected = plan.summary.metrics.total_time_s - torch.retract().moving;
        let seconds = scene.total_seconds();
        assert!((seconds / expected - 1.0).abs() < 1e-9, "{name}: {seconds} s, not {expected} s");
    }
}

#[test]
fn the_torch_goes_on_without_leaps_from_body_to_body() {
    for name in ["shaft", "y-tube"] {
        let (_, profile, scene) = planned(name);
        let (seconds, steps) = (scene.total_seconds(), 40_000);
        let at = |i: usize| scene.at_time(seconds * i as f64 / steps as f64).unwrap();
        let positions: Vec<_> = (0..=steps).map(at).collect();
        // Above a layer around an axis, the way is longer in space.
        let fastest = 1.5 * profile.travel.speed.max(2.0 * profile.process.deposition_speed);
        for pair in positions.windows(2) {
            let leap = pair[0].torch.at.distance(pair[1].torch.at);
            assert!(leap <= fastest * seconds / steps as f64 + 0.01, "{name}: {leap} mm at {:?}", pair[0]);
            assert!((pair[1].torch.up.length() - 1.0).abs() < 1e-4);
        }
    }
}

/// Points on the tops of beads that nothing hides from a camera, with their layer and segment; those of the last layers first.
pub(crate) fn seen<'a>(scene: &'a Scene, camera: &'a Camera) -> impl Iterator<Item = (usize, usize, DVec3)> + 'a {
    let layers = scene.layers().iter().enumerate().rev().filter_map(|(i, layer)| Some((i, layer.as_ref()?)));
    let tops = layers.flat_map(|(i, layer)| layer.beads().iter().enumerate().map(move |(k, bead)| (i, k, bead)));
    tops.step_by(2).filter(|(.., bead)| bead.up().as_dvec3().dot(camera.back()) > 0.99).filter_map(|(i, k, bead)| {
        let top = bead.torch(0.5).at;
        let way = camera.back();
        // Nothing lies on the way to the viewer.
        let hides = |other: &beadwright_studio::view3d::Bead| {
            let middle = other.torch(0.5).at - top;
            let near = middle.reject_from(way).length() < 30.0 && middle.dot(way) > -2.0;
            near && (1..200).any(|step| from_middle(other, top + way * (0.4 * f64::from(step))) < 1.02)
        };
        let free = !scene.layers().iter().flatten().flat_map(|layer| layer.beads()).any(hides);
        free.then_some((i, k, top))
    })
}

#[test]
fn a_click_finds_the_bead_that_is_seen_in_space() {
    for name in ["shaft", "y-tube"] {
        let (_, _, scene) = planned(name);
        let style = Style::default();
        let (mut tried, mut direct) = (0, 0);
        let last = scene.layers().iter().flatten().rfind(|layer| !layer.is_empty()).unwrap().beads();
        for up in [0, last.len() / 3, 2 * last.len() / 3].map(|i| last[i].up().as_dvec3()) {
            // Looks straight at the layer.
            let (yaw, pitch) = (up.y.atan2(up.x), up.z.asin());
            let mut camera = Camera { orthographic: true, yaw, pitch, ..Camera::default() };
            camera.fit(scene.bounds().unwrap(), SIZE);
            for (layer, segment, top) in seen(&scene, &camera).take(30) {
                let found = pick(&scene, &style, &camera, SIZE, camera.project(top, SIZE).unwrap());
                let Pick { layer: of, segment: hit, .. } = found.unwrap();
                let bead = &scene.layer(of).unwrap().beads()[hit];
                // It is there, or a little before it.
                let off = (0..60).map(|step| from_middle(bead, top + camera.back() * (0.1 * f64::from(step))));
                let off = off.fold(f64::INFINITY, f64::min);
                assert!(off < 1.02, "{name}: {of}, {hit} is {off} beside {layer}, {segment} at {top}");
                (tried, direct) = (tried + 1, direct + usize::from(from_middle(bead, top) < 1.02));
            }
        }
        assert!(tried > 40 && 10 * direct > 9 * tried, "{name}: {direct} of {tried} beads are seen");
    }
}

/// Pictures to look at: `cargo test -p beadwright-studio --test it -- space::pictures --ignored`.
#[test]
#[ignore = "for looking"]
fn pictures() {
    let Ok(state) = headless() else { return };
    for name in ["shaft", "hub", "elbow", "y-tube", "dome"] {
        let (_, _, scene) = planned(name);
        let end = scene.at_time(scene.total_seconds() * 0.8).unwrap();
        let plain = Style { mesh: false, ..Style::default() };
        let playing = Style {
            travels: true,
            starts: true,
            marks_from: end.layer,
            layers: 0..=end.layer,
            segments_of_last: Some(end.segment),
            torch: Some(end.torch),
            ..Style::default()
        };
        let middle = scene.bounds().map(|(low, high)| (low + high) / 2.0).unwrap();
        let section = beadwright_studio::view3d::Section { axis: 1, at: middle.y, lower: true };
        let cut = Style { section: Some(section), ..plain.clone() };
        for (what, style, zoom) in
            [("all", plain.clone(), 1.0), ("near", plain, 5.0), ("playing", playing, 1.0), ("cut", cut, 1.0)]
        {
            let mut view = View3d::default();
            view.camera.fit_points(&scene.outline(), SIZE);
            view.camera.zoom(zoom, view.camera.target + view.camera.back() * 30.0);
            let (width, height, pixels) = view.picture(&state, &scene, &style, [900, 700]).unwrap();
            let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("space-{name}-{what}.png"));
            image::RgbaImage::from_raw(width, height, pixels).unwrap().save(&path).unwrap();
            println!("{}", path.display());
        }
    }
}
