//! The page of a bent part: plate and part in 3-D with their movement exaggerated, figures, and the course of lift and heat.

use crate::number::fixed;
use crate::report::bent::Bent;
use crate::report::plot::{Curve, Plot};
use crate::report::sheet::{Row, Sheet};
use distort::{Distortion, Eccentricity, EccentricityScore, Shape};
use glam::DVec2;

/// The page; `course` is the thermal eccentricity over the build.
pub fn page(name: &str, bent: &Distortion, course: &[Eccentricity]) -> Sheet {
    let lead = format!(
        "Plate and part as elastic metal that shrinks bead by bead: {} voxels of {:.1} × {:.1} × {:.1} mm. Not compared with measured plates \
         so far.",
        bent.voxels.len(),
        bent.grid.size.x,
        bent.grid.size.y,
        bent.grid.size.z
    );
    let mut sheet = Sheet::new(&format!("Distortion: {name}"), &lead);
    sheet.bent(&body(bent));
    let head = ["shape", "lift of the plate, mm", "farthest from flat, mm", "deviation of the part, mm", "RMS, mm"];
    let row = |(name, shape): (&str, &Shape)| -> Row {
        let figures = [shape.lift.range, shape.lift.largest, shape.deviation.largest, shape.deviation.rms];
        std::iter::once(name.to_owned()).chain(figures.map(|mm| fixed(mm, 3))).map(|text| (text, false)).collect()
    };
    sheet.heading("How far it bends").table(&head, &shapes(bent).map(row));
    sheet.heading("While it is welded");
    let lift = bent.steps.iter().map(|step| DVec2::new(step.time / 60.0, step.lift.range)).collect();
    sheet.svg(&plot("Lift of the plate on its clamps", "lift, mm", lift).svg());
    let offset = course.iter().map(|at| DVec2::new(at.time / 60.0, at.offset.truncate().length())).collect();
    let EccentricityScore { mean, largest, .. } = EccentricityScore::of(course);
    sheet.text(&format!(
        "Thermal eccentricity, the distance between the middles of heat and metal seen from above: {mean:.1} mm on the mean, \
         {largest:.1} mm at most."
    ));
    sheet.svg(&plot("Thermal eccentricity", "distance, mm", offset).svg());
    sheet
}

fn shapes(bent: &Distortion) -> [(&'static str, &Shape); 2] {
    [("on the clamps", &bent.clamped), ("released", &bent.released)]
}

fn plot(title: &str, y: &str, points: Vec<DVec2>) -> Plot {
    let curve = Curve { name: y.to_owned(), points };
    Plot { title: title.to_owned(), x: "time, min".to_owned(), y: y.to_owned(), curves: vec![curve], ..Plot::default() }
}

/// Plate and part as a surface that bends.
fn body(bent: &Distortion) -> Bent {
    let faces = bent.surface();
    let mut nodes: Vec<usize> = faces.iter().flatten().copied().collect();
    nodes.sort_unstable();
    nodes.dedup();
    let number = |node: usize| nodes.partition_point(|&other| other < node) as u32;
    let halves = |[a, b, c, d]: [u32; 4]| [[a, b, c], [a, c, d]];
    let moved = |shape: &Shape| {
        let of = |node: &usize| shape.nodes.binary_search(node).map_or(glam::DVec3::ZERO, |at| shape.moved[at]);
        nodes.iter().map(of).collect()
    };
    Bent {
        triangles: faces.iter().flat_map(|face| halves(face.map(number))).collect(),
        shapes: shapes(bent).map(|(name, shape)| (name.to_owned(), moved(shape))).into(),
        nodes: nodes.iter().map(|&node| bent.grid.place(node)).collect(),
    }
}
