//! Planning on a thread other than the window's.

use super::work::{Cache, carry_out};
use super::{Event, Notify, Order, Urgency};
use beadwright::task::Task;
use std::sync::mpsc::{Receiver, Sender, channel};

/// The thread, and the events that have come from it.
pub(super) struct Hand {
    orders: Sender<(Order, Task)>,
    events: Receiver<(u64, Event)>,
    sender: Sender<(u64, Event)>,
    task: Task,
    notify: Notify,
}

impl Hand {
    /// A thread that waits for orders and calls `notify` when there are events.
    pub(super) fn new(notify: Notify) -> Self {
        let (orders, inbox) = channel::<(Order, Task)>();
        let (sender, events) = channel();
        let (outbox, bell) = (sender.clone(), notify.clone());
        std::thread::spawn(move || serve(&inbox, &outbox, &bell));
        Self { orders, events, sender, task: Task::new(), notify }
    }

    /// Begins an order, and stops the one before.
    pub(super) fn start(&mut self, order: Order) {
        self.task.cancel();
        let (number, sender, bell) = (order.number, self.sender.clone(), self.notify.clone());
        self.task = Task::with_progress(move |stage, fraction| {
            if sender.send((number, Event::Progress(stage, fraction))).is_ok() {
                bell(Urgency::Soon);
            }
        });
        // The thread lives as long as this sender.
        let _ = self.orders.send((order, self.task.clone()));
    }

    /// Stops the order in progress.
    pub(super) fn stop(&mut self) {
        self.task.cancel();
    }

    /// The events since the last call, with the numbers of their orders.
    pub(super) fn events(&mut self) -> Vec<(u64, Event)> {
        self.events.try_iter().collect()
    }
}

impl Drop for Hand {
    fn drop(&mut self) {
        self.task.cancel();
    }
}

fn serve(inbox: &Receiver<(Order, Task)>, outbox: &Sender<(u64, Event)>, bell: &Notify) {
    let mut kept = Cache::default();
    while let Ok(mut newest) = inbox.recv() {
        // Only the newest order counts.
        while let Ok(newer) = inbox.try_recv() {
            newest = newer;
        }
        let (order, task) = newest;
        let send = |event: Event| {
            let urgency = event.urgency();
            if outbox.send((order.number, event)).is_ok() {
                bell(urgency);
            }
        };
        carry_out(&order, &task, &mut kept, &send);
    }
}
