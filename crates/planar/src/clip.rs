//! Open lines cut by a region.

use crate::Region;
use crate::grid::{GridPoint, from_grid, region_to_grid, to_grid};
use glam::DVec2;
use i_overlay::core::fill_rule::FillRule;
use i_overlay::string::clip::{ClipRule, IntClip};

/// Which part of a line remains.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Keep {
    /// What lies inside the region, its boundary included.
    Inside,
    /// What lies outside, its boundary excluded.
    Outside,
}

/// Joins pieces that the library split although there is no gap between them.
fn whole(pieces: Vec<Vec<GridPoint>>) -> Vec<Vec<GridPoint>> {
    let mut whole: Vec<Vec<GridPoint>> = Vec::with_capacity(pieces.len());
    for piece in pieces {
        let after = whole.iter().position(|w| w.last() == piece.first() && w.first() != w.last());
        let index = match after {
            Some(index) => {
                whole[index].extend(&piece[1..]);
                index
            }
            None => {
                whole.push(piece);
                whole.len() - 1
            }
        };
        let before = (0..whole.len()).find(|&i| i != index && whole[i].first() == whole[index].last());
        if let Some(before) = before {
            let tail = whole[before][1..].to_vec();
            whole[index].extend(tail);
            whole.swap_remove(before);
        }
    }
    whole
}

impl Region {
    /// The pieces of the open line through `points` inside or outside this region, in no fixed order; each runs
    /// in the direction of the line.
    ///
    /// ```
    /// use planar::{DVec2, Polygon, Region, Ring, clip::Keep};
    ///
    /// let corners = [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)].map(DVec2::from);
    /// let square = Region::from(Polygon::simple(Ring::new(corners.to_vec())));
    /// let inside = square.clip_line(&[DVec2::new(-5.0, 4.0), DVec2::new(15.0, 4.0)], Keep::Inside);
    /// assert_eq!(inside, [[DVec2::new(0.0, 4.0), DVec2::new(10.0, 4.0)]]);
    /// ```
    pub fn clip_line(&self, points: &[DVec2], keep: Keep) -> Vec<Vec<DVec2>> {
        // With `invert` the library reverses this flag: true counts the boundary as inside in both cases.
        let rule = ClipRule { invert: keep == Keep::Outside, boundary_included: true };
        let path: Vec<_> = points.iter().map(|&p| to_grid(p)).collect();
        let pieces = region_to_grid(self).clip_path(&path, FillRule::NonZero, rule);
        whole(pieces).into_iter().map(|piece| piece.into_iter().map(from_grid).collect()).collect()
    }
}
