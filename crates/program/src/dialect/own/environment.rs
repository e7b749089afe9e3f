//! What templates can do: the engine, its limits, filters and formats.

use super::settings::Settings;
use super::{FILE, LAYER_FILE, SETTINGS};
use crate::number;
use minijinja::syntax::SyntaxConfig;
use minijinja::value::ValueKind;
use minijinja::{AutoEscape, Environment, Error, ErrorKind, Output, State, UndefinedBehavior, Value, escape_formatter};
use std::collections::BTreeMap;

/// Deepest nesting of includes and calls in templates.
const DEPTH: usize = 60;

/// Work allowed to a template apart from its steps, in units of about one operation or 64 bytes of text.
pub(super) const FUEL: u64 = 1_000_000;
/// Work allowed for each step.
pub(super) const FUEL_PER_STEP: u64 = 10_000;

/// The engine with all templates of a folder: it has access to nothing else, and stops endless templates.
pub(super) fn of(settings: &Settings, files: BTreeMap<String, String>) -> Result<Environment<'static>, Error> {
    let mut environment = Environment::new();
    // Tags on lines of their own leave no empty lines.
    let syntax = SyntaxConfig::builder().trim_blocks(true).lstrip_blocks(true).keep_trailing_newline(true).build()?;
    environment.set_syntax(syntax);
    environment.set_undefined_behavior(UndefinedBehavior::Strict);
    environment.set_auto_escape_callback(|_| AutoEscape::None);
    environment.set_recursion_limit(DEPTH);
    environment.set_debug(false);
    environment.set_formatter(print);
    environment.add_filter("fixed", fixed);
    environment.add_filter("mm", |value: f64| fixed(value, 3));
    environment.add_filter("pad", |value: i64, width: usize| format!("{value:0width$}", width = width.min(20)));
    environment.add_template_owned(FILE, settings.file.clone())?;
    if let Some(name) = &settings.layer_file {
        environment.add_template_owned(LAYER_FILE, name.clone())?;
    }
    for (name, text) in files.into_iter().filter(|(name, _)| name != SETTINGS) {
        environment.add_template_owned(name, text.replace("\r\n", "\n"))?;
    }
    Ok(environment)
}

fn fixed(value: f64, decimals: usize) -> Result<String, Error> {
    if value.is_finite() && value.abs() < 1e9 && decimals <= 9 {
        return Ok(number::fixed(value, decimals));
    }
    Err(Error::new(ErrorKind::InvalidOperation, format!("{value} cannot be written with {decimals} decimals")))
}

/// Prints text and whole numbers. A number with decimals needs an explicit number of decimals, since no default would
/// suit every controller.
fn print(out: &mut Output, state: &mut State, value: &Value) -> Result<(), Error> {
    let problem = match value.kind() {
        // An invalid value carries its own explanation.
        ValueKind::String | ValueKind::Undefined | ValueKind::Invalid => None,
        ValueKind::Number if value.is_integer() => None,
        ValueKind::Number => Some("a number with decimals needs their count: {{ … | fixed(3) }}".to_owned()),
        ValueKind::None => Some("there is no value here: test for it first, with {% if … %}".to_owned()),
        kind => Some(format!("a {kind} cannot be written; name a part of it, such as {{{{ step.x | fixed(3) }}}}")),
    };
    match problem {
        None => escape_formatter(out, state, value),
        Some(problem) => Err(Error::new(ErrorKind::InvalidOperation, problem)),
    }
}

/// An error of the engine, as a sentence with a remedy.
pub(super) fn sentence(fault: &Error) -> String {
    let detail = fault.detail().unwrap_or_default().trim_end_matches('.');
    match fault.kind() {
        ErrorKind::SyntaxError => format!("the template cannot be read: {detail}."),
        ErrorKind::OutOfFuel => {
            "the template takes too long: it loops too often, or writes too much. Go through the steps once.".to_owned()
        }
        ErrorKind::TemplateNotFound => format!("{detail}; only files of this folder can be included or imported."),
        kind if detail.is_empty() => format!("{kind}."),
        ErrorKind::InvalidOperation => format!("{detail}."),
        kind => format!("{kind}: {detail}."),
    }
}
