//! Joins the turns of a helix: a program needs them as one pass, since no program may end with the arc on.

use bead_plan::layer::{Layer, Lit};
use bead_plan::pass::Along;
use std::borrow::Cow;

/// Takes layers, and returns those to be written.
#[derive(Debug, Clone, Default)]
pub struct Turns {
    /// The turns so far, as one layer that ends where the last one does, and the index of that layer.
    so_far: Option<Layer>,
    last: usize,
}

impl Turns {
    /// The layers to be written once this one has come: none while a helix continues.
    pub fn take<'a>(&mut self, layer: &'a Layer) -> Vec<Cow<'a, Layer>> {
        let follows = self.so_far.is_some() && layer.lit.before && layer.index == self.last + 1;
        self.last = layer.index;
        // A helix whose next turn is not welded ends here.
        let mut ready: Vec<Cow<'a, Layer>> =
            if follows { Vec::new() } else { self.end().map(Cow::Owned).into_iter().collect() };
        if layer.lit == Lit::default() {
            ready.push(Cow::Borrowed(layer));
            return ready;
        }
        match &mut self.so_far {
            Some(turns) => append(turns, layer),
            None => self.so_far = Some(Layer { lit: Lit::default(), ..layer.clone() }),
        }
        if !layer.lit.after {
            ready.extend(self.end().map(Cow::Owned));
        }
        ready
    }

    /// The turns of a helix that was not completed.
    pub fn end(&mut self) -> Option<Layer> {
        self.so_far.take()
    }
}

/// Continues the only pass of a layer with that of the next one.
fn append(turns: &mut Layer, next: &Layer) {
    let ([pass], [more]) = (&mut turns.passes[..], &next.passes[..]) else { return };
    let pieces = pass.points.len().saturating_sub(1);
    let joined = |one: &Along, other: &Along| {
        let values = (0..pieces).map(|i| one.after(i)).chain((0..more.points.len()).map(|i| other.after(i)));
        Along::Each(values.collect())
    };
    (pass.width, pass.pace) = (joined(&pass.width, &more.width), joined(&pass.pace, &more.pace));
    pass.points.extend(more.points.iter().skip(1));
    turns.z = next.z;
    turns.islands.clone_from(&next.islands);
}
