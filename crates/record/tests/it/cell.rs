//! A cell that welds a plan and logs it: arcs with their times, logs with clocks of their own, and what goes wrong.
#![allow(dead_code, reason = "not every test program uses all of it")]

use bead_record::{Place, PlannedPass, Source};
use glam::DVec3;
use std::fmt::Write;

/// SplitMix64 (Steele, Lea and Flood 2014).
pub(crate) struct Dice(pub(crate) u64);

impl Dice {
    /// Between 0 and 1.
    pub(crate) fn part(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (z ^ (z >> 31)) as f64 / u64::MAX as f64
    }

    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.part()
    }

    pub(crate) fn below(&mut self, count: usize) -> usize {
        ((self.part() * count as f64) as usize).min(count - 1)
    }
}

/// Back-and-forth walls: `layers` of some passes of different lengths, or all of `length`.
pub(crate) fn wall(layers: usize, each: usize, length: Option<f64>) -> Vec<PlannedPass> {
    let (mut now, mut passes) = (3.0, Vec::new());
    for layer in 1..=layers {
        for pass in 1..=each {
            let long = length.unwrap_or(60.0 + 13.0 * ((layer * 7 + pass * 5) % 11) as f64);
            let at = |x: f64| DVec3::new(x, 6.0 * pass as f64, 2.0 * layer as f64);
            let moving = long / 8.0;
            let place =
                |part: f64| Place { at: at(part * long), time: now + 0.5 + part * moving, feed: 8.0, speed: 8.0 };
            let path = vec![place(0.0), place(0.4), place(1.0)];
            let out = now + 0.5 + moving + 0.3;
            passes.push(PlannedPass {
                layer,
                pass,
                struck: now,
                out,
                path,
                current: Some(180.0),
                voltage: Some(20.0),
                temperature: None,
            });
            now = out + if pass == each { 12.0 } else { 4.0 };
        }
    }
    passes
}

/// What goes wrong in a pass, between two fractions of its time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Fault {
    /// The feed falls to this fraction.
    Feed(f64),
    /// The arc goes out though it is commanded.
    Out,
}

/// A pass as welded, s.
pub(crate) struct Done {
    pub(crate) planned: usize,
    pub(crate) start: f64,
    pub(crate) end: f64,
}

/// A build.
pub(crate) struct Cell<'a> {
    pub(crate) planned: &'a [PlannedPass],
    pub(crate) done: Vec<Done>,
    pub(crate) faults: Vec<(usize, [f64; 2], Fault)>,
    pub(crate) dice: u64,
}

/// A clock: its time where the true one is 0, by how much it runs fast, and when it is set by how much, s.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Clock {
    pub(crate) zero: f64,
    pub(crate) fast: f64,
    pub(crate) set: Option<(f64, f64)>,
}

impl Clock {
    pub(crate) fn new(zero: f64, fast: f64) -> Self {
        Self { zero, fast, set: None }
    }

    pub(crate) fn at(&self, time: f64) -> f64 {
        let step = self.set.filter(|(when, _)| time >= *when).map_or(0.0, |(_, step)| step);
        self.zero + (1.0 + self.fast) * time + step
    }
}

impl<'a> Cell<'a> {
    /// Welds the plan: robots take a little longer than planned, and pauses vary.
    pub(crate) fn new(planned: &'a [PlannedPass], seed: u64) -> Self {
        let mut dice = Dice(seed);
        let (mut done, mut now, mut last) = (Vec::new(), 5.0, planned[0].struck);
        for (index, pass) in planned.iter().enumerate() {
            now += (pass.struck - last) * dice.between(1.0, 1.1) + dice.between(0.0, 0.3);
            let end = now + pass.seconds() * dice.between(1.0, 1.004);
            done.push(Done { planned: index, start: now, end });
            (now, last) = (end, pass.out);
        }
        Self { planned, done, faults: Vec::new(), dice: seed ^ 0x5eed }
    }

    pub(crate) fn end(&self) -> f64 {
        self.done.last().unwrap().end + 5.0
    }

    pub(crate) fn find(&self, planned: usize) -> &Done {
        self.done.iter().find(|done| done.planned == planned).unwrap()
    }

    /// Current, voltage and feed at a time, without noise; what the power source measures 0.1 s after it is commanded.
    fn power(&self, time: f64) -> [f64; 3] {
        let next = self.done.partition_point(|done| done.end <= time);
        let Some(done) = self.done.get(next).filter(|done| time >= done.start + 0.1) else { return [0.5, 62.0, 0.0] };
        let part = (time - done.start) / (done.end - done.start);
        let fault =
            self.faults.iter().find(|(pass, [from, to], _)| *pass == done.planned && (*from..*to).contains(&part));
        let pass = &self.planned[done.planned];
        let at = pass.struck + part * pass.seconds();
        let feed = pass.value(bead_record::Quantity::Feed, at).unwrap();
        match fault.map(|(.., fault)| *fault) {
            Some(Fault::Out) => [0.8, 61.0, 0.0],
            Some(Fault::Feed(factor)) => [180.0 * (0.4 + 0.6 * factor), 20.0, factor * feed],
            None => [180.0, 20.0, feed],
        }
    }

    /// The power source's log at `hertz`, without the rows of `without`.
    pub(crate) fn power_log(&self, clock: &Clock, hertz: f64, without: &[[f64; 2]]) -> String {
        let mut dice = Dice(self.dice);
        let mut text = "time_s,current_a,voltage_v,wire_feed_speed_m_min\n".to_owned();
        for row in 0..(self.end() * hertz) as usize {
            let time = row as f64 / hertz;
            let [current, voltage, feed] = self.power(time);
            let mut noisy = |value: f64, part: f64| value * (1.0 + part * (dice.part() - 0.5));
            let (current, voltage, feed) = (noisy(current, 0.08), noisy(voltage, 0.06), noisy(feed, 0.03));
            if without.iter().all(|[from, to]| !(*from..*to).contains(&time)) {
                writeln!(text, "{:.3},{current:.1},{voltage:.2},{feed:.3}", clock.at(time)).unwrap();
            }
        }
        text
    }

    /// The controller's log; with layers and passes if it is `named`.
    pub(crate) fn controller_log(&self, clock: &Clock, named: bool) -> String {
        let mut text = "time (s);event;layer;pass;note\n".to_owned();
        for done in &self.done {
            let pass = &self.planned[done.planned];
            let label = if named { format!("{};{}", pass.layer, pass.pass) } else { ";".to_owned() };
            let seconds = |time: f64| format!("{:.3}", clock.at(time)).replace('.', ",");
            writeln!(text, "{};arc_on;{label};", seconds(done.start)).unwrap();
            writeln!(text, "{};arc_off;{label};", seconds(done.end)).unwrap();
        }
        text
    }

    /// A pyrometer that sees the pool: it glows with the arc and cools within seconds.
    pub(crate) fn pyrometer_log(&self, clock: &Clock, hertz: f64) -> String {
        let mut text = "time_s,temperature_c\n".to_owned();
        let mut heat: f64 = 60.0;
        for row in 0..(self.end() * hertz) as usize {
            let time = row as f64 / hertz;
            let burns = self.power(time)[0] > 10.0;
            heat = if burns { 1450.0 } else { 120.0 + (heat - 120.0) * (-1.0 / (1.5 * hertz)).exp() };
            writeln!(text, "{:.3},{heat:.1}", clock.at(time)).unwrap();
        }
        text
    }
}

/// A log read from text.
pub(crate) fn log(name: &str, text: &str) -> Source {
    Source::read(name, text.as_bytes(), &[]).unwrap()
}
