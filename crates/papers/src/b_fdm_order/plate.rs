//! Plates of the kinds that the paper shows.

use glam::DVec2;
use planar::{Polygon, Ring};
use std::f64::consts::TAU;

/// The paper's printed figures for a plate: for plain scanning, which it calls the zigzag method, and for its own
/// method.
#[derive(Debug)]
pub struct Printed {
    /// Which figure shows the plate.
    pub figure: u8,
    /// Contour travel per layer, mm (table 1).
    pub travel: [f64; 2],
    /// Time of a layer, s (table 1).
    pub seconds: [f64; 2],
    /// Sub-regions of its section, and how many remain once they are merged (figures 12, 13, 18 and 19), where the
    /// paper says so.
    pub regions: Option<[usize; 2]>,
    /// Roughness Ra of top and side, µm (table 3).
    pub roughness: [[f64; 2]; 2],
}

/// The plates of the paper.
const PRINTED: [Printed; 3] = [
    Printed {
        figure: 1,
        travel: [244.45, 196.81],
        seconds: [141.2, 123.4],
        regions: None,
        roughness: [[18.654, 14.878], [10.721, 6.756]],
    },
    Printed {
        figure: 12,
        travel: [55.33, 48.40],
        seconds: [80.5, 71.2],
        regions: Some([12, 4]),
        roughness: [[18.032, 13.941], [10.986, 6.534]],
    },
    Printed {
        figure: 15,
        travel: [180.23, 160.90],
        seconds: [180.6, 164.5],
        regions: Some([16, 6]),
        roughness: [[19.581, 14.987], [11.208, 6.824]],
    },
];

/// A plate, and what the paper saved on its own plate.
#[derive(Debug, Clone)]
pub struct Plate {
    /// Its kind and size.
    pub name: &'static str,
    /// Its outline and holes, mm; the holes in file order.
    pub polygon: Polygon,
    /// Contour travel and layer time saved in the paper, % (its abstract).
    pub paper: [f64; 2],
    /// The paper's printed figures for its plate of this kind.
    pub printed: &'static Printed,
}

impl Plate {
    /// The plate turned by an angle, °.
    pub fn turned(&self, degrees: f64) -> Polygon {
        // Exact at right angles, so that edges stay parallel to the axes.
        let exact = |v: f64| if v.abs() < 1e-12 { 0.0 } else { v };
        let way = DVec2::from_angle(degrees.to_radians());
        let way = DVec2::new(exact(way.x), exact(way.y));
        let turn = |ring: &Ring| Ring::new(ring.points().iter().map(|p| way.rotate(*p)).collect());
        Polygon { outer: turn(&self.polygon.outer), holes: self.polygon.holes.iter().map(turn).collect() }
    }
}

fn circle(x: f64, y: f64, radius: f64) -> Ring {
    const VERTICES: usize = 64;
    let point = |k: usize| DVec2::new(x, y) + DVec2::from_angle(TAU * k as f64 / VERTICES as f64) * radius;
    Ring::new((0..VERTICES).map(point).collect())
}

fn rectangle(x: f64, y: f64, width: f64, height: f64) -> Ring {
    Ring::new([(x, y), (x + width, y), (x + width, y + height), (x, y + height)].map(DVec2::from).to_vec())
}

/// Plates of the kinds that the paper shows; lying down, like its first one.
pub fn plates() -> [Plate; 3] {
    let plate = |name, kind: usize, paper, outer: Ring, holes: Vec<Ring>| {
        let holes = holes.into_iter().map(Ring::reversed).collect();
        Plate { name, polygon: Polygon { outer, holes }, paper, printed: &PRINTED[kind] }
    };
    let eight = [
        (12.0, 38.0),
        (62.0, 14.0),
        (36.0, 36.0),
        (86.0, 37.0),
        (14.0, 12.0),
        (60.0, 35.0),
        (88.0, 13.0),
        (38.0, 13.0),
    ];
    // One sub-region at the bottom; each hole adds three, each notch in the upper edge two.
    let notched =
        [(0.0, 0.0), (80.0, 0.0), (80.0, 60.0), (52.0, 60.0), (52.0, 38.0), (30.0, 38.0), (30.0, 60.0), (0.0, 60.0)];
    let three = vec![rectangle(34.0, 20.0, 12.0, 8.0), circle(58.0, 14.0, 8.0), circle(16.0, 16.0, 7.0)];
    // No two holes begin or end at the same height: 1 + 5 × 3 sub-regions.
    let five = vec![
        circle(20.0, 50.0, 9.0),
        rectangle(70.0, 44.0, 22.0, 14.0),
        circle(50.0, 25.0, 12.0),
        rectangle(12.0, 10.0, 16.0, 12.0),
        circle(88.0, 19.0, 8.0),
    ];
    [
        plate(
            "nine loops, 100 × 50 mm",
            0,
            [19.5, 12.6],
            rectangle(0.0, 0.0, 100.0, 50.0),
            eight.map(|(x, y)| circle(x, y, 6.0)).to_vec(),
        ),
        plate("twelve sub-regions, 80 × 60 mm", 1, [12.5, 11.6], Ring::new(notched.map(DVec2::from).to_vec()), three),
        plate("six loops, 110 × 70 mm", 2, [10.7, 8.9], rectangle(0.0, 0.0, 110.0, 70.0), five),
    ]
}
