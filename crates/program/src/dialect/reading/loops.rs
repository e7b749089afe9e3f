//! Loops with constant bounds, run as often as a controller runs them.

use super::ReadError;
use super::words::{compact, number};

/// The role of a line in a block: a loop, or a branch.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(in crate::dialect) enum Mark {
    Begin,
    Else,
    End,
}

/// What comes after a line.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(in crate::dialect) enum Next {
    /// The next line. At the beginning of a block: it cannot be evaluated, and all its lines run once.
    On,
    /// The lines of the block that begins here, this many times; a branch runs once or not at all.
    Turns(u64),
    /// The line with this index, further down.
    To(usize),
}

impl Next {
    /// Runs a branch if it is taken; `None` if that is unknown.
    pub(in crate::dialect) fn taken(known: Option<bool>) -> Self {
        known.map_or(Self::On, |taken| Self::Turns(taken.into()))
    }
}

/// A block that has begun.
struct Open {
    /// Its first line.
    body: usize,
    /// Remaining iterations.
    left: u64,
    /// Whether the block is known to run.
    known: bool,
}

/// Runs `count` lines one after another, those of a block as often as it iterates. `mark` says where blocks begin and
/// end; `step` runs a line and says what comes after it.
pub(in crate::dialect) fn unrolled(
    count: usize,
    mark: impl Fn(usize) -> Option<Mark>,
    mut step: impl FnMut(usize) -> Result<Next, ReadError>,
) -> Result<(), ReadError> {
    let mut open: Vec<Open> = Vec::new();
    let mut at = 0;
    while at < count {
        let next = step(at)?;
        at = match (mark(at), next) {
            (_, Next::To(line)) => {
                // Blocks that end in between are left.
                let left = (at..line).filter(|&i| mark(i) == Some(Mark::End)).count();
                open.truncate(open.len().saturating_sub(left));
                line.max(at + 1)
            }
            (Some(Mark::Begin), Next::Turns(0)) => {
                let behind = behind(at + 1, count, &mark);
                if behind > at + 1 && mark(behind - 1) == Some(Mark::Else) {
                    open.push(Open { body: behind, left: 1, known: true });
                }
                behind
            }
            (Some(Mark::Begin), next) => {
                let left = if let Next::Turns(turns) = next { turns } else { 1 };
                open.push(Open { body: at + 1, left, known: next != Next::On });
                at + 1
            }
            (Some(Mark::Else), _) if open.last().is_some_and(|block| block.known) => {
                open.pop();
                let mut end = behind(at + 1, count, &mark);
                while end < count && mark(end - 1) == Some(Mark::Else) {
                    end = behind(end, count, &mark);
                }
                end
            }
            (Some(Mark::End), _) => match open.pop() {
                Some(Open { body, left, known }) if left > 1 => {
                    open.push(Open { body, left: left - 1, known });
                    body
                }
                _ => at + 1,
            },
            _ => at + 1,
        };
    }
    Ok(())
}

/// The line after the `Else` or the end of the block whose first line this is.
pub(in crate::dialect) fn behind(first: usize, count: usize, mark: impl Fn(usize) -> Option<Mark>) -> usize {
    let mut depth = 0_usize;
    for at in first..count {
        match mark(at) {
            Some(Mark::Begin) => depth += 1,
            Some(Mark::Else | Mark::End) if depth == 0 => return at + 1,
            Some(Mark::End) => depth -= 1,
            Some(Mark::Else) | None => {}
        }
    }
    count
}

/// Whether a comparison of plain numbers and of variables with known values holds, such as `a <= 70003`; `None` for any
/// other condition.
pub(in crate::dialect) fn holds(condition: &str, value: impl Fn(&str) -> Option<f64>) -> Option<bool> {
    const SIGNS: [&str; 8] = ["<=", ">=", "<>", "!=", "==", "=", "<", ">"];
    let inside = condition.trim().strip_prefix('(').and_then(|rest| rest.strip_suffix(')'));
    let condition = inside.filter(|inside| !inside.contains(['(', ')'])).unwrap_or(condition);
    let (at, sign) = SIGNS.iter().filter_map(|sign| Some((condition.find(sign)?, *sign))).min_by_key(|(at, _)| *at)?;
    let operand = |text: &str| number(text).or_else(|| value(text.trim()));
    let (a, b) = (operand(&condition[..at])?, operand(&condition[at + sign.len()..])?);
    Some(match sign {
        "<=" => a <= b,
        ">=" => a >= b,
        "<>" | "!=" => a != b,
        "<" => a < b,
        ">" => a > b,
        _ => a == b,
    })
}

/// The direction in which a loop counts if it gives no step.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(in crate::dialect) enum Counting {
    /// Always up.
    Up,
    /// Towards the end.
    Towards,
}

/// Number of iterations of `FOR i=1 TO 10 STEP 2`, `FOR i FROM 1 TO 10 DO` or `FOR R[1]=5 DOWNTO 1`; `before` is the
/// sign or word before the first value. `None` if a bound is not a plain number.
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

/// Number of values from one bound to the other; `None` if that is not finite.
pub(in crate::dialect) fn stepped(from: f64, to: f64, step: f64) -> Option<u64> {
    let steps = (to - from) / step;
    // The cast saturates; the limit on iterations is far below that.
    steps.is_finite().then(|| if steps < -1e-9 { 0 } else { (steps + 1e-9) as u64 + 1 })
}
