//! A layer as a picture for documents: the SVG drawing on white, drawn by resvg.

use super::{ExportError, LayerFormat, svg};
use crate::layer::Layer;
use resvg::tiny_skia::{Color, Pixmap, Transform};
use resvg::usvg::{Options, Tree};

pub(super) const FORMAT: LayerFormat =
    LayerFormat { extension: "png", purpose: "a picture of a layer, for documents", write };

/// The longer side, pixels.
const PIXELS: f32 = 1600.0;

fn write(layer: &Layer) -> Result<Vec<u8>, ExportError> {
    let failed = |reason: &dyn std::fmt::Display| ExportError::Picture(reason.to_string());
    let tree = Tree::from_str(&svg::drawing(layer), &Options::default()).map_err(|error| failed(&error))?;
    let size = tree.size();
    let scale = PIXELS / size.width().max(size.height());
    let [width, height] = [size.width(), size.height()].map(|side| (side * scale).ceil().max(1.0) as u32);
    let mut pixels = Pixmap::new(width, height).ok_or_else(|| failed(&"it has no size"))?;
    pixels.fill(Color::WHITE);
    resvg::render(&tree, Transform::from_scale(scale, scale), &mut pixels.as_mut());
    pixels.encode_png().map_err(|error| failed(&error))
}
