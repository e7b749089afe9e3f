//! Colours of the window. Text stands out from what lies below it by 4.5 : 1 or more (WCAG 2.2, 1.4.3), dark and light.

use beadwright::palette::{self, Rgb};
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
    let pick = |on_dark: Rgb, on_light: Rgb| ink(if dark { on_dark } else { on_light });
    Visuals {
        weak_text_color: Some(pick([150; 3], [95; 3])),
        // Makes text fields stand out without a frame.
        extreme_bg_color: pick([8; 3], [226; 3]),
        error_fg_color: ink(palette::bad(dark)),
        warn_fg_color: ink(palette::mark(dark)),
        hyperlink_color: pick([100, 175, 255], [0, 90, 170]),
        ..standard
    }
}

/// The colour of what went well.
pub fn good(dark: bool) -> Color32 {
    ink(palette::good(dark))
}

/// A colour of the palette.
pub const fn ink([r, g, b]: Rgb) -> Color32 {
    Color32::from_rgb(r, g, b)
}
