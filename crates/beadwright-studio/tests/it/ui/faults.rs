//! What once was wrong with the window, as people saw it.

use crate::window::{Window, click, crosses, example, press, search, sees, studio, wait};
use beadwright::layer::Layer;
use beadwright::planar::{DVec2, Polygon, Ring};
use beadwright::process::StartStop;
use beadwright::profile::Profile;
use beadwright_studio::actions::Action;
use beadwright_studio::jobs::Ask;
use beadwright_studio::project::{Project, Source};
use beadwright_studio::view2d::{Drawing, Named, Show, View2d};
use eframe::egui::epaint::Primitive;
use eframe::egui::{Key, Modifiers, Rect, Role};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use std::path::Path;
use std::time::{Duration, Instant};

fn square(low: f64, high: f64) -> Ring {
    Ring::new([(low, low), (high, low), (high, high), (low, high)].map(DVec2::from).to_vec())
}

/// Slits that are longer than they are wide by four orders of magnitude, at many angles; some with points that coincide.
fn slivers() -> Vec<Ring> {
    let slit = |k: usize| {
        let (way, middle) =
            (DVec2::from_angle(0.37 * k as f64), DVec2::new(10.0 * (k % 9) as f64 - 40.0, 4.0 * k as f64 - 40.0));
        let points = [middle, middle + 6.0 * way, middle + 6.0 * way + 1e-7, middle + 0.0006 * way.perp()];
        Ring::new(if k.is_multiple_of(2) { points.to_vec() } else { points[..3].to_vec() })
    };
    (0..20).map(slit).collect()
}

#[test]
fn slivers_draw_no_spikes() {
    let layer = Layer { islands: vec![Polygon { outer: square(-50.0, 50.0), holes: slivers() }], ..Layer::default() };
    let mut view = View2d::default();
    let draw = move |ui: &mut eframe::egui::Ui| {
        let (steps, pieces, nothing) = ((&[][..], Named::default()), 0, "nothing");
        let drawing =
            Drawing { layer: &layer, bands: None, judgement: None, steps, pieces, chosen: None, scale: None, nothing };
        view.show(ui, drawing, Show::default(), "layer");
    };
    let mut harness = Harness::builder().with_size([600.0, 600.0]).build_ui(draw);
    harness.run_steps(2);
    let shapes = harness.output().shapes.clone();
    let mut reach = Rect::NOTHING;
    for primitive in harness.ctx.tessellate(shapes, 1.0) {
        if let Primitive::Mesh(mesh) = primitive.primitive {
            mesh.vertices.iter().for_each(|vertex| reach.extend_with(vertex.pos));
        }
    }
    // The square fills the view but for a margin.
    assert!(
        Rect::from_min_size([0.0, 0.0].into(), [600.0, 600.0].into()).expand(2.0).contains_rect(reach),
        "{reach:?}"
    );
}

/// Ctrl+O where there is no desktop; elsewhere what happens then, so that no dialog comes up.
fn ask_to_open(harness: &mut Window) {
    let desktop = std::env::var_os("DBUS_SESSION_BUS_ADDRESS").is_some() || cfg!(not(target_os = "linux"));
    if desktop {
        harness.state_mut().ask_in_words(Ask::Open);
    } else {
        harness.key_press_modifiers(Modifiers::COMMAND, Key::O);
    }
    let begun = Instant::now();
    while !sees(harness, "Which file or folder?") {
        harness.run_steps(2);
        assert!(begun.elapsed() < Duration::from_secs(20), "nothing happens");
        std::thread::sleep(Duration::from_millis(20));
    }
}

#[test]
fn without_file_dialogs_a_path_is_typed() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("my part.stl");
    std::fs::write(&path, beadwright::example::find("cross").unwrap().stl()).unwrap();
    let mut harness = studio(&folder.path().join("store"));
    ask_to_open(&mut harness);
    click(&mut harness, "Cancel");
    assert!(!sees(&harness, "Which file or folder?"));
    ask_to_open(&mut harness);
    harness.get_by_role_and_label(Role::TextInput, "Path").click();
    harness.run_steps(2);
    harness.get_by_role_and_label(Role::TextInput, "Path").type_text(path.to_str().unwrap());
    harness.run_steps(2);
    press(&mut harness, Key::Enter);
    wait(&mut harness);
    assert_eq!(harness.state().project().source, Some(Source::File(path)));
    assert!(harness.state().plan().is_complete());
}

#[test]
fn a_message_does_not_move_the_view() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = example(&folder.path().join("store"), "cross");
    press(&mut harness, Key::F3);
    let before = harness.get_by_label("Layer view").rect();
    let broken = folder.path().join("broken.bwp");
    std::fs::write(&broken, "version = 99").unwrap();
    for messages in 1..4 {
        harness.state_mut().open(&broken);
        harness.state_mut().open(&folder.path().join(format!("{messages}.bwp")));
        harness.run_steps(3);
        assert!(harness.state().messages().len() > messages);
        assert_eq!(harness.get_by_label("Layer view").rect(), before, "{messages}");
    }
}

#[test]
fn the_messages_are_not_covered() {
    let folder = tempfile::tempdir().unwrap();
    let harness = example(folder.path(), "cross");
    let (text, play) = (harness.get_by_label("No warnings.").rect(), harness.get_by_label_contains("Play").rect());
    assert!(text.top() > play.bottom() && text.bottom() < 800.0, "{text:?} below {play:?}");
}

#[test]
fn three_messages_are_seen_whole() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = studio(&folder.path().join("store"));
    // Its layers end below the top of the part: two warnings.
    harness.state_mut().act(Action::SetProfile(Profile::built_in_text("cmt-steel-abb").unwrap()));
    harness.state_mut().set_value("layers.level", "false");
    harness.state_mut().open_example("propeller");
    wait(&mut harness);
    harness.state_mut().open(&folder.path().join("none.bwp"));
    harness.run_steps(4);
    let strip = |text: &str| harness.query_all_by_label_contains(text).map(|node| node.rect()).collect::<Vec<_>>();
    let lines = [strip("none.bwp"), strip("• ")].concat();
    assert!(lines.len() >= 3, "{lines:?}");
    for (i, line) in lines.iter().take(3).enumerate() {
        assert!(line.top() > 728.0 && line.bottom() < 800.0, "line {i} at {line} is cut off");
    }
}

#[test]
fn the_number_of_findings_does_not_move_the_tabs() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = example(folder.path(), "cross");
    let places = |harness: &Window| ["Plots", "Export"].map(|tab| harness.get_by_label(tab).rect());
    let before = places(&harness);
    harness.state_mut().set_value("check.max_void", "0.001");
    wait(&mut harness);
    assert!(!harness.state().plan().findings.as_ref().unwrap().is_empty());
    assert_eq!(places(&harness), before);
}

#[test]
fn findings_are_counted_beside_done_and_grouped() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = studio(folder.path());
    harness.state_mut().open_example("cross");
    harness.state_mut().set_value("check.max_void", "0.001");
    wait(&mut harness);
    let count = harness.state().plan().findings.as_ref().unwrap().len();
    assert!(count > 3 && sees(&harness, "Done"));
    click(&mut harness, &format!("Findings: {count}"));
    let voids = harness.state().plan().findings.iter().flatten().filter(|finding| finding.kind == "void");
    let layers: Vec<usize> = voids.filter_map(|finding| finding.layer).collect();
    let title = format!("{} alike (layers {}–{})", layers.len(), layers[0] + 1, layers.last().unwrap() + 1);
    assert!(sees(&harness, &title), "{title} is not on the screen");
    assert!(sees(&harness, &format!("void ({}, worth a look)", layers.len())));
}

#[test]
fn plots_without_values_and_empty_layers_say_so() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("two.stl");
    // One above the other, with air between.
    std::fs::write(&path, crosses(&[|p| p, |p| p.with_z(p.z + 40.0)])).unwrap();
    let mut harness = studio(&folder.path().join("store"));
    harness.state_mut().set_value("layers.level", "false");
    // A file without a part has no values.
    std::fs::write(folder.path().join("none.stl"), "solid none").unwrap();
    harness.state_mut().open(&folder.path().join("none.stl"));
    wait(&mut harness);
    click(&mut harness, "Plots");
    assert_eq!(harness.query_all_by_label("There are no values yet.").count(), 4);
    harness.state_mut().open(&path);
    wait(&mut harness);
    assert!(!sees(&harness, "There are no values yet."));
    // Ten layers of thirty hold nothing; sliders count them too.
    click(&mut harness, "Totals");
    assert!(sees(&harness, "20 / 30"));
    harness.state_mut().view().look_at(14);
    press(&mut harness, Key::F3);
    assert!(sees(&harness, "Layer view: Nothing is laid on this layer."));
    harness.state_mut().view().look_at(2);
    harness.run_steps(3);
    assert!(sees(&harness, "Layer view"));
}

fn opened(folder: &Path, profile: &str, scale: f64) -> Window {
    let mut project = Project { source: Some(Source::Example("cross".to_owned())), ..Project::default() };
    project.placement.scale = scale;
    Profile::built_in_text(profile).unwrap().clone_into(&mut project.profile);
    let path = folder.join("cross.bwp");
    std::fs::write(&path, project.write(None).unwrap()).unwrap();
    let mut harness = studio(&folder.join("store"));
    harness.state_mut().open(&path);
    wait(&mut harness);
    harness
}

#[test]
fn a_printer_has_filament_and_a_torch_has_an_arc() {
    for (profile, scale, there, gone) in [
        ("fdm-abs-0.4", 0.1, ["filament", "time extruding"], ["wire", "arc time"]),
        ("cmt-steel-abb", 1.0, ["wire", "arc time"], ["filament", "time extruding"]),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let harness = opened(folder.path(), profile, scale);
        assert!(there.iter().all(|word| sees(&harness, word)), "{profile}: {there:?}");
        assert!(!gone.iter().any(|word| sees(&harness, word)), "{profile}: {gone:?}");
    }
}

#[test]
fn parameters_are_found_by_names_of_both_languages_and_by_reasons() {
    // A Chinese name, an English one, and a word of the reason for a range.
    for (text, there, gone) in [
        ("沉积速度", "deposition speed", "gas flow"),
        ("Gas flow", "gas flow", "deposition speed"),
        ("ten hours cool", "interpass time", "gas flow"),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let mut harness = example(folder.path(), "cross");
        search(&mut harness, text);
        assert!(sees(&harness, there) && !sees(&harness, gone), "{text}");
    }
}

#[test]
fn a_group_goes_back_to_its_defaults() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = example(folder.path(), "cross");
    let waits = |harness: &Window| {
        let StartStop { interpass_time, end_overlap, .. } =
            Profile::parse(&harness.state().project().profile).unwrap().start_stop;
        (interpass_time, end_overlap)
    };
    harness.state_mut().set_value("start_stop.interpass_time", "9.0");
    harness.state_mut().set_value("start_stop.end_overlap", "3.0");
    wait(&mut harness);
    assert_eq!(waits(&harness), (9.0, 3.0));
    search(&mut harness, "interpass time");
    click(&mut harness, "all to defaults");
    wait(&mut harness);
    assert_eq!(waits(&harness), (0.0, 0.0));
    assert!(harness.state().plan().is_complete());
}
