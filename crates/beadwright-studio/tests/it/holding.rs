//! The part as a positioner holds it in the 3-D view: it turns, and up stays up.

use crate::section::from_middle;
use crate::space::{planned, seen};
use beadwright::model::Mesh;
use beadwright::profile::Profile;
use beadwright::program::{Positioner, PositionerAxis, Turning};
use beadwright::robot::body::Solid;
use beadwright::robot::{self, Cell, Frame, Reach};
use beadwright_studio::arm::stand;
use beadwright_studio::holding::held;
use beadwright_studio::holding::{Come, Place};
use beadwright_studio::level::leans;
use beadwright_studio::view3d::{
    Camera, Colour, Scene, Shape, StandardView, Style, View3d, face, headless, palette, pick,
};
use glam::{DQuat, DVec2, DVec3};
use std::path::PathBuf;
use std::sync::Arc;

const SIZE: DVec2 = DVec2::new(900.0, 700.0);

/// A table that tilts about a line below the part and turns about its own axis.
fn tilting(turning: Turning) -> Positioner {
    let axis = |direction, through, limits, speed| PositionerAxis { direction, through, limits, speed };
    let tilts = axis([1.0, 0.0, 0.0], [0.0, 0.0, -150.0], [-95.0, 95.0], 60.0);
    let turns = axis([0.0, 0.0, 1.0], [0.0; 3], [-7200.0, 7200.0], 120.0);
    Positioner { turning, axes: vec![tilts, turns], up: [0.0, 0.0, 1.0] }
}

/// An example on such a table, and what an arm reaches of it.
struct Held {
    scene: Scene,
    profile: Profile,
    layers: Vec<Arc<beadwright::Layer>>,
    cell: Cell,
    reach: Reach,
}

fn on_table(name: &str, positioner: Option<Positioner>) -> Held {
    let (plan, mut profile, scene) = planned(name);
    profile.program.positioner = positioner;
    let cell = Cell::built_in("kuka-kr20-r1810").unwrap();
    let reach = robot::reach(&cell, cell.part, &profile.track(&plan.layers));
    let layers = plan.layers.into_iter().map(Arc::new).collect();
    Held { scene, profile, layers, cell, reach }
}

impl Held {
    /// The places in the middle of every `step`-th segment.
    fn places(&self, step: usize) -> Vec<Place> {
        let layers = self.scene.layers().iter().enumerate().filter_map(|(i, layer)| Some((i, layer.as_ref()?)));
        let places = layers.flat_map(|(layer, beads)| {
            beads.beads().iter().enumerate().map(move |(segment, bead)| {
                let (pass, torch) = (beads.pass_of(segment), bead.torch(0.5));
                Place { layer, pass, come: Come::Along(beads.laid(pass, segment, torch.at)), torch }
            })
        });
        places.step_by(step).collect()
    }

    /// Where the torch is after that many seconds.
    fn at(&self, seconds: f64) -> Place {
        let now = self.scene.at_time(seconds).unwrap();
        let laid = || self.scene.layer(now.layer).unwrap().laid(now.pass, now.segment, now.torch.at);
        let come = now.come.map_or_else(|| Come::Along(laid()), Come::Towards);
        Place { layer: now.layer, pass: now.pass, come, torch: now.torch }
    }

    fn frame(&self, place: &Place) -> Frame {
        Frame::from(held(&self.reach.poses, place).unwrap())
    }
}

/// Level lines of sight from the front or the right.
fn from(view: StandardView, held: Frame) -> Camera {
    let mut camera = Camera { orthographic: true, held, ..Camera::default() };
    camera.set_view(view);
    camera
}

#[test]
fn the_layer_under_the_torch_is_level_in_the_picture() {
    for name in ["hub", "elbow"] {
        let part = on_table(name, Some(tilting(Turning::Follow)));
        for place in part.places(7) {
            for view in [StandardView::Front, StandardView::Right] {
                let camera = from(view, part.frame(&place));
                let [foot, tip] =
                    [0.0, 50.0].map(|high| camera.project(place.torch.at + place.torch.up * high, SIZE).unwrap());
                let lean = (tip - foot).angle_to(DVec2::NEG_Y).to_degrees().abs();
                assert!(lean < 0.1, "{name}: at {place:?} the layer leans by {lean}° in the picture");
            }
        }
    }
}

#[test]
fn the_part_turns_smoothly_as_the_torch_plays() {
    for (name, turning) in [("hub", Turning::Follow), ("elbow", Turning::Follow), ("elbow", Turning::Index)] {
        let part = on_table(name, Some(tilting(turning)));
        let (seconds, steps) = (part.scene.total_seconds(), 60_000);
        let frames = (0..=steps).map(|i| part.at(seconds * f64::from(i) / f64::from(steps)));
        let frames: Vec<(Place, Frame)> = frames.map(|place| (place, part.frame(&place))).collect();
        let mut turned = 0.0;
        for pair in frames.windows(2) {
            let ((from, a), (to, b)) = (&pair[0], &pair[1]);
            let (way, leap) = (from.torch.at.distance(to.torch.at), a.rotation.angle_between(b.rotation).to_degrees());
            turned += leap;
            assert!(
                leap < 1.0 + 4.0 * way,
                "{name} {turning:?}: it leaps by {leap}° over {way} mm from {from:?} to {to:?}"
            );
        }
        assert!(turned > 80.0, "{name} {turning:?}: it turns by {turned}°");
    }
}

#[test]
fn the_arm_stands_still_in_the_picture_and_reaches_the_bead() {
    for name in ["hub", "elbow"] {
        let part = on_table(name, Some(tilting(Turning::Follow)));
        let (mut stood, mut feet) = (0, Vec::new());
        for place in part.places(101) {
            let Some(arm) = stand(&part.cell, &part.reach, &place) else { continue };
            stood += 1;
            let held = part.frame(&place);
            let end = arm.links.iter().rfind(|link| link.solid == Solid::Torch).unwrap().ends[1];
            let off = held.rotation * (end - place.torch.at);
            // The torch hangs straight down over the bead.
            assert!(off.truncate().length() < 0.05 && off.z > 5.0, "{name}: the nozzle is {off} from the bead");
            let base = arm.links.iter().find(|link| link.solid == Solid::Base).unwrap().ends[0];
            feet.push(from(StandardView::Iso, held).project(base, SIZE).unwrap());
        }
        assert!(stood > 20, "{name}: the arm is shown at {stood} beads only");
        assert!(feet.iter().all(|foot| foot.distance(feet[0]) < 0.01), "{name}: the arm walks");
    }
}

#[test]
fn a_click_finds_the_bead_that_is_seen_on_the_turned_part() {
    let part = on_table("hub", Some(tilting(Turning::Follow)));
    let (mut tried, mut turned) = (0, false);
    let places = part.places(1);
    for place in [5, 4, 3].map(|sixths| places[(places.len() * sixths / 6).min(places.len() - 1)]) {
        let held = part.frame(&place);
        turned |= held.rotation.angle_between(DQuat::IDENTITY) > 1.0;
        // From above one looks straight at the layer under the torch.
        let mut camera = from(StandardView::Top, held);
        camera.fit_points(&part.scene.outline(), SIZE);
        for (layer, segment, top) in seen(&part.scene, &camera).take(12) {
            let at = camera.project(top, SIZE).unwrap();
            assert!(at.cmpge(DVec2::ZERO).all() && at.cmple(SIZE).all(), "{at} is outside the picture");
            let found = pick(&part.scene, &Style::default(), &camera, SIZE, at).unwrap();
            let bead = &part.scene.layer(found.layer).unwrap().beads()[found.segment];
            let off = (0..60).map(|step| from_middle(bead, top + camera.back() * (0.1 * f64::from(step))));
            let off = off.fold(f64::INFINITY, f64::min);
            assert!(off < 1.02, "{found:?} is {off} beside {layer}, {segment} at {top}");
            tried += 1;
        }
    }
    assert!(tried > 20 && turned, "{tried}");
}

#[test]
fn nothing_is_turned_without_a_positioner() {
    let part = on_table("elbow", None);
    assert!(part.places(50).iter().all(|place| held(&part.reach.poses, place).is_none()));
    // Not a digit changes.
    let camera = from(StandardView::Iso, Frame::IDENTITY);
    assert_eq!(camera.sky(), DVec3::Z);
    assert_eq!(camera.eye(), camera.target + camera.back() * camera.distance);
    let (sin, cos) = camera.pitch.sin_cos();
    assert_eq!(camera.back(), DVec3::new(cos * camera.yaw.cos(), cos * camera.yaw.sin(), sin));
}

/// The camera on a held part sees what it would see of a part that lies so.
#[test]
fn a_held_part_looks_like_one_that_lies_so() {
    let (held, mut camera) = (
        Frame {
            position: DVec3::new(30.0, -20.0, 55.0),
            rotation: DQuat::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 1.3),
        },
        Camera::default(),
    );
    let mesh = beadwright::example::find("cross").unwrap().mesh();
    let lying = Mesh { vertices: mesh.vertices.iter().map(|vertex| held.apply(*vertex)).collect(), ..mesh.clone() };
    camera.fit_points(&lying.vertices, SIZE);
    let mut other = Camera { held, ..Camera::default() };
    other.fit_points(&mesh.vertices, SIZE);
    assert!((other.target - camera.target).length() < 1e-6 && (other.distance - camera.distance).abs() < 1e-6);
    camera.pan(DVec2::new(20.0, 30.0), SIZE);
    other.pan(DVec2::new(20.0, 30.0), SIZE);
    camera.zoom(1.3, camera.unproject(DVec2::new(300.0, 200.0), SIZE));
    other.zoom(1.3, other.unproject(DVec2::new(300.0, 200.0), SIZE));
    for vertex in &mesh.vertices {
        let [a, b] = [camera.project(held.apply(*vertex), SIZE), other.project(*vertex, SIZE)].map(Option::unwrap);
        assert!(a.distance(b) < 1e-6, "{a} {b}");
    }
    let Ok(state) = headless() else {
        println!("pictures are skipped: there is nothing to draw with");
        return;
    };
    let picture = |camera: Camera, mesh: &Mesh| {
        let (mut view, mut scene) = (View3d::default(), Scene::default());
        scene.set_mesh(Some(Arc::new(mesh.clone())));
        view.camera = camera;
        view.picture(&state, &scene, &Style::default(), [900, 700]).unwrap().2
    };
    let (a, b) = (picture(camera, &lying), picture(other, &mesh));
    let (mut met, mut unlike) = (0, 0);
    for (x, y) in (0..900).step_by(10).flat_map(|x| (0..700).step_by(10).map(move |y| (x, y))) {
        // The grid on the ground turns with the part; it is seen only beside it.
        let all = [(-3.0, 0.0), (3.0, 0.0), (0.0, -3.0), (0.0, 3.0)];
        let on = |(dx, dy)| face(&mesh, other.ray(DVec2::new(f64::from(x) + 0.5 + dx, f64::from(y) + 0.5 + dy), SIZE));
        if all.into_iter().any(|off| on(off).is_none()) {
            continue;
        }
        let first = 4 * (y as usize * 900 + x as usize);
        let error = (first..first + 3).map(|i| a[i].abs_diff(b[i])).max().unwrap();
        (met, unlike) = (met + 1, unlike + usize::from(error > 6));
    }
    assert!(met > 500 && unlike * 50 < met, "{unlike} of {met} pixels differ");
}

#[test]
fn leans_are_those_of_the_layers_and_none_where_the_part_is_turned() {
    for name in ["hub", "elbow"] {
        let mut part = on_table(name, None);
        let of = |part: &Held| leans(&part.layers, part.scene.layers(), &part.profile);
        let lying = of(&part);
        for (beads, leans) in part.scene.layers().iter().flatten().zip(&lying) {
            assert_eq!(beads.len(), leans.len());
            for (bead, lean) in beads.beads().iter().zip(leans.iter()) {
                let wanted = bead.up().z.clamp(-1.0, 1.0).acos().to_degrees();
                assert!((lean - wanted).abs() < 0.05, "{name}: {lean} instead of {wanted}");
            }
        }
        let most = lying.iter().flat_map(|layer| layer.iter().copied()).fold(0.0, f32::max);
        assert!((89.0..91.0).contains(&most), "{name}: {most}");
        part.profile.program.positioner = Some(tilting(Turning::Follow));
        let turned = of(&part);
        assert!(turned.iter().zip(&lying).all(|(a, b)| a.len() == b.len()));
        assert!(turned.iter().flat_map(|layer| layer.iter()).all(|lean| *lean < 0.1), "{name}");
        // A table that tilts by 30° at most leaves the rest.
        let mut weak = tilting(Turning::Follow);
        weak.axes[0].limits = [-30.0, 30.0];
        part.profile.program.positioner = Some(weak);
        let (left, whole) = (of(&part), lying.iter().flat_map(|layer| layer.iter()));
        for (left, whole) in left.iter().flat_map(|layer| layer.iter()).zip(whole) {
            let wanted = (whole - 30.0).max(0.0);
            assert!((left - wanted).abs() < 3.0, "{name}: {left} instead of {wanted}");
        }
        for (index, leans) in lying.iter().enumerate() {
            part.scene.set_leans(index, leans.clone());
        }
        let range = part.scene.value_range(Colour::OffLevel).unwrap();
        assert!(range.0 == 0.0 && (89.0..91.0).contains(&range.1), "{range:?}");
        assert_ne!(palette::at(Colour::OffLevel, 0.0), palette::at(Colour::OffLevel, 1.0));
    }
}

/// Pictures to look at: `cargo test -p beadwright-studio --test it -- holding::pictures --ignored`.
#[test]
#[ignore = "for looking"]
fn pictures() {
    let Ok(state) = headless() else { return };
    for name in ["hub", "elbow"] {
        let part = on_table(name, Some(tilting(Turning::Follow)));
        let plain = on_table(name, None);
        for (what, part) in [("held", &part), ("plain", &plain)] {
            for share in [0.2, 0.5, 0.8] {
                let seconds = part.scene.total_seconds() * share;
                let (place, now) = (part.at(seconds), part.scene.at_time(seconds).unwrap());
                let arm = stand(&part.cell, &part.reach, &place);
                let style = Style {
                    layers: 0..=now.layer,
                    segments_of_last: Some(now.segment),
                    torch: Some(now.torch),
                    around: arm.map(|arm| arm.shapes).unwrap_or_default(),
                    plate: None,
                    ..Style::default()
                };
                let mut view = View3d::default();
                view.camera.held = held(&part.reach.poses, &place).map_or(Frame::IDENTITY, Frame::from);
                let links = style.around.iter().flat_map(Shape::bounds);
                view.camera.fit_points(&part.scene.outline().into_iter().chain(links).collect::<Vec<_>>(), SIZE);
                let (width, height, pixels) = view.picture(&state, &part.scene, &style, [900, 700]).unwrap();
                let path =
                    PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("holding-{name}-{what}-{share}.png"));
                image::RgbaImage::from_raw(width, height, pixels).unwrap().save(&path).unwrap();
                println!("{}", path.display());
            }
        }
    }
}
