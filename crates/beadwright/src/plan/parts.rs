//! Parts that are welded one after another: one plan, whose layers are those of the first part, then of the second, and so on.

use super::clearance::{Clearance, Close, Watch};
use super::support::Footing;
use super::warm::Warmth;
use super::{Header, PlanError, Sink, Summary, plan_at, slabs_of, warm};
use crate::layer::{Extent, Layer};
use crate::metrics::Metrics;
use crate::model::PartRef;
use crate::process::TorchShape;
use crate::profile::Profile;
use crate::task::Task;
use crate::warning::{WarningSummary, Warnings};

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
    let predicted = |(_, part): &(String, PartRef)| -> Result<(Warmth, usize), PlanError<S::Error>> {
        let warmth = warm::predicted(*part, profile, task)?;
        let count = slabs_of(&warmth, *part, profile, task)?.len();
        Ok((warmth, count))
    };
    let predicted = parts.iter().map(predicted).collect::<Result<Vec<_>, _>>()?;
    let (warmths, counts): (Vec<Warmth>, Vec<usize>) = predicted.into_iter().unzip();
    let bounds = parts.iter().map(|(_, part)| part.bounds());
    let (low, high) = bounds.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))).unwrap_or_default();
    let extent = Extent { layers: counts.iter().sum(), low, high };
    let strategy = profile.fill.strategy.to_string();
    let header = Header { part: name.to_owned(), profile: profile.name.clone(), strategy, extent };
    sink.begin(&header).map_err(PlanError::Sink)?;
    let (mut clearance, width) = (Clearance::default(), profile.bead.width);
    let mut row = Row { first: 0, sink, metrics: Metrics::new(profile), warnings: Warnings::default() };
    let mut remarks = Remarks::of(profile);
    let mut volume = Some(0.0);
    for (((name, part), warmth), count) in parts.iter().zip(&warmths).zip(&counts) {
        clearance.begin(name);
        let mut watch = Watch { sink: &mut row, clearance: &mut clearance, torch, width };
        let own = plan_at(warmth, name, *part, Footing::Plate, profile, task, &mut watch)?;
        remarks.add(Some(name), &own);
        volume = volume.zip(own.metrics.mesh_volume_mm3).map(|(a, b)| a + b);
        row.first += count;
    }
    let Row { mut metrics, warnings, .. } = row;
    metrics.mesh_volume_mm3 = volume;
    let mut forbidden = remarks.forbidden_by(&warnings);
    let Remarks { mut notes, .. } = remarks;
    notes.insert(0, sentence(parts, &counts));
    forbidden.extend(clearance.close().iter().map(Close::sentence));
    Ok(Summary { metrics, warnings, notes, forbidden })
}

/// The room that the torch of a profile takes.
///
/// # Errors
/// [`PlanError::Parts`] where the profile does not say.
pub fn torch_of<E>(profile: &Profile) -> Result<TorchShape, PlanError<E>> {
    profile
        .torch
        .ok_or(PlanError::Parts("the profile lacks the section [torch] with nozzle_radius, stick_out and cone"))
}

/// Which layers belong to which part.
fn sentence(parts: &[(String, PartRef)], counts: &[usize]) -> String {
    let mut first = 1;
    let range = |((name, _), count): (&(String, PartRef), &usize)| {
        let text = format!("{name} (layers {first} to {})", first + count - 1);
        first += count;
        text
    };
    let ranges: Vec<String> = parts.iter().zip(counts).map(range).collect();
    format!("The parts are welded one after another: {}.", ranges.join(", "))
}

/// Why values for some layers cannot be used.
pub(super) const NUMBERED_APART: &str =
    "process.layers: layers are numbered separately for each part or body, so it is not clear which are meant";

/// What is reported about the parts, each thing once.
pub(super) struct Remarks {
    pub(super) notes: Vec<String>,
    pub(super) forbidden: Vec<String>,
}

impl Remarks {
    pub(super) fn of(profile: &Profile) -> Self {
        Self { notes: profile.notes(), forbidden: profile.forbidden() }
    }

    /// What a part adds, with its name if there are several. What it warns of is reported with the layers of all parts.
    pub(super) fn add(&mut self, part: Option<&str>, own: &Summary) {
        let warned: Vec<String> = own.warnings.summaries().map(WarningSummary::sentence).collect();
        let named = |known: &mut Vec<String>, new: &[String]| {
            let new = new.iter().filter(|text| !known.contains(text) && !warned.contains(text));
            let new: Vec<String> =
                new.map(|text| part.map_or_else(|| text.clone(), |part| format!("{part}: {text}"))).collect();
            known.extend(new);
        };
        named(&mut self.notes, &own.notes);
        named(&mut self.forbidden, &own.forbidden);
    }

    /// What forbids the plan of all parts: first what they warn of.
    pub(super) fn forbidden_by(&self, warnings: &Warnings) -> Vec<String> {
        let forbids = warnings.summaries().filter(|w| w.kind.forbids()).map(WarningSummary::sentence);
        forbids.chain(self.forbidden.iter().cloned()).collect()
    }
}

/// Numbers the layers of all parts consecutively.
struct Row<'a, S> {
    /// Layers of the parts before.
    first: usize,
    sink: &'a mut S,
    metrics: Metrics,
    warnings: Warnings,
}

impl<S: Sink> Sink for Row<'_, S> {
    type Error = S::Error;

    /// The plan as a whole has already begun.
    fn begin(&mut self, _part: &Header) -> Result<(), S::Error> {
        Ok(())
    }

    fn layer(&mut self, mut layer: Layer) -> Result<(), S::Error> {
        layer.index += self.first;
        layer.warnings.iter_mut().for_each(|warning| warning.layer += self.first);
        layer.warnings.iter().for_each(|warning| self.warnings.add(*warning, layer.z));
        self.metrics.add(&layer);
        self.sink.layer(layer)
    }
}
