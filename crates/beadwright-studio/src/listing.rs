//! The lines of a program, and where the torch is at each of them.
//!
//! The program is written in its dialect and read back, so that every move knows its line. Runs of moves with the arc on are the
//! passes of the plan, in their order; within a pass, and on the way to it, places are matched by their share of the length.

use crate::view3d::{LayerBeads, Position, Scene};
use beadwright::dialect::{self, reading};
use beadwright::layer::Layer;
use beadwright::plan::Header;
use beadwright::profile::Profile;
use std::ops::Range;
use std::sync::Arc;

/// A torch that is this far beyond the end of a move, mm, is still there: programs and pictures round their places.
const SAME: f64 = 0.01;

/// A program as text, with the way of the torch.
pub struct Listing {
    /// The dialect.
    pub dialect: String,
    files: Vec<File>,
    /// The moves, in the order of the program; none where they cannot be matched with the plan.
    steps: Vec<Step>,
}

/// A file of a program.
pub struct File {
    /// Its name.
    pub name: String,
    text: String,
    /// Where its lines begin in its text.
    begins: Vec<usize>,
    /// Number of lines of the files before it.
    before: usize,
}

/// A place on the way of the torch.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
struct Place {
    /// The pass, counted over the whole program.
    pass: usize,
    /// Whether it lies on the pass, not on the way to it.
    laid: bool,
    /// Share of the length that is done, 0 to 1.
    part: f64,
}

/// The end of a move, and its line, counted from 0 over all files.
#[derive(Debug, Clone, Copy)]
struct Step {
    place: Place,
    line: usize,
}

impl Listing {
    /// The program of a plan in a dialect.
    ///
    /// # Errors
    /// A sentence on why it cannot be written.
    pub fn of(header: &Header, profile: &Profile, layers: &[Arc<Layer>], dialect: &str) -> Result<Self, String> {
        let job = profile.job(&header.part);
        let written = dialect::writer(dialect, &job)
            .and_then(|writer| dialect::write_with(writer, &header.extent, layers, &job))
            .map_err(|error| error.to_string())?;
        let mut written: Vec<(String, String)> = written.into_iter().collect();
        // Parts of a program have numbers: the tenth comes after the second.
        written.sort_by(|(a, _), (b, _)| (a.len(), a).cmp(&(b.len(), b)));
        let mut files: Vec<File> = Vec::with_capacity(written.len());
        for (name, text) in written {
            let before = files.last().map_or(0, |file| file.before + file.len());
            files.push(File::new(name, text, before));
        }
        let passes = layers.iter().flat_map(|layer| &layer.passes).filter(|pass| pass.points.len() > 1).count();
        let steps = whole(&files, passes, |main| steps(&files, main, profile, dialect));
        Ok(Self { dialect: dialect.to_owned(), files, steps })
    }

    /// Its files.
    pub fn files(&self) -> &[File] {
        &self.files
    }

    /// The file of a line.
    pub fn file(&self, line: usize) -> Option<&File> {
        self.files.iter().rfind(|file| file.before <= line)
    }

    /// The line that the controller is at with the torch at this position.
    pub fn line(&self, scene: &Scene, at: &Position) -> Option<usize> {
        let beads = scene.layer(at.layer)?;
        let before: usize = scene.layers()[..at.layer].iter().flatten().map(|layer| passes(layer).count()).sum();
        let pass = before + passes(beads).take_while(|pass| *pass < at.pass).count();
        let laid = || (beads.laid(at.pass, at.segment, at.torch.at) - SAME) / length(beads, at.pass);
        let part = at.come.unwrap_or_else(laid);
        let place = Place { pass, laid: at.come.is_none(), part };
        let next = self.steps.partition_point(|step| step.place < place);
        self.steps.get(next).or(self.steps.last()).map(|step| step.line)
    }

    /// The time at which the controller has done a line, s from the start of the program; for a line without a move, that of the
    /// next move in its file.
    pub fn seconds(&self, scene: &Scene, line: usize) -> Option<f64> {
        let within = self.file(line)?.lines();
        let below = self.steps.iter().enumerate().filter(|(_, step)| within.contains(&step.line) && step.line >= line);
        let (first, Step { line, .. }) = below.min_by_key(|(_, step)| step.line)?;
        // An arc has several moves, all of its line.
        let of_line = self.steps[first..].iter().take_while(|step| step.line == *line);
        let Place { pass, laid, part } = of_line.last()?.place;
        let all = scene.layers().iter().enumerate().filter_map(|(i, layer)| Some((i, layer.as_deref()?)));
        let mut of_program = all.flat_map(|(i, layer)| passes(layer).map(move |pass| (i, layer, pass)));
        let (index, layer, pass) = of_program.nth(pass)?;
        let span = layer.passes().get(pass)?;
        let within =
            if laid { time(layer, pass, part)? } else { span.travel_start + part * (span.arrival - span.travel_start) };
        Some(scene.seconds_before(index) + within)
    }
}

impl File {
    fn new(name: String, text: String, before: usize) -> Self {
        let mut begins = vec![0];
        begins.extend(text.bytes().enumerate().filter(|(_, byte)| *byte == b'\n').map(|(i, _)| i + 1));
        begins.pop_if(|begin| *begin == text.len());
        Self { name, text, begins, before }
    }

    fn len(&self) -> usize {
        self.begins.len()
    }

    /// Its lines, counted over all files.
    pub fn lines(&self) -> Range<usize> {
        self.before..self.before + self.len()
    }

    /// The text of a line, counted over all files.
    pub fn line(&self, line: usize) -> &str {
        let at = |i: usize| self.begins.get(i).copied().unwrap_or(self.text.len());
        let i = line.saturating_sub(self.before);
        self.text.get(at(i)..at(i + 1)).unwrap_or_default().trim_end()
    }

    /// Its text below as many empty lines as the files before it have, so that its lines have numbers of their own.
    fn numbered(&self) -> String {
        format!("{}{}", "\n".repeat(self.before), self.text)
    }
}

/// The moves of a program that begins in a file.
fn steps(files: &[File], main: &File, profile: &Profile, dialect: &str) -> Vec<Step> {
    let mut module = |name: &str| {
        let found = |file: &&File| dialect::may_be_module(&file.name, name);
        files.iter().filter(found).max_by_key(|file| file.len()).map(File::numbered)
    };
    let options = profile.reading_options(Some(&main.name), Some(dialect));
    let Ok(read) = reading::read(&main.numbered(), &mut module, &options) else { return Vec::new() };
    let (mut steps, mut pass) = (Vec::new(), 0);
    let mut from = read.moves.first().map(|step| step.to).unwrap_or_default();
    for run in read.moves.chunk_by(|a, b| a.metal.is_laid() == b.metal.is_laid()) {
        let laid = run.first().is_some_and(|step| step.metal.is_laid());
        let (begin, mut length) = (steps.len(), 0.0);
        for step in run {
            length += from.distance(step.to);
            from = step.to;
            steps.push(Step { place: Place { pass, laid, part: length }, line: step.line - 1 });
        }
        steps[begin..].iter_mut().for_each(|step| step.place.part /= length.max(f64::MIN_POSITIVE));
        pass += usize::from(laid);
    }
    steps
}

/// The moves of a program with this many passes, none if they are not found. Its main file is the one from which all passes are
/// reached; some languages divide a program into several of them.
fn whole(files: &[File], passes: usize, read: impl Fn(&File) -> Vec<Step>) -> Vec<Step> {
    let mut each = Vec::with_capacity(files.len());
    for main in files {
        let steps = read(main);
        if count(&steps) == passes {
            return steps;
        }
        each.push(steps);
    }
    let all = joined(&each);
    if count(&all) == passes { all } else { Vec::new() }
}

/// The moves of programs that follow each other.
fn joined(programs: &[Vec<Step>]) -> Vec<Step> {
    let (mut joined, mut before) = (Vec::new(), 0);
    for steps in programs {
        let later = |step: &Step| Step { place: Place { pass: step.place.pass + before, ..step.place }, ..*step };
        joined.extend(steps.iter().map(later));
        before += count(steps);
    }
    joined
}

/// The number of passes of a program.
fn count(steps: &[Step]) -> usize {
    steps.iter().rfind(|step| step.place.laid).map_or(0, |step| step.place.pass + 1)
}

/// The passes of a layer that lay metal.
fn passes(layer: &LayerBeads) -> impl Iterator<Item = usize> {
    layer.passes().iter().enumerate().filter(|(_, pass)| !pass.segments.is_empty()).map(|(i, _)| i)
}

/// The length of a pass, mm.
fn length(layer: &LayerBeads, pass: usize) -> f64 {
    let segments = layer.passes()[pass].segments.clone();
    layer.beads()[segments].iter().map(|bead| bead.length()).sum::<f64>().max(f64::MIN_POSITIVE)
}

/// The time at which a share of a pass is laid, s from the start of its layer.
fn time(layer: &LayerBeads, pass: usize, part: f64) -> Option<f64> {
    let (mut left, segments) = (part * length(layer, pass), layer.passes()[pass].segments.clone());
    let last = segments.clone().last()?;
    for segment in segments {
        let long = layer.beads()[segment].length();
        if left <= long || segment == last {
            let (begin, end) = layer.times(segment)?;
            return Some(begin + (end - begin) * (left / long.max(f64::MIN_POSITIVE)).min(1.0));
        }
        left -= long;
    }
    None
}
