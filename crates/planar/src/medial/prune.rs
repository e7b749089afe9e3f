//! Removes branches that run into corners.

use super::{MedialAxis, Node, length};

/// The slope is taken over at least this fraction of the radius, so that nearly coincident nodes do not count.
const WINDOW: f64 = 1e-3;

impl MedialAxis {
    /// Without the curves that only run into corners.
    ///
    /// From every free end the axis is cut back as long as the radius grows by at least sin(`corner` / 2) per mm,
    /// as it does on the way out of a corner of interior angle `corner` (rad, usually [`CORNER`](super::CORNER)) or
    /// blunter. Then branches that are the only two at a junction become one, and so on until nothing changes.
    /// Of a square, a triangle or a disc, only one junction without branches remains.
    #[must_use]
    pub fn pruned(mut self, corner: f64) -> Self {
        let slope = (corner / 2.0).sin().max(1e-6);
        while self.cut_back(|nodes| rising_steps(nodes, slope)) {
            self = self.joined();
        }
        self
    }

    /// Without spurs: branches from a free end to a junction, such as those into the teeth of a gear, for which
    /// `is_spur` holds, given their nodes from the free end on. The shortest is removed first, and two branches left
    /// alone at a junction are joined before the next is examined; so the longest path through a tree of spurs remains.
    #[must_use]
    pub fn without_spurs(mut self, is_spur: impl Fn(&[Node]) -> bool) -> Self {
        loop {
            let degrees = self.degrees();
            let mut spurs: Vec<(f64, usize, [usize; 2])> = Vec::new();
            for (number, branch) in self.branches.iter().enumerate() {
                let (free, junction) = match (degrees[branch.from], degrees[branch.to]) {
                    (1, 3..) => (branch.from, branch.to),
                    (3.., 1) => (branch.to, branch.from),
                    _ => continue,
                };
                let mut nodes = branch.nodes.clone();
                if free == branch.to {
                    nodes.reverse();
                }
                if is_spur(&nodes) {
                    spurs.push((length(&nodes), number, [free, junction]));
                }
            }
            spurs.sort_by(|a, b| a.0.total_cmp(&b.0));
            if spurs.is_empty() {
                return self;
            }
            // At each junction only one spur is removed per round.
            let (mut touched, mut ends) = (vec![false; degrees.len()], vec![false; degrees.len()]);
            let mut gone = vec![false; self.branches.len()];
            for (_, number, [end, junction]) in spurs {
                if !std::mem::replace(&mut touched[junction], true) {
                    (gone[number], ends[end]) = (true, true);
                }
            }
            let mut gone = gone.into_iter();
            self.branches.retain(|_| gone.next() == Some(false));
            self.drop_junctions(&ends);
            self = self.joined();
        }
    }

    /// Removes the free branches along which the radius grows, from end to end, as fast as at an object angle below
    /// `min_angle`: noise with a sharp tip.
    pub(super) fn without_noise(mut self, min_angle: f64) -> Self {
        let slope = (min_angle / 2.0).cos();
        let all_or_nothing = |nodes: &[Node]| {
            let rise = nodes[nodes.len() - 1].radius - nodes[0].radius;
            if rise >= slope * length(nodes) { nodes.len() - 1 } else { 0 }
        };
        while self.cut_back(all_or_nothing) {
            self = self.joined();
        }
        self
    }

    /// One round: cuts every free end back by as many steps as `steps` returns for the nodes from that end on. Returns
    /// whether anything was cut.
    fn cut_back(&mut self, steps: impl Fn(&[Node]) -> usize) -> bool {
        let degrees = self.degrees();
        let mut gone = vec![false; self.junctions.len()];
        let mut cut = false;
        for branch in &mut self.branches {
            for end in [branch.from, branch.to] {
                if degrees[end] == 1 && branch.nodes.len() > 1 {
                    let count = steps(&branch.nodes);
                    branch.nodes.drain(..count);
                    self.junctions[end] = branch.nodes[0];
                    gone[end] = branch.nodes.len() == 1;
                    cut |= count > 0;
                }
                branch.nodes.reverse();
            }
        }
        self.branches.retain(|b| b.nodes.len() > 1);
        self.drop_junctions(&gone);
        cut
    }

    fn drop_junctions(&mut self, gone: &[bool]) {
        let mut number = vec![0; gone.len()];
        let mut kept = Vec::with_capacity(gone.len());
        for (junction, _) in gone.iter().enumerate().filter(|&(_, &gone)| !gone) {
            number[junction] = kept.len();
            kept.push(self.junctions[junction]);
        }
        self.junctions = kept;
        for branch in &mut self.branches {
            (branch.from, branch.to) = (number[branch.from], number[branch.to]);
        }
    }
}

/// The number of steps from the first node over which the radius grows by at least `slope` per mm.
fn rising_steps(nodes: &[Node], slope: f64) -> usize {
    let rises = |from: &usize| {
        let (first, mut last, mut along) = (nodes[*from], nodes[*from], 0.0);
        for &node in &nodes[from + 1..] {
            along += last.at.distance(node.at);
            last = node;
            if along > WINDOW * first.radius {
                break;
            }
        }
        last.radius - first.radius >= slope * along
    };
    (0..nodes.len() - 1).take_while(rises).count()
}
