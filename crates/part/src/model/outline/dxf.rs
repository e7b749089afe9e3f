//! DXF drawings: LINE, ARC, CIRCLE, LWPOLYLINE and POLYLINE, with bulges. Curves that cannot be followed exactly are
//! refused by name; texts, dimensions and similar entities are skipped and reported.

use super::super::{ImportError, Units};
use super::entity::{self, Entity, broken};
use super::{Outlines, chain, check_points};
use glam::DVec2;
use planar::Ring;
use std::collections::BTreeMap;
use std::f64::consts::TAU;

/// Arcs become chords that turn by at most this, °: off by 4e-5 of the radius.
const CHORD_DEGREES: f64 = 1.0;

/// Entities without an outline.
const PASSED_OVER: [&str; 14] = [
    "TEXT",
    "MTEXT",
    "ATTDEF",
    "ATTRIB",
    "DIMENSION",
    "ARC_DIMENSION",
    "LEADER",
    "MULTILEADER",
    "POINT",
    "HATCH",
    "VIEWPORT",
    "XLINE",
    "RAY",
    "IMAGE",
];

pub(super) fn is_dxf(bytes: &[u8]) -> bool {
    if bytes.starts_with(b"AutoCAD Binary DXF") {
        return true;
    }
    let head = String::from_utf8_lossy(&bytes[..bytes.len().min(4096)]);
    let mut lines = head.trim_start_matches('\u{feff}').lines().map(str::trim);
    // Comments (999) may come first.
    loop {
        match (lines.next(), lines.next()) {
            (Some("999"), Some(_)) => {}
            (code, value) => return (code, value) == (Some("0"), Some("SECTION")),
        }
    }
}

pub(super) fn read(bytes: &[u8]) -> Result<Outlines, ImportError> {
    if bytes.starts_with(b"AutoCAD Binary") {
        return Err(broken("it is a binary DXF, which is not read; save it as ASCII DXF".to_owned()));
    }
    let text = String::from_utf8_lossy(bytes);
    let drawing = entity::drawing(text.trim_start_matches('\u{feff}'))?;
    let units = match drawing.unit {
        0 => None,
        1 => Some(Units::Inch),
        4 => Some(Units::Millimetre),
        5 => Some(Units::Centimetre),
        6 => Some(Units::Metre),
        other => return Err(broken(format!("its unit ($INSUNITS {other}) is not mm, cm, m or inches"))),
    };
    let mut found = Found::default();
    let mut entities = drawing.entities.iter().peekable();
    while let Some(entity) = entities.next() {
        let mut vertices = Vec::new();
        while entity.name == "POLYLINE" && entities.peek().is_some_and(|next| next.name == "VERTEX") {
            vertices.extend(entities.next());
        }
        found.add(entity, &vertices)?;
        check_points(found.points, "DXF")?;
    }
    let rings = chain::rings(found.pieces).map_err(|chain::Gap(a, b)| {
        broken(format!(
            "the outline from ({:.3}, {:.3}) to ({:.3}, {:.3}) is not closed: join its ends, or delete it",
            a.x, a.y, b.x, b.y
        ))
    })?;
    found.rings.extend(rings);
    let notes =
        found.passed_over.iter().map(|(name, count)| format!("{count} × {name} in the drawing passed over.")).collect();
    Ok(Outlines { rings: found.rings, format: "DXF", units, notes })
}

/// The outlines found in a drawing.
#[derive(Default)]
struct Found {
    rings: Vec<Ring>,
    /// Open pieces.
    pieces: Vec<Vec<DVec2>>,
    passed_over: BTreeMap<String, usize>,
    points: usize,
}

impl Found {
    fn add(&mut self, entity: &Entity<'_>, vertices: &[&Entity<'_>]) -> Result<(), ImportError> {
        // In paper space rather than model space, or hidden.
        if entity.number(67, 0.0)? != 0.0 || entity.number(60, 0.0)? != 0.0 {
            *self.passed_over.entry(format!("{} on paper or hidden", entity.name)).or_default() += 1;
            return Ok(());
        }
        if entity.number(230, 1.0)? < 1.0 - 1e-6 && !PASSED_OVER.contains(&entity.name) {
            return Err(entity.broken("it does not lie in the plane of x and y, seen from above (code 230)"));
        }
        match entity.name {
            "LINE" => self.open(vec![entity.point(10)?, entity.point(11)?]),
            "CIRCLE" => {
                let (centre, radius) = (entity.point(10)?, entity.number(40, 0.0)?);
                let mut points = arc(centre, radius, 0.0, TAU);
                points.pop();
                self.ring(points);
            }
            "ARC" => {
                let (from, to) = (entity.number(50, 0.0)?.to_radians(), entity.number(51, 360.0)?.to_radians());
                let sweep = (to - from).rem_euclid(TAU);
                self.open(arc(entity.point(10)?, entity.number(40, 0.0)?, from, sweep));
            }
            "LWPOLYLINE" => self.polyline(&light_vertices(entity)?, entity.flags()? & 1 == 1),
            "POLYLINE" if entity.flags()? & (16 | 64) > 0 => {
                return Err(entity.broken("it is a mesh; outlines are drawn as lines, arcs, circles and polylines"));
            }
            "POLYLINE" if entity.flags()? & (2 | 4) > 0 => {
                return Err(entity.broken("its curve is fitted; convert it to arcs and lines"));
            }
            "POLYLINE" => {
                let vertex = |vertex: &&Entity<'_>| Ok((vertex.point(10)?, vertex.number(42, 0.0)?));
                let vertices = vertices.iter().map(vertex).collect::<Result<Vec<_>, ImportError>>()?;
                self.polyline(&vertices, entity.flags()? & 1 == 1);
            }
            "SEQEND" => {}
            "SPLINE" | "ELLIPSE" | "INSERT" | "REGION" | "3DSOLID" | "BODY" | "MLINE" => {
                return Err(entity.broken(match entity.name {
                    "SPLINE" | "ELLIPSE" => "it is not read; convert it to polylines or arcs",
                    "INSERT" => "blocks are not read; explode them",
                    _ => "it is not read; outlines are drawn as lines, arcs, circles and polylines",
                }));
            }
            name if PASSED_OVER.contains(&name) => *self.passed_over.entry(name.to_owned()).or_default() += 1,
            _ => return Err(entity.broken("it is not known; outlines are drawn as lines, arcs, circles and polylines")),
        }
        Ok(())
    }

    fn ring(&mut self, points: Vec<DVec2>) {
        self.points += points.len();
        self.rings.push(Ring::new(points));
    }

    fn open(&mut self, points: Vec<DVec2>) {
        self.points += points.len();
        // Zero-length lines join nothing.
        if points.first() != points.last() || points.len() > 2 {
            self.pieces.push(points);
        }
    }

    /// A polyline of points, each with the bulge of the piece that begins there.
    fn polyline(&mut self, vertices: &[(DVec2, f64)], closed: bool) {
        let Some(&first) = vertices.first() else { return };
        let mut points = vec![first.0];
        let next = vertices.iter().skip(1).chain(closed.then_some(&first));
        for (&(from, bulge), &(to, _)) in vertices.iter().zip(next) {
            points.extend(bulged(from, to, bulge).into_iter().skip(1));
        }
        if closed {
            points.pop();
            self.ring(points);
        } else if vertices.len() > 1 {
            self.open(points);
        }
    }
}

/// The vertices of an LWPOLYLINE with their bulges: each begins with code 10.
fn light_vertices(entity: &Entity<'_>) -> Result<Vec<(DVec2, f64)>, ImportError> {
    let mut vertices: Vec<(DVec2, f64)> = Vec::new();
    for &(code, value) in &entity.groups {
        match (code, vertices.last_mut()) {
            (10, _) => vertices.push((DVec2::new(entity.parsed(code, value)?, 0.0), 0.0)),
            (20, Some(vertex)) => vertex.0.y = entity.parsed(code, value)?,
            (42, Some(vertex)) => vertex.1 = entity.parsed(code, value)?,
            _ => {}
        }
    }
    Ok(vertices)
}

/// Points along an arc, both ends included; angles in radians, counter-clockwise.
fn arc(centre: DVec2, radius: f64, from: f64, sweep: f64) -> Vec<DVec2> {
    let count = (sweep.abs().to_degrees() / CHORD_DEGREES).ceil().max(1.0) as usize;
    let at = |k: usize| centre + radius * DVec2::from_angle(from + sweep * k as f64 / count as f64);
    (0..=count).map(at).collect()
}

/// Points from one vertex to the next: straight, or along an arc whose `bulge` is the tangent of a quarter of its
/// sweep.
fn bulged(from: DVec2, to: DVec2, bulge: f64) -> Vec<DVec2> {
    let chord = to - from;
    if bulge == 0.0 || chord == DVec2::ZERO {
        return vec![from, to];
    }
    // Distance of the centre from the chord: r cos(sweep / 2) = c / 2 · (1 - b²) / 2b.
    let centre = from + chord / 2.0 + chord.perp() * (1.0 - bulge * bulge) / (4.0 * bulge);
    let arm = from - centre;
    let mut points = arc(centre, arm.length(), arm.to_angle(), 4.0 * bulge.atan());
    if let Some(last) = points.last_mut() {
        *last = to;
    }
    points
}
