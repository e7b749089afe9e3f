//! The worker's own side: what `worker.js` calls.

use super::Event;
use super::wire::Packer;
use super::work::{Cache, carry_out};
use crate::disk;
use crate::planner::Order;
use beadwright::task::Task;
use js_sys::{Array, Uint8Array};
use std::cell::RefCell;
use std::sync::{Arc, Mutex, PoisonError};
use wasm_bindgen::prelude::*;
use web_sys::DedicatedWorkerGlobalScope;

thread_local! {
    /// What has been read, and what has been sent.
    static KEPT: RefCell<(Cache, Arc<Mutex<Packer>>)> = RefCell::default();
}

/// Takes the model file for the orders that follow.
#[wasm_bindgen]
pub fn take_file(name: &str, bytes: Vec<u8>) {
    disk::hand_over(name.as_ref(), Ok(bytes));
}

/// Carries out an order and posts its events; then `null`.
///
/// # Errors
/// A sentence: these are not the bytes of an order.
#[wasm_bindgen]
pub fn plan(order: &[u8]) -> Result<(), JsValue> {
    let order = Order::unpack(order).map_err(|sentence| JsValue::from_str(&sentence))?;
    KEPT.with_borrow_mut(|(cache, packer)| {
        let (number, to) = (order.number, packer.clone());
        let task = Task::with_progress(move |stage, fraction| send(&to, number, Event::Progress(stage, fraction)));
        let to = packer.clone();
        carry_out(&order, &task, cache, &|event| send(&to, number, event));
    });
    scope().post_message(&JsValue::NULL)
}

fn scope() -> DedicatedWorkerGlobalScope {
    js_sys::global().unchecked_into()
}

fn send(packer: &Mutex<Packer>, number: u64, event: Event) {
    let packed = packer.lock().unwrap_or_else(PoisonError::into_inner).pack(number, event);
    // Text ends the order with this reason; a page that takes no messages is gone, and this worker with it.
    let _ = match packed {
        Ok(bytes) => {
            let bytes = Uint8Array::from(&*bytes);
            scope().post_message_with_transfer(&bytes, &Array::of1(&bytes.buffer()))
        }
        Err(sentence) => scope().post_message(&sentence.into()),
    };
}
