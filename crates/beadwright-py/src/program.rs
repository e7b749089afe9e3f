//! A program from any source, read back as layers and judged, as the command does.

use crate::error::raise;
use crate::judge::Judged;
use crate::part::Part;
use crate::profile::Profile;
use crate::running::Running;
use beadwright::compare;
use beadwright::dialect;
use beadwright::dialect::reading::{self, Fault};
use beadwright::read_back::{self, ReadBack};
use pyo3::prelude::*;

/// How a program is read: codes that strike and end the arc, the bead's width (mm), and whether the profile was chosen.
type Reading = (Vec<String>, Vec<String>, Option<f64>, bool);

/// The language of a program, if a line of it shows it.
#[pyfunction]
pub(crate) fn language(text: &str) -> Option<&'static str> {
    reading::recognise(text).map(|dialect| dialect.language)
}

/// Whether a file may be the module `name` of a program, in any language.
#[pyfunction]
pub(crate) fn may_be_module(file: &str, name: &str) -> bool {
    dialect::may_be_module(file, name)
}

/// The built-in profile that a program of ours names in its first comments.
#[pyfunction]
pub(crate) fn named_profile(text: &str) -> Option<&'static str> {
    read_back::named_profile(text)
}

/// Reads a program; `module` (Python) gives the text of a module by its name, or none.
fn read_back(
    py: Python<'_>,
    name: &str,
    text: &str,
    module: &Py<PyAny>,
    profile: &Profile,
    reading: Reading,
    part: Option<&Part>,
) -> PyResult<ReadBack> {
    let profile = &*profile.profile;
    let mesh = part.and_then(|part| part.part.mesh());
    let mut raised = None;
    let mut find = |name: &str| {
        let found = Python::attach(|py| module.call1(py, (name,))?.extract::<Option<String>>(py));
        found.unwrap_or_else(|error| {
            raised = Some(error);
            None
        })
    };
    let (arc_on, arc_off, bead_width, profile_chosen) = reading;
    let reading = read_back::Reading { arc_on, arc_off, bead_width, profile_chosen };
    let back = Running::new(None, None)
        .run(py, Some(name), |task| ReadBack::program(name, text, &mut find, profile, &reading, mesh, task));
    raised.map_or(back, Err)
}

/// The dangerous lines of a program, and those that a controller would refuse, each with its sentence.
#[pyfunction]
pub(crate) fn faults<'py>(
    py: Python<'py>,
    name: &str,
    text: &str,
    module: Py<PyAny>,
    profile: &Profile,
    reading: Reading,
) -> PyResult<Vec<(Bound<'py, PyAny>, String)>> {
    let value = |fault: &Fault| {
        let module = fault.place.as_ref().and_then(|place| place.module.clone());
        let line = fault.place.as_ref().map(|place| place.line);
        serde_json::json!({
            "kind": fault.kind.name, "module": module, "line": line, "count": fault.count, "text": fault.text,
            "remedy": fault.kind.remedy,
        })
    };
    let back = read_back(py, name, text, &module, profile, reading, None)?;
    back.faults.iter().map(|fault| Ok((pythonize::pythonize(py, &value(fault))?, fault.to_string()))).collect()
}

/// Reads a program and judges what it would build; `module` (Python) gives the text of a module by its name, or none.
#[pyfunction]
#[pyo3(signature = (name, text, module, profile, reading, part, grid, threads, progress))]
#[expect(clippy::too_many_arguments, reason = "the arguments of the Python function")]
pub(crate) fn simulate<'py>(
    py: Python<'py>,
    name: &str,
    text: &str,
    module: Py<PyAny>,
    profile: &Profile,
    reading: Reading,
    part: Option<&Part>,
    grid: Option<f64>,
    threads: Option<usize>,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Judged> {
    let back = read_back(py, name, text, &module, profile, reading, part)?;
    let settings = back.deposit_settings(grid).map_err(|error| raise(&error.to_string(), Some("grid"), None))?;
    let ReadBack { layers, totals, notes, faults, .. } = back;
    let entry = Running::new(threads, progress)
        .run(py, Some(name), |task| compare::program(name, &layers, totals, settings, &None, task))?;
    let faults = faults.iter().map(Fault::to_string).collect();
    Ok(Judged { entry, notes, faults })
}
