//! Posts: a neutral program in a controller's language. A dialect is one file and one arm in [`post`].
//!
//! A post does no I/O: it hands out [`Chunk`]s, text to be appended to a named file, layer by layer.
//!
//! | post | writes |
//! | --- | --- |
//! | [`krl`] | KUKA KRL: a main program with its data, and one subprogram a layer |
//! | [`gcode`] | CNC G-code: one file |
//! | [`marlin`] | G-code for printers: one file |
//! | [`rapid`] | ABB RAPID: a main module with its data, and one module a layer |
//! | [`fanuc`] | FANUC TP: a main program, and one program a layer |
//! | [`inform`] | Yaskawa INFORM: a main job, and one job a layer |
//! | [`urscript`] | URScript: one file, a function a layer |

mod arctech;
pub mod fanuc;
pub mod gcode;
pub mod inform;
pub mod krl;
pub mod marlin;
mod needs;
mod orientation;
pub mod rapid;
mod split;
pub mod urscript;

use crate::number::fixed;
use crate::plan::Layer;
use crate::profile::{BUILT_IN, Profile, ProfileError};
use crate::program::{Instruction, LayerProgram, Programmer};
use crate::template;
use crate::weld::retract_time;
use std::borrow::Borrow;
use std::collections::BTreeMap;

/// The posts by name.
pub const NAMES: [&str; 7] = ["krl", "gcode", "marlin", "rapid", "fanuc", "inform", "urscript"];

/// Text to be appended to a file of the program.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Chunk {
    /// File name without a folder.
    pub file: String,
    /// ASCII text with the line ends of the controller.
    pub text: String,
}

/// Writes a program in one dialect.
pub trait Post: Send {
    /// What comes before the first layer of `layers`.
    fn begin(&mut self, layers: usize) -> Vec<Chunk>;

    /// One layer.
    fn layer(&mut self, program: &LayerProgram) -> Vec<Chunk>;

    /// What comes after the last layer; `leave` takes the torch away.
    fn end(&mut self, leave: Option<Instruction>) -> Vec<Chunk>;
}

/// Why a post cannot be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PostError {
    /// No such post.
    #[error("there is no post \"{0}\". The posts are {known}.", known = NAMES.join(", "))]
    Unknown(String),
    /// The profile has a turn table that the post does not write.
    #[error(
        "the post \"{0}\" does not write the turn table of program.table_angle; krl and rapid do. Take the key out, and turn the table by hand."
    )]
    NoTable(String),
    /// The profile lacks what the post needs.
    #[error(transparent)]
    Profile(#[from] ProfileError),
}

/// The post of that name for a part.
///
/// # Errors
/// [`PostError`] when there is none, or the profile lacks its section.
pub fn post(name: &str, part: &str, profile: &Profile) -> Result<Box<dyn Post>, PostError> {
    needs::check(name, profile)?;
    // In front, since long names lose their end.
    let part = &*if profile.is_dry_run() { format!("dry_{part}") } else { part.to_owned() };
    let angle = profile.program.torch_angle;
    if profile.program.table_angle.is_some() && NAMES.contains(&name) && !["krl", "rapid"].contains(&name) {
        return Err(PostError::NoTable(name.to_owned()));
    }
    match name {
        "krl" => {
            let mut section = profile.krl.clone().ok_or_else(|| no_section(profile, "krl"))?;
            section.orientation = orientation::zyx(section.orientation, angle);
            Ok(Box::new(krl::KukaKrl::new(part, profile, section)))
        }
        "gcode" => {
            let section = profile.gcode.clone().ok_or_else(|| no_section(profile, "gcode"))?;
            Ok(Box::new(gcode::CncGcode::new(part, profile, section)))
        }
        "marlin" => {
            let section = profile.marlin.clone().ok_or_else(|| no_section(profile, "marlin"))?;
            Ok(Box::new(marlin::MarlinGcode::new(part, profile, section)))
        }
        "rapid" => {
            let mut section = profile.rapid.clone().ok_or_else(|| no_section(profile, "rapid"))?;
            section.orientation = orientation::quaternion(section.orientation, angle);
            Ok(Box::new(rapid::AbbRapid::new(part, profile, section)))
        }
        "fanuc" => {
            let mut section = profile.fanuc.clone().ok_or_else(|| no_section(profile, "fanuc"))?;
            section.orientation = orientation::xyz(section.orientation, angle);
            Ok(Box::new(fanuc::FanucTp::new(part, profile, section)))
        }
        "inform" => {
            let mut section = profile.inform.clone().ok_or_else(|| no_section(profile, "inform"))?;
            section.orientation = orientation::xyz(section.orientation, angle);
            Ok(Box::new(inform::YaskawaInform::new(part, profile, section)))
        }
        "urscript" => {
            let mut section = profile.urscript.clone().ok_or_else(|| no_section(profile, "urscript"))?;
            section.orientation = orientation::vector(section.orientation, angle);
            Ok(Box::new(urscript::UniversalScript::new(part, profile, section)))
        }
        _ => Err(PostError::Unknown(name.to_owned())),
    }
}

/// The whole program of some layers in one dialect: the text of each file by its name. Long programs are better written
/// layer by layer.
///
/// # Errors
/// [`PostError`].
pub fn write<L: Borrow<Layer>>(
    name: &str,
    part: &str,
    layers: &[L],
    profile: &Profile,
) -> Result<BTreeMap<String, String>, PostError> {
    let mut post = post(name, part, profile)?;
    let mut programmer = Programmer::of(profile);
    let mut chunks = post.begin(layers.len());
    layers.iter().for_each(|layer| chunks.extend(post.layer(&programmer.layer(layer.borrow()))));
    chunks.extend(post.end(programmer.leave()));
    let mut files = BTreeMap::<String, String>::new();
    for chunk in chunks {
        files.entry(chunk.file).or_default().push_str(&chunk.text);
    }
    Ok(files)
}

fn no_section(profile: &Profile, section: &'static str) -> PostError {
    let with = BUILT_IN.iter().find(|(_, text)| text.contains(&format!("\n[{section}]")));
    let hint = with.map_or(String::new(), |(name, _)| format!("`beadwright profile show {name}` prints one to copy."));
    ProfileError::NoSection { profile: profile.name.clone(), section, hint }.into()
}

/// Values for the templates of a profile.
struct Values(Vec<(&'static str, String)>);

impl Values {
    fn new(program: &str, profile: &Profile) -> Self {
        let process = &profile.process;
        let milliseconds = |seconds: f64| (seconds * 1000.0).round().to_string();
        let retract = retract_time(&profile.start_stop, process);
        Self(vec![
            ("program", program.to_owned()),
            ("layer", String::new()),
            ("pass", String::new()),
            ("wire_feed_speed", process.wire_feed_speed.to_string()),
            ("deposition_speed", process.deposition_speed.to_string()),
            ("arc_start_delay", process.arc_start_delay.to_string()),
            ("arc_end_delay", process.arc_end_delay.to_string()),
            ("gas_preflow", process.gas_preflow.to_string()),
            ("gas_postflow", process.gas_postflow.to_string()),
            ("gas_flow", process.gas_flow.to_string()),
            ("arc_start_delay_ms", milliseconds(process.arc_start_delay)),
            ("arc_end_delay_ms", milliseconds(process.arc_end_delay)),
            ("gas_preflow_ms", milliseconds(process.gas_preflow)),
            ("gas_postflow_ms", milliseconds(process.gas_postflow)),
            ("dwell", "0".to_owned()),
            ("dwell_ms", "0".to_owned()),
            ("wire_feed", fixed(process.wire_feed_speed, 3)),
            ("wire_feed_ratio", fixed(1.0, 4)),
            ("wire_retract", profile.start_stop.wire_retract.to_string()),
            ("wire_retract_time", ((retract * 100.0).round() / 100.0).to_string()),
            ("wire_retract_time_ms", milliseconds(retract)),
        ])
    }

    /// The wait of a template.
    fn set_dwell(&mut self, seconds: f64) {
        self.set("dwell", fixed(seconds, 3));
        self.set("dwell_ms", fixed(seconds * 1000.0, 0));
    }

    /// The wire feed, of the nominal one.
    fn set_wire_feed(&mut self, ratio: f64, nominal: f64) {
        self.set("wire_feed_ratio", fixed(ratio, 4));
        self.set("wire_feed", fixed(ratio * nominal, 3));
    }

    fn set(&mut self, name: &str, value: impl ToString) {
        for (_, v) in self.0.iter_mut().filter(|(known, _)| *known == name) {
            *v = value.to_string();
        }
    }

    fn expand<'a>(&'a self, lines: &'a [String]) -> impl Iterator<Item = String> + 'a {
        lines.iter().map(|line| template::expand(line, &self.0))
    }
}

/// Lines that set the wire feed in a crater: those of the profile, or those that set it anywhere.
fn crater_lines<'a>(crater: &'a [String], wire_feed: &'a [String]) -> &'a [String] {
    if crater.is_empty() { wire_feed } else { crater }
}

/// A wait in pieces of what a controller takes at once, s.
fn waits(seconds: f64, most: f64) -> impl Iterator<Item = f64> {
    let count = (seconds / most).ceil().max(1.0);
    (0..count as usize).map(move |i| (seconds - i as f64 * most).min(most))
}

/// Printable ASCII for comments; other characters become `_`.
fn ascii(text: &str) -> String {
    text.chars().map(|c| if c.is_ascii_graphic() || c == ' ' { c } else { '_' }).collect()
}

/// A name of upper-case letters, digits and `_`, a letter first.
fn upper_name(part: &str) -> String {
    let legal = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_uppercase() } else { '_' };
    let mut name: String = part.chars().map(legal).collect();
    if !name.starts_with(|c: char| c.is_ascii_alphabetic()) {
        name.insert_str(0, "P_");
    }
    name
}
