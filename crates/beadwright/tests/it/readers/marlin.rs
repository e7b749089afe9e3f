//! A reader of printers' G-code: positions and E, absolute or relative; filament back before it goes forward again.

use super::{Point, angle_between, distance};

/// What a printer does.
#[derive(Debug, Default)]
pub struct Print {
    /// Extruded paths.
    pub paths: Vec<Vec<Point>>,
    /// Filament in the paths, mm.
    pub filament: f64,
    /// Filament drawn back in all, mm.
    pub drawn_back: f64,
    /// Length of moves without extrusion after the first point was reached, mm.
    pub travel: f64,
    /// Sum of all waits, s.
    pub waits: f64,
    /// Speed and filament per length of every extruding move, mm/s and mm/mm.
    pub moves: Vec<(f64, f64)>,
}

/// Runs a program; panics where a printer would do harm.
pub fn run(text: &str) -> Print {
    assert!(text.is_ascii());
    let mut print = Print::default();
    let (mut at, mut e, mut relative, mut hot, mut held) = ([None::<f64>; 3], 0.0, None, false, 0.0);
    let (mut goes_on, mut feed) = (false, 0.0);
    for line in text.lines() {
        assert!(line.len() < 96, "too long for Marlin: {line}");
        let code = line.split(';').next().unwrap().trim();
        let mut words = code.split_whitespace();
        let Some(command) = words.next() else { continue };
        let value = |letter: char| {
            let word = code.split_whitespace().skip(1).find(|w| w.starts_with(letter));
            word.map(|w| w[1..].parse::<f64>().unwrap_or_else(|_| panic!("{line}")))
        };
        match command {
            "M82" | "M83" => relative = Some(command == "M83"),
            "M109" => hot = value('S').unwrap() > 150.0,
            "M104" => hot &= value('S') != Some(0.0),
            "G4" => print.waits += value('P').unwrap() / 1000.0,
            "G92" => e = value('E').unwrap(),
            "G0" | "G1" | "G2" | "G3" => {
                let from = at;
                feed = value('F').unwrap_or(feed);
                for (axis, letter) in ['X', 'Y', 'Z'].into_iter().enumerate() {
                    at[axis] = value(letter).or(at[axis]);
                }
                let pushed = match (value('E'), relative.expect("neither M82 nor M83")) {
                    (None, _) => 0.0,
                    (Some(by), true) => by,
                    (Some(to), false) => to - std::mem::replace(&mut e, to),
                };
                assert!(command != "G0" || pushed == 0.0, "extrusion with G0: {line}");
                let ends = (point(from), point(at));
                let (Some(a), Some(b)) = ends else { continue };
                if a == b {
                    assert!(pushed != 0.0 || value('F').is_some(), "nothing moves: {line}");
                    held -= pushed;
                    print.drawn_back += (-pushed).max(0.0);
                    assert!(held > -1e-9, "more filament pushed forward than was drawn back: {line}");
                } else if pushed > 0.0 {
                    assert!(hot, "cold extrusion: {line}");
                    assert!(held.abs() < 1e-9, "extrusion with the filament drawn back: {line}");
                    print.filament += pushed;
                    if !goes_on {
                        print.paths.push(vec![a]);
                    }
                    let path = print.paths.last_mut().unwrap();
                    let before = path.len();
                    if let ("G2" | "G3", Some(i), Some(j)) = (command, value('I'), value('J')) {
                        path.extend(chords(a, [a[0] + i, a[1] + j], command == "G3", b));
                    }
                    path.push(b);
                    let length: f64 = path[before - 1..].windows(2).map(|p| distance(p[0], p[1])).sum();
                    print.moves.push((feed / 60.0, pushed / length));
                } else {
                    assert!(pushed == 0.0, "filament drawn back on the way: {line}");
                    let mut way = vec![a];
                    if let ("G2" | "G3", Some(i), Some(j)) = (command, value('I'), value('J')) {
                        way.extend(chords(a, [a[0] + i, a[1] + j], command == "G3", b));
                    }
                    way.push(b);
                    print.travel += way.windows(2).map(|p| distance(p[0], p[1])).sum::<f64>();
                }
                goes_on = pushed > 0.0 && a != b;
            }
            _ => goes_on = false,
        }
    }
    assert!(!hot, "the nozzle stays hot");
    print
}

/// Points along an arc, without its ends.
fn chords(from: Point, centre: [f64; 2], left: bool, to: Point) -> Vec<Point> {
    let angle = |p: Point| (p[1] - centre[1]).atan2(p[0] - centre[0]);
    let radius = |p: Point| (p[1] - centre[1]).hypot(p[0] - centre[0]);
    assert!((radius(from) - radius(to)).abs() < 0.01, "the end does not lie on the circle");
    let sweep = angle_between(angle(from), angle(to));
    assert_eq!(sweep > 0.0, left, "an arc of half a turn or more");
    let at = |t: f64| [centre[0] + radius(from) * t.cos(), centre[1] + radius(from) * t.sin(), to[2]];
    let count = (sweep.abs() / 0.01).ceil() as usize;
    (1..count).map(|i| at(angle(from) + sweep * i as f64 / count as f64)).collect()
}

fn point(at: [Option<f64>; 3]) -> Option<Point> {
    let [Some(x), Some(y), Some(z)] = at else { return None };
    Some([x, y, z])
}
