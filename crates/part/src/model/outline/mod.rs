//! Drawings: closed outlines in DXF and SVG, which become a solid of a given height.
//!
//! | file | what it does |
//! | --- | --- |
//! | `dxf` | lines, arcs, circles and polylines of DXF drawings |
//! | `entity` | the entities of a DXF drawing as they are in its text |
//! | `svg` | paths and shapes of SVG drawings, through `usvg` |
//! | `chain` | loose pieces are joined end to end |
//!
//! An outline within an outline is a hole; one within a hole is solid again.

mod chain;
mod dxf;
mod entity;
mod svg;

use super::solid::Solid;
use super::{Import, ImportError, MAX_REACH_MM, Mesh, Units};
use glam::DVec2;
use planar::{Bounds, FillRule, Region, Ring};

/// The closed outlines of a drawing.
#[derive(Debug, Clone, PartialEq)]
pub struct Outlines {
    /// Outlines and holes, in the units of the file, y upwards.
    pub rings: Vec<Ring>,
    /// The format, in words.
    pub format: &'static str,
    /// The unit of the coordinates, where the file states it.
    pub units: Option<Units>,
    /// What the drawing holds besides outlines, as sentences.
    pub notes: Vec<String>,
}

/// What kind of drawing the bytes look like, in words; `None` for anything else.
pub fn drawing(bytes: &[u8]) -> Option<&'static str> {
    [(dxf::is_dxf(bytes), "a DXF drawing"), (svg::is_svg(bytes), "an SVG drawing")]
        .into_iter()
        .find_map(|(is, name)| is.then_some(name))
}

/// Reads a drawing.
///
/// # Errors
/// [`ImportError::Broken`] with the line or place, and what to draw instead; [`ImportError::TooFar`].
pub fn read(bytes: &[u8]) -> Result<Outlines, ImportError> {
    let outlines = if dxf::is_dxf(bytes) { dxf::read(bytes)? } else { svg::read(bytes)? };
    // No unit is shorter than a millimetre, so nothing farther out can be planned.
    let reach = outlines.reach();
    if reach.is_nan() || reach > MAX_REACH_MM {
        return Err(ImportError::TooFar { reach_m: reach / 1000.0 });
    }
    if outlines.rings.iter().all(|ring| ring.area() == 0.0) {
        return Err(ImportError::Broken {
            format: outlines.format,
            reason: "it holds no closed outline with an area".to_owned(),
        });
    }
    Ok(outlines)
}

/// Most points of a drawing, once its curves are divided.
const MOST_POINTS: usize = 5_000_000;

/// Refuses drawings with too many points.
fn check_points(count: usize, format: &'static str) -> Result<(), ImportError> {
    if count <= MOST_POINTS {
        return Ok(());
    }
    let reason = format!("its outlines have more than {MOST_POINTS} points, with curves divided; simplify them");
    Err(ImportError::Broken { format, reason })
}

impl Outlines {
    /// Extent along x and y, in the units of the file.
    pub fn size(&self) -> DVec2 {
        Bounds::of(self.rings.iter().flat_map(Ring::points).copied()).map_or(DVec2::ZERO, |bounds| bounds.size())
    }

    /// The greatest distance of a point from the origin along x or y, in the units of the file.
    pub fn reach(&self) -> f64 {
        let points = self.rings.iter().flat_map(Ring::points);
        // Unlike `f64::max`, this keeps NaN.
        points.map(|p| p.abs().max_element()).fold(0.0, |a, b| if b <= a { a } else { b })
    }

    /// The region within the outlines and outside the holes, mm; `factor` is mm per unit of the file.
    pub fn region(&self, factor: f64) -> Region {
        let scaled = |ring: &Ring| Ring::new(ring.points().iter().map(|p| *p * factor).collect());
        Region::from_rings(&self.rings.iter().map(scaled).collect::<Vec<_>>(), FillRule::EvenOdd)
    }

    /// The solid over the outlines, `height` (mm) high; `factor` is mm per unit of the file.
    ///
    /// # Errors
    /// [`ImportError::Broken`] if nothing remains of the outlines at that size.
    pub fn extruded(&self, factor: f64, height: f64) -> Result<Import, ImportError> {
        let region = self.region(factor);
        let mut all = Solid::default();
        for polygon in region.polygons() {
            let first = all.vertices.len() as u32;
            let solid = Solid::extrude(polygon, 0.0, height);
            all.vertices.extend(solid.vertices);
            all.triangles.extend(solid.triangles.iter().map(|t| t.map(|i| i + first)));
        }
        if all.triangles.is_empty() {
            let reason = "nothing is left of its outlines at this size; check the unit".to_owned();
            return Err(ImportError::Broken { format: self.format, reason });
        }
        let (mesh, repair) = Mesh::from_triangles(all.vertices, all.triangles);
        let (format, notes) = (self.format, self.notes.clone());
        Ok(Import { mesh, repair, format, units: Some(Units::Millimetre), objects: Vec::new(), notes, milled: None })
    }
}
