//! SVG drawings: filled shapes and closed lines, as `usvg` resolves them (shapes, styles, transforms, units).
//!
//! y runs downwards in SVG and upwards in a part. If the picture's width is given in mm, cm or inches, so are the
//! coordinates; otherwise one unit of the picture is one unit of the file, and the user says which.

use super::super::{ImportError, Units};
use super::{Outlines, check_points};
use glam::DVec2;
use planar::{FillRule, MAX_COORDINATE_MM, Region, Ring};
use usvg::tiny_skia_path::{PathSegment, Point};
use usvg::{Group, Node, Path, Tree};

/// Curves lie within this fraction of the picture's extent from their chords.
const FLATNESS: f64 = 2e-5;

/// Pixels in a millimetre, according to CSS.
const PX_PER_MM: f64 = 96.0 / 25.4;

/// A line is closed if its ends are this near, as a fraction of the picture's extent.
const CLOSED: f64 = 1e-5;

fn broken(reason: impl Into<String>) -> ImportError {
    ImportError::Broken { format: "SVG", reason: reason.into() }
}

pub(super) fn is_svg(bytes: &[u8]) -> bool {
    let head = String::from_utf8_lossy(&bytes[..bytes.len().min(4096)]);
    let head = head.trim_start_matches('\u{feff}').trim_start();
    head.starts_with("<svg") || (head.starts_with("<?xml") || head.starts_with("<!")) && head.contains("<svg")
}

pub(super) fn read(bytes: &[u8]) -> Result<Outlines, ImportError> {
    let tree = Tree::from_data(bytes, &options()).map_err(|error| broken(error.to_string()))?;
    let size = DVec2::new(tree.size().width().into(), tree.size().height().into());
    let scale = if in_lengths(bytes) { 1.0 / PX_PER_MM } else { 1.0 };
    let mut reader = Reader { height: size.y, flatness: FLATNESS * size.max_element(), rings: Vec::new(), points: 0 };
    reader.group(tree.root())?;
    let scaled = |ring: Ring| Ring::new(ring.points().iter().map(|p| *p * scale).collect());
    let units = in_lengths(bytes).then_some(Units::Millimetre);
    Ok(Outlines { rings: reader.rings.into_iter().map(scaled).collect(), format: "SVG", units, notes: notes(bytes) })
}

/// Embedded pictures are not read, least of all from disk.
fn options() -> usvg::Options<'static> {
    let image_href_resolver =
        usvg::ImageHrefResolver { resolve_data: Box::new(|_, _, _| None), resolve_string: Box::new(|_, _| None) };
    usvg::Options { image_href_resolver, ..usvg::Options::default() }
}

/// Elements without an outline, as sentences.
fn notes(bytes: &[u8]) -> Vec<String> {
    let text = String::from_utf8_lossy(bytes);
    let count = |tag: &str| text.matches(tag).count();
    let counted = [("text", count("<text")), ("image", count("<image"))].into_iter().filter(|(_, count)| *count > 0);
    counted.map(|(name, count)| format!("{count} × {name} in the drawing passed over.")).collect()
}

/// Whether the width of the picture is a length, rather than pixels or a percentage.
fn in_lengths(bytes: &[u8]) -> bool {
    let text = String::from_utf8_lossy(bytes);
    let tag = text.split("<svg").nth(1).and_then(|rest| rest.split('>').next()).unwrap_or_default();
    let width = tag.split_whitespace().find_map(|word| word.strip_prefix("width=")).unwrap_or_default();
    let width = width.trim_matches(['"', '\'', '/']);
    ["mm", "cm", "in", "pt", "pc", "Q"].iter().any(|unit| width.ends_with(unit))
}

struct Reader {
    /// Height of the picture, px.
    height: f64,
    /// Greatest distance of a curve from its chords, px.
    flatness: f64,
    rings: Vec<Ring>,
    /// Points found.
    points: usize,
}

impl Reader {
    fn group(&mut self, group: &Group) -> Result<(), ImportError> {
        for node in group.children() {
            match node {
                Node::Group(group) => self.group(group)?,
                Node::Path(path) if path.is_visible() => self.path(path)?,
                Node::Path(_) | Node::Image(_) | Node::Text(_) => {}
            }
        }
        Ok(())
    }

    fn path(&mut self, path: &Path) -> Result<(), ImportError> {
        let placed = path.data().clone().transform(path.abs_transform());
        let placed = placed.ok_or_else(|| broken(format!("the path \"{}\" lies out of bounds", path.id())))?;
        let mut lines =
            Lines { height: self.height, flatness: self.flatness, done: Vec::new(), open: Vec::new(), points: 0 };
        for segment in placed.segments() {
            lines.segment(segment);
            check_points(self.points + lines.points, "SVG")?;
        }
        self.points += lines.points;
        lines.end(false);
        let near = CLOSED / FLATNESS * self.flatness;
        let rule = path.fill().map(|fill| fill.rule());
        let mut rings = Vec::new();
        for (points, closed) in lines.done {
            let (Some(&first), Some(&last)) = (points.first(), points.last()) else { continue };
            // A filled shape is closed, whether drawn so or not.
            if !closed && rule.is_none() && first.distance(last) > near {
                return Err(broken(format!(
                    "the line \"{}\" from ({:.2}, {:.2}) to ({:.2}, {:.2}) px is not closed: close it, fill it or delete it",
                    path.id(),
                    first.x,
                    self.height - first.y,
                    last.x,
                    self.height - last.y
                )));
            }
            // Beyond this lies the end of the 2-D grid.
            if points.iter().any(|p| p.abs().max_element() > MAX_COORDINATE_MM) {
                return Err(broken(format!("the path \"{}\" lies out of bounds", path.id())));
            }
            rings.push(Ring::new(points));
        }
        let rule = match rule {
            Some(usvg::FillRule::NonZero) => FillRule::NonZero,
            _ => FillRule::EvenOdd,
        };
        self.rings.extend(Region::from_rings(&rings, rule).rings().cloned());
        Ok(())
    }
}

/// The lines of a path with its curves divided; y upwards, px.
struct Lines {
    height: f64,
    flatness: f64,
    /// Points, and whether they were closed.
    done: Vec<(Vec<DVec2>, bool)>,
    open: Vec<DVec2>,
    points: usize,
}

impl Lines {
    fn at(&self, p: Point) -> DVec2 {
        DVec2::new(p.x.into(), self.height - f64::from(p.y))
    }

    fn segment(&mut self, segment: PathSegment) {
        match segment {
            PathSegment::MoveTo(p) => {
                self.end(false);
                let at = self.at(p);
                self.open.push(at);
            }
            PathSegment::LineTo(p) => {
                let at = self.at(p);
                self.open.push(at);
            }
            PathSegment::QuadTo(a, b) => {
                let [a, b] = [a, b].map(|p| self.at(p));
                // The same curve as a cubic.
                let from = self.open.last().copied().unwrap_or(a);
                self.cubic(from.lerp(a, 2.0 / 3.0), b.lerp(a, 2.0 / 3.0), b);
            }
            PathSegment::CubicTo(a, b, c) => {
                let [a, b, c] = [a, b, c].map(|p| self.at(p));
                self.cubic(a, b, c);
            }
            PathSegment::Close => self.end(true),
        }
    }

    /// Adds a curve as chords within the flatness, their number from the second differences of its points.
    fn cubic(&mut self, a: DVec2, b: DVec2, c: DVec2) {
        let from = self.open.last().copied().unwrap_or(a);
        let bend = (from - 2.0 * a + b).length().max((a - 2.0 * b + c).length());
        let count = (0.75 * bend / self.flatness).sqrt().ceil().clamp(1.0, 1e3) as usize;
        self.points += count;
        for k in 1..=count {
            let t = k as f64 / count as f64;
            let s = 1.0 - t;
            self.open.push(s * s * s * from + 3.0 * s * s * t * a + 3.0 * s * t * t * b + t * t * t * c);
        }
    }

    fn end(&mut self, closed: bool) {
        let points = std::mem::take(&mut self.open);
        // After a close command, a path continues from its beginning.
        let first = points.first().copied().filter(|_| closed);
        if points.len() > 1 {
            self.done.push((points, closed));
        }
        self.open.extend(first);
    }
}
