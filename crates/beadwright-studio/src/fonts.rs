//! Fonts. The built-in fonts have no Chinese characters, so a system font that has them is looked for.

use eframe::egui::{Context, FontData, FontDefinitions, FontFamily};
use std::sync::Arc;

/// A font handed over by the page, since a browser shows none of the system's.
#[cfg(target_arch = "wasm32")]
static HANDED: std::sync::OnceLock<Vec<u8>> = std::sync::OnceLock::new();

/// Keeps the bytes of a font with Chinese characters for [`set`].
#[cfg(target_arch = "wasm32")]
pub fn hand_over(bytes: Vec<u8>) {
    // The first one stays.
    let _ = HANDED.set(bytes);
}

#[cfg(target_arch = "wasm32")]
fn chinese() -> Option<FontData> {
    HANDED.get().cloned().map(FontData::from_owned)
}

/// Font families with Chinese characters that are common on each system.
#[cfg(not(target_arch = "wasm32"))]
const FAMILIES: [&str; 10] = [
    "Noto Sans CJK SC",
    "Noto Sans SC",
    "Source Han Sans SC",
    "WenQuanYi Micro Hei",
    "WenQuanYi Zen Hei",
    "Microsoft YaHei",
    "SimHei",
    "PingFang SC",
    "Hiragino Sans GB",
    "Arial Unicode MS",
];

/// Sets the fonts of the window: the built-in text font, then the built-in code font for signs that it lacks, then a
/// Chinese font of the system; false if there is none.
pub fn set(ctx: &Context) -> bool {
    let mut fonts = FontDefinitions::default();
    let mut behind = |name: &str, families: &[FontFamily]| {
        for family in families {
            fonts.families.entry(family.clone()).or_default().push(name.to_owned());
        }
    };
    behind("Hack", &[FontFamily::Proportional]);
    let chinese = chinese();
    if let Some(data) = &chinese {
        behind("chinese", &[FontFamily::Proportional, FontFamily::Monospace]);
        fonts.font_data.insert("chinese".to_owned(), Arc::new(data.clone()));
    }
    ctx.set_fonts(fonts);
    chinese.is_some()
}

/// A system font with Chinese characters.
#[cfg(not(target_arch = "wasm32"))]
fn chinese() -> Option<FontData> {
    let mut database = fontdb::Database::new();
    database.load_system_fonts();
    let families = FAMILIES.map(fontdb::Family::Name);
    let found = database.query(&fontdb::Query { families: &families, ..fontdb::Query::default() })?;
    let (bytes, index) = database.with_face_data(found, |bytes, index| (bytes.to_vec(), index))?;
    Some(FontData { index, ..FontData::from_owned(bytes) })
}
