//! Programs that can begin at any pass: a variable holds the number of the first pass to run, and earlier passes are
//! skipped. The first pass that runs comes from anywhere, and resets the variable to 0.

/// Passes of a layer with numbers of their own; later ones share the last.
const PASSES: usize = 9_999;

/// The number of a pass (from 1) of the layer with this index: the layer times 10000 plus the pass.
pub(super) fn number(layer: usize, pass: usize) -> usize {
    (layer + 1) * (PASSES + 1) + pass.min(PASSES)
}

/// The comment about this variable at the head of a program.
pub(in crate::dialect) fn comment(variable: &str) -> String {
    format!("{variable}: 0, or layer * 10000 + pass, 10001 or more")
}
