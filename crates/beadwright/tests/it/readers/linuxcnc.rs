//! Adds up what LinuxCNC's interpreter (`rs274`) calls when it runs a program: its canonical machining functions.

use super::{Point, distance};
use std::collections::BTreeSet;

/// Totals of a run.
#[derive(Debug, Default)]
pub struct Totals {
    /// Heights at which beads are laid, µm.
    pub heights: BTreeSet<i64>,
    pub arc_starts: usize,
    /// mm
    pub weld_length: f64,
    /// mm
    pub travel: f64,
    /// Time of the moves in feed, s.
    pub arc_time: f64,
    /// s
    pub waits: f64,
}

/// Lines such as `12 N..... STRAIGHT_FEED(10.0000, 0.0000, 5.0000, 0.0000, 0.0000, 0.0000)`.
pub fn run(canon: &str) -> Totals {
    let (mut out, mut at, mut feed, mut ended) = (Totals::default(), None::<Point>, 0.0, false);
    // A spindle without a speed does not turn; gas and wire are outputs 0 and 1.
    let (mut speed, mut forward, mut outputs, mut offset) = (0.0, false, BTreeSet::new(), 0.0);
    // The first two moves, up and across, come from where the machine happens to stand.
    let mut known = 0;
    for line in canon.lines() {
        let Some((call, rest)) = line.split_once('(') else { continue };
        let call = call.split_whitespace().last().unwrap_or_default();
        let values: Vec<f64> =
            rest.trim_end_matches(')').split([',', ' ']).filter_map(|text| text.trim().parse().ok()).collect();
        let moved = match (call, &values[..]) {
            ("STRAIGHT_TRAVERSE" | "STRAIGHT_FEED", &[x, y, z, ..]) => {
                Some(([x, y, z], at.map_or(0.0, |from| distance(from, [x, y, z]))))
            }
            // End, centre, turns (below 0: clockwise), height of the end.
            ("ARC_FEED", &[x, y, cx, cy, turns, z, ..]) => {
                let from = at.unwrap();
                let angle = |p: Point| (p[1] - cy).atan2(p[0] - cx);
                let sweep = super::angle_between(angle(from), angle([x, y, z]));
                assert!(turns.abs() == 1.0 && sweep * turns > 0.0, "{line}");
                Some(([x, y, z], sweep.abs() * (from[0] - cx).hypot(from[1] - cy)))
            }
            _ => None,
        };
        if let Some((to, length)) = moved {
            at = Some(to);
            // All outputs are on along a bead, and none anywhere else.
            let lays = call != "STRAIGHT_TRAVERSE";
            let on = (forward && speed > 0.0, outputs.contains(&0), outputs.contains(&1));
            assert_eq!(on, (lays, lays, lays), "arc, gas, wire: {line}");
            if lays {
                out.heights.insert(((to[2] + offset) * 1e3).round() as i64);
                out.weld_length += length;
                out.arc_time += length / (feed / 60.0);
            } else if known >= 2 {
                out.travel += length;
            }
            known += 1;
        }
        match (call, &values[..]) {
            ("SET_FEED_RATE", &[rate]) => feed = rate,
            ("DWELL", &[seconds]) => out.waits += seconds,
            ("PROGRAM_END", _) => ended = true,
            ("SET_SPINDLE_SPEED", &[_, to]) => speed = to,
            ("SET_AUX_OUTPUT_BIT", &[output]) => drop(outputs.insert(output as u32)),
            ("CLEAR_AUX_OUTPUT_BIT", &[output]) => drop(outputs.remove(&(output as u32))),
            ("SET_G92_OFFSET", &[_, _, z, ..]) => offset = z,
            ("START_SPINDLE_CLOCKWISE", _) => {
                forward = true;
                out.arc_starts += 1;
            }
            ("STOP_SPINDLE_TURNING", _) => forward = false,
            _ => {}
        }
    }
    assert!(ended && outputs.is_empty() && !forward, "the program ends with outputs on: {outputs:?}");
    out
}
