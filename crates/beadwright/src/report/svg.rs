//! One layer as a standalone SVG picture, in millimetres.

use super::{escape, travels};
use crate::layer::Layer;
use crate::number::push_fixed;
use crate::palette::{self, hex};
use crate::pass::{Along, PassKind};
use glam::DVec2;
use planar::{Bounds, Polygon, Ring};

/// Colour of moves without arc.
const TRAVEL: &str = "#6b7280";

/// Text and lines scale with the picture: its larger side is this many units long.
const UNITS: f64 = 100.0;
/// Room for the legend, in units.
const LEGEND_WIDTH: f64 = 91.0;

/// The picture of a layer, y upwards.
///
/// ```
/// use beadwright::planar::{DVec2, Polygon, Ring};
/// use beadwright::{Layer, report::svg};
///
/// let plate = Polygon::simple(Ring::new([(0.0, 0.0), (60.0, 0.0), (60.0, 50.0), (0.0, 50.0)].map(DVec2::from).to_vec()));
/// let picture = svg::layer(&Layer { islands: vec![plate], ..Layer::default() }, "plate & bore");
/// assert!(picture.starts_with("<svg") && picture.contains("<title>plate &amp; bore</title>"));
/// ```
pub fn layer(layer: &Layer, title: &str) -> String {
    let frame = Frame::of(layer);
    let mut svg = frame.open(title);
    islands(&mut svg, layer, frame.unit);
    beads(&mut svg, layer, frame.unit);
    marks(&mut svg, layer, frame.unit);
    frame.legend(&mut svg, layer.passes.iter().any(|pass| pass.kind == PassKind::Wall));
    svg.push_str("</svg>\n");
    svg
}

/// Where things are drawn; y already runs downwards.
struct Frame {
    low: DVec2,
    size: DVec2,
    unit: f64,
}

impl Frame {
    fn of(layer: &Layer) -> Self {
        let rings = layer.islands.iter().flat_map(Polygon::rings).flat_map(Ring::points).copied();
        let points = rings.chain(layer.passes.iter().flat_map(|pass| &pass.points).map(|p| p.truncate()));
        let bounds = Bounds::of(points).unwrap_or(Bounds { min: DVec2::ZERO, max: DVec2::ONE });
        let bead = layer.passes.iter().map(|pass| pass.width.max()).fold(0.0, f64::max);
        let part = bounds.size() + bead;
        let unit = part.max_element().max(1e-3) / UNITS;
        let size = DVec2::new(part.x.max(LEGEND_WIDTH * unit) + 8.0 * unit, part.y + 22.0 * unit);
        let center = DVec2::new(bounds.center().x, -bounds.center().y);
        let low = center - DVec2::new(size.x / 2.0, part.y / 2.0 + 11.0 * unit);
        Self { low, size, unit }
    }

    fn open(&self, title: &str) -> String {
        let (low, size, unit, title) = (self.low, self.size, self.unit, escape(title));
        let mut svg = String::from("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"");
        push_numbers(&mut svg, &[low.x, low.y, size.x, size.y], ' ');
        svg.push_str("\" font-family=\"system-ui, sans-serif\" stroke-linecap=\"round\" stroke-linejoin=\"round\">\n");
        svg.push_str(&format!("<title>{title}</title>\n<rect"));
        attributes(&mut svg, &[("x", low.x), ("y", low.y), ("width", size.x), ("height", size.y)]);
        svg.push_str(" fill=\"#ffffff\"/>\n");
        text(&mut svg, low + DVec2::new(4.0, 6.0) * unit, 3.4 * unit, &format!("font-weight=\"600\">{title}"));
        svg
    }

    /// Colours and a scale bar below the picture; walls are shown without the other kinds.
    fn legend(&self, svg: &mut String, walls: bool) {
        let (unit, y) = (self.unit, self.low.y + self.size.y - 4.0 * self.unit);
        let mut at = DVec2::new(self.low.x + 4.0 * unit, y);
        let widths = [11.0, 8.6, 12.0, 6.4];
        let kinds = palette::KINDS.iter().zip(widths).map(|(kind, width)| (kind.name(), colour(*kind), width));
        let kinds = kinds.chain([("travel", TRAVEL.to_owned(), 8.8)]);
        let shown = |name: &str| name == "travel" || (name == "wall") == walls;
        for (name, colour, width) in kinds.filter(|(name, ..)| shown(name)) {
            let (thick, dash) = if name == "travel" { (0.35, "1.4 0.9") } else { (1.8, "none") };
            line(svg, at - DVec2::Y * 0.8 * unit, at + DVec2::new(3.0, -0.8) * unit, thick * unit);
            let dash = if dash == "none" { String::new() } else { dashes(unit) };
            svg.push_str(&format!(" stroke=\"{colour}\"{dash}/>\n"));
            text(svg, at + DVec2::X * 4.6 * unit, 2.2 * unit, &format!(">{name}"));
            at.x += (width + 4.6) * unit;
        }
        for (name, colour) in [("arc start", palette::START), ("arc end", palette::END)] {
            dot(svg, at + DVec2::new(0.8, -0.8) * unit, 0.9 * unit, &hex(colour));
            text(svg, at + DVec2::X * 2.4 * unit, 2.2 * unit, &format!(">{name}"));
            at.x += 12.6 * unit;
        }
        self.scale_bar(svg);
    }

    fn scale_bar(&self, svg: &mut String) {
        let (unit, length) = (self.unit, round_length(20.0 * self.unit));
        let right = self.low + DVec2::new(self.size.x - 4.0 * unit, 6.0 * unit);
        let left = right - DVec2::X * length;
        let tick = DVec2::Y * 0.8 * unit;
        for (a, b) in [(left, right), (left - tick, left + tick), (right - tick, right + tick)] {
            line(svg, a, b, 0.35 * unit);
            svg.push_str(" stroke=\"#111827\"/>\n");
        }
        let middle = (left + right) / 2.0 - DVec2::Y * 1.2 * unit;
        text(svg, middle, 2.2 * unit, &format!("text-anchor=\"middle\">{length} mm"));
    }
}

/// The largest of 1, 2 and 5 times a power of ten that is not above `length`.
fn round_length(length: f64) -> f64 {
    let power = 10_f64.powf(length.log10().floor());
    [5.0, 2.0].into_iter().find(|f| f * power <= length).unwrap_or(1.0) * power
}

fn islands(svg: &mut String, layer: &Layer, unit: f64) {
    svg.push_str("<path fill=\"#e5e7eb\" fill-rule=\"evenodd\" stroke=\"#6b7280\" stroke-width=\"");
    push_fixed(svg, 0.2 * unit, 3);
    svg.push_str("\" d=\"");
    for ring in layer.islands.iter().flat_map(Polygon::rings) {
        path(svg, ring.points().iter().copied(), true);
    }
    svg.push_str("\"/>\n");
}

fn beads(svg: &mut String, layer: &Layer, unit: f64) {
    for pass in &layer.passes {
        let points = || pass.points.iter().map(|p| p.truncate());
        match pass.width {
            Along::Same(width) => stroke(svg, pass.kind, points(), pass.closed, width, WIDE),
            // In a group, so that the pieces of one pass do not darken each other.
            Along::Each(_) => {
                svg.push_str("<g opacity=\"0.45\">\n");
                for s in pass.segments() {
                    stroke(svg, pass.kind, [s.from.truncate(), s.to.truncate()].into_iter(), false, s.width, "");
                }
                svg.push_str("</g>\n");
            }
        }
    }
    for pass in &layer.passes {
        stroke(svg, pass.kind, pass.points.iter().map(|p| p.truncate()), pass.closed, 0.25 * unit, "");
    }
}

/// Opacity of beads, so that what lies below them shows through.
const WIDE: &str = " stroke-opacity=\"0.45\"";

fn colour(kind: PassKind) -> String {
    hex(palette::kind(kind))
}

fn stroke(svg: &mut String, kind: PassKind, points: impl Iterator<Item = DVec2>, closed: bool, width: f64, more: &str) {
    let colour = colour(kind);
    svg.push_str(&format!("<path fill=\"none\" stroke=\"{colour}\"{more} stroke-width=\""));
    push_fixed(svg, width, 3);
    svg.push_str("\" d=\"");
    path(svg, points, closed);
    svg.push_str("\"/>\n");
}

fn marks(svg: &mut String, layer: &Layer, unit: f64) {
    let flip = |p: DVec2| DVec2::new(p.x, -p.y);
    for (from, to) in travels(layer) {
        line(svg, flip(from), flip(to), 0.25 * unit);
        svg.push_str(&format!(" stroke=\"{TRAVEL}\"{}/>\n", dashes(unit)));
    }
    let [start, end] = [palette::START, palette::END].map(hex);
    // On closed passes the two coincide: the start is drawn over the end.
    for pass in &layer.passes {
        let at = |p: Option<glam::DVec3>| p.map(|p| flip(p.truncate()));
        at(pass.end()).into_iter().for_each(|p| dot(svg, p, 0.75 * unit, &end));
        at(pass.start()).into_iter().for_each(|p| dot(svg, p, 0.5 * unit, &start));
    }
}

fn path(svg: &mut String, points: impl Iterator<Item = DVec2>, closed: bool) {
    for (i, p) in points.enumerate() {
        svg.push(if i == 0 { 'M' } else { 'L' });
        push_numbers(svg, &[p.x, -p.y], ' ');
    }
    if closed {
        svg.push('Z');
    }
}

/// A line without its colour and its end.
fn line(svg: &mut String, a: DVec2, b: DVec2, width: f64) {
    svg.push_str("<line");
    attributes(svg, &[("x1", a.x), ("y1", a.y), ("x2", b.x), ("y2", b.y), ("stroke-width", width)]);
}

fn dashes(unit: f64) -> String {
    let mut text = String::from(" stroke-dasharray=\"");
    push_numbers(&mut text, &[0.9 * unit, 0.8 * unit], ' ');
    text + "\""
}

fn dot(svg: &mut String, center: DVec2, radius: f64, colour: &str) {
    svg.push_str("<circle");
    attributes(svg, &[("cx", center.x), ("cy", center.y), ("r", radius)]);
    svg.push_str(&format!(" fill=\"{colour}\"/>\n"));
}

/// `rest` is everything from the last attributes on, escaped.
fn text(svg: &mut String, at: DVec2, size: f64, rest: &str) {
    svg.push_str("<text");
    attributes(svg, &[("x", at.x), ("y", at.y), ("font-size", size)]);
    svg.push_str(&format!(" fill=\"#111827\" {rest}</text>\n"));
}

fn attributes(svg: &mut String, values: &[(&str, f64)]) {
    for (name, value) in values {
        svg.push_str(&format!(" {name}=\""));
        push_fixed(svg, *value, 3);
        svg.push('"');
    }
}

fn push_numbers(svg: &mut String, values: &[f64], between: char) {
    for (i, value) in values.iter().enumerate() {
        if i > 0 {
            svg.push(between);
        }
        push_fixed(svg, *value, 3);
    }
}
