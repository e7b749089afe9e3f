//! Opening and writing files: models, projects, programs, pictures.

use crate::batch::{self, Batch};
use crate::computing::Computing;
use crate::disk;
use crate::export::Export;
use crate::jobs::{self, Ask};
use crate::project::{Project, Source};
use crate::studio::Studio;
use beadwright::bead::library::BeadLibrary;
use beadwright::profile::Profile;
use beadwright::task::Stage;
use eframe::egui::DroppedFileHandle;
use std::io::Cursor;
use std::path::{Path, PathBuf};

impl Studio {
    /// Opens a model or a project.
    pub fn open(&mut self, path: &Path) {
        // A project keeps the path and may be opened from any working directory, so the path must be absolute.
        let path = &std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        if is_project(path) {
            self.open_project(path);
        } else {
            self.open.file = None;
            self.open_model(Source::File(path.to_owned()));
        }
        self.window.settings.remember(path);
        self.window.store.keep_settings(&self.window.settings);
    }

    /// Opens files dropped on the window.
    pub(crate) fn open_dropped(&mut self, files: Vec<DroppedFileHandle>) {
        #[cfg(not(target_arch = "wasm32"))]
        match &files[..] {
            several @ [_, _, ..] if !several.iter().any(|file| is_project(file.path())) => {
                self.begin_batch(several.iter().map(|file| file.path().to_owned()).collect());
            }
            files => files.iter().for_each(|file| self.open(file.path())),
        }
        // Browsers read files later.
        #[cfg(target_arch = "wasm32")]
        if !files.is_empty() {
            self.jobs.dialog = Some(jobs::receive(&self.window.ctx, files));
        }
    }

    /// Opens one of the example parts.
    pub fn open_example(&mut self, name: &str) {
        self.open.file = None;
        self.open_model(Source::Example(name.to_owned()));
    }

    fn open_model(&mut self, source: Source) {
        let profile = self.project().profile.clone();
        let project = Project { source: Some(source), profile, ..Project::default() };
        self.begin(project);
    }

    fn open_project(&mut self, path: &Path) {
        let named = |error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
        let project = disk::text(path);
        let project = project.and_then(|text| Project::read(&text, path.parent()).map_err(|error| named(&error)));
        match project {
            Ok(project) => {
                self.open.file = Some(path.to_owned());
                self.begin(project);
            }
            Err(error) => self.complain(error),
        }
    }

    /// Writes the project file.
    pub fn save_to(&mut self, path: &Path) {
        let written = self.project().write(path.parent());
        let written = written.and_then(|text| disk::write(path, text.as_bytes()));
        match written {
            Ok(()) => {
                self.open.saved = self.project().clone();
                self.open.file = Some(path.to_owned());
                self.window.settings.remember(path);
                self.window.store.keep_settings(&self.window.settings);
                self.say(format!("{} {}", self.t("written"), path.display()));
            }
            Err(error) => self.complain(error),
        }
    }

    /// Writes into a folder: a program, a file of the plan, or everything that `beadwright plan` writes.
    pub fn export(&mut self, what: &Export, folder: &Path) {
        let done = what.write(&self.plans.own, folder);
        self.report(folder, done);
    }

    fn report(&mut self, folder: &Path, done: Result<Vec<String>, String>) {
        const SHOWN: usize = 4;
        match done {
            Ok(names) => {
                let more = if names.len() > SHOWN { ", …" } else { "" };
                let names = names.iter().take(SHOWN).cloned().collect::<Vec<_>>().join(", ");
                self.say(format!("{} {}: {names}{more}", self.t("written"), folder.display()));
            }
            Err(error) => self.complain(error),
        }
    }

    /// Plans several models one after another, with the profile of the project.
    pub fn begin_batch(&mut self, paths: Vec<PathBuf>) {
        let profile = self.known().parsed().map_or_else(String::new, |parsed| parsed.profile.name.clone());
        let (mut batch, work) = Batch::of(paths, self.project(), profile);
        batch.run = Some(Computing::start(&self.window.ctx, Stage::Plan, work));
        (self.jobs.batch, self.view.batch) = (Some(batch), true);
    }

    /// Asks for a file or a folder.
    pub(crate) fn ask(&mut self, what: Ask) {
        let name = self.project().part();
        self.jobs.dialog = Some(jobs::ask(&self.window.ctx, what, &name));
    }

    /// Asks for a path to be typed, as on a desktop without file dialogs.
    pub fn ask_in_words(&mut self, what: Ask) {
        let named = |extension: &str| format!("{}.{extension}", self.project().part());
        let first = match what {
            Ask::SaveProject => named("bwp"),
            Ask::SavePicture => named("png"),
            Ask::Open | Ask::Folder | Ask::BatchFolder | Ask::OpenProfile | Ask::OpenBeads => String::new(),
            Ask::OpenScan | Ask::OpenBuildScan => String::new(),
        };
        (self.jobs.typed, self.view.typed) = (Some(what), first);
    }

    pub(crate) fn answered(&mut self, what: Ask, path: &Path) {
        match what {
            Ask::Open => self.open(path),
            Ask::SaveProject => self.save_to(path),
            Ask::SavePicture => self.save_picture(path),
            Ask::OpenBeads => self.open_beads(path),
            Ask::OpenScan => self.open_scan(path),
            Ask::BatchFolder => match batch::models(path) {
                Ok(models) => self.begin_batch(models),
                Err(error) => self.complain(error),
            },
            Ask::OpenBuildScan => self.open_build_scan(path),
            Ask::OpenProfile => {
                let text = disk::text(path);
                let checked = text.and_then(|text| Profile::parse(&text).map(|_| text).map_err(|e| e.to_string()));
                match checked {
                    Ok(text) => {
                        self.set_profile("profile", Ok(text));
                        self.follow_profile();
                    }
                    Err(error) => self.complain(error),
                }
            }
            Ask::Folder => {
                let what = self.jobs.exporting.clone();
                self.export(&what, path);
            }
        }
    }

    /// Shows a bead library, as `beadwright bead fit` writes it.
    pub fn open_beads(&mut self, path: &Path) {
        let named = |error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
        match disk::text(path).and_then(|text| BeadLibrary::parse(&text).map_err(|error| named(&error))) {
            Ok(library) => self.jobs.beads = Some(library),
            Err(error) => self.complain(error),
        }
    }

    /// Writes a picture of the 3-D view.
    pub fn save_picture(&mut self, path: &Path) {
        const SIZE: [u32; 2] = [1920, 1200];
        let Some(render_state) = &self.window.render_state else { return };
        let style = self.known().style(&self.view);
        let picture = self.solid.picture(render_state, &self.plans.own.scene, &style, SIZE);
        let written = picture.and_then(|(width, height, pixels)| {
            let (colours, format) = (image::ColorType::Rgba8, image::ImageFormat::Png);
            let mut bytes = Cursor::new(Vec::new());
            let drawn = image::write_buffer_with_format(&mut bytes, &pixels, width, height, colours, format);
            drawn.map_err(|error| format!("{}: {error}.", path.display()))?;
            disk::write(path, bytes.get_ref())
        });
        match written {
            Ok(()) => self.say(format!("{} {}", self.t("written"), path.display())),
            Err(error) => self.complain(error),
        }
    }
}

fn is_project(path: &Path) -> bool {
    path.extension().is_some_and(|end| end.eq_ignore_ascii_case("bwp"))
}
