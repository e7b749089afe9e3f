//! One order carried out: the model is read, the layer in view planned, then all layers, which are judged and checked.

use super::{Event, Failure, Order};
use crate::disk::{self, Stamp};
use crate::jobs;
use crate::project::{Project, Source};
use crate::view2d::height;
use crate::view3d::LayerBeads;
use beadwright::check;
use beadwright::compare::MAP_PIXELS;
use beadwright::deposit::{Judge, Judgement};
use beadwright::example;
use beadwright::layer::Layer;
use beadwright::model::{ImportError, Mesh, Model, Part, PartError, Placement, Units};
use beadwright::pass::Segment;
use beadwright::plan::choice::{self, Choice};
use beadwright::plan::stock::Stocked;
use beadwright::plan::{self, Bands, Header, PlanError, Sink};
use beadwright::preform::PreformSettings;
use beadwright::profile::Profile;
use beadwright::task::{Cancelled, Task};
use beadwright::weld::Torch;
use std::convert::Infallible;
use std::sync::Arc;

/// What has been read and placed, kept so that it need not be done again.
#[derive(Default)]
pub(super) struct Cache {
    model: Option<(ModelKey, Model)>,
    part: Option<(PartKey, Arc<Part>)>,
    mesh: Option<(Arc<Part>, Arc<Mesh>)>,
}

/// What a model depends on: its source, when it was changed, and whether a damaged one is used.
type ModelKey = (Source, Option<Stamp>, bool);

/// What a placed part depends on besides its model; the bead width is used in guessing the units.
#[derive(Clone, Copy, PartialEq)]
struct PartKey {
    placement: Placement,
    height: Option<f64>,
    bead_width: f64,
    preform: Option<PreformSettings>,
}

/// Carries out an order and sends what comes of it; a cancelled one ends in silence.
pub(super) fn carry_out(order: &Order, task: &Task, kept: &mut Cache, send: &(dyn Fn(Event) + Sync)) {
    match jobs::caught(|| work(order, task, kept, send)) {
        Ok(Ok(()) | Err(Stop::Cancelled)) => {}
        Ok(Err(Stop::Failed(failure))) => send(Event::Failed(failure)),
        Err(sentence) => {
            // A panic may have left it in any state.
            *kept = Cache::default();
            send(Event::Failed(Failure::Sentence(sentence)));
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

fn work(order: &Order, task: &Task, kept: &mut Cache, send: &(dyn Fn(Event) + Sync)) -> Result<(), Stop> {
    let sentence = |text: String| Stop::Failed(Failure::Sentence(text));
    let profile = Profile::parse(&order.project.profile).map_err(|error| sentence(error.to_string()))?;
    let part = kept.part(&order.project, &profile, task)?;
    let Choice { profile, note } = choice::choose(&part, &profile, false, task)?;
    let profile = Arc::new(profile);
    let known = kept.mesh.as_ref().filter(|(of, _)| Arc::ptr_eq(of, &part)).map(|(_, mesh)| mesh.clone());
    let mesh = known.or_else(|| part.mesh().map(|mesh| Arc::new(mesh.clone())));
    kept.mesh = mesh.clone().map(|mesh| (part.clone(), mesh));
    send(Event::Part(part.clone(), mesh, profile.clone()));
    if let Some(layer) = plan::preview(&part, &profile, order.layer, task)? {
        let beads = Arc::new(LayerBeads::of(&layer, &mut Torch::of(&profile.weld_settings())));
        send(Event::Preview(Arc::new(layer), beads));
    }
    let mut layers = Layers { send, layers: Vec::new(), torch: Torch::of(&profile.weld_settings()) };
    let mut summary = plan::plan_into(&order.project.part(), &*part, &profile, task, &mut layers)?;
    let layers = layers.layers;
    summary.notes.splice(0..0, part.notes().iter().cloned().chain(note));
    let grown = summary.grown.take();
    send(Event::Planned(Box::new(summary)));
    let settings = plan::deposit_settings_over(&profile, part.bounds());
    let judge = Judge::new(settings).with_pictures(MAP_PIXELS);
    let each = |index: usize, judgement: Judgement| {
        let errors = errors(&layers[index], &judgement, &profile);
        send(Event::Judged(index, Arc::new(judgement), errors));
    };
    let judged = check::judge_layers(&layers, &profile, judge, grown, task, each)?;
    let total = judged.total;
    send(Event::Checked(total, check::check_figures(&layers, &profile, judged)));
    Ok(())
}

/// The height error in the middle of every piece, in nominal bead heights.
fn errors(layer: &Layer, judgement: &Judgement, profile: &Profile) -> Arc<[f32]> {
    let Some(map) = &judgement.picture else { return Arc::default() };
    let at = |p: glam::DVec3| {
        let pixel = ((p.truncate() - map.low) / map.pixel).floor();
        let inside = pixel.cmpge(glam::DVec2::ZERO).all() && pixel.x < map.width as f64 && pixel.y < map.height as f64;
        let value = inside.then(|| map.values.get(pixel.y as usize * map.width + pixel.x as usize)).flatten()?;
        // A void has no height in the picture.
        Some(height(*value).unwrap_or_default() - 1.0)
    };
    let bands = Bands::of_layer(layer, profile);
    let once = |piece: Segment| bands.as_ref().map_or(piece, |bands| bands.piece(piece));
    let pieces = layer.passes.iter().flat_map(|pass| pass.segments()).map(once);
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

    fn asks_how_it_grows(&self) -> bool {
        true
    }
}

impl Cache {
    fn part(&mut self, project: &Project, profile: &Profile, task: &Task) -> Result<Arc<Part>, Stop> {
        let Some(source) = &project.source else {
            return Err(Stop::Failed(Failure::Sentence("no model is open.".to_owned())));
        };
        let changed = match source {
            Source::File(path) => disk::stamp(path),
            Source::Example(_) => None,
        };
        let file = (source.clone(), changed, project.accept_damaged);
        let fresh = self.model.as_ref().is_some_and(|(of, _)| *of == file);
        if !fresh {
            self.part = None;
            self.model = Some((file, read(source, project.accept_damaged, task)?));
        }
        let bead_width = profile.bead.width;
        let preform = project.preform.then(|| profile.preform_settings());
        let key = PartKey { placement: project.placement, height: project.height, bead_width, preform };
        if let Some((_, part)) = self.part.as_ref().filter(|(of, _)| *of == key) {
            return Ok(part.clone());
        }
        let Some((_, model)) = &self.model else { return Err(Stop::Cancelled) };
        let part = model.clone().place(&project.placement, project.height, bead_width);
        let part = part.map_err(|error| refused(source, &error))?;
        let part = if project.preform { Stocked::of(part, profile, task)?.part } else { part };
        let part = Arc::new(part);
        self.part = Some((key, part.clone()));
        Ok(part)
    }
}

fn read(source: &Source, accept_damaged: bool, task: &Task) -> Result<Model, Stop> {
    let bytes = match source {
        Source::File(path) => disk::read(path).map_err(|text| Stop::Failed(Failure::Sentence(text)))?,
        Source::Example(name) => {
            let found = example::find(name);
            let found = found.ok_or_else(|| Stop::Failed(Failure::Sentence(format!("there is no example {name}."))))?;
            found.stl()
        }
    };
    let read = if accept_damaged { Model::read_damaged } else { Model::read };
    read(&bytes, task).map_err(|error| refused(source, &error))
}

fn refused(source: &Source, error: &PartError) -> Stop {
    let text = format!("{}: {error}", source.label());
    match error {
        PartError::Import(ImportError::Cancelled(_)) => Stop::Cancelled,
        PartError::Units(unclear) => {
            Stop::Failed(Failure::Units(text, Units::ALL.map(|(_, units)| unclear.size_in(units))))
        }
        PartError::Import(ImportError::Damaged { .. }) => Stop::Failed(Failure::Damaged(text)),
        PartError::NoHeight => Stop::Failed(Failure::Height(text)),
        _ => Stop::Failed(Failure::Sentence(text)),
    }
}
