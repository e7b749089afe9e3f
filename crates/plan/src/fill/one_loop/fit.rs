//! Fits flat beads edge to edge: an edge next to a gap moves out, one that lies over its neighbour moves back.
//!
//! Every point looks to both sides, as far as the next bead or the outline. A gap or an overlap is closed by a move
//! combined with a change of width, so that each edge contributes its share. In a corner of the outline a bead moves
//! further in and becomes narrower.

use super::LoopSettings;
use super::line::Line;
use super::room::Room;
use super::squares::Squares;
use super::tangles::Mend;
use glam::DVec2;

/// Neighbouring beads overlap by this many bead widths.
const OVERLAP: f64 = 0.028;
/// Fraction of a gap that an edge closes in a round, and fraction of an overlap that it withdraws.
const CLOSE: f64 = 1.0;
const BACK: f64 = 0.1;
/// Overlaps count as at most this deep, and gaps are searched for up to this reach, in bead widths.
const DEEPEST: f64 = 0.3;
const REACH: f64 = 0.35;
/// Each round a point is pulled this fraction of the way to the midpoint of its neighbours.
const TENSION: f64 = 0.03;
/// Each round, widths return by this fraction towards their initial values.
const RETURN: f64 = 0.02;
/// Pieces of the same line less than this many bead widths apart along it do not count as neighbours.
const APART: f64 = 0.9;
/// At a corner both legs touch the outline to within this, and their joint misses it by more than this, in bead widths.
const TOUCH: f64 = 0.06;
/// Fraction of that miss by which the joint moves in a round; and the ratio of bead narrowing to that move in a square
/// corner: twice the move over √2.
const INTO_CORNER: f64 = 0.3;
const NARROWS: f64 = std::f64::consts::SQRT_2;
/// Where the cosine between a piece's normal and the line of sight is at most this, only its round ends are seen.
const LEAST_LEAN: f64 = 0.2;

/// Fits lines edge to edge, with `mend` applied after each round.
pub fn fitted(mut lines: Vec<Line>, room: &Room, settings: &LoopSettings, mend: Mend) -> Vec<Line> {
    let first: Vec<Vec<f64>> = lines.iter().map(|line| line.widths.clone()).collect();
    for _ in 0..settings.rounds {
        let (pieces, before) = (Pieces::of(&lines, settings), lines.clone());
        for (number, line) in lines.iter_mut().enumerate() {
            let moves = Moves::of(line, number, &pieces, room, settings);
            moves.make(line, &first[number], room, settings);
        }
        mend(&mut lines, &before);
    }
    lines
}

/// How the points of a line move, and how much wider the bead becomes there, mm.
struct Moves {
    shifts: Vec<DVec2>,
    grows: Vec<f64>,
}

impl Moves {
    fn of(line: &Line, number: usize, pieces: &Pieces, room: &Room, settings: &LoopSettings) -> Self {
        let n = line.points.len();
        let mut moves = Self { shifts: vec![DVec2::ZERO; n], grows: vec![0.0; n] };
        let mut along = 0.0;
        for i in 0..n {
            let (p, half) = (line.points[i], line.half_width(i));
            let ways = [(line.before(i), i), (i, line.behind(i))];
            let ways = ways.map(|(a, b)| (line.points[b] - line.points[a]).normalize_or_zero());
            let sight = Sight { from: p, normal: (ways[0] + ways[1]).normalize_or_zero().perp(), line: number, along };
            let free = sight.free(pieces, room, half + REACH * settings.bead_width, settings);
            let (shift, grow) = corner(&free, half, room.at(p), settings.limits(line.thin[i]).0, settings)
                .unwrap_or_else(|| {
                    let [left, right] = free.map(|free| free.wanted(half, settings));
                    ((left - right) / 2.0, left + right)
                });
            (moves.shifts[i], moves.grows[i]) = (sight.normal * shift, grow);
            if line.is_end(i) {
                moves.shifts[i] = DVec2::ZERO;
            }
            along += p.distance(line.points[line.behind(i)]);
        }
        moves
    }

    fn make(&self, line: &mut Line, first: &[f64], room: &Room, settings: &LoopSettings) {
        let shifts = line.smoothed(&self.shifts);
        line.points.iter_mut().zip(shifts).for_each(|(point, shift)| *point += shift);
        line.tighten(TENSION);
        for (i, first) in first.iter().enumerate().take(line.count()) {
            let (low, high) = settings.limits(line.thin[i]);
            let grow = (self.grows[i] + self.grows[line.behind(i)]) / 2.0;
            let width = line.widths[i] + (first - line.widths[i]) * RETURN;
            line.widths[i] = (width + grow).clamp(low, high);
        }
        line.keep_inside(room, settings);
        line.meet_outline(room, settings);
        line.fit_inside(room, settings);
    }
}

/// The free distance to one side, mm, and whether it ends at the outline.
#[derive(Debug, Clone, Copy)]
struct Free {
    distance: f64,
    is_outline: bool,
}

impl Free {
    /// How far an edge `half` (mm) from the centre-line should move out, mm.
    fn wanted(self, half: f64, settings: &LoopSettings) -> f64 {
        let w = settings.bead_width;
        if self.is_outline {
            return (self.distance - half).max(-DEEPEST * w);
        }
        let gap = self.distance - half + OVERLAP * w;
        if gap > 0.0 { CLOSE * gap } else { BACK * gap.max(-DEEPEST * w) }
    }
}

/// How far the joint of two legs in a corner of the outline moves (positive to the left), and the change of bead width,
/// mm.
fn corner(free: &[Free; 2], half: f64, room: f64, narrowest: f64, settings: &LoopSettings) -> Option<(f64, f64)> {
    let touch = TOUCH * settings.bead_width;
    let is_corner = |free: &&Free| free.is_outline && free.distance - half > touch && room - half < touch;
    let side = free.iter().position(|free| is_corner(&free))?;
    let most = (half - narrowest / 2.0) * NARROWS;
    let by = (INTO_CORNER * (free[side].distance - half)).min(most).max(0.0);
    Some((if side == 0 { by } else { -by }, -NARROWS * by))
}

/// What a point of a line sees to both sides.
struct Sight {
    from: DVec2,
    /// Unit vector to the left.
    normal: DVec2,
    line: usize,
    along: f64,
}

impl Sight {
    /// Distance to the next bead or the outline on the left and on the right, at most `reach` (mm).
    fn free(&self, pieces: &Pieces, room: &Room, reach: f64, settings: &LoopSettings) -> [Free; 2] {
        let mut free = [reach; 2];
        for piece in pieces.near(self.from).filter(|piece| !self.is_own(piece, pieces, settings)) {
            for edge in self.edges(piece).into_iter().flatten() {
                let side = usize::from(edge.middle < 0.0);
                free[side] = free[side].min((edge.middle.abs() - edge.depth).max(0.0));
            }
        }
        let margin = 5e-4 * settings.bead_width;
        [(free[0], self.normal), (free[1], -self.normal)].map(|(free, way)| {
            let outline = self.to_outline(way, free, room, settings);
            if outline < free {
                Free { distance: outline - margin, is_outline: true }
            } else {
                Free { distance: free, is_outline: false }
            }
        })
    }

    fn is_own(&self, piece: &Piece, pieces: &Pieces, settings: &LoopSettings) -> bool {
        let apart = (piece.along - self.along).abs();
        let around = apart.min(pieces.lengths[self.line] - apart);
        piece.line == self.line && around < APART * settings.bead_width
    }

    /// Where the line of sight crosses a piece: its round ends, and its sides.
    fn edges(&self, piece: &Piece) -> [Option<Crossing>; 3] {
        let (a, b, r) = (piece.from - self.from, piece.to - self.from, piece.radius);
        let (ay, by) = (self.normal.perp_dot(a), self.normal.perp_dot(b));
        let (ax, bx) = (self.normal.dot(a), self.normal.dot(b));
        let round = |x: f64, y: f64| (y.abs() < r).then(|| Crossing { middle: x, depth: (r * r - y * y).sqrt() });
        let side = || {
            let lean = (by - ay).abs() / a.distance(b);
            let middle = ax + ay / (ay - by) * (bx - ax);
            (lean > LEAST_LEAN).then_some(Crossing { middle, depth: r / lean })
        };
        [round(ax, ay), round(bx, by), if ay * by < 0.0 { side() } else { None }]
    }

    /// Distance to the outline in the direction `way`, up to about `most` (mm), in steps short enough not to overshoot.
    fn to_outline(&self, way: DVec2, most: f64, room: &Room, settings: &LoopSettings) -> f64 {
        let mut along = 0.0;
        for _ in 0..6 {
            let step = room.at(self.from + way * along);
            along += step;
            if along >= most || step < 1e-3 * settings.bead_width {
                break;
            }
        }
        along
    }
}

/// Where a line of sight crosses a bead: the middle (positive to the left), and the distance from it to the edges.
struct Crossing {
    middle: f64,
    depth: f64,
}

struct Piece {
    from: DVec2,
    to: DVec2,
    radius: f64,
    line: usize,
    /// Position of its middle along its line, mm.
    along: f64,
}

/// All pieces, and where they lie.
struct Pieces {
    pieces: Vec<Piece>,
    lengths: Vec<f64>,
    squares: Squares,
}

impl Pieces {
    fn of(lines: &[Line], settings: &LoopSettings) -> Self {
        let (mut pieces, mut lengths) = (Vec::new(), Vec::new());
        for (number, line) in lines.iter().enumerate() {
            let mut along = 0.0;
            for (from, to, width) in line.pieces() {
                let length = from.distance(to);
                pieces.push(Piece { from, to, radius: width / 2.0, line: number, along: along + length / 2.0 });
                along += length;
            }
            lengths.push(along);
        }
        let middles: Vec<DVec2> = pieces.iter().map(|piece| (piece.from + piece.to) / 2.0).collect();
        // Half a bead, a gap and half of the widest bead fit into a square.
        let squares = Squares::of(&middles, settings.bead_width * (0.5 + REACH) + settings.width_limits.1);
        Self { pieces, lengths, squares }
    }

    /// The pieces around a place.
    fn near(&self, p: DVec2) -> impl Iterator<Item = &Piece> {
        self.squares.near(p).map(|i| &self.pieces[i])
    }
}
