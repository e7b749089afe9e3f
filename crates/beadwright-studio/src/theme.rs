//! Colours of the window. Text stands out from what lies below it by 4.5 : 1 or more (WCAG 2.2, 1.4.3), dark and light.

use eframe::egui::{Color32, Context, Theme, Visuals};

/// Sets the colours of both themes.
pub fn set(ctx: &Context) {
    for theme in [Theme::Dark, Theme::Light] {
        ctx.set_visuals_of(theme, visuals(theme));
    }
}

/// The colours of a theme.
pub fn visuals(theme: Theme) -> Visuals {
    let (dark, standard) = (theme == Theme::Dark, theme.default_visuals());
    let pick = |on_dark: [u8; 3], on_light: [u8; 3]| {
        let [r, g, b] = if dark { on_dark } else { on_light };
        Color32::from_rgb(r, g, b)
    };
    Visuals {
        weak_text_color: Some(pick([150; 3], [95; 3])),
        // Makes text fields stand out without a frame.
        extreme_bg_color: pick([8; 3], [226; 3]),
        error_fg_color: pick([255, 110, 100], [180, 20, 20]),
        warn_fg_color: pick([255, 160, 30], [145, 75, 0]),
        hyperlink_color: pick([100, 175, 255], [0, 90, 170]),
        ..standard
    }
}

/// The colour of what went well.
pub fn good(dark: bool) -> Color32 {
    if dark { Color32::from_rgb(0x5f, 0xd0, 0x8a) } else { Color32::from_rgb(0x13, 0x7a, 0x3e) }
}
