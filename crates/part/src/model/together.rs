//! Several parts for one build: side by side on the plate, or where their files place them.

use super::{Import, Mesh, Object, RepairReport};
use glam::{DVec2, DVec3};
use planar::Bounds;

/// How several parts are placed on a plate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Arrangement {
    /// In rows starting at x = y = 0.
    Rows {
        /// Gap between their extents, mm.
        gap: f64,
    },
    /// At their own coordinates.
    AsTheyAre,
}

/// Why parts cannot be built together.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TogetherError {
    /// Two parts occupy the same place.
    #[error("the extents of {0} and {1} overlap, seen from above. Let Beadwright place them, or move one of them.")]
    Overlap(String, String),
    /// None was given.
    #[error("there is no part to build")]
    Empty,
}

/// A part's name and its solid.
pub type Named = (String, Import);

/// A part's name and its extent on the plate, mm.
pub type Place = (String, Bounds);

/// One solid of several placed parts, and where each of them is.
///
/// # Errors
/// [`TogetherError`].
pub fn together(parts: Vec<Named>, arrangement: Arrangement) -> Result<(Import, Vec<Place>), TogetherError> {
    let (parts, places) = arrange(parts, arrangement)?;
    let mut all = parts.into_iter().map(|(_, import)| import);
    let first = all.next().ok_or(TogetherError::Empty)?;
    Ok((all.fold(first, joined), places))
}

/// The parts moved to their places.
///
/// # Errors
/// [`TogetherError::Overlap`].
pub fn arrange(parts: Vec<Named>, arrangement: Arrangement) -> Result<(Vec<Named>, Vec<Place>), TogetherError> {
    let extents: Vec<Bounds> = parts.iter().map(|(_, import)| extent(&import.mesh)).collect();
    let moves = match arrangement {
        Arrangement::Rows { gap } => rows(&extents, gap),
        Arrangement::AsTheyAre => vec![DVec2::ZERO; parts.len()],
    };
    let moved = |(extent, by): (&Bounds, &DVec2)| Bounds { min: extent.min + by, max: extent.max + by };
    let names = parts.iter().map(|(name, _)| name.clone());
    let places: Vec<Place> = names.zip(extents.iter().zip(&moves).map(moved)).collect();
    if let Some((a, b)) = crowded(&places) {
        return Err(TogetherError::Overlap(a, b));
    }
    let moved = parts.into_iter().zip(moves).map(|((name, mut import), by)| {
        import.mesh.vertices.iter_mut().for_each(|vertex| *vertex += by.extend(0.0));
        import.milled.iter_mut().for_each(|milled| milled.shift(by.extend(0.0)));
        let mut at: Vec<DVec3> = import.objects.drain(..).flat_map(|object| object.at).collect();
        at.iter_mut().for_each(|point| *point += by.extend(0.0));
        import.objects = vec![Object { name: name.clone(), triangles: import.repair.triangles_read, at }];
        (name, import)
    });
    Ok((moved.collect(), places))
}

fn extent(mesh: &Mesh) -> Bounds {
    let (low, high): (DVec3, DVec3) = mesh.bounds();
    Bounds { min: low.truncate(), max: high.truncate() }
}

/// How far each part moves to its place in the rows: the deepest first, in rows about as long as all of them are deep.
fn rows(extents: &[Bounds], gap: f64) -> Vec<DVec2> {
    let size = |index: usize| extents[index].size() + gap;
    let mut order: Vec<usize> = (0..extents.len()).collect();
    order.sort_by(|a, b| size(*b).y.total_cmp(&size(*a).y));
    let longest = order.iter().map(|index| size(*index).x).fold(0.0, f64::max);
    let length = order.iter().map(|index| size(*index).element_product()).sum::<f64>().sqrt().max(longest);
    let (mut at, mut depth, mut moves) = (DVec2::ZERO, 0.0_f64, vec![DVec2::ZERO; extents.len()]);
    for index in order {
        if at.x > 0.0 && at.x + size(index).x > 1.2 * length {
            (at, depth) = (DVec2::new(0.0, at.y + depth), 0.0);
        }
        moves[index] = at - extents[index].min;
        depth = depth.max(size(index).y);
        at.x += size(index).x;
    }
    moves
}

/// Two parts whose extents overlap.
fn crowded(places: &[Place]) -> Option<(String, String)> {
    let overlap = |a: &Bounds, b: &Bounds| (a.min.max(b.min) + 1e-6).cmplt(a.max.min(b.max)).all();
    let pairs = places.iter().enumerate().flat_map(|(i, a)| places[i + 1..].iter().map(move |b| (a, b)));
    pairs.into_iter().find(|(a, b)| overlap(&a.1, &b.1)).map(|(a, b)| (a.0.clone(), b.0.clone()))
}

/// Two solids as one import; the meshes are not joined.
fn joined(mut first: Import, second: Import) -> Import {
    first.mesh.add(second.mesh);
    match (&mut first.milled, second.milled) {
        (Some(first), Some(second)) => {
            first.mesh.add(second.mesh);
            first.stock.extend(second.stock);
        }
        (first, second) => *first = first.take().or(second),
    }
    first.repair = added(first.repair, second.repair);
    first.objects.extend(second.objects);
    first.notes.extend(second.notes);
    first.format = "several files";
    first
}

fn added(a: RepairReport, b: RepairReport) -> RepairReport {
    RepairReport {
        damage: a.damage.or(b.damage),
        appended_bytes: a.appended_bytes + b.appended_bytes,
        triangles_read: a.triangles_read + b.triangles_read,
        triangles: a.triangles + b.triangles,
        vertices: a.vertices + b.vertices,
        degenerate: a.degenerate + b.degenerate,
        duplicate: a.duplicate + b.duplicate,
        vertices_merged: a.vertices_merged + b.vertices_merged,
        open_edges: a.open_edges + b.open_edges,
        non_manifold_edges: a.non_manifold_edges + b.non_manifold_edges,
        flipped: a.flipped + b.flipped,
        inside_out: a.inside_out || b.inside_out,
        normals_against_winding: a.normals_against_winding + b.normals_against_winding,
        shells: a.shells + b.shells,
    }
}
