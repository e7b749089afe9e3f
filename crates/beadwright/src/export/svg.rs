//! A layer as an SVG drawing to scale, for laser cutters, drawing programs and documents: outlines and the middles of beads as
//! hairlines, beads as strokes as wide as they are. (The pictures of the report have legends and marks; these have none.)

use super::{ExportError, LayerFormat};
use crate::layer::Layer;
use crate::number::{fixed, push_fixed};
use crate::palette;
use crate::pass::{Pass, PassKind, Segment};
use glam::DVec2;
use planar::{Bounds, Polygon, Ring};

pub(super) const FORMAT: LayerFormat =
    LayerFormat { extension: "svg", purpose: "a layer's outlines and passes to scale, for drawing programs", write };

/// Width of outlines and middles, mm.
const HAIRLINE: f64 = 0.1;

fn colour(kind: PassKind) -> String {
    palette::hex(palette::kind(kind))
}

fn write(layer: &Layer) -> Result<Vec<u8>, ExportError> {
    Ok(drawing(layer).into_bytes())
}

/// The text of the drawing.
pub(super) fn drawing(layer: &Layer) -> String {
    let rings = layer.islands.iter().flat_map(Polygon::rings).flat_map(Ring::points).copied();
    let passes = layer.passes.iter().flat_map(|pass| &pass.points).map(|p| p.truncate());
    let bounds = Bounds::of(rings.chain(passes)).unwrap_or(Bounds { min: DVec2::ZERO, max: DVec2::ONE });
    let rim = layer.passes.iter().map(|pass| pass.width.max()).fold(HAIRLINE, f64::max) / 2.0;
    let (size, left, top) = (bounds.size() + 2.0 * rim, bounds.min.x - rim, -bounds.max.y - rim);
    let [width, height] = [size.x, size.y].map(|v| fixed(v, 4));
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}mm\" height=\"{height}mm\" viewBox=\"{} {} {width} {height}\">\n\
         <title>Layer {}, z {} mm</title>\n<g id=\"passes\" fill=\"none\" stroke-linecap=\"round\" stroke-linejoin=\"round\">\n",
        fixed(left, 4),
        fixed(top, 4),
        layer.index + 1,
        fixed(layer.z, 4)
    );
    layer.passes.iter().for_each(|pass| bead(&mut svg, pass));
    svg.push_str(&format!("</g>\n<g id=\"middles\" fill=\"none\" stroke-width=\"{HAIRLINE}\">\n"));
    layer.passes.iter().for_each(|pass| middle(&mut svg, pass));
    svg.push_str(&format!("</g>\n<g id=\"outlines\" fill=\"none\" stroke=\"#000000\" stroke-width=\"{HAIRLINE}\">\n"));
    for island in &layer.islands {
        svg.push_str("<path d=\"");
        for ring in island.rings() {
            line(&mut svg, ring.points().iter().copied());
            svg.push('Z');
        }
        svg.push_str("\"/>\n");
    }
    svg.push_str("</g>\n</svg>\n");
    svg
}

/// A pass as wide as its bead: one stroke for each stretch of one width, in a group, so that they do not darken each other.
fn bead(svg: &mut String, pass: &Pass) {
    let (name, colour) = (pass.kind.name(), colour(pass.kind));
    svg.push_str(&format!("<g class=\"{name}\" stroke=\"{colour}\" opacity=\"0.6\">\n"));
    let segments: Vec<Segment> = pass.segments().collect();
    for stretch in segments.chunk_by(|a, b| a.width == b.width) {
        svg.push_str(&format!("<path stroke-width=\"{}\" d=\"", fixed(stretch[0].width, 4)));
        let points = std::iter::once(stretch[0].from).chain(stretch.iter().map(|segment| segment.to));
        line(svg, points.map(|p| p.truncate()));
        svg.push_str("\"/>\n");
    }
    svg.push_str("</g>\n");
}

/// The path of the torch along a pass.
fn middle(svg: &mut String, pass: &Pass) {
    svg.push_str(&format!("<path stroke=\"{}\" d=\"", colour(pass.kind)));
    line(svg, pass.line().into_iter());
    svg.push_str("\"/>\n");
}

/// The data of a path through points; y runs downwards.
fn line(svg: &mut String, points: impl Iterator<Item = DVec2>) {
    for (i, p) in points.enumerate() {
        svg.push(if i == 0 { 'M' } else { 'L' });
        push_fixed(svg, p.x, 4);
        svg.push(' ');
        push_fixed(svg, -p.y, 4);
    }
}
