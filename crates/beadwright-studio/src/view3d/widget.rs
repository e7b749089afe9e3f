//! The widget: the pointer turns, moves, zooms and picks, and a picture is rendered when something changed.

use super::beads::ROUGH;
use super::camera::Camera;
use super::gpu::{Gpu, Quality, Target};
use super::pick::{Pick, pick};
use super::scene::Scene;
use super::shape::Shape;
use super::style::Style;
use super::{gpu, overlay};
use crate::theme::ink;
use eframe::egui::{self, Color32, PointerButton, Rect, Sense, Ui, WidgetInfo, pos2};
use eframe::egui_wgpu::{RenderState, wgpu};
use glam::{DVec2, DVec3};
use web_time::Instant;

/// The picture stays coarse this long after the last turn of the mouse wheel, s.
const SETTLE: f64 = 0.2;

/// Number of segments beyond which scenes are drawn coarsely while they move: with a graphics card, without one.
const COARSE_FROM: [usize; 2] = [1_500_000, 12_000];

/// Number of rough segments that can be drawn in a twentieth of a second: with a graphics card, without one.
const IN_TIME: [usize; 2] = [1_500_000, 20_000];

/// At least this many layers of a part are drawn while it moves.
const LEAST_LAYERS: usize = 8;

/// Scenes with fewer segments than this get four samples per pixel even without a graphics card, once they are still.
const SMOOTH_BELOW: usize = 60_000;

/// From this many segments on, a bead under the pointer is only identified when it is clicked.
const HOVER_BELOW: usize = 400_000;

/// What happened in the view.
#[derive(Debug)]
pub struct Shown {
    /// The segment that was clicked.
    pub picked: Option<Pick>,
    /// The line of sight through the click: its origin and its direction.
    pub sight: Option<(DVec3, DVec3)>,
    /// Whether the view was clicked, on a bead or not.
    pub clicked: bool,
    /// The segment under the resting pointer.
    pub hovered: Option<Pick>,
    /// Whether a picture was rendered in this frame.
    pub rendered: bool,
    /// The widget, for menus and tooltips.
    pub response: egui::Response,
}

/// Time that a picture took, s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Timing {
    /// Sending what changed.
    pub upload: f64,
    /// Rendering, until it was finished.
    pub render: f64,
}

/// Everything a picture depends on.
#[derive(Debug, Clone, PartialEq)]
struct Key {
    camera: Camera,
    pixels: [u32; 2],
    style: Style,
    version: u64,
    quality: Quality,
}

/// A picture that egui can show.
#[derive(Debug)]
struct Frame {
    target: Target,
    texture: egui::TextureId,
    key: Option<Key>,
}

/// The 3-D view. It keeps its buffers and its last picture.
#[derive(Debug)]
pub struct View3d {
    /// Where the eye is.
    pub camera: Camera,
    /// The text shown where there is no graphics adapter.
    pub no_adapter: String,
    /// A line at the foot of the picture.
    pub caption: String,
    /// Places that must be in the picture too when the scene is fitted into it, mm.
    pub around: Vec<DVec3>,
    /// A place that is marked, mm.
    pub pin: Option<DVec3>,
    gpu: Option<Gpu>,
    /// The fine and the coarse picture.
    frames: [Option<Frame>; 2],
    fit: bool,
    /// A place to be framed when the view is next shown, and the height of the picture there, mm.
    framed: Option<(DVec3, f64)>,
    wheel_at: f64,
    hovered: Option<(Key, egui::Pos2, Option<Pick>)>,
}

impl Default for View3d {
    fn default() -> Self {
        Self {
            camera: Camera::default(),
            no_adapter: "The 3-D view needs a graphics adapter with Vulkan, Metal, Direct3D 12 or OpenGL; none was \
                         found. Everything else works without it."
                .to_owned(),
            caption: String::new(),
            around: Vec::new(),
            pin: None,
            gpu: None,
            frames: [None, None],
            fit: true,
            framed: None,
            wheel_at: f64::NEG_INFINITY,
            hovered: None,
        }
    }
}

impl View3d {
    /// Fits the scene into the picture when it is next shown, or as soon as there is one.
    pub fn fit(&mut self) {
        self.fit = true;
    }

    /// Moves a place (mm) to the middle of a picture of this height (mm).
    pub fn frame(&mut self, place: DVec3, height: f64) {
        (self.framed, self.fit) = (Some((place, height)), false);
    }

    /// Keeps the camera where it is, also when the view is shown for the first time.
    pub fn hold(&mut self) {
        self.fit = false;
    }

    /// The widget: it takes all available space. `label` is its name for screen readers.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        state: Option<&RenderState>,
        scene: &Scene,
        style: &Style,
        label: &str,
    ) -> Shown {
        let response = ui.allocate_response(ui.available_size(), Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::labeled(egui::Role::Image, true, label));
        let rect = response.rect;
        let size = DVec2::new(f64::from(rect.width().max(1.0)), f64::from(rect.height().max(1.0)));
        let moving = self.steer(ui, &response, size);
        if response.double_clicked() {
            self.fit = true;
        }
        if self.fit && scene.bounds().is_some() {
            let machine = style.around.iter().flat_map(Shape::bounds);
            let seen = scene.outline().into_iter().chain(machine).chain(self.around.iter().copied());
            self.camera.fit_points(&seen.collect::<Vec<_>>(), size);
            self.fit = false;
        }
        if let Some((place, height)) = self.framed.take() {
            self.camera.frame(place, height);
        }
        let clicked = response.clicked();
        let mut shown = Shown { picked: None, sight: None, clicked, hovered: None, rendered: false, response };
        let Some(state) = state else {
            self.say_no_adapter(ui, rect, style.dark);
            return shown;
        };
        let scale = ui.ctx().pixels_per_point();
        let pixels = [rect.width(), rect.height()].map(|length| ((length * scale).round() as u32).max(1));
        let (texture, key, rendered) = self.rendered(state, scene, style, pixels, moving);
        shown.rendered = rendered;
        let painter = ui.painter().with_clip_rect(rect);
        painter.image(texture, rect, Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0)), Color32::WHITE);
        overlay::paint(&painter, rect, &self.camera, &self.caption, style.dark);
        if let Some(at) = self.pin.and_then(|pin| self.camera.project(pin, size)) {
            let at = rect.min + egui::vec2(at.x as f32, at.y as f32);
            overlay::ring(&painter, at, ui.visuals().warn_fg_color);
        }
        let at = |pos: egui::Pos2| DVec2::new(f64::from(pos.x - rect.left()), f64::from(pos.y - rect.top()));
        if shown.clicked {
            let pos = shown.response.interact_pointer_pos();
            shown.picked = pos.and_then(|pos| pick(scene, style, &self.camera, size, at(pos)));
            shown.sight = pos.map(|pos| self.camera.ray(at(pos), size));
        }
        if let Some(pos) = shown.response.hover_pos().filter(|_| !moving && scene.segments_drawn() < HOVER_BELOW) {
            let camera = self.camera;
            shown.hovered = self.hover(key, pos, || pick(scene, style, &camera, size, at(pos)));
        }
        shown
    }

    /// Turns, moves and zooms with the pointer; returns whether the view is in motion.
    fn steer(&mut self, ui: &Ui, response: &egui::Response, size: DVec2) -> bool {
        let drag = response.drag_delta();
        let drag = DVec2::new(f64::from(drag.x), f64::from(drag.y));
        let shift = ui.input(|input| input.modifiers.shift);
        let pans = response.dragged_by(PointerButton::Secondary)
            || response.dragged_by(PointerButton::Middle)
            || (shift && response.dragged_by(PointerButton::Primary));
        if pans {
            self.camera.pan(drag, size);
        } else if response.dragged_by(PointerButton::Primary) {
            self.camera.orbit(drag);
        }
        let (wheel, pinch, now) = ui.input(|i| (i.smooth_scroll_delta().y, i.zoom_delta(), i.time));
        let factor = f64::from(pinch) * (f64::from(wheel) * 0.004).exp();
        if let Some(pos) = response.hover_pos().filter(|_| factor != 1.0) {
            let at = pos - response.rect.min;
            let under = self.camera.unproject(DVec2::new(f64::from(at.x), f64::from(at.y)), size);
            self.camera.zoom(factor, under);
            self.wheel_at = now;
        }
        let settling = now - self.wheel_at < SETTLE;
        if settling {
            // So that the fine picture is drawn afterwards.
            ui.ctx().request_repaint_after(std::time::Duration::from_secs_f64(SETTLE));
        }
        response.dragged() || settling
    }

    /// The picture, rendered again if anything changed: its texture, what it shows, and whether it is new.
    fn rendered(
        &mut self,
        state: &RenderState,
        scene: &Scene,
        style: &Style,
        pixels: [u32; 2],
        moving: bool,
    ) -> (egui::TextureId, Key, bool) {
        let camera = self.camera;
        let gpu = self.gpu.get_or_insert_with(|| Gpu::new(state));
        let coarse = moving && scene.segments_drawn() > COARSE_FROM[usize::from(gpu.software)];
        // From far away, rough beads look the same as exact ones.
        let pixel = camera.height() / f64::from(pixels[1]);
        let exact = scene.segments_drawn() < SMOOTH_BELOW || rough_error(scene) > 0.4 * pixel;
        let quality = if coarse {
            coarse_quality(gpu.software, scene.rough(style))
        } else {
            fine_quality(gpu.software, moving, scene.segments_drawn(), exact)
        };
        // A software renderer draws a quarter of the pixels while the view moves.
        let pixels = if coarse && gpu.software { pixels.map(|n| n.div_ceil(2)) } else { pixels };
        let key = Key { camera, pixels, style: style.clone(), version: scene.version(), quality };
        let frame = &mut self.frames[usize::from(coarse)];
        let fits = |frame: &Frame| frame.target.pixels == pixels && frame.target.samples == quality.samples;
        if !frame.as_ref().is_some_and(fits) {
            let target = gpu.target(pixels, quality.samples);
            let texture = register(state, &target, frame.as_ref().map(|frame| frame.texture));
            *frame = Some(Frame { target, texture, key: None });
        }
        let Some(frame) = frame else { return (egui::TextureId::default(), key, false) };
        let stale = frame.key.as_ref() != Some(&key);
        if stale {
            gpu.draw(scene, style, &camera, quality, &frame.target);
            frame.key = Some(key.clone());
        }
        (frame.texture, key, stale)
    }

    /// What lies under the resting pointer; looked up only once.
    fn hover(&mut self, key: Key, pos: egui::Pos2, search: impl FnOnce() -> Option<Pick>) -> Option<Pick> {
        if let Some((of, at, found)) = &self.hovered
            && *at == pos
            && (of.camera, of.version, &of.style.layers, of.style.segments_of_last, of.style.section)
                == (key.camera, key.version, &key.style.layers, key.style.segments_of_last, key.style.section)
        {
            return *found;
        }
        let found = search();
        self.hovered = Some((key, pos, found));
        found
    }

    fn say_no_adapter(&self, ui: &mut Ui, rect: Rect, dark: bool) {
        ui.painter().rect_filled(rect, 0.0, ink(gpu::background(dark)));
        let inner = rect.shrink2(egui::vec2(rect.width() * 0.1, rect.height() * 0.4));
        ui.put(inner, egui::Label::new(&self.no_adapter));
    }

    /// The picture as the camera sees it: width, height, and rows of red, green, blue, alpha.
    ///
    /// # Errors
    /// A sentence if the graphics card does not return it.
    pub fn picture(
        &mut self,
        state: &RenderState,
        scene: &Scene,
        style: &Style,
        size: [u32; 2],
    ) -> Result<(u32, u32, Vec<u8>), String> {
        let gpu = self.gpu.get_or_insert_with(|| Gpu::new(state));
        let target = gpu.target(size, 4);
        let quality = Quality { strips: 4, samples: 4, exact: true, caps: true, every: 1 };
        gpu.draw(scene, style, &self.camera, quality, &target);
        Ok((target.pixels[0], target.pixels[1], gpu.read(&target)?))
    }

    /// Renders a picture as the widget would, without showing it, and returns how long it took.
    ///
    /// # Errors
    /// A sentence if the graphics card does not answer.
    pub fn time_frame(
        &mut self,
        state: &RenderState,
        scene: &Scene,
        style: &Style,
        size: [u32; 2],
        moving: bool,
    ) -> Result<Timing, String> {
        let clock = Instant::now();
        let gpu = self.gpu.get_or_insert_with(|| Gpu::new(state));
        gpu.sync(scene, style);
        gpu.wait()?;
        let upload = clock.elapsed().as_secs_f64();
        let clock = Instant::now();
        self.rendered(state, scene, style, size, moving);
        let gpu = self.gpu.get_or_insert_with(|| Gpu::new(state));
        gpu.wait()?;
        Ok(Timing { upload, render: clock.elapsed().as_secs_f64() })
    }
}

/// How far rough beads may deviate from the exact ones, mm.
fn rough_error(scene: &Scene) -> f64 {
    let bead = scene.layers().iter().flatten().find_map(|layer| layer.beads().first());
    bead.map_or(0.0, |bead| f64::from(ROUGH * bead.width()))
}

/// While the view moves, one layer stands for several once there are more rough `segments` than can be drawn in time.
fn coarse_quality(software: bool, (layers, segments): (usize, usize)) -> Quality {
    let every = segments.div_ceil(IN_TIME[usize::from(software)]).clamp(1, (layers / LEAST_LAYERS).max(1));
    Quality { strips: 2, samples: 1, exact: false, caps: every == 1, every }
}

fn fine_quality(software: bool, moving: bool, segments: usize, exact: bool) -> Quality {
    if !software {
        return Quality { strips: 4, samples: 4, exact: true, caps: true, every: 1 };
    }
    let samples = if !moving && segments < SMOOTH_BELOW { 4 } else { 1 };
    Quality { strips: 2, samples, exact, caps: true, every: 1 }
}

/// Registers a picture with egui, replacing the previous one.
fn register(state: &RenderState, target: &Target, known: Option<egui::TextureId>) -> egui::TextureId {
    let mut renderer = state.renderer.write();
    let filter = wgpu::FilterMode::Linear;
    match known {
        Some(texture) => {
            renderer.update_egui_texture_from_wgpu_texture(&state.device, &target.view, filter, texture);
            texture
        }
        None => renderer.register_native_texture(&state.device, &target.view, filter),
    }
}
