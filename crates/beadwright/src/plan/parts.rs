//! Parts that are welded one after another, as one plan: the layers of the first part, then those of the second, and so
//! on.

use super::clearance::{Clearance, Close, Watch};
use super::row::{NUMBERED_APART, Row};
use super::settings::PlanSettings;
use super::warm::Warmth;
use super::{Header, PlanError, Sink, Start, Summary, plan_at, slabs_of, warm};
use crate::layer::Extent;
use crate::model::PartRef;
use crate::process::TorchShape;
use crate::profile::Profile;
use crate::task::Task;

/// Plans parts next to each other on z = 0, each from its first layer to its last before the next one begins, and hands all
/// layers to `sink`, numbered consecutively. Travels to another part pass over everything already built. Where the torch
/// (`[torch]`) would hit a finished part, [`Summary::forbidden`] says so.
///
/// # Errors
/// [`PlanError`], including where the profile lacks `[torch]`, or has values for some layers only.
pub fn parts_into<S: Sink + Send>(
    name: &str,
    parts: &[(String, PartRef)],
    profile: &Profile,
    task: &Task,
    sink: &mut S,
) -> Result<Summary, PlanError<S::Error>> {
    let torch = torch_of(profile)?;
    if !profile.layers.are_level() || !profile.layers.bodies.is_empty() {
        return Err(PlanError::Parts("layers.chart, layers.bodies: only parts with level layers can be"));
    }
    if !profile.process.layers.is_empty() {
        return Err(PlanError::Parts(NUMBERED_APART));
    }
    let settings = &PlanSettings::of(profile);
    let predicted = |(_, part): &(String, PartRef)| -> Result<(Warmth, usize), PlanError<S::Error>> {
        let warmth = warm::predicted(*part, settings, task)?;
        let count = slabs_of(&warmth, *part, settings, task)?.len();
        Ok((warmth, count))
    };
    let predicted = parts.iter().map(predicted).collect::<Result<Vec<_>, _>>()?;
    let (warmths, counts): (Vec<Warmth>, Vec<usize>) = predicted.into_iter().unzip();
    let bounds = parts.iter().map(|(_, part)| part.bounds());
    let (low, high) = bounds.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))).unwrap_or_default();
    let extent = Extent { layers: counts.iter().sum(), low, high };
    let (profile, strategy) = (settings.profile.to_owned(), settings.strategy.to_string());
    let header = Header { part: name.to_owned(), profile, strategy, extent };
    sink.begin(&header).map_err(PlanError::Sink)?;
    let (mut clearance, width) = (Clearance::default(), settings.bead_width);
    let mut row = Row::new(settings, sink, true);
    for (((name, part), warmth), count) in parts.iter().zip(&warmths).zip(&counts) {
        clearance.begin(name);
        let mut watch = Watch { sink: &mut row, clearance: &mut clearance, torch, width };
        let own = plan_at(Start::alone(warmth, None), name, *part, settings, task, &mut watch)?;
        row.finish(name, *count, &own);
    }
    let mut summary = row.summary("The parts are welded one after another");
    summary.forbidden.extend(clearance.close().iter().map(Close::sentence));
    Ok(summary)
}

/// The shape of a profile's torch.
///
/// # Errors
/// [`PlanError::Parts`] where the profile lacks it.
pub fn torch_of<E>(profile: &Profile) -> Result<TorchShape, PlanError<E>> {
    profile
        .torch
        .ok_or(PlanError::Parts("the profile lacks the section [torch] with nozzle_radius, stick_out and cone"))
}
