//! Writing a program: the common part of all dialects.
//!
//! A writer does no I/O: it returns [`Chunk`]s, text to be appended to a named file, layer by layer.

mod extra;
pub(super) mod frame;
mod hooks;
pub(in crate::dialect) mod in_cell;
mod names;
pub(super) mod needs;
pub(super) mod orientation;
mod placeholders;
pub(super) mod restart;
pub(super) mod split;
pub(super) mod volumes;

pub use extra::Extra;
pub use hooks::Hooks;
pub(super) use names::upper_name;
pub use placeholders::PLACEHOLDERS;
pub(super) use placeholders::Values;

use super::own::OwnError;
use super::{ALL, Dialect, Sections, find, names};
use crate::program::{LayerProgram, ProgramSettings, Programmer, Safety, Turns, Weave};
use bead_plan::bead::Bead;
use bead_plan::layer::{Extent, Layer};
use bead_plan::weld::WeldSettings;
use glam::DVec3;
use std::borrow::Borrow;
use std::collections::BTreeMap;

/// Text to be appended to a file of the program.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Chunk {
    /// File name without a folder.
    pub file: String,
    /// ASCII text with the line ends of the controller.
    pub text: String,
}

impl Chunk {
    /// Text for a file.
    pub fn new(file: impl Into<String>, text: impl Into<String>) -> Self {
        Self { file: file.into(), text: text.into() }
    }
}

/// Writes a program in one dialect.
pub trait Writer: Send {
    /// The text before the first layer; `extent` is that of the part.
    fn begin(&mut self, extent: &Extent) -> Vec<Chunk>;

    /// One layer.
    fn layer(&mut self, program: &LayerProgram) -> Vec<Chunk>;

    /// The text after the last layer; the torch is clear of the part.
    fn end(&mut self) -> Vec<Chunk>;

    /// Whether the controller weaves by itself if the job weaves; otherwise the weave is written as moves.
    fn weaves(&self) -> bool {
        false
    }

    /// Remarks about the finished program, as sentences.
    fn notes(&self) -> Vec<String> {
        Vec::new()
    }

    /// Why the program is incomplete, if something went wrong while writing; none of it may then be used. [User-defined
    /// dialects](crate::dialect::own) can fail once they have begun, and so can controls that cannot jump far enough.
    fn failure(&self) -> Option<DialectError> {
        None
    }
}

/// What is to be written: everything that a dialect needs besides the layers.
#[derive(Debug, Clone)]
pub struct Job<'a> {
    /// Name of the part; files and modules are named after it.
    pub part: String,
    /// Name of the profile, for comments.
    pub profile: String,
    /// The sections of the profile for the dialects.
    pub sections: &'a Sections,
    /// The nominal bead.
    pub bead: Bead,
    /// Thickness of a layer, mm.
    pub layer_height: f64,
    /// Diameter of the wire, mm.
    pub wire_diameter: f64,
    /// Arc, wire, speeds, and how passes begin and end.
    pub weld: WeldSettings,
    /// How paths become moves.
    pub program: &'a ProgramSettings,
    /// What the cell must supply.
    pub safety: &'a Safety,
    /// The weave along a pass, if any.
    pub weave: Option<&'a Weave>,
    /// Whether the program only moves, with arc, gas and wire always off.
    pub dry_run: bool,
}

impl Job<'_> {
    /// Makes the instructions of the layers, for controllers that weave by themselves or for those that do not.
    pub fn programmer(&self, weaves: bool) -> Programmer {
        Programmer::of(&self.weld, self.program, self.dry_run).woven(self.weave.filter(|_| !weaves))
    }

    /// The weave, if the controller performs it along with the arc; a dry run has none.
    pub(super) fn weave(&self) -> Option<Weave> {
        self.weave.filter(|_| !self.dry_run).cloned()
    }

    /// A comment for the head of files.
    pub(super) fn comment(&self) -> String {
        format!("{}, {}", ascii(&self.part), ascii(&self.profile))
    }

    /// Comments of at most `width` characters that say what the cell must supply.
    pub(super) fn supplies(&self, width: usize) -> Vec<String> {
        let sentences = self.safety.supplies.iter().flat_map(|text| wrapped(text, width));
        let head = (!self.safety.supplies.is_empty()).then(|| "The cell must supply:".to_owned());
        head.into_iter().chain(sentences).collect()
    }
}

/// Why a program cannot be written in a dialect.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DialectError {
    /// No such dialect.
    #[error("there is no post \"{0}\". The posts are {known}. A folder with a dialect of your own is given with its path, such as ./{0}.", known = names().join(", "))]
    Unknown(String),
    /// The profile lacks the section of the dialect.
    #[error("profile \"{profile}\" has no [{dialect}] section, which the post \"{dialect}\" needs.")]
    NoSection {
        /// Name of the profile.
        profile: String,
        /// Name of the dialect, and of its section.
        dialect: &'static str,
    },
    /// The profile lacks a key of the dialect that its other keys need.
    #[error("profile \"{profile}\" has no {key} that {why} needs. {remedy}")]
    NoKey {
        /// Name of the profile.
        profile: String,
        /// Full key, such as `krl.wire_feed`.
        key: String,
        /// What needs it.
        why: String,
        /// What to write, or what to leave out.
        remedy: String,
    },
    /// The dialect cannot do what the profile asks for.
    #[error("the post \"{dialect}\" cannot write {what}. {remedy}")]
    Cannot {
        /// Name of the dialect.
        dialect: &'static str,
        /// What it cannot write.
        what: &'static str,
        /// What to do.
        remedy: &'static str,
    },
    /// Two programs would be written to one file.
    #[error(
        "the posts \"{first}\" and \"{second}\" would both write {file}. Ask for one of them, or give them different extensions."
    )]
    SameFile {
        /// The file.
        file: String,
        /// The dialect that comes first.
        first: String,
        /// The other one, or the same again.
        second: String,
    },
    /// The part does not fit on the printer's bed.
    #[error(
        "the part is {:.1} × {:.1} × {:.1} mm, and the bed has {:.0} × {:.0} × {:.0} mm (marlin.bed). Turn the part or make it \
         smaller, or give the size of your printer.",
        part.x, part.y, part.z, bed[0], bed[1], bed[2]
    )]
    OffBed {
        /// Length, width and height of the part, mm.
        part: DVec3,
        /// Length, width and height that the printer reaches, mm.
        bed: [f64; 3],
    },
    /// The profile has an axis that the dialect does not write.
    #[error("the post \"{dialect}\" does not write {key}; {others} do. Remove the key, and move the axis by hand.")]
    NoAxis {
        /// Name of the dialect.
        dialect: &'static str,
        /// The key of the axis.
        key: &'static str,
        /// The dialects that write it.
        others: String,
    },
    /// The user's own templates are broken, or write less than the job asks for.
    #[error(transparent)]
    Own(#[from] OwnError),
}

/// Refuses axes that a dialect does not write.
fn check_axes(dialect: &'static Dialect, program: &ProgramSettings) -> Result<(), DialectError> {
    let refuse = |key: &'static str, writes: fn(&Dialect) -> bool| {
        let names: Vec<&str> = ALL.iter().filter(|other| writes(other)).map(|other| other.name).collect();
        Err(DialectError::NoAxis { dialect: dialect.name, key, others: names.join(" and ") })
    };
    match turning_key(program) {
        _ if program.linear_axis.is_some() && !dialect.linear_axis => {
            refuse("program.linear_axis", |dialect| dialect.linear_axis)
        }
        Some(key @ POSITIONER) if !dialect.positioner => refuse(key, |dialect| dialect.positioner),
        Some(key) if key != POSITIONER && !dialect.table => refuse(key, |dialect| dialect.table),
        _ => Ok(()),
    }
}

/// The key of a positioner.
const POSITIONER: &str = "program.positioner";

/// The key of the axes that turn the part; `None` if there are none.
fn turning_key(program: &ProgramSettings) -> Option<&'static str> {
    let keys = [
        (program.positioner.is_some(), POSITIONER),
        (program.table_side.is_some(), "program.table_side"),
        (program.table_angle.is_some(), "program.table_angle"),
    ];
    keys.into_iter().find(|(is_set, _)| *is_set).map(|(_, key)| key)
}

/// A writer for a program in the dialect with this name.
///
/// # Errors
/// [`DialectError`] when there is no such dialect, the profile lacks its section, or the job asks for more than it can
/// write.
pub fn writer(name: &str, job: &Job<'_>) -> Result<Box<dyn Writer>, DialectError> {
    let dialect = find(name).ok_or_else(|| DialectError::Unknown(name.to_owned()))?;
    let missing = || DialectError::NoSection { profile: job.profile.clone(), dialect: dialect.name };
    let section = job.sections.get(name).ok_or_else(missing)?;
    check_axes(dialect, job.program)?;
    if let (Some(table), Some(why)) = (section.table().filter(|table| !table.known), turning_key(job.program)) {
        let (profile, key, remedy) = (job.profile.clone(), table.key.to_owned(), table.what.to_owned());
        return Err(DialectError::NoKey { profile, key, why: why.to_owned(), remedy });
    }
    extra::check(dialect.name, section, job)?;
    section.writer(job)
}

/// The whole program of some layers in one dialect: the text of each file by its name. Long programs are better written
/// layer by layer.
///
/// # Errors
/// [`DialectError`].
pub fn write<L: Borrow<Layer>>(
    name: &str,
    layers: &[L],
    job: &Job<'_>,
) -> Result<BTreeMap<String, String>, DialectError> {
    write_with(writer(name, job)?, &Extent::of(layers), layers, job)
}

/// The same with a given writer, and with the part's extent: [`write()`] takes that of its passes.
///
/// # Errors
/// [`DialectError`] of the writer.
pub fn write_with<L: Borrow<Layer>>(
    mut writer: Box<dyn Writer>,
    extent: &Extent,
    layers: &[L],
    job: &Job<'_>,
) -> Result<BTreeMap<String, String>, DialectError> {
    let mut programmer = job.programmer(writer.weaves());
    let (mut chunks, mut turns) = (writer.begin(extent), Turns::default());
    for layer in layers {
        turns.take(layer.borrow()).iter().for_each(|layer| chunks.extend(writer.layer(&programmer.layer(layer))));
    }
    turns.end().iter().for_each(|layer| chunks.extend(writer.layer(&programmer.layer(layer))));
    chunks.extend(writer.end());
    let mut files = BTreeMap::<String, String>::new();
    for chunk in chunks {
        files.entry(chunk.file).or_default().push_str(&chunk.text);
    }
    writer.failure().map_or(Ok(files), Err)
}

/// A wait, s, split into pieces of at most `most`, the longest that a controller accepts at once.
pub(super) fn waits(seconds: f64, most: f64) -> impl Iterator<Item = f64> {
    let count = (seconds / most).ceil().max(1.0);
    (0..count as usize).map(move |i| (seconds - i as f64 * most).min(most))
}

/// The words of a text in lines of at most `width` characters; only a longer word makes a longer line.
fn wrapped(text: &str, width: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut().filter(|line| line.len() + 1 + word.len() <= width) {
            Some(line) => {
                line.push(' ');
                line.push_str(word);
            }
            None => lines.push(word.to_owned()),
        }
    }
    lines
}

/// Printable ASCII for comments; other characters become `_`.
pub(super) fn ascii(text: &str) -> String {
    text.chars().map(|c| if c.is_ascii_graphic() || c == ' ' { c } else { '_' }).collect()
}

/// Whether a text can be the extension of a file's name.
pub(super) fn is_extension(text: &str) -> bool {
    !text.is_empty() && text.bytes().all(|b| b.is_ascii_alphanumeric())
}
