//! `beadwright listen`: what a cell publishes over MQTT and OPC UA becomes logs for `beadwright record`.

use crate::{progress, say};
use bead_listen::{Heard, Source, Until};
use std::io::Write;
use std::path::PathBuf;

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// What to listen to: a TOML file for each broker or server; its log has the same name.
    #[arg(required = true, value_name = "SOURCE.toml")]
    sources: Vec<PathBuf>,
    /// Folder for the logs; logs that are there go on.
    #[arg(short, long, default_value = "logs", value_name = "FOLDER")]
    output: PathBuf,
    /// Stop after this many seconds; without it, Ctrl-C stops it.
    #[arg(long = "for", value_name = "S", value_parser = parse_seconds)]
    seconds: Option<f64>,
    /// Stop when nothing has been heard for this many seconds.
    #[arg(long, value_name = "S", value_parser = parse_seconds)]
    until_idle: Option<f64>,
    /// Print machine-readable JSON: what was heard.
    #[arg(long)]
    json: bool,
}

fn parse_seconds(text: &str) -> Result<f64, String> {
    let seconds: f64 = text.parse().map_err(|_| "a number of seconds is expected".to_owned())?;
    if (0.1..=1e7).contains(&seconds) { Ok(seconds) } else { Err("it must lie between 0.1 and 10000000 s".to_owned()) }
}

pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let sources = arguments.sources.iter().map(|path| Source::read(path)).collect::<Result<Vec<_>, _>>()?;
    // On standard error at once, whatever becomes of the output.
    let said = |sentence: &str| {
        if say::loudness() != say::Loudness::Quiet {
            eprintln!("{sentence}");
        }
    };
    for (k, source) in sources.iter().enumerate() {
        let twice = sources[..k].iter().any(|other| other.name == source.name);
        anyhow::ensure!(
            !twice,
            "two sources are named {0}, and would write the same {0}.csv. Rename one.",
            source.name
        );
        for column in source.unused() {
            said(&format!("note: {}: `beadwright record` does not use the column {column}", source.name));
        }
    }
    let (task, bar) = progress::task()?;
    bar.finish_and_clear();
    let until = Until { seconds: arguments.seconds, idle: arguments.until_idle, stopped: &|| task.check().is_err() };
    let heard = bead_listen::listen(&sources, &arguments.output, until, &said)?;
    if arguments.json {
        let logs: Vec<_> = heard.iter().map(as_json).collect();
        return Ok(writeln!(std::io::stdout(), "{:#}", serde_json::json!({ "logs": logs }))?);
    }
    heard.iter().try_for_each(print)
}

fn as_json(heard: &Heard) -> serde_json::Value {
    serde_json::json!({ "log": heard.path, "rows": heard.rows, "interruptions": heard.interruptions,
        "unreadable": heard.unreadable, "nothing_from": heard.nothing_from })
}

fn print(heard: &Heard) -> anyhow::Result<()> {
    writeln!(
        say::done(false),
        "{}: {} rows, {} interruptions, {} unreadable messages",
        heard.path.display(),
        heard.rows,
        heard.interruptions,
        heard.unreadable
    )?;
    let mut warnings = say::warnings();
    for place in &heard.nothing_from {
        writeln!(warnings, "warning: {}: nothing came from {place}. Check its name.", heard.name)?;
    }
    Ok(())
}
