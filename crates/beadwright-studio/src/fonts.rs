//! Letters. The built-in fonts have no Chinese; one of the system's fonts that has is looked for.

use eframe::egui::{Context, FontData, FontDefinitions, FontFamily};
use std::sync::Arc;

/// Families with Chinese letters, the usual ones of each system.
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

/// Adds a Chinese font of the system behind the built-in ones; false if there is none.
pub fn add_chinese(ctx: &Context) -> bool {
    let mut database = fontdb::Database::new();
    database.load_system_fonts();
    let families = FAMILIES.map(fontdb::Family::Name);
    let Some(found) = database.query(&fontdb::Query { families: &families, ..fontdb::Query::default() }) else {
        return false;
    };
    let Some((bytes, index)) = database.with_face_data(found, |bytes, index| (bytes.to_vec(), index)) else {
        return false;
    };
    let mut fonts = FontDefinitions::default();
    fonts.font_data.insert("chinese".to_owned(), Arc::new(FontData { index, ..FontData::from_owned(bytes) }));
    for family in [FontFamily::Proportional, FontFamily::Monospace] {
        fonts.families.entry(family).or_default().push("chinese".to_owned());
    }
    ctx.set_fonts(fonts);
    true
}
