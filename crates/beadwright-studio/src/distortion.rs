//! How plate and part bend as the metal cools, computed in the background.

use crate::computing::Computing;
use crate::level::Drawn;
use crate::view3d::Bent;
use beadwright::distort::{Deviation, Distortion, Lift, Shape};
use beadwright::distortion::{Clamps, Setup, Welding};
use beadwright::layer::Layer;
use beadwright::profile::Profile;
use beadwright::task::Task;
use std::sync::Arc;

/// How many times as large as computed movements can be drawn at first, and the part of the body's size by which the farthest
/// place may then seem to move: as in the page of `beadwright distort`.
const TIMES: [f64; 9] = [1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0];
const AT_FIRST: f64 = 0.1;

/// A shape of plate and part.
pub struct Figure {
    /// The plate.
    pub lift: Lift,
    /// The part.
    pub deviation: Deviation,
    /// How it is drawn.
    pub bent: Arc<Bent>,
}

/// What becomes of plate and part.
pub struct Distorted {
    /// On the clamps, at the end of the build.
    pub clamped: Figure,
    /// After the clamps are opened.
    pub released: Figure,
    /// How many times as large as computed the movement is drawn at first.
    pub times: f64,
}

impl Distorted {
    /// The distortion of a plan, as `beadwright distort` computes it.
    ///
    /// # Errors
    /// A sentence on what is missing, or why the model cannot be used.
    pub fn of(
        layers: &[Arc<Layer>],
        drawn: &Drawn,
        profile: &Profile,
        clamps: Clamps,
        task: &Task,
    ) -> Result<Self, String> {
        let built = Welding::of(layers, profile)
            .and_then(|welding| Setup { clamps, ..Setup::default() }.build(&welding, profile, task))
            .map_err(|error| error.to_string())?;
        task.check().map_err(|error| error.to_string())?;
        let straight = Bent::divided(&built, drawn);
        let figure = |shape: &Shape| {
            let bent = Arc::new(Bent::new(&built, shape, &straight));
            Figure { lift: shape.lift, deviation: shape.deviation, bent }
        };
        let (clamped, released) = (figure(&built.clamped), figure(&built.released));
        let most = clamped.bent.most().max(released.bent.most());
        Ok(Self { times: at_first(&built, most), clamped, released })
    }
}

/// How many times as large as computed a movement is drawn at first.
fn at_first(built: &Distortion, most: f64) -> f64 {
    let size = built.grid.size * glam::DVec3::from_array(built.grid.counts.map(|count| count as f64));
    let fits = |times: &f64| times * most <= AT_FIRST * size.length();
    TIMES.into_iter().rfind(fits).unwrap_or(TIMES[0])
}

/// A computation for clamps at these places, under way or done.
pub(crate) struct Distorting {
    pub(crate) clamps: Clamps,
    pub(crate) run: Computing<Distorted>,
}
