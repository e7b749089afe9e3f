//! Dialects: the languages of controllers. A neutral program is written in one of them, and programs in any of them are
//! read back.
//!
//! A dialect consists of a folder, declared above, and a line in the table below. The folder holds
//!
//! | file | what it is |
//! | --- | --- |
//! | `mod.rs` | the row [`DIALECT`](krl::DIALECT) |
//! | `section.rs` | the keys of the profile, with their limits, and how the [section](Section) begins a writer |
//! | `write.rs` | the syntax, from which `writing::frame` makes a [writer](writing::Writer) |
//! | `read.rs` | the reader |
//!
//! [`writing`] and [`reading`] hold what the dialects share. Users' own dialects, folders of templates, are written by
//! [`own`].

pub mod fanuc;
pub mod gcode;
pub mod inform;
pub mod krl;
pub mod marlin;
pub mod own;
pub mod rapid;
pub mod reading;
pub mod urscript;
pub mod writing;

pub use reading::read;
pub use writing::{Chunk, DialectError, Extra, Hooks, Job, PLACEHOLDERS, Writer, write, write_with, writer};

use crate::program::ProgramSettings;
use crate::template;
use bead_plan::limit::{Broken, Limit};
use bead_plan::weld::WeldSettings;
use reading::{ArcCodes, FindModule, Options, ReadError, ReadProgram};
use serde::{Deserialize, Serialize};

/// A language of controllers.
#[derive(Debug)]
pub struct Dialect {
    /// The name people type.
    pub name: &'static str,
    /// The language as people write it; dialects of one language are read in the same way.
    pub language: &'static str,
    /// Extensions of the files that may hold a main program's modules, such as `src`; empty if one file holds
    /// everything.
    pub module_extensions: &'static [&'static str],
    /// Whether it writes the linear axis of the robot.
    pub linear_axis: bool,
    /// Whether it writes the axis of a turn table (`program.table_angle`, `program.table_side`).
    pub table: bool,
    /// Whether it writes the axes of a positioner (`program.positioner`).
    pub positioner: bool,
    /// Whether a trimmed line can occur only in a program of this dialect; always false if another dialect reads its
    /// programs.
    typical: fn(&str) -> bool,
    /// Reads a program.
    read: fn(&str, &mut FindModule<'_>, &Options) -> Result<ReadProgram, ReadError>,
}

/// Keys and lines of the templates in a section.
pub type Templates<'a> = Vec<(&'static str, &'a Vec<String>)>;

/// The section of a profile for one dialect.
pub trait Section {
    /// Limits of the numeric values.
    fn limits(&self) -> Vec<Limit>;

    /// The first value that a controller would refuse, or that does not fit the other settings of programs.
    fn broken(&self, program: &ProgramSettings) -> Option<Broken>;

    /// Keys and lines of the templates.
    fn templates(&self) -> Templates<'_>;

    /// Whether it can write a feature that only some dialects can.
    fn supports(&self, _extra: Extra) -> bool {
        false
    }

    /// The profile's lines at other places of programs, if the dialect has them.
    fn hooks(&self) -> Option<&Hooks> {
        None
    }

    /// Whether the torch stands still until the arc is steady (`process.arc_start_delay`), so that it may then move off
    /// at any time.
    fn stands_at_start(&self) -> bool {
        self.templates().iter().any(|(key, lines)| key.ends_with(".arc_on") && stands(lines))
    }

    /// Time that the torch stands still at the end of a pass, s, without the crater filling of `[start_stop]`, if the
    /// data of the section determine it instead of `process.arc_end_delay`.
    fn arc_end_time(&self, _weld: &WeldSettings) -> Option<f64> {
        None
    }

    /// Most instructions of a pass, if no program may be longer; `None` if a pass that exceeds the limit makes a longer
    /// program.
    fn longest_pass(&self, _program: &ProgramSettings) -> Option<usize> {
        None
    }

    /// How the section names the axes that turn the part; `None` if the dialect writes none.
    fn table(&self) -> Option<Table> {
        None
    }

    /// Removes, for a dry run, whatever would switch the arc, apart from the templates.
    fn dry_run(&mut self) {}

    /// Begins writing a program.
    ///
    /// # Errors
    /// [`DialectError`] for a job that asks for more than the dialect can write or the section provides.
    fn writer(&self, job: &Job<'_>) -> Result<Box<dyn Writer>, DialectError>;
}

/// Whether the lines that strike the arc wait until it is steady.
fn stands(arc_on: &[String]) -> bool {
    arc_on.iter().any(|line| line.contains("{{arc_start_delay"))
}

/// How a section names the turn table under the part, so that the part's frame turns with it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Table {
    /// Full key.
    pub key: &'static str,
    /// Whether the profile gives it.
    pub known: bool,
    /// What it is: a sentence.
    pub what: &'static str,
}

/// The table: for each dialect its module, its section, and what the section is for.
macro_rules! dialects {
    ($($(#[$doc:meta])* $name:ident: $section:ident,)*) => {
        /// The dialects.
        pub const ALL: &[&Dialect] = &[$(&$name::DIALECT),*];

        /// The sections that a profile has.
        #[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
        #[serde(deny_unknown_fields)]
        #[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
        pub struct Sections {
            $($(#[$doc])* pub $name: Option<$name::$section>,)*
        }

        impl Sections {
            /// The section of a dialect.
            pub fn get(&self, name: &str) -> Option<&dyn Section> {
                match name {
                    $(stringify!($name) => self.$name.as_ref().map(|section| section as &dyn Section),)*
                    _ => None,
                }
            }

            /// The sections that are present.
            pub fn iter(&self) -> impl Iterator<Item = &dyn Section> {
                ALL.iter().filter_map(|dialect| self.get(dialect.name))
            }

            /// Removes, for a dry run, whatever would switch the arc.
            pub fn dry_run(&mut self) {
                $(self.$name.iter_mut().for_each(|section| section.dry_run());)*
            }
        }
    };
}

dialects! {
    /// KUKA KRL; needed for the post `krl`.
    krl: Krl,
    /// CNC G-code; needed for the post `gcode`.
    gcode: Gcode,
    /// Printers' G-code; needed for the post `marlin`.
    marlin: Marlin,
    /// ABB RAPID; needed for the post `rapid`.
    rapid: Rapid,
    /// FANUC TP; needed for the post `fanuc`.
    fanuc: Fanuc,
    /// Yaskawa INFORM; needed for the post `inform`.
    inform: Inform,
    /// URScript; needed for the post `urscript`.
    urscript: Urscript,
}

impl Sections {
    /// Keys and lines of all templates, those of hooks too.
    pub fn templates(&self) -> impl Iterator<Item = (String, &Vec<String>)> {
        ALL.iter().filter_map(|dialect| Some((dialect.name, self.get(dialect.name)?))).flat_map(|(name, section)| {
            let hooks = section.hooks().map(Hooks::templates).unwrap_or_default();
            let hooks = hooks.into_iter().map(move |(key, lines)| (format!("{name}.hooks.{key}"), lines));
            section.templates().into_iter().map(|(key, lines)| (key.to_owned(), lines)).chain(hooks)
        })
    }

    /// The codes in the templates that strike and end the arc: the last line of those that strike it and the first of
    /// those that end it, since gas and delays come before and after. Lines with placeholders do not count.
    pub fn arc_codes(&self) -> ArcCodes {
        let lines_of = |name: &str| {
            let template = move |(key, lines): (String, &Vec<String>)| {
                let plain = lines.iter().filter(|line| !template::has_placeholder(line));
                // Readers see statements without the `;` that ends them.
                let codes: Vec<String> = plain.map(|l| l.trim_end().trim_end_matches(';').to_owned()).collect();
                key.ends_with(name).then_some(codes)
            };
            self.templates().filter_map(template).collect::<Vec<_>>()
        };
        ArcCodes {
            on: lines_of(".arc_on").into_iter().filter_map(|codes| codes.last().cloned()).collect(),
            off: lines_of(".arc_off").into_iter().filter_map(|codes| codes.first().cloned()).collect(),
            alone: false,
        }
    }
}

/// The names of the dialects.
pub fn names() -> Vec<&'static str> {
    ALL.iter().map(|dialect| dialect.name).collect()
}

/// Whether a file may be the module `name` of a program, ignoring case and language; both are given without their
/// folder.
///
/// ```
/// use bead_program::dialect;
///
/// assert!(dialect::may_be_module("PART_L001.SRC", "part_l001"));
/// assert!(!dialect::may_be_module("part_l001.txt", "part_l001"));
/// ```
pub fn may_be_module(file: &str, name: &str) -> bool {
    let [file, name] = [file, name].map(str::to_ascii_lowercase);
    let known = |extension: &str| ALL.iter().any(|dialect| dialect.module_extensions.contains(&extension));
    file.strip_prefix(&name).is_some_and(|rest| rest.is_empty() || rest.strip_prefix('.').is_some_and(known))
}

/// The dialect with this name.
///
/// ```
/// use bead_program::dialect;
///
/// assert_eq!(dialect::find("rapid").map(|dialect| dialect.language), Some("RAPID"));
/// assert!(dialect::names().iter().all(|name| dialect::find(name).is_some()));
/// ```
pub fn find(name: &str) -> Option<&'static Dialect> {
    ALL.iter().find(|dialect| dialect.name == name).copied()
}
