//! A reader of CNC G-code: modal words, one M code a block, G0 never with the arc on.

use super::{Machine, Motion};

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
}

impl Reader {
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
        if let [Some(x), Some(y), Some(z)] = self.axes {
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
