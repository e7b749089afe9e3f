//! plan.json, version 1: the plan as text, written layer by layer.

use crate::number::push_fixed;
use crate::plan::{Along, Header, Layer, Pass};
use planar::Ring;
use serde_json::json;

/// Version of the format.
pub const VERSION: u32 = 1;

/// Decimals of coordinates: the 0.1 µm grid of the plane.
const DECIMALS: usize = 4;

/// The text before the first layer.
pub fn head(header: &Header) -> String {
    let Header { part, profile, strategy, .. } = header;
    let fields = json!({ "part": part, "profile": profile, "strategy": strategy }).to_string();
    format!("{{\"version\":{VERSION},\"units\":\"mm\",{},\"layers\":[", &fields[1..fields.len() - 1])
}

/// The text of one layer; `first` tells whether a comma must come before it.
pub fn layer(layer: &Layer, first: bool) -> String {
    let points: usize = layer.passes.iter().map(|p| p.points.len()).sum();
    let mut text = String::with_capacity(256 + points * 28);
    text.push_str(if first { "\n" } else { ",\n" });
    text.push_str(&format!("{{\"index\":{},\"z\":", layer.index));
    push_fixed(&mut text, layer.z, DECIMALS);
    text.push_str(",\"height\":");
    push_fixed(&mut text, layer.height, DECIMALS);
    text.push_str(",\"islands\":");
    list(&mut text, &layer.islands, |text, island| {
        text.push_str("{\"outline\":");
        ring(text, &island.outer);
        text.push_str(",\"holes\":");
        list(text, &island.holes, ring);
        text.push('}');
    });
    text.push_str(",\"passes\":");
    list(&mut text, &layer.passes, pass);
    text.push('}');
    text
}

/// The text after the last layer.
pub fn tail() -> &'static str {
    "\n]}\n"
}

fn pass(text: &mut String, pass: &Pass) {
    text.push_str(&format!("{{\"kind\":\"{}\",\"closed\":{},\"points\":", pass.kind.name(), pass.closed));
    list(text, &pass.points, |text, p| numbers(text, &p.to_array()));
    text.push_str(",\"width\":");
    along(text, &pass.width);
    text.push_str(",\"speed\":");
    along(text, &pass.speed);
    text.push('}');
}

fn along(text: &mut String, along: &Along) {
    match along {
        Along::Same(value) => push_fixed(text, *value, DECIMALS),
        Along::Each(values) => numbers(text, values),
    }
}

fn ring(text: &mut String, ring: &Ring) {
    list(text, ring.points(), |text, p| numbers(text, &p.to_array()));
}

fn numbers(text: &mut String, values: &[f64]) {
    list(text, values, |text, v| push_fixed(text, *v, DECIMALS));
}

fn list<T>(text: &mut String, items: &[T], mut write: impl FnMut(&mut String, &T)) {
    text.push('[');
    for (i, item) in items.iter().enumerate() {
        if i > 0 {
            text.push(',');
        }
        write(text, item);
    }
    text.push(']');
}
