//! A plan for other programs: its beads piece by piece, as tables and as scenes.
//!
//! | file | for |
//! | --- | --- |
//! | `csv` | spreadsheets, pandas |
//! | `vtp` | ParaView, VTK, pyvista |

mod csv;
mod vtp;

use crate::layer::Layer;
use crate::pass::PassKind;
use crate::profile::Profile;
use crate::weld::{Torch, path};
use glam::DVec3;

/// A format for beads.
pub struct Format {
    /// The ending of its files.
    pub extension: &'static str,
    /// What it is for.
    pub purpose: &'static str,
    /// Writes pieces of beads.
    pub write: fn(&[Piece]) -> Vec<u8>,
}

/// All of them.
pub const FORMATS: [Format; 2] = [csv::FORMAT, vtp::FORMAT];

/// The format of files with this ending.
pub fn format(extension: &str) -> Option<&'static Format> {
    FORMATS.iter().find(|format| format.extension.eq_ignore_ascii_case(extension))
}

/// A straight piece of a bead, as it is welded: with overlap, hot start and lead-out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Piece {
    /// Layer, from 1.
    pub layer: usize,
    /// Pass in its layer, from 1.
    pub pass: usize,
    /// What the pass is for.
    pub kind: PassKind,
    /// Where it begins, mm.
    pub from: DVec3,
    /// Where it ends, mm.
    pub to: DVec3,
    /// Width of the bead, mm.
    pub width: f64,
    /// Thickness of the layer, mm.
    pub height: f64,
    /// Speed of the torch, mm/s; without acceleration.
    pub speed: f64,
    /// Speed at which the nominal wire feed lays the metal, mm/s.
    pub pace: f64,
    /// Wire feed, as a multiple of the nominal one.
    pub feed: f64,
    /// When it begins, s since the start of the build; waits and travels are counted.
    pub start: f64,
    /// How long it takes, s.
    pub seconds: f64,
}

/// The pieces of all beads of a plan, in the order in which they are welded.
pub fn pieces(layers: &[Layer], profile: &Profile) -> Vec<Piece> {
    let (mut torch, mut found, mut now) = (Torch::of(&profile.weld_settings()), Vec::new(), 0.0);
    for layer in layers.iter().filter(|layer| !layer.passes.is_empty()) {
        now += torch.begin_layer(layer.index).map_or(0.0, |pause| pause.moving + pause.seconds);
        for (number, pass) in (1..).zip(&layer.passes) {
            let Some(start) = pass.start() else { continue };
            now += torch.wait(pass.wait).map_or(0.0, |pause| pause.moving + pause.seconds);
            now += torch.approach(start).moving;
            let moves = path(pass, torch.ends());
            let welded = torch.weld(&moves);
            now += welded.before;
            let steady: f64 = moves.windows(2).map(|w| w[0].0.distance(w[1].0) / torch.speed_at(w[1].1)).sum();
            // Speeding up and slowing down is spread over the pass.
            let slower = if steady > 0.0 { welded.moving / steady } else { 1.0 };
            let (mut begin, mut way) = (now, 0.0);
            let widths = widths(pass);
            for pair in moves.windows(2) {
                let (from, (to, pace)) = (pair[0].0, pair[1]);
                let (speed, feed) = (torch.speed_at(pace), torch.feed_at(pace));
                let seconds = from.distance(to) / speed * slower;
                let width = widths.iter().find(|(end, _)| way < end - 1e-9).or(widths.last()).map_or(0.0, |w| w.1);
                way += from.distance(to);
                let (layer, height, kind) = (layer.index + 1, layer.height, pass.kind);
                found.push(Piece {
                    layer,
                    pass: number,
                    kind,
                    from,
                    to,
                    width,
                    height,
                    speed,
                    pace,
                    feed,
                    start: begin,
                    seconds,
                });
                begin += seconds;
            }
            now += welded.moving + welded.crater + welded.after + torch.retract().moving;
        }
    }
    found
}

/// How far along a pass each width reaches, mm, and the width, mm; the overlap of a closed pass begins anew.
fn widths(pass: &crate::pass::Pass) -> Vec<(f64, f64)> {
    let mut way = 0.0;
    let mut once: Vec<(f64, f64)> = Vec::new();
    for segment in pass.segments() {
        way += segment.length();
        once.push((way, segment.width));
    }
    let again: Vec<(f64, f64)> = once.iter().map(|(end, width)| (end + way, *width)).collect();
    once.extend(again);
    once
}
