//! The papers' experiments repeated, with our results next to theirs. A paper is one file and one line in [`PAPERS`].

pub mod a_skeleton_hybrid;
pub mod b_fdm_order;
pub mod c_compound;
pub mod d_thin_wall;
pub mod goal;

use beadwright::report::sheet::Sheet;
use beadwright::task::Task;
use goal::Goal;

/// The result of an experiment.
pub struct Reproduced {
    /// Tables and pictures.
    pub page: Sheet,
    /// What it sets out to reach.
    pub goals: Vec<Goal>,
    /// Pictures for the book, SVG, with the names of their files.
    pub pictures: Vec<(&'static str, String)>,
    /// The findings in a few lines, for the terminal.
    pub lines: Vec<String>,
    /// Programs, as texts to be appended to named files.
    pub files: Vec<(String, String)>,
}

/// A paper.
pub struct Paper {
    /// The name that users type.
    pub name: &'static str,
    /// Authors, year and subject.
    pub about: &'static str,
    /// Runs the experiment.
    pub run: fn(&Task) -> Result<Reproduced, ReproduceError>,
}

/// The papers.
pub const PAPERS: [Paper; 4] = [
    Paper {
        name: "a-skeleton-hybrid",
        about: "Zhao et al. 2023: contours whose pockets are filled as skeleton regions, on a propeller",
        run: a_skeleton_hybrid::run,
    },
    Paper {
        name: "b-fdm-order",
        about: "Han et al. 2018: order of contours, raster angle and merged sub-regions, on three printed plates",
        run: b_fdm_order::run,
    },
    Paper {
        name: "c-compound",
        about: "Liu et al. 2022: zigzag with a contour, and the distance between the two (figures 7 and 8), at twelve angles",
        run: c_compound::run,
    },
    Paper {
        name: "d-thin-wall",
        about: "Li et al.: predicted heights of thin walls, and paths that do not cross, on a frame, a blade, a gourd and a pot",
        run: d_thin_wall::run,
    },
];

/// Why an experiment could not be run.
#[derive(Debug, thiserror::Error)]
#[error("the experiment could not be run: {0}")]
pub struct ReproduceError(pub String);
