//! A program read back becomes layers that the deposit model can judge, over the slices of the part it was made for.

use crate::bead::Law;
use crate::deposit::DepositSettings;
use crate::dialect::reading::{ReadLayer, ReadPass, ReadProgram};
use crate::layer::Layer;
use crate::model::Mesh;
use crate::pass::{Along, Pass};
use crate::process::Process;
use crate::slice::{Slab, SliceOptions, Slicer};
use crate::task::{Cancelled, Task};
use glam::DVec2;
use planar::Bounds;

/// The passes of a program by layer. The width of a piece is the first of these that is known: `width`; where the
/// program gives the volume, as printers do, the width of a bead of the layer's height with that volume; the width that
/// the program gives; the width that the bead law gives at the program's speed; the nominal width. Its pace follows
/// from the volume where the program gives that; otherwise from the program's speed, with the wire feed that `process` has in
/// the layer: wire feeds are not read from programs.
pub fn layers(
    program: &ReadProgram,
    settings: &DepositSettings,
    law: &Law,
    process: &Process,
    width: Option<f64>,
) -> Vec<Layer> {
    let read = program.layers();
    let layer = |(index, read): (usize, ReadLayer)| {
        let height = if read.height > 0.0 { read.height } else { settings.nominal.rise };
        let bead_height = settings.nominal.bead.height * height / settings.nominal.rise;
        let passes = {
            let rate = process.at_layer(index).rate();
            read.passes.iter().filter_map(|p| pass(p, settings, law, bead_height, rate, width)).collect()
        };
        Layer { index, z: read.z, height, passes, ..Layer::default() }
    };
    read.into_iter().enumerate().map(layer).collect()
}

/// Least and greatest width of a bead, in nominal bead widths: blobs and stringing are not beads.
const WIDTHS: (f64, f64) = (0.25, 4.0);

/// `rate` is the wire feed as a multiple of the nominal one.
fn pass(
    read: &ReadPass,
    settings: &DepositSettings,
    law: &Law,
    bead_height: f64,
    rate: f64,
    width: Option<f64>,
) -> Option<Pass> {
    let nominal = &settings.nominal;
    let mut points = vec![*read.points.first()?];
    let (mut widths, mut paces) = (Vec::new(), Vec::new());
    for (i, pair) in read.points.windows(2).enumerate() {
        let length = pair[0].distance(pair[1]);
        if length < 1e-6 {
            continue;
        }
        points.push(pair[1]);
        let of_volume = |volume: f64| nominal.bead.section.width_of(bead_height, volume / length);
        let of_pace = |pace: f64| law.width_of_area(&nominal.bead, nominal.bead.area() * nominal.pace / pace);
        let written = read.volume[i].map(of_volume).or(read.width[i]);
        let pace = Some(read.speed[i] / rate).filter(|pace| *pace > 0.0);
        let own = written.or_else(|| pace.map(of_pace));
        let own = own.map(|own| own.clamp(WIDTHS.0 * nominal.bead.width, WIDTHS.1 * nominal.bead.width));
        widths.push(width.or(own).unwrap_or(nominal.bead.width));
        paces.push(match read.volume[i] {
            Some(volume) => nominal.pace * nominal.bead.area() * length / volume.max(1e-9),
            None => pace.unwrap_or(nominal.pace),
        });
    }
    // The last point has no piece after it.
    widths.push(*widths.last()?);
    paces.push(*paces.last()?);
    let kind = crate::pass::PassKind::Infill;
    Some(Pass { kind, closed: false, points, width: Along::Each(widths), pace: Along::Each(paces), wait: 0.0 })
}

/// The shift, mm, that brings the middle of the program's passes to the middle of the part. `None` where the passes already
/// lie within the part grown by a bead width: they are taken as they lie.
pub fn shift(layers: &[Layer], mesh: &Mesh, settings: &DepositSettings) -> Option<DVec2> {
    let points = layers.iter().flat_map(|l| &l.passes).flat_map(|p| &p.points).map(|p| p.truncate());
    let (beads, (low, high)) = (Bounds::of(points)?, mesh.bounds());
    let room = settings.nominal.bead.width;
    let within = beads.min.cmpge(low.truncate() - room).all() && beads.max.cmple(high.truncate() + room).all();
    (!within).then(|| (low + high).truncate() / 2.0 - beads.center())
}

/// Moves all passes, mm.
pub fn translate(layers: &mut [Layer], by: DVec2) {
    let points = layers.iter_mut().flat_map(|l| &mut l.passes).flat_map(|p| &mut p.points);
    points.for_each(|p| *p += by.extend(0.0));
}

/// Cuts the part at the middle of every layer and gives each its islands.
///
/// # Errors
/// [`Cancelled`].
pub fn outline(layers: &mut [Layer], mesh: &Mesh, options: SliceOptions, task: &Task) -> Result<(), Cancelled> {
    let slabs = layers.iter().map(|l| Slab { z: l.z, height: l.height }).collect();
    let slices = Slicer::of_slabs(mesh, slabs, options, task)?.all(task)?;
    for (layer, slice) in layers.iter_mut().zip(slices) {
        layer.slice_area = slice.area();
        layer.islands = slice.islands;
    }
    Ok(())
}
