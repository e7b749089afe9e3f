//! Planning in the background: a request goes in, events come out, and a newer request stops the previous one.
//!
//! A separate thread reads the model, plans the layer in view, then all layers, judges them and runs the checks. It
//! keeps what it has read, so that a change of the profile does not read the model again.

use crate::jobs;
use crate::project::{Project, Source};
use crate::view2d::height;
use crate::view3d::LayerBeads;
use beadwright::check::{self, Finding};
use beadwright::compare::MAP_PIXELS;
use beadwright::deposit::{Figures, Judge, Judgement};
use beadwright::example;
use beadwright::layer::Layer;
use beadwright::model::{Mesh, Model, Part, PartError, Placement};
use beadwright::plan::choice::{self, Choice};
use beadwright::plan::{self, Header, PlanError, Sink, Summary};
use beadwright::profile::Profile;
use beadwright::task::{Cancelled, Stage, Task};
use beadwright::weld::Torch;
use std::convert::Infallible;
use std::path::Path;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::SystemTime;

/// What the planner reports; a number says which request it belongs to.
pub enum Event {
    /// How far a stage has come, 0 to 1.
    Progress(Stage, f64),
    /// The model is read and placed, with its mesh for the view; the profile it is planned with.
    Part(Arc<Part>, Option<Arc<Mesh>>, Arc<Profile>),
    /// The layer in view, before the others.
    Preview(Arc<Layer>, Arc<LayerBeads>),
    /// The layers begin to arrive.
    Begin(Header),
    /// The next layer.
    Layer(Arc<Layer>, Arc<LayerBeads>),
    /// All layers are planned.
    Planned(Box<Summary>),
    /// What the deposit model says of a layer, and the height error at every piece, in nominal bead heights.
    Judged(usize, Arc<Judgement>, Arc<[f32]>),
    /// What it says of all layers together, and what the checks found.
    Checked(Figures, Vec<Finding>),
    /// Planning failed; nothing more comes.
    Failed(Failure),
}

/// Why there is no plan.
#[derive(Debug, Clone, PartialEq)]
pub enum Failure {
    /// The unit of the model must be given: a sentence that says why.
    Units(String),
    /// The height of a wall must be given.
    Height(String),
    /// Anything else, as a sentence.
    Sentence(String),
}

struct Request {
    number: u64,
    project: Project,
    layer: usize,
    task: Task,
}

/// How soon an event should be shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Urgency {
    /// At once: the user is waiting for it.
    Now,
    /// Together with others like it.
    Soon,
}

type Notify = Arc<dyn Fn(Urgency) + Send + Sync>;

impl Event {
    fn urgency(&self) -> Urgency {
        match self {
            Self::Part(..) | Self::Preview(..) | Self::Planned(_) | Self::Checked(..) | Self::Failed(_) => Urgency::Now,
            Self::Progress(..) | Self::Begin(_) | Self::Layer(..) | Self::Judged(..) => Urgency::Soon,
        }
    }
}

/// The planning thread and its events.
pub struct Planner {
    requests: Sender<Request>,
    events: Receiver<(u64, Event)>,
    number: u64,
    task: Task,
    notify: Notify,
    sender: Sender<(u64, Event)>,
}

impl Planner {
    /// A planner that calls `notify` when there are events to fetch.
    pub fn new(notify: impl Fn(Urgency) + Send + Sync + 'static) -> Self {
        let (requests, inbox) = channel::<Request>();
        let (sender, events) = channel();
        let notify: Notify = Arc::new(notify);
        let (outbox, bell) = (sender.clone(), notify.clone());
        std::thread::spawn(move || serve(&inbox, &outbox, &bell));
        Self { requests, events, number: 0, task: Task::new(), notify, sender }
    }

    /// Plans a project, the given layer (from 0) first, and stops any planning in progress.
    pub fn plan(&mut self, project: &Project, layer: usize) {
        self.task.cancel();
        self.number += 1;
        let (number, sender, bell) = (self.number, self.sender.clone(), self.notify.clone());
        self.task = Task::with_progress(move |stage, fraction| {
            if sender.send((number, Event::Progress(stage, fraction))).is_ok() {
                bell(Urgency::Soon);
            }
        });
        let request = Request { number, project: project.clone(), layer, task: self.task.clone() };
        // The thread lives as long as this sender.
        let _ = self.requests.send(request);
    }

    /// Stops any planning in progress.
    pub fn cancel(&mut self) {
        self.task.cancel();
        self.number += 1;
    }

    /// The new events of the last request.
    pub fn events(&mut self) -> Vec<Event> {
        let number = self.number;
        self.events.try_iter().filter(|(of, _)| *of == number).map(|(_, event)| event).collect()
    }
}

impl Drop for Planner {
    fn drop(&mut self) {
        self.task.cancel();
    }
}

/// What has been read and placed, kept so that it need not be done again.
#[derive(Default)]
struct Cache {
    model: Option<(Source, Option<SystemTime>, Model)>,
    part: Option<(PartKey, Arc<Part>)>,
    mesh: Option<(Arc<Part>, Arc<Mesh>)>,
}

/// What a placed part depends on besides its model; the bead width is used in guessing the units.
#[derive(Clone, Copy, PartialEq)]
struct PartKey {
    placement: Placement,
    height: Option<f64>,
    bead_width: f64,
}

fn serve(inbox: &Receiver<Request>, outbox: &Sender<(u64, Event)>, bell: &Notify) {
    let mut kept = Cache::default();
    while let Ok(mut request) = inbox.recv() {
        // Only the newest request counts.
        while let Ok(newer) = inbox.try_recv() {
            request = newer;
        }
        let number = request.number;
        let send = |event: Event| {
            let urgency = event.urgency();
            if outbox.send((number, event)).is_ok() {
                bell(urgency);
            }
        };
        match jobs::caught(|| work(&request, &mut kept, &send)) {
            Ok(Ok(()) | Err(Stop::Cancelled)) => {}
            Ok(Err(Stop::Failed(failure))) => send(Event::Failed(failure)),
            Err(sentence) => {
                // A panic may have left it in any state.
                kept = Cache::default();
                send(Event::Failed(Failure::Sentence(sentence)));
            }
        }
    }
}

enum Stop {
    Cancelled,
    Failed(Failure),
}

impl From<Cancelled> for Stop {
    fn from(_: Cancelled) -> Self {
        Self::Cancelled
    }
}

impl From<PlanError<Infallible>> for Stop {
    fn from(error: PlanError<Infallible>) -> Self {
        match error {
            PlanError::Cancelled(_) => Self::Cancelled,
            other => Self::Failed(Failure::Sentence(other.to_string())),
        }
    }
}

fn work(request: &Request, kept: &mut Cache, send: &(dyn Fn(Event) + Sync)) -> Result<(), Stop> {
    let task = &request.task;
    let sentence = |text: String| Stop::Failed(Failure::Sentence(text));
    let profile = Profile::parse(&request.project.profile).map_err(|error| sentence(error.to_string()))?;
    let part = kept.part(&request.project, profile.bead.width, task)?;
    let Choice { profile, note } = choice::choose(&part, &profile, false, task)?;
    let profile = Arc::new(profile);
    let known = kept.mesh.as_ref().filter(|(of, _)| Arc::ptr_eq(of, &part)).map(|(_, mesh)| mesh.clone());
    let mesh = known.or_else(|| part.mesh().map(|mesh| Arc::new(mesh.clone())));
    kept.mesh = mesh.clone().map(|mesh| (part.clone(), mesh));
    send(Event::Part(part.clone(), mesh, profile.clone()));
    if let Some(layer) = plan::preview(&part, &profile, request.layer, task)? {
        let beads = Arc::new(LayerBeads::of(&layer, &mut Torch::of(&profile.weld_settings())));
        send(Event::Preview(Arc::new(layer), beads));
    }
    let mut layers = Layers { send, layers: Vec::new(), torch: Torch::of(&profile.weld_settings()) };
    let mut summary = plan::plan_into(&request.project.part(), &*part, &profile, task, &mut layers)?;
    let layers = layers.layers;
    summary.notes.splice(0..0, note);
    send(Event::Planned(Box::new(summary)));
    let settings = plan::deposit_settings_over(&profile, part.bounds());
    let judge = Judge::new(settings).with_pictures(MAP_PIXELS);
    let each = |index: usize, judgement: Judgement| {
        let errors = errors(&layers[index], &judgement);
        send(Event::Judged(index, Arc::new(judgement), errors));
    };
    let judged = check::judge_layers(&layers, &profile, judge, task, each)?;
    let total = judged.total;
    send(Event::Checked(total, check::check_figures(&layers, &profile, settings.nominal.rise, judged)));
    Ok(())
}

/// The height error in the middle of every piece, in nominal bead heights.
fn errors(layer: &Layer, judgement: &Judgement) -> Arc<[f32]> {
    let Some(map) = &judgement.picture else { return Arc::default() };
    let at = |p: glam::DVec3| {
        let pixel = ((p.truncate() - map.low) / map.pixel).floor();
        let inside = pixel.cmpge(glam::DVec2::ZERO).all() && pixel.x < map.width as f64 && pixel.y < map.height as f64;
        let value = inside.then(|| map.values.get(pixel.y as usize * map.width + pixel.x as usize)).flatten()?;
        // A void has no height in the picture.
        Some(height(*value).unwrap_or_default() - 1.0)
    };
    let pieces = layer.passes.iter().flat_map(|pass| pass.segments());
    pieces.map(|s| at((s.from + s.to) / 2.0).unwrap_or_default() as f32).collect()
}

struct Layers<'a> {
    send: &'a (dyn Fn(Event) + Sync),
    layers: Vec<Arc<Layer>>,
    torch: Torch,
}

impl Sink for Layers<'_> {
    type Error = Infallible;

    fn begin(&mut self, header: &Header) -> Result<(), Infallible> {
        (self.send)(Event::Begin(header.clone()));
        Ok(())
    }

    fn layer(&mut self, layer: Layer) -> Result<(), Infallible> {
        let beads = Arc::new(LayerBeads::of(&layer, &mut self.torch));
        let layer = Arc::new(layer);
        self.layers.push(layer.clone());
        (self.send)(Event::Layer(layer, beads));
        Ok(())
    }
}

impl Cache {
    fn part(&mut self, project: &Project, bead_width: f64, task: &Task) -> Result<Arc<Part>, Stop> {
        let Some(source) = &project.source else {
            return Err(Stop::Failed(Failure::Sentence("no model is open.".to_owned())));
        };
        let changed = modified(source);
        let fresh = self.model.as_ref().is_some_and(|(of, at, _)| of == source && *at == changed);
        if !fresh {
            self.part = None;
            self.model = Some((source.clone(), changed, read(source, task)?));
        }
        let key = PartKey { placement: project.placement, height: project.height, bead_width };
        if let Some((_, part)) = self.part.as_ref().filter(|(of, _)| *of == key) {
            return Ok(part.clone());
        }
        let Some((_, _, model)) = &self.model else { return Err(Stop::Cancelled) };
        let part = model.clone().place(&project.placement, project.height, bead_width);
        let part = Arc::new(part.map_err(|error| refused(source, &error))?);
        self.part = Some((key, part.clone()));
        Ok(part)
    }
}

fn modified(source: &Source) -> Option<SystemTime> {
    match source {
        Source::File(path) => path.metadata().and_then(|m| m.modified()).ok(),
        Source::Example(_) => None,
    }
}

fn read(source: &Source, task: &Task) -> Result<Model, Stop> {
    let bytes = match source {
        Source::File(path) => bytes(path).map_err(|text| Stop::Failed(Failure::Sentence(text)))?,
        Source::Example(name) => {
            let found = example::find(name);
            let found = found.ok_or_else(|| Stop::Failed(Failure::Sentence(format!("there is no example {name}."))))?;
            found.stl()
        }
    };
    Model::read(&bytes, task).map_err(|error| refused(source, &error))
}

fn bytes(path: &Path) -> Result<Vec<u8>, String> {
    if path.is_dir() {
        return Err(format!("{}: this is a folder, not a model file.", path.display()));
    }
    std::fs::read(path).map_err(|error| format!("{}: {error}.", path.display()))
}

fn refused(source: &Source, error: &PartError) -> Stop {
    let text = format!("{}: {error}", source.label());
    match error {
        PartError::Import(beadwright::model::ImportError::Cancelled(_)) => Stop::Cancelled,
        PartError::Units(_) => Stop::Failed(Failure::Units(text)),
        PartError::NoHeight => Stop::Failed(Failure::Height(text)),
        _ => Stop::Failed(Failure::Sentence(text)),
    }
}
