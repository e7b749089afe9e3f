//! A scan of the built part is seen over the part, in the colours of its deviation, and taken away again.

use crate::window::{Window, click, example, has_adapter, sees, wait};
use beadwright_studio::view3d::{Colour, palette};
use egui_kittest::kittest::Queryable;
use glam::DVec3;
use std::path::{Path, PathBuf};

/// Points of a lattice over an arm of the cross, whose upper face lies 20 mm above the plate; each `by(x, y)` mm above that.
fn scan(folder: &Path, by: fn(f64, f64) -> f64) -> PathBuf {
    let lattice = (-49..=49).flat_map(|x| (-17..=17).map(move |y| (f64::from(x), f64::from(y))));
    let lines: String = lattice.map(|(x, y)| format!("{x},{y},{}\n", 20.0 + by(x, y))).collect();
    let path = folder.join("scan.csv");
    std::fs::write(&path, lines).unwrap();
    path
}

/// A surface over that arm at one height, mm.
fn surface(folder: &Path, z: f64) -> PathBuf {
    let corners = [(-49.0, -17.0), (49.0, -17.0), (49.0, 17.0), (-49.0, 17.0)];
    let vertices: String = corners.iter().map(|(x, y)| format!("{x} {y} {z}\n")).collect();
    let head = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
                element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    let path = folder.join(format!("scan {z}.ply"));
    std::fs::write(&path, format!("{head}{vertices}4 0 1 2 3\n")).unwrap();
    path
}

fn open(harness: &mut Window, path: &Path) {
    harness.state_mut().open_scan(path);
    wait(harness);
}

#[test]
fn the_figures_of_a_scan_are_shown_and_taken_away() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = example(&folder.path().join("store"), "cross");
    assert!(!sees(&harness, "Close the scan"));
    open(&mut harness, &scan(folder.path(), |x, _| if x < 0.0 { -0.25 } else { 0.75 }));
    // 49 of the 99 columns are too low.
    let (low, high) = (49.0 / 99.0, 50.0 / 99.0);
    let mean = 0.75 * high - 0.25 * low;
    assert!(sees(&harness, &format!("mean {mean:+.2} ± 0.50 mm")));
    assert!(sees(&harness, "outside up to +0.75 mm") && sees(&harness, "inside up to -0.25 mm"));
    assert!(sees(&harness, "metal missing: 49 %") && sees(&harness, "-0.75 mm") && sees(&harness, "+0.75 mm"));
    // Half a millimetre more to be milled off: compared anew with the allowance.
    harness.state_mut().set_value("fill.machining_allowance", "1.0");
    wait(&mut harness);
    assert!(sees(&harness, "within the allowance 0–1 mm: 51 %"));
    click(&mut harness, "Close the scan");
    assert!(!sees(&harness, "scan.csv") && harness.state().scan().is_none());
    // The next part has none either.
    open(&mut harness, &scan(folder.path(), |_, _| 0.5));
    assert!(harness.state().scan().is_some());
    harness.state_mut().open_example("plate");
    wait(&mut harness);
    assert!(harness.state().scan().is_none());
}

#[test]
fn a_scan_that_cannot_be_compared_says_why() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = example(&folder.path().join("store"), "cross");
    let path = folder.path().join("empty.csv");
    std::fs::write(&path, "x,y,z\n").unwrap();
    open(&mut harness, &path);
    assert!(harness.query_by_label_contains("the scan holds no points").is_some());
    open(&mut harness, &scan(folder.path(), |_, _| 500.0));
    assert!(harness.query_by_label_contains("off the part's surface").is_some());
    let harness = &mut crate::window::studio(&folder.path().join("other"));
    open(harness, &path);
    assert!(sees(harness, "A scan is compared with a solid part: open one first."));
}

#[test]
fn a_scan_has_the_colours_of_its_deviation() {
    if !has_adapter() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let mut harness = example(&folder.path().join("store"), "cross");
    harness.key_press(eframe::egui::Key::Num7);
    harness.run_steps(3);
    let middle = |harness: &mut Window| {
        harness.remove_cursor();
        harness.run_steps(4);
        let place = harness.get_by_label("3-D view").rect().center();
        let picture = harness.render().unwrap();
        // On an arm, beside the red and green lines of the axes.
        let [r, g, b, _] = picture.get_pixel(place.x as u32 + 60, place.y as u32 + 10).0;
        DVec3::new(r.into(), g.into(), b.into())
    };
    let (above, below) = (palette::at(Colour::HeightError, 1.0), palette::at(Colour::HeightError, 0.0));
    for (path, wanted) in [
        (surface(folder.path(), 20.5), above),
        (surface(folder.path(), 19.5), below),
        (scan(folder.path(), |x, _| if x < 0.0 { -0.4 } else { 0.4 }), above),
    ] {
        open(&mut harness, &path);
        // Lit, but of that hue.
        let (seen, wanted) = (middle(&mut harness).normalize(), DVec3::from(wanted.map(f64::from)).normalize());
        assert!(seen.dot(wanted) > 0.93, "{}: {seen} is not {wanted}", path.display());
    }
    let with = middle(&mut harness);
    click(&mut harness, "Scan");
    assert!(middle(&mut harness).distance(with) > 30.0, "the beads are not seen again");
}
