//! Exports opened by the programs that they are meant for: VTK and pyarrow.

use crate::common::ok;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

/// Python with the packages in the folder that BEADWRIGHT_PYTHON_PACKAGES names, besides its own.
pub(crate) fn python(folder: &Path, arguments: &[&str]) -> std::io::Result<Output> {
    let mut python = Command::new("python3");
    if let Some(packages) = std::env::var_os("BEADWRIGHT_PYTHON_PACKAGES") {
        python.env("PYTHONPATH", packages);
    }
    python.current_dir(folder).args(arguments).output()
}

/// Whether both can be imported; where a folder with them is named, they must.
fn there(folder: &Path) -> bool {
    let asked = python(folder, &["-c", "import vtkmodules.vtkIOXML, vtkmodules.vtkFiltersVerdict, pyarrow.parquet"]);
    if asked.is_ok_and(|output| output.status.success()) {
        return true;
    }
    assert!(
        std::env::var_os("BEADWRIGHT_PYTHON_PACKAGES").is_none(),
        "pip install vtk pyarrow: exports are opened with them"
    );
    eprintln!("not opened: vtk and pyarrow are not installed (BEADWRIGHT_PYTHON_PACKAGES names a folder with them)");
    false
}

#[test]
fn sums_are_those_of_the_plan_and_tables_are_equal() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    if !there(at) {
        return;
    }
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/opened_elsewhere.py");
    for (part, profile) in [("cross", "cmt-al2319-kuka"), ("vase", "cmt-steel-abb"), ("star", "cmt-steel-robots")] {
        ok(at, &["example", part, "-o", "part.stl"]);
        ok(at, &["plan", "part.stl", "-p", profile, "--no-deposit", "-o", "out"]);
        for file in ["beads.vtp", "beads.parquet", "beads.csv"] {
            ok(at, &["export", "out/plan.json", "-o", file]);
        }
        let said = python(at, &[script, "beads.vtp", "beads.parquet", "beads.csv"]).unwrap();
        assert!(said.status.success(), "{part}: {}", String::from_utf8_lossy(&said.stderr));
        let seen: serde_json::Value = serde_json::from_slice(&said.stdout).unwrap();
        let json =
            |file: &str| -> serde_json::Value { serde_json::from_slice(&fs::read(at.join(file)).unwrap()).unwrap() };
        let (metrics, plan) = (json("out/metrics.json"), json("out/plan.json"));
        // Paces of some mm/s have four decimals in a plan, and most passes of a part may have the same pace.
        let near = |a: f64, b: f64| (a - b).abs() <= 1e-5 * b;
        let number = |value: &serde_json::Value| value.as_f64().unwrap();
        // The arc also burns in craters, where the torch stands.
        let crater = number(&plan["profile"]["start_stop"]["crater_fill_time"]) * number(&metrics["passes"]);
        assert!(near(number(&seen["length"]), number(&metrics["deposited_length_mm"])), "{part}: {seen} {metrics}");
        assert!(near(number(&seen["time"]) + crater, number(&metrics["arc_time_s"])), "{part}: {seen} {metrics}");
        assert_eq!((&seen["layers"], &seen["passes"]), (&metrics["layers"], &metrics["passes"]), "{part}");
        // Texts have four decimals for places and six for the rest.
        assert_eq!((&seen["rows"], seen["names"].as_bool()), (&seen["lines"], Some(true)), "{part}");
        for (name, apart) in seen["apart"].as_object().unwrap() {
            assert!(apart.as_f64().is_some_and(|apart| apart <= 0.51e-4), "{part}, {name}: {apart}");
        }
    }
}
