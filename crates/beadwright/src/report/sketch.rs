//! Plain pictures of areas and lines, for the steps of a strategy.

use super::escape;
use crate::number::fixed;
use crate::palette::{Rgb, hex};
use glam::DVec2;
use planar::{Bounds, Region};

/// A picture put together shape by shape, y upwards.
#[derive(Debug, Clone)]
pub struct Sketch {
    bounds: Bounds,
    title: String,
    body: String,
}

impl Sketch {
    /// An empty picture of the plane within `bounds`.
    pub fn new(bounds: Bounds, title: &str) -> Self {
        Self { bounds, title: title.to_owned(), body: String::new() }
    }

    /// A filled region.
    pub fn region(&mut self, region: &Region, colour: Rgb) -> &mut Self {
        let colour = hex(colour);
        let rings: String = region.rings().map(|ring| path(ring.points(), true)).collect();
        self.body += &format!("<path fill=\"{colour}\" fill-rule=\"evenodd\" d=\"{rings}\"/>\n");
        self
    }

    /// A line of this `width`, mm.
    pub fn line(&mut self, points: &[DVec2], closed: bool, colour: Rgb, width: f64) -> &mut Self {
        let (line, colour, width) = (path(points, closed), hex(colour), fixed(width, 3));
        self.body += &format!("<path fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\" d=\"{line}\"/>\n");
        self
    }

    /// The picture.
    pub fn svg(&self) -> String {
        let (low, size) = (self.bounds.min, self.bounds.size());
        let edge = 0.03 * size.max_element();
        let unit = size.max_element() / 30.0;
        let numbers = [
            low.x - edge,
            -self.bounds.max.y - edge - 1.5 * unit,
            size.x + 2.0 * edge,
            size.y + 2.0 * edge + 1.5 * unit,
        ];
        let title = escape(&self.title);
        let view = numbers.map(|v| fixed(v, 3)).join(" ");
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"{view}\" class=\"plot\" role=\"img\" aria-label=\"{title}\" stroke-linejoin=\"round\" \
             stroke-linecap=\"round\" font-family=\"system-ui, sans-serif\">\n<text x=\"{}\" y=\"{}\" font-size=\"{}\" \
             font-weight=\"600\">{title}</text>\n{}</svg>\n",
            fixed(low.x, 3),
            fixed(-self.bounds.max.y - edge, 3),
            fixed(unit, 3),
            self.body
        )
    }
}

fn path(points: &[DVec2], closed: bool) -> String {
    let mut text = String::with_capacity(points.len() * 16);
    for (i, p) in points.iter().enumerate() {
        text += if i == 0 { "M" } else { "L" };
        text += &format!("{} {}", fixed(p.x, 3), fixed(-p.y, 3));
    }
    if closed { text + "Z" } else { text }
}
