//! A reader of URScript: the functions of one program, run as it calls them; poses in the part's frame.

use super::{Machine, Motion, Point, distance};
use std::collections::BTreeMap;

/// Runs a program; `arc` is the number of the output that switches the arc.
pub fn run(text: &str, arc: u32) -> Motion {
    assert!(text.is_ascii() && !text.contains(['\t', '\r']));
    let mut start = text.lines().find_map(super::branches::declaration).unwrap_or(0.0);
    let text = &super::branches::resolve(text, &mut start);
    let lines: Vec<&str> = text.lines().collect();
    let name = lines[0].strip_prefix("def ").and_then(|l| l.strip_suffix("():")).unwrap();
    assert!(name.bytes().all(|b| b.is_ascii_lowercase() || b.is_ascii_digit() || b == b'_'), "{name}");
    assert_eq!(lines.last(), Some(&"end"), "nothing comes behind the program");
    let (mut functions, mut body, mut open) = (BTreeMap::new(), Vec::new(), None);
    for line in lines[1..lines.len() - 1].iter().map(|l| l.trim()).filter(|l| !l.starts_with('#')) {
        match (line.strip_prefix("def ").and_then(|l| l.strip_suffix("():")), &mut open) {
            (Some(function), None) => open = Some((function.to_owned(), Vec::new())),
            (None, Some(_)) if line == "end" => {
                let (function, body) = open.take().unwrap();
                assert!(functions.insert(function, body).is_none());
            }
            (None, Some((_, body))) => body.push(line),
            (None, None) => body.push(line),
            (Some(_), Some(_)) => panic!("{line} in another function"),
        }
    }
    assert!(open.is_none());
    let mut reader = Reader { functions, arc, machine: Machine::default(), blend: 0.0, homes: 0, before: 0.0 };
    body.iter().for_each(|line| reader.statement(line));
    assert_eq!(reader.homes, 2);
    reader.machine.finish()
}

struct Reader<'a> {
    functions: BTreeMap<String, Vec<&'a str>>,
    arc: u32,
    machine: Machine,
    /// Blend at the end of the last move and the length of that move, mm.
    blend: f64,
    before: f64,
    homes: usize,
}

impl Reader<'_> {
    fn statement(&mut self, line: &str) {
        if line.starts_with("movej([") {
            assert!(!self.machine.burns());
            self.homes += 1;
        } else if let Some(to) = line.strip_prefix("movej(pose_trans(part_frame, p[") {
            self.machine.approach(pose(to));
        } else if line.starts_with("movel(") || line.starts_with("movec(") {
            self.motion(line);
        } else if let Some(rest) = line.strip_prefix("set_standard_digital_out(") {
            let (output, value) = rest.strip_suffix(')').unwrap().split_once(", ").unwrap();
            if output.parse::<u32>().unwrap() == self.arc {
                assert_eq!(self.blend, 0.0, "the arc is switched at a blended point");
                if value == "True" { self.machine.arc_on() } else { self.machine.arc_off() }
            }
        } else if let Some(seconds) = line.strip_prefix("sleep(") {
            assert_eq!(self.blend, 0.0, "a wait at a blended point");
            self.machine.wait(seconds.strip_suffix(')').unwrap().parse().unwrap());
        } else if let Some(feed) = line.strip_prefix("set_standard_analog_out(0, ") {
            self.machine.motion.feeds.push(feed.strip_suffix(')').unwrap().parse().unwrap());
        } else if let Some(function) = line.strip_suffix("()") {
            let body = self.functions.get(function).unwrap_or_else(|| panic!("{function} is not there yet")).clone();
            body.iter().for_each(|line| self.statement(line));
        } else {
            let known = ["set_tcp(p[", "global part_frame = p[", "waited = "];
            assert!(known.iter().any(|k| line.starts_with(k)), "{line}");
        }
    }

    fn motion(&mut self, line: &str) {
        let poses: Vec<Point> = line.split("pose_trans(part_frame, p[").skip(1).map(pose).collect();
        let value = |key: &str| -> Option<f64> {
            let rest = line.split(&format!(", {key}=")).nth(1)?;
            Some(rest.split([',', ')']).next()?.parse().unwrap())
        };
        let (speed, blend) = (value("v").unwrap() * 1000.0, value("r").unwrap_or(0.0) * 1000.0);
        assert!(speed > 0.0 && value("a").unwrap() > 0.0);
        let to = *poses.last().unwrap();
        let length = self.machine.at.map_or(f64::INFINITY, |at| distance(at, to));
        assert!(self.blend < 0.5 * length.min(self.before) || self.blend == 0.0, "blends overlap: {line}");
        match poses[..] {
            [to] if line.starts_with("movel") => self.machine.move_to(to, speed),
            [via, to] if line.starts_with("movec") => self.machine.arc_to(via, to, speed),
            _ => panic!("{line}"),
        }
        (self.blend, self.before) = (blend, length);
        assert!(blend == 0.0 || blend < 0.5 * length, "the blend is longer than half of the move: {line}");
    }
}

/// Metres to mm.
fn pose(text: &str) -> Point {
    let numbers: Vec<f64> = text.split(']').next().unwrap().split(',').map(|v| v.parse().unwrap()).collect();
    assert_eq!(numbers.len(), 6);
    [0, 1, 2].map(|i| numbers[i] * 1000.0)
}
