//! The section through the 3-D view: what is seen and what is picked is what lies on the plane.

use beadwright::fill::StrategyName;
use beadwright::pass::PassKind;
use beadwright::profile::Profile;
use beadwright::task::Task;
use beadwright::weld::Torch;
use beadwright::{example, model};
use beadwright_studio::view3d::{
    Bead, Camera, LayerBeads, Scene, Section, StandardView, Style, View3d, headless, palette, pick,
};
use glam::{DVec2, DVec3};
use std::sync::Arc;

const PIXELS: [u32; 2] = [800, 400];
const SIZE: DVec2 = DVec2::new(800.0, 400.0);

fn planned(name: &str) -> Scene {
    let mut profile = Profile::built_in("cmt-al2319-kuka").unwrap();
    profile.fill.strategy = StrategyName::Hybrid;
    let example = example::find(name).unwrap();
    if let Some(chart) = example.chart {
        profile.layers.chart = chart.parse().unwrap();
    }
    let import = model::import(&example.stl(), &Task::default()).unwrap();
    let mut mesh = import.mesh;
    mesh.place(1.0, DVec3::ZERO);
    let plan = beadwright::plan::plan(name, &mesh, &profile, &Task::default()).unwrap();
    let mut scene = Scene::default();
    scene.set_mesh(Some(Arc::new(mesh)));
    let mut torch = Torch::of(&profile.weld_settings());
    for layer in &plan.layers {
        scene.set_layer(layer.index, Arc::new(LayerBeads::of(layer, &mut torch)));
    }
    scene
}

/// How far a point is from the middle of a bead, an ellipse along a line with round ends: 1 on its surface.
pub(crate) fn from_middle(bead: &Bead, at: DVec3) -> f64 {
    let (width, height, up) = (f64::from(bead.width()), f64::from(bead.height()), bead.up().as_dvec3());
    let stretched = |v: DVec3| (v.reject_from(up) / width + v.project_onto(up) / height) * 2.0;
    let middle = up * (height / 2.0);
    let [a, b, p] = [bead.from().as_dvec3() - middle, bead.to().as_dvec3() - middle, at].map(stretched);
    let part = ((p - a).dot(b - a) / (b - a).length_squared().max(1e-12)).clamp(0.0, 1.0);
    p.distance(a.lerp(b, part))
}

/// The bead that a point is deepest in, its kind, and how deep.
fn deepest(scene: &Scene, at: DVec3) -> (f64, PassKind, [usize; 2]) {
    let layers = scene.layers().iter().enumerate().filter_map(|(i, layer)| Some((i, layer.as_ref()?)));
    let beads = layers.flat_map(|(i, layer)| {
        let of = move |segment| layer.passes()[layer.pass_of(segment)].kind;
        layer.beads().iter().enumerate().map(move |(segment, bead)| (from_middle(bead, at), of(segment), [i, segment]))
    });
    beads.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap()
}

/// Looks squarely at a section across y or x.
fn squarely(scene: &Scene, axis: usize) -> Camera {
    let view = if axis == 1 { StandardView::Front } else { StandardView::Right };
    let mut camera = Camera { orthographic: true, ..Camera::default() };
    camera.set_view(view);
    camera.fit(scene.bounds().unwrap(), SIZE);
    camera
}

/// Places spread over a section.
fn places(scene: &Scene, section: &Section, count: u64) -> Vec<DVec3> {
    let (low, high) = scene.bounds().unwrap();
    let step = |x: &u64| Some(x.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407));
    let parts: Vec<f64> = std::iter::successors(Some(11), step)
        .skip(1)
        .take(3 * count as usize)
        .map(|x| (x >> 11) as f64 / (1_u64 << 53) as f64)
        .collect();
    let place = |part: &[f64]| {
        let mut at = low + (high - low) * DVec3::from_slice(part);
        at[section.axis] = section.at;
        at
    };
    parts.chunks_exact(3).map(place).collect()
}

/// The sections looked at: from the side that is cut away.
const SECTIONS: [Section; 3] = [
    Section { axis: 1, at: 3.1, lower: true },
    Section { axis: 0, at: -7.3, lower: false },
    Section { axis: 1, at: -6.2, lower: true },
];

/// What they cut: the last one has layers around an axis.
const PARTS: [&str; 3] = ["cross", "gear", "shaft"];

#[test]
fn the_section_shows_the_inside_of_beads_where_they_are() {
    let Ok(state) = headless() else {
        println!("pictures are skipped: there is nothing to draw with");
        return;
    };
    for (name, section) in PARTS.into_iter().zip(SECTIONS) {
        let scene = planned(name);
        let mut view = View3d::default();
        view.camera = squarely(&scene, section.axis);
        let style = Style { mesh: false, section: Some(section), ..Style::default() };
        let (width, _, pixels) = view.picture(&state, &scene, &style, PIXELS).unwrap();
        let (mut inside, mut outside, mut mixed, mut alike) = (0, 0, 0, 0);
        for at in places(&scene, &section, 6000) {
            let seen = view.camera.project(at, SIZE).unwrap();
            let first = 4 * (seen.y as usize * width as usize + seen.x as usize);
            let found: Vec<f64> = pixels[first..first + 3].iter().map(|c| f64::from(*c)).collect();
            let (off, kind, _) = deepest(&scene, at);
            let wanted = palette::kind(kind).map(|c| 0.85 * f64::from(c));
            let error = found.iter().zip(wanted).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            if off < 0.75 {
                inside += 1;
                // Where beads overlap, and are as deep in each other, either may be seen.
                mixed += usize::from(error > 4.0);
            } else if off > 1.05 {
                outside += 1;
                // A bead behind the section may happen to be lit as much.
                alike += usize::from(error < 4.0);
            }
        }
        assert!(mixed * 12 < inside, "{name}: {mixed} of {inside} points have another colour");
        assert!(alike * 10 < outside, "{name}: {alike} of {outside} points look like metal");
        assert!(inside > 100 && outside > 20, "{inside} points in beads, {outside} beside them");
    }
}

#[test]
fn a_click_on_the_section_picks_the_bead_that_is_cut_there() {
    for (name, section) in PARTS.into_iter().zip(SECTIONS) {
        let scene = planned(name);
        let camera = squarely(&scene, section.axis);
        let style = Style { section: Some(section), ..Style::default() };
        let mut picked = 0;
        for at in places(&scene, &section, 1500) {
            let found = pick(&scene, &style, &camera, SIZE, camera.project(at, SIZE).unwrap());
            if deepest(&scene, at).0 < 0.98 {
                let found = found.unwrap();
                let bead = &scene.layer(found.layer).unwrap().beads()[found.segment];
                assert!(from_middle(bead, at) < 1.02, "{name}, {at:.2}: {found:?} does not lie there");
                picked += 1;
            }
        }
        assert!(picked > 100, "{picked}");
    }
}

#[test]
fn a_ray_is_kept_on_the_side_that_is_kept() {
    for section in SECTIONS.into_iter().chain([Section { axis: 2, at: 4.0, lower: false }]) {
        for i in 0..60_u32 {
            let angle = f64::from(i) * 0.7;
            let way = DVec3::new(angle.cos(), (1.3 * angle).sin(), (0.6 * angle).cos()).normalize();
            let origin = DVec3::new(20.0, -30.0, 25.0) * (0.21 * f64::from(i)).sin();
            let kept = section.kept(origin, way);
            for step in 0..200 {
                let t = f64::from(step) * 0.5 + 0.013;
                let beyond = (origin + way * t)[section.axis] > section.at;
                let wanted = beyond == section.lower;
                assert_eq!(
                    kept.is_some_and(|(from, to)| (from..to).contains(&t)),
                    wanted,
                    "{section:?}, {origin}, {t}"
                );
            }
        }
    }
}
