//! One plan of a batch, and what is kept of it.

use crate::model::{Model, Placing, Use};
use crate::plan::{deposit_settings, refused};
use crate::profile;
use beadwright::compare::MAP_PIXELS;
use beadwright::deposit::{Figures, Judge};
use beadwright::fill::StrategyName;
use beadwright::layer::Layer;
use beadwright::plan::choice::{self, Choice};
use beadwright::plan::{self, Header, Sink, Summary};
use beadwright::profile::Profile;
use beadwright::report;
use beadwright::task::Task;
use std::path::PathBuf;

/// What is planned.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Run {
    pub(super) file: PathBuf,
    pub(super) profile: String,
    /// The profile's if none is asked for.
    pub(super) strategy: Option<StrategyName>,
    /// Keys with their values.
    pub(super) swept: Vec<(String, String)>,
}

/// What is the same for all plans.
pub(super) struct Asked<'a> {
    pub(super) placing: &'a Placing,
    pub(super) height: Option<f64>,
    pub(super) set: &'a [String],
    pub(super) grid: Option<f64>,
    pub(super) deposit: bool,
    pub(super) pictures: bool,
}

/// A run with its plan, or why there is none.
pub(super) struct Row {
    pub(super) run: Run,
    pub(super) planned: Result<Planned, String>,
}

/// What is kept of a plan.
pub(super) struct Planned {
    pub(super) strategy: StrategyName,
    pub(super) summary: Summary,
    pub(super) figures: Option<Figures>,
    /// The layer in the middle, as SVG.
    pub(super) picture: Option<String>,
}

impl Run {
    /// Settings over those that all plans share.
    fn settings(&self, set: &[String]) -> Vec<String> {
        let strategy = self.strategy.iter().map(|strategy| format!("fill.strategy=\"{strategy}\""));
        let swept = self.swept.iter().map(|(key, value)| format!("{key}={value}"));
        set.iter().cloned().chain(strategy).chain(swept).collect()
    }
}

/// Plans as `beadwright plan` does, but writes nothing.
pub(super) fn plan(run: &Run, asked: &Asked<'_>, task: &Task) -> anyhow::Result<Planned> {
    let profile = profile::load(&run.profile, &run.settings(asked.set))?;
    let model = Model::placed_so(&run.file, asked.placing);
    let part = model.part_placed(&profile, Use::AsDrawn, asked.height, task)?;
    let Choice { profile, note } = choice::choose(&part, &profile, run.strategy.is_some(), task)?;
    let settings = deposit_settings(asked.grid, &profile, part.bounds())?;
    // Pictures make the judge look closer at a few squares, so it draws them as for `plan`: the figures are the same.
    let judge = asked.deposit.then(|| Judge::new(settings).with_pictures(MAP_PIXELS).without_patches());
    let mut kept = Kept { profile: &profile, judge, pictures: asked.pictures, middle: 0, picture: None };
    let summary = plan::plan_into(&model.part(), &part, &profile, task, &mut kept);
    let mut summary = summary.map_err(|error| refused(error, &run.file))?;
    summary.notes.splice(0..0, part.notes().iter().cloned().chain(note));
    let figures = kept.judge.as_ref().map(|judge| *judge.total());
    Ok(Planned { strategy: profile.fill.strategy, summary, figures, picture: kept.picture })
}

/// Judges layers as they come, and draws the one in the middle.
struct Kept<'a> {
    profile: &'a Profile,
    judge: Option<Judge>,
    pictures: bool,
    /// Index of the layer that is drawn.
    middle: usize,
    picture: Option<String>,
}

impl Sink for Kept<'_> {
    type Error = anyhow::Error;

    fn begin(&mut self, header: &Header) -> anyhow::Result<()> {
        self.middle = header.extent.layers / 2;
        Ok(())
    }

    fn layer(&mut self, layer: Layer) -> anyhow::Result<()> {
        if self.pictures && layer.index == self.middle {
            let title = format!("Layer {}, z {:.2} mm", layer.index + 1, layer.z);
            self.picture = Some(report::svg::layer(&plan::drawn(&layer, self.profile), &title));
        }
        if let Some(judge) = &mut self.judge {
            judge.layer(&plan::welded_alone(&layer, self.profile));
        }
        Ok(())
    }
}
