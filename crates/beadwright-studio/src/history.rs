//! Undo and redo.

/// A value with those it had before, and those that were undone.
#[derive(Debug, Clone)]
pub struct History<T> {
    now: T,
    past: Vec<T>,
    future: Vec<T>,
    /// What the last change was about, while it may go on: one drag of a slider is one step.
    open: Option<String>,
}

/// No more steps are kept.
const STEPS: usize = 200;

impl<T: Clone + PartialEq> History<T> {
    /// A value without a past.
    pub fn new(now: T) -> Self {
        Self { now, past: Vec::new(), future: Vec::new(), open: None }
    }

    /// The value.
    pub fn now(&self) -> &T {
        &self.now
    }

    /// Changes the value. Changes about the same thing are one step until [`History::seal`]. Tells whether it differs.
    pub fn set(&mut self, about: &str, next: T) -> bool {
        if next == self.now {
            return false;
        }
        let goes_on = self.open.as_deref() == Some(about);
        let before = std::mem::replace(&mut self.now, next);
        if !goes_on {
            self.past.push(before);
            self.past.drain(..self.past.len().saturating_sub(STEPS));
        }
        self.future.clear();
        self.open = Some(about.to_owned());
        true
    }

    /// The next change is a step of its own.
    pub fn seal(&mut self) {
        self.open = None;
    }

    /// Takes the last step back; false if there is none.
    pub fn undo(&mut self) -> bool {
        self.seal();
        let Some(before) = self.past.pop() else { return false };
        self.future.push(std::mem::replace(&mut self.now, before));
        true
    }

    /// Takes back the last undo; false if there is none.
    pub fn redo(&mut self) -> bool {
        self.seal();
        let Some(after) = self.future.pop() else { return false };
        self.past.push(std::mem::replace(&mut self.now, after));
        true
    }

    /// How many steps can be taken back.
    pub fn steps(&self) -> usize {
        self.past.len()
    }

    /// Whether a step can be taken back.
    pub fn can_undo(&self) -> bool {
        !self.past.is_empty()
    }

    /// Whether an undo can be taken back.
    pub fn can_redo(&self) -> bool {
        !self.future.is_empty()
    }
}
