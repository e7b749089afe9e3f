//! What is known: window, project, plans, background work. Panels can read it, change the view, and queue all other
//! requests.

use crate::actions::Action;
use crate::adaptation::Adapting;
use crate::batch::Batch;
use crate::compared::Compared;
use crate::directions::Dividing;
use crate::distortion::Distorting;
use crate::export::Export;
use crate::form::{self, Parsed};
use crate::heat::Temperatures;
use crate::history::History;
use crate::jobs::{Answer, Ask, Job};
use crate::level::Leans;
use crate::listing::Listing;
use crate::planner::Planner;
use crate::project::Project;
use crate::settings::{Settings, Store};
use crate::state::PlanState;
use crate::steps::Looked;
use crate::text::Language;
use crate::trial::Trial;
use crate::view::{Mode, ViewState};
use crate::view2d::View2d;
use crate::view3d::{Colour, LayerBeads, Pick, Plate, Style, View3d};
use beadwright::bead::library::BeadLibrary;
use beadwright::chart::Chart;
use beadwright::fill::StrategyName;
use beadwright::program::PositionerAxis;
use beadwright::robot::{Cell, Reach, Suggestion};
use eframe::egui::{self, Context};
use eframe::egui_wgpu::RenderState;
use glam::DVec3;
use std::path::PathBuf;
use std::rc::Rc;

/// A second plan of the same part, with another strategy.
pub(crate) struct Other {
    /// The strategy.
    pub strategy: StrategyName,
    /// Its planner.
    pub planner: Planner,
    /// Its plan.
    pub plan: PlanState,
    /// Its steps in the layer in view.
    pub looked: Looked,
}

/// The window and what is remembered.
pub(crate) struct Window {
    pub(crate) ctx: Context,
    pub(crate) render_state: Option<RenderState>,
    pub(crate) store: Store,
    pub(crate) settings: Settings,
    /// Pictures of the examples drawn so far, in their order.
    pub(crate) pictures: Vec<egui::TextureHandle>,
    /// Sentences on what went wrong or was done, newest last.
    pub(crate) messages: Vec<Message>,
    /// Whether there is a font with Chinese characters.
    pub(crate) chinese: bool,
    /// Whether the user wants to close the window despite unsaved changes and is being asked about them.
    pub(crate) closing: bool,
}

/// What the step that opens a part is about.
pub(crate) const OPENING: &str = "step-open";

/// The open project.
pub(crate) struct Open {
    pub(crate) project: History<Project>,
    /// Its file.
    pub(crate) file: Option<PathBuf>,
    /// The project as last opened or saved.
    pub(crate) saved: Project,
    /// The project as last autosaved.
    pub(crate) kept: Project,
    /// Number of undo steps when it was opened.
    pub(crate) opened: usize,
    /// Whether the user is being asked about an undo that would close the part.
    pub(crate) asks_undo: bool,
    /// The remedy that is tried.
    pub(crate) trial: Option<Trial>,
    /// The project of a run that crashed.
    pub(crate) lost: Option<Project>,
    /// The profile as the form needs it, from the text that was parsed last.
    pub(crate) parsed: Option<Rc<Parsed>>,
    /// A key whose value was refused, and why.
    pub(crate) refused: Option<(String, String)>,
}

/// The plan, and a second one to compare it with.
pub(crate) struct Plans {
    pub(crate) planner: Planner,
    pub(crate) own: PlanState,
    pub(crate) other: Option<Other>,
}

/// The dialect of a program, and its lines, or a sentence on why it cannot be written.
pub(crate) type Listed = (String, Result<Listing, String>);

/// Other background work, and its results.
#[derive(Default)]
pub(crate) struct Jobs {
    pub(crate) dialog: Option<Job<Answer>>,
    /// What the path being typed is for, where there is no dialog.
    pub(crate) typed: Option<Ask>,
    /// What to write into the folder that is being asked for.
    pub(crate) exporting: Export,
    /// Whether the user is being asked about its serious findings first.
    pub(crate) doubted: bool,
    /// The steps of the strategy in the layer in view.
    pub(crate) looked: Looked,
    /// Whether temperatures are computed for the second plan.
    pub(crate) heat_of_other: bool,
    pub(crate) heat_job: Option<Job<Result<Temperatures, String>>>,
    pub(crate) level_job: Option<Job<Leans>>,
    /// The turn of the part, °, in which it costs least.
    pub(crate) orient_job: Option<Job<DVec3>>,
    pub(crate) listing_job: Option<Job<Listed>>,
    /// The lines of the program.
    pub(crate) listing: Option<Listed>,
    /// How plate and part bend, computed or being computed.
    pub(crate) distortion: Option<Distorting>,
    /// Several models, planned or being planned.
    pub(crate) batch: Option<Batch>,
    /// A scan of the unfinished build, compared or being compared.
    pub(crate) adapting: Option<Adapting>,
    /// Divisions of the part, found or looked for.
    pub(crate) dividing: Option<Dividing>,
    pub(crate) reach_job: Option<Job<Result<Reach, String>>>,
    pub(crate) reach: Option<Reach>,
    pub(crate) suggest_job: Option<Job<Option<Suggestion>>>,
    /// A place of the part that the cell reaches better; none where there is none.
    pub(crate) suggested: Option<Option<Suggestion>>,
    /// The cell that the results are for.
    pub(crate) cell: Option<Cell>,
    /// A scan to be opened.
    pub(crate) scan_wanted: Option<PathBuf>,
    pub(crate) scan_job: Option<Job<Result<Compared, String>>>,
    /// A scan of the built part.
    pub(crate) scan: Option<Compared>,
    /// Measured beads to look at.
    pub(crate) beads: Option<BeadLibrary>,
}

impl Jobs {
    /// Drops what was found about the reach of a cell, and what is being looked for.
    pub(crate) fn forget_reach(&mut self) {
        (self.reach, self.reach_job) = (None, None);
        (self.suggested, self.suggest_job) = (None, None);
    }

    /// Gives up planning several models; what is planned stays.
    pub(crate) fn stop_batch(&mut self) {
        self.batch.iter_mut().for_each(|batch| batch.run = None);
    }

    /// Whether nothing is being computed.
    pub(crate) fn is_idle(&self) -> bool {
        let computes = self.reach_job.is_some()
            || self.suggest_job.is_some()
            || self.heat_job.is_some()
            || self.level_job.is_some()
            || self.orient_job.is_some()
            || self.scan_job.is_some()
            || self.listing_job.is_some()
            || self.scan_wanted.is_some()
            || self.batch.as_ref().is_some_and(Batch::runs)
            || self.adapting.as_ref().is_some_and(|adapting| adapting.run.progress().is_some())
            || self.dividing.as_ref().is_some_and(|dividing| dividing.run.progress().is_some())
            || self.distortion.as_ref().is_some_and(|distortion| distortion.run.progress().is_some());
        !computes && !self.looked.is_busy()
    }
}

/// A message in the window.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Message {
    /// Whether something went wrong.
    pub error: bool,
    /// The sentence.
    pub text: String,
}

/// What is to be done once the panels are drawn.
pub(crate) type Queue = Vec<Action>;

/// Window, project, plans and background work.
#[derive(Clone, Copy)]
pub(crate) struct Known<'a> {
    pub(crate) window: &'a Window,
    pub(crate) open: &'a Open,
    pub(crate) plans: &'a Plans,
    pub(crate) jobs: &'a Jobs,
}

/// What is shown, and from where it is seen.
pub(crate) struct View<'a> {
    pub(crate) state: &'a mut ViewState,
    pub(crate) solid: &'a mut View3d,
    pub(crate) flat: &'a mut View2d,
    /// The views of the plan with another strategy.
    pub(crate) their_solid: &'a mut View3d,
    pub(crate) their_flat: &'a mut View2d,
}

impl<'a> Known<'a> {
    pub(crate) fn language(self) -> Language {
        if self.window.chinese { self.window.settings.language } else { Language::English }
    }

    /// The text of a key in the language of the window.
    pub(crate) fn t(self, key: &'static str) -> &'static str {
        self.language().text(key)
    }

    /// Whether the plan is one for a printer, which has filament and no arc.
    pub(crate) fn prints(self) -> bool {
        self.plans.own.profile.as_ref().is_some_and(|profile| profile.prints())
    }

    /// The text of a key in the words of the process: those of welding, or of printing where they differ.
    pub(crate) fn worded(self, key: &'static str) -> &'static str {
        let printed = self.prints().then(|| self.language().find(&format!("fdm {key}"))).flatten();
        printed.unwrap_or_else(|| self.t(key))
    }

    /// The project.
    pub(crate) fn project(self) -> &'a Project {
        self.open.project.now()
    }

    /// The change that is tried, as long as nothing else is changed.
    pub(crate) fn trial(self) -> Option<&'a Trial> {
        self.open.trial.as_ref().filter(|trial| trial.tried == *self.project())
    }

    /// A value of the profile, as in TOML; `None` where the profile does not set it.
    pub(crate) fn value_now(self, key: &str) -> Option<String> {
        form::value(&self.parsed()?.values, key).map(|value| value.to_string())
    }

    /// What a step of the project is called, from what it is about: a key of the profile, or of a text.
    pub(crate) fn step(self, about: &str) -> String {
        let (language, name) = (self.language(), about.rsplit('.').next().unwrap_or(about));
        match language.find(about) {
            Some(text) => text.to_owned(),
            None if form::BASIC.contains(&about) => language.word("basic", about),
            None => language.word("name", name),
        }
    }

    /// The profile as its form needs it.
    pub(crate) fn parsed(self) -> Option<Rc<Parsed>> {
        self.open.parsed.clone()
    }

    /// The plate on which the part is built, if the profile has one and the first layers lie on it.
    pub(crate) fn plate(self) -> Option<Plate> {
        let profile = self.plans.own.profile.as_ref()?;
        let plate = profile.substrate.as_ref()?;
        let first = profile.layers.charts().next()?;
        let is_flat = matches!(first, Chart::Plane(_) | Chart::Guide(_));
        if !is_flat || !first.sheet(0.0).at(DVec3::ZERO).normal.abs_diff_eq(DVec3::Z, 1e-6) {
            return None;
        }
        let (low, high) = self.plans.own.part.as_ref()?.bounds();
        let (low, high) = (low.truncate() - plate.margin, high.truncate() + plate.margin);
        Some(Plate { low, high, thickness: plate.thickness })
    }

    /// The axes of the positioner, if there is one.
    pub(crate) fn axes(self) -> &'a [PositionerAxis] {
        let profile = self.plans.own.profile.as_ref();
        let positioner = profile.and_then(|profile| profile.program.positioner.as_ref());
        positioner.map_or(&[], |positioner| &positioner.axes)
    }

    /// A bead, given by its layer, its pass and its piece of the pass.
    pub(crate) fn pick(self, chosen: (usize, usize, usize)) -> Option<Pick> {
        pick_in(self.plans.own.scene.layer(chosen.0)?, chosen)
    }

    /// The values at the two ends of the colours: those chosen by hand, or else the least and the largest of all plans in view.
    pub(crate) fn range(self, view: &ViewState) -> Option<(f64, f64)> {
        if let Some((colour, [low, high])) = view.range
            && colour == view.colour
        {
            return Some((low, high));
        }
        let other = self.plans.other.as_ref().filter(|_| view.mode == Mode::Compare);
        let plans = [Some(&self.plans.own), other.map(|other| &other.plan)];
        let ranges = plans.into_iter().flatten().filter_map(|plan| plan.scene.value_range(view.colour));
        ranges.reduce(|(a, b), (c, d)| (a.min(c), b.max(d)))
    }

    /// What the 3-D view shows.
    pub(crate) fn style(self, view: &ViewState) -> Style {
        let inner = view.scan && self.scan().is_some() || view.stock && self.has_stock();
        let bent = self.bent(view).is_some();
        let divided = self.pieces(view).is_some();
        let scan = inner && view.mode == Mode::Solid && !view.laying && !bent && !divided;
        let beads = !scan && !divided;
        let arm = self.arm(view).filter(|_| !bent);
        let machine = if bent { Default::default() } else { self.machine(view, arm.as_ref()) };
        let at_arm = self.torch_place(view).filter(|_| arm.is_some()).map(|place| place.torch);
        let scene = &self.plans.own.scene;
        let pieces = scene.layer(view.last).map_or(0, |layer| layer.len());
        let reached = || scene.drawn_segments(view.last, (view.progress * pieces as f64).round() as usize);
        Style {
            colour: if bent { Colour::Movement } else { view.colour },
            range: self.range(view).filter(|_| !bent),
            mesh: view.mesh || view.laying,
            scan,
            pieces: divided,
            bent: bent && view.plate,
            travels: view.show.travels && beads,
            starts: view.show.starts && beads,
            marks_from: if view.all_marks { 0 } else { view.last },
            // Beads would be in front of the faces to be clicked, and in front of the scan or the bodies.
            beads: view.show.beads && !view.laying && beads,
            layers: view.first..=view.last,
            segments_of_last: (view.progress < 1.0).then(reached),
            section: view.section,
            plate: self.plate().filter(|_| view.plate && !bent),
            // The torch follows the plan.
            torch: view.torch.filter(|_| !bent).or(at_arm),
            around: machine.0,
            floor: machine.1,
            highlight: view.chosen.and_then(|chosen| pick_in(scene.drawn_layer(chosen.0)?, chosen)),
            dark: !self.window.settings.light,
        }
    }
}

/// A bead of a layer, given by its layer, its pass and its piece of the pass.
fn pick_in(beads: &LayerBeads, (layer, pass, piece): (usize, usize, usize)) -> Option<Pick> {
    let piece = beads.piece(beads.passes().get(pass)?.segments.start) + piece;
    Some(Pick { layer, pass, segment: beads.segments_of(piece).start })
}
