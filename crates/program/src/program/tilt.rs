//! The lean of the torch: with the wall that it builds (work angle), and forward or back along its path (travel angle).
//!
//! A wall leans where its outline is offset from the outline of the layer below. The torch then leans the same way, so that
//! the wire points down the wall and not past it. Steps, ledges and anything away from an outline leave it upright.

use super::ProgramSettings;
use bead_plan::layer::Layer;
use glam::{DVec2, DVec3};
use planar::Polygon;
use rstar::RTree;
use rstar::primitives::Line;

/// A pass within this many bead widths of an outline belongs to the wall there.
const REACH: f64 = 1.5;
/// Outlines farther apart than this many layer heights are a step, not a wall (about 63°).
const STEP: f64 = 2.0;
/// Greatest lean of the torch from upright: sine of 45°.
const MOST: f64 = std::f64::consts::FRAC_1_SQRT_2;
/// Leans are multiples of this (0.03°), so that a wall's small faults do not move the torch.
const GRID: f64 = 0.0005;
/// Leans that differ by at most this (2°) may be in one fitted piece.
pub(super) const ALIKE: f64 = 0.035;

type Outlines = RTree<Line<[f64; 2]>>;

/// Computes the torch's lean, layer by layer.
#[derive(Debug, Clone)]
pub struct Tilt {
    follow_wall: f64,
    /// Greatest work angle, rad.
    max_work_angle: f64,
    /// Sine of the travel angle.
    back: f64,
    here: Outlines,
    below: Outlines,
    height: f64,
}

impl Tilt {
    /// As in the profile; `None` if the torch stays upright.
    pub fn new(program: &ProgramSettings) -> Option<Self> {
        let (max_work_angle, back) = (program.max_work_angle.to_radians(), program.travel_angle.to_radians().sin());
        let (here, below) = (Outlines::new(), Outlines::new());
        let tilt = Self { follow_wall: program.follow_wall, max_work_angle, back, here, below, height: 1.0 };
        program.tilts().then_some(tilt)
    }

    /// Moves on to the next layer.
    pub fn enter(&mut self, layer: &Layer) {
        let line = |(a, b): (DVec2, DVec2)| Line::new(a.to_array(), b.to_array());
        let rings = layer.islands.iter().flat_map(Polygon::rings);
        let mut edges: Vec<_> = rings.flat_map(|ring| ring.edges()).map(line).collect();
        // Walls given as curves have no outline but their own paths.
        if edges.is_empty() {
            let pieces = layer.passes.iter().flat_map(|pass| pass.segments());
            edges.extend(pieces.map(|s| line((s.from.truncate(), s.to.truncate()))));
        }
        self.below = std::mem::replace(&mut self.here, RTree::bulk_load(edges));
        self.height = layer.height;
    }

    /// Divides long moves near their ends, so that the torch turns at corners and not all along the sides.
    pub fn divided(moves: Vec<(DVec3, f64)>, width: f64) -> Vec<(DVec3, f64)> {
        let mut divided: Vec<(DVec3, f64)> = Vec::with_capacity(moves.len());
        for (to, pace) in moves {
            let long = divided.last().map(|last| last.0).filter(|from| from.distance(to) > 6.0 * width);
            if let Some(from) = long {
                let part = 2.0 * width / from.distance(to);
                divided.extend([(from.lerp(to, part), pace), (to.lerp(from, part), pace)]);
            }
            divided.push((to, pace));
        }
        divided
    }

    /// The lean at every point of a path whose beads have this width (mm).
    pub fn leans(&self, moves: &[(DVec3, f64)], width: f64) -> Vec<DVec2> {
        let points: Vec<DVec2> = moves.iter().map(|(to, _)| to.truncate()).collect();
        let leans: Vec<DVec2> =
            (0..points.len()).map(|i| self.wall(points[i], width) - way(&points, i) * self.back).collect();
        let even = |lean: DVec2| (lean.clamp_length_max(MOST) / GRID).round() * GRID;
        smoothed(&points, &leans, width).into_iter().map(even).collect()
    }

    /// The lean of the wall at a point.
    fn wall(&self, at: DVec2, width: f64) -> DVec2 {
        let beside = || {
            let top = nearest(&self.here, at)?;
            let away = top - nearest(&self.below, top)?;
            (top.distance(at) < REACH * width && away.length() < STEP * self.height).then_some(away)
        };
        beside().map_or(DVec2::ZERO, |away| {
            let angle = (away.length() / self.height).atan() * self.follow_wall;
            away.normalize_or_zero() * angle.min(self.max_work_angle).sin()
        })
    }
}

/// The nearest point on an outline.
fn nearest(outlines: &Outlines, to: DVec2) -> Option<DVec2> {
    let line = outlines.nearest_neighbor(&to.to_array())?;
    Some(DVec2::from_array(line.nearest_point(&to.to_array())))
}

/// The direction of a path at a point; the bisecting direction at a corner.
fn way(points: &[DVec2], i: usize) -> DVec2 {
    let towards = |from: usize, to: usize| (points[to] - points[from]).normalize_or_zero();
    let (before, after) = (towards(i.saturating_sub(1), i), towards(i, (i + 1).min(points.len() - 1)));
    (before + after).normalize_or_zero()
}

/// The mean of the values along the path from `width` (mm) before each point to `width` after it; near an end, the
/// interval is shortened on both sides.
fn smoothed(points: &[DVec2], values: &[DVec2], width: f64) -> Vec<DVec2> {
    // The integral of the values up to each point, over the distance (mm).
    let mut sums = vec![(0.0, DVec2::ZERO); points.len().min(1)];
    for (p, v) in points.windows(2).zip(values.windows(2)) {
        let (step, &(way, sum)) = (p[0].distance(p[1]), sums.last().unwrap_or(&(0.0, DVec2::ZERO)));
        sums.push((way + step, sum + step * (v[0] + v[1]) / 2.0));
    }
    let end = sums.last().map_or(0.0, |(way, _)| *way);
    let upto = |way: f64| {
        let i = sums.partition_point(|(at, _)| *at < way).clamp(1, sums.len() - 1);
        let ((from, sum), to) = (sums[i - 1], sums[i].0);
        let part = if to > from { (way - from) / (to - from) } else { 0.0 };
        sum + (way - from) * (values[i - 1] + (values[i] - values[i - 1]) * part / 2.0)
    };
    let mean = |i: usize| {
        let (way, half) = (sums[i].0, width.min(sums[i].0).min(end - sums[i].0));
        if half > 0.0 { (upto(way + half) - upto(way - half)) / (2.0 * half) } else { values[i] }
    };
    (0..points.len()).map(mean).collect()
}

#[cfg(test)]
mod tests {
    use super::{Tilt, smoothed};
    use crate::program::ProgramSettings;
    use bead_plan::layer::Layer;
    use glam::{DVec2, DVec3};
    use planar::{Polygon, Ring};

    fn ring(radius: f64, centre: DVec2) -> Ring {
        let point = |k: i32| centre + radius * DVec2::from_angle(f64::from(k) * std::f64::consts::TAU / 180.0);
        Ring::new((0..180).map(point).collect())
    }

    fn layer(radius: f64, centre: DVec2) -> Layer {
        let islands = vec![Polygon { outer: ring(radius, centre), holes: Vec::new() }];
        Layer { height: 2.0, islands, ..Layer::default() }
    }

    fn around(radius: f64, centre: DVec2) -> Vec<(DVec3, f64)> {
        let points = ring(radius, centre);
        points.points().iter().chain(points.points().first()).map(|p| (p.extend(4.0), 8.0)).collect()
    }

    fn settings(follow_wall: f64, max_work_angle: f64, travel_angle: f64) -> ProgramSettings {
        ProgramSettings { follow_wall, max_work_angle, travel_angle, ..ProgramSettings::default() }
    }

    /// On a cone whose wall leans by 20° the torch leans by 20° outward or inward, wherever the cone is.
    #[test]
    fn the_torch_leans_with_a_cone() {
        let centre = DVec2::new(13.0, -41.0);
        for (slope, share, most, expected) in [
            (20.0_f64, 1.0, 40.0, 20.0_f64),
            (-20.0, 1.0, 40.0, -20.0),
            (20.0, 0.5, 40.0, 10.0),
            (30.0, 1.0, 12.0, 12.0),
        ] {
            let step = 2.0 * slope.to_radians().tan();
            let mut tilt = Tilt::new(&settings(share, most, 0.0)).unwrap();
            [layer(50.0, centre), layer(50.0 + step, centre)].iter().for_each(|l| tilt.enter(l));
            let moves = around(47.5 + step, centre);
            for (lean, (at, _)) in tilt.leans(&moves, 5.0).iter().zip(&moves) {
                let outward = (at.truncate() - centre).normalize();
                assert!(lean.distance(outward * expected.to_radians().sin()) < 0.008, "{slope}: {lean} at {at}");
            }
        }
    }

    #[test]
    fn steps_and_the_inside_stay_upright() {
        let mut tilt = Tilt::new(&settings(1.0, 40.0, 0.0)).unwrap();
        [layer(50.0, DVec2::ZERO), layer(40.0, DVec2::ZERO)].iter().for_each(|l| tilt.enter(l));
        assert!(tilt.leans(&around(37.5, DVec2::ZERO), 5.0).iter().all(|lean| *lean == DVec2::ZERO));
        [layer(50.0, DVec2::ZERO), layer(51.0, DVec2::ZERO)].iter().for_each(|l| tilt.enter(l));
        assert!(tilt.leans(&around(30.0, DVec2::ZERO), 5.0).iter().all(|lean| *lean == DVec2::ZERO));
    }

    /// A torch that pushes leans back over the bead that it has laid.
    #[test]
    fn the_travel_angle_leans_along_the_way() {
        let tilt = Tilt::new(&settings(0.0, 40.0, 10.0)).unwrap();
        let moves = Tilt::divided(vec![(DVec3::ZERO, 8.0), (DVec3::new(100.0, 0.0, 0.0), 8.0)], 5.0);
        assert_eq!(moves.iter().map(|m| m.0.x).collect::<Vec<_>>(), [0.0, 10.0, 90.0, 100.0]);
        let back = DVec2::new(-10.0_f64.to_radians().sin(), 0.0);
        assert!(tilt.leans(&moves, 5.0).iter().all(|lean| lean.distance(back) < 0.0015));
    }

    #[test]
    fn a_mean_along_the_path() {
        let points: Vec<DVec2> = (0..=100).map(|k| DVec2::new(f64::from(k), 0.0)).collect();
        let ramp: Vec<DVec2> = points.iter().map(|p| DVec2::new(p.x, 1.0)).collect();
        let even = smoothed(&points, &ramp, 7.5);
        assert!(even.iter().zip(&ramp).all(|(a, b)| a.distance(*b) < 1e-9));
        let step: Vec<DVec2> = points.iter().map(|p| DVec2::X * f64::from(u8::from(p.x >= 50.0))).collect();
        let even = smoothed(&points, &step, 7.5);
        assert!(
            even.windows(2).all(|w| (0.0..0.07).contains(&(w[1].x - w[0].x)))
                && (even[49].x - 29.0 / 60.0).abs() < 0.06
        );
        assert_eq!(smoothed(&points[..1], &ramp[..1], 5.0), ramp[..1]);
        assert!(smoothed(&[], &[], 5.0).is_empty());
    }
}
