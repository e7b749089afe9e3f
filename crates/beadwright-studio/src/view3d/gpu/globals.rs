//! The data passed to all shaders for one picture.

use super::Quality;
use crate::view3d::camera::Camera;
use crate::view3d::palette;
use crate::view3d::scene::Scene;
use crate::view3d::shape::Floor;
use crate::view3d::style::{Colour, Style};
use bytemuck::{Pod, Zeroable};
use glam::{DVec2, DVec3};

/// What a point that is not of a bead belongs to: an index into [`Globals::roles`].
pub(super) mod role {
    pub(in crate::view3d) const TRAVEL: u32 = 0;
    pub(in crate::view3d) const EDGE: u32 = 1;
    pub(in crate::view3d) const START: u32 = 2;
    pub(in crate::view3d) const END: u32 = 3;
    pub(in crate::view3d) const TORCH: u32 = 4;
    pub(in crate::view3d) const NOZZLE: u32 = 5;
    pub(in crate::view3d) const PLATE: u32 = 8;
    pub(in crate::view3d) const LINK: u32 = 9;
    pub(in crate::view3d) const JOINT: u32 = 11;
    pub(in crate::view3d) const TABLE: u32 = 12;
}

/// See `common.wgsl`.
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub(super) struct Globals {
    clip_from_world: [[f32; 4]; 4],
    eye: [f32; 4],
    light: [f32; 4],
    gloss: [f32; 4],
    back: [f32; 4],
    screen: [f32; 4],
    values: [f32; 4],
    ground: [f32; 4],
    missing: [f32; 4],
    pub accent: [f32; 4],
    section: [f32; 4],
    sky: [f32; 4],
    floor: [[f32; 4]; 4],
    roles: [[f32; 4]; ROLES],
}

/// Number of roles; 6 is the model, 7 the grid, 10 the inside of a cut model, 13 the floor.
const ROLES: usize = 14;

/// How much rounder beads are shaded than they are: 0 as they are, 1 as circles.
const ROUNDNESS: f64 = 0.6;

/// How much nearer lines are drawn than the surfaces they lie on, as a fraction of their depth.
const NUDGE: [f64; 2] = [3e-4, 2e-6];

impl Globals {
    /// The data for a picture of this many pixels.
    pub(super) fn new(scene: &Scene, style: &Style, camera: &Camera, pixels: [u32; 2], quality: Quality) -> Self {
        let size = DVec2::new(f64::from(pixels[0]), f64::from(pixels[1]));
        let back = camera.back();
        let light = (back * 0.62 + camera.up() * 0.58 - camera.right() * 0.46).normalize();
        let eye = if camera.orthographic { back.extend(0.0) } else { camera.eye().extend(1.0) };
        let at_one = if camera.orthographic { 1.0 } else { 1.0 / camera.distance };
        let nudge = NUDGE[usize::from(camera.orthographic)];
        let (low, per_range) = values(scene, style);
        let v4 = |x: f64, y: f64, z: f64, w: f64| [x as f32, y as f32, z as f32, w as f32];
        Self {
            clip_from_world: camera.clip_from_world(size).as_mat4().to_cols_array_2d(),
            eye: eye.as_vec4().into(),
            light: light.extend(0.0).as_vec4().into(),
            gloss: (light + back).normalize().extend(0.0).as_vec4().into(),
            back: back.extend(0.0).as_vec4().into(),
            screen: v4(size.x, size.y, camera.height() / size.y * at_one, nudge),
            values: v4(low, per_range, 2.0 / f64::from(quality.strips), ROUNDNESS),
            ground: ground(scene, quality.every),
            missing: rgba(palette::missing(style.dark), 1.0),
            accent: [0.0; 4],
            section: section(style),
            sky: camera.sky().extend(0.0).as_vec4().into(),
            floor: style.floor.as_ref().map_or([[0.0; 4]; 4], floor),
            roles: roles(style.dark),
        }
    }
}

/// Lowest value of the colour map and 1 / its range.
fn values(scene: &Scene, style: &Style) -> (f64, f64) {
    if style.colour == Colour::Kind {
        return (0.0, 1.0 / (palette::STEPS - 1) as f64);
    }
    let (low, high) = style.range.or_else(|| scene.value_range(style.colour)).unwrap_or((0.0, 1.0));
    // If all values are the same, they get the middle of the map.
    if high > low { (low, 1.0 / (high - low)) } else { (low - 0.5, 1.0) }
}

/// Centre and half size of the grid, well beyond the part; and how many layers a bead stands for.
fn ground(scene: &Scene, every: usize) -> [f32; 4] {
    let (low, high) = scene.bounds().unwrap_or((DVec3::splat(-50.0), DVec3::splat(50.0)));
    let middle = (low + high) / 2.0;
    let half = (high - low).truncate().length() * 0.9 + 60.0;
    [middle.x as f32, middle.y as f32, half as f32, every as f32]
}

/// The floor's x, y and z and its middle, mm; behind x how far it goes.
fn floor(Floor { frame, half }: &Floor) -> [[f32; 4]; 4] {
    let [x, y, z] = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| frame.rotation * axis);
    [(x, *half), (y, 0.0), (z, 0.0), (frame.position, 1.0)].map(|(v, w)| v.extend(w).as_vec4().into())
}

/// Normal and offset of the section, mm: what lies beyond is cut away, and without a section nothing is.
fn section(style: &Style) -> [f32; 4] {
    let plane = style.section.map(|section| section.plane());
    plane.map_or([0.0; 4], |(normal, offset)| normal.extend(offset).as_vec4().into())
}

fn roles(dark: bool) -> [[f32; 4]; ROLES] {
    let by_theme = |on_dark, on_light| if dark { on_dark } else { on_light };
    [
        rgba(by_theme([214, 220, 230], [70, 80, 96]), 0.55),
        rgba(by_theme([190, 200, 214], [40, 50, 64]), if dark { 0.45 } else { 0.5 }),
        rgba(palette::START, 1.0),
        rgba(palette::END, 1.0),
        rgba([196, 200, 206], 1.0),
        rgba([208, 138, 84], 1.0),
        rgba(by_theme([160, 176, 198], [172, 188, 210]), 1.0),
        rgba(by_theme([150, 158, 170], [96, 104, 118]), if dark { 0.34 } else { 0.42 }),
        rgba(by_theme([74, 80, 90], [206, 211, 219]), 1.0),
        rgba(by_theme([190, 194, 200], [214, 217, 222]), 1.0),
        rgba(by_theme([104, 122, 148], [126, 146, 178]), 1.0),
        rgba(by_theme([98, 104, 114], [120, 127, 138]), 1.0),
        rgba(by_theme([132, 138, 148], [176, 182, 190]), 1.0),
        rgba(by_theme([52, 56, 63], [222, 226, 232]), 0.8),
    ]
}

fn rgba(rgb: palette::Rgb, alpha: f32) -> [f32; 4] {
    let [r, g, b] = rgb.map(|c| f32::from(c) / 255.0);
    [r, g, b, alpha]
}
