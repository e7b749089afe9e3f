//! Robot cells in the window: what stands around the part, and what does not fit the profile.

use crate::window::{Window, press, sees, slide, studio, wait};
use beadwright::example;
use beadwright_studio::actions::Action;
use eframe::egui::Key;
use std::path::{Path, PathBuf};

/// An example with the robot of a cell, on a positioner or not.
fn shown(store: &Path, part: &str, cell: &'static str, positioner: Option<&str>) -> Window {
    let mut harness = studio(store);
    if let Some(chart) = example::find(part).unwrap().chart {
        harness.state_mut().set_value("layers.chart", chart);
    }
    if let Some(positioner) = positioner {
        harness.state_mut().set_value("program.positioner", positioner);
    }
    harness.state_mut().open_example(part);
    wait(&mut harness);
    harness.state_mut().act(Action::TakeCell(cell));
    harness.state_mut().view().robot = true;
    press(&mut harness, Key::F2);
    wait(&mut harness);
    harness
}

const DKP: &str = r#"{ turning = "follow", machine = "kuka-dkp-400" }"#;

#[test]
fn a_cell_that_does_not_fit_the_profile_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let dialect =
        "The profile writes krl, but this robot reads urscript: choose a cell or a process of the same robot.";
    let positioner = "The profile turns the part on a positioner that this cell does not describe: whether the part lies where the \
                      cell has it must be measured.";
    let mut harness = shown(folder.path(), "cross", "kuka-kr20-r1810", None);
    assert!(!sees(&harness, dialect) && !sees(&harness, positioner));
    harness.state_mut().act(Action::TakeCell("ur10e"));
    wait(&mut harness);
    assert!(sees(&harness, dialect));
    harness.state_mut().set_value("program.positioner", DKP);
    harness.state_mut().act(Action::TakeCell("kuka-kr20-r1810"));
    wait(&mut harness);
    wait(&mut harness);
    assert!(sees(&harness, positioner) && !sees(&harness, dialect));
}

/// Pictures to look at: `cargo test -p beadwright-studio --test it -- ui::robots::pictures --ignored`.
#[test]
#[ignore = "for looking"]
fn pictures() {
    let folder = tempfile::tempdir().unwrap();
    let lying = r#"{ turning = "follow", machine = "head-tailstock" }"#;
    let cells = [
        ("kuka", "propeller", "kuka-kr20-r1810", None),
        ("abb", "propeller", "abb-irb1410", None),
        ("fanuc", "propeller", "fanuc-arc-mate-100id", None),
        ("ur", "cross", "ur10e", None),
        ("dkp", "elbow", "kuka-kr20-r1810", Some(DKP)),
        ("lying", "hub", "yaskawa-ar2010", Some(lying)),
    ];
    for (what, part, cell, positioner) in cells {
        let light = what == "abb" || what == "lying";
        let mut harness = shown(folder.path(), part, cell, positioner);
        if light {
            harness.state_mut().act(Action::Theme);
        }
        for (name, key, last) in [("a", Key::Num0, 12.0), ("b", Key::Num1, 40.0)] {
            harness.key_press(key);
            slide(&mut harness, "Last layer", last);
            harness.key_press(Key::F);
            harness.run_steps(6);
            let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("robots-{what}-{name}.png"));
            harness.render().unwrap().save(&path).unwrap();
            println!("{}", path.display());
        }
    }
}
