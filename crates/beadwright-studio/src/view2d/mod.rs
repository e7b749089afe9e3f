//! One layer from above: outline, beads, pockets and skeleton regions, the height field with its voids, a measurement.
//!
//! | file | what it does |
//! | --- | --- |
//! | `pen` | draws in the coordinates of the part |
//! | `steps` | pockets and regions of the hybrid, rings and flips of the loop |
//! | `heat` | the colours of heights |

mod heat;
mod pen;
mod steps;

pub use heat::{heat, height};
pub use steps::Named;

use crate::steps::Steps;
use crate::view3d::ring;
use beadwright::deposit::Judgement;
use beadwright::layer::Layer;
use beadwright::pass::{Pass, Segment};
use beadwright::plan::Bands;
use beadwright::planar::Bounds;
use eframe::egui::{
    self, Align2, Color32, FontId, Pos2, Rect, Role, Sense, Stroke, TextureHandle, TextureOptions, Ui, WidgetInfo,
    pos2, vec2,
};
use glam::DVec2;
use heat::VOID;
pub(crate) use heat::image;
use pen::Pen;
use std::sync::Arc;

/// What of the layer is in view: the middle of the view, mm, and its scale, points per mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Eye {
    /// Middle of the view, mm.
    pub centre: DVec2,
    /// Points of the screen per mm.
    pub scale: f64,
}

/// What is shown of a layer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Show {
    /// Beads with their width.
    pub beads: bool,
    /// The path of the torch.
    pub paths: bool,
    /// Moves without arc.
    pub travels: bool,
    /// Where the arc starts and ends.
    pub starts: bool,
    /// The height field of the deposit model.
    pub heights: bool,
    /// How the strategy arrives at its passes.
    pub regions: bool,
}

impl Default for Show {
    fn default() -> Self {
        Self { beads: true, paths: true, travels: true, starts: true, heights: false, regions: false }
    }
}

/// What the view shows.
#[derive(Clone, Copy)]
pub struct Drawing<'a> {
    /// The layer.
    pub layer: &'a Layer,
    /// The islands around an axis whose passes go around more than once.
    pub bands: Option<&'a Bands>,
    /// What the deposit model says about it.
    pub judgement: Option<&'a Arc<Judgement>>,
    /// The steps of the strategy, island by island, and what their colours mean.
    pub steps: (&'a [Steps], Named),
    /// Number of bead segments that are shown.
    pub pieces: usize,
    /// The pass that is chosen, and its piece.
    pub chosen: Option<(usize, usize)>,
    /// The caption of the scale of heights, where it is shown.
    pub scale: Option<&'a str>,
    /// The text for a layer without passes.
    pub nothing: &'a str,
}

/// What the user did in the view.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Done {
    /// The pass that was clicked, with its segment; `Some(None)` for a click on no pass.
    pub picked: Option<Option<(usize, usize)>>,
}

/// The view.
#[derive(Default)]
pub struct View2d {
    eye: Option<Eye>,
    /// Whether clicks measure.
    pub measuring: bool,
    /// A place that is marked, mm.
    pub pin: Option<DVec2>,
    /// A place to be framed when the view is next shown, and how much around it, mm.
    framed: Option<(DVec2, f64)>,
    measure: Vec<DVec2>,
    map: Option<(Arc<Judgement>, TextureHandle)>,
}

impl Eye {
    fn fitting(bounds: &Bounds, rect: Rect) -> Self {
        const MARGIN: f64 = 1.15;
        let size = (bounds.size() * MARGIN).max(DVec2::splat(1.0));
        let scale = (f64::from(rect.width()) / size.x).min(f64::from(rect.height()) / size.y);
        Self { centre: bounds.center(), scale: scale.max(1e-3) }
    }

    fn to_screen(self, p: DVec2, rect: Rect) -> Pos2 {
        let d = (p - self.centre) * self.scale;
        rect.center() + vec2(d.x as f32, -d.y as f32)
    }

    fn to_part(self, p: Pos2, rect: Rect) -> DVec2 {
        let d = p - rect.center();
        self.centre + DVec2::new(f64::from(d.x), -f64::from(d.y)) / self.scale
    }
}

impl View2d {
    /// Shows the whole layer again.
    pub fn fit(&mut self) {
        self.eye = None;
    }

    /// Moves a place to the middle, with this much around it from edge to edge, mm.
    pub fn frame(&mut self, place: DVec2, room: f64) {
        self.framed = Some((place, room));
    }

    /// Shows the same place as another view.
    pub fn follow(&mut self, other: &Self) {
        self.eye = other.eye;
    }

    /// The place in view; `None` while the whole layer is shown.
    pub fn eye(&self) -> Option<Eye> {
        self.eye
    }

    /// Clears the measurement.
    pub fn clear_measure(&mut self) {
        self.measure.clear();
    }

    /// The measured distance, mm.
    pub fn measured(&self) -> Option<f64> {
        match self.measure[..] {
            [a, b] => Some(a.distance(b)),
            _ => None,
        }
    }

    /// Shows a layer in all the available space.
    pub fn show(&mut self, ui: &mut Ui, subject: Drawing<'_>, show: Show, label: &str) -> Done {
        let (rect, response) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, label));
        let bounds = bounds(&subject);
        if let Some((centre, room)) = self.framed.take() {
            self.eye = Some(Eye { centre, scale: f64::from(rect.width().min(rect.height())) / room.max(1e-3) });
        }
        let mut eye = self.eye.unwrap_or_else(|| Eye::fitting(&bounds, rect));
        move_eye(&mut eye, ui, &response, rect);
        if response.double_clicked() {
            self.eye = None;
        } else if Some(eye) != self.eye && self.eye.is_some() || response.dragged() || response.hovered() {
            self.eye = Some(eye).filter(|eye| *eye != Eye::fitting(&bounds, rect));
        }
        let painter = ui.painter_at(rect);
        let pen = Pen { painter: &painter, eye, rect, ui };
        if show.heights {
            self.heights(&pen, subject.judgement);
        }
        pen.outlines(subject.layer);
        pen.passes(&subject, show);
        if show.regions {
            pen.steps(subject.steps.0, &subject.steps.1);
        }
        pen.chosen(&subject);
        self.pin.into_iter().for_each(|place| ring(&painter, pen.at(place), ui.visuals().warn_fg_color));
        self.measures(&pen);
        pen.scale_bar();
        if subject.layer.passes.is_empty() {
            pen.note(Align2::CENTER_CENTER, subject.nothing);
            response.widget_info(|| WidgetInfo::labeled(Role::Image, true, format!("{label}: {}", subject.nothing)));
        }
        if let (true, Some(caption)) = (show.heights, subject.scale) {
            pen.heat_scale(caption);
        }
        let at = response.hover_pos().map(|p| eye.to_part(p, rect));
        if let Some(at) = at {
            pen.note(Align2::RIGHT_BOTTOM, &format!("x {:.2}  y {:.2} mm", at.x, at.y));
        }
        let clicked = response.clicked().then_some(at).flatten();
        self.click(clicked, &subject)
    }

    fn click(&mut self, at: Option<DVec2>, subject: &Drawing<'_>) -> Done {
        let Some(at) = at else { return Done::default() };
        if !self.measuring {
            return Done { picked: Some(nearest(subject, at)) };
        }
        if self.measure.len() == 2 {
            self.measure.clear();
        }
        self.measure.push(at);
        Done::default()
    }

    fn measures(&self, pen: &Pen<'_>) {
        let ink = pen.ui.visuals().strong_text_color();
        let places: Vec<Pos2> = self.measure.iter().map(|p| pen.at(*p)).collect();
        places.iter().for_each(|p| {
            pen.painter.circle_stroke(*p, 4.0, Stroke::new(1.5, ink));
        });
        if let ([a, b], Some(length)) = (&places[..], self.measured()) {
            pen.painter.line_segment([*a, *b], Stroke::new(1.5, ink));
            let middle = a.lerp(*b, 0.5);
            pen.painter.text(middle, Align2::LEFT_BOTTOM, format!(" {length:.2} mm"), FontId::proportional(14.0), ink);
        }
    }

    fn heights(&mut self, pen: &Pen<'_>, judgement: Option<&Arc<Judgement>>) {
        let Some((judgement, map)) = judgement.and_then(|j| Some((j, j.picture.as_ref()?))) else { return };
        if self.map.as_ref().is_none_or(|(of, _)| !Arc::ptr_eq(of, judgement)) {
            let texture = pen.ui.ctx().load_texture("heights", image(map), TextureOptions::NEAREST);
            self.map = Some((judgement.clone(), texture));
        }
        let Some((_, texture)) = &self.map else { return };
        let size = DVec2::new(map.width as f64, map.height as f64) * map.pixel;
        let place = Rect::from_two_pos(pen.at(map.low), pen.at(map.low + size));
        pen.painter.image(texture.id(), place, Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0)), Color32::WHITE);
        // A ring around each void, slightly larger than the void.
        for void in &judgement.voids {
            let radius = pen.points((void.area / std::f64::consts::PI).sqrt()) + 3.0;
            pen.painter.circle_stroke(pen.at(void.place), radius, Stroke::new(1.5, VOID));
        }
    }
}

impl Drawing<'_> {
    /// The pieces of a pass, each on the layer unrolled once.
    fn pieces<'p>(&'p self, pass: &'p Pass) -> impl Iterator<Item = Segment> + 'p {
        pass.segments().map(|piece| self.bands.map_or(piece, |bands| bands.piece(piece)))
    }
}

fn bounds(subject: &Drawing<'_>) -> Bounds {
    let layer = subject.layer;
    let outlines = layer.islands.iter().flat_map(|island| island.outer.points().iter().copied());
    let pieces = layer.passes.iter().flat_map(|pass| subject.pieces(pass));
    let points = pieces.flat_map(|piece| [piece.from.truncate(), piece.to.truncate()]);
    Bounds::of(outlines.chain(points)).unwrap_or(Bounds { min: DVec2::ZERO, max: DVec2::ONE })
}

fn move_eye(eye: &mut Eye, ui: &Ui, response: &egui::Response, rect: Rect) {
    if response.dragged() {
        let d = response.drag_delta();
        eye.centre -= DVec2::new(f64::from(d.x), -f64::from(d.y)) / eye.scale;
    }
    if let Some(pointer) = response.hover_pos() {
        let (scroll, pinch) = ui.input(|i| (i.smooth_scroll_delta().y, i.zoom_delta()));
        let factor = f64::from(pinch) * f64::from(scroll * 0.005).exp();
        if factor != 1.0 {
            let fixed = eye.to_part(pointer, rect);
            eye.scale = (eye.scale * factor).clamp(1e-3, 1e4);
            eye.centre += fixed - eye.to_part(pointer, rect);
        }
    }
}

/// The pass under a point, with its segment.
fn nearest(subject: &Drawing<'_>, at: DVec2) -> Option<(usize, usize)> {
    let passes = subject.layer.passes.iter().enumerate();
    let pieces = passes.flat_map(|(p, pass)| subject.pieces(pass).enumerate().map(move |s| (p, s)));
    let distances = pieces.filter_map(|(pass, (i, s))| {
        let (a, b) = (s.from.truncate(), s.to.truncate());
        let along = ((at - a).dot(b - a) / (b - a).length_squared().max(1e-12)).clamp(0.0, 1.0);
        let distance = at.distance(a.lerp(b, along));
        (distance <= s.width / 2.0).then_some((distance, (pass, i)))
    });
    distances.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, found)| found)
}
