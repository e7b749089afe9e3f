//! Programs and plans read back: files, their modules, and the part they were made for.

use crate::model;
use anyhow::Context;
use beadwright::compare::Totals;
use beadwright::deposit::DepositSettings;
use beadwright::dialect::inform::InformSpeed;
use beadwright::dialect::reading::{self, ArcCodes};
use beadwright::layer::Layer;
use beadwright::metrics::Metrics;
use beadwright::model::Import;
use beadwright::plan;
use beadwright::plan_file;
use beadwright::profile::Profile;
use beadwright::simulate;
use beadwright::task::Task;
use std::fs;
use std::path::{Path, PathBuf};

/// How a program is read.
#[derive(clap::Args, Default)]
pub(crate) struct Reading {
    /// Words that strike the arc, besides those of the language and of the profile, such as --arc-on "M64 P1".
    #[arg(long, value_name = "CODE")]
    arc_on: Vec<String>,
    /// Words that end the arc, besides those of the language and of the profile.
    #[arg(long, value_name = "CODE")]
    arc_off: Vec<String>,
    /// Bead width, mm, instead of the one from the program or the profile.
    #[arg(long, value_name = "MM")]
    bead_width: Option<f64>,
}

/// A program or plan as layers.
pub(crate) struct Loaded {
    pub(crate) name: String,
    pub(crate) language: &'static str,
    pub(crate) layers: Vec<Layer>,
    pub(crate) totals: Totals,
    pub(crate) settings: DepositSettings,
    pub(crate) notes: Vec<String>,
}

impl Reading {
    /// Reads a program or a plan.json. With a part, its slices become the islands of the layers.
    pub(crate) fn load(
        &self,
        path: &Path,
        profile: &Profile,
        part: Option<&Import>,
        task: &Task,
    ) -> anyhow::Result<Loaded> {
        let bytes = fs::read(path).with_context(|| format!("{}", path.display()))?;
        let text = String::from_utf8_lossy(&bytes);
        let name = path.file_name().map_or_else(String::new, |n| n.to_string_lossy().into_owned());
        if text.trim_start().starts_with('{') {
            return load_plan(&name, &text, profile).with_context(|| format!("{}", path.display()));
        }
        let folder = path.parent().map_or_else(PathBuf::new, Path::to_owned);
        let mut module = |name: &str| find_module(&folder, name);
        let inform_cm_per_min =
            profile.dialects.inform.as_ref().is_some_and(|i| i.speed == InformSpeed::CentimetresPerMinute);
        let options = reading::Options { arc: self.codes(profile), filament_diameter: None, inform_cm_per_min };
        let program = reading::read(&text, &mut module, &options).with_context(|| format!("{}", path.display()))?;
        let settings = plan::deposit_settings(profile);
        let mut layers = simulate::layers(&program, &settings, &profile.bead.law, self.bead_width);
        let mut notes = program.notes.clone();
        if let Some(part) = part {
            if let Some(by) = simulate::shift(&layers, &part.mesh, &settings) {
                simulate::translate(&mut layers, by);
                notes.push(format!(
                    "The program was moved by x {:.2} y {:.2} mm, so that its middle is the part's.",
                    by.x, by.y
                ));
            }
            simulate::outline(&mut layers, &part.mesh, profile.slice_options(), task)?;
        }
        let language = program.language;
        let mut totals = Totals::of_program(&program.totals(), &layers, profile);
        if let Some(motion) = &profile.motion {
            totals.total_time_s = program.seconds(motion);
        }
        Ok(Loaded { name, language, layers, totals, settings, notes })
    }

    /// What switches the arc: the words given, and the lines of the profile's templates without placeholders.
    fn codes(&self, profile: &Profile) -> ArcCodes {
        let templates = profile.dialects.arc_codes();
        ArcCodes {
            on: self.arc_on.iter().cloned().chain(templates.on).collect(),
            off: self.arc_off.iter().cloned().chain(templates.off).collect(),
        }
    }
}

fn load_plan(name: &str, text: &str, profile: &Profile) -> anyhow::Result<Loaded> {
    let file = plan_file::read(text)?;
    let settings = file.settings.unwrap_or_else(|| plan::deposit_settings(profile));
    let mut metrics = Metrics::new(profile);
    file.layers.iter().for_each(|layer| metrics.add(layer));
    let (totals, notes) = (Totals::of_plan(&metrics), Vec::new());
    Ok(Loaded { name: name.to_owned(), language: "plan", layers: file.layers, totals, settings, notes })
}

/// A module beside the program, whatever its case and extension.
fn find_module(folder: &Path, name: &str) -> Option<String> {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let wanted = name.to_ascii_lowercase();
    let fits = |path: &PathBuf| {
        let file = path.file_name().map(|f| f.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
        file == wanted || ["src", "mod", "sub", "ls", "jbi"].iter().any(|ext| file == format!("{wanted}.{ext}"))
    };
    let mut files: Vec<PathBuf> =
        fs::read_dir(folder).ok()?.filter_map(|e| Some(e.ok()?.path())).filter(fits).collect();
    files.sort();
    fs::read(files.first()?).ok().map(|bytes| String::from_utf8_lossy(&bytes).into_owned())
}

/// The profile of a plan or program, and the part it was made for.
pub(crate) fn part(
    path: Option<&Path>,
    units: Option<beadwright::model::Units>,
    profile: &Profile,
    task: &Task,
) -> anyhow::Result<Option<Import>> {
    let place = |path: &Path| {
        let model = model::Model { model: path.to_owned(), units, scale: 1.0, turn: glam::DVec3::ZERO, centre: false };
        model.placed(profile.bead.width, task)
    };
    path.map(place).transpose()
}
