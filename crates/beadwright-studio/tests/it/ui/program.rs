//! The program beside the torch: its line is marked, and a line that is clicked takes the torch there.

use crate::window::{Window, click, example, has_adapter, open_list, sees, slide, wait};
use egui_kittest::kittest::Queryable;
use std::path::Path;

/// Where the torch is, in the program too.
fn now(harness: &mut Window) -> f64 {
    let view = harness.state_mut().view().clone();
    view.now(&harness.state().plan().scene)
}

#[test]
fn the_program_follows_the_torch_and_the_torch_the_program() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = example(folder.path(), "cross");
    click(&mut harness, "Program");
    wait(&mut harness);
    let total = harness.state().plan().scene.total_seconds();
    slide(&mut harness, "Program time", 0.35 * total);
    harness.run_steps(3);
    // Layer 4 of 10 lies at 8 mm.
    assert!(harness.query_all_by_label_contains("Z 8.000").count() > 3, "the lines of the torch are not in view");
    if has_adapter() {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("program.png");
        harness.render().unwrap().save(path).unwrap();
    }
    // Lines further down are done later.
    let before = now(&mut harness);
    let lines: Vec<_> = harness.query_all_by_label_contains("LIN {X").collect();
    lines[lines.len() - 4].click();
    harness.run_steps(3);
    let after = now(&mut harness);
    assert!(after > before && after < before + 300.0, "{before} s, then {after} s");
    assert!(harness.state_mut().view().torch.is_some());
    // Other files can be read, too, and the torch followed again.
    open_list(&mut harness, "File of the program");
    click(&mut harness, "CROSS.dat");
    assert!(harness.query_by_label_contains("DEFDAT").is_some());
    open_list(&mut harness, "File of the program");
    click(&mut harness, "the one that the torch is in");
    assert!(harness.query_all_by_label_contains("LIN {X").next().is_some());
    // A dialect that the profile has no section for says so.
    open_list(&mut harness, "Dialect");
    click(&mut harness, "rapid");
    wait(&mut harness);
    assert!(harness.query_by_label_contains("[rapid]").is_some() && !sees(&harness, "CROSS.src"));
}
