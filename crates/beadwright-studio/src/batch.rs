//! Several models, planned one after another as the window would plan each, and what is worst about them.

use crate::computing::Computing;
use crate::planner;
use crate::project::{Project, Source};
use crate::state::PlanState;
use beadwright::finding::{Finding, Severity};
use beadwright::task::Task;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// Extensions of the files of a folder that are planned; others are passed over.
const MODELS: [&str; 9] = ["stl", "3mf", "obj", "ply", "amf", "igs", "iges", "dxf", "svg"];

/// What is worst about a plan.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// Nothing was found.
    Good,
    /// Something is doubtful.
    Doubtful,
    /// Something is serious.
    Serious,
    /// Its program may not be written.
    Forbidden,
}

/// The figures of a plan.
#[derive(Debug, Clone, PartialEq)]
pub struct Figures {
    /// Wire, kg.
    pub mass: f64,
    /// Time of the program, s.
    pub seconds: f64,
    /// Number of arc starts.
    pub starts: usize,
    /// What is worst.
    pub verdict: Verdict,
    /// The worst finding; none where nothing was found.
    pub worst: Option<Finding>,
}

/// How far a model has come.
#[derive(Debug, Clone, PartialEq)]
pub enum Come {
    /// It has not begun.
    Waits,
    /// It is being planned.
    Runs,
    /// It is planned.
    Planned(Figures),
    /// It cannot be planned: why.
    Failed(String),
}

/// A model of a batch.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Its file.
    pub path: PathBuf,
    /// How far it has come.
    pub come: Come,
}

impl Row {
    /// The name of its file.
    pub fn name(&self) -> String {
        self.path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned())
    }

    /// Whether nothing more will come of it.
    pub fn is_done(&self) -> bool {
        matches!(self.come, Come::Planned(_) | Come::Failed(_))
    }
}

/// Models being planned, or planned.
pub(crate) struct Batch {
    /// The name of their profile.
    pub(crate) profile: String,
    rows: Arc<Mutex<Vec<Row>>>,
    /// None once it is given up.
    pub(crate) run: Option<Computing<()>>,
}

impl Batch {
    /// The models of these files, with the profile of a project, to be planned by the work that is returned.
    pub(crate) fn of(
        paths: Vec<PathBuf>,
        project: &Project,
        profile: String,
    ) -> (Self, impl FnOnce(&Task) -> Result<(), String> + Send + 'static) {
        let rows: Vec<Row> = paths.iter().map(|path| Row { path: path.clone(), come: Come::Waits }).collect();
        let rows = Arc::new(Mutex::new(rows));
        let (shared, project) = (rows.clone(), project.clone());
        let work = move |task: &Task| {
            for (number, path) in paths.into_iter().enumerate() {
                set(&shared, number, Come::Runs);
                let alone = Project {
                    source: Some(Source::File(path)),
                    profile: project.profile.clone(),
                    preform: project.preform,
                    ..Project::default()
                };
                let come = planned(&alone, task).map_or_else(Come::Failed, Come::Planned);
                task.check().map_err(|error| error.to_string())?;
                set(&shared, number, come);
            }
            Ok(())
        };
        (Self { profile, rows, run: None }, work)
    }

    /// Its rows as far as they have come.
    pub(crate) fn rows(&self) -> Vec<Row> {
        self.rows.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Whether models are being planned.
    pub(crate) fn runs(&self) -> bool {
        self.run.as_ref().is_some_and(|run| run.progress().is_some())
    }
}

fn set(rows: &Mutex<Vec<Row>>, number: usize, come: Come) {
    if let Some(row) = rows.lock().unwrap_or_else(PoisonError::into_inner).get_mut(number) {
        row.come = come;
    }
}

/// The models in a folder, by name.
///
/// # Errors
/// A sentence: the folder cannot be read, or holds none.
#[cfg(not(target_arch = "wasm32"))]
pub(crate) fn models(folder: &Path) -> Result<Vec<PathBuf>, String> {
    let unread = |error: std::io::Error| format!("{}: {error}.", folder.display());
    let is_model = |path: &PathBuf| {
        let packed = path.extension().is_some_and(|end| end.eq_ignore_ascii_case("gz"));
        let name = if packed { path.with_extension("") } else { path.clone() };
        let end = name.extension().map(|end| end.to_string_lossy().to_lowercase());
        end.is_some_and(|end| MODELS.contains(&&*end)) && path.is_file()
    };
    let entries = std::fs::read_dir(folder).map_err(unread)?;
    let paths = entries.map(|entry| entry.map(|entry| entry.path())).collect::<Result<Vec<_>, _>>().map_err(unread)?;
    let mut models: Vec<PathBuf> = paths.into_iter().filter(is_model).collect();
    models.sort();
    let kinds = MODELS.map(str::to_uppercase).join(", ");
    if models.is_empty() { Err(format!("{}: there is no model here ({kinds}).", folder.display())) } else { Ok(models) }
}

/// A browser shows no folders.
#[cfg(target_arch = "wasm32")]
pub(crate) fn models(folder: &Path) -> Result<Vec<PathBuf>, String> {
    Err(format!("{}: folders cannot be read in a browser ({}).", folder.display(), MODELS.join(", ")))
}

/// Plans a project as the window would.
fn planned(project: &Project, task: &Task) -> Result<Figures, String> {
    let plan = Mutex::new(PlanState::default());
    planner::plan_alone(project, task, &|event| plan.lock().unwrap_or_else(PoisonError::into_inner).take(event));
    let plan = plan.into_inner().unwrap_or_else(PoisonError::into_inner);
    if let Some(failure) = plan.failure {
        return Err(failure.sentence().to_owned());
    }
    let summary = plan.summary.as_ref().ok_or("it was not planned.")?;
    let refused = |text: &String| Finding::new("refused", Severity::Serious, text.clone());
    let worst = plan.reported.first().filter(|finding| finding.severity < Severity::Note);
    let verdict = match worst {
        _ if !summary.forbidden.is_empty() => Verdict::Forbidden,
        Some(finding) if finding.severity == Severity::Serious => Verdict::Serious,
        Some(_) => Verdict::Doubtful,
        None => Verdict::Good,
    };
    Ok(Figures {
        mass: summary.metrics.wire_mass_kg,
        seconds: summary.metrics.total_time_s,
        starts: summary.metrics.arc_starts,
        verdict,
        worst: summary.forbidden.first().map(refused).or(worst.cloned()),
    })
}
