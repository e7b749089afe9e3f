//! Refuses, with an explanation, a job that needs more than a dialect's templates can do, so that no writer has to.

use super::{DialectError, Job};
use crate::dialect::Templates;
use bead_plan::process::Follow;

/// Refuses a job that needs more than the lines of a section can do; `example` shows how they may set the wire feed.
pub(in crate::dialect) fn lines(
    dialect: &'static str,
    templates: &Templates<'_>,
    example: &str,
    job: &Job<'_>,
) -> Result<(), DialectError> {
    // A dry run switches nothing.
    if job.dry_run {
        return Ok(());
    }
    let lines_of = |name: &str| {
        let key = format!("{dialect}.{name}");
        templates.iter().filter(move |(k, _)| **k == key).flat_map(|(_, lines)| lines.iter())
    };
    let ends = &job.weld.ends;
    let why = match job.weld.process.follow {
        Follow::WireFeed => Some("process.follow = \"wire-feed\""),
        Follow::Speed if job.weld.process.feeds_by_layer() => Some("[[process.layers]]"),
        Follow::Speed => ends.crater_is_weaker().then_some("a start_stop.crater_power below 1"),
    };
    if let Some(why) = why.filter(|_| lines_of("wire_feed").next().is_none()) {
        let remedy = format!(
            "Add the lines that set it in the cell, such as wire_feed = [\"{example}\"], or use process.follow = \
             \"speed\", a crater_power of 1 and the same speed for all layers.",
        );
        return Err(no_key(job, format!("{dialect}.wire_feed"), why, remedy));
    }
    let jobs = job.weld.process.layers.iter().any(|row| row.job.is_some_and(|own| own != job.weld.process.job));
    if jobs && !templates.iter().any(|(_, lines)| lines.iter().any(|line| line.contains("{{job}}"))) {
        let remedy = "Add the line that selects a job of the power source.";
        return Err(no_key(
            job,
            format!("{dialect}.layer_start with {{{{job}}}}"),
            "[[process.layers]]",
            remedy.to_owned(),
        ));
    }
    if ends.wire_retract > 0.0 && !lines_of("arc_off").any(|line| line.contains("{{wire_retract")) {
        let remedy = "Use {{wire_retract}} (mm), {{wire_retract_time}} (s) or {{wire_retract_time_ms}} in its lines.";
        let key = format!("{dialect}.arc_off with {{{{wire_retract}}}}");
        return Err(no_key(job, key, "start_stop.wire_retract", remedy.to_owned()));
    }
    Ok(())
}

fn no_key(job: &Job<'_>, key: String, why: &str, remedy: String) -> DialectError {
    DialectError::NoKey { profile: job.profile.clone(), key, why: why.to_owned(), remedy }
}
