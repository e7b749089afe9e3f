//! The layers of parts or bodies that are welded one after another, as those of one plan: numbered consecutively, with
//! each report made once.

use super::settings::PlanSettings;
use super::{Header, Sink, Summary};
use crate::layer::Layer;
use crate::metrics::Metrics;
use crate::profile::LayersSection;
use crate::warning::{WarningSummary, Warnings};

/// Why values for some layers cannot be used (`process.layers`).
pub(super) const NUMBERED_APART: &str =
    "process.layers: layers are numbered separately for each part or body, so it is not clear which are meant";

/// Numbers layers consecutively and hands them on.
pub(super) struct Row<'a, S> {
    /// How the layers of all bodies lie in space.
    layers: &'a LayersSection,
    sink: &'a mut S,
    /// The body whose layers are coming; 0 for parts.
    pub(super) body: usize,
    /// Number of layers before it.
    first: usize,
    /// Whether there is more than one, so that each is named.
    several: bool,
    /// Which layers belong to which part or body, as text.
    ranges: Vec<String>,
    metrics: Metrics,
    volume: Option<f64>,
    warnings: Warnings,
    notes: Vec<String>,
    forbidden: Vec<String>,
}

impl<'a, S: Sink> Row<'a, S> {
    /// No layers yet; the plan as a whole has already begun.
    pub(super) fn new(settings: &PlanSettings<'a>, sink: &'a mut S, several: bool) -> Self {
        Self {
            layers: settings.layers,
            sink,
            body: 0,
            first: 0,
            several,
            ranges: Vec::new(),
            metrics: settings.metrics.clone(),
            volume: Some(0.0),
            warnings: Warnings::default(),
            notes: settings.notes.clone(),
            forbidden: settings.forbidden.clone(),
        }
    }

    /// Takes over the summary of a part or body whose layers have all come. Its warnings are reported with those of all
    /// layers.
    pub(super) fn finish(&mut self, name: &str, layers: usize, own: &Summary) {
        let warned: Vec<String> = own.warnings.summaries().map(WarningSummary::sentence).collect();
        let several = self.several;
        let add = |known: &mut Vec<String>, new: &[String]| {
            let new = new.iter().filter(|text| !known.contains(text) && !warned.contains(text));
            let new: Vec<String> =
                new.map(|text| if several { format!("{name}: {text}") } else { text.clone() }).collect();
            known.extend(new);
        };
        add(&mut self.notes, &own.notes);
        add(&mut self.forbidden, &own.forbidden);
        self.ranges.push(format!("{name} (layers {} to {})", self.first + 1, self.first + layers));
        self.first += layers;
        self.volume = self.volume.zip(own.metrics.mesh_volume_mm3).map(|(a, b)| a + b);
    }

    /// The summary of all; `how` begins the sentence that says which layers belong to which.
    pub(super) fn summary(self, how: &str) -> Summary {
        let Self { mut metrics, warnings, mut notes, volume, ranges, several, .. } = self;
        metrics.mesh_volume_mm3 = volume;
        notes.splice(0..0, several.then(|| format!("{how}: {}.", ranges.join(", "))));
        let forbids = warnings.summaries().filter(|w| w.kind.forbids()).map(WarningSummary::sentence);
        let forbidden = forbids.chain(self.forbidden).collect();
        Summary { metrics, warnings, notes, forbidden, blocked: Vec::new(), grown: None }
    }
}

impl<S: Sink> Sink for Row<'_, S> {
    type Error = S::Error;

    /// The plan as a whole has already begun.
    fn begin(&mut self, _part: &Header) -> Result<(), S::Error> {
        Ok(())
    }

    fn layer(&mut self, mut layer: Layer) -> Result<(), S::Error> {
        layer.index += self.first;
        layer.body = self.body;
        layer.warnings.iter_mut().for_each(|warning| warning.layer += self.first);
        let sheet = self.layers.sheet(&layer);
        for warning in &layer.warnings {
            let at = sheet.map(|sheet| sheet.at(warning.place.extend(layer.z)).place);
            self.warnings.add_at(*warning, layer.z, at);
        }
        self.metrics.add(&layer);
        self.sink.layer(layer)
    }
}
