//! One frame of the window: receive what has happened, do what was asked for, draw the panels.

use crate::actions;
use crate::computing::Computing;
use crate::jobs::{self, Answer};
use crate::known::Queue;
use crate::panels;
use crate::settings::text_percent;
use crate::studio::Studio;
use crate::view3d::Colour;
use eframe::egui::{self, ViewportCommand};

impl Studio {
    /// Receives what has happened in the background.
    fn hear(&mut self) {
        for event in self.plans.planner.events() {
            self.plans.own.take(event);
        }
        if let Some(other) = &mut self.plans.other {
            for event in other.planner.events() {
                other.plan.take(event);
            }
        }
        self.hear_of_adapting();
        self.jobs.batch.iter_mut().filter_map(|batch| batch.run.as_mut()).for_each(Computing::hear);
        self.view.follow(self.plans.own.layer_count());
        match jobs::take(&mut self.jobs.dialog) {
            Some(Ok(Answer { what, path: Some(path), .. })) => self.answered(what, &path),
            Some(Ok(Answer { what, path: None, seen: false })) => self.ask_in_words(what),
            Some(Ok(_)) | None => {}
            Some(Err(error)) => self.complain(error),
        }
        let theirs = self.plans.other.as_mut().map_or(Ok(()), |other| other.looked.hear());
        if let Err(error) = self.jobs.looked.hear().and(theirs) {
            // Do not retry: it would only fail again.
            self.view.show.regions = false;
            self.complain(error);
        }
        match jobs::take(&mut self.jobs.heat_job) {
            Some(Ok(Ok(temperatures))) if temperatures.iter().any(|layer| !layer.is_empty()) => {
                let other = self.plans.other.as_mut().map(|other| &mut other.plan);
                let plan = if self.jobs.heat_of_other { other } else { Some(&mut self.plans.own) };
                if let Some(plan) = plan {
                    for (layer, temperatures) in temperatures.into_iter().enumerate() {
                        plan.scene.set_temperatures(layer, temperatures);
                    }
                }
            }
            // Nothing to show; do not try again.
            Some(Ok(Ok(_))) => self.view.colour = Colour::Kind,
            Some(Ok(Err(error)) | Err(error)) => {
                self.view.colour = Colour::Kind;
                self.complain(error);
            }
            None => {}
        }
        match jobs::take(&mut self.jobs.level_job) {
            Some(Ok(leans)) if leans.iter().any(|layer| !layer.is_empty()) => {
                for (layer, leans) in leans.into_iter().enumerate() {
                    self.plans.own.scene.set_leans(layer, leans);
                }
            }
            // Nothing to show; do not try again.
            Some(Ok(_)) => self.view.colour = Colour::Kind,
            Some(Err(error)) => {
                self.view.colour = Colour::Kind;
                self.complain(error);
            }
            None => {}
        }
        match jobs::take(&mut self.jobs.orient_job) {
            Some(Ok(turn)) => self.change("placement", |project| project.placement.turn = turn),
            Some(Err(error)) => self.complain(error),
            None => {}
        }
        match jobs::take(&mut self.jobs.listing_job) {
            Some(Ok(listing)) => {
                self.jobs.listing = Some(listing);
                (self.view.listed, self.view.file) = (None, None);
            }
            // Do not try again: it would only fail again.
            Some(Err(error)) => self.jobs.listing = Some((self.view.dialect.clone(), Err(error))),
            None => {}
        }
        self.hear_of_scan();
        self.hear_of_distortion();
        self.hear_of_directions();
        match jobs::take(&mut self.jobs.suggest_job) {
            Some(Ok(found)) => self.jobs.suggested = Some(found),
            Some(Err(error)) => self.complain(error),
            None => {}
        }
        match jobs::take(&mut self.jobs.reach_job) {
            Some(Ok(Ok(reach))) => {
                self.jobs.reach = Some(reach);
                if self.view.robot {
                    self.solid.fit();
                }
            }
            Some(Ok(Err(error)) | Err(error)) => {
                // Do not retry: it would only fail again.
                self.view.robot = false;
                self.complain(error);
            }
            None => {}
        }
    }

    /// Asks before closing the window would lose changes.
    fn hold(&mut self) {
        if self.is_changed() && self.window.ctx.input(|input| input.viewport().close_requested()) {
            self.window.ctx.send_viewport_cmd(ViewportCommand::CancelClose);
            self.window.closing = true;
        }
    }

    /// Autosaves the project when it has changed.
    fn keep(&mut self) {
        if *self.open.project.now() != self.open.kept {
            self.open.kept = self.open.project.now().clone();
            if let Err(error) = self.window.store.keep_project(&self.open.kept) {
                self.complain(error);
            }
        }
    }
}

impl eframe::App for Studio {
    fn ui(&mut self, ui: &mut egui::Ui, _: &mut eframe::Frame) {
        self.hear();
        self.hold();
        for action in actions::pressed(&self.window.ctx) {
            self.act(action);
        }
        let dropped = self.window.ctx.input(|input| input.raw.dropped_files.clone());
        self.open_dropped(dropped);
        self.parse();
        let (known, mut view) = self.parts();
        let mut queue = Queue::new();
        panels::show(known, &mut view, &mut queue, ui);
        for action in queue {
            self.act(action);
        }
        if self.window.ctx.input(|input| input.pointer.any_pressed() || input.pointer.any_released()) {
            self.open.project.seal();
        }
        self.keep();
    }

    fn on_exit(&mut self) {
        self.window.settings.text_percent = text_percent(&self.window.ctx);
        self.window.store.keep_settings(&self.window.settings);
        // If the user has not decided about the lost project, ask again at the next start.
        match &self.open.lost {
            Some(lost) => drop(self.window.store.keep_project(lost)),
            None => self.window.store.forget_project(),
        }
    }
}
