//! Text can be read in both themes: its contrast is 4.5 : 1 or more (WCAG 2.2, success criterion 1.4.3).

use beadwright_studio::theme;
use eframe::egui::{Color32, Theme};

/// Relative luminance (WCAG 2.2).
fn luminance(colour: Color32) -> f64 {
    let linear = |c: u8| {
        let c = f64::from(c) / 255.0;
        if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
    };
    0.2126 * linear(colour.r()) + 0.7152 * linear(colour.g()) + 0.0722 * linear(colour.b())
}

/// Contrast of a text to what lies below it, 1 to 21.
fn contrast(text: Color32, ground: Color32) -> f64 {
    let (a, b) = (luminance(text), luminance(ground));
    (a.max(b) + 0.05) / (a.min(b) + 0.05)
}

#[test]
fn contrast_is_that_of_the_standard() {
    assert!((contrast(Color32::WHITE, Color32::BLACK) - 21.0).abs() < 1e-9);
    // #777777 on white is the usual example of a grey that just fails, #767676 of one that just passes.
    let [fails, passes] = [0x77, 0x76].map(|grey| contrast(Color32::from_gray(grey), Color32::WHITE));
    assert!(fails < 4.5 && passes > 4.5, "{fails}, {passes}");
}

#[test]
fn every_text_can_be_read_in_both_themes() {
    for (theme, dark) in [(Theme::Dark, true), (Theme::Light, false)] {
        let visuals = theme::visuals(theme);
        let inks = [
            ("text", visuals.text_color()),
            ("weak text", visuals.weak_text_color()),
            ("strong text", visuals.strong_text_color()),
            ("links", visuals.hyperlink_color),
            ("errors", visuals.error_fg_color),
            ("warnings", visuals.warn_fg_color),
            ("what went well", theme::good(dark)),
        ];
        // Every second row of a table is a little brighter or darker than the panel.
        let row = visuals.panel_fill.blend(visuals.faint_bg_color);
        for ground in [visuals.panel_fill, visuals.window_fill, row] {
            for (name, ink) in inks {
                let found = contrast(ink, ground);
                assert!(found >= 4.5, "{theme:?}: {name} {ink:?} on {ground:?}: {found:.2}");
            }
        }
        for ink in [visuals.text_color(), visuals.weak_text_color()] {
            let found = contrast(ink, visuals.extreme_bg_color);
            assert!(found >= 4.5, "{theme:?}: {ink:?} in text fields: {found:.2}");
        }
        let widgets = &visuals.widgets;
        for look in [&widgets.inactive, &widgets.hovered, &widgets.active, &widgets.open] {
            let found = contrast(look.text_color(), look.weak_bg_fill);
            assert!(found >= 4.5, "{theme:?}: {look:?}: {found:.2}");
        }
        let selected = contrast(visuals.selection.stroke.color, visuals.selection.bg_fill);
        assert!(selected >= 4.5, "{theme:?}: what is selected: {selected:.2}");
    }
}
