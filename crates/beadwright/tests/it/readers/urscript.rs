//! A reader of URScript: the functions of one program, run as it calls them; poses in the part's frame.

use super::{Carried, Machine, Motion, Stand, distance};
use glam::{DQuat, DVec3};
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
            // A function of one line that lifts the frame.
            (None, None) if line.starts_with("def lifted(height):") => open = Some(("lifted".to_owned(), Vec::new())),
            (None, None) => body.push(line),
            (Some(_), Some(_)) => panic!("{line} in another function"),
        }
    }
    assert!(open.is_none());
    let mut reader = Reader {
        functions,
        arc,
        machine: Machine::default(),
        blend: 0.0,
        homes: 0,
        before: 0.0,
        heights: Vec::new(),
        turns: 0,
        at_home: false,
        axes: [None; 2],
    };
    body.iter().for_each(|line| reader.statement(line));
    // Home at both ends and before each turn of the part; the last turn back follows the last of these.
    assert_eq!(reader.homes, 2 + reader.turns.saturating_sub(1));
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
    /// Heights added to layers, mm.
    heights: Vec<f64>,
    /// How often the part was turned, whether the torch is at home, and the angles, °.
    turns: usize,
    at_home: bool,
    axes: [Option<f64>; 2],
}

impl Reader<'_> {
    fn statement(&mut self, line: &str) {
        if line.starts_with("movej([") {
            assert!(!self.machine.burns());
            self.homes += 1;
            self.at_home = true;
        } else if let Some(to) = line.strip_prefix("movej(pose_trans(part_frame, p[") {
            self.at_home = false;
            self.machine.approach(Stand { axes: self.axes, ..pose(to) });
        } else if let Some(angles) = line.strip_prefix("turn_part(") {
            assert!(self.at_home, "the part turns under the torch");
            let mut angles = angles.strip_suffix(')').unwrap().split(", ").map(|angle| angle.parse().unwrap());
            self.axes = [angles.next(), angles.next()];
            self.turns += 1;
        } else if line.starts_with("movel(") || line.starts_with("movec(") {
            self.motion(line);
        } else if let Some(rest) = line.strip_prefix("set_standard_digital_out(") {
            let (output, value) = rest.strip_suffix(')').unwrap().split_once(", ").unwrap();
            if output.parse::<u32>().unwrap() == self.arc {
                assert_eq!(self.blend, 0.0, "the arc is switched at a blended point");
                match value {
                    "True" => self.machine.arc_on(),
                    // At its end the program makes sure once more.
                    _ if self.machine.burns() => self.machine.arc_off(),
                    _ => {}
                }
            }
        } else if let Some(seconds) = line.strip_prefix("sleep(") {
            assert_eq!(self.blend, 0.0, "a wait at a blended point");
            self.machine.wait(seconds.strip_suffix(')').unwrap().parse().unwrap());
        } else if let Some(feed) = line.strip_prefix("set_standard_analog_out(0, ") {
            self.machine.motion.feeds.push(feed.strip_suffix(')').unwrap().parse().unwrap());
        } else if let Some(heights) = line.strip_prefix("global layer_dz = [") {
            self.heights = heights.trim_end_matches(']').split(", ").map(|v| v.parse().unwrap()).collect();
        } else if let Some(layer) = line.strip_prefix("global part_frame = lifted(layer_dz[") {
            assert!(self.functions["lifted"][0].contains("p[0.0,0.0,height/1000.0,0.0,0.0,0.0]"));
            self.machine.lift = self.heights[layer.trim_end_matches("])").parse::<usize>().unwrap()];
        } else if let Some(function) = line.strip_suffix("()") {
            let body = self.functions.get(function).unwrap_or_else(|| panic!("{function} is not there yet")).clone();
            body.iter().for_each(|line| self.statement(line));
        } else {
            let known = ["set_tcp(p[", "global part_frame = p[", "global place = p[", "waited = ", "tried = "];
            assert!(known.iter().any(|k| line.starts_with(k)), "{line}");
        }
    }

    fn motion(&mut self, line: &str) {
        let poses = line.split("pose_trans(part_frame, p[").skip(1);
        let poses: Vec<Stand> = poses.map(|text| Stand { axes: self.axes, ..pose(text) }).collect();
        self.at_home = false;
        let value = |key: &str| -> Option<f64> {
            let rest = line.split(&format!(", {key}=")).nth(1)?;
            Some(rest.split([',', ')']).next()?.parse().unwrap())
        };
        let (speed, blend) = (value("v").unwrap() * 1000.0, value("r").unwrap_or(0.0) * 1000.0);
        assert!(speed > 0.0 && value("a").unwrap() > 0.0);
        let to = *poses.last().unwrap();
        let length = self.machine.at.map_or(f64::INFINITY, |at| distance(at, to.at));
        // The orientation goes to that of the end, or keeps to the tangent.
        self.machine.carried = match value("mode") {
            Some(1.0) => Carried::ByTheTangent,
            mode => {
                assert_eq!(mode.unwrap_or(0.0), 0.0, "{line}");
                Carried::InTheFrame
            }
        };
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
fn pose(text: &str) -> Stand {
    let numbers: Vec<f64> = text.split(']').next().unwrap().split(',').map(|v| v.parse().unwrap()).collect();
    assert_eq!(numbers.len(), 6);
    let tool = DQuat::from_scaled_axis(DVec3::new(numbers[3], numbers[4], numbers[5]));
    Stand { at: [0, 1, 2].map(|i| numbers[i] * 1000.0), tool, axes: [None; 2] }
}
