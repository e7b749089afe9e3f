//! One layer as a file of its own: outlines, and a segment for each pass.

use super::style::{Style, Styles, Values};
use super::{BETWEEN, OVERLAP, OWN, units};
use crate::export::walk::Run;
use crate::layer::Layer;
use crate::model::package::TOOLPATH;
use crate::number::fixed;
use crate::program::Attitude;
use glam::{DVec2, DVec3};
use planar::Polygon;
use std::collections::BTreeMap;
use uuid::Uuid;

/// The lines of a run: the values of each, and the tag of the point at its end (0 for none).
pub(super) fn lines(run: &Run<'_>) -> (Vec<Values>, Vec<u32>) {
    let mut own = run.pass.segments().peekable();
    let mut pace = own.peek().map_or(0.0, |segment| segment.pace);
    let line = |piece: &crate::export::Piece| {
        let tag = match own.peek() {
            None => OVERLAP,
            Some(segment) => {
                pace = segment.pace;
                if segment.to == piece.to { 0 } else { BETWEEN }
            }
        };
        if tag == 0 {
            own.next();
        }
        ([piece.width, piece.speed, pace, piece.feed], tag)
    };
    run.pieces.iter().map(line).unzip()
}

/// The file of a layer with its runs and the lines of each.
pub(super) fn xml(layer: &Layer, runs: &[(&Run<'_>, Vec<Values>, Vec<u32>)], styles: &Styles, item: Uuid) -> String {
    let points: usize = runs.iter().map(|(run, ..)| run.pieces.len() + 1).sum();
    let mut text = String::with_capacity(1024 + 90 * points);
    text.push_str(&format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<layer xmlns=\"{TOOLPATH}\" xmlns:bw=\"{OWN}\">\n\
         <parts><part id=\"1\" uuid=\"{item}\"/></parts>\n<profiles>\n"
    ));
    let used: BTreeMap<usize, Uuid> = runs.iter().filter_map(|(run, ..)| styles.number(&Style::of(run))).collect();
    for (number, uuid) in used {
        text.push_str(&format!("<profile id=\"{number}\" uuid=\"{uuid}\"/>\n"));
    }
    text.push_str("</profiles>\n");
    data(&mut text, layer);
    text.push_str("<segments>\n");
    for (run, values, tags) in runs {
        segment(&mut text, run, values, tags, styles);
    }
    text.push_str("</segments>\n</layer>\n");
    text
}

/// What the extension cannot express: where the layer lies, and its outlines.
fn data(text: &mut String, layer: &Layer) {
    let (z, height) = (units(layer.z), units(layer.height));
    let goes_on = if layer.lit.after { " goes_on=\"1\"" } else { "" };
    text.push_str(&format!("<data>\n<bw:layer z=\"{z}\" height=\"{height}\"{goes_on}/>\n"));
    for island in &layer.islands {
        for (ring, name) in Polygon::rings(island).zip(std::iter::once("outline").chain(std::iter::repeat("hole"))) {
            let numbers: Vec<String> = ring.points().iter().map(|p| format!("{} {}", units(p.x), units(p.y))).collect();
            text.push_str(&format!("<bw:{name} points=\"{}\"/>\n", numbers.join(" ")));
        }
    }
    text.push_str("</data>\n");
}

fn segment(text: &mut String, run: &Run<'_>, values: &[Values], tags: &[u32], styles: &Styles) {
    let Some((profile, _)) = styles.number(&Style::of(run)) else { return };
    let microseconds = |seconds: f64| (seconds * 1e6).round() as u64;
    let time = microseconds(run.pieces.iter().map(|piece| piece.seconds).sum());
    let (travel, axes) = (microseconds(run.travel), if styles.leaning { 6 } else { 3 });
    text.push_str(&format!(
        "<segment type=\"polyline{axes}d\" profileid=\"{profile}\" partid=\"1\" timeprediction=\"{time}\" \
         jumpprediction=\"{travel}\""
    ));
    if run.pass.wait > 0.0 {
        text.push_str(&format!(" bw:wait=\"{}\"", microseconds(run.pass.wait)));
    }
    text.push_str(if run.pass.closed { " bw:closed=\"1\">\n" } else { ">\n" });
    let lean = |i: usize| styles.leaning.then(|| run.leans.get(i).copied().unwrap_or_default());
    run.pieces.first().into_iter().for_each(|piece| {
        point(text, piece.from, lean(0));
        text.push_str("/>\n");
    });
    for (i, ((piece, values), tag)) in (1..).zip(run.pieces.iter().zip(values).zip(tags)) {
        point(text, piece.to, lean(i));
        if *tag > 0 {
            text.push_str(&format!(" tag=\"{tag}\""));
        }
        styles.factors(text, values);
        text.push_str("/>\n");
    }
    text.push_str("</segment>\n");
}

/// The beginning of a point element, with the torch's orientation where it leans.
fn point(text: &mut String, at: DVec3, lean: Option<DVec2>) {
    let name = if lean.is_some() { "point6d" } else { "point3d" };
    text.push_str(&format!("<{name} x=\"{}\" y=\"{}\" z=\"{}\"", units(at.x), units(at.y), units(at.z)));
    if let Some(lean) = lean {
        let q = Attitude { lean, ..Attitude::default() }.rotation();
        for (key, value) in [("i", q.x), ("j", q.y), ("k", q.z), ("w", q.w)] {
            text.push_str(&format!(" {key}=\"{}\"", fixed(value, 9)));
        }
    }
}
