//! Example parts, generated from their dimensions: to try the program, to test it, to compare settings.
//!
//! | file | what it holds |
//! | --- | --- |
//! | `bracket`, `cross`, `gear`, `plate`, `propeller`, `star`, `vase` | one solid part each |
//! | `hub`, `shaft` | one part each that is welded in layers around its axis |
//! | `elbow` | a part that is welded in layers square to its middle line |
//! | `dome`, `clad` | one part each that is welded in layers over a surface |
//! | `mould` | a part to be clad |
//! | `y_tube` | a part that is welded as several bodies |
//! | [`blade`], `gourd`, `pot`, `tian`, `wall` | one thin-walled part each (Li et al.) |
//! | `outline` | points on circles and arcs |
//! | `between` | what lies between two surfaces |

mod between;
pub mod blade;
mod bracket;
mod clad;
mod cross;
mod dome;
mod elbow;
mod gear;
mod gourd;
mod hub;
mod mould;
mod outline;
mod plate;
mod pot;
mod propeller;
mod shaft;
mod star;
mod tian;
mod vase;
mod wall;
mod y_tube;

use crate::curve::Nurbs;
use crate::model::iges::{self, WriteOptions};
use crate::model::solid::Solid;
use crate::model::{Mesh, stl};
use glam::DVec2;

/// A part that the program itself can generate; it stands on z = 0, centred about the z axis.
#[derive(Debug, Clone, Copy)]
pub struct Example {
    /// What people type: `propeller`.
    pub name: &'static str,
    /// A one-line description that ends with the extent along x, y and z, mm.
    pub about: &'static str,
    build: fn() -> Solid,
    curves: Option<fn() -> Vec<Nurbs>>,
    /// Its layers, if they are not level: [`Chart`](crate::chart::Chart) as text.
    pub chart: Option<&'static str>,
    /// The text of its bodies file, if a chart alone does not say how it is welded.
    bodies: Option<fn() -> String>,
}

/// Every example, by name.
pub const ALL: &[Example] = &[
    Example {
        name: "blade",
        about: "blade, an arched 3.5 mm wall that turns by 25° on its way up, 92.5 × 28.4 × 100 mm",
        build: blade::build,
        curves: Some(blade::curves),
        chart: None,
        bodies: None,
    },
    Example {
        name: "bracket",
        about: "bracket, an arm with a gusset on an upright 14 mm plate, to be welded as its preform, 100 × 60 × 90 mm",
        build: bracket::build,
        curves: None,
        chart: None,
        bodies: None,
    },
    Example {
        name: "clad",
        about: "cladding 5.6 mm thick on a saddle, welded in layers that follow it, 140 × 90 × 15.6 mm",
        build: clad::build,
        curves: None,
        chart: None,
        bodies: Some(clad::bodies),
    },
    Example {
        name: "cross",
        about: "cross with 36 mm wide arms, 100 × 100 × 20 mm",
        build: cross::build,
        curves: None,
        chart: None,
        bodies: None,
    },
    Example {
        name: "dome",
        about: "dished cap 12 mm thick, welded over a mould in layers that follow it, 140 × 140 × 20.3 mm",
        build: dome::build,
        curves: None,
        chart: None,
        bodies: Some(dome::bodies),
    },
    Example {
        name: "elbow",
        about: "quarter bend of a pipe with a 20 mm wall, welded square to its middle line, 190 × 90 × 190 mm",
        build: elbow::build,
        curves: None,
        chart: Some(elbow::CHART),
        bodies: None,
    },
    Example {
        name: "gear",
        about: "gear with 12 trapezoidal teeth and a 40 mm bore, 140 × 140 × 20 mm",
        build: gear::build,
        curves: None,
        chart: None,
        bodies: None,
    },
    Example {
        name: "gourd",
        about: "bottle gourd with a 4 mm wall, open at both ends, 120 × 120 × 200 mm",
        build: gourd::build,
        curves: Some(gourd::curves),
        chart: None,
        bodies: None,
    },
    Example {
        name: "hub",
        about: "hub of 80 mm with four twisted blades, welded around its axis, 240 × 240 × 70 mm",
        build: hub::build,
        curves: None,
        chart: Some("cylinder:axis=z,radius=40"),
        bodies: None,
    },
    Example {
        name: "mould",
        about: "block with a shallow hollow in its top, such as a mould's, to be clad, 160 × 120 × 34 mm",
        build: mould::build,
        curves: None,
        chart: None,
        bodies: None,
    },
    Example {
        name: "plate",
        about: "plate with rounded corners and five holes from 10 to 30 mm, 120 × 80 × 12 mm",
        build: plate::build,
        curves: None,
        chart: None,
        bodies: None,
    },
    Example {
        name: "pot",
        about: "pot with a 4 mm wall, square below and round above, 100 × 100 × 80 mm",
        build: pot::build,
        curves: Some(pot::curves),
        chart: None,
        bodies: None,
    },
    Example {
        name: "propeller",
        about: "ship propeller, four twisted blades on an 80 mm hub with a 36 mm bore, 260 × 260 × 20 mm",
        build: propeller::build,
        curves: None,
        chart: None,
        bodies: None,
    },
    Example {
        name: "shaft",
        about: "shaft of 50 mm with two flanges, welded around its axis, 122 × 122 × 160 mm",
        build: shaft::build,
        curves: None,
        chart: Some("cylinder:axis=z,radius=25"),
        bodies: None,
    },
    Example {
        name: "star",
        about: "five-pointed star of 80 mm radius, 152.2 × 144.7 × 20 mm",
        build: star::build,
        curves: None,
        chart: None,
        bodies: None,
    },
    Example {
        name: "tian",
        about: "frame like the character 田, four openings between 4.5 mm walls, 100 × 100 × 26 mm",
        build: tian::build,
        curves: Some(tian::curves),
        chart: None,
        bodies: None,
    },
    Example {
        name: "vase",
        about: "vase with a 14 mm wall and a closed 12 mm bottom, 104 × 104 × 120 mm",
        build: vase::build,
        curves: None,
        chart: None,
        bodies: None,
    },
    Example {
        name: "wall",
        about: "straight wall of one bead, 120 × 4.5 × 72 mm",
        build: wall::build,
        curves: Some(wall::curves),
        chart: None,
        bodies: None,
    },
    Example {
        name: "y-tube",
        about: "tube of 60 mm with a 16 mm wall that forks into two, welded as three bodies, 156.3 × 60 × 156.2 mm",
        build: y_tube::build,
        curves: None,
        chart: None,
        bodies: Some(|| y_tube::BODIES.to_owned()),
    },
];

/// A bodies file with one body whose layers follow a surface: its heights on a grid of `step` (mm), with `columns` and
/// `rows` on each side of the middle.
fn surface_body(name: &str, step: f64, columns: i32, rows: i32, height: impl Fn(DVec2) -> f64) -> String {
    let at = |i: i32, j: i32| DVec2::new(f64::from(i), f64::from(j)) * step;
    let grid = (-rows..=rows).flat_map(|j| (-columns..=columns).map(move |i| at(i, j)));
    let heights: Vec<String> = grid.map(|p| format!("{:.4}", height(p))).collect();
    let from = at(-columns, -rows);
    format!(
        "[[body]]\nname = \"{name}\"\nchart = \"surface:up=z,from={}/{},step={step},columns={},heights={}\"\n",
        from.x,
        from.y,
        2 * columns + 1,
        heights.join(":")
    )
}

/// The example with this name.
pub fn find(name: &str) -> Option<&'static Example> {
    ALL.iter().find(|example| example.name == name)
}

impl Example {
    /// The part as a binary STL file, mm.
    pub fn stl(&self) -> Vec<u8> {
        let solid = (self.build)();
        let facets = solid.triangles.iter().map(|t| t.map(|i| solid.vertices[i as usize]));
        stl::write(&format!("beadwright example {}", self.name), facets)
    }

    /// Its bodies, as the text of a bodies file (`beadwright plan --bodies`); `None` if its layers are level.
    pub fn bodies(&self) -> Option<String> {
        let one = || self.chart.map(|chart| format!("[[body]]\nname = \"{}\"\nchart = \"{chart}\"\n", self.name));
        self.bodies.map(|bodies| bodies()).or_else(one)
    }

    /// The centre-lines of the wall as an IGES file, mm; `None` for parts that are not thin walls.
    pub fn iges(&self) -> Option<String> {
        let curves = (self.curves?)();
        let named: Vec<(&str, &Nurbs)> = curves.iter().map(|curve| (self.name, curve)).collect();
        let options = WriteOptions { file_name: format!("{}.igs", self.name), ..WriteOptions::default() };
        Some(iges::write(&named, &options))
    }

    /// The part as a mesh, mm.
    ///
    /// ```
    /// use bead_part::example;
    ///
    /// // Two arms of 100 × 36 mm that share a square, 20 mm high.
    /// let cross = example::find("cross").ok_or("no such example")?.mesh();
    /// let area = 2.0 * 100.0 * 36.0 - 36.0 * 36.0;
    /// assert!((cross.volume() - area * 20.0).abs() < 1e-6);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn mesh(&self) -> Mesh {
        let Solid { vertices, triangles } = (self.build)();
        Mesh::from_triangles(vertices, triangles).0
    }
}
