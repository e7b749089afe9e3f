//! A pass in space: the path with the arc on, and the width and pace along it.

use crate::bead::pace::LayerPace;
use crate::process::{Dot, Process};
use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};

/// What a pass is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PassKind {
    /// Parallel to the boundary.
    Contour,
    /// Scan lines.
    Infill,
    /// Fill of pockets between contours.
    Skeleton,
    /// Along the middle of a wall.
    Wall,
    /// A dot: the arc burns on the spot.
    Spot,
}

impl PassKind {
    /// The word in plan.json and in programs.
    pub fn name(self) -> &'static str {
        match self {
            Self::Contour => "contour",
            Self::Infill => "infill",
            Self::Skeleton => "skeleton",
            Self::Wall => "wall",
            Self::Spot => "spot",
        }
    }

    /// Pace, mm/s, of a pass of this width, mm, in a layer; `dot` is the dot that the process lays with the torch
    /// standing still.
    pub fn pace(self, layer: &LayerPace<'_>, dot: Option<Dot>, width: f64) -> f64 {
        match (self, dot) {
            (Self::Spot, Some(dot)) => dot.pace(width),
            (Self::Wall, _) => layer.of_wall(width),
            _ => layer.of_bead(width),
        }
    }
}

/// A value along a path.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Along {
    /// The same everywhere.
    Same(f64),
    /// One value per point, which holds up to the next point.
    Each(Vec<f64>),
}

impl Along {
    /// The value on the way from a point to the next.
    pub fn after(&self, point: usize) -> f64 {
        match self {
            Self::Same(value) => *value,
            Self::Each(values) => values.get(point).or(values.last()).copied().unwrap_or_default(),
        }
    }

    /// The largest value.
    pub fn max(&self) -> f64 {
        match self {
            Self::Same(value) => *value,
            Self::Each(values) => values.iter().copied().fold(0.0, f64::max),
        }
    }

    /// Every value changed by `change`.
    pub fn map(&self, change: impl Fn(f64) -> f64) -> Self {
        match self {
            Self::Same(value) => Self::Same(change(*value)),
            Self::Each(values) => Self::Each(values.iter().map(|v| change(*v)).collect()),
        }
    }

    /// Reverses the values together with the path: every piece keeps its own value, including the closing piece.
    ///
    /// ```
    /// use bead_plan::pass::Along;
    ///
    /// // Three points have two pieces; the value of the last point belongs to none of them.
    /// let mut widths = Along::Each(vec![4.0, 6.0, 6.0]);
    /// widths.reverse();
    /// assert_eq!([widths.after(0), widths.after(1)], [6.0, 4.0]);
    /// ```
    pub fn reverse(&mut self) {
        if let Self::Each(values) = self
            && let [pieces @ .., _] = &mut values[..]
        {
            pieces.reverse();
        }
    }

    /// Adds a value for a new point on the piece after point `index`.
    pub fn split(&mut self, index: usize) {
        if let Self::Each(values) = self
            && let Some(&value) = values.get(index)
        {
            values.insert(index + 1, value);
        }
    }

    /// Rotates the values so that the point `index` comes first.
    pub fn rotate_left(&mut self, index: usize) {
        if let Self::Each(values) = self {
            let places = index.min(values.len());
            values.rotate_left(places);
        }
    }
}

/// One path with the arc on, in the part's space.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Pass {
    /// What it is for.
    pub kind: PassKind,
    /// Whether it ends where it began; the first point is then not repeated.
    pub closed: bool,
    /// Torch tool points, mm; z is the top of the layer.
    pub points: Vec<DVec3>,
    /// Bead width, mm.
    pub width: Along,
    /// Pace, mm/s: the speed at which the nominal wire feed lays the metal of a piece. [`Process::speed_at`] gives the
    /// speed of the torch.
    pub pace: Along,
    /// Time the torch waits before it, s, so that the metal below can cool.
    pub wait: f64,
}

/// One straight piece of a pass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Segment {
    /// Where it begins, mm.
    pub from: DVec3,
    /// Where it ends, mm.
    pub to: DVec3,
    /// Bead width, mm.
    pub width: f64,
    /// Pace, mm/s.
    pub pace: f64,
}

impl Segment {
    /// Length, mm.
    pub fn length(&self) -> f64 {
        self.from.distance(self.to)
    }

    /// Time for which the torch moves along it, s; without acceleration.
    pub fn seconds(&self, process: &Process) -> f64 {
        self.length() / process.speed_at(self.pace)
    }
}

impl Pass {
    /// The straight pieces in order, with the closing one of a closed pass.
    pub fn segments(&self) -> impl Iterator<Item = Segment> + '_ {
        let closing = self.closed.then(|| self.points.last().copied().zip(self.points.first().copied())).flatten();
        let pieces = self.points.windows(2).map(|w| (w[0], w[1])).chain(closing);
        pieces.enumerate().map(|(i, (from, to))| Segment {
            from,
            to,
            width: self.width.after(i),
            pace: self.pace.after(i),
        })
    }

    /// The path seen from above, mm; that of a closed pass ends where it began.
    pub fn line(&self) -> Vec<DVec2> {
        let again = self.closed.then(|| self.points.first()).flatten();
        self.points.iter().chain(again).map(|p| p.truncate()).collect()
    }

    /// Where the arc starts.
    pub fn start(&self) -> Option<DVec3> {
        self.points.first().copied()
    }

    /// Where the arc ends.
    pub fn end(&self) -> Option<DVec3> {
        if self.closed { self.points.first().copied() } else { self.points.last().copied() }
    }

    /// Makes a closed pass begin at the point with this index; an open one is unchanged.
    pub fn begin_at(&mut self, index: usize) {
        if self.closed && index < self.points.len() {
            self.points.rotate_left(index);
            self.width.rotate_left(index);
            self.pace.rotate_left(index);
        }
    }

    /// Reverses an open pass; a closed one is unchanged.
    pub fn reverse(&mut self) {
        if !self.closed {
            self.points.reverse();
            self.width.reverse();
            self.pace.reverse();
        }
    }

    /// Deposited length, mm.
    ///
    /// ```
    /// use bead_plan::pass::{Along, Pass, PassKind};
    /// use glam::DVec3;
    ///
    /// // A closed pass has a piece that leads back to its start.
    /// let points = vec![DVec3::ZERO, DVec3::X * 10.0, DVec3::new(10.0, 10.0, 0.0), DVec3::Y * 10.0];
    /// let (width, pace) = (Along::Same(5.0), Along::Same(8.0));
    /// let square = Pass { kind: PassKind::Contour, closed: true, points, width, pace, wait: 0.0 };
    /// assert_eq!((square.segments().count(), square.length()), (4, 40.0));
    /// assert_eq!(square.start(), square.end());
    /// ```
    pub fn length(&self) -> f64 {
        self.segments().map(|s| s.length()).sum()
    }

    /// The part of the pass between two distances along it, mm; on a closed one they may go beyond its start.
    ///
    /// ```
    /// use bead_plan::pass::{Along, Pass, PassKind};
    /// use glam::DVec3;
    ///
    /// let points = vec![DVec3::ZERO, DVec3::X * 10.0, DVec3::new(10.0, 10.0, 0.0)];
    /// let (width, pace) = (Along::Same(5.0), Along::Same(8.0));
    /// let pass = Pass { kind: PassKind::Infill, closed: false, points, width, pace, wait: 0.0 };
    /// let middle = pass.stretch(5.0, 15.0);
    /// assert_eq!(middle.points, [DVec3::X * 5.0, DVec3::X * 10.0, DVec3::new(10.0, 5.0, 0.0)]);
    /// ```
    pub fn stretch(&self, from: f64, to: f64) -> Self {
        let mut along = 0.0;
        let again = if self.closed { 2 } else { 1 };
        let mut kept: Vec<Segment> = Vec::new();
        for segment in (0..again).flat_map(|_| self.segments()) {
            let length = segment.length();
            let part = |distance: f64| segment.from.lerp(segment.to, ((distance - along) / length).clamp(0.0, 1.0));
            if length > 0.0 && along + length > from && along < to {
                kept.push(Segment { from: part(from), to: part(to), ..segment });
            }
            along += length;
        }
        self.of_pieces(&kept)
    }

    /// The same pass, but open and along the given pieces, each of which must begin where the one before it ends.
    pub fn of_pieces(&self, pieces: &[Segment]) -> Self {
        let points = pieces.first().map(|s| s.from).into_iter().chain(pieces.iter().map(|s| s.to)).collect();
        // A value applies from its point to the next.
        let values = |value: fn(&Segment) -> f64| Along::Each(pieces.iter().chain(pieces.last()).map(value).collect());
        let (width, pace) = (values(|s| s.width), values(|s| s.pace));
        Self { kind: self.kind, closed: false, points, width, pace, wait: self.wait }
    }

    /// Number of turns sharper than 30° from one piece to the next.
    pub fn turns(&self) -> usize {
        const COS_30: f64 = 0.866_025;
        let way = |s: &Segment| (s.to - s.from).normalize_or_zero();
        let ways: Vec<DVec3> = self.segments().map(|s| way(&s)).collect();
        let closing = self.closed.then(|| ways.last().zip(ways.first())).flatten();
        let pairs = ways.windows(2).map(|w| (&w[0], &w[1])).chain(closing);
        pairs.filter(|(a, b)| a.dot(**b) < COS_30).count()
    }

    /// Time for which the torch moves along it, s; without acceleration.
    pub fn seconds(&self, process: &Process) -> f64 {
        self.segments().map(|s| s.seconds(process)).sum()
    }
}
