//! One layer from above: outline, beads, pockets and skeleton regions, the height field with its voids, a measure.

use crate::view3d::palette;
use beadwright::deposit::{Judgement, Picture, picture};
use beadwright::fill::PassKind;
use beadwright::fill::hybrid::Steps;
use beadwright::plan::{Layer, Segment};
use beadwright::planar::Bounds;
use eframe::egui::{
    self, Align2, Color32, ColorImage, FontId, Painter, Pos2, Rect, Role, Sense, Shape, Stroke, TextureHandle,
    TextureOptions, Ui, WidgetInfo, pos2, vec2,
};
use glam::DVec2;
use std::sync::Arc;

/// Where one looks: the middle of the view, mm, and its scale, points per mm.
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
    /// The way of the torch.
    pub paths: bool,
    /// Moves without arc.
    pub travels: bool,
    /// Where the arc starts and ends.
    pub starts: bool,
    /// The height field of the deposit model.
    pub heights: bool,
    /// Pockets and skeleton regions of the hybrid.
    pub regions: bool,
}

impl Default for Show {
    fn default() -> Self {
        Self { beads: true, paths: true, travels: true, starts: true, heights: false, regions: false }
    }
}

/// What is looked at.
#[derive(Clone, Copy)]
pub struct Subject<'a> {
    /// The layer.
    pub layer: &'a Layer,
    /// What the deposit model says of it.
    pub judgement: Option<&'a Arc<Judgement>>,
    /// The steps of the hybrid, island by island.
    pub steps: &'a [Steps],
    /// Pieces of beads that are shown.
    pub pieces: usize,
    /// The pass that is chosen.
    pub chosen: Option<usize>,
    /// The caption of the scale of heights, where it is shown.
    pub scale: Option<&'a str>,
}

/// What a person did in the view.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Done {
    /// The pass that was clicked on, with its piece; `Some(None)` for a click beside all.
    pub picked: Option<Option<(usize, usize)>>,
}

/// The view.
#[derive(Default)]
pub struct View2d {
    eye: Option<Eye>,
    /// Whether clicks measure.
    pub measuring: bool,
    measure: Vec<DVec2>,
    map: Option<(Arc<Judgement>, TextureHandle)>,
}

const START: Color32 = Color32::from_rgb(0x1a, 0x9c, 0x4b);
const END: Color32 = Color32::from_rgb(0xd9, 0x2d, 0x3a);
const VOID: Color32 = Color32::from_rgb(232, 0, 150);
const POCKET: Color32 = Color32::from_rgb(0x7e, 0x57, 0xc2);
const REGION: Color32 = Color32::from_rgb(0x0f, 0x8b, 0x8d);

/// The colour of a kind of pass.
pub fn colour(kind: PassKind) -> Color32 {
    let [r, g, b] = palette::kind(kind);
    Color32::from_rgb(r, g, b)
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
    /// The whole layer is shown again.
    pub fn fit(&mut self) {
        self.eye = None;
    }

    /// A place comes to the middle, mm; near enough to see beads.
    pub fn look_at(&mut self, place: DVec2) {
        const NEAR: f64 = 8.0;
        let scale = self.eye.map_or(NEAR, |eye| eye.scale.max(NEAR));
        self.eye = Some(Eye { centre: place, scale });
    }

    /// Looks where another view looks.
    pub fn follow(&mut self, other: &Self) {
        self.eye = other.eye;
    }

    /// Where this view looks; none while all of the layer is shown.
    pub fn eye(&self) -> Option<Eye> {
        self.eye
    }

    /// Forgets what was measured.
    pub fn clear_measure(&mut self) {
        self.measure.clear();
    }

    /// The distance that was measured, mm.
    pub fn measured(&self) -> Option<f64> {
        match self.measure[..] {
            [a, b] => Some(a.distance(b)),
            _ => None,
        }
    }

    /// Shows a layer in all the room there is.
    pub fn show(&mut self, ui: &mut Ui, subject: Subject<'_>, show: Show, label: &str) -> Done {
        let (rect, response) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, label));
        let bounds = bounds(subject.layer);
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
        if show.regions {
            subject.steps.iter().for_each(|steps| pen.regions(steps));
        }
        pen.passes(&subject, show);
        self.measures(&pen);
        pen.scale_bar();
        if let (true, Some(caption)) = (show.heights, subject.scale) {
            pen.heat_scale(caption);
        }
        let at = response.hover_pos().map(|p| eye.to_part(p, rect));
        if let Some(at) = at {
            pen.note(Align2::RIGHT_BOTTOM, &format!("x {:.2}  y {:.2} mm", at.x, at.y));
        }
        let clicked = response.clicked().then_some(at).flatten();
        self.click(clicked, subject.layer)
    }

    fn click(&mut self, at: Option<DVec2>, layer: &Layer) -> Done {
        let Some(at) = at else { return Done::default() };
        if !self.measuring {
            return Done { picked: Some(nearest(layer, at)) };
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
        // A ring around each void, a little larger than it is.
        for void in &judgement.voids {
            let radius = pen.points((void.area / std::f64::consts::PI).sqrt()) + 3.0;
            pen.painter.circle_stroke(pen.at(void.place), radius, Stroke::new(1.5, VOID));
        }
    }
}

fn bounds(layer: &Layer) -> Bounds {
    let outlines = layer.islands.iter().flat_map(|island| island.outer.points().iter().copied());
    let points = layer.passes.iter().flat_map(|pass| pass.points.iter().map(|p| p.truncate()));
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

/// The pass under a point, with its piece.
fn nearest(layer: &Layer, at: DVec2) -> Option<(usize, usize)> {
    let pieces = layer.passes.iter().enumerate().flat_map(|(p, pass)| pass.segments().enumerate().map(move |s| (p, s)));
    let distances = pieces.filter_map(|(pass, (i, s))| {
        let (a, b) = (s.from.truncate(), s.to.truncate());
        let along = ((at - a).dot(b - a) / (b - a).length_squared().max(1e-12)).clamp(0.0, 1.0);
        let distance = at.distance(a.lerp(b, along));
        (distance <= s.width / 2.0).then_some((distance, (pass, i)))
    });
    distances.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, found)| found)
}

/// Draws in the coordinates of the part.
struct Pen<'a> {
    painter: &'a Painter,
    eye: Eye,
    rect: Rect,
    ui: &'a Ui,
}

impl Pen<'_> {
    fn at(&self, p: DVec2) -> Pos2 {
        self.eye.to_screen(p, self.rect)
    }

    fn points(&self, length: f64) -> f32 {
        (length * self.eye.scale) as f32
    }

    fn ring(&self, points: &[DVec2], stroke: Stroke) {
        self.painter.add(Shape::closed_line(points.iter().map(|p| self.at(*p)).collect(), stroke));
    }

    fn outlines(&self, layer: &Layer) {
        let stroke = Stroke::new(1.2, self.ui.visuals().weak_text_color());
        for island in &layer.islands {
            self.ring(island.outer.points(), stroke);
            island.holes.iter().for_each(|hole| self.ring(hole.points(), stroke));
        }
    }

    fn regions(&self, steps: &Steps) {
        for pocket in steps.levels.iter().flat_map(|level| &level.pockets) {
            let stroke = Stroke::new(if pocket.kept { 2.0 } else { 0.8 }, POCKET);
            self.ring(pocket.shape.outer.points(), stroke);
        }
        for ring in steps.regions.rings() {
            self.ring(ring.points(), Stroke::new(2.0, REGION));
        }
    }

    fn passes(&self, subject: &Subject<'_>, show: Show) {
        let mut left = subject.pieces;
        let shown = subject.layer.passes.iter().map(|pass| {
            let pieces: Vec<_> = pass.segments().take(left).collect();
            left -= pieces.len();
            (pass.kind, pieces)
        });
        let shown: Vec<(PassKind, Vec<Segment>)> = shown.collect();
        // Under the colours of heights, beads would only hide them.
        if show.beads && !show.heights {
            for (i, (kind, pieces)) in shown.iter().enumerate() {
                self.bead(*kind, pieces, subject.chosen == Some(i));
            }
            self.outlines(subject.layer);
        }
        let (mut torch, weak) = (None, Stroke::new(1.0, self.ui.visuals().weak_text_color()));
        for (i, (kind, pieces)) in shown.iter().enumerate() {
            let (Some(first), Some(last)) = (pieces.first(), pieces.last()) else { break };
            let [start, end] = [first.from, last.to].map(|p| self.at(p.truncate()));
            if let (true, Some(from)) = (show.travels, torch) {
                self.painter.extend(Shape::dashed_line(&[from, start], weak, 5.0, 4.0));
            }
            if show.paths {
                let ink = if show.heights { Color32::BLACK } else { colour(*kind) };
                let width = if subject.chosen == Some(i) { 3.0 } else { 1.5 };
                let points = pieces.iter().map(|s| s.to).map(|p| self.at(p.truncate()));
                self.painter.add(Shape::line([start].into_iter().chain(points).collect(), Stroke::new(width, ink)));
            }
            if show.starts {
                self.painter.circle_filled(start, 3.5, START);
                self.painter.circle_filled(end, 2.5, END);
            }
            torch = Some(end);
        }
    }

    /// A bead in a pale colour that covers what lies below it, round at its ends and corners.
    fn bead(&self, kind: PassKind, pieces: &[Segment], chosen: bool) {
        /// Cosine of the turn from which on a corner would show a gap.
        const GAP: f64 = 0.995;
        let ground = self.ui.visuals().panel_fill;
        let ink = ground.lerp_to_gamma(colour(kind), if chosen { 0.8 } else { 0.4 });
        let way = |s: &Segment| (s.to - s.from).normalize_or_zero();
        for (i, s) in pieces.iter().enumerate() {
            let line = [s.from, s.to].map(|p| self.at(p.truncate()));
            let width = self.points(s.width);
            self.painter.line_segment(line, Stroke::new(width, ink));
            let before = i.checked_sub(1).map(|before| &pieces[before]);
            if before.is_none_or(|before| way(before).dot(way(s)) < GAP) {
                self.painter.circle_filled(line[0], width / 2.0, ink);
            }
            if i + 1 == pieces.len() {
                self.painter.circle_filled(line[1], width / 2.0, ink);
            }
        }
    }

    /// A line of a round length.
    fn scale_bar(&self) {
        let longest = f64::from(self.rect.width()) / 5.0 / self.eye.scale;
        let power = 10_f64.powf(longest.log10().floor());
        let length = [5.0, 2.0, 1.0].into_iter().map(|f| f * power).find(|l| *l <= longest).unwrap_or(power);
        let ink = self.ui.visuals().text_color();
        let from = self.rect.left_bottom() + vec2(12.0, -14.0);
        let to = from + vec2(self.points(length), 0.0);
        self.painter.line_segment([from, to], Stroke::new(2.0, ink));
        self.painter.text(from, Align2::LEFT_BOTTOM, format!("{length} mm"), FontId::proportional(12.0), ink);
    }

    /// What the colours of heights mean, in nominal bead heights.
    fn heat_scale(&self, caption: &str) {
        const STEPS: usize = 50;
        const MARKS: [f64; 3] = [0.0, 1.0, 2.0];
        let ink = self.ui.visuals().text_color();
        let place = Rect::from_min_size(self.rect.left_top() + vec2(12.0, 26.0), vec2(12.0, 120.0));
        let y = |height: f64| place.bottom() - place.height() * (height / picture::FULL_SCALE) as f32;
        for i in 0..STEPS {
            let height = |i: usize| picture::FULL_SCALE * i as f64 / STEPS as f64;
            let strip = Rect::from_x_y_ranges(place.x_range(), y(height(i + 1))..=y(height(i)));
            self.painter.rect_filled(strip, 0.0, heat(height(i)));
        }
        let font = FontId::proportional(12.0);
        for mark in MARKS {
            let at = pos2(place.right() + 4.0, y(mark));
            self.painter.text(at, Align2::LEFT_CENTER, format!("{mark:.0}"), font.clone(), ink);
        }
        self.painter.text(place.left_top() - vec2(0.0, 8.0), Align2::LEFT_BOTTOM, caption, font.clone(), ink);
        let void = Rect::from_min_size(place.left_bottom() + vec2(0.0, 8.0), vec2(12.0, 12.0));
        self.painter.rect_filled(void, 0.0, VOID);
        self.painter.text(void.right_center() + vec2(4.0, 0.0), Align2::LEFT_CENTER, "< 0.35", font, ink);
    }

    fn note(&self, corner: Align2, text: &str) {
        let place = corner.pos_in_rect(&self.rect.shrink(8.0));
        self.painter.text(place, corner, text, FontId::monospace(12.0), self.ui.visuals().text_color());
    }
}

/// Height in nominal bead heights, and its colour: as in the report.
const HEAT: [(f64, [f64; 3]); 7] = [
    (0.0, [38.0, 43.0, 92.0]),
    (0.35, [45.0, 104.0, 190.0]),
    (0.75, [150.0, 196.0, 226.0]),
    (1.0, [238.0, 240.0, 234.0]),
    (1.3, [250.0, 176.0, 84.0]),
    (1.6, [214.0, 62.0, 42.0]),
    (2.0, [110.0, 0.0, 22.0]),
];

/// The colour of a height, in nominal bead heights.
pub fn heat(height: f64) -> Color32 {
    let above = HEAT.iter().position(|(at, _)| *at >= height).unwrap_or(HEAT.len() - 1).max(1);
    let ((low, a), (high, b)) = (HEAT[above - 1], HEAT[above]);
    let part = ((height - low) / (high - low)).clamp(0.0, 1.0);
    let [r, g, b] = [0, 1, 2].map(|i| (a[i] + (b[i] - a[i]) * part).round() as u8);
    Color32::from_rgb(r, g, b)
}

/// The height in a pixel, in nominal bead heights; none where there is no metal, or a void.
pub fn height(value: u8) -> Option<f64> {
    let step = picture::FULL_SCALE / f64::from(u8::MAX - picture::FIRST_HEIGHT);
    value.checked_sub(picture::FIRST_HEIGHT).map(|v| f64::from(v) * step)
}

fn image(map: &Picture) -> ColorImage {
    let pixel = |value: u8| match value {
        picture::EMPTY => Color32::TRANSPARENT,
        picture::VOID_PIXEL => VOID,
        value => height(value).map_or(Color32::TRANSPARENT, heat),
    };
    // The picture has its lowest row first, an image its highest.
    let rows = map.values.chunks(map.width.max(1)).rev();
    ColorImage::new([map.width, map.height], rows.flatten().map(|v| pixel(*v)).collect())
}
