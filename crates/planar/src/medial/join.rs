//! Joins branches where only two meet, and merges junctions that coincide.

use super::{Branch, MedialAxis, Node};

impl MedialAxis {
    /// Merges junctions linked by a branch shorter than `least` (mm) into the one with the larger disc.
    pub(super) fn merged(mut self, least: f64) -> Self {
        let mut leader: Vec<usize> = (0..self.junctions.len()).collect();
        for branch in self.branches.iter().filter(|b| b.length() < least) {
            let (a, b) = (leading(&mut leader, branch.from), leading(&mut leader, branch.to));
            let (big, small) = if self.junctions[a].radius >= self.junctions[b].radius { (a, b) } else { (b, a) };
            leader[small] = big;
        }
        self.branches.retain(|b| b.length() >= least);
        for branch in &mut self.branches {
            branch.from = leading(&mut leader, branch.from);
            branch.to = leading(&mut leader, branch.to);
            let last = branch.nodes.len() - 1;
            branch.nodes[0] = self.junctions[branch.from];
            branch.nodes[last] = self.junctions[branch.to];
        }
        let kept = |j: usize| leader[j] == j;
        self.chained(kept)
    }

    /// Joins the two branches wherever only two meet at a junction.
    pub(super) fn joined(self) -> Self {
        self.chained(|_| true)
    }

    /// As [`Self::joined`], but keeps only the junctions that `keep` accepts.
    fn chained(self, keep: impl Fn(usize) -> bool) -> Self {
        let degrees = self.degrees();
        let mut at_junction: Vec<Vec<usize>> = vec![Vec::new(); self.junctions.len()];
        for (number, branch) in self.branches.iter().enumerate() {
            at_junction[branch.from].push(number);
            at_junction[branch.to].push(number);
        }
        let mut open: Vec<Option<Branch>> = self.branches.into_iter().map(Some).collect();
        let mut axis = Self::default();
        let mut number = vec![None; self.junctions.len()];
        let ends = (0..self.junctions.len()).filter(|&j| keep(j) && degrees[j] != 2);
        let passed = (0..self.junctions.len()).filter(|&j| degrees[j] == 2);
        for start in ends.chain(passed) {
            if degrees[start] != 2 {
                axis.junction(&mut number, start, self.junctions[start]);
            }
            for &first in &at_junction[start] {
                let Some(mut chain) = open[first].take().map(|b| b.starting_at(start)) else { continue };
                while degrees[chain.to] == 2 && chain.to != start {
                    let next = at_junction[chain.to].iter().find_map(|&b| open[b].take());
                    let Some(next) = next.map(|b| b.starting_at(chain.to)) else { break };
                    chain.nodes.extend(&next.nodes[1..]);
                    chain.to = next.to;
                }
                let [from, to] = [chain.from, chain.to].map(|j| axis.junction(&mut number, j, self.junctions[j]));
                axis.branches.push(Branch { from, to, ..chain });
            }
        }
        axis
    }

    /// The index in this axis of a junction of the old axis, added if it is new.
    fn junction(&mut self, number: &mut [Option<usize>], old: usize, node: Node) -> usize {
        *number[old].get_or_insert_with(|| {
            self.junctions.push(node);
            self.junctions.len() - 1
        })
    }
}

impl Branch {
    /// The same curve, oriented so that it begins at `junction`.
    fn starting_at(mut self, junction: usize) -> Self {
        if self.from != junction {
            self.nodes.reverse();
            (self.from, self.to) = (self.to, self.from);
        }
        self
    }
}

/// Union–find with path halving.
fn leading(leader: &mut [usize], mut junction: usize) -> usize {
    while leader[junction] != junction {
        leader[junction] = leader[leader[junction]];
        junction = leader[junction];
    }
    junction
}
