//! Candidate directions, and how well they suit a piece.

use super::samples::{Sample, area};
use super::{PIECE, SKEW, Settings, TILT, TRIES, WORTH};
use crate::chart::Plane;
use crate::model::Mesh;
use glam::{DQuat, DVec3};
use rayon::prelude::*;
use std::f64::consts::{PI, TAU};

/// Directions spread over the half sphere, so close together that refining one in small steps finds the best.
const SPREAD: usize = 160;
/// The largest flat faces also give directions; their normals are binned on a grid of this spacing.
const FACES: usize = 16;
const SAME_FACE: f64 = 0.02;
/// A face is upright if its normal rises by less than this.
const UPRIGHT: f64 = 1e-6;
/// Angles by which a direction is turned in search of a better one, °.
const TURNS: [f64; 5] = [6.0, 3.0, 1.5, 0.5, 0.1];
/// Axes tried for each such turn.
const TRIED: usize = 12;
/// Heights along a direction at which a part may be cut.
const HEIGHTS: usize = 60;
/// How far outside a face a cut along it lies, mm.
const OUTSIDE: f64 = 0.01;
/// Along each direction, the planes tried spare these fractions of the most that one plane can.
const SHARES: [f64; 4] = [1.0, 0.9, 0.7, 0.45];
/// Two planes are alike if their directions differ by less than this, °, and their heights by less than this fraction
/// of the size.
const SAME_CUT: (f64, f64) = (8.0, 0.04);
/// Cost of a leaning face that does not overhang, as a fraction of its cost if it faced straight down.
const LEANS: f64 = 0.05;
/// Radius of a torch, and its height above the metal, mm.
const TORCH: f64 = 25.0;
/// Overhang up to this many squared bead widths is ignored.
const NOTHING: f64 = 4.0;
/// A face lies on the table or in a cut if it is within this fraction of the size, and faces it within the angle of
/// this cosine.
const ON_IT: f64 = 2e-3;
const FACES_IT: f64 = 0.99;
/// A face is square to a direction if the cosine of the angle between its normal and the direction is greater.
const ALONG: f64 = 0.9999;

/// Data by which directions are judged.
pub(super) struct Judge {
    pub(super) settings: Settings,
    /// Size of the whole part, mm.
    pub(super) size: f64,
    /// Surface of the whole part, mm².
    pub(super) surface: f64,
    /// Overhang that is ignored, mm².
    pub(super) nothing: f64,
    /// Sine of the largest angle at which walls may lean.
    steep: f64,
    ways: Vec<DVec3>,
    /// Directions square to large flat faces.
    pub(super) faces: Vec<DVec3>,
}

impl Judge {
    pub(super) fn new(mesh: &Mesh, samples: &[Sample], settings: Settings) -> Self {
        let surface = area(samples.iter());
        let steep = settings.lean.to_radians().sin();
        let least = settings.tilt.to_radians().cos() - 1e-6;
        let faces = faces(mesh);
        let upright = faces.iter().filter(|face| face.z < UPRIGHT).map(|face| -*face);
        let own: Vec<DVec3> = std::iter::once(DVec3::Z).chain(faces.iter().copied()).chain(upright).collect();
        // A cut slightly off a face would leave a sliver there.
        let beside = |way: &DVec3| !own.iter().any(|own| own.angle_between(*way).to_degrees() < SAME_CUT.0);
        let ways = own.iter().copied().chain(spread().filter(beside));
        let ways = ways.filter(|way| way.z >= least.max(-UPRIGHT)).collect();
        let nothing = NOTHING * settings.bead.powi(2);
        Self { settings, size: mesh.size().length(), surface, nothing, steep, ways, faces }
    }

    /// The plane of the table.
    pub(super) fn table(&self) -> Plane {
        Plane::default()
    }

    /// Area that overhangs if layers are square to `up`, or is so near the table that the torch would touch it, mm²;
    /// what stands on `base` does not overhang.
    pub(super) fn hanging(&self, samples: &[Sample], up: DVec3, base: Plane) -> f64 {
        let tilt = up.angle_between(DVec3::Z);
        // Below this height a torch square to the layer touches the table: its side is one radius away from its axis.
        let low = TORCH * (tilt.sin() - tilt.cos());
        let hangs = |sample: &&Sample| sample.place.z < low || self.hangs(sample, up) && !self.stands(sample, base);
        area(samples.iter().filter(hangs))
    }

    pub(super) fn hangs(&self, sample: &Sample, up: DVec3) -> bool {
        -sample.normal.dot(up) > self.steep
    }

    /// The same where walls may lean this much, °, if that is more.
    pub(super) fn hangs_beyond(&self, lean: f64, sample: &Sample, up: DVec3) -> bool {
        -sample.normal.dot(up) > self.steep.max(lean.to_radians().sin())
    }

    pub(super) fn stands(&self, sample: &Sample, base: Plane) -> bool {
        let height = base.up.dot(sample.place - base.origin);
        height.abs() < ON_IT * self.size && -sample.normal.dot(base.up) > FACES_IT
    }

    /// The cost of a direction for a piece on a base, as an area, mm².
    fn cost(&self, samples: &[Sample], up: DVec3, base: Plane) -> f64 {
        let leaning = samples.iter().filter(|sample| !self.stands(sample, base));
        let leaning: f64 = leaning.map(|sample| sample.area * (-sample.normal.dot(up)).max(0.0)).sum();
        self.hanging(samples, up, base) + LEANS * leaning + self.tilt(lies(up)) + self.skew(samples, up, base)
    }

    /// The cost of layers square to `up` at the cut on which a piece stands, as an area, mm²: nothing where they lie along the
    /// cut or square to it.
    pub(super) fn skew(&self, samples: &[Sample], up: DVec3, cut: Plane) -> f64 {
        let standing = area(samples.iter().filter(|sample| self.stands(sample, cut)));
        SKEW * standing * (2.0 * up.angle_between(cut.up)).sin().abs()
    }

    /// The cost of a build direction at this angle from the vertical, °, as an area, mm².
    pub(super) fn tilt(&self, degrees: f64) -> f64 {
        TILT * self.surface * degrees / 90.0
    }

    /// The cost of the number of pieces in a division, as an area, mm².
    pub(super) fn pieces(&self, count: usize) -> f64 {
        PIECE * self.surface * count as f64
    }

    /// The direction that best suits a piece standing on `base`.
    pub(super) fn best(&self, samples: &[Sample], base: Plane) -> DVec3 {
        let least = self.settings.tilt.to_radians().cos() - 1e-6;
        // The piece must stand on its base.
        let fits = |up: DVec3| up.z >= least && up.dot(base.up) >= 0.5;
        let ways = self.ways.iter().copied().chain([base.up]).filter(|up| fits(*up));
        let judged = ways.map(|up| (self.cost(samples, up, base), up));
        let (mut cost, mut best) = judged.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((f64::MAX, base.up));
        for degrees in TURNS {
            loop {
                let across = best.any_orthonormal_vector();
                let turned = (0..TRIED).map(|k| {
                    let axis = DQuat::from_axis_angle(best, TAU * k as f64 / TRIED as f64) * across;
                    (DQuat::from_axis_angle(axis, degrees.to_radians()) * best).normalize()
                });
                let judged = turned.filter(|up| fits(*up)).map(|up| (self.cost(samples, up, base), up));
                match judged.min_by(|a, b| a.0.total_cmp(&b.0)) {
                    Some((other, up)) if other < cost * (1.0 - 1e-6) => (cost, best) = (other, up),
                    _ => break,
                }
            }
        }
        best
    }
}

/// Angle between a direction and the vertical, °.
pub(super) fn lies(up: DVec3) -> f64 {
    up.angle_between(DVec3::Z).to_degrees()
}

/// Planes that take off most of what overhangs, those along large faces first.
pub(super) fn planes(samples: &[Sample], judge: &Judge) -> Vec<Plane> {
    let table = judge.table();
    let hangs = |sample: &Sample| judge.hangs(sample, DVec3::Z) && !judge.stands(sample, table);
    let hanging: Vec<bool> = samples.iter().map(hangs).collect();
    let along = |up: &DVec3| {
        let heights = samples.iter().map(|sample| up.dot(sample.place));
        let (low, high) = heights.fold((f64::MAX, f64::MIN), |(low, high), h| (low.min(h), high.max(h)));
        let step = (high - low) / HEIGHTS as f64;
        // Faces that look along the direction, and against it: their areas, and those times their heights.
        let (mut areas, mut faces) = (vec![[0.0; 2]; HEIGHTS], vec![[[0.0; 2]; 2]; HEIGHTS]);
        let is_own = up.z > ALONG || judge.faces.iter().any(|face| face.dot(*up).abs() > ALONG);
        for (sample, hanging) in samples.iter().zip(&hanging) {
            let height = up.dot(sample.place);
            let at = (((height - low) / step) as usize).min(HEIGHTS - 1);
            areas[at][0] += f64::from(u8::from(*hanging)) * sample.area;
            areas[at][1] += f64::from(u8::from(judge.hangs(sample, *up))) * sample.area;
            let faces_it = sample.normal.dot(*up);
            if is_own && faces_it.abs() > ALONG {
                let sums = &mut faces[at][usize::from(faces_it < 0.0)];
                *sums = [sums[0] + sample.area, sums[1] + sample.area * height];
            }
        }
        let (mut spared, mut left, mut found) = (0.0, 0.0, Vec::new());
        for k in (1..HEIGHTS).rev() {
            spared += areas[k][0];
            left += areas[k][1];
            let plane = Plane { origin: *up * (low + k as f64 * step), up: *up };
            found.push((spared - 0.5 * left - judge.tilt(lies(*up)), spared, plane));
        }
        let most = found.iter().map(|(worth, ..)| *worth).fold(0.0, f64::max);
        // For each fraction, the highest plane that spares so much: it takes off no more than it must.
        let highest = |share: &f64| found.iter().copied().find(|(worth, ..)| *worth >= share * most);
        let worthwhile = |(_, spared, _): &(f64, f64, Plane)| *spared > WORTH * judge.surface;
        let by_share =
            SHARES.iter().filter_map(highest).filter(worthwhile).map(|(worth, _, plane)| (false, worth, plane));
        // Along a large face, a cut leaves no slab, and a little outside it, no film. `found` begins with the highest.
        let along_face = |(found, [ahead, against]): (&(f64, f64, Plane), &[[f64; 2]; 2])| {
            let ([area, sum], outside) = if ahead[0] > against[0] { (ahead, OUTSIDE) } else { (against, -OUTSIDE) };
            let plane = Plane { origin: *up * (sum / area + outside), up: *up };
            (worthwhile(found) && *area > WORTH * judge.surface).then_some((true, found.0, plane))
        };
        let along_faces = found.iter().zip(faces[1..].iter().rev()).filter_map(along_face);
        along_faces.chain(by_share).collect::<Vec<_>>()
    };
    let mut found: Vec<(bool, f64, Plane)> = judge.ways.par_iter().flat_map_iter(along).collect();
    found.sort_by(|a, b| b.0.cmp(&a.0).then(b.1.total_cmp(&a.1)));
    let mut planes: Vec<Plane> = Vec::new();
    for (along_face, _, plane) in found {
        let alike = |other: &Plane| {
            other.up.angle_between(plane.up).to_degrees() < SAME_CUT.0
                && (other.up.dot(plane.origin - other.origin)).abs() < SAME_CUT.1 * judge.size
        };
        let room = if along_face { TRIES / 2 } else { TRIES };
        if planes.len() < room && !planes.iter().any(alike) {
            planes.push(plane.rounded());
        }
    }
    planes
}

/// Directions spread evenly over the upper half of the sphere (Fibonacci).
fn spread() -> impl Iterator<Item = DVec3> {
    let golden = PI * (3.0 - 5.0_f64.sqrt());
    (0..SPREAD).map(move |k| {
        let z = (k as f64 + 0.5) / SPREAD as f64;
        let (sin, cos) = (golden * k as f64).sin_cos();
        DVec3::new(cos, sin, 0.0) * (1.0 - z * z).sqrt() + DVec3::Z * z
    })
}

/// Normals of the largest flat faces; those that point down are reversed.
fn faces(mesh: &Mesh) -> Vec<DVec3> {
    let mut sums: std::collections::BTreeMap<[i64; 3], (DVec3, f64)> = std::collections::BTreeMap::new();
    for corners in &mesh.triangles {
        let [a, b, c] = corners.map(|corner| mesh.vertices[corner as usize]);
        let doubled = (b - a).cross(c - a);
        let Some(normal) = doubled.try_normalize() else { continue };
        let normal = if normal.z < 0.0 { -normal } else { normal };
        let sum = sums.entry((normal / SAME_FACE).to_array().map(|v| v.round() as i64)).or_default();
        sum.0 += normal * doubled.length();
        sum.1 += doubled.length();
    }
    let mut faces: Vec<(DVec3, f64)> = sums.into_values().collect();
    faces.sort_by(|a, b| b.1.total_cmp(&a.1));
    faces.into_iter().take(FACES).filter_map(|(sum, _)| sum.try_normalize()).collect()
}
