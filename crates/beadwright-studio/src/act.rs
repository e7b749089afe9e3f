//! Carries out what the user asked for.

use crate::actions::Action;
use crate::export::Export;
use crate::heat;
use crate::jobs::{self, Ask, Job};
use crate::known::OPENING;
use crate::level;
use crate::listing::Listing;
use crate::orient;
use crate::remedy::Change;
use crate::studio::Studio;
use crate::thumbnail::{self, thumbnail};
use crate::trial::{self, Trial};
use crate::view::{Mode, Side};
use crate::view3d::StandardView;
use beadwright::example;
use beadwright::robot::Cell;
use eframe::egui::{TextureOptions, ViewportCommand};
use std::path::Path;

impl Studio {
    /// Carries out an action.
    pub fn act(&mut self, action: Action) {
        match action {
            Action::Open => self.ask(Ask::Open),
            Action::Save => match self.open.file.clone() {
                Some(path) => self.save_to(&path),
                None => self.ask(Ask::SaveProject),
            },
            Action::SaveAs => self.ask(Ask::SaveProject),
            Action::ExportProgram => {
                let program = Export::Program(self.view.dialect.clone());
                self.begin_export(program);
            }
            // Undo must not close the part without a question.
            Action::Undo if self.open.project.undoes() == Some(OPENING) => self.open.asks_undo = true,
            Action::Undo => self.step_back(),
            Action::DecideUndo(goes_on) => {
                self.open.asks_undo = false;
                // Another part may have been opened, or a step taken, while the question was there.
                if goes_on && self.open.project.undoes() == Some(OPENING) {
                    self.step_back();
                }
            }
            Action::Try(change) => self.begin_trial(change),
            Action::EndTrial(keeps) => self.end_trial(keeps),
            Action::Redo => {
                let redone = self.open.project.redo();
                self.went(redone);
            }
            Action::Plan => self.replan(),
            Action::Stop => {
                self.plans.planner.cancel();
                self.plans.own.progress = None;
                if let Some(other) = &mut self.plans.other {
                    other.planner.cancel();
                    other.plan.progress = None;
                }
                self.view.playing = false;
                self.view.pin = None;
                self.view.division = None;
                self.jobs.stop_batch();
                if self.jobs.distortion.as_ref().is_some_and(|distortion| distortion.run.progress().is_some()) {
                    self.stop_distortion();
                }
                if self.jobs.dividing.as_ref().is_some_and(|dividing| dividing.run.progress().is_some()) {
                    self.stop_directions();
                }
            }
            Action::Solid => self.view.switch(Mode::Solid),
            Action::Layer => self.view.switch(Mode::Layer),
            Action::Compare => self.view.switch(Mode::Compare),
            Action::Fit => {
                self.flat.fit();
                self.solid.fit();
            }
            Action::Top => self.look(StandardView::Top),
            Action::Front => self.look(StandardView::Front),
            Action::Right => self.look(StandardView::Right),
            Action::Corner => self.look(StandardView::Iso),
            Action::Up => self.view.step_layer(1, self.plans.own.layer_count()),
            Action::Down => self.view.step_layer(-1, self.plans.own.layer_count()),
            Action::Play => {
                let starts = !self.view.playing && self.plans.own.summary.is_some();
                self.view.play(starts, &self.plans.own.scene);
            }
            Action::Theme => {
                self.window.settings.light = !self.window.settings.light;
                self.apply_theme();
                self.window.store.keep_settings(&self.window.settings);
            }
            Action::PlaceTool => {
                self.view.placing = !self.view.placing;
                self.view.switch(Mode::Solid);
                self.solid.fit();
            }
            Action::Keys => self.view.keys = !self.view.keys,
            Action::Quit => self.window.ctx.send_viewport_cmd(ViewportCommand::Close),
            Action::Ask(what) => self.ask(what),
            Action::Answer(path) => {
                if let (Some(what), Some(path)) = (self.jobs.typed.take(), path) {
                    self.answered(what, &path);
                }
            }
            Action::Export(what) => self.begin_export(what),
            Action::DecideExport(goes_on) => {
                self.jobs.doubted = false;
                if goes_on {
                    self.choose_folder();
                }
            }
            Action::AcceptDamaged => self.change("skip-damaged", |project| project.accept_damaged = true),
            Action::OpenFile(path) => self.open(&path),
            Action::OpenExample(name) => self.open_example(name),
            Action::Speak(language) => {
                self.window.settings.language = language;
                self.window.store.keep_settings(&self.window.settings);
            }
            Action::TextSize(percent) => {
                self.window.settings.text_percent = percent;
                self.apply_text_size();
                self.window.store.keep_settings(&self.window.settings);
            }
            Action::AllParameters(all) => {
                self.window.settings.all_parameters = all;
                self.window.store.keep_settings(&self.window.settings);
            }
            Action::SetValue(key, value) => self.set_value(&key, &value),
            Action::ResetValue(key) => self.reset_values(&[key]),
            Action::ResetValues(keys) => self.reset_values(&keys),
            Action::SetProfile(text) => {
                self.set_profile("profile", Ok(text.to_owned()));
                self.follow_profile();
            }
            Action::Preform(preform) => self.change("preform", |project| project.preform = preform),
            Action::Place(placement) => self.change("placement", |project| project.placement = placement),
            Action::Height(height) => self.change("height", |project| project.height = Some(height)),
            Action::CompareWith(strategy) => self.compare_with(Some(strategy)),
            Action::Dismiss(index) => drop(self.window.messages.remove(index)),
            Action::DismissFailure => self.plans.own.failure = None,
            Action::DrawExample => self.draw_example(),
            Action::LookCloser => self.look_closer(),
            Action::Heat => self.begin_heat(),
            Action::Level => self.begin_level(),
            Action::Orient => self.begin_orienting(),
            Action::FindDirections => self.begin_directions(),
            Action::StopDirections => self.stop_directions(),
            Action::Divide(way) => self.divide(way),
            Action::Distort => self.begin_distortion(),
            Action::List => self.begin_listing(),
            Action::StopDistortion => self.stop_distortion(),
            Action::CloseScan => self.close_scan(),
            Action::Adapt => self.adapt(),
            Action::Batch(paths) => self.begin_batch(paths),
            Action::StopBatch => self.jobs.stop_batch(),
            Action::CloseBuildScan => self.close_build_scan(),
            Action::TakeCell(name) => {
                self.view.cell_chosen = true;
                self.take_cell(name);
            }
            Action::Reach => self.begin_reach(),
            Action::Suggest => self.begin_suggesting(),
            Action::BringBack => {
                if let Some(project) = self.open.lost.take() {
                    self.begin(project);
                }
            }
            Action::LetGo => {
                self.open.lost = None;
                self.forget_lost();
            }
            Action::Leave => self.close(),
            Action::GoOn => self.window.closing = false,
        }
    }

    /// Exports, unless a program should not be started; about one with serious findings the user is asked.
    fn begin_export(&mut self, what: Export) {
        let (program, own) = (what.has_program(), &self.plans.own);
        if let Some(reason) = own.forbidden().first().filter(|_| program).cloned() {
            self.view.side = Side::Findings;
            self.complain(format!("{} {reason} {}", self.t("export-refused"), self.t("export-refused-help")));
            return;
        }
        self.jobs.doubted = program && own.serious().next().is_some();
        self.jobs.exporting = what;
        if !self.jobs.doubted {
            self.choose_folder();
        }
    }

    /// Writes into the folder that is given, or asks for one.
    fn choose_folder(&mut self) {
        let folder = self.view.folder.trim().to_owned();
        match folder.as_str() {
            "" => self.ask(Ask::Folder),
            folder => self.answered(Ask::Folder, Path::new(folder)),
        }
    }

    /// Draws the picture of one example, so that no frame takes long.
    fn draw_example(&mut self) {
        let (ctx, drawn) = (&self.window.ctx, &mut self.window.pictures);
        let Some(example) = example::ALL.get(drawn.len()) else { return };
        let scale = ctx.pixels_per_point().ceil() as usize;
        let picture = thumbnail(&example.mesh(), thumbnail::SIZE.map(|length| length * scale));
        drawn.push(ctx.load_texture(example.name, picture, TextureOptions::LINEAR));
        ctx.request_repaint();
    }

    /// Computes the steps of the strategies in the layer in view.
    fn look_closer(&mut self) {
        let (ctx, layer) = (&self.window.ctx, self.view.last);
        let own = &self.plans.own;
        self.jobs.looked.begin(ctx, own.layer(layer), own.profile.as_ref());
        if let Some(other) = self.plans.other.as_mut().filter(|_| self.view.mode == Mode::Compare) {
            other.looked.begin(ctx, other.plan.layer(layer), other.plan.profile.as_ref());
        }
    }

    /// Computes what the robot of the selected cell can reach.
    fn begin_reach(&mut self) {
        if let Some(profile) = self.plans.own.profile.clone() {
            let (cell, layers) = (self.view.cell.clone(), self.plans.own.layers.clone());
            self.jobs.cell = Cell::built_in(&cell).ok();
            self.jobs.reach_job = Some(jobs::reach(&self.window.ctx, cell, layers, profile));
        }
    }

    /// Looks for a place of the part that the cell reaches better.
    fn begin_suggesting(&mut self) {
        if let Some((profile, cell)) = self.plans.own.profile.clone().zip(self.jobs.cell.clone()) {
            let layers = self.plans.own.layers.clone();
            self.jobs.suggest_job = Some(jobs::suggest(&self.window.ctx, cell, layers, profile));
        }
    }

    /// Computes how warm the metal is where passes begin, in the plan and then in the one it is compared with.
    fn begin_heat(&mut self) {
        self.jobs.heat_of_other = !self.plans.own.is_cold();
        let other = self.plans.other.as_ref().map(|other| &other.plan);
        let plan = if self.jobs.heat_of_other { other } else { Some(&self.plans.own) };
        if let Some((plan, profile)) = plan.and_then(|plan| Some((plan, plan.profile.clone()?))) {
            self.jobs.heat_job = Some(heat::heat(&self.window.ctx, plan.layers.clone(), profile));
        }
    }

    /// Writes the program, and finds out where the torch is at each of its lines.
    fn begin_listing(&mut self) {
        let own = &self.plans.own;
        let (Some(header), Some(profile)) = (own.header.clone(), own.profile.clone()) else { return };
        let (layers, dialect) = (own.layers.clone(), self.view.dialect.clone());
        self.jobs.listing_job = Some(Job::start(&self.window.ctx, move || {
            let listing = Listing::of(&header, &profile, &layers, &dialect);
            (dialect, listing)
        }));
    }

    /// Looks for the way up in which the part costs least.
    fn begin_orienting(&mut self) {
        let own = &self.plans.own;
        if let Some(part) = own.part.clone() {
            let preform = own.profile.clone().filter(|_| self.project().preform);
            self.jobs.orient_job = Some(orient::orient(&self.window.ctx, part, self.project().placement, preform));
        }
    }

    /// Computes how far layers lean from level.
    fn begin_level(&mut self) {
        let own = &self.plans.own;
        if let Some(profile) = own.profile.clone() {
            let (layers, drawn) = (own.layers.clone(), own.scene.layers().to_vec());
            self.jobs.level_job = Some(level::level(&self.window.ctx, layers, drawn, profile));
        }
    }

    /// Makes a change, to be kept or taken back.
    fn begin_trial(&mut self, change: Change) {
        let Some(before) = trial::figures(&self.plans.own) else { return };
        let (from, was) = (self.known().value_now(change.key), self.project().clone());
        self.open.project.seal();
        self.set_value(change.key, &change.value);
        self.open.project.seal();
        if *self.project() == was {
            // The value was refused, or it is the same.
            self.open.refused.clone().into_iter().for_each(|(_, reason)| self.complain(reason));
            return;
        }
        self.open.trial = Some(Trial { change, from, before, was, tried: self.project().clone() });
    }

    /// Keeps the change that is tried, or takes it back.
    fn end_trial(&mut self, keeps: bool) {
        let is_tried = self.known().trial().is_some();
        if let Some(trial) = self.open.trial.take().filter(|_| is_tried && !keeps) {
            self.open.project.seal();
            self.change(trial.change.key, |project| *project = trial.was);
            self.open.project.seal();
        }
    }

    /// Undoes a step.
    fn step_back(&mut self) {
        let undone = self.open.project.undo();
        self.went(undone);
    }

    /// Follows an undo or redo; `gone` says whether there was a step to take.
    fn went(&mut self, gone: bool) {
        // Before this file was opened there was another project, which must not be saved into this file.
        if self.open.project.steps() < self.open.opened {
            self.open.file = None;
            (self.view.adapt, self.jobs.adapting) = (None, None);
        }
        self.open.refused = None;
        if gone {
            self.replan();
        }
    }

    fn look(&mut self, from: StandardView) {
        self.solid.camera.set_view(from);
        self.solid.fit();
    }
}
