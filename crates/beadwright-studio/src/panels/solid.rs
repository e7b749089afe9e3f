//! The 3-D view with its bar and its legend.

use super::{bead, place, robot, scan, section, stock};
use crate::actions::Action;
use crate::studio::Studio;
use crate::view3d::{Colour, Pick, Style, face, palette};
use beadwright::model::Placement;
use eframe::egui::{Color32, ComboBox, Rect, Sense, Ui, vec2};
use glam::DVec3;

/// What the colours can show, with their texts.
const COLOURS: [(Colour, &str); 7] = [
    (Colour::Kind, "colour-kind"),
    (Colour::Order, "colour-order"),
    (Colour::Speed, "colour-speed"),
    (Colour::Width, "colour-width"),
    (Colour::HeightError, "colour-height"),
    (Colour::Time, "colour-time"),
    (Colour::Temperature, "colour-temperature"),
];

pub(super) fn show(studio: &mut Studio, ui: &mut Ui) {
    ui.horizontal_wrapped(|ui| bar(studio, ui));
    ui.horizontal_wrapped(|ui| {
        colours(studio, ui);
        legend(studio, ui);
        ui.separator();
        section::show(studio, ui);
        ui.separator();
        place::switch(studio, ui);
    });
    bead::show(studio, ui);
    robot::joints(studio, ui);
    scan::show(studio, ui);
    stock::show(studio, ui);
    let (style, label) = (studio.style(), studio.t("view-3d-label"));
    studio.solid.around = place::around(studio);
    let rect = view(studio, ui, &style, label);
    place::show(studio, ui, rect);
}

/// The picture, with what a click chooses; where it is.
pub(super) fn view(studio: &mut Studio, ui: &mut Ui, style: &Style, label: &str) -> Rect {
    studio.solid.caption = caption(studio);
    studio.solid.no_adapter = studio.t("no-adapter").to_owned();
    studio.solid.camera.orthographic = studio.view.parallel;
    let shown = studio.solid.show(ui, studio.window.render_state.as_ref(), &studio.plans.own.scene, style, label);
    if studio.view.laying {
        shown.sight.into_iter().for_each(|sight| lay(studio, sight));
    } else if shown.clicked {
        studio.view.chosen = shown.picked.and_then(|pick| chosen(studio, pick));
    }
    shown.response.rect
}

/// Lays the part onto the face that is seen there.
fn lay(studio: &mut Studio, sight: (DVec3, DVec3)) {
    let Some(normal) = studio.plans.own.scene.mesh().and_then(|mesh| face(mesh, sight)) else { return };
    let placement = studio.project().placement;
    studio.request(Action::Place(Placement { turn: placement.turned_onto(normal), ..placement }));
    studio.view.laying = false;
    studio.solid.fit();
}

/// What is shown.
pub(super) fn bar(studio: &mut Studio, ui: &mut Ui) {
    let texts = ["show-mesh", "show-beads", "show-travels", "show-starts", "all-marks", "show-plate", "parallel"];
    let [mesh, beads, travels, starts, all_marks, plate, parallel] = texts.map(|key| studio.t(key));
    ui.checkbox(&mut studio.view.mesh, mesh);
    ui.checkbox(&mut studio.view.show.beads, beads);
    ui.checkbox(&mut studio.view.show.travels, travels);
    ui.checkbox(&mut studio.view.show.starts, starts);
    ui.checkbox(&mut studio.view.all_marks, all_marks);
    ui.checkbox(&mut studio.view.plate, plate);
    robot::switch(studio, ui);
    ui.checkbox(&mut studio.view.parallel, parallel);
}

/// What the colours show.
pub(super) fn colours(studio: &mut Studio, ui: &mut Ui) {
    let label = ui.label(studio.t("colour"));
    let text = |colour| COLOURS.iter().find(|(c, _)| *c == colour).map_or("colour-kind", |(_, key)| *key);
    let selected = studio.t(text(studio.view.colour));
    let combo = ComboBox::from_id_salt("colour").selected_text(selected).show_ui(ui, |ui| {
        for (colour, key) in COLOURS {
            let text = studio.t(key);
            ui.selectable_value(&mut studio.view.colour, colour, text);
        }
    });
    combo.response.labelled_by(label.id);
    warm(studio, ui);
}

/// Has temperatures computed when they are to be shown and the plan has none.
fn warm(studio: &mut Studio, ui: &mut Ui) {
    if studio.jobs.heat_job.is_some() {
        ui.spinner();
        ui.weak(studio.t("stage-heat"));
        return;
    }
    let known = || studio.plans.own.scene.value_range(Colour::Temperature).is_some();
    if studio.view.colour == Colour::Temperature && studio.plans.own.summary.is_some() && !known() {
        studio.request(Action::Heat);
    }
}

/// What the colours mean: a patch for each kind of pass in the plan, or a scale with its ends.
fn legend(studio: &Studio, ui: &mut Ui) {
    let dark = !studio.window.settings.light;
    if studio.view.colour == Colour::Kind {
        let passes = || studio.plans.own.layers.iter().flat_map(|layer| &layer.passes);
        let used = |kind| passes().any(|pass| palette::kind(pass.kind) == palette::kind(kind));
        for kind in palette::KINDS.into_iter().filter(|kind| used(*kind)) {
            let (place, _) = ui.allocate_exact_size(vec2(12.0, 12.0), Sense::hover());
            ui.painter().rect_filled(place, 2.0, colour(palette::kind(kind)));
            ui.label(studio.language().word("kind", kind.name()));
        }
        return;
    }
    let Some((low, high)) = studio.plans.own.scene.value_range(studio.view.colour) else {
        ui.weak(studio.t("no-values"));
        return;
    };
    let unit = match studio.view.colour {
        Colour::Speed => " mm/s",
        Colour::Width => " mm",
        Colour::Time => " s",
        Colour::Temperature => " °C",
        Colour::HeightError => studio.t("unit-bead-heights"),
        _ => "",
    };
    ui.label(format!("{low:.1}{unit}"));
    scale(ui, |part| palette::at(studio.view.colour, part, dark));
    ui.label(format!("{high:.1}{unit}"));
}

/// A strip of all colours of a scale, which gives them by their part of it, 0 to 1.
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
        ui.painter().rect_filled(strip, 0.0, colour(colour_at(part(i))));
    }
}

fn colour([r, g, b]: [u8; 3]) -> Color32 {
    Color32::from_rgb(r, g, b)
}

/// The size of the plate, and what the grid on it shows.
fn caption(studio: &Studio) -> String {
    let plate = studio.plate().filter(|_| studio.view.plate).map(|plate| {
        let size = plate.high - plate.low;
        format!("{} {:.0} × {:.0} × {:.0} mm, ", studio.t("show-plate"), size.x, size.y, plate.thickness)
    });
    format!("{}{}", plate.unwrap_or_default(), studio.t("grid"))
}

/// The picked bead, its segment counted within its pass instead of within its layer.
fn chosen(studio: &Studio, pick: Pick) -> Option<(usize, usize, usize)> {
    let span = studio.plans.own.scene.layer(pick.layer)?.passes().get(pick.pass)?;
    Some((pick.layer, pick.pass, pick.segment - span.segments.start))
}
