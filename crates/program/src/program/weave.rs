//! The section `[weave]` of a profile, and weaving as moves, for controllers that do not weave by themselves.

use super::{MIN_MOVE_MM, rounded};
use bead_plan::limit::{Broken, Limit, broken_row, limits};
use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};

/// How the torch swings from side to side along a pass: by the controller's own weaving, or by moves where it has none. The
/// bead of `[bead]` is then the woven one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Weave {
    /// Distance along the pass over which the torch swings once to both sides, mm.
    pub length: f64,
    /// How far it swings to each side, mm.
    pub amplitude: f64,
    /// How long it stays at each side, s; where the weave is written as moves, it moves on along the pass meanwhile. Default 0.
    #[serde(default)]
    pub dwell: f64,
    /// Number of the weaving file that has these values, on Yaskawa controllers; default 1.
    #[serde(default = "one")]
    pub file: u32,
    /// Other weaves for some layers; default none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub layers: Vec<LayerWeave>,
}

/// How the torch swings in some layers; what a row leaves out is as in the section.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LayerWeave {
    /// First layer, from 1.
    pub from: usize,
    /// Last layer.
    pub to: usize,
    /// Distance along the pass over which the torch swings once to both sides, mm.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub length: Option<f64>,
    /// How far it swings to each side, mm.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub amplitude: Option<f64>,
    /// How long it stays at each side, s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub dwell: Option<f64>,
    /// Number of the weaving file that has these values, on Yaskawa controllers.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<u32>,
}

fn one() -> u32 {
    1
}

impl Weave {
    /// The weave in the layer with this index: the first row that includes the layer applies.
    ///
    /// ```
    /// use bead_program::program::{LayerWeave, Weave};
    ///
    /// let wide = LayerWeave { from: 2, to: 3, amplitude: Some(4.0), ..LayerWeave::default() };
    /// let weave = Weave { length: 3.0, amplitude: 2.0, dwell: 0.0, file: 1, layers: vec![wide] };
    /// assert_eq!([0, 1].map(|layer| weave.at_layer(layer).amplitude), [2.0, 4.0]);
    /// ```
    pub fn at_layer(&self, index: usize) -> Self {
        let row = self.layers.iter().find(|row| (row.from..=row.to).contains(&(index + 1)));
        self.with(&row.cloned().unwrap_or_default())
    }

    fn with(&self, row: &LayerWeave) -> Self {
        Self {
            length: row.length.unwrap_or(self.length),
            amplitude: row.amplitude.unwrap_or(self.amplitude),
            dwell: row.dwell.unwrap_or(self.dwell),
            file: row.file.unwrap_or(self.file),
            layers: Vec::new(),
        }
    }

    /// Whether two layers differ in the weave, but not in the weaving file that holds it.
    pub(crate) fn shares_files(&self) -> bool {
        let all =
            || std::iter::once(LayerWeave::default()).chain(self.layers.iter().cloned()).map(|row| self.with(&row));
        all().any(|a| all().any(|b| a != b && a.file == b.file))
    }

    /// The first invalid row of layers.
    pub fn broken(&self) -> Option<Broken> {
        self.layers.iter().find_map(|row| broken_row("weave", row.from, row.to, &self.with(row).limits()))
    }

    /// The limits of its numbers.
    pub fn limits(&self) -> Vec<Limit> {
        limits! {
            "weave.length": self.length, 0.5, 50.0, "mm", "controllers weave neither finer nor coarser";
            "weave.amplitude": self.amplitude, 0.1, 25.0, "mm", "controllers weave neither finer nor coarser";
            "weave.dwell": self.dwell, 0.0, 5.0, "s", "standing still longer with the arc on burns through";
            "weave.file": self.file.into(), 1.0, 255.0, "(weaving file)", "controllers have files 1 to 255";
        }
    }
}

/// A move of a woven path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Swing {
    /// Where it ends, mm.
    pub(super) to: DVec3,
    /// Index of the move of the path along which it swings.
    pub(super) of: usize,
    /// Speed, mm/s.
    pub(super) speed: f64,
}

/// A path along which the torch swings in half waves of equal length from its start to its end, both on the path, in
/// the same time as the path: `speeds` (mm/s) apply up to the points of the path.
pub(super) fn swings(path: &[DVec3], speeds: &[f64], weave: &Weave) -> Vec<Swing> {
    // Distance and time up to each point.
    let mut along = vec![(0.0, 0.0)];
    for (i, pair) in path.windows(2).enumerate() {
        let (length, (way, time)) = (pair[0].distance(pair[1]), along[i]);
        along.push((way + length, time + length / speeds[i + 1].max(1e-9)));
    }
    let Some(&(end, whole)) = along.last().filter(|(end, _)| *end > 0.0) else { return Vec::new() };
    let halves = (2.0 * end / weave.length).round();
    let of = |way: f64| along.partition_point(|(at, _)| *at < way).clamp(1, along.len() - 1);
    let part = |way: f64, i: usize| (way - along[i - 1].0) / (along[i].0 - along[i - 1].0).max(1e-12);
    let place = |way: f64| path[of(way) - 1].lerp(path[of(way)], part(way, of(way)).clamp(0.0, 1.0));
    let time = |way: f64| along[of(way) - 1].1 + part(way, of(way)) * (along[of(way)].1 - along[of(way) - 1].1);
    // Sideways from the path's direction near a point, so that corners of the path are rounded.
    let side = |way: f64| {
        let about = weave.amplitude.min(end / 4.0);
        let ahead = place((way + about).min(end)) - place((way - about).max(0.0));
        ahead.truncate().try_normalize().unwrap_or(DVec2::X).perp()
    };
    let mut corners = Vec::new();
    let half = end / halves.max(1.0);
    for k in 0..if halves < 1.0 { 0 } else { halves as usize } {
        let middle = (k as f64 + 0.5) * half;
        let stays = (weave.dwell * speeds[of(middle)]).min(MOST_STAY * half);
        let swing = if k.is_multiple_of(2) { weave.amplitude } else { -weave.amplitude };
        let ends = [middle - stays / 2.0, middle + stays / 2.0];
        let ends = if stays > 2.0 * MIN_MOVE_MM { &ends[..] } else { &ends[..1] };
        corners.extend(ends.iter().map(|&way| (way, place(way) + (side(way) * swing).extend(0.0))));
    }
    corners.push((end, place(end)));
    let (mut from, mut since, mut out) = (path[0], 0.0, Vec::with_capacity(corners.len()));
    for (way, to) in corners {
        let (to, until) = (rounded(to), if way >= end { whole } else { time(way) });
        let speed = from.distance(to) / (until - since).max(1e-9);
        out.push(Swing { to, of: of((way - 1e-9).max(0.0)), speed });
        (from, since) = (to, until);
    }
    out
}

/// Greatest fraction of a half wave during which the torch dwells at a side.
const MOST_STAY: f64 = 0.8;

#[cfg(test)]
mod tests {
    use super::{Weave, swings};
    use glam::DVec3;
    use std::f64::consts::TAU;

    fn weave(dwell: f64) -> Weave {
        Weave { length: 4.0, amplitude: 1.5, dwell, file: 1, layers: Vec::new() }
    }

    fn time(from: DVec3, swings: &[super::Swing]) -> f64 {
        let mut at = from;
        let take = |swing: &super::Swing| {
            let time = at.distance(swing.to) / swing.speed;
            at = swing.to;
            time
        };
        swings.iter().map(take).sum()
    }

    /// On a line of 100 mm at 8 mm/s, 50 half waves: as long as the line takes, 1.5 mm to both sides, from end to end.
    #[test]
    fn a_line_is_woven_in_the_time_of_the_line() {
        let path = [DVec3::new(5.0, 7.0, 2.0), DVec3::new(85.0, 67.0, 2.0)];
        for dwell in [0.0, 0.1] {
            let swings = swings(&path, &[8.0, 8.0], &weave(dwell));
            assert_eq!(swings.len(), if dwell > 0.0 { 101 } else { 51 });
            assert_eq!(swings.last().unwrap().to, path[1]);
            assert!((time(path[0], &swings) - 12.5).abs() < 1e-3);
            let off = |to: DVec3| (to - path[0]).dot(DVec3::new(-0.6, 0.8, 0.0));
            let sides: Vec<f64> = swings[..swings.len() - 1].iter().map(|s| off(s.to)).collect();
            assert!(sides.iter().all(|side| (side.abs() - 1.5).abs() < 2e-3), "{sides:?}");
            assert!(sides.iter().sum::<f64>().abs() < 0.01);
            // A torch that dwells at a side moves on at the speed of the pass.
            let still = swings.windows(2).filter(|pair| off(pair[0].to) * off(pair[1].to) > 1.0);
            still.for_each(|pair| assert!((pair[1].speed - 8.0).abs() < 0.02, "{}", pair[1].speed));
        }
    }

    /// A faster stretch has as many swings per mm, which are run faster.
    #[test]
    fn the_pitch_is_the_same_at_any_speed() {
        let path: Vec<DVec3> = (0..=100).map(|k| DVec3::new(f64::from(k), 0.0, 1.0)).collect();
        let speeds: Vec<f64> = (0..=100).map(|k| if k > 50 { 12.0 } else { 6.0 }).collect();
        let swings = swings(&path, &speeds, &weave(0.0));
        assert!((time(path[0], &swings) - 50.0 / 6.0 - 50.0 / 12.0).abs() < 1e-3);
        let steps: Vec<f64> = swings.windows(2).map(|pair| pair[1].to.x - pair[0].to.x).collect();
        assert!(steps[..steps.len() - 1].iter().all(|step| (step - 2.0).abs() < 2e-3), "{steps:?}");
        assert!((swings[40].speed / swings[10].speed - 2.0).abs() < 1e-3);
    }

    /// Around a circle the swings stay near it, and a path that is shorter than a half wave stays as it is.
    #[test]
    fn circles_and_short_paths() {
        let circle: Vec<DVec3> = (0..=240)
            .map(|k| 20.0 * DVec3::new((TAU * f64::from(k) / 240.0).cos(), (TAU * f64::from(k) / 240.0).sin(), 0.0))
            .collect();
        let around = swings(&circle, &[8.0; 241], &weave(0.0));
        let off = around[..around.len() - 1].iter().map(|swing| (swing.to.length() - 20.0).abs());
        assert!(off.into_iter().all(|off| (off - 1.5).abs() < 0.05));
        let short = [DVec3::ZERO, DVec3::new(0.9, 0.0, 0.0)];
        let swings = swings(&short, &[8.0; 2], &weave(0.0));
        assert!(swings.len() == 1 && swings[0].to == short[1] && (swings[0].speed - 8.0).abs() < 1e-9);
    }
}
