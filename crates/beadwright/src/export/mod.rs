//! A plan for other programs: its beads piece by piece, as tables, as scenes and as toolpaths.
//!
//! | file | for |
//! | --- | --- |
//! | `csv`, `parquet` (feature `parquet`) | spreadsheets, pandas; `table` has their columns |
//! | `vtp` | ParaView, VTK, pyvista |
//! | [`toolpath`] | other planners and machines: the 3MF Toolpath extension, written and read |
//! | `stl`, `glb` | viewers: the shape as built, which `swept` makes |
//! | [`solids`] | CAD and CAM: several solids in one 3MF; `archive` is what all 3MF files share |
//! | `dxf`, `svg`, `png` (feature `png`) | CAD and drawing programs, documents, layer by layer |
//! | `walk` | what all of them write: the passes as they are welded, with times and waits |

mod archive;
mod csv;
mod dxf;
mod glb;
#[cfg(feature = "parquet")]
pub(crate) mod parquet;
#[cfg(feature = "png")]
mod png;
pub mod solids;
mod stl;
mod svg;
mod swept;
mod table;
pub mod toolpath;
mod vtp;
mod walk;

use crate::heat::History;
use crate::layer::Layer;
use crate::pass::PassKind;
use crate::plan::Header;
use crate::profile::Profile;
use crate::program::Tilt;
use crate::weld::Torch;
use glam::DVec3;

/// What is exported: a plan and the profile it is welded with.
#[derive(Debug, Clone, Copy)]
pub struct Beads<'a> {
    /// Part, profile and strategy.
    pub header: &'a Header,
    /// Layers, lowest first.
    pub layers: &'a [Layer],
    /// How they are welded.
    pub profile: &'a Profile,
    /// Temperatures of the metal during welding, where they were computed.
    pub heat: Option<&'a History>,
}

/// A format for beads.
pub struct Format {
    /// The extension of its files.
    pub extension: &'static str,
    /// What it is for.
    pub purpose: &'static str,
    /// Writes the bytes of a file.
    pub write: fn(&Beads<'_>) -> Result<Vec<u8>, ExportError>,
}

/// Why a plan cannot be exported.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ExportError {
    /// Nothing to write.
    #[error("the plan has no passes, so there is nothing to export")]
    Empty,
    /// The archive of a 3MF file cannot be made.
    #[error("the archive cannot be written: {0}")]
    Archive(#[from] zip::result::ZipError),
    /// A Parquet table cannot be made.
    #[cfg(feature = "parquet")]
    #[error("the table cannot be written: {0}")]
    Table(#[from] ::parquet::errors::ParquetError),
    /// More than the format can hold.
    #[error("the file would be {gigabytes:.1} GB, but this format holds at most 4 GB; export it as STL")]
    TooLarge {
        /// Its size, GB.
        gigabytes: f64,
    },
    /// Layers that the format cannot hold.
    #[error(
        "this format holds level layers only, and those of the plan lie on {0} (layers.chart); export csv, vtp, stl or glb"
    )]
    NotLevel(&'static str),
    /// A picture cannot be drawn.
    #[cfg(feature = "png")]
    #[error("the picture cannot be drawn: {0}")]
    Picture(String),
    /// The content of an archive cannot be packed.
    #[error("the archive cannot be written: {0}")]
    Packing(#[from] std::io::Error),
}

/// All formats for beads.
pub const FORMATS: &[Format] = &[
    csv::FORMAT,
    #[cfg(feature = "parquet")]
    parquet::FORMAT,
    vtp::FORMAT,
    toolpath::FORMAT,
    stl::FORMAT,
    glb::FORMAT,
];

/// The format of files with this extension.
///
/// ```
/// use beadwright::export::{Beads, format};
/// use beadwright::{Profile, StrategyName, Task, example, plan};
///
/// let mut profile = Profile::built_in("cmt-al2319-kuka")?;
/// profile.fill.strategy = StrategyName::Raster;
/// let star = example::find("star").ok_or("no such example")?.mesh();
/// let plan = plan("star", &star, &profile, &Task::new())?;
/// let beads = Beads { header: &plan.header, layers: &plan.layers, profile: &profile, heat: None };
/// // A line with the names of the columns, and one for each piece.
/// let table = (format("csv").ok_or("no such format")?.write)(&beads)?;
/// assert_eq!(String::from_utf8(table)?.lines().count(), 1 + beads.pieces().len());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn format(extension: &str) -> Option<&'static Format> {
    FORMATS.iter().find(|format| format.extension.eq_ignore_ascii_case(extension))
}

/// A format for single layers.
pub struct LayerFormat {
    /// The extension of its files.
    pub extension: &'static str,
    /// What it is for.
    pub purpose: &'static str,
    /// Writes the bytes of a file.
    pub write: fn(&Layer) -> Result<Vec<u8>, ExportError>,
}

/// All formats for single layers.
pub const LAYER_FORMATS: &[LayerFormat] = &[
    dxf::FORMAT,
    svg::FORMAT,
    #[cfg(feature = "png")]
    png::FORMAT,
];

/// The format of layers in files with this extension.
pub fn layer_format(extension: &str) -> Option<&'static LayerFormat> {
    LAYER_FORMATS.iter().find(|format| format.extension.eq_ignore_ascii_case(extension))
}

/// A straight piece of a bead, as it is welded: with overlap, hot start and lead-out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Piece {
    /// Layer, from 1.
    pub layer: usize,
    /// Pass in its layer, from 1.
    pub pass: usize,
    /// What the pass is for.
    pub kind: PassKind,
    /// Where it begins, mm.
    pub from: DVec3,
    /// Where it ends, mm.
    pub to: DVec3,
    /// Unit vector out of the layer, in the middle of the piece.
    pub normal: DVec3,
    /// Width of the bead, mm.
    pub width: f64,
    /// Thickness of the layer, mm.
    pub height: f64,
    /// Speed of the torch, mm/s; without acceleration.
    pub speed: f64,
    /// Speed at which the nominal wire feed lays the metal, mm/s.
    pub pace: f64,
    /// Wire feed, as a multiple of the nominal one.
    pub feed: f64,
    /// When it begins, s since the start of the build; waits and travels are counted.
    pub start: f64,
    /// How long it takes, s.
    pub seconds: f64,
    /// Temperature of the metal just ahead of the torch, °C; NaN where it was not computed.
    pub temperature: f64,
}

impl Beads<'_> {
    /// The pieces of all beads, in the order in which they are welded.
    pub fn pieces(&self) -> Vec<Piece> {
        let mut pieces: Vec<Piece> = self.runs().into_iter().flat_map(|run| self.in_space(run)).collect();
        for run in pieces.chunk_by_mut(|a, b| (a.layer, a.pass) == (b.layer, b.pass)) {
            self.warm(run);
        }
        pieces
    }

    /// All passes as they are welded, on their layers.
    fn runs(&self) -> Vec<walk::Run<'_>> {
        let Profile { program, layers, .. } = self.profile;
        walk::runs(self.layers, Torch::of(&self.profile.weld_settings()), Tilt::new(program), layers)
    }

    /// The pieces of a pass in space.
    fn in_space(&self, run: walk::Run<'_>) -> Vec<Piece> {
        let mut pieces = run.pieces;
        if let Some(sheet) = self.profile.layers.sheet(run.layer) {
            for piece in &mut pieces {
                let on_layer = piece.from.distance(piece.to);
                (piece.from, piece.to) = (sheet.at(piece.from).place, sheet.at(piece.to).place);
                // It takes the same time as on the layer.
                let longer = piece.from.distance(piece.to) / on_layer;
                piece.speed *= if longer.is_finite() { longer } else { 1.0 };
            }
        }
        pieces
    }

    /// Sets the temperatures of the pieces of one pass.
    fn warm(&self, pieces: &mut [Piece]) {
        let (Some(heat), Some(first)) = (self.heat, pieces.first()) else { return };
        let pass = heat.layers.get(first.layer - 1).and_then(|layer| layer.passes.get(first.pass - 1));
        let Some(pass) = pass else { return };
        let mut way = 0.0;
        for piece in pieces {
            let length = piece.from.distance(piece.to);
            let index = ((way + length / 2.0) / heat.spacing) as usize;
            piece.temperature = pass.along.get(index).or(pass.along.last()).copied().unwrap_or(f64::NAN);
            way += length;
        }
    }
}
