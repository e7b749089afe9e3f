//! Where a part overhangs, as a picture: seen from below, coloured by how far its faces lean.

use crate::model::Mesh;
use crate::number::fixed;
use crate::palette::{LEANS, LYING, Rgb, hex};
use glam::{DVec2, DVec3};

/// Maximum number of faces drawn; with more, the file would be too large for browsers.
const MOST_FACES: usize = 200_000;

/// Faces this close to the lowest point lie on the plate, as a fraction of the part's extent.
const ON_PLATE: f64 = 1e-3;

/// The part has more downward faces than are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("{0} faces point downwards; at most {MOST_FACES} are drawn. Use a coarser model.")]
pub struct TooMany(pub usize);

/// A downward face.
struct Face {
    corners: [DVec3; 3],
    colour: Rgb,
    area: f64,
}

/// The picture as SVG, in the units of the part, with z upwards. Faces lean by the angle between
/// them and the vertical: a wall by 0°, a ceiling by 90°.
///
/// # Errors
/// [`TooMany`].
pub fn svg(mesh: &Mesh) -> Result<String, TooMany> {
    let (low, high) = mesh.bounds();
    let plate = low.z + ON_PLATE * mesh.size().max_element();
    let mut faces: Vec<Face> =
        mesh.triangles.iter().filter_map(|t| face(t.map(|i| mesh.vertices[i as usize]), plate)).collect();
    if faces.len() > MOST_FACES {
        return Err(TooMany(faces.len()));
    }
    // What is nearer to the eye below is drawn later.
    let middle = |face: &Face| face.corners.iter().map(|c| c.z).sum::<f64>();
    faces.sort_by(|a, b| middle(b).total_cmp(&middle(a)));
    // From below, x runs to the left.
    let seen = |corner: DVec3| DVec2::new(low.x + high.x - corner.x, -corner.y);
    let size = high - low;
    let unit = size.truncate().max_element().max(1e-6) / 40.0;
    let left = size.x + 2.0 * unit;
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"{} {} {} {}\" font-family=\"system-ui, sans-serif\" \
         font-size=\"{}\" stroke-width=\"{}\" stroke-linejoin=\"round\">\n",
        fixed(low.x - unit, 3),
        fixed(-high.y - unit, 3),
        fixed(left + 14.0 * unit, 3),
        fixed((size.y + 2.0 * unit).max(9.0 * unit), 3),
        fixed(unit, 3),
        fixed(unit / 50.0, 4),
    );
    for face in &faces {
        let points: Vec<String> =
            face.corners.iter().map(|c| seen(*c)).map(|p| format!("{},{}", fixed(p.x, 3), fixed(p.y, 3))).collect();
        let colour = hex(face.colour);
        text += &format!("<polygon fill=\"{colour}\" stroke=\"{colour}\" points=\"{}\"/>\n", points.join(" "));
    }
    text += &legend(&faces, DVec2::new(low.x + left, -high.y), unit);
    Ok(text + "</svg>\n")
}

/// A downward face, with its colour.
fn face(corners: [DVec3; 3], plate: f64) -> Option<Face> {
    let [a, b, c] = corners;
    let across = (b - a).cross(c - a);
    let normal = across.try_normalize().filter(|normal| normal.z < -1e-9)?;
    let lean = (-normal.z).clamp(0.0, 1.0).asin().to_degrees();
    let lies = corners.iter().all(|corner| corner.z <= plate);
    let [.., (_, steepest)] = LEANS;
    let band = LEANS.iter().find(|(most, _)| lean <= *most).map_or(steepest, |(_, colour)| *colour);
    Some(Face { corners, colour: if lies { LYING } else { band }, area: across.length() / 2.0 })
}

/// Colours with the area that has them.
fn legend(faces: &[Face], corner: DVec2, unit: f64) -> String {
    let area = |colour: Rgb| faces.iter().filter(|face| face.colour == colour).map(|face| face.area).sum::<f64>();
    let mut from = 0.0;
    let bands = LEANS.iter().map(|(most, colour)| {
        let name = format!("leans {from:.0} to {most:.0}°");
        from = *most;
        (name, *colour)
    });
    let rows: Vec<(String, Rgb)> = std::iter::once(("on the plate".to_owned(), LYING)).chain(bands).collect();
    let row = |(k, (name, ink)): (usize, &(String, Rgb))| {
        let colour = hex(*ink);
        let y = corner.y + 1.6 * unit * k as f64;
        format!(
            "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"{colour}\"/><text x=\"{}\" y=\"{}\">{name}: {}</text>\n",
            fixed(corner.x, 3),
            fixed(y, 3),
            fixed(unit, 3),
            fixed(unit, 3),
            fixed(corner.x + 1.4 * unit, 3),
            fixed(y + 0.85 * unit, 3),
            fixed(area(*ink), 1),
        )
    };
    rows.iter().enumerate().map(row).collect()
}
