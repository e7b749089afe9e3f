//! A reader of CNC G-code: modal words, one M code a block, G0 never with the arc on.

use super::{Machine, Motion, Stand};
use glam::{DQuat, DVec3};

/// Runs a program; `arc_on` and `arc_off` are the M codes of the arc.
pub fn run(text: &str, arc_on: u32, arc_off: u32) -> Motion {
    assert!(text.starts_with("%\n") && text.ends_with("%\n"));
    run_flavour(&text[2..text.len() - 2], arc_on, arc_off)
}

/// The same for a program without `%` signs.
pub fn run_flavour(text: &str, arc_on: u32, arc_off: u32) -> Motion {
    let mut start = text.lines().find_map(super::branches::declaration).unwrap_or(0.0);
    let text = &super::branches::resolve(text, &mut start);
    let lines: Vec<&str> = text.lines().collect();
    assert!(text.is_ascii() && !text.contains('%'));
    let mut reader = Reader::default();
    let mut ended = false;
    for line in &lines {
        assert!(line.len() < 80, "block too long: {line}");
        assert!(!ended, "a block after M30: {line}");
        if line.starts_with('(') {
            assert!(!text.contains(';') && line.ends_with(')') && line.matches('(').count() == 1, "{line}");
            continue;
        }
        if line.starts_with(';') {
            assert!(!text.contains('('), "two kinds of comments");
            continue;
        }
        let words: Vec<(char, f64)> = line.split_whitespace().map(word).collect();
        let codes = |letter: char| words.iter().filter(move |w| w.0 == letter).map(|w| w.1 as u32);
        assert!(codes('M').count() <= 1, "two M codes in one block: {line}");
        if let Some(m) = codes('M').next() {
            assert!(words.iter().all(|w| !"XYZ".contains(w.0)), "M code in a motion block: {line}");
            match m {
                m if m == arc_on => reader.machine.arc_on(),
                // At its end the program makes sure once more.
                m if m == arc_off && !reader.machine.burns() => {}
                m if m == arc_off => reader.machine.arc_off(),
                // Tool centre point control of LinuxCNC: X, Y and Z are places on the part, or the machine's axes.
                428 | 429 => reader.control_tip(m == 428),
                m => ended |= m == 30,
            }
        }
        reader.block(&words, line);
    }
    assert!(ended, "no M30");
    reader.machine.finish()
}

#[derive(Default)]
struct Reader {
    machine: Machine,
    axes: [Option<f64>; 3],
    motion: Option<u32>,
    /// mm/min
    feed: Option<f64>,
    /// Angles of A, B and C, °.
    turned: [Option<f64>; 3],
    /// Whether X, Y and Z are places on the part, however it is turned.
    tip_control: Option<bool>,
}

impl Reader {
    fn control_tip(&mut self, on: bool) {
        assert!(!self.machine.burns(), "tool centre point control is switched under the arc");
        assert_eq!(
            self.motion == Some(0),
            on,
            "as it is switched the torch stands where G0 brought it, or on its way from the part"
        );
        (self.tip_control, self.axes) = (Some(on), [None; 3]);
    }

    /// A torch that points straight down in the machine, on a part that lies on a table carried by A or B and turned by C.
    fn stand(&self, at: super::Point) -> Stand {
        let stated: Vec<f64> = self.turned.into_iter().flatten().collect();
        let turns = self.turned.iter().zip([DVec3::X, DVec3::Y, DVec3::Z]);
        let part = turns.fold(DQuat::IDENTITY, |all, (angle, axis)| {
            all * DQuat::from_axis_angle(axis, angle.unwrap_or(0.0).to_radians())
        });
        let down = Stand::from(at);
        Stand { tool: part.inverse() * down.tool, axes: [0, 1].map(|k| stated.get(k).copied()), ..down }
    }

    fn block(&mut self, words: &[(char, f64)], line: &str) {
        if words.contains(&('G', 52.0)) {
            self.machine.lift = words.iter().find(|w| w.0 == 'Z').unwrap().1;
            return;
        }
        if words.contains(&('G', 4.0)) {
            let time: Vec<f64> = words.iter().filter(|w| "PXF".contains(w.0)).map(|w| w.1).collect();
            assert_eq!(time.len(), 1, "{line}");
            return self.machine.wait(time[0]);
        }
        // LinuxCNC: an analogue output with the next motion, or at once.
        if words.contains(&('M', 67.0)) || words.contains(&('M', 68.0)) {
            self.machine.motion.feeds.extend(words.iter().filter(|w| w.0 == 'Q').map(|w| w.1));
            return;
        }
        let (mut moves, mut centre) = (false, [None; 2]);
        for &(letter, value) in words {
            match letter {
                'G' if (0.0..=3.0).contains(&value) => self.motion = Some(value as u32),
                'F' => self.feed = Some(value),
                'I' | 'J' => centre["IJ".find(letter).unwrap()] = Some(value),
                'A' | 'B' | 'C' => {
                    self.turned["ABC".find(letter).unwrap()] = Some(value);
                    moves = true;
                }
                'X' | 'Y' | 'Z' => {
                    self.axes["XYZ".find(letter).unwrap()] = Some(value);
                    moves = true;
                }
                _ => {}
            }
        }
        if !moves {
            return;
        }
        let motion = self.motion.expect("a move without G0 or G1");
        assert!(motion >= 1 || !self.machine.burns(), "G0 with the arc on: {line}");
        let speed = if motion >= 1 { self.feed.expect("G1 without F") / 60.0 } else { f64::INFINITY };
        // Where axes turn the part, the torch keeps its speed on it, and it comes down where they stand.
        if self.tip_control == Some(false) {
            assert!(motion == 0 && !self.machine.burns(), "a move of the machine's axes: {line}");
            return;
        }
        if let [Some(x), Some(y), Some(z)] = self.axes {
            if self.tip_control.is_some() {
                assert!(motion == 1 && centre == [None; 2], "a rapid move with the part: {line}");
                let stand = self.stand([x, y, z]);
                let first = self.machine.at.is_none();
                return if first { self.machine.approach(stand) } else { self.machine.move_to(stand, speed) };
            }
            match (motion, centre) {
                (2 | 3, [Some(i), Some(j)]) => self.machine.turn_about([i, j], motion == 3, [x, y, z], speed),
                (0 | 1, [None, None]) => self.machine.move_to([x, y, z], speed),
                _ => panic!("{line}"),
            }
        }
    }
}

fn word(text: &str) -> (char, f64) {
    let letter = text.chars().next().unwrap();
    assert!(letter.is_ascii_uppercase(), "{text}");
    (letter, text[1..].parse().unwrap_or_else(|_| panic!("{text} is no word")))
}
