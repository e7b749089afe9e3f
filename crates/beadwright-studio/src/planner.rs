//! Planning in the background: an order goes in, events come out, and a newer order stops the previous one.
//!
//! | file | what it does |
//! | --- | --- |
//! | `work` | carries out an order: reads the model, plans the layer in view, then all layers, judges and checks them |
//! | `thread` | does so on a thread other than the window's |
//! | `worker`, `at_work` | do so in a worker of a browser's page: the page's side, and its own |
//! | [`wire`] | orders and events as bytes, which is what passes between the two |
//!
//! What has been read is kept, so that a change of the profile does not read the model again.

#[cfg(target_arch = "wasm32")]
mod at_work;
#[cfg(not(target_arch = "wasm32"))]
mod thread;
pub mod wire;
mod work;
#[cfg(target_arch = "wasm32")]
mod worker;

#[cfg(target_arch = "wasm32")]
pub use at_work::{plan, take_file};
#[cfg(not(target_arch = "wasm32"))]
use thread::Hand;
#[cfg(target_arch = "wasm32")]
use worker::Hand;

use crate::project::Project;
use crate::view3d::LayerBeads;
use beadwright::Finding;
use beadwright::deposit::{Figures, Judgement};
use beadwright::layer::Layer;
use beadwright::model::{Mesh, Part};
use beadwright::plan::{Header, Summary};
use beadwright::profile::Profile;
use beadwright::task::{Stage, Task};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// What the planner reports; a number says which order it belongs to.
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
    /// What the deposit model says about a layer, and the height error at every piece, in nominal bead heights.
    Judged(usize, Arc<Judgement>, Arc<[f32]>),
    /// Its figures for all layers together, and what the checks found.
    Checked(Figures, Vec<Finding>),
    /// Planning failed; nothing more comes.
    Failed(Failure),
}

/// Why there is no plan.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Failure {
    /// The unit of the model must be given: a sentence that says why, and the size by each unit of
    /// [`Units::ALL`](beadwright::model::Units::ALL), mm.
    Units(String, [String; 4]),
    /// The model is damaged, but part of it can be used: a sentence that says what is wrong.
    Damaged(String),
    /// The height of a wall must be given.
    Height(String),
    /// Anything else, as a sentence.
    Sentence(String),
}

impl Failure {
    /// The sentence.
    pub fn sentence(&self) -> &str {
        match self {
            Self::Units(sentence, _) | Self::Damaged(sentence) | Self::Height(sentence) | Self::Sentence(sentence) => {
                sentence
            }
        }
    }
}

/// What is to be planned.
#[derive(Debug, Clone, PartialEq)]
pub struct Order {
    /// Counts the orders of a planner; events carry it.
    pub number: u64,
    /// The project.
    pub project: Project,
    /// The layer in view, from 0, which is planned first.
    pub layer: usize,
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

/// Plans a project on this thread, as a planner does in the background; a cancelled one ends in silence.
pub fn plan_alone(project: &Project, task: &Task, send: &(dyn Fn(Event) + Sync)) {
    let order = Order { number: 0, project: project.clone(), layer: 0 };
    work::carry_out(&order, task, &mut work::Cache::default(), send);
}

/// Plans in the background; keeps only the events of the last order.
pub struct Planner {
    hand: Hand,
    number: u64,
}

impl Planner {
    /// A planner that calls `notify` when there are events to fetch.
    pub fn new(notify: impl Fn(Urgency) + Send + Sync + 'static) -> Self {
        Self { hand: Hand::new(Arc::new(notify)), number: 0 }
    }

    /// Plans a project, the given layer (from 0) first, and stops any planning in progress.
    pub fn plan(&mut self, project: &Project, layer: usize) {
        self.number += 1;
        self.hand.start(Order { number: self.number, project: project.clone(), layer });
    }

    /// Stops any planning in progress.
    pub fn cancel(&mut self) {
        self.number += 1;
        self.hand.stop();
    }

    /// The new events of the last order.
    pub fn events(&mut self) -> Vec<Event> {
        let number = self.number;
        self.hand.events().into_iter().filter(|(of, _)| *of == number).map(|(_, event)| event).collect()
    }
}
