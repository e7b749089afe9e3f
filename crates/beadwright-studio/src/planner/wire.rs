//! Orders and events as bytes (MessagePack), which is what passes between a browser's page and its worker.
//!
//! Only what the page cannot make itself is sent: a part when it has changed, only the chosen strategy of the profile, and
//! no segments to be drawn.

use super::{Event, Failure, Order};
use crate::project::Project;
use crate::view3d::LayerBeads;
use beadwright::Finding;
use beadwright::check::CHECKS;
use beadwright::deposit::{Figures, Judgement, figures};
use beadwright::fill::StrategyName;
use beadwright::finding::Severity;
use beadwright::layer::Layer;
use beadwright::model::wall_curves::WallCurves;
use beadwright::model::{Import, Mesh, Milled, Object, Part, RepairReport, Units};
use beadwright::plan::{Header, Summary};
use beadwright::profile::Profile;
use beadwright::task::Stage;
use beadwright::weld::Torch;
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

#[derive(Serialize, Deserialize)]
enum Sent {
    Progress(Stage, f64),
    /// The part, where it differs from the one sent before, and the strategy it is planned with.
    Part(Option<Body>, StrategyName),
    Preview(Arc<Layer>),
    Begin(Header),
    Layer(Arc<Layer>),
    Planned(Box<Summary>),
    Judged(usize, Arc<Judgement>, Arc<[f32]>),
    Checked(#[serde(with = "figures::whole")] Figures, Vec<Found>),
    Failed(Failure),
}

#[derive(Serialize, Deserialize)]
enum Body {
    Solid {
        mesh: Mesh,
        repair: Box<RepairReport>,
        format: String,
        units: Option<Units>,
        objects: Vec<Object>,
        notes: Vec<String>,
        milled: Option<Box<Milled>>,
    },
    Curves {
        curves: WallCurves,
        height: f64,
        warnings: Vec<String>,
    },
}

/// A finding, its check by its place in [`CHECKS`].
#[derive(Serialize, Deserialize)]
struct Found {
    check: usize,
    severity: Severity,
    count: usize,
    layer: Option<usize>,
    pass: Option<usize>,
    place: Option<DVec3>,
    size: Option<f64>,
    text: String,
    remedy: Option<String>,
}

fn bytes(of: &impl Serialize) -> Result<Vec<u8>, String> {
    rmp_serde::to_vec(of).map_err(|error| format!("the page and its worker do not understand each other: {error}."))
}

fn of_bytes<'a, T: Deserialize<'a>>(bytes: &'a [u8]) -> Result<T, String> {
    let error = |error| format!("the page and its worker do not understand each other: {error}. Load the page again.");
    rmp_serde::from_slice(bytes).map_err(error)
}

impl Order {
    /// The order as bytes.
    ///
    /// # Errors
    /// A sentence: the project cannot be written.
    pub fn pack(&self) -> Result<Vec<u8>, String> {
        bytes(&(self.number, self.project.write(None)?, self.layer))
    }

    /// The order of these bytes.
    ///
    /// # Errors
    /// A sentence: the bytes are not an order.
    pub fn unpack(bytes: &[u8]) -> Result<Self, String> {
        let (number, project, layer): (u64, String, usize) = of_bytes(bytes)?;
        let project = Project::read(&project, None).map_err(|error| error.to_string())?;
        Ok(Self { number, project, layer })
    }
}

/// Makes bytes of the events of a worker.
#[derive(Default)]
pub struct Packer {
    /// The part as last sent.
    part: Option<Arc<Part>>,
}

impl Packer {
    /// An event as bytes, with the number of its order.
    ///
    /// # Errors
    /// A sentence: a value that no bytes can be made of.
    pub fn pack(&mut self, number: u64, event: Event) -> Result<Vec<u8>, String> {
        bytes(&(number, self.sent(event)))
    }

    fn sent(&mut self, event: Event) -> Sent {
        match event {
            Event::Progress(stage, fraction) => Sent::Progress(stage, fraction),
            Event::Part(part, _, profile) => {
                let known = self.part.as_ref().is_some_and(|known| Arc::ptr_eq(known, &part));
                let body = (!known).then(|| Body::of(&part));
                self.part = Some(part);
                Sent::Part(body, profile.fill.strategy)
            }
            Event::Preview(layer, _) => Sent::Preview(layer),
            Event::Begin(header) => Sent::Begin(header),
            Event::Layer(layer, _) => Sent::Layer(layer),
            Event::Planned(summary) => Sent::Planned(summary),
            Event::Judged(index, judgement, errors) => Sent::Judged(index, judgement, errors),
            Event::Checked(total, findings) => Sent::Checked(total, findings.into_iter().map(Found::of).collect()),
            Event::Failed(failure) => Sent::Failed(failure),
        }
    }
}

/// Makes events of the bytes of one worker.
#[derive(Default)]
pub struct Unpacker {
    part: Option<(Arc<Part>, Option<Arc<Mesh>>)>,
    /// The profile of the present order.
    profile: String,
    chosen: Option<Arc<Profile>>,
    torch: Torch,
}

impl Unpacker {
    /// What comes from now on belongs to an order with this text of a profile.
    pub fn begin(&mut self, profile: &str) {
        profile.clone_into(&mut self.profile);
    }

    /// The event of these bytes, and the number of its order.
    ///
    /// # Errors
    /// A sentence: the bytes are not an event.
    pub fn unpack(&mut self, bytes: &[u8]) -> Result<(u64, Event), String> {
        let (number, sent) = of_bytes(bytes)?;
        Ok((number, self.event(sent)?))
    }

    fn event(&mut self, sent: Sent) -> Result<Event, String> {
        Ok(match sent {
            Sent::Progress(stage, fraction) => Event::Progress(stage, fraction),
            Sent::Part(body, strategy) => self.part(body, strategy)?,
            Sent::Preview(layer) => {
                let beads = LayerBeads::of(&layer, &mut self.fresh_torch());
                Event::Preview(layer, Arc::new(beads))
            }
            Sent::Begin(header) => {
                self.torch = self.fresh_torch();
                Event::Begin(header)
            }
            Sent::Layer(layer) => {
                let beads = LayerBeads::of(&layer, &mut self.torch);
                Event::Layer(layer, Arc::new(beads))
            }
            Sent::Planned(summary) => Event::Planned(summary),
            Sent::Judged(index, judgement, errors) => Event::Judged(index, judgement, errors),
            Sent::Checked(total, found) => {
                Event::Checked(total, found.into_iter().filter_map(Found::finding).collect())
            }
            Sent::Failed(failure) => Event::Failed(failure),
        })
    }

    fn part(&mut self, body: Option<Body>, strategy: StrategyName) -> Result<Event, String> {
        if let Some(body) = body {
            let part = Arc::new(body.part());
            let mesh = part.mesh().map(|mesh| Arc::new(mesh.clone()));
            self.part = Some((part, mesh));
        }
        let (part, mesh) = self.part.clone().ok_or("the worker sent no part. Load the page again.")?;
        let mut profile = Profile::parse(&self.profile).map_err(|error| error.to_string())?;
        profile.fill.strategy = strategy;
        let profile = Arc::new(profile);
        self.chosen = Some(profile.clone());
        Ok(Event::Part(part, mesh, profile))
    }

    fn fresh_torch(&self) -> Torch {
        self.chosen.as_ref().map_or_else(Torch::default, |profile| Torch::of(&profile.weld_settings()))
    }
}

impl Body {
    fn of(part: &Part) -> Self {
        match part.clone() {
            Part::Mesh(Import { mesh, repair, format, units, objects, notes, milled }) => {
                Self::Solid { mesh, repair: Box::new(repair), format: format.to_owned(), units, objects, notes, milled }
            }
            Part::Curves { curves, height, warnings } => Self::Curves { curves, height, warnings },
        }
    }

    fn part(self) -> Part {
        match self {
            Self::Solid { mesh, repair, format, units, objects, notes, milled } => {
                // A few bytes for each part, kept for as long as the page is open.
                let format = String::leak(format);
                Part::Mesh(Import { mesh, repair: *repair, format, units, objects, notes, milled })
            }
            Self::Curves { curves, height, warnings } => Part::Curves { curves, height, warnings },
        }
    }
}

impl Found {
    fn of(finding: Finding) -> Self {
        let Finding { kind, severity, count, layer, pass, place, size, text, remedy, .. } = finding;
        let check = CHECKS.iter().position(|known| known.name == kind).unwrap_or(CHECKS.len());
        Self { check, severity, count, layer, pass, place, size, text, remedy }
    }

    fn finding(self) -> Option<Finding> {
        let Self { check, severity, count, layer, pass, place, size, text, remedy } = self;
        let check = CHECKS.get(check)?;
        Some(Finding { count, layer, pass, place, size, remedy, ..Finding::new(check.name, severity, text) })
    }
}
