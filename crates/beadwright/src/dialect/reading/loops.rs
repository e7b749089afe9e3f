//! Loops with constant bounds, run as often as a controller runs them.

use super::ReadError;
use super::words::{compact, number};

/// What a line is to the loop around it.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(in crate::dialect) enum Mark {
    Begin,
    End,
}

/// Runs `count` lines one after another, those of a loop as often as it turns. `mark` tells where loops begin and end;
/// `step` runs a line and, where a loop begins, returns how often that turns.
pub(in crate::dialect) fn unrolled(
    count: usize,
    mark: impl Fn(usize) -> Option<Mark>,
    mut step: impl FnMut(usize) -> Result<u64, ReadError>,
) -> Result<(), ReadError> {
    // First line of the body, and turns that are left.
    let mut open: Vec<(usize, u64)> = Vec::new();
    let mut at = 0;
    while at < count {
        let turns = step(at)?;
        at = match mark(at) {
            Some(Mark::Begin) if turns == 0 => behind(at, count, &mark),
            Some(Mark::Begin) => {
                open.push((at + 1, turns));
                at + 1
            }
            Some(Mark::End) => match open.pop() {
                Some((body, left)) if left > 1 => {
                    open.push((body, left - 1));
                    body
                }
                _ => at + 1,
            },
            None => at + 1,
        };
    }
    Ok(())
}

/// The line behind the end of the loop that begins at a line.
fn behind(begin: usize, count: usize, mark: impl Fn(usize) -> Option<Mark>) -> usize {
    let mut depth = 0_usize;
    for at in begin..count {
        match mark(at) {
            Some(Mark::Begin) => depth += 1,
            Some(Mark::End) if depth <= 1 => return at + 1,
            Some(Mark::End) => depth -= 1,
            None => {}
        }
    }
    count
}

/// Which way a loop counts where it tells no step.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(in crate::dialect) enum Counting {
    /// Always up.
    Up,
    /// Towards the end.
    Towards,
}

/// How often `FOR i=1 TO 10 STEP 2`, `FOR i FROM 1 TO 10 DO` or `FOR R[1]=5 DOWNTO 1` turns; `before` is the sign or
/// word before the first value. `None` where a bound is no plain number.
pub(in crate::dialect) fn turns(text: &str, before: &str, counting: Counting) -> Option<u64> {
    let flat = compact(text);
    let (_, bounds) = flat.strip_suffix("DO").unwrap_or(&flat).split_once(before)?;
    let (from, rest) = bounds.split_once("DOWNTO").or_else(|| bounds.split_once("TO"))?;
    let (to, step) = rest.split_once("STEP").map_or((rest, None), |(to, step)| (to, Some(step)));
    let (from, to) = (number(from)?, number(to)?);
    let down = bounds.contains("DOWNTO") || (counting == Counting::Towards && to < from);
    let step = match step {
        Some(step) => number(step)?,
        None => {
            if down {
                -1.0
            } else {
                1.0
            }
        }
    };
    stepped(from, to, step)
}

/// How many values from one bound to the other.
pub(in crate::dialect) fn stepped(from: f64, to: f64, step: f64) -> Option<u64> {
    let steps = (to - from) / step;
    // The cast saturates; the limit on turns is far below.
    steps.is_finite().then(|| if steps < -1e-9 { 0 } else { (steps + 1e-9) as u64 + 1 })
}
