//! The discs of chords, junctions and corners, and how they are linked.

use super::boundary::Boundary;
use super::disc::{Disc, Tent, TentDisc, at_junction, on_tent, through_samples, widest_angle};
use super::graph::{Graph, Links};
use super::mesh::{Cell, Mesh};
use glam::DVec2;
use std::f64::consts::PI;

impl<'a> Graph<'a> {
    pub(super) fn of(boundary: &'a Boundary, mesh: &'a Mesh) -> Self {
        let tents: Vec<Tent> = (0..mesh.chords.len()).map(|chord| mesh.tent(boundary, chord)).collect();
        let chords: Vec<TentDisc> = tents.iter().map(|tent| on_tent(boundary, tent)).collect();
        let discs: Vec<Disc> = chords.iter().map(|c| c.disc).collect();
        let (links, out) = (vec![Links::new(); discs.len()], vec![false; discs.len()]);
        let mut graph = Self { boundary, mesh, discs, tents, links, out };
        let mut junctions = Vec::new();
        for (number, cell) in mesh.cells.iter().enumerate() {
            let sides: Vec<usize> = cell.chords().map(|(chord, _)| chord).collect();
            match sides[..] {
                [] => {}
                [chord] => graph.add(corner_disc(mesh, cell), &[chord]),
                [a, b] => graph.link(a, b),
                _ => {
                    let exact = junction_disc(boundary, mesh, number, &chords);
                    let deepest = sides.iter().map(|&c| graph.discs[c]).max_by(|a, b| a.radius.total_cmp(&b.radius));
                    junctions.extend(exact.map(|disc| (number, disc.at)));
                    if let Some(disc) = exact.or(deepest) {
                        graph.add(disc, &sides);
                    }
                }
            }
        }
        for (cell, at) in junctions {
            graph.drop_overtaken(cell, at);
        }
        graph
    }

    /// A junction may lie outside its triangle, beyond a chord; the disc found on that chord is then on another branch
    /// and is dropped.
    fn drop_overtaken(&mut self, cell: usize, junction: DVec2) {
        let mesh = self.mesh;
        for (mut chord, mut corner) in mesh.cells[cell].chords() {
            let mut here = cell;
            while self.tents[chord].peak.is_none() && beyond(mesh, chord, corner, junction) {
                let [before, after] = self.links[chord][..] else { break };
                if before == after {
                    break;
                }
                self.remove(chord);
                self.link(before, after);
                let [a, b] = mesh.sides[chord];
                here = if a == here { b } else { a };
                let mut onward = mesh.cells[here].chords().filter(|&(c, _)| c != chord);
                let (Some(next), None) = (onward.next(), onward.next()) else { break };
                (chord, corner) = next;
            }
        }
    }
}

/// Whether `p` lies on the other side of the chord than the sample `corner`.
fn beyond(mesh: &Mesh, chord: usize, corner: usize, p: DVec2) -> bool {
    let [a, b] = mesh.chords[chord].map(|s| mesh.at(s));
    let side = |p: DVec2| (b - a).perp_dot(p - a);
    side(p) * side(mesh.at(corner)).signum() < -1e-12 * (b - a).length()
}

/// The corner of a triangle with one chord: a point of the axis with radius 0.
fn corner_disc(mesh: &Mesh, cell: &Cell) -> Disc {
    let tip = cell.chords.iter().position(Option::is_some).unwrap_or(0);
    let [at, p, q] = [0, 1, 2].map(|k| mesh.at(cell.corners[(tip + k) % 3]));
    Disc { at, radius: 0.0, angle: PI - (p - at).angle_to(q - at).abs() }
}

/// The disc at a junction: from the edges of the samples; on a jagged outline, from the edges that the chords' discs
/// touch.
fn junction_disc(boundary: &Boundary, mesh: &Mesh, number: usize, chords: &[TentDisc]) -> Option<Disc> {
    let (cell, guess) = (&mesh.cells[number], mesh.centres[number]?);
    let own = cell.corners.map(|c| mesh.samples[c].edge);
    let touched = cell.corners.map(|corner| {
        let edges = cell.chords().flat_map(|(chord, _)| {
            let feet = chords[chord].feet;
            (0..2).filter(move |&k| mesh.chords[chord][k] == corner).map(move |k| feet[k].edge)
        });
        let distance = |e: &usize| boundary.foot_on(*e, guess).distance;
        edges.min_by(|e, f| distance(e).total_cmp(&distance(f))).unwrap_or(mesh.samples[corner].edge)
    });
    let corners = cell.corners.map(|c| mesh.at(c));
    at_junction(boundary, guess, own)
        .or_else(|| at_junction(boundary, guess, touched))
        .map(|disc| Disc { angle: disc.angle.min(widest_angle(disc.at, corners)), ..disc })
        .or_else(|| through_samples(boundary, guess, corners))
}
