//! The index of lines sees every line that is near, and long slanted lines cost it no more than their length.

use beadwright::fill::line_index::{LineIndex, cells_along};
use glam::DVec2;
use planar::polyline::distance_squared_to_segment;
use proptest::prelude::*;

/// Half of the points lie on a grid of whole millimetres, so that lines run along edges and through corners of cells.
fn point() -> impl Strategy<Value = DVec2> {
    let on_grid = (-40..40_i32, -40..40_i32).prop_map(|(x, y)| DVec2::new(x.into(), y.into()));
    prop_oneof![on_grid, (-40.0..40.0, -40.0..40.0).prop_map(DVec2::from)]
}

proptest! {
    #[test]
    fn every_piece_within_sight_is_near(a in point(), b in point(), place in point(), sight in 1..6_i32) {
        let sight = f64::from(sight);
        let mut index = LineIndex::new(sight);
        index.add_line(7, &[a, b]);
        if distance_squared_to_segment(place, a, b) <= sight * sight {
            prop_assert!(index.near(place).any(|piece| piece == (7, 0, a, b)));
        }
    }
}

#[test]
fn a_slanted_line_has_the_cells_that_it_passes() {
    // It enters a cell at each of the 1,000 columns and 500 rows; some enter both at once.
    let cells = cells_along(DVec2::splat(0.5), DVec2::new(1000.5, 500.5), 1.0, 0.0).count();
    assert!((1001..=1501).contains(&cells), "{cells} cells");
}
