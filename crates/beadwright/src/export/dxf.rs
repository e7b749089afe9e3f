//! A layer as DXF of release 12, which every CAD program reads: outlines and passes as polylines, mm.
//!
//! Each kind of pass is a layer of the drawing. A pass at one height is a flat polyline that carries its widths; another
//! one is a polyline in space.

use super::{ExportError, LayerFormat};
use crate::layer::Layer;
use crate::number::push_fixed;
use crate::pass::Pass;
use glam::DVec3;
use planar::Polygon;

pub(super) const FORMAT: LayerFormat =
    LayerFormat { extension: "dxf", purpose: "a layer's outlines and passes, for CAD programs", write };

/// A polyline that ends where it begins.
const CLOSED: u32 = 1;
/// A polyline in space, and a vertex of one.
const IN_SPACE: u32 = 8;
const VERTEX_IN_SPACE: u32 = 32;

/// Passes whose points differ in height by less are flat, mm.
const FLAT_MM: f64 = 1e-4;

fn write(layer: &Layer) -> Result<Vec<u8>, ExportError> {
    Ok(drawing(layer).into_bytes())
}

fn drawing(layer: &Layer) -> String {
    let mut drawing = Drawing(String::new());
    drawing.text(999, &format!("layer {}, mm", layer.index + 1));
    drawing.text(0, "SECTION");
    drawing.text(2, "ENTITIES");
    for ring in layer.islands.iter().flat_map(Polygon::rings) {
        let points: Vec<DVec3> = ring.points().iter().map(|p| p.extend(layer.z)).collect();
        drawing.polyline("OUTLINE", &points, true, |_| 0.0);
    }
    for pass in &layer.passes {
        drawing.polyline(&layer_name(pass), &pass.points, pass.closed, |i| pass.width.after(i));
    }
    drawing.text(0, "ENDSEC");
    drawing.text(0, "EOF");
    drawing.0
}

/// The drawing's layer for a pass.
fn layer_name(pass: &Pass) -> String {
    pass.kind.name().to_ascii_uppercase()
}

/// The text of a drawing: pairs of a code and a value.
struct Drawing(String);

impl Drawing {
    fn text(&mut self, code: u32, value: &str) {
        self.0.push_str(&format!("{code:3}\n{value}\n"));
    }

    fn number(&mut self, code: u32, value: f64) {
        self.0.push_str(&format!("{code:3}\n"));
        push_fixed(&mut self.0, value, 4);
        self.0.push('\n');
    }

    fn flags(&mut self, flags: u32) {
        self.text(70, &format!("{flags:6}"));
    }

    fn place(&mut self, at: DVec3) {
        for (code, value) in [(10, at.x), (20, at.y), (30, at.z)] {
            self.number(code, value);
        }
    }

    /// A polyline; `width` (mm) gives its width from each point on.
    fn polyline(&mut self, layer: &str, points: &[DVec3], closed: bool, width: impl Fn(usize) -> f64) {
        let height = points.first().map_or(0.0, |p| p.z);
        let flat = points.iter().all(|p| (p.z - height).abs() < FLAT_MM);
        self.text(0, "POLYLINE");
        self.text(8, layer);
        self.text(66, "     1");
        self.place(DVec3::Z * if flat { height } else { 0.0 });
        self.flags(if closed { CLOSED } else { 0 } + if flat { 0 } else { IN_SPACE });
        for (i, point) in points.iter().enumerate() {
            self.text(0, "VERTEX");
            self.text(8, layer);
            self.place(*point);
            if flat {
                self.number(40, width(i));
                self.number(41, width(i));
            } else {
                self.flags(VERTEX_IN_SPACE);
            }
        }
        self.text(0, "SEQEND");
        self.text(8, layer);
    }
}
