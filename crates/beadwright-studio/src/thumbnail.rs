//! Small pictures of meshes, drawn without a graphics card: seen from a corner, lit from the upper left.

use crate::view3d::Camera;
use beadwright::model::Mesh;
use eframe::egui::{Color32, ColorImage};
use glam::{DVec2, DVec3};

/// Size of the picture of an example in the window, points.
pub const SIZE: [usize; 2] = [148, 104];

/// Samples along each side of a pixel.
const SAMPLES: usize = 2;

/// The colour of the mesh in full light: red, green, blue, 0 to 255.
const INK: [f64; 3] = [150.0, 178.0, 214.0];

/// A picture of a mesh, width × height pixels, transparent around it.
pub fn thumbnail(mesh: &Mesh, [width, height]: [usize; 2]) -> ColorImage {
    let mut canvas = Canvas::new(width * SAMPLES, height * SAMPLES);
    let size = DVec2::new(canvas.width as f64, canvas.height as f64);
    let mut camera = Camera { orthographic: true, ..Camera::default() };
    camera.fit_points(&mesh.vertices, size);
    let light = (camera.back() * 0.6 + camera.up() * 0.6 - camera.right() * 0.45).normalize();
    for triangle in &mesh.triangles {
        let corners = triangle.map(|i| mesh.vertices.get(i as usize).copied().unwrap_or_default());
        let seen = corners.map(|p| camera.project(p, size).map(|at| at.extend(p.dot(camera.back()))));
        let [Some(a), Some(b), Some(c)] = seen else { continue };
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize_or_zero();
        // Meshes may be inside out; what is seen faces the viewer.
        let facing = if normal.dot(camera.back()) < 0.0 { -normal } else { normal };
        canvas.fill([a, b, c], 0.35 + 0.65 * facing.dot(light).max(0.0));
    }
    canvas.picture(width, height)
}

/// Brightness and depth of every sample.
struct Canvas {
    width: usize,
    height: usize,
    light: Vec<f64>,
    depth: Vec<f64>,
}

impl Canvas {
    fn new(width: usize, height: usize) -> Self {
        let samples = width * height;
        Self { width, height, light: vec![0.0; samples], depth: vec![f64::NEG_INFINITY; samples] }
    }

    /// Fills a triangle of corners (x, y, nearness) where nothing nearer is drawn.
    fn fill(&mut self, [a, b, c]: [DVec3; 3], light: f64) {
        let (ab, ac) = ((b - a).truncate(), (c - a).truncate());
        let area = ab.perp_dot(ac);
        if area.abs() < 1e-9 {
            return;
        }
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        let cells =
            |low: f64, high: f64, count: usize| low.max(0.0) as usize..(high.max(0.0).ceil() as usize).min(count);
        for y in cells(low.y, high.y, self.height) {
            for x in cells(low.x, high.x, self.width) {
                let from_a = DVec2::new(x as f64 + 0.5, y as f64 + 0.5) - a.truncate();
                let (v, w) = (from_a.perp_dot(ac) / area, ab.perp_dot(from_a) / area);
                let depth = a.z + v * (b.z - a.z) + w * (c.z - a.z);
                let at = y * self.width + x;
                if v >= 0.0 && w >= 0.0 && v + w <= 1.0 && depth > self.depth[at] {
                    (self.light[at], self.depth[at]) = (light, depth);
                }
            }
        }
    }

    fn picture(&self, width: usize, height: usize) -> ColorImage {
        let pixel = |i: usize| {
            let (x, y) = (i % width * SAMPLES, i / width * SAMPLES);
            let samples = (0..SAMPLES * SAMPLES).map(|s| (y + s / SAMPLES) * self.width + x + s % SAMPLES);
            let (mut light, mut drawn) = (0.0, 0.0);
            for sample in samples.filter(|&sample| self.depth[sample].is_finite()) {
                light += self.light[sample];
                drawn += 1.0;
            }
            let share = 1.0 / (SAMPLES * SAMPLES) as f64;
            let [r, g, b] = INK.map(|ink| (ink * light * share).min(255.0) as u8);
            Color32::from_rgba_premultiplied(r, g, b, (255.0 * drawn * share) as u8)
        };
        ColorImage::new([width, height], (0..width * height).map(pixel).collect())
    }
}
