//! The tool that moves the part on its plate: handles at its foot, and the arrow keys.

use crate::actions::Action;
use crate::known::{Known, Queue, View};
use crate::theme;
use crate::view3d::{Camera, Gizmo, Grip, Handle, Moved, palette};
use beadwright::palette::AXES;
use eframe::egui::{
    Color32, CursorIcon, EventFilter, FontId, Key, Modifiers, Painter, Popup, Pos2, Rect, Response, Role, Sense, Shape,
    Stroke, Ui, Vec2, WidgetInfo, vec2,
};
use glam::{DVec2, DVec3};

/// Half the side of a handle, points.
const HANDLE: f32 = 9.0;

/// Step of a drag, mm or °.
const STEP: f64 = 0.1;

/// The handles with their names and the colours of their axes.
const HANDLES: [(Handle, &str, Color32); 3] = [
    (Handle::X, "move-x", theme::ink(AXES[0])),
    (Handle::Y, "move-y", theme::ink(AXES[1])),
    (Handle::Turn, "turn-z", theme::ink(AXES[2])),
];

/// A part of the window with the camera that shows it.
struct Sight<'a> {
    camera: &'a Camera,
    rect: Rect,
}

impl Sight<'_> {
    fn size(&self) -> DVec2 {
        DVec2::new(f64::from(self.rect.width().max(1.0)), f64::from(self.rect.height().max(1.0)))
    }

    fn at(&self, place: DVec3) -> Option<Pos2> {
        let seen = self.camera.project(place, self.size())?;
        Some(self.rect.min + vec2(seen.x as f32, seen.y as f32))
    }

    fn ray(&self, at: DVec2) -> (DVec3, DVec3) {
        self.camera.ray(at, self.size())
    }
}

/// The switch of the tool.
pub(super) fn switch(known: Known<'_>, view: &mut View<'_>, ui: &mut Ui) {
    let [text, hint] = ["place", "place-hint"].map(|key| known.t(key));
    if ui.toggle_value(&mut view.state.placing, text).on_hover_text(hint).clicked() {
        view.solid.fit();
    }
}

/// What the tool needs to be in the picture.
pub(super) fn around(known: Known<'_>, view: &View<'_>) -> Vec<DVec3> {
    let part = known.plans.own.part.as_ref().filter(|_| view.state.placing);
    part.map(|part| Gizmo::around(part.bounds()).ring().collect()).unwrap_or_default()
}

/// The handles over the 3-D view.
pub(super) fn show(known: Known<'_>, view: &mut View<'_>, queue: &mut Queue, ui: &mut Ui, rect: Rect) {
    let Some(part) = known.plans.own.part.clone().filter(|_| view.state.placing) else { return };
    arrows(known, view, queue, ui);
    let camera = view.solid.camera;
    let (gizmo, sight) = (Gizmo::around(part.bounds()), Sight { camera: &camera, rect });
    let shown = gizmo.moved(view.state.grip.map(|grip| grip.moved).unwrap_or_default());
    let painter = ui.painter().with_clip_rect(rect);
    extent(&painter, &sight, part.bounds(), &gizmo, &shown);
    for (handle, name, colour) in HANDLES.into_iter().filter(|(handle, ..)| gizmo.can(*handle, &camera)) {
        let held = view.state.grip.is_some_and(|grip| grip.handle == handle);
        let Some(at) = sight.at(shown.tip(handle)).filter(|at| held || rect.contains(*at)) else { continue };
        let (place, label) = (Rect::from_center_size(at, Vec2::splat(2.0 * HANDLE)), known.t(name));
        let response = ui.interact(place, ui.scope_id().with(name), Sense::drag());
        response.widget_info(|| WidgetInfo::labeled(Role::Button, true, label));
        draw(&painter, &sight, &shown, handle, colour, &response);
        drag(known, view, queue, &response, &sight, &gizmo, handle);
        nudge(known, queue, ui, &response, &gizmo, handle);
        if response.dragged() {
            figure(&painter, at, ui.visuals().strong_text_color(), moved(known, view));
        }
    }
}

/// Follows a handle that is dragged; the part moves there once the handle is released.
fn drag(
    known: Known<'_>,
    view: &mut View<'_>,
    queue: &mut Queue,
    response: &Response,
    sight: &Sight<'_>,
    gizmo: &Gizmo,
    handle: Handle,
) {
    let Some(at) = response.interact_pointer_pos() else { return };
    let at = at - sight.rect.min;
    let at = DVec2::new(f64::from(at.x), f64::from(at.y));
    if response.drag_started() {
        let origin = response.ctx.input(|input| input.pointer.press_origin()).map(|pos| pos - sight.rect.min);
        let from = origin.map_or(at, |pos| DVec2::new(f64::from(pos.x), f64::from(pos.y)));
        view.state.grip = Some(Grip { handle, from, moved: Moved::default() });
    }
    let Some(mut grip) = view.state.grip.filter(|grip| grip.handle == handle) else { return };
    if let Some(moved) = gizmo.dragged(handle, sight.ray(grip.from), sight.ray(at)) {
        let round = |value: f64| (value / STEP).round() * STEP;
        grip.moved = Moved { shift: moved.shift.map(round), turn: round(moved.turn) };
    }
    view.state.grip = Some(grip);
    if response.drag_stopped() {
        view.state.grip = None;
        place(known, queue, grip.moved, gizmo.foot.truncate());
    }
}

/// Arrow keys for the handle that has the focus: 1 mm or 1°, with Shift ten.
fn nudge(known: Known<'_>, queue: &mut Queue, ui: &Ui, response: &Response, gizmo: &Gizmo, handle: Handle) {
    if !response.has_focus() {
        return;
    }
    let arrows = EventFilter { horizontal_arrows: true, vertical_arrows: true, ..EventFilter::default() };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, arrows));
    let [right, up] = pressed(ui);
    if right + up != 0.0 {
        place(known, queue, handle.by(right + up), gizmo.foot.truncate());
    }
}

/// Arrow keys while nothing has the focus: along the axes of the plate that go that way in the view.
fn arrows(known: Known<'_>, view: &View<'_>, queue: &mut Queue, ui: &Ui) {
    if ui.ctx().egui_wants_keyboard_input() || Popup::is_any_open(ui.ctx()) {
        return;
    }
    let [right, up] = pressed(ui);
    let seen = view.solid.camera.right().truncate();
    let along = if seen.x.abs() >= seen.y.abs() { DVec2::X * seen.x.signum() } else { DVec2::Y * seen.y.signum() };
    let shift = along * right + along.perp() * up;
    if shift != DVec2::ZERO {
        place(known, queue, Moved { shift, turn: 0.0 }, DVec2::ZERO);
    }
}

/// The steps to the right and up that the arrow keys ask for.
fn pressed(ui: &Ui) -> [f64; 2] {
    let step = if ui.input(|input| input.modifiers.shift) { 10.0 } else { 1.0 };
    let times = |key| ui.input_mut(|input| input.count_and_consume_key(Modifiers::NONE, key)) as f64;
    let pairs = [[Key::ArrowRight, Key::ArrowLeft], [Key::ArrowUp, Key::ArrowDown]];
    pairs.map(|[more, less]| step * (times(more) - times(less)))
}

fn place(known: Known<'_>, queue: &mut Queue, moved: Moved, foot: DVec2) {
    let placement = known.project().placement.moved(moved.shift, moved.turn, foot);
    queue.push(Action::Place(placement));
}

/// The extent of the part on its plate, where it would end up.
fn extent(painter: &Painter, sight: &Sight<'_>, (low, high): (DVec3, DVec3), gizmo: &Gizmo, shown: &Gizmo) {
    let turn = DVec2::from_angle(shown.turn.to_radians());
    let placed = |x: f64, y: f64| shown.foot + turn.rotate(DVec2::new(x, y) - gizmo.foot.truncate()).extend(0.0);
    let corners = [(low.x, low.y), (high.x, low.y), (high.x, high.y), (low.x, high.y)];
    let line: Vec<Pos2> = corners.into_iter().filter_map(|(x, y)| sight.at(placed(x, y))).collect();
    painter.add(Shape::closed_line(line, Stroke::new(1.5, theme::ink(palette::CHOSEN))));
}

/// A text next to a handle.
fn figure(painter: &Painter, at: Pos2, ink: Color32, text: String) {
    let place = at + vec2(2.0 * HANDLE, -HANDLE);
    let galley = painter.layout_no_wrap(text, FontId::proportional(14.0), ink);
    let ground = Rect::from_min_size(place, galley.size()).expand(4.0);
    painter.rect_filled(ground, 3.0, painter.ctx().global_style().visuals.panel_fill);
    painter.galley(place, galley, ink);
}

/// A handle, and the line from the foot to it or the ring on which it lies.
fn draw(painter: &Painter, sight: &Sight<'_>, gizmo: &Gizmo, handle: Handle, colour: Color32, response: &Response) {
    let lively = response.hovered() || response.dragged() || response.has_focus();
    let stroke = Stroke::new(if lively { 3.5 } else { 2.0 }, colour);
    let line: Vec<Pos2> = match handle {
        Handle::Turn => gizmo.ring().filter_map(|place| sight.at(place)).collect(),
        _ => [gizmo.foot, gizmo.tip(handle)].into_iter().filter_map(|place| sight.at(place)).collect(),
    };
    painter.add(Shape::line(line, stroke));
    let radius = if lively { HANDLE } else { HANDLE - 2.0 };
    painter.circle(response.rect.center(), radius, colour, Stroke::new(1.5, Color32::WHITE));
    if lively {
        response.ctx.set_cursor_icon(if response.dragged() { CursorIcon::Grabbing } else { CursorIcon::Grab });
    }
}

/// How far the part has been dragged, or a hint on how to use the tool.
pub(super) fn moved(known: Known<'_>, view: &View<'_>) -> String {
    match view.state.grip {
        Some(Grip { handle: Handle::Turn, moved, .. }) => format!("{} {:+.1}°", known.t("turn-z"), moved.turn),
        Some(Grip { moved: Moved { shift, .. }, .. }) => {
            format!("{} {:+.1} mm, {} {:+.1} mm", known.t("move-x"), shift.x, known.t("move-y"), shift.y)
        }
        None => known.t("place-hint").to_owned(),
    }
}
