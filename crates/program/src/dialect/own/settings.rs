//! The settings of a user-defined dialect: its `dialect.toml`.

use serde::Deserialize;

/// The settings of the files to be written; file names are templates.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Settings {
    /// Name of the file of `begin.txt` and `end.txt`, and of the layers too if `layer_file` is omitted.
    pub(super) file: String,
    /// Name of the file of each layer.
    pub(super) layer_file: Option<String>,
    /// How lines end.
    #[serde(default)]
    pub(super) line_ends: LineEnds,
    /// Increment of `block()`.
    #[serde(default = "step")]
    pub(super) block_step: usize,
    /// Number after which `block()` restarts.
    #[serde(default = "most")]
    pub(super) block_most: usize,
}

/// How lines end.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum LineEnds {
    /// Carriage return and line feed, as most controllers expect.
    #[default]
    Crlf,
    /// Line feed alone.
    Lf,
}

fn step() -> usize {
    10
}

fn most() -> usize {
    99_990
}

impl Settings {
    /// Reads `dialect.toml`; an error has its line and a sentence.
    pub(super) fn read(text: &str) -> Result<Self, (Option<usize>, String)> {
        let settings: Self = toml::from_str(text).map_err(|error| {
            let line = error.span().map(|span| text[..span.start.min(text.len())].matches('\n').count() + 1);
            (line, format!("{}.", error.message().replace('`', "\"")))
        })?;
        if settings.block_step == 0 || settings.block_most < settings.block_step {
            return Err((None, "block_step must be 1 or more, and block_most no less than block_step.".to_owned()));
        }
        Ok(settings)
    }
}
