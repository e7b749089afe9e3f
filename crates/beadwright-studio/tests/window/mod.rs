//! The program without a screen, as a person would use it.
#![allow(dead_code)]

use beadwright_studio::Studio;
use beadwright_studio::settings::Store;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use std::path::Path;
use std::time::{Duration, Instant};

/// Longest wait for a plan.
const PATIENCE: Duration = Duration::from_secs(120);

pub(crate) fn studio(store: &Path) -> Harness<'static, Studio> {
    let store = Store::at(store.to_owned());
    let mut harness = Harness::builder()
        .with_size([1280.0, 800.0])
        .with_max_steps(64)
        .wgpu()
        .build_eframe(move |cc| Studio::new(cc, store));
    harness.run_steps(2);
    harness
}

/// Runs until nothing is under way.
pub(crate) fn wait(harness: &mut Harness<'static, Studio>) {
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
pub(crate) fn click(harness: &mut Harness<'static, Studio>, label: &str) {
    harness.get_by_label(label).click();
    harness.run_steps(3);
}
