//! The 3-D view with its bar and its legend.

use super::{bead, distortion, place, robot, scan, section, stock};
use crate::actions::Action;
use crate::known::{Known, Queue, View};
use crate::theme;
use crate::view::Mode;
use crate::view3d::{Colour, Pick, Style, face, palette};
use beadwright::model::Placement;
use beadwright::robot::Frame;
use eframe::egui::{ComboBox, DragValue, Rect, Role, Sense, Ui, WidgetInfo, vec2};
use glam::DVec3;
use std::ops::RangeInclusive;

/// What the colours can show, with their texts.
const COLOURS: [(Colour, &str); 8] = [
    (Colour::Kind, "colour-kind"),
    (Colour::Order, "colour-order"),
    (Colour::Speed, "colour-speed"),
    (Colour::Width, "colour-width"),
    (Colour::HeightError, "colour-height"),
    (Colour::Time, "colour-time"),
    (Colour::Temperature, "colour-temperature"),
    (Colour::OffLevel, "colour-off-level"),
];

pub(super) fn show(known: Known<'_>, view: &mut View<'_>, queue: &mut Queue, ui: &mut Ui) {
    ui.horizontal_wrapped(|ui| bar(known, view, queue, ui));
    ui.horizontal_wrapped(|ui| {
        // A bent shape has the colours of its movement, and bodies have their own, each with a legend elsewhere.
        if known.bent(view.state).is_none() && known.pieces(view.state).is_none() {
            colours(known, view, queue, ui);
            legend(known, view, ui);
            ui.separator();
        }
        section::show(known, view, ui);
        ui.separator();
        place::switch(known, view, ui);
        distortion::switch(known, view, queue, ui);
    });
    bead::show(known, view, ui);
    robot::joints(known, view, queue, ui);
    scan::show(known, view, queue, ui);
    distortion::show(known, view, queue, ui);
    stock::show(known, view, ui);
    let (style, label) = (known.style(view.state), known.t("view-3d-label"));
    view.solid.around = place::around(known, view);
    let rect = picture(known, view, queue, ui, &style, label);
    place::show(known, view, queue, ui, rect);
}

/// The picture, with what a click chooses; returns where it is.
pub(super) fn picture(
    known: Known<'_>,
    view: &mut View<'_>,
    queue: &mut Queue,
    ui: &mut Ui,
    style: &Style,
    label: &str,
) -> Rect {
    view.solid.caption = caption(known, view, style);
    view.solid.no_adapter = known.t("no-adapter").to_owned();
    view.solid.pin = view.state.pin.as_ref().map(|pin| pin.at);
    view.solid.camera.orthographic = view.state.parallel;
    view.solid.camera.held = known.held(view.state).map_or(Frame::IDENTITY, Frame::from);
    let shown = view.solid.show(ui, known.window.render_state.as_ref(), &known.plans.own.scene, style, label);
    if view.state.laying {
        shown.sight.into_iter().for_each(|sight| lay(known, view, queue, sight));
    } else if shown.clicked {
        view.state.chosen = shown.picked.and_then(|pick| chosen(known, pick));
    }
    shown.response.rect
}

/// Lays the part onto the face that is seen there.
fn lay(known: Known<'_>, view: &mut View<'_>, queue: &mut Queue, sight: (DVec3, DVec3)) {
    let Some(normal) = known.plans.own.scene.mesh().and_then(|mesh| face(mesh, sight)) else { return };
    let placement = known.project().placement;
    queue.push(Action::Place(Placement { turn: placement.turned_onto(normal), ..placement }));
    view.state.laying = false;
    view.solid.fit();
}

/// What is shown.
pub(super) fn bar(known: Known<'_>, view: &mut View<'_>, queue: &mut Queue, ui: &mut Ui) {
    let texts = ["show-mesh", "show-beads", "show-travels", "show-starts", "all-marks", "show-plate", "parallel"];
    let [mesh, beads, travels, starts, all_marks, plate, parallel] = texts.map(|key| known.t(key));
    ui.checkbox(&mut view.state.mesh, mesh);
    ui.checkbox(&mut view.state.show.beads, beads);
    ui.checkbox(&mut view.state.show.travels, travels);
    ui.checkbox(&mut view.state.show.starts, starts);
    ui.checkbox(&mut view.state.all_marks, all_marks);
    ui.checkbox(&mut view.state.plate, plate);
    robot::switch(known, view, queue, ui);
    ui.checkbox(&mut view.state.parallel, parallel);
}

/// What the colours show.
pub(super) fn colours(known: Known<'_>, view: &mut View<'_>, queue: &mut Queue, ui: &mut Ui) {
    let label = ui.label(known.t("colour"));
    let text = |colour| COLOURS.iter().find(|(c, _)| *c == colour).map_or("colour-kind", |(_, key)| *key);
    let selected = known.t(text(view.state.colour));
    let combo = ComboBox::from_id_salt("colour").selected_text(selected).show_ui(ui, |ui| {
        for (colour, key) in COLOURS {
            let text = known.t(key);
            ui.selectable_value(&mut view.state.colour, colour, text);
        }
    });
    combo.response.labelled_by(label.id);
    warm(known, view, queue, ui);
    lean(known, view, queue, ui);
}

/// Has temperatures computed when they are to be shown and a plan in view has none.
fn warm(known: Known<'_>, view: &View<'_>, queue: &mut Queue, ui: &mut Ui) {
    if known.jobs.heat_job.is_some() {
        ui.spinner();
        ui.weak(known.t("stage-heat"));
        return;
    }
    let other = known.plans.other.as_ref().filter(|_| view.state.mode == Mode::Compare);
    let cold = known.plans.own.is_cold() || other.is_some_and(|other| other.plan.is_cold());
    if view.state.colour == Colour::Temperature && cold {
        queue.push(Action::Heat);
    }
}

/// Has leans computed when they are to be shown.
fn lean(known: Known<'_>, view: &View<'_>, queue: &mut Queue, ui: &mut Ui) {
    if known.jobs.level_job.is_some() {
        ui.spinner();
        return;
    }
    let has = || known.plans.own.scene.value_range(Colour::OffLevel).is_some();
    if view.state.colour == Colour::OffLevel && known.plans.own.is_planned() && !has() {
        queue.push(Action::Level);
    }
}

/// What the colours mean: a patch for each kind of pass in the plan, or a scale whose ends can be changed.
pub(super) fn legend(known: Known<'_>, view: &mut View<'_>, ui: &mut Ui) {
    if view.state.colour == Colour::Kind {
        let passes = || known.plans.own.layers.iter().flat_map(|layer| &layer.passes);
        let used = |kind| passes().any(|pass| palette::kind(pass.kind) == palette::kind(kind));
        for kind in palette::KINDS.into_iter().filter(|kind| used(*kind)) {
            let (place, _) = ui.allocate_exact_size(vec2(12.0, 12.0), Sense::hover());
            ui.painter().rect_filled(place, 2.0, theme::ink(palette::kind(kind)));
            ui.label(known.language().word("kind", kind.name()));
        }
        return;
    }
    let Some((low, high)) = known.range(view.state) else {
        ui.weak(known.t("no-values"));
        return;
    };
    let unit = match view.state.colour {
        Colour::Speed => " mm/s",
        Colour::Width => " mm",
        Colour::Time => " s",
        Colour::Temperature => " °C",
        Colour::OffLevel => "°",
        Colour::HeightError => known.t("unit-bead-heights"),
        _ => "",
    };
    if high <= low {
        ui.label(format!("{low:.1}{unit}"));
        return;
    }
    let (colour, mut ends) = (view.state.colour, [low, high]);
    let decimals = (2.0 - (high - low).log10().floor()).clamp(1.0, 4.0) as usize;
    // A field that is left as it was gives back what it shows, which is rounded.
    let rounding = 0.5 * 0.1_f64.powi(decimals as i32);
    // Ends never meet: the colours between them would have no values.
    let least = 1e-3 * low.abs().max(high.abs()).max(1e-3);
    let end = |ui: &mut Ui, value: &mut f64, text: &str, range: RangeInclusive<f64>| {
        let before = *value;
        let field = DragValue::new(value).range(range).speed(0.01 * (high - low)).fixed_decimals(decimals).suffix(unit);
        let field = field.clamp_existing_to_range(false).update_while_editing(false);
        let response = ui.add(field).on_hover_text(text);
        response.widget_info(|| WidgetInfo::labeled(Role::SpinButton, true, text));
        if (*value - before).abs() <= rounding {
            *value = before;
        }
    };
    end(ui, &mut ends[0], known.t("range-low"), f64::NEG_INFINITY..=high - least);
    scale(ui, |part| palette::at(colour, part));
    end(ui, &mut ends[1], known.t("range-high"), low + least..=f64::INFINITY);
    if ends != [low, high] {
        view.state.range = Some((colour, ends));
    }
    let chosen = view.state.range.is_some_and(|(of, _)| of == colour);
    if chosen && ui.small_button("↺").on_hover_text(known.t("range-reset")).clicked() {
        view.state.range = None;
    }
}

/// A strip of all colours of a scale; `colour_at` gives the colour at a fraction of it, 0 to 1.
pub(super) fn scale(ui: &mut Ui, colour_at: impl Fn(f64) -> palette::Rgb) {
    const STEPS: usize = 40;
    let (place, _) = ui.allocate_exact_size(vec2(120.0, 12.0), Sense::hover());
    for i in 0..STEPS {
        let part = |i: usize| i as f64 / STEPS as f64;
        let x = place.x_range();
        let strip = Rect::from_x_y_ranges(
            x.min + x.span() * part(i) as f32..=x.min + x.span() * part(i + 1) as f32,
            place.y_range(),
        );
        ui.painter().rect_filled(strip, 0.0, theme::ink(colour_at(part(i))));
    }
}

/// The size of the plate, and what the grid on it or on the floor shows.
fn caption(known: Known<'_>, view: &View<'_>, style: &Style) -> String {
    let plate = known.plate().filter(|_| view.state.plate).map(|plate| {
        let size = plate.high - plate.low;
        format!("{} {:.0} × {:.0} × {:.0} mm, ", known.t("show-plate"), size.x, size.y, plate.thickness)
    });
    let grid = if style.floor.is_some() { "grid-floor" } else { "grid" };
    format!("{}{}", plate.unwrap_or_default(), known.t(grid))
}

/// The picked bead: the piece of its pass that the segment belongs to.
fn chosen(known: Known<'_>, pick: Pick) -> Option<(usize, usize, usize)> {
    let beads = known.plans.own.scene.drawn_layer(pick.layer)?;
    let first = beads.piece(beads.passes().get(pick.pass)?.segments.start);
    Some((pick.layer, pick.pass, beads.piece(pick.segment) - first))
}
