//! Independent readers of the written programs: they know the languages, not the writers.
#![allow(dead_code, unreachable_pub)]

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

use glam::{DQuat, DVec3};
use std::collections::BTreeMap;
use std::path::Path;

/// A point, mm.
pub type Point = [f64; 3];

/// How a program states that the torch stands: its point, its tool (z along the wire, out of the torch) in the program's
/// frame, and the axes beside the robot's, as far as they are stated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stand {
    pub at: Point,
    pub tool: DQuat,
    pub axes: [Option<f64>; 2],
}

impl From<Point> for Stand {
    /// A torch that points straight down.
    fn from(at: Point) -> Self {
        Self { at, tool: DQuat::from_xyzw(1.0, 0.0, 0.0, 0.0), axes: [None; 2] }
    }
}

/// A, B, C of KRL; W, P, R of FANUC and Rx, Ry, Rz of Yaskawa are the same turns in the other order, °.
pub fn euler(about_z: f64, about_y: f64, about_x: f64) -> DQuat {
    let [z, y, x] = [about_z, about_y, about_x].map(f64::to_radians);
    DQuat::from_rotation_z(z) * DQuat::from_rotation_y(y) * DQuat::from_rotation_x(x)
}

/// How a controller carries the tool along an arc from the stand at its start to that at its end.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Carried {
    /// Turned evenly in the program's frame.
    #[default]
    InTheFrame,
    /// Turned evenly as seen from the tangent.
    OnThePath,
    /// Held to the tangent as at the start, whatever the end says.
    ByTheTangent,
}

impl Carried {
    /// The tool at the fraction `part` of an arc that turns by `sweep` (radians) about the vertical.
    fn along(self, from: DQuat, to: DQuat, sweep: f64, part: f64) -> DQuat {
        let tangent = |part: f64| DQuat::from_rotation_z(sweep * part);
        match self {
            Self::InTheFrame => from.slerp(to, part),
            Self::OnThePath => tangent(part) * from.slerp(tangent(-1.0) * to, part),
            Self::ByTheTangent => tangent(part) * from,
        }
    }
}

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
    /// On the part, mm.
    pub points: Vec<Point>,
    /// The tool at each point, in the part's frame.
    pub tools: Vec<DQuat>,
    /// How far the table has turned at each point, °.
    pub turns: Vec<f64>,
    /// The axes beside the robot's at each point, as far as they are stated, °.
    pub axes: Vec<[Option<f64>; 2]>,
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
    /// Which of the axes beside the robot's turns the table under the part, about the origin of the program's frame.
    pub table: Option<usize>,
    /// Whether the program's frame turns with the table.
    pub frame_turns: bool,
    /// How the tool is carried along arcs.
    pub carried: Carried,
    /// Height that the program adds to its points, mm.
    pub lift: f64,
    pub at: Option<Point>,
    pub stand: Option<Stand>,
    weld: Option<Weld>,
    /// Whether the torch stands over a bead that it has just laid, or comes from anywhere: the next way must be upright.
    over: bool,
}

impl Machine {
    pub fn arc_on(&mut self) {
        assert!(self.weld.is_none(), "arc on while it burns");
        let start = self.stand.expect("arc on before the first move");
        self.weld = Some(Weld::default());
        self.lay(start, None);
    }

    /// The angle of the table where a stand says one, °.
    fn turn(&self, stand: &Stand) -> f64 {
        self.table.and_then(|axis| stand.axes[axis]).unwrap_or(0.0)
    }

    /// A point of the bead, on the part: a frame that does not turn with the table leaves the path standing in the cell
    /// while the part turns away below it.
    fn lay(&mut self, stand: Stand, speed: Option<f64>) {
        let turn = self.turn(&stand);
        let back = DQuat::from_rotation_z(if self.frame_turns { 0.0 } else { -turn.to_radians() });
        let Some(weld) = &mut self.weld else { return };
        let at = DVec3::from_array(stand.at) + DVec3::Z * self.lift;
        weld.points.push((back * at).to_array());
        weld.tools.push(back * stand.tool);
        weld.turns.push(turn);
        weld.axes.push(stand.axes);
        weld.speeds.extend(speed);
    }

    /// All stands of a program state the same axes.
    fn arrive(&mut self, stand: Stand) {
        let stated = |stand: &Stand| stand.axes.map(|axis| axis.is_some());
        let same = self.stand.is_none_or(|before| stated(&before) == stated(&stand));
        assert!(same, "an axis is stated here and not there: {stand:?}");
        (self.at, self.stand) = (Some(stand.at), Some(stand));
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
    pub fn approach(&mut self, to: impl Into<Stand>) {
        assert!(!self.over && self.weld.is_none(), "the joints move in the part");
        self.arrive(to.into());
        self.over = true;
    }

    pub fn move_to(&mut self, to: impl Into<Stand>, speed: f64) {
        let stand = to.into();
        let to = stand.at;
        if let Some(at) = self.at.filter(|_| self.over && self.weld.is_none()) {
            let way = DVec3::from_array(to) - DVec3::from_array(at);
            // On layers that are not level, along the wire.
            let along_the_wire = self.stand.is_some_and(|stand| (stand.tool * DVec3::Z).cross(way).length() < 2e-3);
            assert!(
                way.truncate().length() < 2e-3 || along_the_wire,
                "the torch goes across to {to:?} where it should go up or down"
            );
            self.over = false;
        }
        match (self.burns(), self.at) {
            (true, Some(at)) => {
                assert!(distance(at, to) >= 0.0099, "a weld move of no length at {to:?}");
                self.lay(stand, Some(speed));
            }
            (false, Some(at)) => self.motion.travel += distance(at, to),
            (_, None) => {}
        }
        self.arrive(stand);
    }

    /// A circular move over `via`, in chords so fine that its length is kept within 1e-5.
    pub fn arc_to(&mut self, via: impl Into<Stand>, to: impl Into<Stand>, speed: f64) {
        let (via, stand) = (via.into().at, to.into());
        let to = stand.at;
        let from = self.at.expect("an arc from nowhere");
        let (centre, radius) = circle(from, via, to);
        let angle = |p: Point| (p[1] - centre[1]).atan2(p[0] - centre[0]);
        let sweep = angle_between(angle(from), angle(via)) + angle_between(angle(via), angle(to));
        assert!(sweep.abs() < std::f64::consts::PI, "an arc of half a turn or more to {to:?}");
        assert!(sweep.abs() > 0.017 && distance(from, via) >= 0.1 && distance(via, to) >= 0.1, "a tiny arc to {to:?}");
        self.turn_to(centre, radius, sweep, stand, speed);
    }

    /// A circular move about `centre`; `sweep` in radians, counter-clockwise above 0.
    pub fn turn_to(&mut self, centre: Point, radius: f64, sweep: f64, to: impl Into<Stand>, speed: f64) {
        let end: Stand = to.into();
        let (begin, to) = (self.stand.expect("an arc from nowhere"), end.at);
        let from = begin.at;
        assert!((distance(to, centre) - radius).abs() < 0.01, "the end {to:?} does not lie on the circle");
        assert!(distance(from, to) >= 0.0099, "a weld move of no length at {to:?}");
        let start = (from[1] - centre[1]).atan2(from[0] - centre[0]);
        let chords = (sweep.abs() / 0.01).ceil().max(1.0);
        self.motion.circles += 1;
        let carried = self.carried;
        let along = |part: f64| {
            let angle = start + sweep * part;
            let at = [centre[0] + radius * angle.cos(), centre[1] + radius * angle.sin(), to[2]];
            let axis = |i: usize| Some(begin.axes[i]? + (end.axes[i]? - begin.axes[i]?) * part);
            Stand { at, tool: carried.along(begin.tool, end.tool, sweep, part), axes: [0, 1].map(axis) }
        };
        if self.burns() {
            (1..chords as usize).for_each(|i| self.lay(along(i as f64 / chords), Some(speed)));
            self.lay(Stand { at: to, ..along(1.0) }, Some(speed));
        } else {
            self.motion.travel += radius * sweep.abs();
        }
        // A tool that keeps to the tangent arrives as the arc leaves it.
        self.arrive(Stand { tool: along(1.0).tool, ..end });
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
