//! Undo and redo.

/// A value, its earlier values, and those that were undone.
#[derive(Debug, Clone)]
pub struct History<T> {
    now: T,
    past: Vec<Step<T>>,
    future: Vec<Step<T>>,
    /// Whether the last change may still continue: one drag of a slider is one step.
    open: bool,
}

/// A step, with the value on its other side.
#[derive(Debug, Clone)]
struct Step<T> {
    about: String,
    value: T,
}

/// Maximum number of steps that are kept.
const STEPS: usize = 200;

impl<T: Clone + PartialEq> History<T> {
    /// A value without a history.
    pub fn new(now: T) -> Self {
        Self { now, past: Vec::new(), future: Vec::new(), open: false }
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
        let goes_on = self.open && self.undoes() == Some(about);
        let value = std::mem::replace(&mut self.now, next);
        if !goes_on {
            self.past.push(Step { about: about.to_owned(), value });
            self.past.drain(..self.past.len().saturating_sub(STEPS));
        }
        self.future.clear();
        self.open = true;
        true
    }

    /// Makes the next change a separate step.
    pub fn seal(&mut self) {
        self.open = false;
    }

    /// Undoes the last step; false if there is none.
    pub fn undo(&mut self) -> bool {
        self.seal();
        Self::go(&mut self.now, &mut self.past, &mut self.future)
    }

    /// Redoes the last undone step; false if there is none.
    pub fn redo(&mut self) -> bool {
        self.seal();
        Self::go(&mut self.now, &mut self.future, &mut self.past)
    }

    /// Takes the last of some steps, and keeps the way back.
    fn go(now: &mut T, from: &mut Vec<Step<T>>, to: &mut Vec<Step<T>>) -> bool {
        let Some(Step { about, value }) = from.pop() else { return false };
        to.push(Step { about, value: std::mem::replace(now, value) });
        true
    }

    /// How many steps can be undone.
    pub fn steps(&self) -> usize {
        self.past.len()
    }

    /// What the step to be undone next is about.
    pub fn undoes(&self) -> Option<&str> {
        self.past.last().map(|step| &*step.about)
    }

    /// What the step to be redone next is about.
    pub fn redoes(&self) -> Option<&str> {
        self.future.last().map(|step| &*step.about)
    }
}
