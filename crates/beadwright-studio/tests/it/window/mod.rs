//! The program without a screen, as a person would use it.
#![allow(dead_code)]

use beadwright_studio::Studio;
use beadwright_studio::settings::Store;
use eframe::egui::{Event, Key, Modifiers, PointerButton, Pos2, Role};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use glam::DVec3;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// Longest wait for a plan.
const PATIENCE: Duration = Duration::from_secs(120);

/// The window of a test.
pub(crate) type Window = Harness<'static, Studio>;

pub(crate) fn studio(store: &Path) -> Window {
    studio_of_size(store, [1280.0, 800.0])
}

/// The program in a window of this many points.
pub(crate) fn studio_of_size(store: &Path, size: [f32; 2]) -> Window {
    let store = Store::at(store.to_owned());
    let builder = Harness::builder().with_size(size).with_max_steps(64);
    let builder = if has_adapter() { builder.wgpu() } else { builder };
    let mut harness = builder.build_eframe(move |cc| Studio::new(cc, store));
    harness.run_steps(2);
    harness
}

/// Whether there is something to draw with; says so where there is not.
pub(crate) fn has_adapter() -> bool {
    static FOUND: OnceLock<bool> = OnceLock::new();
    *FOUND.get_or_init(|| match beadwright_studio::view3d::headless() {
        Ok(_) => true,
        Err(error) => {
            println!("pictures are skipped: {error}");
            false
        }
    })
}

/// The command `beadwright`, built.
pub(crate) fn command() -> &'static Path {
    static BUILT: OnceLock<PathBuf> = OnceLock::new();
    BUILT.get_or_init(|| {
        // This package's tests do not build the command by themselves. With all tests it is already there: built alone, with other
        // features of the crates below it, it would take minutes more.
        let mut build = Command::new(env!("CARGO"));
        let all = ["test", "--quiet", "--workspace", "--no-run", "--test", "it"];
        assert!(build.args(all).status().unwrap().success());
        Path::new(env!("CARGO_BIN_EXE_beadwright-studio")).with_file_name("beadwright")
    })
}

/// Runs the command; what it prints.
pub(crate) fn run(arguments: &[&str]) -> String {
    let output = Command::new(command()).args(arguments).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// Runs until nothing is under way.
pub(crate) fn wait(harness: &mut Window) {
    let start = Instant::now();
    loop {
        harness.run_steps(2);
        if harness.state().is_idle() {
            break;
        }
        assert!(start.elapsed() < PATIENCE, "no plan after {PATIENCE:?}");
        std::thread::sleep(Duration::from_millis(10));
    }
    harness.run_steps(2);
}

/// Clicks on what has this label.
pub(crate) fn click(harness: &mut Window, label: &str) {
    harness.get_by_label(label).click();
    harness.run_steps(3);
}

/// Presses a key.
pub(crate) fn press(harness: &mut Window, key: Key) {
    harness.key_press(key);
    harness.run_steps(3);
}

/// Sets the slider of this name.
pub(crate) fn slide(harness: &mut Window, label: &str, value: f64) {
    harness.get_by_role_and_label(Role::Slider, label).set_value_accesskit(value);
    harness.run_steps(3);
}

/// Presses the button of the pointer, or lets it go.
pub(crate) fn button(harness: &mut Window, pos: Pos2, pressed: bool) {
    harness.event(Event::PointerButton { pos, button: PointerButton::Primary, pressed, modifiers: Modifiers::NONE });
    harness.run_steps(2);
}

/// Presses the button at one place and moves to another, without letting go.
pub(crate) fn pull(harness: &mut Window, from: Pos2, to: Pos2) {
    harness.hover_at(from);
    harness.run_steps(2);
    button(harness, from, true);
    for pos in [from.lerp(to, 0.5), to] {
        harness.hover_at(pos);
        harness.run_steps(2);
    }
}

/// Drags from one place to another, and waits for what comes of it.
pub(crate) fn drag(harness: &mut Window, from: Pos2, to: Pos2) {
    pull(harness, from, to);
    button(harness, to, false);
    harness.remove_cursor();
    wait(harness);
}

/// Opens the list of a choice.
pub(crate) fn open_list(harness: &mut Window, label: &str) {
    harness.get_by_role_and_label(Role::ComboBox, label).click();
    harness.run_steps(3);
}

/// Whether this text is to be seen.
pub(crate) fn sees(harness: &Window, label: &str) -> bool {
    harness.query_all_by_label(label).next().is_some()
}

/// Whether a text that has this in it is to be seen.
pub(crate) fn says(harness: &Window, part: &str) -> bool {
    harness.query_all_by_label_contains(part).next().is_some()
}

/// Clicks at a place of the window.
pub(crate) fn click_at(harness: &mut Window, pos: Pos2) {
    harness.hover_at(pos);
    for pressed in [true, false] {
        let (button, modifiers) = (PointerButton::Primary, Modifiers::NONE);
        harness.event(Event::PointerButton { pos, button, pressed, modifiers });
    }
    harness.run_steps(3);
}

/// Types a text into the number field of this name, and Enter.
pub(crate) fn type_number(harness: &mut Window, name: &str, text: &str) {
    harness.get_by_role_and_label(Role::SpinButton, name).click();
    harness.run_steps(2);
    harness.get_by_role_and_label(Role::SpinButton, name).type_text(text);
    harness.run_steps(1);
    harness.key_press(Key::Enter);
    harness.run_steps(3);
}

/// The values at both ends of the colours, as they are shown.
pub(crate) fn colour_range(harness: &Window) -> [String; 2] {
    let field = |name| harness.get_by_role_and_label(Role::SpinButton, name).value().unwrap();
    ["Lowest value of the colours", "Highest value of the colours"].map(field)
}

/// Checks that these values are shown at both ends of the colours, to a hundredth of what is between them.
pub(crate) fn shows(harness: &Window, ends: [f64; 2], unit: &str) {
    let number = |end: &String| end.strip_suffix(unit).and_then(|number| number.parse::<f64>().ok());
    let near = |(text, end): (&String, f64)| {
        number(text).is_some_and(|shown| (shown - end).abs() <= 0.01 * (ends[1] - ends[0]))
    };
    let shown = colour_range(harness);
    assert!(shown.iter().zip(ends).all(near), "{shown:?}, not {ends:?}{unit}");
}

/// Searches among the parameters.
pub(crate) fn search(harness: &mut Window, text: &str) {
    harness.get_by_role_and_label(Role::TextInput, "Search").click();
    harness.run_steps(2);
    harness.get_by_role_and_label(Role::TextInput, "Search").type_text(text);
    harness.run_steps(3);
}

/// Opens an example and waits for its plan.
pub(crate) fn example(store: &Path, name: &str) -> Window {
    let mut harness = studio(store);
    harness.state_mut().open_example(name);
    wait(&mut harness);
    assert!(harness.state().plan().is_complete(), "{:?}", harness.state().plan().failure);
    harness
}

/// The same with a folder of its own, which lasts as long as the window needs it.
pub(crate) fn planned(name: &str) -> (TempDir, Window) {
    let folder = tempfile::tempdir().unwrap();
    let harness = example(folder.path(), name);
    (folder, harness)
}

/// Lowest and highest coordinates of the part that is planned, mm.
pub(crate) fn bounds(harness: &Window) -> (DVec3, DVec3) {
    harness.state().plan().part.as_ref().unwrap().bounds()
}

/// The cross, several times, each moved and turned by a function, as a binary STL.
pub(crate) fn crosses(place: &[fn(DVec3) -> DVec3]) -> Vec<u8> {
    let mesh = beadwright::example::find("cross").unwrap().mesh();
    let mut bytes = vec![0; 80];
    bytes.extend(((mesh.triangles.len() * place.len()) as u32).to_le_bytes());
    for place in place {
        for triangle in &mesh.triangles {
            bytes.extend([0_u8; 12]);
            let corners = triangle.map(|i| place(mesh.vertices[i as usize]).as_vec3().to_array());
            bytes.extend(corners.as_flattened().iter().flat_map(|v| v.to_le_bytes()));
            bytes.extend([0, 0]);
        }
    }
    bytes
}
