//! The page's side of planning in a browser: a worker of the same program, to which orders go as bytes. A worker cannot be
//! interrupted, so one that is to stop is ended, and the next order starts another.

use super::wire::Unpacker;
use super::{Event, Failure, Notify, Order};
use crate::disk::{self, Stamp};
use crate::jobs;
use crate::project::Source;
use js_sys::{Object, Reflect, Uint8Array};
use std::cell::RefCell;
use std::path::PathBuf;
use std::rc::Rc;
use wasm_bindgen::prelude::*;
use web_sys::{Event as PageEvent, MessageEvent, WorkerOptions, WorkerType};

/// The file that starts a worker, next to the page.
const SCRIPT: &str = "worker.js";

/// What has come from the worker, and whether it is at work.
#[derive(Default)]
struct Inbox {
    events: Vec<(u64, Event)>,
    unpacker: Unpacker,
    /// The order in progress.
    number: Option<u64>,
    /// Whether a fault has ended the worker.
    dead: bool,
}

/// The worker, and the events that have come from it.
pub(super) struct Hand {
    inbox: Rc<RefCell<Inbox>>,
    worker: Option<Worker>,
    notify: Notify,
}

impl Hand {
    /// Starts no worker before the first order.
    pub(super) fn new(notify: Notify) -> Self {
        Self { inbox: Rc::default(), worker: None, notify }
    }

    /// Begins an order, and stops the one before.
    pub(super) fn start(&mut self, order: Order) {
        self.stop();
        let number = order.number;
        if let Err(sentence) = self.send(order) {
            self.worker = None;
            self.inbox.borrow_mut().fail(number, sentence);
            (self.notify)(super::Urgency::Now);
        }
    }

    fn send(&mut self, order: Order) -> Result<(), String> {
        if self.inbox.borrow().dead {
            self.worker = None;
        }
        let worker = match self.worker.take() {
            Some(worker) => worker,
            None => {
                *self.inbox.borrow_mut() = Inbox::default();
                Worker::start(&self.inbox, &self.notify)?
            }
        };
        let worker = self.worker.insert(worker);
        let mut inbox = self.inbox.borrow_mut();
        inbox.unpacker.begin(&order.project.profile);
        inbox.number = Some(order.number);
        worker.ask(&order)
    }

    /// Ends a worker that is busy; an idle one is kept, with everything that it has read.
    pub(super) fn stop(&mut self) {
        if self.inbox.borrow_mut().number.take().is_some() {
            self.worker = None;
        }
    }

    /// The events since the last call, with the numbers of their orders.
    pub(super) fn events(&mut self) -> Vec<(u64, Event)> {
        std::mem::take(&mut self.inbox.borrow_mut().events)
    }
}

impl Inbox {
    /// Takes a message: bytes are an event, `null` is the end of an order, text is why the worker has ended.
    fn take(&mut self, message: &JsValue) {
        if let Some(reason) = message.as_string() {
            self.end(&reason);
        } else if message.is_null() {
            self.number = None;
        } else {
            match self.unpacker.unpack(&Uint8Array::new(message).to_vec()) {
                Ok(event) => self.events.push(event),
                Err(sentence) => self.end(&sentence),
            }
        }
    }

    fn end(&mut self, reason: &str) {
        self.dead = true;
        if let Some(number) = self.number.take() {
            self.fail(number, jobs::fault(reason));
        }
    }

    fn fail(&mut self, number: u64, sentence: String) {
        self.events.push((number, Event::Failed(Failure::Sentence(sentence))));
    }
}

/// A worker that lives as long as this.
struct Worker {
    worker: web_sys::Worker,
    /// The model file that it has.
    file: Option<(PathBuf, Option<Stamp>)>,
    _on_message: Closure<dyn FnMut(MessageEvent)>,
    _on_error: Closure<dyn FnMut(PageEvent)>,
}

impl Worker {
    fn start(inbox: &Rc<RefCell<Inbox>>, notify: &Notify) -> Result<Self, String> {
        let options = WorkerOptions::new();
        options.set_type(WorkerType::Module);
        let failed =
            |error: JsValue| format!("the planning worker cannot be started ({error:?}). Load the page again.");
        let worker = web_sys::Worker::new_with_options(SCRIPT, &options).map_err(failed)?;
        let (to, bell) = (inbox.clone(), notify.clone());
        let on_message = Closure::new(move |message: MessageEvent| {
            to.borrow_mut().take(&message.data());
            bell(to.borrow().events.last().map_or(super::Urgency::Soon, |(_, event)| event.urgency()));
        });
        let (to, bell) = (inbox.clone(), notify.clone());
        let on_error = Closure::new(move |error: PageEvent| {
            // Only errors of a script that runs carry a message.
            let reason = Reflect::get(&error, &"message".into()).ok().and_then(|reason| reason.as_string());
            to.borrow_mut().end(reason.as_deref().unwrap_or("worker.js cannot be loaded"));
            bell(super::Urgency::Now);
        });
        worker.set_onmessage(Some(on_message.as_ref().unchecked_ref()));
        worker.set_onerror(Some(on_error.as_ref().unchecked_ref()));
        // Compiled once, for the page and all its workers.
        worker.post_message(&wasm_bindgen::module()).map_err(failed)?;
        Ok(Self { worker, file: None, _on_message: on_message, _on_error: on_error })
    }

    fn ask(&mut self, order: &Order) -> Result<(), String> {
        let failed = |error: JsValue| format!("the planning worker takes no orders ({error:?}). Load the page again.");
        if let Some(Source::File(path)) = &order.project.source {
            let file = Some((path.clone(), disk::stamp(path)));
            if self.file != file {
                let message = file_message(path.to_string_lossy().as_ref(), &disk::read(path)?).map_err(failed)?;
                self.worker.post_message(&message).map_err(failed)?;
                self.file = file;
            }
        }
        self.worker.post_message(&Uint8Array::from(&*order.pack()?)).map_err(failed)
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        self.worker.terminate();
    }
}

/// `{name, bytes}`.
fn file_message(name: &str, bytes: &[u8]) -> Result<Object, JsValue> {
    let pairs = [("name", JsValue::from_str(name)), ("bytes", Uint8Array::from(bytes).into())];
    let message = Object::new();
    for (key, value) in pairs {
        Reflect::set(&message, &key.into(), &value)?;
    }
    Ok(message)
}
