//! Beads as VTK's XML poly data: one line per piece, with its values; numbers as base64 of little-endian bytes.
//!
//! In ParaView, the filter Tube with the radius by `width` shows the beads.

use super::{Beads, ExportError, Format, Piece};
use crate::palette;
use crate::pass::PassKind;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;

pub(super) const FORMAT: Format =
    Format { extension: "vtp", purpose: "lines with values, for ParaView and VTK", write };

/// The numbers that stand for the kinds of passes.
const KINDS: [PassKind; 5] = [PassKind::Contour, PassKind::Infill, PassKind::Skeleton, PassKind::Wall, PassKind::Spot];

fn write(beads: &Beads<'_>) -> Result<Vec<u8>, ExportError> {
    let pieces = beads.pieces();
    let mut text = format!(
        "<?xml version=\"1.0\"?>\n<!-- mm, s; kind: 0 contour, 1 infill, 2 skeleton, 3 wall, 4 spot; colour: of the kind -->\n\
         <VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<PolyData>\n\
         <Piece NumberOfPoints=\"{}\" NumberOfLines=\"{}\">\n<Points>\n",
        2 * pieces.len(),
        pieces.len()
    );
    let places = pieces.iter().flat_map(|p| [p.from, p.to]).flat_map(|at| at.to_array());
    push(&mut text, "type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\"", places.flat_map(f64::to_le_bytes));
    text.push_str("</Points>\n<Lines>\n");
    let ends = |step: i64| (1..=pieces.len() as i64).map(move |k| step * k);
    push(&mut text, "type=\"Int64\" Name=\"connectivity\"", (0..2 * pieces.len() as i64).flat_map(i64::to_le_bytes));
    push(&mut text, "type=\"Int64\" Name=\"offsets\"", ends(2).flat_map(i64::to_le_bytes));
    text.push_str("</Lines>\n<CellData Scalars=\"width\">\n");
    let mut column = |name: &str, value: fn(&Piece) -> f64| {
        let kind = format!("type=\"Float64\" Name=\"{name}\"");
        push(&mut text, &kind, pieces.iter().flat_map(|p| value(p).to_le_bytes()));
    };
    column("width", |p| p.width);
    column("height", |p| p.height);
    column("speed", |p| p.speed);
    column("pace", |p| p.pace);
    column("wire feed", |p| p.feed);
    column("start", |p| p.start);
    column("time", |p| p.seconds);
    if beads.heat.is_some() {
        column("temperature", |p| p.temperature);
    }
    let mut number = |name: &str, value: fn(&Piece) -> usize| {
        let kind = format!("type=\"Int32\" Name=\"{name}\"");
        push(&mut text, &kind, pieces.iter().flat_map(|p| (value(p) as i32).to_le_bytes()));
    };
    number("layer", |p| p.layer);
    number("pass", |p| p.pass);
    number("kind", |p| KINDS.iter().position(|kind| *kind == p.kind).unwrap_or_default());
    // As bytes, so that viewers show it without a map.
    let colours = pieces.iter().flat_map(|p| palette::kind(p.kind));
    push(&mut text, "type=\"UInt8\" Name=\"colour\" NumberOfComponents=\"3\"", colours);
    if !beads.profile.layers.are_level() {
        let normals = pieces.iter().flat_map(|p| p.normal.to_array()).flat_map(f64::to_le_bytes);
        push(&mut text, "type=\"Float64\" Name=\"normal\" NumberOfComponents=\"3\"", normals);
    }
    text.push_str("</CellData>\n</Piece>\n</PolyData>\n</VTKFile>\n");
    Ok(text.into_bytes())
}

/// An array: the number of its bytes, then the bytes, in one base64 text.
fn push(text: &mut String, attributes: &str, bytes: impl Iterator<Item = u8>) {
    let mut data = vec![0; 8];
    data.extend(bytes);
    let length = (data.len() - 8) as u64;
    data[..8].copy_from_slice(&length.to_le_bytes());
    text.push_str(&format!("<DataArray {attributes} format=\"binary\">\n"));
    STANDARD.encode_string(data, text);
    text.push_str("\n</DataArray>\n");
}
