//! Independent readers of the written programs: they know the languages, not the writers.
#![allow(dead_code, unreachable_pub, clippy::unwrap_used, clippy::expect_used, clippy::panic)]

pub mod branches;
pub mod cnc;
pub mod fanuc;
pub mod gcode;
pub mod inform;
pub mod krl;
pub mod linuxcnc;
pub mod marlin;
pub mod rapid;
pub mod urscript;

use std::collections::BTreeMap;
use std::path::Path;

/// A point, mm.
pub type Point = [f64; 3];

/// What a program does, as a machine would see it.
#[derive(Debug, Default, Clone, PartialEq)]
pub struct Motion {
    /// Paths with the arc on, from where the torch stood when it was lit to where it was put out.
    pub welds: Vec<Weld>,
    /// Length of moves without arc after the first point was reached, mm.
    pub travel: f64,
    /// Circular moves.
    pub circles: usize,
    /// Sum of all waits, in the unit of the language, s.
    pub waits: f64,
    /// What the wire feed was set to while the arc was on or before, in the order of the program.
    pub feeds: Vec<f64>,
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

/// Centre and radius of the circle through three points of one height.
fn circle(a: Point, b: Point, c: Point) -> (Point, f64) {
    assert!(a[2] == b[2] && b[2] == c[2], "an arc that climbs");
    let (bx, by, cx, cy) = (b[0] - a[0], b[1] - a[1], c[0] - a[0], c[1] - a[1]);
    let d = 2.0 * (bx * cy - by * cx);
    assert!(d.abs() > 1e-9, "an arc through three points of a line");
    let (b2, c2) = (bx * bx + by * by, cx * cx + cy * cy);
    let (x, y) = ((cy * b2 - by * c2) / d, (bx * c2 - cx * b2) / d);
    ([a[0] + x, a[1] + y, a[2]], x.hypot(y))
}

/// The smaller turn from one direction to another, radians.
pub fn angle_between(a: f64, b: f64) -> f64 {
    use std::f64::consts::{PI, TAU};
    (b - a + PI).rem_euclid(TAU) - PI
}

/// Follows moves and arc switching; panics where a controller would do harm.
#[derive(Default)]
pub struct Machine {
    pub motion: Motion,
    pub at: Option<Point>,
    weld: Option<Weld>,
    /// Whether the torch stands over a bead that it has just laid, or comes from anywhere: the next way must be upright.
    over: bool,
}

impl Machine {
    pub fn arc_on(&mut self) {
        assert!(self.weld.is_none(), "arc on while it burns");
        let start = self.at.expect("arc on before the first move");
        self.weld = Some(Weld { points: vec![start], speeds: Vec::new() });
    }

    pub fn arc_off(&mut self) {
        let weld = self.weld.take().expect("arc off while it is off");
        self.over = true;
        assert!(weld.points.len() > 1, "arc on and off on one spot");
        self.motion.welds.push(weld);
    }

    pub fn wait(&mut self, seconds: f64) {
        assert!(seconds >= 0.0 && seconds.is_finite());
        self.motion.waits += seconds;
    }

    pub fn burns(&self) -> bool {
        self.weld.is_some()
    }

    /// A move of the joints to a place above the part.
    pub fn approach(&mut self, to: Point) {
        assert!(self.at.is_none() && self.weld.is_none(), "the joints move in the part");
        (self.at, self.over) = (Some(to), true);
    }

    pub fn move_to(&mut self, to: Point, speed: f64) {
        if let Some(at) = self.at.filter(|_| self.over && self.weld.is_none()) {
            assert!(at[..2] == to[..2], "the torch goes across to {to:?} where it should go up or down");
            self.over = false;
        }
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

    /// A circular move over `via`, in chords so fine that its length is kept within 1e-5.
    pub fn arc_to(&mut self, via: Point, to: Point, speed: f64) {
        let from = self.at.expect("an arc from nowhere");
        let (centre, radius) = circle(from, via, to);
        let angle = |p: Point| (p[1] - centre[1]).atan2(p[0] - centre[0]);
        let sweep = angle_between(angle(from), angle(via)) + angle_between(angle(via), angle(to));
        assert!(sweep.abs() < std::f64::consts::PI, "an arc of half a turn or more to {to:?}");
        assert!(sweep.abs() > 0.017 && distance(from, via) >= 0.1 && distance(via, to) >= 0.1, "a tiny arc to {to:?}");
        self.turn_to(centre, radius, sweep, to, speed);
    }

    /// A circular move about `centre`; `sweep` in radians, counter-clockwise above 0.
    pub fn turn_to(&mut self, centre: Point, radius: f64, sweep: f64, to: Point, speed: f64) {
        let from = self.at.expect("an arc from nowhere");
        assert!((distance(to, centre) - radius).abs() < 0.01, "the end {to:?} does not lie on the circle");
        assert!(distance(from, to) >= 0.0099, "a weld move of no length at {to:?}");
        let start = (from[1] - centre[1]).atan2(from[0] - centre[0]);
        let chords = (sweep.abs() / 0.01).ceil().max(1.0);
        self.at = Some(to);
        self.motion.circles += 1;
        let Some(weld) = self.weld.as_mut() else {
            self.motion.travel += radius * sweep.abs();
            return;
        };
        for i in 1..chords as usize {
            let angle = start + sweep * i as f64 / chords;
            weld.points.push([centre[0] + radius * angle.cos(), centre[1] + radius * angle.sin(), to[2]]);
            weld.speeds.push(speed);
        }
        weld.points.push(to);
        weld.speeds.push(speed);
    }

    /// G2 and G3: the centre as seen from the start.
    pub fn turn_about(&mut self, centre: [f64; 2], left: bool, to: Point, speed: f64) {
        let from = self.at.expect("an arc from nowhere");
        let centre = [from[0] + centre[0], from[1] + centre[1], from[2]];
        let angle = |p: Point| (p[1] - centre[1]).atan2(p[0] - centre[0]);
        let sweep = angle_between(angle(from), angle(to));
        assert_eq!(sweep > 0.0, left, "an arc of half a turn or more to {to:?}");
        self.turn_to(centre, distance(from, centre), sweep, to, speed);
    }

    pub fn finish(self) -> Motion {
        assert!(self.weld.is_none(), "the program ends with the arc on");
        assert!(!self.over, "the program ends on the bead");
        self.motion
    }
}

/// Compares with the folder `tests/golden/NAME`; `BEADWRIGHT_GOLDEN=write` writes it instead.
pub fn golden(name: &str, files: &BTreeMap<String, String>) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden").join(name);
    if std::env::var("BEADWRIGHT_GOLDEN").is_ok_and(|v| v == "write") {
        std::fs::create_dir_all(&folder).unwrap();
        files.iter().for_each(|(file, text)| std::fs::write(folder.join(file), text).unwrap());
    }
    let mut found: Vec<String> =
        std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    found.sort();
    assert_eq!(found, files.keys().cloned().collect::<Vec<_>>());
    for (file, text) in files {
        let expected = std::fs::read_to_string(folder.join(file)).unwrap();
        let differs = text.lines().zip(expected.lines()).find(|(a, b)| a != b);
        assert_eq!(differs, None, "{name}/{file}");
        assert!(*text == expected, "{name}/{file} differs in length or line ends");
    }
}
