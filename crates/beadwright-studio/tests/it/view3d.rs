//! The 3-D view: its clock, what is picked, where the camera looks, and what colour the pixels have.

use beadwright::example;
use beadwright::fill::StrategyName;
use beadwright::metrics::Metrics;
use beadwright::model;
use beadwright::plan::{Plan, plan};
use beadwright::process::{Follow, StartStop};
use beadwright::profile::Profile;
use beadwright::task::Task;
use beadwright::weld::Torch;
use beadwright_studio::view3d::{
    Camera, Colour, LayerBeads, Pick, Scene, StandardView, Style, View3d, headless, palette, pick,
};
use eframe::egui;
use eframe::egui_wgpu::RenderState;
use egui_kittest::{Harness, kittest::Queryable as _};
use glam::{DVec2, DVec3};
use std::path::PathBuf;
use std::sync::Arc;

const SIZE: DVec2 = DVec2::new(900.0, 700.0);

fn profile() -> Profile {
    Profile::built_in("cmt-al2319-kuka").unwrap()
}

/// An example, planned, and its scene.
fn planned(name: &str, profile: &Profile) -> (Plan, Scene) {
    let import = model::import(&example::find(name).unwrap().stl(), &Task::default()).unwrap();
    let mut mesh = import.mesh;
    mesh.place(1.0, DVec3::ZERO);
    let plan = plan(name, &mesh, profile, &Task::default()).unwrap();
    let mut scene = Scene::default();
    scene.set_mesh(Some(Arc::new(mesh)));
    let mut torch = Torch::of(&profile.weld_settings());
    for layer in &plan.layers {
        scene.set_layer(layer.index, Arc::new(LayerBeads::of(layer, &mut torch)));
    }
    (plan, scene)
}

fn renderer() -> Option<RenderState> {
    match headless() {
        Ok(state) => Some(state),
        Err(error) => {
            println!("pictures are skipped: {error}");
            None
        }
    }
}

/// Numbers that look random and are the same every time.
fn random(count: usize, below: usize) -> impl Iterator<Item = usize> {
    let step = |x: &u64| Some(x.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407));
    std::iter::successors(Some(7_u64), step).skip(1).map(move |x| (x >> 33) as usize % below).take(count)
}

#[test]
fn the_clock_agrees_with_the_metrics() {
    let mut with_motion = profile();
    with_motion.motion = Some(beadwright::motion::Motion { acceleration: 300.0, corner_speed: 8.0 });
    // Waits, craters, hot starts and overlaps count too, and so does who follows the width of the bead.
    let mut with_ends = profile();
    with_ends.process.follow = Follow::WireFeed;
    with_ends.start_stop = StartStop {
        end_overlap: 5.0,
        lead_in_length: 8.0,
        lead_in_power: 1.3,
        crater_fill_time: 0.8,
        wire_retract: 3.0,
        interpass_time: 30.0,
        ..StartStop::default()
    };
    for profile in [profile(), with_motion, with_ends] {
        let (plan, scene) = planned("plate", &profile);
        // The clock stops at the end of the last pass; the plan counts the way up from there too.
        let mut torch = Torch::of(&profile.weld_settings());
        plan.layers.iter().for_each(|layer| drop(LayerBeads::of(layer, &mut torch)));
        let expected = plan.summary.metrics.total_time_s - torch.retract().moving;
        let seconds = scene.total_seconds();
        assert!((seconds / expected - 1.0).abs() < 1e-9, "{seconds} s, not {expected} s");
        let mut one = Metrics::new(&profile);
        one.add(&plan.layers[0]);
        let mut torch = Torch::of(&profile.weld_settings());
        let alone = LayerBeads::of(&plan.layers[0], &mut torch).seconds() + torch.retract().moving;
        assert!((alone / one.total_time_s - 1.0).abs() < 1e-9);
    }
}

#[test]
fn the_torch_goes_on_without_leaps() {
    let (plan, scene) = planned("star", &profile());
    let (seconds, steps) = (scene.total_seconds(), 20_000);
    let positions: Vec<_> = (0..=steps).map(|i| scene.at_time(seconds * i as f64 / steps as f64).unwrap()).collect();
    let fastest = profile().travel.speed.max(profile().process.deposition_speed * 2.0);
    for pair in positions.windows(2) {
        let leap = pair[0].torch.at.distance(pair[1].torch.at);
        assert!(leap <= fastest * seconds / steps as f64 + 0.01, "{leap} mm at {:?}", pair[0]);
        assert!((pair[0].layer, pair[0].segment) <= (pair[1].layer, pair[1].segment));
    }
    assert!(positions[0].torch.at.distance(plan.layers[0].passes[0].start().unwrap()) < 1e-3);
    let end = plan.layers.last().unwrap().passes.last().unwrap().end().unwrap();
    assert!(positions[steps].torch.at.distance(end) < 1e-3);
    assert_eq!(positions[steps].segment, scene.layers().last().unwrap().as_ref().unwrap().len());
    assert_eq!(Scene::default().at_time(3.0), None);
}

#[test]
fn segments_belong_to_their_passes_and_times_follow_each_other() {
    let (plan, scene) = planned("star", &profile());
    let beads = scene.layer(1).unwrap();
    assert_eq!(beads.len(), plan.layers[1].passes.iter().map(|p| p.segments().count()).sum::<usize>());
    let mut before = 0.0;
    for segment in 0..beads.len() {
        let (begin, end) = beads.times(segment).unwrap();
        assert!(begin >= before - 1e-3 && end >= begin, "segment {segment}: {begin} to {end} s after {before} s");
        assert!(beads.passes()[beads.pass_of(segment)].segments.contains(&segment));
        before = end;
    }
}

/// Whether the middle of a segment is covered by no other bead of its layer that lies as high there.
fn alone(beads: &LayerBeads, segment: usize) -> bool {
    let of = |i: usize| &beads.beads()[i];
    let middle = (of(segment).from() + of(segment).to()) / 2.0;
    let near = |i: usize| {
        let (a, b) = (of(i).from(), of(i).to());
        let along = ((middle - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
        middle.distance(a + (b - a) * along) < 0.05 * of(i).width()
    };
    (0..beads.len()).filter(|&i| i != segment).all(|i| !near(i))
}

#[test]
fn a_click_finds_the_segment_that_is_seen() {
    let (plan, scene) = planned("propeller", &profile());
    let top = plan.layers.len() - 1;
    let style = Style { layers: 0..=top, ..Style::default() };
    let (mut camera, mut tried) = (Camera::default(), 0);
    for orthographic in [false, true] {
        camera.orthographic = orthographic;
        camera.set_view(StandardView::Top);
        camera.fit(scene.bounds().unwrap(), SIZE);
        let beads = scene.layer(top).unwrap();
        for segment in random(300, beads.len()).filter(|&i| alone(beads, i)) {
            let bead = &beads.beads()[segment];
            let middle = (bead.from() + bead.to()).as_dvec3() / 2.0;
            let found = pick(&scene, &style, &camera, SIZE, camera.project(middle, SIZE).unwrap());
            assert_eq!(found, Some(Pick { layer: top, pass: beads.pass_of(segment), segment }), "at {middle}");
            tried += 1;
        }
    }
    assert!(tried > 200, "only {tried} segments lie free");
    let beside = pick(&scene, &style, &camera, SIZE, DVec2::new(3.0, 3.0));
    assert_eq!(beside, None);
    let hidden = Style { beads: false, ..style };
    assert_eq!(pick(&scene, &hidden, &camera, SIZE, SIZE / 2.0), None);
}

fn cameras() -> impl Iterator<Item = Camera> {
    let turned = |orthographic: bool| {
        [(-1.0, 0.4), (2.0, 1.2), (0.3, -0.6)].map(|(yaw, pitch)| Camera {
            yaw,
            pitch,
            orthographic,
            ..Camera::default()
        })
    };
    [false, true].into_iter().flat_map(turned)
}

#[test]
fn what_is_projected_lies_on_its_line_of_sight() {
    for camera in cameras() {
        for point in [DVec3::new(40.0, -25.0, 10.0), DVec3::new(-80.0, 60.0, 55.0)] {
            let seen = camera.project(point, SIZE).unwrap();
            let (origin, way) = camera.ray(seen, SIZE);
            let off = (point - origin).reject_from(way).length();
            assert!(off < 1e-6, "{off} mm beside it");
            let clip = camera.clip_from_world(SIZE) * point.extend(1.0);
            let ndc = clip.truncate() / clip.w;
            let pixel = DVec2::new((ndc.x + 1.0) / 2.0, (1.0 - ndc.y) / 2.0) * SIZE;
            assert!(pixel.distance(seen) < 1e-3, "the graphics card sees it at {pixel}, not at {seen}");
            assert!((0.0..1.0).contains(&ndc.z));
        }
        let at = DVec2::new(120.0, 600.0);
        assert!(camera.project(camera.unproject(at, SIZE), SIZE).unwrap().distance(at) < 1e-6);
    }
}

#[test]
fn a_fitted_box_is_in_the_picture_and_fills_it() {
    let bounds = (DVec3::new(-130.0, -20.0, 0.0), DVec3::new(130.0, 90.0, 60.0));
    for (mut camera, size) in cameras().flat_map(|c| [(c, SIZE), (c, DVec2::new(300.0, 800.0))]) {
        camera.fit(bounds, size);
        let (low, high) = bounds;
        let (mut first, mut last) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for i in 0..8 {
            let pick = |axis: usize| if i >> axis & 1 == 0 { low[axis] } else { high[axis] };
            let seen = camera.project(DVec3::new(pick(0), pick(1), pick(2)), size).unwrap();
            (first, last) = (first.min(seen), last.max(seen));
        }
        assert!(first.min_element() >= 0.0 && (size - last).min_element() >= 0.0, "{first} to {last} of {size}");
        let filled = ((last - first) / size).max_element();
        assert!(filled > 0.85, "only {filled} of the picture is used");
    }
}

#[test]
fn zooming_keeps_the_place_under_the_pointer() {
    for mut camera in cameras() {
        let at = DVec2::new(200.0, 150.0);
        let point = camera.unproject(at, SIZE);
        for factor in [1.7, 0.4, 3.0] {
            camera.zoom(factor, point);
            assert!(camera.project(point, SIZE).unwrap().distance(at) < 1e-6);
        }
        let before = camera.project(camera.target, SIZE).unwrap();
        let target = camera.target;
        camera.pan(DVec2::new(30.0, -12.0), SIZE);
        let moved = camera.project(target, SIZE).unwrap() - before;
        assert!(moved.distance(DVec2::new(30.0, -12.0)) < 1e-6, "the part follows the pointer, not {moved}");
    }
}

#[test]
fn colours_of_a_map_are_all_different_and_grow_brighter() {
    let brightness = |[r, g, b]: [u8; 3]| 0.21 * f64::from(r) + 0.72 * f64::from(g) + 0.07 * f64::from(b);
    for colour in [Colour::Order, Colour::Temperature] {
        let map = palette::map(colour);
        assert!(map.windows(8).step_by(8).all(|w| brightness(w[7]) > brightness(w[0])));
    }
    assert_eq!(palette::map(Colour::Kind)[1], palette::kind(palette::KINDS[1]));
}

#[test]
fn beads_know_how_warm_the_metal_was_where_a_limit_holds() {
    let mut limited = profile();
    let limits =
        beadwright::heat::Interpass { max_temperature: 120.0, min_temperature: None, reorder: true, along: false };
    assert_eq!(planned("cross", &limited).1.value_range(Colour::Temperature), None);
    limited.interpass = Some(limits);
    let (plan, scene) = planned("cross", &limited);
    let (low, high) = scene.value_range(Colour::Temperature).unwrap();
    assert!((19.0..25.0).contains(&low) && (60.0..121.5).contains(&high), "{low} to {high} °C");
    for (layer, beads) in plan.layers.iter().zip(scene.layers().iter().flatten()) {
        let temperatures: Vec<f32> = beads.passes().iter().filter_map(|pass| pass.temperature).collect();
        assert_eq!(temperatures, layer.temperatures.iter().map(|t| t.start as f32).collect::<Vec<_>>());
    }
}

fn save(name: &str, (width, height, pixels): &(u32, u32, Vec<u8>)) {
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    let image = image::RgbaImage::from_raw(*width, *height, pixels.clone()).unwrap();
    image.save(&path).unwrap();
    println!("{}", path.display());
}

/// Hue in degrees, and how much colour there is, 0 to 1.
fn hue([r, g, b]: [u8; 3]) -> (f64, f64) {
    let [r, g, b] = [r, g, b].map(|c| f64::from(c) / 255.0);
    let (most, least) = (r.max(g).max(b), r.min(g).min(b));
    let spread = (most - least).max(1e-9);
    let hue = if most == r {
        (g - b) / spread
    } else if most == g {
        2.0 + (b - r) / spread
    } else {
        4.0 + (r - g) / spread
    };
    ((hue * 60.0).rem_euclid(360.0), (most - least) / most.max(1e-9))
}

#[test]
fn beads_have_the_hue_of_their_kind_where_they_lie() {
    let Some(state) = renderer() else { return };
    let mut profile = profile();
    profile.fill.strategy = StrategyName::Hybrid;
    let (plan, scene) = planned("star", &profile);
    let top = plan.layers.len() - 1;
    let beads = scene.layer(top).unwrap();
    for (dark, orthographic) in [(true, false), (false, true)] {
        let style = Style { mesh: false, dark, ..Style::default() };
        let mut view = View3d::default();
        view.camera.orthographic = orthographic;
        view.camera.set_view(StandardView::Top);
        view.camera.fit(scene.bounds().unwrap(), SIZE);
        let picture = view.picture(&state, &scene, &style, [SIZE.x as u32, SIZE.y as u32]).unwrap();
        save(&format!("star-{}.png", if dark { "dark" } else { "light" }), &picture);
        let pixel = |at: DVec2| {
            let i = 4 * (at.y as usize * SIZE.x as usize + at.x as usize);
            [0, 1, 2].map(|c| picture.2[i + c])
        };
        for segment in random(100, beads.len()).filter(|&i| alone(beads, i)) {
            let bead = &beads.beads()[segment];
            let middle = view.camera.project((bead.from() + bead.to()).as_dvec3() / 2.0, SIZE).unwrap();
            let kind = beads.passes()[beads.pass_of(segment)].kind;
            let ((seen, strength), (expected, _)) = (hue(pixel(middle)), hue(palette::kind(kind)));
            let off = (seen - expected + 180.0).rem_euclid(360.0) - 180.0;
            assert!(off.abs() < 12.0 && strength > 0.3, "hue {seen} at {middle}, not {expected} of {}", kind.name());
        }
        assert!(hue(pixel(DVec2::new(20.0, 20.0))).1 < 0.25, "the ground has a colour");
    }
}

/// Pictures to look at; they take a while, so only on demand: `cargo test -p beadwright-studio --test it -- view3d:: --ignored`.
#[test]
#[ignore = "for looking"]
fn pictures() {
    let Some(state) = renderer() else { return };
    let profile = profile();
    let (plan, mut scene) = planned("propeller", &profile);
    let top = plan.layers.len() - 1;
    println!("{} segments, {} layers, strategy {}", scene.segments(), plan.layers.len(), plan.header.strategy);
    let mut view = View3d::default();
    let shoot = |view: &mut View3d, scene: &Scene, name: &str, side: StandardView, zoom: f64, style: Style| {
        view.camera = Camera::default();
        view.camera.set_view(side);
        view.camera.fit_points(&scene.outline(), SIZE);
        let towards = DVec3::new(110.0, -20.0, 18.0);
        view.camera.zoom(zoom, towards);
        if zoom > 3.0 {
            view.camera.target = towards;
        }
        save(name, &view.picture(&state, scene, &style, [900, 700]).unwrap());
    };
    let plain = Style { mesh: false, ..Style::default() };
    use StandardView::{Front, Iso, Top};
    shoot(&mut view, &scene, "a-all.png", Iso, 1.0, plain.clone());
    shoot(&mut view, &scene, "b-layer.png", Top, 1.0, Style { layers: 3..=3, ..plain.clone() });
    shoot(&mut view, &scene, "c-close.png", Iso, 5.0, plain.clone());
    shoot(&mut view, &scene, "d-layer-close.png", Top, 6.0, Style { layers: 3..=3, ..plain.clone() });
    shoot(&mut view, &scene, "e-front.png", Front, 4.0, plain.clone());
    shoot(
        &mut view,
        &scene,
        "f-order-light.png",
        Iso,
        1.0,
        Style { colour: Colour::Order, dark: false, ..plain.clone() },
    );
    let torch = scene.at_time(scene.total_seconds() * 0.4).unwrap();
    let playing = Style {
        travels: true,
        starts: true,
        mesh: true,
        layers: 0..=torch.layer,
        segments_of_last: Some(torch.segment),
        torch: Some(torch.torch),
        ..plain.clone()
    };
    shoot(&mut view, &scene, "g-playing.png", Iso, 1.0, playing.clone());
    shoot(&mut view, &scene, "h-playing-light.png", Iso, 1.6, Style { dark: false, ..playing });
    shoot(&mut view, &scene, "i-mesh.png", Iso, 1.0, Style { beads: false, mesh: true, ..plain.clone() });
    shoot(
        &mut view,
        &scene,
        "j-mesh-light.png",
        Iso,
        1.0,
        Style { beads: false, mesh: true, dark: false, ..plain.clone() },
    );
    let highlight =
        Some(Pick { layer: top, pass: 2, segment: scene.layer(top).unwrap().passes()[2].segments.start + 3 });
    shoot(&mut view, &scene, "k-highlight.png", Iso, 2.0, Style { highlight, colour: Colour::Time, ..plain.clone() });
    for index in 0..=top {
        let beads = scene.layer(index).unwrap();
        let wave = |b: &beadwright_studio::view3d::Bead| (b.from().x / 30.0).sin() * (b.from().y / 25.0).cos() * 0.4;
        let values: Arc<[f32]> = beads.beads().iter().map(wave).collect();
        scene.set_values(index, values);
    }
    shoot(&mut view, &scene, "l-error.png", Iso, 1.0, Style { colour: Colour::HeightError, ..plain.clone() });
    let outline = scene.outline();
    for (name, yaw, pitch, orthographic, layers) in [
        ("n-below.png", -1.0, -0.5, false, 0..=top),
        ("o-parallel.png", -1.57, 0.15, true, 0..=top),
        ("p-far.png", -1.0, 0.6, false, 2..=5),
    ] {
        view.camera = Camera { yaw, pitch, orthographic, ..Camera::default() };
        view.camera.fit_points(&outline, SIZE);
        view.camera.distance *= if name == "p-far.png" { 6.0 } else { 1.0 };
        save(name, &view.picture(&state, &scene, &Style { layers, ..plain.clone() }, [900, 700]).unwrap());
    }
    for (part, strategy) in [("gear", "hybrid"), ("pot", "wall"), ("vase", "contour")] {
        let mut profile = profile.clone();
        profile.fill.strategy = strategy.parse().unwrap();
        let (_, scene) = planned(part, &profile);
        shoot(&mut view, &scene, &format!("m-{part}.png"), Iso, 1.0, plain.clone());
    }
}

/// A window that holds nothing but the view.
struct Window {
    view: View3d,
    scene: Scene,
    style: Style,
    rendered: usize,
    picked: Option<Pick>,
    hovered: Option<Pick>,
    with_adapter: bool,
}

impl eframe::App for Window {
    fn ui(&mut self, ui: &mut egui::Ui, frame: &mut eframe::Frame) {
        let state = frame.wgpu_render_state().filter(|_| self.with_adapter);
        let shown = self.view.show(ui, state, &self.scene, &self.style, "3-D view");
        self.rendered += usize::from(shown.rendered);
        self.picked = shown.picked.or(self.picked);
        self.hovered = shown.hovered;
    }
}

fn window(with_adapter: bool) -> Harness<'static, Window> {
    let (_, scene) = planned("star", &profile());
    let style = Style { mesh: false, ..Style::default() };
    let window =
        Window { view: View3d::default(), scene, style, rendered: 0, picked: None, hovered: None, with_adapter };
    Harness::builder().with_size(egui::vec2(640.0, 480.0)).wgpu().build_eframe(|_| window)
}

#[test]
fn the_view_turns_zooms_and_picks_and_rests() {
    if renderer().is_none() {
        return;
    }
    let mut harness = window(true);
    harness.run_steps(6);
    let rendered = harness.state().rendered;
    assert_eq!(rendered, 1, "nothing changed after the first picture");
    let middle = harness.get_by_label("3-D view").rect().center();

    harness.hover_at(middle);
    harness.run_steps(2);
    let below = harness.state().hovered;
    assert!(below.is_some(), "a bead lies in the middle of the star");
    assert_eq!(harness.state().rendered, rendered, "a pointer changes nothing");

    let before = harness.state().view.camera;
    harness.drag_at(middle);
    harness.run_steps(1);
    harness.hover_at(middle + egui::vec2(90.0, 20.0));
    harness.run_steps(2);
    harness.drop_at(middle + egui::vec2(90.0, 20.0));
    harness.run_steps(4);
    let turned = harness.state().view.camera;
    assert!((before.yaw - turned.yaw).abs() > 0.3 && turned.target == before.target);
    assert!(harness.state().rendered > rendered);
    assert_eq!(harness.state().picked, None, "a drag is no click");

    harness.hover_at(middle);
    harness.run_steps(1);
    let line = egui::Event::MouseWheel {
        unit: egui::MouseWheelUnit::Line,
        delta: egui::vec2(0.0, 3.0),
        phase: egui::TouchPhase::Move,
        source: egui::MouseWheelSource::Wheel,
        modifiers: egui::Modifiers::NONE,
    };
    harness.event(line);
    harness.run_steps(20);
    assert!(harness.state().view.camera.distance < 0.98 * turned.distance);

    harness.drag_at(middle);
    harness.run_steps(1);
    harness.drop_at(middle);
    harness.run_steps(3);
    assert!(harness.state().picked.is_some());
    harness.render().unwrap().save(PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("widget.png")).unwrap();
}

#[test]
fn without_an_adapter_the_view_says_so() {
    if renderer().is_none() {
        return;
    }
    let mut harness = window(false);
    harness.run_steps(3);
    assert_eq!(harness.state().rendered, 0);
    let sentence = harness.state().view.no_adapter.clone();
    assert!(harness.query_by_label(&sentence).is_some());
}

#[test]
fn layers_that_come_in_any_order_give_the_same_picture() {
    let Some(state) = renderer() else { return };
    let (plan, whole) = planned("star", &profile());
    let top = plan.layers.len() - 1;
    let mut view = View3d::default();
    view.camera.fit(whole.bounds().unwrap(), SIZE);
    let camera = view.camera;
    let shoot =
        |view: &mut View3d, scene: &Scene, style: &Style| view.picture(&state, scene, style, [300, 240]).unwrap().2;
    for colour in [Colour::Kind, Colour::Order, Colour::Time, Colour::Speed] {
        let style = Style { colour, travels: true, starts: true, ..Style::default() };
        let mut scene = Scene::default();
        scene.set_mesh(whole.mesh().cloned());
        for index in [top, 1, 0].into_iter().chain(2..=top) {
            scene.set_layer(index, whole.layer(index).unwrap().clone());
            shoot(&mut view, &scene, &style);
        }
        let mut fresh = View3d::default();
        fresh.camera = camera;
        assert!(shoot(&mut view, &scene, &style) == shoot(&mut fresh, &whole, &style), "{colour:?}");
    }
    // Part of the layers looks like a scene that holds no others.
    let mut low = Scene::default();
    low.set_mesh(whole.mesh().cloned());
    (0..=3).for_each(|i| low.set_layer(i, whole.layer(i).unwrap().clone()));
    let style = Style { layers: 0..=3, ..Style::default() };
    assert!(shoot(&mut view, &whole, &style) == shoot(&mut view, &low, &Style::default()), "layers 0 to 3");
    let none = Style { segments_of_last: Some(0), ..style.clone() };
    let below = Style { layers: 0..=2, ..style };
    assert!(shoot(&mut view, &whole, &none) == shoot(&mut view, &whole, &below), "nothing of layer 3");
    whole.layers().iter().flatten().for_each(|layer| assert!(!layer.is_empty()));
    let empty = Scene::default();
    shoot(&mut view, &empty, &Style::default());
}
