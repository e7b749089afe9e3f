//! The compact form of a layer in `report.html`: base64 of a fixed head and a deflated body.
//!
//! The head is [`HEAD`] numbers (f64, little-endian), so that the page can draw its chart without inflating anything:
//! z, height, slice area, planned area, deposited length, arc time, travel length, passes, warnings, lowest x and y,
//! size in x and y, resolution, points, judged area, void area, overfilled area. The body is a table of u32, the points
//! and the warnings:
//!
//! | table | |
//! | --- | --- |
//! | `n` | number of u32 that follow |
//! | islands, then for each: rings, points of each ring | outer ring first |
//! | passes, then for each: kind + 256 if closed + 512 if it varies, points, width, speed | width in µm, speed in µm/s; at every point if it varies |
//!
//! Points (rings, then passes) are Int16 differences from one to the next in units of the resolution, starting at the
//! lowest corner of the layer, in four planes: low bytes of x, high bytes of x, low bytes of y, high bytes of y. The
//! rest is JSON: the warnings as `[x, y, text, serious]`.
//!
//! The [height field](map) of a layer is base64 of a deflated body: lowest x and y, pixel, pixels in x and y (f64,
//! little-endian), then one byte per pixel as in [`Picture`].

use crate::deposit::{Figures, Picture};
use crate::layer::Layer;
use crate::pass::{Along, Pass, PassKind};
use crate::plan::is_jump;
use crate::process::Process;
use crate::warning::{Warning, WarningKind};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::DeflateEncoder;
use glam::{DVec2, I64Vec2};
use planar::{Bounds, Polygon, Ring};
use std::io::Write;

/// Numbers in the head; 18 × 8 bytes are 192 characters of base64, with nothing left over.
pub const HEAD: usize = 18;

/// Finest resolution of coordinates, mm.
const FINEST: f64 = 0.01;

/// A layer spans at most this many units, so that every difference fits in an Int16.
const SPAN: f64 = 32_000.0;

/// Maximum number of warnings listed for one layer.
const MOST_WARNINGS: usize = 30;

/// One layer, and what the deposit model says about it, as base64. It does not depend on other layers, so callers may
/// encode several in parallel.
pub fn layer(layer: &Layer, process: &Process, figures: Option<&Figures>) -> String {
    let process = process.at_layer(layer.index);
    encoded(layer, figures, &|pace| process.speed_at(pace))
}

/// One layer as it is, with paces in place of the torch's speeds.
pub fn shape(layer: &Layer) -> String {
    encoded(layer, None, &|pace| pace)
}

/// `speed` gives the speed of the torch at a pace, mm/s.
fn encoded(layer: &Layer, figures: Option<&Figures>, speed: &dyn Fn(f64) -> f64) -> String {
    let bounds = Bounds::of(points(layer)).unwrap_or(Bounds { min: DVec2::ZERO, max: DVec2::ZERO });
    let resolution = (bounds.size().max_element() / SPAN).max(FINEST);
    let bytes = head(layer, speed, figures, &bounds, resolution).iter().flat_map(|v| v.to_le_bytes()).collect();
    STANDARD.encode(deflate(bytes, &body(layer, speed, bounds.min, resolution)))
}

fn points(layer: &Layer) -> impl Iterator<Item = DVec2> + '_ {
    let rings = layer.islands.iter().flat_map(Polygon::rings).flat_map(Ring::points).copied();
    rings.chain(layer.passes.iter().flat_map(|pass| &pass.points).map(|p| p.truncate()))
}

fn head(
    layer: &Layer,
    speed: &dyn Fn(f64) -> f64,
    figures: Option<&Figures>,
    bounds: &Bounds,
    resolution: f64,
) -> [f64; HEAD] {
    let size = bounds.size();
    let length = |pass: &Pass| pass.segments().filter(|s| !is_jump(s)).map(|s| s.length()).sum::<f64>();
    let seconds = |pass: &Pass| pass.segments().map(|s| s.length() / speed(s.pace)).sum::<f64>();
    let figures = figures.copied().unwrap_or_default();
    [
        layer.z,
        layer.height,
        layer.slice_area,
        layer.planned_area,
        layer.passes.iter().map(length).sum(),
        layer.passes.iter().map(seconds).sum(),
        super::travels(layer).map(|(from, to)| from.distance(to)).sum(),
        layer.passes.len() as f64,
        layer.warnings.len() as f64,
        bounds.min.x,
        bounds.min.y,
        size.x,
        size.y,
        resolution,
        points(layer).count() as f64,
        figures.area,
        figures.void,
        figures.overfill,
    ]
}

/// A height field as base64.
pub fn map(picture: &Picture) -> String {
    let head = [picture.low.x, picture.low.y, picture.pixel, picture.width as f64, picture.height as f64];
    let mut bytes: Vec<u8> = head.iter().flat_map(|v| v.to_le_bytes()).collect();
    bytes.extend(&picture.values);
    STANDARD.encode(deflate(Vec::new(), &bytes))
}

fn body(layer: &Layer, speed: &dyn Fn(f64) -> f64, origin: DVec2, resolution: f64) -> Vec<u8> {
    let table = table(layer, speed);
    let mut bytes = Vec::with_capacity(4 * table.len() + 4 * points(layer).count() + 256);
    bytes.extend((table.len() as u32).to_le_bytes());
    bytes.extend(table.iter().flat_map(|v| v.to_le_bytes()));
    let differences = differences(layer, origin, resolution);
    bytes.extend(differences.iter().map(|d| d[0].to_le_bytes()[0]));
    bytes.extend(differences.iter().map(|d| d[0].to_le_bytes()[1]));
    bytes.extend(differences.iter().map(|d| d[1].to_le_bytes()[0]));
    bytes.extend(differences.iter().map(|d| d[1].to_le_bytes()[1]));
    bytes.extend(warnings(&layer.warnings).to_string().into_bytes());
    bytes
}

fn table(layer: &Layer, speed: &dyn Fn(f64) -> f64) -> Vec<u32> {
    let mut table = vec![layer.islands.len() as u32];
    for island in &layer.islands {
        table.push(island.rings().count() as u32);
        table.extend(island.rings().map(|ring| ring.points().len() as u32));
    }
    table.push(layer.passes.len() as u32);
    for pass in &layer.passes {
        let varies = matches!((&pass.width, &pass.pace), (Along::Each(_), _) | (_, Along::Each(_)));
        let flags = if pass.closed { 256 } else { 0 } + if varies { 512 } else { 0 };
        table.extend([kind(pass.kind) + flags, pass.points.len() as u32]);
        for i in 0..if varies { pass.points.len() } else { 1 } {
            let values = [pass.width.after(i), speed(pass.pace.after(i))];
            table.extend(values.map(|value| (value * 1e3).round() as u32));
        }
    }
    table
}

/// The number of a kind in the page.
fn kind(kind: PassKind) -> u32 {
    match kind {
        PassKind::Contour => 0,
        PassKind::Infill => 1,
        PassKind::Skeleton => 2,
        PassKind::Wall | PassKind::Spot => 3,
    }
}

fn differences(layer: &Layer, origin: DVec2, resolution: f64) -> Vec<[i16; 2]> {
    let mut last = I64Vec2::ZERO;
    let step = |p: DVec2| {
        // A cast rounds down what is not negative.
        let at = ((p - origin) / resolution + 0.5).as_i64vec2();
        let difference = at - std::mem::replace(&mut last, at);
        [difference.x as i16, difference.y as i16]
    };
    points(layer).map(step).collect()
}

/// Bytes as base64 of what they deflate to.
pub(super) fn deflated(bytes: &[u8]) -> String {
    STANDARD.encode(deflate(Vec::new(), bytes))
}

fn deflate(head: Vec<u8>, body: &[u8]) -> Vec<u8> {
    let mut encoder = DeflateEncoder::new(head, Compression::fast());
    // Writing into memory does not fail.
    let written = encoder.write_all(body).and_then(|()| encoder.finish());
    written.unwrap_or_default()
}

fn warnings(warnings: &[Warning]) -> serde_json::Value {
    let round = |v: f64| (v * 100.0).round() / 100.0;
    let first = warnings.iter().take(MOST_WARNINGS);
    first.map(|w| serde_json::json!([round(w.place.x), round(w.place.y), short(w), w.kind.forbids()])).collect()
}

/// A warning in a few words, without its place.
fn short(warning: &Warning) -> String {
    let size = warning.size;
    match warning.kind {
        WarningKind::GapClosed => format!("gap of {size:.3} mm bridged"),
        WarningKind::OpenContourDropped => format!("open contour of {size:.1} mm dropped"),
        WarningKind::ContoursUnited => format!("contours united, {size:.1} mm² changed"),
        WarningKind::ThinFeature => format!("{size:.1} mm² narrower than a bead left empty"),
        WarningKind::ThinWall => format!("{size:.1} mm² of wall thinner than the narrowest bead"),
        WarningKind::Refilled => format!("island of {size:.1} mm² filled by another strategy"),
        WarningKind::IslandTooSmall => format!("island of {size:.1} mm² left out"),
        WarningKind::PassTooShort => format!("pass of {size:.1} mm left out"),
        WarningKind::Bare => format!("{size:.1} mm² of an island left bare"),
        WarningKind::Undersize => format!("{size:.1} mm² without metal at the part's faces"),
        WarningKind::Unsound => "passes leave the part or cross".to_owned(),
        WarningKind::HighStart => format!("first bead {size:.2} mm above the plate"),
        WarningKind::NothingBelow => format!("nothing below, {size:.2} mm above the last bead"),
        WarningKind::InTheAir => format!("{size:.1} mm of a pass over nothing"),
        WarningKind::OverUnwelded => format!("{size:.1} mm of a pass above what got no bead"),
        WarningKind::HangingIsland => format!("hanging island of {size:.1} mm² left out"),
        WarningKind::LayerThickness => format!("{size:.2} mm too thin or too thick"),
        WarningKind::Overhang => format!("{size:.1} mm² overhang the layer below"),
        WarningKind::ShortArc => format!("pass of {size:.1} mm ends before its arc is steady"),
        WarningKind::Relit => format!("pass longer than a program: arc struck again {size:.0} times"),
        WarningKind::ManyPoints => format!("{size:.0} points, more than check.max_points"),
        WarningKind::Sliver => format!("sliver of {size:.2} mm² left out"),
        WarningKind::NeverCools => format!("does not cool, {size:.0} °C"),
        WarningKind::HotAhead => format!("{size:.0} °C ahead of the torch"),
        WarningKind::Paused => "pass cut, the torch waits".to_owned(),
        WarningKind::TooCold => format!("too cold, {size:.0} °C"),
        WarningKind::EmptyLayer => "nothing to deposit".to_owned(),
    }
}
