//! The voxels of one level that hold metal, and their nodes, numbered slab by slab along the longest side.
//!
//! Work is shared out in chunks of slabs. A chunk owns its nodes and computes all voxels that touch them, so those of one
//! slab are computed twice; in return, threads never write to the same place and sums have one order.

use crate::grid::{index, position};
use rayon::prelude::*;
use std::ops::Range;

/// No node.
const NONE: u32 = u32::MAX;
/// About as many chunks for a level.
const CHUNKS: usize = 12;
/// A chunk has at least this many slabs.
const LEAST_SLABS: usize = 3;

/// Consecutive slabs: their nodes, and all voxels that touch these.
#[derive(Debug, Clone)]
pub(crate) struct Chunk {
    pub(crate) nodes: Range<usize>,
    pub(crate) slabs: Range<usize>,
}

/// The voxels with metal of one level.
#[derive(Debug, Clone)]
pub(crate) struct Mesh {
    pub(crate) counts: [usize; 3],
    /// Directions from the one that counts fastest to that of the slabs.
    axes: [usize; 3],
    /// Number of each node of the lattice, or `NONE`.
    numbers: Vec<u32>,
    /// Position of each node in the lattice.
    pub(crate) nodes: Vec<[u16; 3]>,
    /// Index in the lattice of each voxel with metal.
    pub(crate) voxels: Vec<usize>,
    /// The eight nodes of each voxel.
    pub(crate) corners: Vec<[u32; 8]>,
    /// Where the voxels of each slab begin.
    pub(crate) voxel_starts: Vec<usize>,
    /// Where the nodes of each slab begin.
    pub(crate) node_starts: Vec<usize>,
    pub(crate) chunks: Vec<Chunk>,
}

/// Calls `visit` for every position of a lattice, in the order of the axes.
fn walk(counts: [usize; 3], axes: [usize; 3], slab: usize, mut visit: impl FnMut([usize; 3])) {
    let mut at = [0; 3];
    at[axes[2]] = slab;
    for middle in 0..counts[axes[1]] {
        at[axes[1]] = middle;
        for fast in 0..counts[axes[0]] {
            at[axes[0]] = fast;
            visit(at);
        }
    }
}

impl Mesh {
    /// The voxels of a lattice for which `alive` holds, with slabs across its longest side.
    pub(crate) fn new(counts: [usize; 3], alive: impl Fn(usize) -> bool) -> Self {
        let mut axes = [0, 1, 2];
        axes.sort_by_key(|&axis| counts[axis]);
        Self::along(counts, axes, alive)
    }

    /// The same with the given order of directions.
    pub(crate) fn along(counts: [usize; 3], axes: [usize; 3], alive: impl Fn(usize) -> bool) -> Self {
        let node_counts = counts.map(|n| n + 1);
        let slabs = counts[axes[2]];
        let mut numbers = vec![NONE; node_counts.iter().product()];
        let (mut voxels, mut voxel_starts) = (Vec::new(), vec![0]);
        let lattice_corners = |at: [usize; 3]| -> [usize; 8] {
            std::array::from_fn(|c| index(node_counts, std::array::from_fn(|d| at[d] + (c >> d & 1))))
        };
        for slab in 0..slabs {
            walk(counts, axes, slab, |at| {
                let voxel = index(counts, at);
                if alive(voxel) {
                    voxels.push(voxel);
                    lattice_corners(at).iter().for_each(|&node| numbers[node] = 0);
                }
            });
            voxel_starts.push(voxels.len());
        }
        let (mut nodes, mut node_starts) = (Vec::new(), vec![0]);
        for slab in 0..=slabs {
            walk(node_counts, axes, slab, |at| {
                let number = &mut numbers[index(node_counts, at)];
                if *number != NONE {
                    *number = nodes.len() as u32;
                    nodes.push(at.map(|a| a as u16));
                }
            });
            node_starts.push(nodes.len());
        }
        let corners_of = |&voxel: &usize| lattice_corners(position(counts, voxel)).map(|node| numbers[node]);
        let corners = voxels.iter().map(corners_of).collect();
        let chunks = chunks(&node_starts);
        Self { counts, axes, numbers, nodes, voxels, corners, voxel_starts, node_starts, chunks }
    }

    /// The lattice of voxels twice as large, where one is alive if any of its eight parts is.
    pub(crate) fn coarser(&self) -> Self {
        let counts = self.counts.map(|n| n.div_ceil(2));
        let mut alive = vec![false; counts.iter().product()];
        for &voxel in &self.voxels {
            alive[index(counts, position(self.counts, voxel).map(|a| a / 2))] = true;
        }
        Self::along(counts, self.axes, |voxel| alive[voxel])
    }

    /// The number of the node at an index of the lattice.
    pub(crate) fn number(&self, node: usize) -> Option<usize> {
        self.numbers.get(node).filter(|&&number| number != NONE).map(|&number| number as usize)
    }

    /// Index in the lattice of a node.
    pub(crate) fn lattice_node(&self, number: usize) -> usize {
        index(self.counts.map(|n| n + 1), self.nodes[number].map(usize::from))
    }

    /// The place in `voxels` of each voxel of the lattice, or `u32::MAX`.
    pub(crate) fn order(&self) -> Vec<u32> {
        let mut order = vec![NONE; self.counts.iter().product()];
        self.voxels.iter().enumerate().for_each(|(i, &voxel)| order[voxel] = i as u32);
        order
    }

    /// The first column of each row of the stiffness, three rows per node.
    pub(crate) fn first_columns(&self) -> Vec<usize> {
        let mut firsts: Vec<u32> = (0..self.nodes.len() as u32).collect();
        for corners in &self.corners {
            let first = corners.iter().copied().min().unwrap_or_default();
            corners.iter().for_each(|&c| firsts[c as usize] = firsts[c as usize].min(first));
        }
        firsts.iter().flat_map(|&first| [3 * first as usize; 3]).collect()
    }

    /// The eight nodes of the coarser mesh between which each node lies; those between which it lies in fewer directions
    /// occur several times, so that each has the weight 1/8.
    pub(crate) fn parents(&self, coarser: &Self) -> Vec<[u32; 8]> {
        let node_counts = coarser.counts.map(|n| n + 1);
        let parents = |at: &[u16; 3]| {
            std::array::from_fn(|c| {
                let side = |d: usize| (usize::from(at[d]) + (c >> d & 1)) / 2;
                coarser.numbers[index(node_counts, [side(0), side(1), side(2)])]
            })
        };
        self.nodes.par_iter().map(parents).collect()
    }

    /// Calls `work` for all chunks, each with its own part of `values`, which has one entry per node.
    pub(crate) fn each_chunk<V: Send>(&self, values: &mut [V], work: impl Fn(&Chunk, &mut [V]) + Sync) {
        let mut parts = Vec::with_capacity(self.chunks.len());
        let mut rest = values;
        for chunk in &self.chunks {
            let (part, others) = rest.split_at_mut(chunk.nodes.len().min(rest.len()));
            parts.push((chunk, part));
            rest = others;
        }
        parts.into_par_iter().for_each(|(chunk, part)| work(chunk, part));
    }
}

/// Slabs in chunks with about as many nodes.
fn chunks(node_starts: &[usize]) -> Vec<Chunk> {
    let (slabs, nodes) = (node_starts.len() - 1, node_starts[node_starts.len() - 1]);
    let wanted = nodes.div_ceil(CHUNKS);
    let mut chunks = Vec::new();
    let mut first = 0;
    for end in 1..=slabs {
        let range = node_starts[first]..node_starts[end];
        if end == slabs || (range.len() >= wanted && end - first >= LEAST_SLABS) {
            chunks.push(Chunk { nodes: range, slabs: first..end });
            first = end;
        }
    }
    chunks
}
