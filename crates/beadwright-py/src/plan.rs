//! A part and a profile become a plan.

use crate::error::Refuse;
use crate::layer::Layer;
use crate::part::Part;
use crate::planned::Planned;
use crate::profile::Profile;
use crate::running::Running;
use crate::save;
use beadwright::export::{self, Beads};
use beadwright::plan::choice::{self, Choice};
use beadwright::plan::{self as library, PlanError};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::convert::Infallible;
use std::path::PathBuf;
use std::sync::Arc;

/// A plan.
#[pyclass(frozen, module = "beadwright._core")]
pub(crate) struct Plan(pub(crate) Planned);

/// Plans a part. With `kept` the profile's strategy is used whatever the part looks like.
#[pyfunction]
#[pyo3(signature = (part, profile, kept, threads, progress))]
pub(crate) fn plan<'py>(
    py: Python<'py>,
    part: &Part,
    profile: &Profile,
    kept: bool,
    threads: Option<usize>,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Plan> {
    part.fits(profile.profile.bead.width).refuse(Some(&part.name))?;
    let work = |task: &_| -> Result<_, PlanError<Infallible>> {
        let Choice { profile, note } = choice::choose(&part.part, &profile.profile, kept, task)?;
        let plan = library::plan(&part.name, &*part.part, &profile, task)?;
        Ok((plan, profile, note))
    };
    let (plan, chosen, note) = Running::new(threads, progress).run(py, Some(&part.name), work)?;
    Ok(Plan(Planned {
        header: plan.header,
        layers: Arc::new(plan.layers),
        summary: plan.summary,
        note,
        profile: chosen,
        folder: profile.folder.clone(),
        part: part.part.clone(),
    }))
}

#[pymethods]
impl Plan {
    #[getter]
    fn part(&self) -> &str {
        &self.0.header.part
    }

    #[getter]
    fn profile(&self) -> &str {
        &self.0.header.profile
    }

    #[getter]
    fn strategy(&self) -> &str {
        &self.0.header.strategy
    }

    #[getter]
    fn layers(&self) -> Vec<Layer> {
        Layer::all(&self.0.layers)
    }

    /// The totals.
    #[getter]
    fn metrics<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let mut value = serde_json::json!(self.0.summary.metrics);
        value["coverage"] = self.0.summary.metrics.coverage().into();
        Ok(pythonize::pythonize(py, &value)?)
    }

    /// The summed events, each with its sentence.
    #[getter]
    fn warnings<'py>(&self, py: Python<'py>) -> PyResult<Vec<(Bound<'py, PyAny>, String)>> {
        let with_sentence = |w: &beadwright::warning::WarningSummary| Ok((pythonize::pythonize(py, w)?, w.sentence()));
        self.0.summary.warnings.summaries().map(with_sentence).collect()
    }

    /// What does not fit together in the profile, and why the strategy is not the profile's, as sentences.
    #[getter]
    fn notes(&self) -> Vec<String> {
        self.0.note.iter().chain(&self.0.summary.notes).cloned().collect()
    }

    /// Everything to report about the plan, the worst first, each with its sentence: as `beadwright plan` finds it.
    fn findings<'py>(
        &self,
        py: Python<'py>,
        threads: Option<usize>,
        progress: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Vec<(Bound<'py, PyAny>, String)>> {
        let all = Running::new(threads, progress).run(py, None, |task| save::findings(&self.0, task))?;
        all.iter().map(|finding| Ok((pythonize::pythonize(py, finding)?, finding.sentence()))).collect()
    }

    /// Why its programs should not be written; nothing for a plan that can be welded.
    #[getter]
    fn forbidden(&self) -> Vec<String> {
        self.0.summary.forbidden.clone()
    }

    /// The programs: the text of each file by its name.
    fn post(&self, py: Python<'_>, names: Vec<String>) -> PyResult<BTreeMap<String, String>> {
        let (profile, posts) = self.0.posts(names)?;
        Running::new(Some(1), None).run(py, None, |_| save::programs(&self.0, &profile, &posts))
    }

    /// Writes all files of the plan into a folder, and returns their names.
    #[pyo3(signature = (folder, names, deposit, allow_findings, threads, progress))]
    #[expect(clippy::too_many_arguments, reason = "the arguments of the Python method")]
    fn save<'py>(
        &self,
        py: Python<'py>,
        folder: PathBuf,
        names: Vec<String>,
        deposit: bool,
        allow_findings: bool,
        threads: Option<usize>,
        progress: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Vec<String>> {
        let (profile, posts) = self.0.posts(names)?;
        let wanted = save::Wanted { folder: &folder, profile: &profile, posts: &posts, deposit, allow_findings };
        Running::new(threads, progress).run(py, None, |task| save::save(&self.0, &wanted, task))
    }

    /// The bytes of a file in a format for other programs, by its extension.
    fn export(&self, py: Python<'_>, extension: &str) -> PyResult<Cow<'static, [u8]>> {
        let known = || export::FORMATS.iter().map(|format| format.extension).collect::<Vec<_>>().join(", ");
        let format = export::format(extension)
            .ok_or_else(|| PyValueError::new_err(format!("\"{extension}\" is not a format; use {}.", known())))?;
        let plan = &self.0;
        let beads = Beads { header: &plan.header, layers: &plan.layers, profile: &plan.profile, heat: None };
        Ok(Running::new(None, None).run(py, None, |_| (format.write)(&beads))?.into())
    }
}
