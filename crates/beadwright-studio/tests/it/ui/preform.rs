//! A part is planned as its preform, in which the part is seen in the colours of what is milled off.

use crate::window::{click, example, sees, wait};

#[test]
fn a_part_is_planned_as_its_preform_and_again_as_drawn() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = example(folder.path(), "cross");
    let height = |harness: &crate::window::Window| harness.state().plan().part.as_ref().unwrap().bounds().1.z;
    let as_drawn = height(&harness);
    assert!(!sees(&harness, "Part in the preform"));
    click(&mut harness, "Preform");
    wait(&mut harness);
    // 4 mm for the saw, 1.5 below and 2 above the part, in steps.
    assert!((height(&harness) - as_drawn - 7.5).abs() < 1.5, "{}", height(&harness));
    assert!(harness.state().plan().summary.is_some() && harness.state().project().preform);
    harness.key_press(eframe::egui::Key::Num7);
    harness.run_steps(3);
    click(&mut harness, "Part in the preform");
    assert!(sees(&harness, "metal to mill off: 0"));
    click(&mut harness, "Preform");
    wait(&mut harness);
    assert!(!sees(&harness, "Part in the preform"));
    assert_eq!(height(&harness), as_drawn);
}
