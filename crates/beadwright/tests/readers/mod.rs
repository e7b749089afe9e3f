//! Independent readers of the written programs: they know the languages, not the writers.
#![allow(dead_code, unreachable_pub, clippy::unwrap_used, clippy::expect_used, clippy::panic)]

pub mod gcode;
pub mod krl;
pub mod marlin;
pub mod rapid;

/// A point, mm.
pub type Point = [f64; 3];

/// What a program does, as a machine would see it.
#[derive(Debug, Default, Clone, PartialEq)]
pub struct Motion {
    /// Paths with the arc on, from where the torch stood when it was lit to where it was put out.
    pub welds: Vec<Weld>,
    /// Length of moves without arc after the first point was reached, mm.
    pub travel: f64,
}

/// One path with the arc on.
#[derive(Debug, Default, Clone, PartialEq)]
pub struct Weld {
    pub points: Vec<Point>,
    /// Speeds of the moves, mm/s.
    pub speeds: Vec<f64>,
}

impl Motion {
    pub fn weld_length(&self) -> f64 {
        self.welds.iter().flat_map(|w| w.points.windows(2)).map(|p| distance(p[0], p[1])).sum()
    }
}

pub fn distance(a: Point, b: Point) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

/// Follows moves and arc switching; panics where a controller would do harm.
#[derive(Default)]
pub struct Machine {
    pub motion: Motion,
    pub at: Option<Point>,
    weld: Option<Weld>,
}

impl Machine {
    pub fn arc_on(&mut self) {
        assert!(self.weld.is_none(), "arc on while it burns");
        let start = self.at.expect("arc on before the first move");
        self.weld = Some(Weld { points: vec![start], speeds: Vec::new() });
    }

    pub fn arc_off(&mut self) {
        let weld = self.weld.take().expect("arc off while it is off");
        assert!(weld.points.len() > 1, "arc on and off on one spot");
        self.motion.welds.push(weld);
    }

    pub fn burns(&self) -> bool {
        self.weld.is_some()
    }

    pub fn move_to(&mut self, to: Point, speed: f64) {
        match (&mut self.weld, self.at) {
            (Some(weld), Some(at)) => {
                assert!(distance(at, to) >= 0.0099, "a weld move of no length at {to:?}");
                weld.points.push(to);
                weld.speeds.push(speed);
            }
            (None, Some(at)) => self.motion.travel += distance(at, to),
            (_, None) => {}
        }
        self.at = Some(to);
    }

    pub fn finish(self) -> Motion {
        assert!(self.weld.is_none(), "the program ends with the arc on");
        self.motion
    }
}
