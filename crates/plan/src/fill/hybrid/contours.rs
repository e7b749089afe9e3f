//! Contours, and their cuts at skeleton regions.

use super::pockets::Level;
use crate::fill::FillSettings;
use glam::DVec2;
use planar::clip::Keep;
use planar::{Region, Ring};

/// A piece of a contour that remains between cuts at skeleton regions.
#[derive(Debug, Clone, PartialEq)]
pub struct Piece {
    /// Number of the contour, counted inwards from 0.
    pub level: usize,
    /// Its points.
    pub points: Vec<DVec2>,
}

/// All contours of an island.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Contours {
    /// Contours that are not cut, with their level.
    pub complete: Vec<(usize, Ring)>,
    /// What remains of the cut ones.
    pub incomplete: Vec<Piece>,
}

/// Cuts the contours of all levels where they run inside a skeleton region. By default the outermost one gives the
/// shape and is cut only where the part is as thin as one bead.
pub fn cut(levels: &[Level], regions: &Region, settings: &FillSettings) -> Contours {
    // The sides of a pocket lie on the contour itself, so cut slightly more.
    let knife = regions.offset(4.0 * settings.hybrid.tolerance, settings.hybrid.join());
    let mut contours = Contours::default();
    for (index, level) in levels.iter().enumerate() {
        let mut take = |ring: &Ring, knife: &Region| cut_ring(index, ring, knife, settings, &mut contours);
        if settings.hybrid.literal {
            level.contour.rings().for_each(|ring| take(ring, &knife));
        } else if index == 0 {
            let thin = thin(&level.region, settings);
            level.region.rings().for_each(|ring| take(ring, &thin));
        } else {
            let capped = if regions.is_empty() { level.region.clone() } else { capped(&level.region, settings) };
            capped.rings().for_each(|ring| take(&drawn_out(ring, settings), &knife));
        }
    }
    contours
}

fn cut_ring(level: usize, ring: &Ring, knife: &Region, settings: &FillSettings, contours: &mut Contours) {
    let Some(&first) = ring.points().first() else { return };
    let line: Vec<DVec2> = ring.points().iter().copied().chain([first]).collect();
    let mut pieces = knife.clip_line(&line, Keep::Outside);
    let kept: f64 = pieces.iter().map(|p| planar::polyline::length(p)).sum();
    if kept > ring.length() - 1e-3 {
        contours.complete.push((level, ring.clone()));
        return;
    }
    join_at(first, &mut pieces);
    pieces.retain(|piece| planar::polyline::length(piece) >= settings.min_pass_length);
    contours.incomplete.extend(pieces.into_iter().map(|points| Piece { level, points }));
}

/// A ring is clipped as a line from its first point back to that point: pieces that meet there are joined.
fn join_at(first: DVec2, pieces: &mut Vec<Vec<DVec2>>) {
    let near = |p: Option<&DVec2>| p.is_some_and(|p| p.distance(first) < 1e-3);
    let ends = pieces.iter().position(|piece| near(piece.last()));
    let begins = pieces.iter().position(|piece| near(piece.first()));
    if let (Some(ends), Some(begins)) = (ends, begins)
        && ends != begins
    {
        let tail = pieces[begins].split_off(1);
        pieces[ends].extend(tail);
        pieces.swap_remove(begins);
    }
}

/// Where two sides of the outermost contour would be closer together than this, in stepovers, one bead is laid along the middle.
const THIN: f64 = 0.6;

/// The areas, long enough for a pass, where both sides of a contour lie too close together.
fn thin(region: &Region, settings: &FillSettings) -> Region {
    let r = THIN / 2.0 * settings.stepover;
    let open = region.offset(-r, settings.hybrid.join()).offset(r + settings.hybrid.tolerance, settings.hybrid.join());
    let mut thin = region.difference(&open).into_polygons();
    // The outline of a piece without width is twice its length; its bead stays clear of both ends of the contour.
    let shortest = settings.min_pass_length + 2.0 * settings.hybrid.least_gap;
    thin.retain(|piece| piece.outer.length() >= 2.0 * shortest);
    Region::from_normalised(thin).offset(4.0 * settings.hybrid.tolerance, settings.hybrid.join())
}

/// Tips are cut off where both legs of a contour are this far apart, in stepovers.
const CAP: f64 = 0.9;

/// A contour without the tips of corners sharper than 60°: there the metal of both legs would pile up, while a void
/// would remain between the tips of neighbouring contours. The space beyond gets a bead of its own.
fn capped(region: &Region, settings: &FillSettings) -> Region {
    let r = CAP / 2.0 * settings.stepover;
    let blunt = region.offset(-r, settings.hybrid.join()).offset(r + settings.hybrid.tolerance, settings.hybrid.join());
    let mut tips = region.difference(&blunt).into_polygons();
    // The tip of an angle θ lies r (1/sin(θ/2) − 1) above its cap: r at 60°.
    let grown = blunt.offset(r, settings.hybrid.join());
    tips.retain(|tip| tip.outer.points().iter().any(|p| !grown.contains(*p)));
    if tips.is_empty() {
        return region.clone();
    }
    // The sides of a tip lie on the contour itself: cutting slightly more leaves no slivers.
    let knife = Region::from_normalised(tips).offset(4.0 * settings.hybrid.tolerance, settings.hybrid.join());
    region.difference(&knife)
}

/// Corners sharper than this are extended: cosine of the turn from leg to leg, 75°.
const SHARP: f64 = 0.26;
/// A corner is extended along this length of its legs, in stepovers.
const LEG: f64 = 1.2;

/// A ring whose sharp corners are extended towards the next ring outside. The tips of two rings lie d/sin(θ/2) apart.
/// The outer ring fills this up to where its legs are 0.84 w apart, the inner one the last 0.45 d in front of its tip.
/// What remains in between is a void, while the metal of both legs piles up at the tip: so the tip is moved out into
/// it.
fn drawn_out(ring: &Ring, settings: &FillSettings) -> Ring {
    let (points, d) = (ring.points(), settings.stepover);
    let n = points.len();
    let length = ring.length();
    let mut stations = vec![0.0; n];
    for i in 1..n {
        stations[i] = stations[i - 1] + points[i - 1].distance(points[i]);
    }
    let tip = |i: usize| {
        let (before, at, after) = (points[(i + n - 1) % n], points[i], points[(i + 1) % n]);
        let (a, b) = ((at - before).normalize_or_zero(), (after - at).normalize_or_zero());
        // The region lies on the left: a left turn is convex.
        (a.perp_dot(b) > 0.0 && a.dot(b) < SHARP).then(|| {
            let half_sine = ((1.0 + a.dot(b)) / 2.0).max(1e-3).sqrt();
            let reach = (d - 0.42 * settings.bead.width) / half_sine - 0.45 * d;
            (at, (a - b).normalize_or_zero(), settings.hybrid.tip_reach * reach.clamp(0.0, 1.2 * d))
        })
    };
    let tips: Vec<usize> = (0..n).filter(|&i| tip(i).is_some()).collect();
    if tips.is_empty() || settings.hybrid.tip_reach == 0.0 {
        return ring.clone();
    }
    // The extended legs of two corners must not overlap.
    let apart = |i: usize, j: usize| (stations[j] - stations[i]).rem_euclid(length);
    let room = |k: usize| {
        let (last, next) = (tips[(k + tips.len() - 1) % tips.len()], tips[(k + 1) % tips.len()]);
        let gap = |a, b| if a == b { length } else { apart(a, b) };
        gap(last, tips[k]).min(gap(tips[k], next)) / 2.0
    };
    let legs: Vec<f64> = (0..tips.len()).map(|k| (LEG * d).min(0.9 * room(k))).collect();
    let mut drawn: Vec<(f64, DVec2)> = Vec::with_capacity(n + 2 * tips.len());
    for (i, &p) in points.iter().enumerate() {
        // The tips are in order: only the one before and the one after can be near.
        let k = tips.partition_point(|&t| t < i);
        if tips.get(k) == Some(&i) {
            let moved = tip(i).map_or(p, |(at, way, reach)| at + way * reach);
            let on = |by: f64| (stations[i] + by).rem_euclid(length);
            drawn.push((on(-legs[k]), along(points, &stations, length, on(-legs[k]))));
            drawn.push((stations[i], moved));
            drawn.push((on(legs[k]), along(points, &stations, length, on(legs[k]))));
            continue;
        }
        let beside = [(k + tips.len() - 1) % tips.len(), k % tips.len()];
        let near = |k: usize| apart(i, tips[k]).min(apart(tips[k], i)) < legs[k];
        if !beside.into_iter().any(near) {
            drawn.push((stations[i], p));
        }
    }
    drawn.sort_by(|a, b| a.0.total_cmp(&b.0));
    Ring::new(drawn.into_iter().map(|(_, p)| p).collect())
}

/// The point at a given station (length along the ring, mm).
fn along(points: &[DVec2], stations: &[f64], length: f64, at: f64) -> DVec2 {
    let i = stations.partition_point(|&s| s <= at).saturating_sub(1);
    let (a, b) = (points[i], points[(i + 1) % points.len()]);
    let end = stations.get(i + 1).copied().unwrap_or(length);
    a.lerp(b, ((at - stations[i]) / (end - stations[i]).max(1e-9)).clamp(0.0, 1.0))
}
