//! Undo and redo.

/// A value, its earlier values, and those that were undone.
#[derive(Debug, Clone)]
pub struct History<T> {
    now: T,
    past: Vec<T>,
    future: Vec<T>,
    /// What the last change was about, while it may still continue: one drag of a slider is one step.
    open: Option<String>,
}

/// Maximum number of steps that are kept.
const STEPS: usize = 200;

impl<T: Clone + PartialEq> History<T> {
    /// A value without a history.
    pub fn new(now: T) -> Self {
        Self { now, past: Vec::new(), future: Vec::new(), open: None }
    }

    /// The value.
    pub fn now(&self) -> &T {
        &self.now
    }

    /// Changes the value; true if it differs. Changes about the same thing are one step until [`History::seal`].
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

    /// Makes the next change a separate step.
    pub fn seal(&mut self) {
        self.open = None;
    }

    /// Undoes the last step; false if there is none.
    pub fn undo(&mut self) -> bool {
        self.seal();
        let Some(before) = self.past.pop() else { return false };
        self.future.push(std::mem::replace(&mut self.now, before));
        true
    }

    /// Redoes the last undone step; false if there is none.
    pub fn redo(&mut self) -> bool {
        self.seal();
        let Some(after) = self.future.pop() else { return false };
        self.past.push(std::mem::replace(&mut self.now, after));
        true
    }

    /// How many steps can be undone.
    pub fn steps(&self) -> usize {
        self.past.len()
    }

    /// Whether a step can be undone.
    pub fn can_undo(&self) -> bool {
        !self.past.is_empty()
    }

    /// Whether a step can be redone.
    pub fn can_redo(&self) -> bool {
        !self.future.is_empty()
    }
}
