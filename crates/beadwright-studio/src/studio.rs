//! The program: window, project, plans, background work, views.

use crate::actions::Action;
use crate::compared::Compared;
use crate::export::Export;
use crate::form::Parsed;
use crate::heat::Temperatures;
use crate::history::History;
use crate::jobs::{Answer, Ask, Job};
use crate::planner::{Planner, Urgency};
use crate::project::Project;
use crate::settings::{Settings, Store};
use crate::state::PlanState;
use crate::steps::Looked;
use crate::text::Language;
use crate::theme;
use crate::view::{Mode, ViewState};
use crate::view2d::View2d;
use crate::view3d::{Camera, Pick, Plate, Style, View3d};
use beadwright::bead::library::BeadLibrary;
use beadwright::fill::StrategyName;
use beadwright::profile::{Profile, edit};
use beadwright::robot::{Cell, Reach};
use eframe::egui::{self, Context, ViewportCommand};
use eframe::egui_wgpu::RenderState;
use eframe::egui_wgpu::wgpu::DeviceType;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::time::Duration;

/// A second plan of the same part, with another strategy.
pub struct Other {
    /// The strategy.
    pub strategy: StrategyName,
    /// Its planner.
    pub planner: Planner,
    /// Its plan.
    pub plan: PlanState,
    /// Its steps in the layer in view.
    pub looked: Looked,
    /// Its view of a layer.
    pub flat: View2d,
    /// Its view in 3-D.
    pub solid: View3d,
}

/// The window and what is remembered.
pub struct Window {
    pub(crate) ctx: Context,
    pub(crate) render_state: Option<RenderState>,
    pub(crate) store: Store,
    pub(crate) settings: Settings,
    /// Pictures of the examples, in their order, as far as they are drawn.
    pub(crate) pictures: Vec<egui::TextureHandle>,
    /// Sentences on what went wrong or was done, newest last.
    pub(crate) messages: Vec<Message>,
    /// Whether there is a font with Chinese characters.
    pub(crate) chinese: bool,
    /// Whether the user wants to close the window despite unsaved changes and is being asked about them.
    pub(crate) closing: bool,
}

/// The open project.
pub struct Open {
    pub(crate) project: History<Project>,
    /// Its file.
    pub(crate) file: Option<PathBuf>,
    /// The project as last opened or saved.
    pub(crate) saved: Project,
    /// The project as last autosaved.
    pub(crate) kept: Project,
    /// Number of undo steps when it was opened.
    pub(crate) opened: usize,
    /// The project of a run that crashed.
    pub(crate) lost: Option<Project>,
    /// The profile as the form needs it, parsed from the text last read.
    parsed: Option<Rc<Parsed>>,
    /// A key whose value was refused, and why.
    pub(crate) refused: Option<(String, String)>,
}

/// The plan, and a second one to compare it with.
pub struct Plans {
    pub(crate) planner: Planner,
    pub(crate) own: PlanState,
    pub(crate) other: Option<Other>,
}

/// Other background work, and its results.
#[derive(Default)]
pub struct Jobs {
    pub(crate) dialog: Option<Job<Answer>>,
    /// A path that is typed, where there is no dialog: what for, and the text so far.
    pub(crate) typed: Option<(Ask, String)>,
    /// What to write into the folder that is being asked for.
    pub(crate) exporting: Export,
    /// The steps of the strategy in the layer in view.
    pub(crate) looked: Looked,
    pub(crate) heat_job: Option<Job<Result<Temperatures, String>>>,
    pub(crate) reach_job: Option<Job<Result<Reach, String>>>,
    pub(crate) reach: Option<Reach>,
    /// The cell that this is about.
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
    /// Whether nothing is being computed.
    fn is_idle(&self) -> bool {
        let computes = self.reach_job.is_some()
            || self.heat_job.is_some()
            || self.scan_job.is_some()
            || self.scan_wanted.is_some();
        !computes && !self.looked.is_busy()
    }
}

/// The program, as the panels show it. Panels change only the view; everything else they ask for by a queue.
pub struct Studio {
    pub(crate) window: Window,
    pub(crate) open: Open,
    pub(crate) plans: Plans,
    pub(crate) jobs: Jobs,
    pub(crate) view: ViewState,
    pub(crate) solid: View3d,
    pub(crate) flat: View2d,
    /// What to do once the panels are drawn.
    pub(crate) queue: Vec<Action>,
}

/// A message in the window.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Message {
    /// Whether something went wrong.
    pub error: bool,
    /// The sentence.
    pub text: String,
}

impl Studio {
    /// The program in a window; `store` keeps settings and the autosaved project.
    pub fn new(cc: &eframe::CreationContext<'_>, store: Store) -> Self {
        let ctx = cc.egui_ctx.clone();
        let settings = store.settings();
        let planner = Planner::new(bell(&ctx, cc.wgpu_render_state.as_ref()));
        let studio = Self {
            window: Window {
                chinese: crate::fonts::set(&ctx),
                render_state: cc.wgpu_render_state.clone(),
                ctx,
                store,
                settings,
                pictures: Vec::new(),
                messages: Vec::new(),
                closing: false,
            },
            open: Open {
                project: History::new(Project::default()),
                file: None,
                saved: Project::default(),
                kept: Project::default(),
                opened: 0,
                lost: None,
                parsed: None,
                refused: None,
            },
            plans: Plans { planner, own: PlanState::default(), other: None },
            jobs: Jobs::default(),
            view: ViewState::default(),
            solid: View3d::default(),
            flat: View2d::default(),
            queue: Vec::new(),
        };
        studio.apply_theme();
        studio
    }

    /// Asks for something to be done once the panels are drawn.
    pub(crate) fn request(&mut self, action: Action) {
        self.queue.push(action);
    }

    /// Offers to restore the project of a run that crashed, if there is one.
    pub fn offer_lost(&mut self) {
        self.open.lost = self.window.store.lost_project();
    }

    /// Discards that project; what is open now is autosaved in its place.
    pub(crate) fn forget_lost(&mut self) {
        self.window.store.forget_project();
        self.open.kept = Project::default();
    }

    /// The text of a key in the language of the window.
    pub(crate) fn t(&self, key: &'static str) -> &'static str {
        self.language().text(key)
    }

    /// Whether the plan is one for a printer, which has filament and no arc.
    pub(crate) fn prints(&self) -> bool {
        self.plans.own.profile.as_ref().is_some_and(|profile| profile.prints())
    }

    /// The text of a key in the words of the process: those of welding, or of printing where they differ.
    pub(crate) fn worded(&self, key: &'static str) -> &'static str {
        let printed = self.prints().then(|| self.language().find(&format!("fdm {key}"))).flatten();
        printed.unwrap_or_else(|| self.t(key))
    }

    pub(crate) fn language(&self) -> Language {
        if self.window.chinese { self.window.settings.language } else { Language::English }
    }

    /// The project.
    pub fn project(&self) -> &Project {
        self.open.project.now()
    }

    /// The file of the open project.
    pub fn file(&self) -> Option<&Path> {
        self.open.file.as_deref()
    }

    /// The profile as its form needs it.
    pub(crate) fn parsed(&mut self) -> Option<Rc<Parsed>> {
        let text = &self.open.project.now().profile;
        if self.open.parsed.as_ref().is_none_or(|parsed| parsed.text != *text) {
            self.open.parsed = Parsed::of(text).map(Rc::new);
        }
        self.open.parsed.clone()
    }

    /// The plan, as far as it has come.
    pub fn plan(&self) -> &PlanState {
        &self.plans.own
    }

    /// The messages in the window.
    pub fn messages(&self) -> &[Message] {
        &self.window.messages
    }

    /// What is shown.
    pub fn view(&mut self) -> &mut ViewState {
        &mut self.view
    }

    /// From where the 3-D view is seen.
    pub fn camera(&self) -> Camera {
        self.solid.camera
    }

    /// Whether nothing is running in the background.
    pub fn is_idle(&self) -> bool {
        let other = self.plans.other.as_ref().is_some_and(|other| other.plan.is_busy() || other.looked.is_busy());
        !self.plans.own.is_busy() && !other && self.jobs.is_idle()
    }

    pub(crate) fn say(&mut self, text: impl Into<String>) {
        self.window.messages.push(Message { error: false, text: text.into() });
    }

    pub(crate) fn complain(&mut self, text: impl Into<String>) {
        let message = Message { error: true, text: text.into() };
        // An error that repeats at every step of a drag is reported once.
        if self.window.messages.last() != Some(&message) {
            self.window.messages.push(message);
        }
    }

    /// What is shown now.
    pub(crate) fn style(&self) -> Style {
        let view = &self.view;
        let inner = view.scan && self.scan().is_some() || view.stock && self.has_stock();
        let scan = inner && view.mode == Mode::Solid && !view.laying;
        let arm = self.arm();
        let at_arm = self.torch_place().filter(|_| arm.is_some()).map(|place| place.at);
        let pieces = self.plans.own.scene.layer(view.last).map_or(0, |layer| layer.len());
        Style {
            colour: view.colour,
            mesh: view.mesh || view.laying,
            scan,
            travels: view.show.travels && !scan,
            starts: view.show.starts && !scan,
            marks_from: if view.all_marks { 0 } else { view.last },
            // Beads would be in front of the faces to be clicked, and in front of the scan.
            beads: view.show.beads && !view.laying && !scan,
            layers: view.first..=view.last,
            segments_of_last: (view.progress < 1.0).then_some((view.progress * pieces as f64).round() as usize),
            section: view.section,
            plate: self.plate().filter(|_| view.plate),
            torch: view.torch.or(at_arm),
            arm: arm.map(|arm| arm.links).unwrap_or_default(),
            highlight: view.chosen.and_then(|chosen| self.pick(chosen)),
            dark: !self.window.settings.light,
        }
    }

    /// The plate on which the part is built, if the profile has one.
    pub(crate) fn plate(&self) -> Option<Plate> {
        let plate = self.plans.own.profile.as_ref()?.substrate.as_ref()?;
        let (low, high) = self.plans.own.part.as_ref()?.bounds();
        let (low, high) = (low.truncate() - plate.margin, high.truncate() + plate.margin);
        Some(Plate { low, high, thickness: plate.thickness })
    }

    pub(crate) fn pick(&self, (layer, pass, piece): (usize, usize, usize)) -> Option<Pick> {
        let span = self.plans.own.scene.layer(layer)?.passes().get(pass)?;
        Some(Pick { layer, pass, segment: span.segments.start + piece })
    }

    /// Switches to another project.
    pub(crate) fn begin(&mut self, project: Project) {
        self.open.project.seal();
        self.open.project.set("open", project);
        self.open.project.seal();
        self.open.opened = self.open.project.steps();
        self.open.saved = self.open.project.now().clone();
        self.open.refused = None;
        self.close_scan();
        self.follow_profile();
        self.flat.clear_measure();
        self.view.reset();
        self.flat.fit();
        self.solid.fit();
        self.replan();
    }

    /// Whether something would be lost if the window were closed.
    pub fn is_changed(&self) -> bool {
        self.project().source.is_some() && *self.project() != self.open.saved
    }

    /// Closes the window, whatever was changed.
    pub(crate) fn close(&mut self) {
        self.open.saved = self.project().clone();
        self.window.ctx.send_viewport_cmd(ViewportCommand::Close);
    }

    /// Changes the project, and plans again if it differs.
    pub(crate) fn change(&mut self, about: &str, change: impl FnOnce(&mut Project)) {
        let mut next = self.project().clone();
        change(&mut next);
        if self.open.project.set(about, next) {
            self.replan();
        }
    }

    /// Sets a value of the profile, given as in TOML; an invalid value is reported at its field.
    pub fn set_value(&mut self, key: &str, value: &str) {
        let text = edit::with_value(&self.project().profile, key, value);
        self.set_profile(key, text.map_err(|error| error.to_string()));
    }

    /// Removes values from the profile, so that their defaults apply: all of them, or none if one cannot be missing.
    pub(crate) fn reset_values(&mut self, keys: &[String]) {
        let Some(first) = keys.first() else { return };
        let text = keys.iter().try_fold(self.project().profile.clone(), |text, key| edit::without_value(&text, key));
        self.set_profile(first, text.map_err(|error| error.to_string()));
    }

    /// Takes over the text of a profile if it is valid.
    pub(crate) fn set_profile(&mut self, about: &str, text: Result<String, String>) {
        let checked = text.and_then(|text| match Profile::parse(&text) {
            Ok(_) => Ok(text),
            Err(error) => Err(error.to_string()),
        });
        match checked {
            Ok(text) => {
                self.open.refused = None;
                self.change(about, |project| project.profile = text);
            }
            Err(reason) => self.open.refused = Some((about.to_owned(), reason)),
        }
    }

    /// Plans the project again, the layer in view first.
    pub fn replan(&mut self) {
        self.view.playing = false;
        self.view.chosen = None;
        // Pending answers are about the previous plan.
        (self.jobs.reach, self.jobs.reach_job) = (None, None);
        self.jobs.looked.forget();
        self.jobs.heat_job = None;
        if self.project().source.is_none() {
            // Undo has led back to the empty window.
            self.plans.planner.cancel();
            self.plans.own = PlanState::default();
            self.plans.other = None;
            return;
        }
        self.plans.own.restart();
        self.plans.planner.plan(self.open.project.now(), self.view.last);
        let project = self.open.project.now().clone();
        if let Some(other) = &mut self.plans.other {
            other.looked.forget();
            other.plan.restart();
            other.planner.plan(&with_strategy(project, other.strategy), self.view.last);
        }
    }

    /// Plans the part with a second strategy too, shown next to the first; none removes the second plan.
    pub fn compare_with(&mut self, strategy: Option<StrategyName>) {
        let Some(strategy) = strategy else {
            self.plans.other = None;
            return;
        };
        let mut other = Other {
            strategy,
            planner: Planner::new(bell(&self.window.ctx, self.window.render_state.as_ref())),
            plan: PlanState::default(),
            looked: Looked::default(),
            flat: View2d::default(),
            solid: View3d::default(),
        };
        if self.project().source.is_some() {
            other.plan.restart();
            other.planner.plan(&with_strategy(self.project().clone(), strategy), self.view.last);
        }
        self.plans.other = Some(other);
    }

    pub(crate) fn apply_theme(&self) {
        theme::set(&self.window.ctx);
        self.window.ctx.set_theme(if self.window.settings.light { egui::Theme::Light } else { egui::Theme::Dark });
    }
}

/// Redraws the window when the planner has something to report: at once, or after a delay where drawing in software
/// would hold up planning.
fn bell(ctx: &Context, render_state: Option<&RenderState>) -> impl Fn(Urgency) + Send + Sync + 'static {
    const WHILE: Duration = Duration::from_millis(500);
    let in_software = render_state.is_some_and(|state| state.adapter.get_info().device_type == DeviceType::Cpu);
    let ctx = ctx.clone();
    move |urgency| match urgency {
        Urgency::Soon if in_software => ctx.request_repaint_after(WHILE),
        _ => ctx.request_repaint(),
    }
}

/// A project with another strategy.
fn with_strategy(mut project: Project, strategy: StrategyName) -> Project {
    if let Ok(text) = edit::with_value(&project.profile, "fill.strategy", &format!("\"{strategy}\"")) {
        project.profile = text;
    }
    project
}
