//! Widths: a piece of bead lays the metal of its cell, the area closer to it than to any other piece. A single bead in
//! a wall is as wide as the wall.

use super::LoopSettings;
use super::line::Line;
use super::room::Room;
use glam::DVec2;
use planar::nearest::{NONE, nearest};

/// Points farther than this from every line, in stepovers, belong to no bead.
const FARTHEST: f32 = 0.9;
/// Widths are averaged over this many stepovers before and after.
const WINDOW: f64 = 0.8;

/// Gives every piece the width of its cell.
pub fn set_widths(lines: &mut [Line], room: &Room, settings: &LoopSettings) {
    let edge = settings.edge();
    let wanted: Vec<bool> = room.distance.iter().map(|&distance| f64::from(distance) > edge).collect();
    let pieces: Vec<(DVec2, DVec2)> = lines.iter().flat_map(Line::pieces).map(|(a, b, _)| (a, b)).collect();
    let near = nearest(&room.lattice, &pieces, &wanted);
    let (mut areas, cell) = (vec![0.0; pieces.len()], room.lattice.step * room.lattice.step);
    let farthest = FARTHEST * settings.stepover as f32;
    for (&piece, &distance) in near.segment.iter().zip(&near.distance) {
        if piece != NONE && distance < farthest {
            areas[piece as usize] += cell;
        }
    }
    let mut first = 0;
    for line in lines {
        let own = first..first + line.count();
        first = own.end;
        set_widths_of(line, &areas[own], room, settings);
    }
}

fn set_widths_of(line: &mut Line, areas: &[f64], room: &Room, settings: &LoopSettings) {
    let lengths: Vec<f64> = line.pieces().map(|(a, b, _)| a.distance(b)).collect();
    let mean = lengths.iter().sum::<f64>() / lengths.len().max(1) as f64;
    let reach = ((WINDOW * settings.stepover / mean).round() as usize).clamp(1, (lengths.len() / 3).max(1));
    let [areas, lengths] = [areas, &lengths].map(|values| windowed(values, reach, line.closed));
    for i in 0..line.count() {
        let (low, high) = settings.limits(line.thin[i]);
        let middle = line.points[i].midpoint(line.points[line.behind(i)]);
        let width = if line.thin[i] { 2.0 * room.at(middle) } else { settings.width_for(areas[i] / lengths[i]) };
        line.widths[i] = width.clamp(low, high);
    }
}

/// Sums over `reach` values before and after each value.
fn windowed(values: &[f64], reach: usize, closed: bool) -> Vec<f64> {
    let n = values.len();
    let sum = |i: usize| match closed {
        true => (0..=2 * reach).map(|k| values[(i + 2 * n + k - reach) % n]).sum(),
        false => values[i.saturating_sub(reach)..(i + reach + 1).min(n)].iter().sum(),
    };
    (0..n).map(sum).collect()
}
