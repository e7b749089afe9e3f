//! Finds the lines near a point: a grid of cells that hold pieces of lines.

use glam::{DVec2, IVec2};
use rustc_hash::FxHashMap;

/// Numbered lines, cut into pieces and sorted by place.
pub struct LineIndex {
    size: f64,
    cells: FxHashMap<IVec2, Vec<Piece>>,
}

/// Number of the line, number of the piece in it, and its ends.
type Piece = (usize, usize, DVec2, DVec2);

/// A place this near the edge of a cell counts as in both, mm: a rounding error leaves no line out.
const EDGE: f64 = 1e-9;

/// The first line met in a direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sight {
    /// Number of the line.
    pub line: usize,
    /// Number of the piece in it.
    pub piece: usize,
    /// Distance to it, mm.
    pub distance: f64,
}

impl LineIndex {
    /// An index without lines, which sees no farther than `sight` (mm).
    pub fn new(sight: f64) -> Self {
        Self { size: sight, cells: FxHashMap::default() }
    }

    /// How far it sees, mm.
    pub fn sight_mm(&self) -> f64 {
        self.size
    }

    /// Adds a line.
    pub fn add_line(&mut self, number: usize, points: &[DVec2]) {
        for (k, pair) in points.windows(2).enumerate() {
            for cell in cells_along(pair[0], pair[1], self.size, EDGE) {
                self.cells.entry(cell).or_default().push((number, k, pair[0], pair[1]));
            }
        }
    }

    /// The first line met in a direction; the piece `own` does not count.
    pub fn sight(&self, from: DVec2, way: DVec2, own: (usize, usize)) -> Option<Sight> {
        let to = from + way * self.size;
        let mut nearest: Option<Sight> = None;
        for (line, piece, a, b) in self.around(from, to).filter(|(line, piece, ..)| (*line, *piece) != own) {
            let (edge, start) = (b - a, a - from);
            let cross = way.perp_dot(edge);
            let (t, u) = (start.perp_dot(edge) / cross, start.perp_dot(way) / cross);
            let seen = cross.abs() > 1e-12 && t > 1e-6 && t <= self.size && (0.0..=1.0).contains(&u);
            if seen && nearest.is_none_or(|nearest| t < nearest.distance) {
                nearest = Some(Sight { line, piece, distance: t });
            }
        }
        nearest
    }

    /// Whether a line crosses the segment; touching does not count.
    pub fn crosses(&self, a: DVec2, b: DVec2) -> bool {
        let side = |p: DVec2, q: DVec2, r: DVec2| (q - p).perp_dot(r - p);
        let cut = |c: DVec2, d: DVec2| side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0;
        self.around(a, b).any(|(_, _, c, d)| cut(c, d))
    }

    /// Every piece near a point, with its number and that of its line: all within sight, and some beyond.
    pub fn near(&self, place: DVec2) -> impl Iterator<Item = (usize, usize, DVec2, DVec2)> + '_ {
        self.around(place - self.size, place + self.size)
    }

    fn around(&self, a: DVec2, b: DVec2) -> impl Iterator<Item = Piece> + '_ {
        covered(a, b, self.size).flat_map(|cell| self.cells.get(&cell).into_iter().flatten().copied())
    }
}

/// The square cells of side `size` (mm) that come within `reach` (mm) of a segment, and a few beside them, column by
/// column: a long slanted line has no more than its length asks for.
pub fn cells_along(a: DVec2, b: DVec2, size: f64, reach: f64) -> impl Iterator<Item = IVec2> {
    let (a, b) = if a.x <= b.x { (a / size, b / size) } else { (b / size, a / size) };
    let reach = reach / size;
    let number = |place: f64| place.floor() as i32;
    let slope = if b.x > a.x { (b.y - a.y) / (b.x - a.x) } else { 0.0 };
    (number(a.x - reach)..=number(b.x + reach)).flat_map(move |x| {
        let at = |edge: f64| a.y + slope * (edge.clamp(a.x, b.x) - a.x);
        let edge = f64::from(x);
        let (from, to) = if slope == 0.0 { (a.y, b.y) } else { (at(edge - reach), at(edge + 1.0 + reach)) };
        (number(from.min(to) - reach)..=number(from.max(to) + reach)).map(move |y| IVec2::new(x, y))
    })
}

/// The cells of the box around two points.
fn covered(a: DVec2, b: DVec2, size: f64) -> impl Iterator<Item = IVec2> {
    let (low, high) = ((a.min(b) / size).floor().as_ivec2(), (a.max(b) / size).floor().as_ivec2());
    (low.x..=high.x).flat_map(move |x| (low.y..=high.y).map(move |y| IVec2::new(x, y)))
}
