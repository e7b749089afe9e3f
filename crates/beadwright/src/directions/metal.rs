//! The metal of a divided part: what is welded as each of its bodies, and what must be there already.

use crate::chart::{Bound, Chart, Cylinder};
use crate::model::Mesh;
use crate::profile::Body;

/// Some of the metal of a part.
#[derive(Debug, Clone)]
pub struct Metal {
    /// Where it is.
    pub mesh: Mesh,
    /// The body that it belongs to, by its index.
    pub body: usize,
    /// Whether it is there before anything is welded.
    pub stock: bool,
}

/// The metal of a part as these bodies, in their order.
pub fn metal(part: &Mesh, bodies: &[Body]) -> Vec<Metal> {
    let mut all = Vec::new();
    for (number, body) in bodies.iter().enumerate() {
        let whole = body.of_mesh(part);
        let mut add = |mesh, stock| all.push(Metal { mesh, body: number, stock });
        let Chart::Cylinder(around) = &body.chart else {
            add(whole, false);
            continue;
        };
        // Below its first layer lies metal of other bodies, or stock.
        add(Bound::Cylinder(*around).part_of(&whole), false);
        if body.on_stock {
            let inside = Cylinder { side: around.side.other(), ..*around };
            add(Bound::Cylinder(inside).part_of(&whole), true);
        }
    }
    all
}
