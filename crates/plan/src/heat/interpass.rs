//! The limit of the temperature between passes: how long to wait, what to weld meanwhile, and where to begin.

use super::build::{Build, LONGEST_WAIT, LayerHeat, NOISE};
use super::frame::On;
use super::settings::Interpass;
use crate::layer::Layer;
use crate::pass::Pass;
use glam::DVec3;
use std::collections::VecDeque;

/// Points of a closed pass tried as its start.
const STARTS: usize = 16;

/// A pass that begins this close to the end of the last one continues its bead, mm.
const GOES_ON_MM: f64 = 0.5;

/// The first wait tried, s, and the factor for the next ones while the metal is still too hot after them.
const FIRST_WAIT: f64 = 16.0;
const FURTHER: f64 = 1.5;

/// Least length of the pieces into which a pass is cut, in bead widths.
const SHORTEST: f64 = 4.0;

/// A start must be cooler than the planned one by this to replace it, K.
const WORTH_MOVING: f64 = 2.0;

impl Build {
    /// Builds a layer within the limits of `[interpass]`: sets the waits of its passes and, if that saves waiting,
    /// their order and starts. Without limits, the same as [`Self::layer`].
    pub fn layer_within_limits(&mut self, layer: &mut Layer) -> LayerHeat {
        // A helix cannot pause along the way.
        let Some(limits) = self.limits().filter(|_| !layer.lit.is_turn()) else {
            return self.layer(layer);
        };
        let (mut heat, on) = (self.begin(layer), self.on(layer));
        let mut queues = if limits.reorder { by_island(layer) } else { vec![layer.passes.drain(..).collect()] };
        let (mut current, mut end) = (0, None);
        while queues.iter().any(|queue| !queue.is_empty()) {
            self.catch_up(None);
            current = self.next(on, &mut queues, current, end, &limits);
            let Some(mut pass) = queues[current].pop_front() else { break };
            let Some(start) = pass.start() else { continue };
            pass.wait += self.wait_for(on, start, limits.max_temperature);
            if let Some(rest) = self.cut_where_hot(on, &mut pass, &limits) {
                heat.cuts.extend(pass.end().map(|end| end.truncate()));
                queues[current].push_front(rest);
            }
            end = pass.end();
            heat.passes.extend(self.pass(on, &pass));
            layer.passes.push(pass);
        }
        self.end(layer);
        LayerHeat { end: self.seconds(), ..heat }
    }

    /// The queue that comes next: that of the current island while its metal is cool enough, or if its pass continues
    /// from the `end` of the last one; otherwise the first cool one in the planned order, or the one that waits least.
    /// Its pass begins where it is coolest if it must wait.
    fn next(
        &self,
        on: On,
        queues: &mut [VecDeque<Pass>],
        current: usize,
        end: Option<DVec3>,
        limits: &Interpass,
    ) -> usize {
        let hot = |at: DVec3| self.surface(on, at.truncate()) - limits.max_temperature;
        let open: Vec<(usize, DVec3)> =
            queues.iter().enumerate().filter_map(|(q, queue)| Some((q, queue.front()?.start()?))).collect();
        let Some(&(first, _)) = open.first() else { return current };
        let cool = |&&(_, start): &&(usize, DVec3)| hot(start) <= 0.0;
        let goes_on = |&(_, start): &(usize, DVec3)| end.is_some_and(|end| end.distance(start) < GOES_ON_MM);
        let here = open.iter().filter(|(q, _)| *q == current).find(|head| cool(head) || goes_on(head));
        if let Some(&(queue, _)) = here.or_else(|| open.iter().find(cool)) {
            return queue;
        }
        if !limits.reorder {
            return first;
        }
        let heads = open.iter().filter_map(|(q, _)| Some((*q, cooler(queues[*q].front()?, hot))));
        let Some((queue, (_, begin))) = heads.min_by(|a, b| a.1.0.total_cmp(&b.1.0)) else { return first };
        match (begin, queues[queue].front_mut()) {
            (Begin::At(index), Some(pass)) => pass.begin_at(index),
            (Begin::Reversed, Some(pass)) => pass.reverse(),
            _ => {}
        }
        queue
    }

    /// Ends a pass where the metal ahead of the torch would be hotter than the limit, if the limit applies along
    /// passes; returns the rest, which begins on the end of the bead. Both are long enough to be welded.
    fn cut_where_hot(&self, on: On, pass: &mut Pass, limits: &Interpass) -> Option<Pass> {
        if !limits.along {
            return None;
        }
        let (width, length) = (self.settings.bead_width, pass.length());
        let shortest = SHORTEST * width;
        let heat = self.clone().pass(on, pass)?;
        let places = heat.along.iter().enumerate().map(|(k, ahead)| (k as f64 * self.spacing(), ahead));
        let hot = |&(at, ahead): &(f64, &f64)| at >= shortest && *ahead > limits.max_temperature + NOISE;
        let (there, _) = places.into_iter().find(hot)?;
        let at = (there - self.spacing()).max(shortest).min(length - shortest);
        if at < shortest {
            return None;
        }
        let beyond = if pass.closed { width } else { 0.0 };
        let rest = Pass { wait: 0.0, ..pass.stretch(at - width, length + beyond) };
        *pass = pass.stretch(0.0, at);
        Some(rest)
    }

    /// The wait in whole seconds until the metal under the start of a pass is no hotter than `limit` °C when the torch
    /// gets there; [`LONGEST_WAIT`] if it never cools that far.
    fn wait_for(&mut self, on: On, start: DVec3, limit: f64) -> f64 {
        let (at, ambient) = (start.truncate(), self.settings.heat.ambient);
        // Metal this cool does not get too hot in the meantime.
        if self.surface(on, at) <= limit.midpoint(ambient) {
            return 0.0;
        }
        let (today, now) = (self.body.clone(), self.now);
        // By how much the metal is too hot after a wait, K.
        let after = |build: &mut Self, wait: f64| {
            (build.now, build.pending) = (now, 0.0);
            build.body.clone_from(&today);
            build.spend(build.until(wait, start));
            build.catch_up(Some((on, at)));
            build.surface(on, at) - limit
        };
        let wait = shortest(limit - ambient, |wait| after(self, wait));
        (self.body, self.now, self.pending) = (today, now, 0.0);
        wait
    }

    /// Seconds from now until the torch is at a start, including a wait before it.
    fn until(&self, wait: f64, start: DVec3) -> f64 {
        let mut torch = self.torch.clone();
        let pause = torch.wait(wait).map_or(0.0, |pause| pause.moving + pause.seconds);
        pause + torch.approach(start).moving
    }
}

/// Where a pass begins.
#[derive(Clone, Copy)]
enum Begin {
    AsPlanned,
    /// At the point of a closed pass with this index.
    At(usize),
    /// At the other end of an open one.
    Reversed,
}

/// The coolest start of a pass, and the temperature there, °C: anywhere on a closed pass, at either end of an open one.
fn cooler(pass: &Pass, hot: impl Fn(DVec3) -> f64) -> (f64, Begin) {
    let planned = pass.start().map_or(f64::INFINITY, &hot);
    let other = if pass.closed {
        let count = pass.points.len();
        let places = (0..STARTS.min(count)).map(|s| s * count / STARTS.min(count));
        places.map(|index| (hot(pass.points[index]), Begin::At(index))).min_by(|a, b| a.0.total_cmp(&b.0))
    } else {
        pass.end().map(|end| (hot(end), Begin::Reversed))
    };
    other.filter(|(there, _)| *there < planned - WORTH_MOVING).unwrap_or((planned, Begin::AsPlanned))
}

/// The passes of each island in their order, islands in the planned order.
fn by_island(layer: &mut Layer) -> Vec<VecDeque<Pass>> {
    let mut queues: Vec<(Option<usize>, VecDeque<Pass>)> = Vec::new();
    for pass in layer.passes.drain(..) {
        let at = pass.start().unwrap_or_default().truncate();
        let island = layer.islands.iter().position(|island| island.contains(at));
        match queues.iter_mut().find(|(known, _)| *known == island) {
            Some((_, queue)) => queue.push_back(pass),
            None => queues.push((island, VecDeque::from([pass]))),
        }
    }
    queues.into_iter().map(|(_, queue)| queue).collect()
}

/// The shortest wait in whole seconds after which the metal is no hotter than allowed, at most [`LONGEST_WAIT`].
/// `after(wait)` is how much hotter it is than that (K), `rise` (K) the limit above the surroundings.
fn shortest(rise: f64, mut after: impl FnMut(f64) -> f64) -> f64 {
    let (mut short, mut long, mut guess) = (-1.0, f64::INFINITY, 0.0);
    while long - short > 1.0 && guess < LONGEST_WAIT {
        let over = after(guess);
        if over > 0.0 {
            short = guess;
        } else {
            long = guess;
        }
        // Freely cooling metal loses about this much per second, or more.
        let next = (guess + over * guess / rise.max(1.0)).round();
        guess = if next > short && next < long && long.is_finite() {
            next
        } else if long.is_finite() {
            short.midpoint(long).floor()
        } else {
            next.max(FIRST_WAIT + FURTHER * guess)
        };
    }
    long.min(LONGEST_WAIT)
}
