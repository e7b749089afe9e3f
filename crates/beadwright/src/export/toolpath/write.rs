//! The package: the model file with profiles and the list of layers, the layers, and what binds them.

use super::style::{Styles, Values};
use super::{OWN, UNIT_MM, layer};
use crate::export::archive::{Archive, MODEL, relationships};
use crate::export::walk::Run;
use crate::export::{Beads, ExportError};
use crate::model::package::{PRODUCTION, TOOLPATH};
use crate::number::fixed;
use crate::plan_file;
use crate::report::escape;
use glam::DVec3;
use uuid::Uuid;

pub(super) fn write(beads: &Beads<'_>) -> Result<Vec<u8>, ExportError> {
    if let Some(chart) = beads.profile.layers.charts().find(|chart| !chart.is_level()) {
        return Err(ExportError::NotLevel(chart.name()));
    }
    let runs = beads.runs();
    let (values, tags): (Vec<Vec<Values>>, Vec<Vec<u32>>) = runs.iter().map(layer::lines).unzip();
    let nominal = [beads.profile.bead.width, beads.profile.process.deposition_speed];
    let ids = Ids::of(beads);
    let styles = Styles::new(&runs, &values, [nominal[0], nominal[1], nominal[1], 1.0], ids.file);
    let box_of_beads = extent(&runs).ok_or(ExportError::Empty)?;

    let mut package = Archive::new()?;
    package.add(MODEL, &model(beads, &styles, &ids, box_of_beads))?;
    let kind = format!("{TOOLPATH}/layer");
    let targets = (0..beads.layers.len()).map(|index| (kind.as_str(), layer_path(index)));
    package.add("3D/_rels/3dmodel.model.rels", &relationships(targets))?;
    let mut lines = runs.iter().zip(values).zip(tags).map(|((run, values), tags)| (run, values, tags)).peekable();
    for (index, layer) in beads.layers.iter().enumerate() {
        let mut here = Vec::new();
        while let Some(line) = lines.next_if(|(run, ..)| std::ptr::eq(run.layer, layer)) {
            here.push(line);
        }
        package.add(&layer_path(index), &layer::xml(layer, &here, &styles, ids.item))?;
    }
    package.finish()
}

/// The path of the file of the layer with this index, from 0.
fn layer_path(index: usize) -> String {
    format!("/Toolpath/Layers/layer{:05}.xml", index + 1)
}

/// The identifiers in a file: the same plan always has the same ones.
struct Ids {
    file: Uuid,
    object: Uuid,
    build: Uuid,
    item: Uuid,
}

impl Ids {
    fn of(beads: &Beads<'_>) -> Self {
        let own = Uuid::new_v5(&Uuid::NAMESPACE_URL, OWN.as_bytes());
        let head = Uuid::new_v5(&own, plan_file::head(beads.header, beads.profile).as_bytes());
        let next = |id: Uuid, layer| Uuid::new_v5(&id, plan_file::layer(layer, None).as_bytes());
        let file = beads.layers.iter().fold(head, next);
        let of = |name: &str| Uuid::new_v5(&file, name.as_bytes());
        Self { file, object: of("object"), build: of("build"), item: of("item") }
    }
}

/// The lowest and highest corner of the metal, mm; `None` without any metal.
fn extent(runs: &[Run<'_>]) -> Option<(DVec3, DVec3)> {
    let pieces = || runs.iter().flat_map(|run| &run.pieces);
    pieces().next()?;
    let ends = || pieces().flat_map(|piece| [(piece.from, piece), (piece.to, piece)]);
    let low = ends().map(|(at, p)| at - DVec3::new(p.width / 2.0, p.width / 2.0, p.height));
    let high = ends().map(|(at, p)| at + DVec3::new(p.width / 2.0, p.width / 2.0, 0.0));
    Some((low.fold(DVec3::INFINITY, DVec3::min), high.fold(DVec3::NEG_INFINITY, DVec3::max)))
}

/// The model file. Its object, which a build needs, is the box around all beads.
fn model(beads: &Beads<'_>, styles: &Styles, ids: &Ids, around: (DVec3, DVec3)) -> String {
    let part = escape(&beads.header.part);
    let mut text = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
         <model unit=\"millimeter\" xml:lang=\"en-US\" xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\" \
         xmlns:p=\"{PRODUCTION}\" xmlns:tp=\"{TOOLPATH}\" xmlns:bw=\"{OWN}\" requiredextensions=\"p tp\">\n\
         <metadata name=\"Title\">{part}</metadata>\n<metadata name=\"Application\">Beadwright {}</metadata>\n<resources>\n\
         <tp:toolpathresource id=\"1\" uuid=\"{}\" unitfactor=\"{}\" toolpathtype=\"{}\">\n",
        env!("CARGO_PKG_VERSION"),
        ids.file,
        fixed(UNIT_MM, 4),
        if styles.leaning { "6axis" } else { "3axis" },
    );
    text.push_str(&styles.xml());
    text.push_str("<tp:toolpathlayers>\n");
    for index in 0..beads.layers.len() {
        text.push_str(&format!("<tp:toolpathlayer path=\"{}\"/>\n", layer_path(index)));
    }
    let (strategy, profile) = (escape(&beads.header.strategy), escape(&serde_json::json!(beads.profile).to_string()));
    let (low, high) = (beads.header.extent.low.to_array(), beads.header.extent.high.to_array());
    let bounds = low.iter().chain(&high).map(f64::to_string).collect::<Vec<_>>().join(" ");
    text.push_str(&format!(
        "</tp:toolpathlayers>\n<tp:toolpathdata><bw:plan part=\"{part}\" strategy=\"{strategy}\" profile=\"{profile}\" bounds=\"{bounds}\"/>\
         </tp:toolpathdata>\n</tp:toolpathresource>\n<object id=\"2\" p:UUID=\"{}\" type=\"model\" name=\"{part}: box around its \
         beads\">\n",
        ids.object
    ));
    mesh(&mut text, around);
    text.push_str(&format!(
        "</object>\n</resources>\n<build p:UUID=\"{}\" tp:toolpathid=\"1\">\n<item objectid=\"2\" p:UUID=\"{}\"/>\n</build>\n\
         </model>\n",
        ids.build, ids.item
    ));
    text
}

/// A box as a mesh.
fn mesh(text: &mut String, (low, high): (DVec3, DVec3)) {
    const SIDES: [[u8; 4]; 6] = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    text.push_str("<mesh>\n<vertices>\n");
    for corner in 0..8 {
        let side = |axis: usize| if corner >> axis & 1 == 1 { high[axis] } else { low[axis] };
        let [x, y, z] = [0, 1, 2].map(|axis| fixed(side(axis), 4));
        text.push_str(&format!("<vertex x=\"{x}\" y=\"{y}\" z=\"{z}\"/>\n"));
    }
    text.push_str("</vertices>\n<triangles>\n");
    for [a, b, c, d] in SIDES {
        for [a, b, c] in [[a, b, c], [a, c, d]] {
            text.push_str(&format!("<triangle v1=\"{a}\" v2=\"{b}\" v3=\"{c}\"/>\n"));
        }
    }
    text.push_str("</triangles>\n</mesh>\n");
}
