//! Divisions of a part into bodies, each with a build direction of its own, found in the background as by `beadwright directions`.

use crate::computing::Computing;
use crate::view3d::Scanned;
use beadwright::directions::{Settings, Tried, metal, tried};
use beadwright::model::{Mesh, Part};
use beadwright::profile::{Body, Profile};
use beadwright::task::Task;
use std::sync::Arc;

/// At most this many that can be welded are shown.
const BEST: usize = 3;

/// Divisions looked for, or found.
pub(crate) struct Dividing {
    /// The part that is divided.
    pub(crate) part: Arc<Part>,
    /// The profile without its bodies.
    pub(crate) profile: Profile,
    pub(crate) run: Computing<Ways>,
}

/// A division that is shown.
pub struct Way {
    /// How the part is divided, and what came of planning it.
    pub tried: Tried,
    /// Whether it needs layers farther from level than is usual.
    pub farther: bool,
    /// The part in the colours of its bodies.
    pub(crate) pieces: Option<Arc<Scanned>>,
    /// Whether some of it, in grey, must be there already.
    pub stock: bool,
    /// The bodies as text, by which those of a profile are compared with them.
    text: String,
}

/// The divisions of a part.
pub struct Ways {
    /// What overhangs in level layers, mm².
    pub level: f64,
    /// The best that can be welded, those that cannot be welded, and what could be with layers farther from level.
    pub ways: Vec<Way>,
}

impl Ways {
    /// The divisions of a part by a profile, without the bodies that it has.
    ///
    /// # Errors
    /// A sentence on why the part cannot be divided.
    pub fn of(name: &str, part: &Part, profile: &Profile, task: &Task) -> Result<Self, String> {
        let settings = Settings::usual(profile.bead.width);
        let found = tried(name, part, profile, false, settings, task).map_err(|error| error.to_string())?;
        let mesh = part.mesh().ok_or("a part given by curves is not divided.")?;
        let (level, tilted) = (found.level, found.tilted.clone());
        let (can, cannot) = found.offered().cloned().partition::<Vec<Tried>, _>(Tried::is_planned);
        let usual = can.into_iter().take(BEST).chain(cannot).map(|tried| (tried, false));
        let all = usual.chain(tilted.map(|tried| (tried, true)));
        let way = |(tried, farther)| task.check().map(|()| Way::of(tried, farther, mesh));
        let ways = all.map(way).collect::<Result<_, _>>().map_err(|error| error.to_string())?;
        Ok(Self { level, ways })
    }
}

impl Way {
    fn of(tried: Tried, farther: bool, mesh: &Mesh) -> Self {
        let metal = metal(mesh, &tried.bodies);
        let text = Body::write(&tried.clone().into_bodies());
        let stock = metal.iter().any(|metal| metal.stock);
        Self { tried, farther, pieces: Scanned::pieces(&metal).map(Arc::new), stock, text }
    }

    /// Whether it is how a part with these bodies is welded.
    pub fn is_of(&self, bodies: &[Body]) -> bool {
        self.text == Body::write(bodies)
    }
}
