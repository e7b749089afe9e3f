//! Anyone's program, read back as layers and judged, as the command does.

use crate::error::exception;
use crate::judge::{Judged, extent, fitted};
use crate::part::Part;
use crate::profile::Profile;
use crate::running::Running;
use beadwright::compare::{self, Totals};
use beadwright::dialect::reading::{self, Fault, Metal, ReadError, ReadProgram};
use beadwright::profile::{self, BUILT_IN};
use beadwright::{Layer, Mesh, Task, plan, simulate as library};
use pyo3::prelude::*;

/// How a program is read: codes that light and end the arc, and the bead's width (mm), where they are told.
type Reading = (Vec<String>, Vec<String>, Option<f64>);

/// The language of a program, if a line of it tells.
#[pyfunction]
pub(crate) fn language(text: &str) -> Option<&'static str> {
    reading::recognise(text).map(|dialect| dialect.language)
}

/// The built-in profile that a program of ours names in its first comments.
#[pyfunction]
pub(crate) fn told_profile(text: &str) -> Option<&'static str> {
    const HEAD: usize = 40;
    let told = |line: &str| {
        let line = line.trim_end_matches(|c: char| !c.is_ascii_alphanumeric()).to_ascii_lowercase();
        BUILT_IN.iter().map(|(name, _)| *name).find(|name| line.strip_suffix(name).is_some_and(|l| l.ends_with(", ")))
    };
    text.lines().take(HEAD).find_map(told)
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
    let profile = &*profile.profile;
    let mesh = part.and_then(|part| part.part.mesh());
    let mut raised = None;
    let mut find = |name: &str| {
        let told = Python::attach(|py| module.call1(py, (name,))?.extract::<Option<String>>(py));
        told.unwrap_or_else(|error| {
            raised = Some(error);
            None
        })
    };
    let program = read(text, &mut find, profile, &reading);
    if let Some(error) = raised {
        return Err(error);
    }
    let program = program.map_err(|error| exception(&error, Some(name)))?;
    let (mut loaded, judged_with) = (Loaded::of(program, profile, reading.2), plan::deposit_settings(profile));
    Running::new(threads, None).run(py, Some(name), |task| loaded.outline(mesh, profile, task))?;
    let settings = fitted(grid, judged_with, &extent(&loaded.layers), loaded.layers.len())?;
    let Loaded { layers, totals, notes, faults } = loaded;
    let entry = Running::new(threads, progress)
        .run(py, Some(name), |task| compare::program(name, &layers, totals, settings, &None, task))?;
    Ok(Judged { entry, notes, faults })
}

/// The moves, with the codes given and those of the profile's templates.
fn read(
    text: &str,
    module: &mut reading::FindModule<'_>,
    profile: &profile::Profile,
    (on, off, _): &Reading,
) -> Result<ReadProgram, ReadError> {
    let mut options = profile.reading_options(None, None);
    options.arc.on.splice(0..0, on.iter().cloned());
    options.arc.off.splice(0..0, off.iter().cloned());
    reading::read(text, module, &options)
}

/// A program as layers.
struct Loaded {
    layers: Vec<Layer>,
    totals: Totals,
    notes: Vec<String>,
    faults: Vec<String>,
}

impl Loaded {
    fn of(mut program: ReadProgram, profile: &profile::Profile, bead_width: Option<f64>) -> Self {
        let settings = plan::deposit_settings(profile);
        let layers = library::layers(&program, &settings, &profile.bead.law, &profile.process, bead_width);
        let mut notes = program.notes.clone();
        let printer = program.moves.iter().any(|step| matches!(step.metal, Metal::Volume(_)));
        if profile.process.follow == beadwright::process::Follow::WireFeed && !printer {
            notes.push(
                "The profile changes the wire feed along a pass (process.follow), and programs' wire feeds are not read: all \
                 beads are judged with the nominal one."
                    .to_owned(),
            );
        }
        let (rapids, length) = program.take_rapids_at(profile.travel.speed);
        if rapids > 0 {
            let (metres, speed) = (length / 1e3, profile.travel.speed);
            notes.push(format!("{rapids} moves tell no speed, {metres:.2} m; travel.speed, {speed} mm/s, is taken."));
        }
        let mut totals = Totals::of_program(&program.totals(), &layers, profile);
        if let Some(motion) = &profile.motion {
            totals.total_time_s = program.seconds(motion);
        }
        let faults = program.faults.iter().map(Fault::to_string).collect();
        Self { layers, totals, notes, faults }
    }

    /// Gives the layers the slices of the part, over whose middle the program is moved where it lies elsewhere.
    fn outline(
        &mut self,
        mesh: Option<&Mesh>,
        profile: &profile::Profile,
        task: &Task,
    ) -> Result<(), beadwright::task::Cancelled> {
        let Some(mesh) = mesh else { return Ok(()) };
        if let Some(by) = library::shift(&self.layers, mesh, &plan::deposit_settings(profile)) {
            library::translate(&mut self.layers, by);
            self.notes.push(format!(
                "The program was moved by x {:.2} y {:.2} mm, so that its middle is the part's.",
                by.x, by.y
            ));
        }
        library::outline(&mut self.layers, mesh, profile.slice_options(), task)
    }
}
