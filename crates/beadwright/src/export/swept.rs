//! The shape as built: every bead a closed body, its cross-section swept along the path.
//! The section is upright across the path, on the bottom of its layer; its area is the metal that is laid there, and
//! its shape the profile's. At a bend the body turns in the plane halfway between both directions, so that what the inside
//! loses the outside gains, and the volume is the metal's exactly. Where the path turns by more than 90° a new body begins.
//! Bodies of neighbouring beads overlap, as the formulas of single beads do; metal that fills craters has no shape here.

use super::walk::Run;
use super::{Beads, Piece};
use crate::bead::Section;
use crate::model::solid::Solid;
use crate::pass::PassKind;
use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2, PI};

/// Number of corners of a cross-section; they affect how accurate its shape is, but not its area.
const CORNERS: usize = 10;

/// Pieces shorter than this in plan view have no direction, mm.
const SHORTEST_MM: f64 = 1e-6;

/// A bead, or the part of one between two sharp turns.
pub(super) struct Body {
    pub(super) kind: PassKind,
    pub(super) solid: Solid,
}

/// The bodies of all beads, in the order in which they are welded.
pub(super) fn bodies(beads: &Beads<'_>) -> Vec<Body> {
    let process = &beads.profile.process;
    let metal = beads.profile.bead().area() * process.deposition_speed;
    let runs = beads.runs();
    let in_space = |run: &Run<'_>| {
        let mut bodies = of_run(run, beads.profile.bead.section, metal);
        if let Some(sheet) = beads.profile.layers.sheet(run.layer) {
            let vertices = bodies.iter_mut().flat_map(|body| &mut body.solid.vertices);
            vertices.for_each(|p| *p = sheet.at(*p).place);
        }
        bodies
    };
    runs.iter().flat_map(in_space).collect()
}

/// A piece of the path with its cross-section.
struct Stretch {
    from: DVec3,
    to: DVec3,
    way: DVec2,
    section: [DVec2; CORNERS],
}

impl Stretch {
    /// `metal` is what the nominal wire feed lays, mm³/s; `None` for a piece that is too short.
    fn of(piece: &Piece, shape: Section, metal: f64) -> Option<Self> {
        let along = piece.to - piece.from;
        let level = along.truncate().length();
        (level > SHORTEST_MM).then(|| {
            // The section is upright even where the path climbs, and is then higher.
            let area = metal / piece.pace * (along.length() / level);
            let down = DVec3::Z * piece.height;
            let section = section(shape, piece.width, area);
            Self { from: piece.from - down, to: piece.to - down, way: along.truncate() / level, section }
        })
    }
}

/// The corners of a section with that width (mm) and area (mm²), counter-clockwise from its right foot: across, up.
fn section(shape: Section, width: f64, area: f64) -> [DVec2; CORNERS] {
    let height = shape.height_of(width, area);
    let corners: [DVec2; CORNERS] = std::array::from_fn(|i| {
        let part = i as f64 / (CORNERS - 1) as f64;
        match shape {
            Section::Parabola => {
                let x = 0.5 - part;
                DVec2::new(x * width, height * (1.0 - 4.0 * x * x))
            }
            Section::Ellipse => DVec2::from_angle(part * PI) * DVec2::new(width / 2.0, height),
            Section::Stadium => {
                let half = CORNERS / 2;
                let (side, turn) = if i < half { (1.0, i) } else { (-1.0, i - half) };
                let angle = turn as f64 / (half - 1) as f64 * PI - side * FRAC_PI_2;
                let round = DVec2::new(height.min(width), height) / 2.0;
                let middle = DVec2::new(side * (width / 2.0 - round.x), height / 2.0);
                middle + DVec2::from_angle(angle) * round
            }
        }
    });
    // A polygon with its corners on the outline has slightly too little area; what is missing is added at the top.
    let inside: f64 = (0..CORNERS).map(|i| corners[i].perp_dot(corners[(i + 1) % CORNERS]) / 2.0).sum();
    corners.map(|corner| corner * DVec2::new(1.0, area / inside))
}

fn of_run(run: &Run<'_>, shape: Section, metal: f64) -> Vec<Body> {
    let stretches: Vec<Stretch> = run.pieces.iter().filter_map(|piece| Stretch::of(piece, shape, metal)).collect();
    let bends = |a: &Stretch, b: &Stretch| mitre(a.way, b.way).is_some();
    let chains: Vec<&[Stretch]> = stretches.chunk_by(bends).collect();
    let meets = |chain: &[Stretch]| match chain {
        [first, .., last] => chains.len() == 1 && first.from == last.to && bends(last, first),
        _ => false,
    };
    chains.iter().map(|chain| Body { kind: run.pass.kind, solid: swept(chain, meets(chain)) }).collect()
}

/// The vector across the path at a bend, longer than 1 so that sections keep their width on both sides; `None` where
/// the path turns by more than 90°.
fn mitre(before: DVec2, after: DVec2) -> Option<DVec2> {
    let middle = (before + after).try_normalize()?.perp();
    let cosine = middle.dot(before.perp());
    (cosine > FRAC_1_SQRT_2 - 1e-9).then(|| middle / cosine)
}

/// The body along a chain of stretches; `closed` where it ends at its beginning.
fn swept(chain: &[Stretch], closed: bool) -> Solid {
    let mut solid = Solid::default();
    let count = chain.len();
    let across =
        |before: usize, after: usize| mitre(chain[before].way, chain[after].way).unwrap_or(chain[after].way.perp());
    for (i, stretch) in chain.iter().enumerate() {
        let begin = match i {
            0 if closed => across(count - 1, 0),
            0 => stretch.way.perp(),
            _ => across(i - 1, i),
        };
        let end = match i + 1 {
            next if next < count => across(i, next),
            _ if closed => across(count - 1, 0),
            _ => stretch.way.perp(),
        };
        // The section of the piece before ends in the same plane; where the two differ there is a step.
        for (at, across) in [(stretch.from, begin), (stretch.to, end)] {
            let corner = |c: &DVec2| at + (across * c.x).extend(c.y);
            solid.vertices.extend(stretch.section.iter().map(corner));
        }
    }
    let rings = 2 * count;
    let joined = if closed { rings } else { rings - 1 };
    for ring in 0..joined {
        wall(&mut solid, ring * CORNERS, (ring + 1) % rings * CORNERS);
    }
    if !closed {
        let last = (rings - 1) * CORNERS;
        for k in 2..CORNERS {
            solid.triangles.push([0, k, k - 1].map(|i| i as u32));
            solid.triangles.push([last, last + k - 1, last + k].map(|i| i as u32));
        }
    }
    solid
}

fn wall(solid: &mut Solid, low: usize, high: usize) {
    for i in 0..CORNERS {
        let j = (i + 1) % CORNERS;
        let [a, b, c, d] = [low + i, low + j, high + j, high + i].map(|v| v as u32);
        solid.triangles.extend([[a, b, c], [a, c, d]]);
    }
}
