//! The window: where project, planner, views and panels are put together.

use crate::actions;
use crate::export::Export;
use crate::form::Parsed;
use crate::history::History;
use crate::jobs::{self, Ask, Job};
use crate::panels;
use crate::planner::{Haste, Planner};
use crate::project::Project;
use crate::settings::{Settings, Store};
use crate::state::PlanState;
use crate::text::Language;
use crate::view::ViewState;
use crate::view2d::View2d;
use crate::view3d::View3d;
use beadwright::bead::library::BeadLibrary;
use beadwright::fill::hybrid::Steps;
use beadwright::profile::{Profile, edit};
use beadwright::robot::Reach;
use eframe::egui::{self, Context, ViewportCommand};
use eframe::egui_wgpu::RenderState;
use eframe::egui_wgpu::wgpu::DeviceType;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::time::Duration;

/// A second plan of the same part, with another strategy.
pub struct Other {
    /// The strategy.
    pub strategy: String,
    /// Its planner.
    pub planner: Planner,
    /// Its plan.
    pub plan: PlanState,
    /// Its view.
    pub flat: View2d,
}

/// The program.
pub struct Studio {
    pub(crate) ctx: Context,
    pub(crate) render_state: Option<RenderState>,
    pub(crate) store: Store,
    pub(crate) settings: Settings,
    pub(crate) project: History<Project>,
    /// Where the project lies.
    pub(crate) file: Option<PathBuf>,
    pub(crate) planner: Planner,
    pub(crate) plan: PlanState,
    pub(crate) other: Option<Other>,
    pub(crate) view: ViewState,
    pub(crate) solid: View3d,
    pub(crate) flat: View2d,
    /// What went wrong or was done, as sentences, the newest last.
    pub(crate) messages: Vec<Message>,
    /// The profile as its form needs it, of the text that it was read from last.
    parsed: Option<Rc<Parsed>>,
    /// What is wrong with the value of a key that was typed.
    pub(crate) refused: Option<(String, String)>,
    pub(crate) dialog: Option<Job<(Ask, Option<PathBuf>)>>,
    /// The dialect that a folder is asked for.
    pub(crate) exporting: Export,
    pub(crate) steps_job: Option<Job<(usize, Vec<Steps>)>>,
    pub(crate) steps: Option<(usize, Vec<Steps>)>,
    pub(crate) reach_job: Option<Job<Result<Reach, String>>>,
    pub(crate) reach: Option<Reach>,
    /// Measured beads to look at.
    pub(crate) beads: Option<BeadLibrary>,
    /// The project of a run that did not end well.
    pub(crate) lost: Option<Project>,
    pub(crate) chinese: bool,
    /// The project as it was kept aside last.
    kept: Project,
    /// The project as it was opened or written last.
    pub(crate) saved: Project,
    /// Whether the window is to be closed although there are changes, and it is asked what becomes of them.
    pub(crate) closing: bool,
    /// Steps of the history when the project was opened.
    pub(crate) opened: usize,
}

/// A sentence in the window.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Message {
    /// Whether something went wrong.
    pub error: bool,
    /// The sentence.
    pub text: String,
}

impl Studio {
    /// The program in a window; `store` remembers things.
    pub fn new(cc: &eframe::CreationContext<'_>, store: Store) -> Self {
        let ctx = cc.egui_ctx.clone();
        let settings = store.settings();
        let studio = Self {
            chinese: crate::fonts::set(&ctx),
            render_state: cc.wgpu_render_state.clone(),
            planner: Planner::new(bell(&ctx, cc.wgpu_render_state.as_ref())),
            lost: None,
            ctx,
            settings,
            store,
            project: History::new(Project::default()),
            file: None,
            plan: PlanState::default(),
            other: None,
            view: ViewState::default(),
            solid: View3d::default(),
            flat: View2d::default(),
            messages: Vec::new(),
            parsed: None,
            refused: None,
            dialog: None,
            exporting: Export::default(),
            steps_job: None,
            steps: None,
            reach_job: None,
            reach: None,
            beads: None,
            kept: Project::default(),
            saved: Project::default(),
            closing: false,
            opened: 0,
        };
        studio.apply_theme();
        studio
    }

    /// Offers the project of a run that did not end well, if there is one.
    pub fn offer_lost(&mut self) {
        self.lost = self.store.lost_project();
    }

    /// Lets go of that project; what is open now is kept aside in its place.
    pub(crate) fn forget_lost(&mut self) {
        self.store.forget_project();
        self.kept = Project::default();
    }

    /// The text of a key in the language of the window.
    pub(crate) fn t(&self, key: &'static str) -> &'static str {
        self.language().text(key)
    }

    pub(crate) fn language(&self) -> Language {
        if self.chinese { self.settings.language } else { Language::English }
    }

    /// The project.
    pub fn project(&self) -> &Project {
        self.project.now()
    }

    /// The project file that is worked on.
    pub fn file(&self) -> Option<&Path> {
        self.file.as_deref()
    }

    /// The profile as its form needs it.
    pub(crate) fn parsed(&mut self) -> Option<Rc<Parsed>> {
        let text = &self.project.now().profile;
        if self.parsed.as_ref().is_none_or(|parsed| parsed.text != *text) {
            self.parsed = Parsed::of(text).map(Rc::new);
        }
        self.parsed.clone()
    }

    /// The plan, as far as it has come.
    pub fn plan(&self) -> &PlanState {
        &self.plan
    }

    /// The sentences in the window.
    pub fn messages(&self) -> &[Message] {
        &self.messages
    }

    /// What is shown.
    pub fn view(&mut self) -> &mut ViewState {
        &mut self.view
    }

    /// Whether nothing is under way.
    pub fn is_idle(&self) -> bool {
        let other = self.other.as_ref().is_some_and(|other| other.plan.is_busy());
        !self.plan.is_busy() && !other && self.reach_job.is_none() && self.steps_job.is_none()
    }

    pub(crate) fn say(&mut self, text: impl Into<String>) {
        self.messages.push(Message { error: false, text: text.into() });
    }

    pub(crate) fn complain(&mut self, text: impl Into<String>) {
        let message = Message { error: true, text: text.into() };
        // What goes wrong again and again, at every step of a drag, is said once.
        if self.messages.last() != Some(&message) {
            self.messages.push(message);
        }
    }

    /// Works on another project from now on.
    pub(crate) fn begin(&mut self, project: Project) {
        self.project.seal();
        self.project.set("open", project);
        self.project.seal();
        self.opened = self.project.steps();
        self.saved = self.project.now().clone();
        self.refused = None;
        self.flat.clear_measure();
        self.view.reset();
        self.flat.fit();
        self.solid.fit();
        self.replan();
    }

    /// Whether something would be lost if the window were closed.
    pub fn is_changed(&self) -> bool {
        self.project().source.is_some() && *self.project() != self.saved
    }

    /// Closes the window, whatever was changed.
    pub(crate) fn close(&mut self) {
        self.saved = self.project().clone();
        self.ctx.send_viewport_cmd(ViewportCommand::Close);
    }

    /// Asks before changes are lost with the window.
    fn hold(&mut self) {
        if self.is_changed() && self.ctx.input(|input| input.viewport().close_requested()) {
            self.ctx.send_viewport_cmd(ViewportCommand::CancelClose);
            self.closing = true;
        }
    }

    /// Changes the project, and plans anew if it differs.
    pub(crate) fn change(&mut self, about: &str, change: impl FnOnce(&mut Project)) {
        let mut next = self.project().clone();
        change(&mut next);
        if self.project.set(about, next) {
            self.replan();
        }
    }

    /// Lays a value over the profile, given as in TOML; what cannot be is told at the field.
    pub fn set_value(&mut self, key: &str, value: &str) {
        let text = edit::with_value(&self.project().profile, key, value);
        self.set_profile(key, text.map_err(|error| error.to_string()));
    }

    /// Takes a value out of the profile, so that its default holds.
    pub(crate) fn reset_value(&mut self, key: &str) {
        let text = edit::without_value(&self.project().profile, key);
        self.set_profile(key, text.map_err(|error| error.to_string()));
    }

    /// Takes the text of a profile if it can be.
    pub(crate) fn set_profile(&mut self, about: &str, text: Result<String, String>) {
        let checked = text.and_then(|text| match Profile::parse(&text) {
            Ok(_) => Ok(text),
            Err(error) => Err(error.to_string()),
        });
        match checked {
            Ok(text) => {
                self.refused = None;
                self.change(about, |project| project.profile = text);
            }
            Err(reason) => self.refused = Some((about.to_owned(), reason)),
        }
    }

    /// Plans the project anew, the layer in view first.
    pub fn replan(&mut self) {
        self.view.playing = false;
        self.view.chosen = None;
        // Answers that are still under way are about the plan before.
        (self.reach, self.reach_job) = (None, None);
        (self.steps, self.steps_job) = (None, None);
        if self.project().source.is_none() {
            // Undone to the empty window.
            self.planner.cancel();
            self.plan = PlanState::default();
            self.other = None;
            return;
        }
        self.plan.restart();
        self.planner.plan(self.project.now(), self.view.last);
        let project = self.project.now().clone();
        if let Some(other) = &mut self.other {
            other.plan.restart();
            other.planner.plan(&with_strategy(project, &other.strategy), self.view.last);
        }
    }

    /// Plans the part with a second strategy too, to be seen beside the first; none for no second plan.
    pub fn compare_with(&mut self, strategy: Option<&str>) {
        let Some(strategy) = strategy else {
            self.other = None;
            return;
        };
        let mut other = Other {
            strategy: strategy.to_owned(),
            planner: Planner::new(bell(&self.ctx, self.render_state.as_ref())),
            plan: PlanState::default(),
            flat: View2d::default(),
        };
        if self.project().source.is_some() {
            other.plan.restart();
            other.planner.plan(&with_strategy(self.project().clone(), strategy), self.view.last);
        }
        self.other = Some(other);
    }

    pub(crate) fn apply_theme(&self) {
        for theme in [egui::Theme::Dark, egui::Theme::Light] {
            self.ctx.style_mut_of(theme, |style| {
                let visuals = &mut style.visuals;
                visuals.weak_text_color = Some(egui::Color32::from_gray(if visuals.dark_mode { 150 } else { 95 }));
                // A field to write in is seen without a frame.
                visuals.extreme_bg_color = egui::Color32::from_gray(if visuals.dark_mode { 8 } else { 226 });
            });
        }
        self.ctx.set_theme(if self.settings.light { egui::Theme::Light } else { egui::Theme::Dark });
    }

    /// Takes in what has happened in the background.
    fn hear(&mut self) {
        for event in self.planner.events() {
            self.plan.take(event);
        }
        if let Some(other) = &mut self.other {
            for event in other.planner.events() {
                other.plan.take(event);
            }
        }
        self.view.follow(self.plan.layer_count());
        match jobs::take(&mut self.dialog) {
            Some(Ok((what, Some(path)))) => self.answered(what, &path),
            Some(Ok((_, None))) | None => {}
            Some(Err(error)) => self.complain(error),
        }
        match jobs::take(&mut self.steps_job) {
            Some(Ok(steps)) => self.steps = Some(steps),
            Some(Err(error)) => {
                // Not again: it would only break again.
                self.view.show.regions = false;
                self.complain(error);
            }
            None => {}
        }
        match jobs::take(&mut self.reach_job) {
            Some(Ok(Ok(reach))) => self.reach = Some(reach),
            Some(Ok(Err(error)) | Err(error)) => self.complain(error),
            None => {}
        }
    }

    /// Keeps the project aside when it has changed.
    fn keep(&mut self) {
        if *self.project.now() != self.kept {
            self.kept = self.project.now().clone();
            if let Err(error) = self.store.keep_project(&self.kept) {
                self.complain(error);
            }
        }
    }
}

/// Draws the window again when the planner has something to tell: at once, or within a while where drawing in software
/// would hold up planning.
fn bell(ctx: &Context, render_state: Option<&RenderState>) -> impl Fn(Haste) + Send + Sync + 'static {
    const WHILE: Duration = Duration::from_millis(500);
    let in_software = render_state.is_some_and(|state| state.adapter.get_info().device_type == DeviceType::Cpu);
    let ctx = ctx.clone();
    move |haste| match haste {
        Haste::Soon if in_software => ctx.request_repaint_after(WHILE),
        _ => ctx.request_repaint(),
    }
}

/// A project with another strategy.
fn with_strategy(mut project: Project, strategy: &str) -> Project {
    if let Ok(text) = edit::with_value(&project.profile, "fill.strategy", &format!("\"{strategy}\"")) {
        project.profile = text;
    }
    project
}

impl eframe::App for Studio {
    fn ui(&mut self, ui: &mut egui::Ui, _: &mut eframe::Frame) {
        self.hear();
        self.hold();
        for action in actions::pressed(&self.ctx) {
            self.act(action);
        }
        let dropped = self.ctx.input(|input| input.raw.dropped_files.clone());
        for path in dropped.iter().map(|file| file.path()) {
            self.open(path);
        }
        panels::show(self, ui);
        if self.ctx.input(|input| input.pointer.any_released()) {
            self.project.seal();
        }
        self.keep();
    }

    fn on_exit(&mut self) {
        self.store.keep_settings(&self.settings);
        // What was not decided yet is asked again.
        match &self.lost {
            Some(lost) => drop(self.store.keep_project(lost)),
            None => self.store.forget_project(),
        }
    }
}
