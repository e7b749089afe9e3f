//! What is known of a plan, put together from the planner's events.

use crate::adaptation::Follows;
use crate::planner::{Event, Failure};
use crate::view3d::{Colour, Scanned, Scene};
use beadwright::Finding;
use beadwright::adapt::Adapted;
use beadwright::check;
use beadwright::deposit::{Figures, Judgement};
use beadwright::finding::Severity;
use beadwright::layer::Layer;
use beadwright::model::{Mesh, Part};
use beadwright::plan::{Header, Summary};
use beadwright::profile::Profile;
use beadwright::report::rows;
use beadwright::task::Stage;
use std::sync::Arc;

/// A plan as far as it is made.
#[derive(Default)]
pub struct PlanState {
    /// The placed model.
    pub part: Option<Arc<Part>>,
    /// The profile of this plan.
    pub profile: Option<Arc<Profile>>,
    /// What all layers have in common, once the layers begin to arrive.
    pub header: Option<Header>,
    /// The layers planned so far.
    pub layers: Vec<Arc<Layer>>,
    /// The layer in view, planned first, until the other layers have got that far.
    pub preview: Option<Arc<Layer>>,
    /// What the deposit model says about each layer.
    pub judgements: Vec<Arc<Judgement>>,
    /// Its figures for all layers together.
    pub total: Option<Figures>,
    /// Totals and warnings, once all layers are there.
    pub summary: Option<Summary>,
    /// What the checks found, at the very end.
    pub findings: Option<Vec<Finding>>,
    /// Everything to report so far, the worst first: those of a check as one.
    pub reported: Vec<Finding>,
    /// The stage in progress.
    pub progress: Option<(Stage, f64)>,
    /// Why there is no plan.
    pub failure: Option<Failure>,
    /// What the 3-D view shows.
    pub scene: Scene,
    /// The scan that the upper layers follow, if they do.
    pub adapted: Option<Arc<Adapted>>,
    /// Whether layers have to follow a scan before anything may be written.
    awaits: bool,
    /// How much of what is in view already comes from the last request.
    received: Received,
}

/// Figures of a plan: their names, and their values.
pub type Rows = Vec<(&'static str, String)>;

/// How much of what is in view comes from the present request; the rest is still from the previous one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Received {
    #[default]
    Nothing,
    Part,
    Layers,
}

/// The check that compares the end of the part with its plan.
const ENDS: &str = "built-height";

impl PlanState {
    /// A new request has started; the old plan stays in view until the new one replaces it. It may await layers that follow a scan.
    pub fn restart(&mut self, awaits: bool) {
        (self.adapted, self.awaits) = (None, awaits);
        self.progress = Some((Stage::Import, 0.0));
        self.failure = None;
        self.findings = None;
        self.received = Received::Nothing;
        self.report();
    }

    /// Takes the layers that follow a scan in place of those planned. The deposit model says nothing about them: it knows no uneven
    /// ground.
    pub fn follow(&mut self, follows: &Follows) {
        let number = follows.adapted.number;
        self.layers.clone_from(&follows.built);
        self.judgements.truncate(number);
        self.scene.truncate(number);
        for (layer, beads) in &follows.layers {
            self.scene.set_layer(self.layers.len(), beads.clone());
            self.layers.push(layer.clone());
        }
        let mut summary = follows.summary.clone();
        if let Some(planned) = self.summary.take() {
            // What could not be welded as planned cannot be welded on the metal that was measured either.
            let more = planned.forbidden.into_iter().filter(|text| !summary.forbidden.contains(text));
            summary.forbidden.extend(more.collect::<Vec<_>>());
            (summary.warnings, summary.blocked) = (planned.warnings, planned.blocked);
        }
        (self.header, self.summary) = (Some(follows.header.clone()), Some(summary));
        self.total = None;
        if let Some(findings) = &mut self.findings {
            // How the layers that follow end is not known.
            findings.retain(|finding| finding.layer.map_or(finding.kind != ENDS, |layer| layer < number));
        }
        self.adapted = Some(follows.adapted.clone());
        self.report();
    }

    /// Puts together what there is to report.
    fn report(&mut self) {
        let repaired = self.part.as_ref().map(|part| part.repair().sentences()).unwrap_or_default();
        let found = self.findings.as_deref().map(check::grouped).unwrap_or_default();
        self.reported = match &self.summary {
            Some(summary) => check::all_findings(summary, &repaired, &found),
            None => repaired.into_iter().map(|text| Finding::new("model", Severity::Note, text)).collect(),
        };
    }

    /// Number of findings that are more than notes, metal that is missing included.
    pub fn found(&self) -> usize {
        self.reported.iter().filter(|f| f.severity < Severity::Note).map(|f| f.count).sum()
    }

    /// What is serious about the last request, as far as it is known.
    pub fn serious(&self) -> impl Iterator<Item = &Finding> {
        let known = self.is_of_last_request();
        self.reported.iter().filter(move |finding| known && finding.severity == Severity::Serious)
    }

    /// Why the programs of the last request should not be written.
    pub fn forbidden(&self) -> &[String] {
        let summary = self.summary.as_ref().filter(|_| self.is_of_last_request());
        summary.map_or(&[], |summary| &summary.forbidden)
    }

    /// Whether layers, profile and totals in view belong together and to the last request: only then may they be
    /// written to files.
    pub fn is_of_last_request(&self) -> bool {
        self.received == Received::Layers && (!self.awaits || self.adapted.is_some())
    }

    /// Whether the last request is planned, though perhaps not yet judged.
    pub fn is_planned(&self) -> bool {
        self.summary.is_some() && self.is_of_last_request()
    }

    /// Whether the part in view is that of the last request.
    pub fn is_placed(&self) -> bool {
        self.received != Received::Nothing
    }

    /// Its totals as far as they are known.
    pub fn totals(&self) -> Rows {
        let metrics = self.summary.as_ref().map(|summary| &summary.metrics);
        let totals = metrics.map(rows::totals).into_iter().flatten();
        // Sliders and plots count all layers.
        let all = self.layers.len();
        let totals = totals.map(|(name, value)| match metrics {
            Some(metrics) if name == "layers" && all > metrics.layers => (name, format!("{value} / {all}")),
            _ => (name, value),
        });
        totals.chain(self.total.as_ref().map(rows::deposit).into_iter().flatten()).collect()
    }

    /// Whether its temperatures could be computed, but are not.
    pub fn is_cold(&self) -> bool {
        let planned = self.summary.is_some() && self.is_of_last_request();
        planned && self.scene.value_range(Colour::Temperature).is_none()
    }

    /// Takes in an event.
    pub fn take(&mut self, event: Event) {
        let tells = !matches!(event, Event::Progress(..) | Event::Layer(..) | Event::Judged(..));
        self.hold(event);
        if tells {
            self.report();
        }
    }

    fn hold(&mut self, event: Event) {
        match event {
            Event::Progress(stage, fraction) => self.progress = Some((stage, fraction)),
            Event::Part(part, mesh, profile) => {
                self.received = Received::Part;
                self.take_part(part, mesh, profile);
            }
            Event::Preview(layer, beads) => {
                self.clear_layers();
                self.scene.set_layer(layer.index, beads);
                self.preview = Some(layer);
            }
            Event::Begin(header) => {
                self.received = Received::Layers;
                self.clear_plan();
                self.header = Some(header);
            }
            Event::Layer(layer, beads) => {
                self.scene.set_layer(layer.index, beads);
                self.layers.push(layer);
            }
            Event::Planned(summary) => self.summary = Some(*summary),
            Event::Judged(index, judgement, errors) => {
                self.scene.set_values(index, errors);
                self.judgements.push(judgement);
            }
            Event::Checked(total, findings) => {
                self.total = Some(total);
                self.findings = Some(findings);
                self.progress = None;
            }
            Event::Failed(failure) => {
                self.progress = None;
                self.clear_failed();
                self.failure = Some(failure);
            }
        }
    }

    fn take_part(&mut self, part: Arc<Part>, mesh: Option<Arc<Mesh>>, profile: Arc<Profile>) {
        let same = self.part.as_ref().is_some_and(|old| Arc::ptr_eq(old, &part));
        if !same {
            self.scene.set_mesh(mesh);
            self.preview = None;
            self.clear_layers();
        }
        self.part = Some(part);
        self.profile = Some(profile);
        if !same {
            self.show_stock();
        }
    }

    /// Shows the part within its preform, coloured by the metal over its faces, in place of any scan.
    pub(crate) fn show_stock(&mut self) {
        let milled = self.part.as_deref().and_then(Part::milled);
        self.scene.set_scan(milled.and_then(Scanned::stock));
    }

    /// Clears what the failed request has not replaced and would otherwise be taken for its result.
    fn clear_failed(&mut self) {
        if self.received == Received::Nothing {
            (self.part, self.profile) = (None, None);
            self.scene.clear();
        }
        if self.received != Received::Layers {
            self.preview = None;
            self.clear_layers();
        }
    }

    fn clear_layers(&mut self) {
        self.scene.clear_layers();
        self.clear_plan();
    }

    /// Forgets the plan; the preview stays in view.
    fn clear_plan(&mut self) {
        self.header = None;
        self.layers.clear();
        self.judgements.clear();
        self.total = None;
        self.summary = None;
        self.findings = None;
    }

    /// Number of layers known so far.
    pub fn layer_count(&self) -> usize {
        let preview = self.preview.as_ref().map_or(0, |layer| layer.index + 1);
        self.header.as_ref().map_or(preview, |header| header.extent.layers).max(self.layers.len())
    }

    /// A layer if it is planned, or else its preview.
    pub fn layer(&self, index: usize) -> Option<&Arc<Layer>> {
        self.layers.get(index).or_else(|| self.preview.as_ref().filter(|layer| layer.index == index))
    }

    /// Whether everything is done.
    pub fn is_complete(&self) -> bool {
        self.findings.is_some()
    }

    /// Whether planning is in progress.
    pub fn is_busy(&self) -> bool {
        self.progress.is_some()
    }
}
