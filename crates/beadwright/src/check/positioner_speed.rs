//! Positioners that would have to turn too fast.

use super::{Check, Finding, Subject, turned};

pub(super) const CHECK: Check = Check {
    name: "positioner-speed",
    what: "welding moves along which an axis of program.positioner would have to turn faster than its speed",
    why: "the controller then slows the torch down, and the bead becomes wider and hotter there",
    example: "layer 3, pass 1, x 12.0 y 4.0 z 30.00 mm: axis 2 would turn at 64.1°/s, and its speed is 30°/s. 4 other moves are too \
              fast, too.",
    remedy: "weld more slowly there, turn the part between passes only (program.positioner.turning = \"index\"), or move the seam of \
             the chart away from the place",
    find,
};

/// Tolerance for rounding.
const MORE: f64 = 1.001;

fn find(subject: &Subject<'_>) -> Vec<Finding> {
    let Some(positioner) = &subject.settings.program.positioner else { return Vec::new() };
    let moves = turned::moves(subject);
    let fast = moves.iter().filter_map(|turned| {
        let axes = positioner.axes.iter().zip(turned.rates).enumerate();
        let (axis, ratio) = axes.map(|(k, (axis, rate))| (k, rate / axis.speed)).max_by(|a, b| a.1.total_cmp(&b.1))?;
        (ratio > MORE).then_some((ratio, axis, turned))
    });
    let fast: Vec<_> = fast.collect();
    let Some(&(ratio, axis, turned)) = fast.iter().max_by(|a, b| a.0.total_cmp(&b.0)) else { return Vec::new() };
    let (rate, speed) = (turned.rates[axis], positioner.axes[axis].speed);
    let more = match fast.len() - 1 {
        0 => String::new(),
        1 => " Another move is too fast, too.".to_owned(),
        others => format!(" {others} other moves are too fast, too."),
    };
    let text = format!("axis {} would turn at {rate:.1}°/s, and its speed is {speed}°/s.{more}", axis + 1);
    vec![CHECK.of_pass(turned.layer, turned.pass, Some(turned.place), text).sized(ratio)]
}
