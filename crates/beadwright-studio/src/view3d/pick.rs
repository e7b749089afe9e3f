//! Which segment is seen at a point of the picture.
//!
//! A bead is a tube of elliptical cross-section with round ends. In a space stretched along its height until the ellipse is
//! a circle, it is a capsule, so the hit is exact. Bounding boxes keep the search short: those of layers, from near to
//! far until the next one is behind the best hit, and those of blocks of segments within a layer.

use super::beads::{BLOCK, Bead, LayerBeads};
use super::camera::Camera;
use super::scene::Scene;
use super::style::Style;
use glam::{DVec2, Vec3};

/// A segment of the scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Pick {
    /// The layer, from 0.
    pub layer: usize,
    /// The pass in its layer, from 0.
    pub pass: usize,
    /// The segment in its layer, from 0.
    pub segment: usize,
}

struct Ray {
    origin: Vec3,
    way: Vec3,
    /// The stretch of the ray that no section cuts away, mm.
    kept: (f32, f32),
}

/// The nearest of the shown segments at a point of the picture; `size` and `at` in screen points.
pub fn pick(scene: &Scene, style: &Style, camera: &Camera, size: DVec2, at: DVec2) -> Option<Pick> {
    if !style.beads {
        return None;
    }
    let (origin, way) = camera.ray(at, size);
    let kept = style.section.map_or(Some((0.0, f64::INFINITY)), |section| section.kept(origin, way))?;
    let ray = Ray { origin: origin.as_vec3(), way: way.as_vec3(), kept: (kept.0 as f32, kept.1 as f32) };
    let mut layers: Vec<(f32, usize, &LayerBeads, usize)> = scene
        .drawn_present()
        .map(|(index, layer)| (index, layer, style.shown(index, layer.len())))
        .filter(|(_, _, shown)| *shown > 0)
        .filter_map(|(index, layer, shown)| Some((ray.enters(layer.bounds()?)?, index, &**layer, shown)))
        .collect();
    layers.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut best: Option<(f32, usize, usize)> = None;
    for (entry, index, layer, shown) in layers {
        if best.is_some_and(|(nearest, ..)| entry > nearest) {
            break;
        }
        if let Some((distance, segment)) = nearest(layer, shown, &ray)
            && best.is_none_or(|(nearest, ..)| distance < nearest)
        {
            best = Some((distance, index, segment));
        }
    }
    best.and_then(|(_, layer, segment)| Some(Pick { layer, pass: scene.drawn_layer(layer)?.pass_of(segment), segment }))
}

/// The nearest of the first `shown` segments of a layer, and its distance, mm.
fn nearest(layer: &LayerBeads, shown: usize, ray: &Ray) -> Option<(f32, usize)> {
    let mut best: Option<(f32, usize)> = None;
    for (block, &bounds) in layer.boxes.iter().enumerate().take(shown.div_ceil(BLOCK)) {
        let Some(entry) = ray.enters(bounds) else { continue };
        if best.is_some_and(|(nearest, _)| entry > nearest) {
            continue;
        }
        let first = block * BLOCK;
        for (i, bead) in layer.beads[first..shown.min(first + BLOCK)].iter().enumerate() {
            if let Some(distance) = ray.hits(bead)
                && best.is_none_or(|(nearest, _)| distance < nearest)
            {
                best = Some((distance, first + i));
            }
        }
    }
    best
}

impl Ray {
    /// Distance at which the ray enters a box, mm; `None` if it misses.
    fn enters(&self, (low, high): (Vec3, Vec3)) -> Option<f32> {
        let (mut first, mut last) = self.kept;
        for axis in 0..3 {
            let (origin, way) = (self.origin[axis], self.way[axis]);
            if way.abs() < 1e-12 {
                if origin < low[axis] || origin > high[axis] {
                    return None;
                }
                continue;
            }
            let (a, b) = ((low[axis] - origin) / way, (high[axis] - origin) / way);
            first = first.max(a.min(b));
            last = last.min(a.max(b));
        }
        (first <= last).then_some(first)
    }

    /// Distance at which the ray enters a bead, mm; `None` if it misses.
    fn hits(&self, bead: &Bead) -> Option<f32> {
        let (width, height) = (bead.width(), bead.height());
        let (up, more) = (bead.up(), if height > 0.0 { width / height - 1.0 } else { 0.0 });
        let stretched = |v: Vec3| v + up * (more * up.dot(v));
        // Starts near the bead, since with a distant eye f32 would lose digits.
        let near = (bead.from() - self.origin).dot(self.way);
        let origin = self.origin + self.way * near;
        let [a, b] = bead.middle_line().map(|end| stretched(end - origin));
        let way = stretched(self.way);
        let entry = near + enters_capsule(way, a, b, width / 2.0)?;
        // Where the near side is cut away, the section shows the inside.
        let first = entry.max(self.kept.0);
        let inside = || distance_to(way * (first - near), a, b) <= width / 2.0;
        (first <= self.kept.1 && (entry >= self.kept.0 || inside())).then_some(first)
    }
}

/// How far a point is from the line from `a` to `b`.
fn distance_to(point: Vec3, a: Vec3, b: Vec3) -> f32 {
    let part = ((point - a).dot(b - a) / (b - a).length_squared().max(1e-12)).clamp(0.0, 1.0);
    point.distance(a.lerp(b, part))
}

/// The first `t` at which `t · way` enters the capsule from `a` to `b`.
fn enters_capsule(way: Vec3, a: Vec3, b: Vec3, radius: f32) -> Option<f32> {
    let axis = b - a;
    let (length2, forward, offset) = (axis.length_squared(), axis.dot(way), -a.dot(axis));
    let (way2, towards) = (way.length_squared(), -a.dot(way));
    let k2 = length2 * way2 - forward * forward;
    if k2 > 1e-9 * length2 * way2 {
        let k1 = length2 * towards - offset * forward;
        let k0 = length2 * a.length_squared() - offset * offset - radius * radius * length2;
        let root = k1 * k1 - k2 * k0;
        if root < 0.0 {
            return None;
        }
        let t = (-k1 - root.sqrt()) / k2;
        let place = offset + t * forward;
        if (0.0..=length2).contains(&place) {
            return Some(t);
        }
        return enters_ball(way, if place < 0.0 { a } else { b }, radius);
    }
    let ends = [enters_ball(way, a, radius), enters_ball(way, b, radius)];
    ends.into_iter().flatten().reduce(f32::min)
}

fn enters_ball(way: Vec3, centre: Vec3, radius: f32) -> Option<f32> {
    let (way2, towards) = (way.length_squared(), centre.dot(way));
    let root = towards * towards - way2 * (centre.length_squared() - radius * radius);
    (root >= 0.0).then(|| (towards - root.sqrt()) / way2)
}
