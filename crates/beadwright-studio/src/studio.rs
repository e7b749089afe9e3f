//! The program: window, project, plans, background work, views.

pub use crate::known::Message;

use crate::form::Parsed;
use crate::history::History;
use crate::known::{Jobs, Known, OPENING, Open, Other, Plans, View, Window};
use crate::planner::{Planner, Urgency};
use crate::project::Project;
use crate::settings::Store;
use crate::state::PlanState;
use crate::steps::Looked;
use crate::theme;
use crate::view::ViewState;
use crate::view2d::View2d;
use crate::view3d::{Camera, View3d};
use beadwright::fill::StrategyName;
use beadwright::profile::{Profile, edit};
use eframe::egui::{self, Context, ViewportCommand};
use eframe::egui_wgpu::RenderState;
use eframe::egui_wgpu::wgpu::DeviceType;
use std::path::Path;
use std::rc::Rc;
use std::time::Duration;

/// The program. Panels can change only the view; everything else they request through a queue.
pub struct Studio {
    pub(crate) window: Window,
    pub(crate) open: Open,
    pub(crate) plans: Plans,
    pub(crate) jobs: Jobs,
    pub(crate) view: ViewState,
    pub(crate) solid: View3d,
    pub(crate) flat: View2d,
    /// The views of the plan with another strategy.
    pub(crate) their_solid: View3d,
    pub(crate) their_flat: View2d,
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
                asks_undo: false,
                trial: None,
                parsed: None,
                refused: None,
            },
            plans: Plans { planner, own: PlanState::default(), other: None },
            jobs: Jobs::default(),
            view: ViewState::default(),
            solid: View3d::default(),
            flat: View2d::default(),
            their_solid: View3d::default(),
            their_flat: View2d::default(),
        };
        studio.apply_theme();
        studio.apply_text_size();
        studio
    }

    /// What panels may read.
    pub(crate) fn known(&self) -> Known<'_> {
        Known { window: &self.window, open: &self.open, plans: &self.plans, jobs: &self.jobs }
    }

    /// What panels may read, and what they may change.
    pub(crate) fn parts(&mut self) -> (Known<'_>, View<'_>) {
        let Self { window, open, plans, jobs, view, solid, flat, their_solid, their_flat } = self;
        (Known { window, open, plans, jobs }, View { state: view, solid, flat, their_solid, their_flat })
    }

    /// Offers to restore the project of a run that crashed, if there is one.
    pub fn offer_lost(&mut self) {
        self.open.lost = self.window.store.lost_project();
    }

    /// Discards that project; the open one is autosaved in its place.
    pub(crate) fn forget_lost(&mut self) {
        self.window.store.forget_project();
        self.open.kept = Project::default();
    }

    /// The text of a key in the language of the window.
    pub(crate) fn t(&self, key: &'static str) -> &'static str {
        self.known().t(key)
    }

    /// The project.
    pub fn project(&self) -> &Project {
        self.open.project.now()
    }

    /// The file of the open project.
    pub fn file(&self) -> Option<&Path> {
        self.open.file.as_deref()
    }

    /// Parses the profile for its form, if it has changed.
    pub(crate) fn parse(&mut self) {
        let text = &self.open.project.now().profile;
        if self.open.parsed.as_ref().is_none_or(|parsed| parsed.text != *text) {
            self.open.parsed = Parsed::of(text).map(Rc::new);
        }
    }

    /// The plan as far as it is made.
    pub fn plan(&self) -> &PlanState {
        &self.plans.own
    }

    /// The plan that it is compared with.
    pub fn other_plan(&self) -> Option<&PlanState> {
        self.plans.other.as_ref().map(|other| &other.plan)
    }

    /// The messages in the window.
    pub fn messages(&self) -> &[Message] {
        &self.window.messages
    }

    /// What is shown.
    pub fn view(&mut self) -> &mut ViewState {
        &mut self.view
    }

    /// The camera of the 3-D view.
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

    /// Switches to another project.
    pub(crate) fn begin(&mut self, project: Project) {
        self.open.project.seal();
        self.open.project.set(OPENING, project);
        self.open.project.seal();
        self.open.opened = self.open.project.steps();
        self.open.saved = self.open.project.now().clone();
        self.open.refused = None;
        self.open.asks_undo = false;
        self.close_scan();
        self.stop_directions();
        self.close_build_scan();
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
        let next = next.without_stale(self.project());
        if next.adapted.is_none() && self.project().adapted.is_some() {
            self.say(self.t("adapt-dropped"));
        }
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
        (self.view.chosen, self.view.pin) = (None, None);
        // Pending answers are about the previous plan.
        self.jobs.forget_reach();
        self.jobs.looked.forget();
        (self.jobs.listing, self.jobs.listing_job) = (None, None);
        (self.jobs.heat_job, self.jobs.level_job, self.jobs.distortion) = (None, None, None);
        (self.jobs.orient_job, self.jobs.adapting) = (None, None);
        self.keep_directions();
        if self.project().source.is_none() {
            // Undo has led back to the empty window.
            self.stop_directions();
            self.plans.planner.cancel();
            self.plans.own = PlanState::default();
            self.plans.other = None;
            return;
        }
        self.plans.own.restart(self.open.project.now().adapted.is_some());
        self.plans.planner.plan(self.open.project.now(), self.view.last);
        let project = self.open.project.now().clone();
        if let Some(other) = &mut self.plans.other {
            other.looked.forget();
            other.plan.restart(false);
            other.planner.plan(&with_strategy(project, other.strategy), self.view.last);
        }
    }

    /// Plans the part with a second strategy too, shown next to the first; none removes the second plan.
    pub fn compare_with(&mut self, strategy: Option<StrategyName>) {
        // Pending temperatures may be those of another plan.
        self.jobs.heat_job = None;
        let Some(strategy) = strategy else {
            self.plans.other = None;
            return;
        };
        let mut other = Other {
            strategy,
            planner: Planner::new(bell(&self.window.ctx, self.window.render_state.as_ref())),
            plan: PlanState::default(),
            looked: Looked::default(),
        };
        (self.their_solid, self.their_flat) = (View3d::default(), View2d::default());
        if self.project().source.is_some() {
            other.plan.restart(false);
            other.planner.plan(&with_strategy(self.project().clone(), strategy), self.view.last);
        }
        self.plans.other = Some(other);
    }

    pub(crate) fn apply_text_size(&self) {
        // What stands in the file may be anything; keys stay within these.
        let percent = self.window.settings.text_percent.clamp(50, 400);
        self.window.ctx.set_zoom_factor(percent as f32 / 100.0);
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
