//! Which flags help with an error of the library, which knows no flags.

use beadwright::adapt::SeeError;
use beadwright::bead::library::LibraryError;
use beadwright::check;
use beadwright::dialect::reading::ReadError;
use beadwright::finding::{Finding, Severity, Words, lacks_metal_below};
use beadwright::model::{ImportError, PartError};
use beadwright::plan::{PlanError, Summary};
use beadwright::profile::Profile;
use beadwright::read_back::ReadBackError;

/// What the command offers against the findings of a plan by this profile.
pub(crate) fn words(profile: &Profile) -> Words {
    profile.layers.by_lie(of_level, of_charted, of_bodies)
}

/// The part is already divided into bodies: only dividing it elsewhere helps.
fn of_bodies(kind: &str) -> Option<&'static str> {
    if lacks_metal_below(kind) {
        Some("Other planes in the file of bodies divide the part elsewhere.")
    } else {
        of_level(kind)
    }
}

/// Layers that are not level begin where their chart does, so cutting and turning the part do not help.
fn of_charted(kind: &str) -> Option<&'static str> {
    if lacks_metal_below(kind) {
        Some("--bodies divides the part into bodies that each have metal below.")
    } else {
        of_level(kind)
    }
}

fn of_level(kind: &str) -> Option<&'static str> {
    Some(match kind {
        "gap-closed" => "inspect --repair shows and repairs it.",
        "open-contour-dropped" => {
            "inspect --repair --fill-holes MM repairs the model, --surface says what the surface is."
        }
        "high-start" | "nothing-below" => "--from-z MM begins higher up, --lay-flat turns the part.",
        "in-the-air" => "--orient and --lay-flat turn the part, --from-z MM begins higher up.",
        "over-unwelded" => "--scale enlarges the part, --orient and --lay-flat turn it.",
        "hanging-island" | "overhang" => "--orient turns the part.",
        "bare" | "void" => "beadwright compare shows what other strategies leave.",
        "built-height" => "beadwright adapt corrects the layers that follow a scan.",
        "reach" => "reach --suggest looks for a better place.",
        _ => return None,
    })
}

/// All that is to be said of a plan, the worst first, with remedies in the words of the command; `model` and `found` as in
/// [`check::all_findings`].
pub(crate) fn findings(summary: &Summary, model: &[String], found: &[Finding], words: Words) -> Vec<Finding> {
    check::all_findings(summary, model, found).into_iter().map(|finding| finding.in_words(words)).collect()
}

/// Why the programs of a plan should not be started, as sentences with remedies in the words of the command.
pub(crate) fn reasons(summary: &Summary, words: Words) -> Vec<String> {
    let serious =
        findings(summary, &[], &[], words).into_iter().filter(|finding| finding.severity == Severity::Serious);
    serious.map(|finding| finding.sentence()).collect()
}

/// A sentence, where there are flags.
pub(crate) fn of(error: &anyhow::Error) -> Option<&'static str> {
    error
        .chain()
        .find_map(|cause| part(cause).or_else(|| program(cause)).or_else(|| library(cause)).or_else(|| scan(cause)))
}

/// The same for an error of planning.
pub(crate) fn of_plan<E>(error: &PlanError<E>) -> Option<&'static str> {
    match error {
        PlanError::Open { .. } => {
            Some("--surface solid and --surface wall set it; inspect --repair --fill-holes MM mends the model.")
        }
        PlanError::SideBySide(_) | PlanError::NoSides { .. } => Some("--curves sides and --curves centre set it."),
        PlanError::NoHelix { .. } => Some("--surface wall sets it."),
        _ => None,
    }
}

fn part(cause: &(dyn std::error::Error + 'static)) -> Option<&'static str> {
    Some(match cause.downcast_ref()? {
        PartError::Units(_) => "--units in, cm, m or mm sets it; --scale enlarges the part.",
        PartError::NoHeight => "--height sets it, in mm.",
        PartError::HeightOfSolid => "Leave --height out.",
        PartError::Import(ImportError::Outline { .. }) => "--height gives it one.",
        PartError::Import(ImportError::TooFar { .. }) => "--units sets the unit.",
        PartError::Import(ImportError::Damaged { .. }) => "--accept-damaged uses the triangles that it does have.",
        _ => return None,
    })
}

fn program(cause: &(dyn std::error::Error + 'static)) -> Option<&'static str> {
    match cause.downcast_ref()? {
        ReadBackError::Read(ReadError::NoDeposition { .. }) => Some("--arc-on and --arc-off name them."),
        ReadBackError::Printer => Some("--profile names it."),
        _ => None,
    }
}

fn library(cause: &(dyn std::error::Error + 'static)) -> Option<&'static str> {
    let inputs = matches!(cause.downcast_ref()?, LibraryError::Inputs { .. } | LibraryError::TooFew { .. });
    inputs.then_some("--inputs names those that are fitted.")
}

fn scan(cause: &(dyn std::error::Error + 'static)) -> Option<&'static str> {
    Some(match cause.downcast_ref()? {
        SeeError::Beside { .. } | SeeError::TooFew { .. } | SeeError::Uneven { .. } => {
            "--align fit aligns the scan with the part."
        }
        SeeError::Height { .. } => "--align plate takes the plate in the scan as z = 0.",
        _ => return None,
    })
}
