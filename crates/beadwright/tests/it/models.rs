//! Real parts from `BEADWRIGHT_MODELS` (else `shared/models` beside the workspace): all are imported and cut.

use crate::common;

use beadwright::model::import;
use beadwright::slice::{Slice, SliceOptions, Slicer};
use beadwright::task::Task;
use beadwright::warning::WarningKind;
use common::models;
use glam::DVec3;
use std::fs;
use std::path::{Path, PathBuf};

/// Closed, and no solid inside another: sections and volume must agree.
const SOLID: [&str; 13] = [
    "body_structure_top.stl",
    "branches16.stl",
    "bunny_closed.stl",
    "cube_invalid_unicode.stl",
    "featuretype.stl",
    "moon_chinese_header.stl",
    "openthruster_prop_cw.stl",
    "plate_holes.stl",
    "pulley_t30.stl",
    "rear_case.stl",
    "star_ascii.stl",
    "star_empty_header.stl",
    "two_objects_mixed_case.stl",
];

/// Files that must be refused, and a word of the reason.
const REFUSED: [(&str, &str); 1] = [("pulley_t30_truncated.stl", "cut short")];

fn paths() -> Vec<PathBuf> {
    let entries = fs::read_dir(models()).expect("BEADWRIGHT_MODELS names the folder of shared models");
    let mut paths: Vec<PathBuf> = entries.map(|e| e.unwrap().path()).collect();
    paths.sort();
    paths
}

fn name(path: &Path) -> String {
    path.file_name().unwrap().to_string_lossy().into_owned()
}

/// The part enlarged to 200 mm in 200 layers.
fn sliced(mesh: &mut beadwright::model::Mesh) -> Vec<Slice> {
    mesh.place(200.0 / mesh.size().max_element(), DVec3::ZERO);
    let options = SliceOptions { layer_height: mesh.size().z / 200.0, close_gap: 0.5, simplify: 0.01 };
    Slicer::new(mesh, options, &Task::new()).unwrap().all(&Task::new()).unwrap()
}

/// Imports and cuts one file; whether sections and volume were compared.
fn check(path: &Path) -> bool {
    let name = name(path);
    let import = match import(&fs::read(path).unwrap(), &Task::new()) {
        Ok(import) => import,
        Err(error) => {
            let reason = REFUSED.iter().find(|(refused, _)| *refused == name);
            let (_, word) = reason.unwrap_or_else(|| panic!("{name} was refused: {error}"));
            assert!(error.to_string().contains(word), "{name}: {error}");
            return false;
        }
    };
    assert!(REFUSED.iter().all(|(refused, _)| *refused != name), "{name} was not refused");
    let (mut mesh, repair) = (import.mesh, import.repair);
    let layers = sliced(&mut mesh);
    // A part that is no solid either gives islands or reports what was dropped.
    assert!(layers.iter().any(|l| !l.islands.is_empty() || !l.warnings.is_empty()), "{name}: {repair:?}");
    let is_closed = repair.open_edges == 0 && repair.non_manifold_edges == 0;
    let overlaps = layers.iter().flat_map(|l| &l.warnings).any(|w| w.kind == WarningKind::ContoursUnited);
    let sections: f64 = layers.iter().map(|l| l.area() * l.height).sum();
    let ratio = sections / mesh.volume();
    eprintln!("{name}: {} layers, sections / volume {ratio:.4}, closed {is_closed}, overlaps {overlaps}", layers.len());
    if !is_closed || overlaps {
        return false;
    }
    assert_eq!(layers.iter().flat_map(|l| &l.warnings).next(), None, "{name}: a closed part has nothing to warn of");
    assert!((ratio - 1.0).abs() < 0.01, "{name}: sections have {ratio} of the volume");
    true
}

#[test]
#[cfg_attr(no_models, ignore = "no shared models")]
fn every_model_is_cut_or_refused() {
    let paths = paths();
    let stl = paths.iter().filter(|p| p.extension().is_some_and(|e| e.eq_ignore_ascii_case("stl")));
    for path in stl {
        let compared = check(path);
        assert!(compared || !SOLID.contains(&name(path).as_str()), "{} is a solid", name(path));
    }
}

#[test]
#[cfg_attr(no_models, ignore = "no shared models")]
fn models_in_other_formats_are_recognised() {
    for path in paths() {
        let expect = match path.extension().and_then(|e| e.to_str()) {
            Some("step") => "a STEP file",
            Some("iges" | "igs") => "an IGES file",
            _ => continue,
        };
        let error = import(&fs::read(&path).unwrap(), &Task::new()).unwrap_err().to_string();
        assert!(error.contains(expect), "{}: {error}", name(&path));
    }
}
