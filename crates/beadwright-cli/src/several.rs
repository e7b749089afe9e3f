//! Which parts are in a build, in which order they are welded, and in how many programs.

use crate::model;
use beadwright::model::together::{Arrangement, Place, arrange, together};
use beadwright::model::{Import, Mesh, Part};
use std::path::Path;

#[derive(clap::Args)]
pub(crate) struct Several {
    /// Another part for the same build, turned and scaled in the same way; may be given several times. The parts are
    /// placed in rows. With --programs parts it may have its own profile: FILE:profile=NAME.
    #[arg(long, value_name = "MODEL")]
    pub(crate) with: Vec<String>,
    /// Distance between the parts of one build, mm.
    #[arg(long, value_name = "MM", default_value_t = 20.0, value_parser = parse_gap, requires = "with")]
    gap: f64,
    /// Leave the parts of one build where their files place them in x and y.
    #[arg(long, requires = "with", conflicts_with = "gap")]
    as_placed: bool,
    /// Build the parts together, layer by layer, or one after another, the lowest first; refused if the torch (section
    /// [torch] of the profile) would hit a finished part.
    #[arg(long, value_enum, default_value_t = Order::Layers, requires = "with")]
    pub(crate) order: Order,
    /// Write one plan with one program, or a plan and a program for each part into its own folder (with --order parts).
    #[arg(long, value_enum, default_value_t = Programs::One, requires = "with")]
    pub(crate) programs: Programs,
}

/// Which comes first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Order {
    /// All parts of a layer before the next layer.
    Layers,
    /// All layers of a part before the next part.
    Parts,
}

/// How many programs there are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Programs {
    /// One for the build.
    One,
    /// One for each part.
    Parts,
}

fn parse_gap(text: &str) -> Result<f64, String> {
    let gap: f64 = text.parse().map_err(|_| "a distance in mm is expected".to_owned())?;
    if (0.0..=1000.0).contains(&gap) { Ok(gap) } else { Err("the gap must lie between 0 and 1000 mm".to_owned()) }
}

impl Several {
    /// Refuses arguments that do not fit together.
    pub(crate) fn check(&self) -> anyhow::Result<()> {
        anyhow::ensure!(
            self.programs == Programs::One || self.order == Order::Parts,
            "--programs parts: parts that are built together need one program. --order parts welds them one after another."
        );
        let own = self.with.iter().find(|with| own_profile(with).1.is_some());
        if let Some(with) = own.filter(|_| self.programs == Programs::One) {
            anyhow::bail!("--with {with}: a part may have its own profile only with --programs parts");
        }
        Ok(())
    }

    fn arrangement(&self) -> Arrangement {
        if self.as_placed { Arrangement::AsTheyAre } else { Arrangement::Rows { gap: self.gap } }
    }

    /// Positions of the first model and the others; `place` reads and places one of them.
    pub(crate) fn stand(
        &self,
        first: &model::Model,
        place: impl Fn(&model::Model) -> anyhow::Result<Part>,
    ) -> anyhow::Result<Build> {
        let whole = place(first)?;
        if self.with.is_empty() {
            return Ok(Build { whole, base: None, places: Vec::new(), lowest_first: Vec::new() });
        }
        let mut parts = vec![(first.part(), solid(whole, &first.model)?)];
        for with in &self.with {
            let model = model::Model::placed_so(own_profile(with).0, &first.placing);
            parts.push((model.part(), solid(place(&model)?, &model.model)?));
        }
        let (mut solids, places) = arrange(parts, self.arrangement())?;
        let (whole, _) = together(solids.clone(), Arrangement::AsTheyAre)?;
        solids.sort_by(|(_, a), (_, b)| a.mesh.size().z.total_cmp(&b.mesh.size().z));
        Ok(Build { whole: Part::Mesh(whole), base: None, places, lowest_first: solids })
    }

    /// The name of the profile that is a part's own.
    pub(crate) fn profile_of(&self, part: &str) -> Option<&str> {
        let named = |with: &&String| model::Model::of(own_profile(with).0).part() == part;
        self.with.iter().find(named).and_then(|with| own_profile(with).1)
    }
}

/// What is built.
pub(crate) struct Build {
    /// As one part.
    pub(crate) whole: Part,
    /// An existing part on which it is welded.
    pub(crate) base: Option<Mesh>,
    /// Where each of several parts is placed.
    pub(crate) places: Vec<Place>,
    /// Each of several parts with its name, on its own, the lowest first.
    pub(crate) lowest_first: Vec<(String, Import)>,
}

fn solid(part: Part, path: &Path) -> anyhow::Result<Import> {
    match part {
        Part::Mesh(import) => Ok(import),
        Part::Curves { .. } => anyhow::bail!("{}: only solids can share a build", path.display()),
    }
}

/// The file and the profile of `FILE:profile=NAME`.
fn own_profile(with: &str) -> (&Path, Option<&str>) {
    match with.rsplit_once(":profile=") {
        Some((file, profile)) => (Path::new(file), Some(profile)),
        None => (Path::new(with), None),
    }
}
