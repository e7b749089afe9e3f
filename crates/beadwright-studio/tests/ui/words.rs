//! Languages and themes.

use super::window::{Window, click, example, has_adapter, sees, studio};
use beadwright_studio::settings::Store;
use beadwright_studio::text::table;
use eframe::egui::{Context, FontDefinitions, FontId, Key, Modifiers, RawInput, Theme};
use egui_kittest::kittest::{NodeT, Queryable};
use std::path::Path;

#[test]
fn the_window_speaks_chinese() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = studio(folder.path());
    click(&mut harness, "View");
    harness.get_by_label_contains("Language").click();
    harness.run_steps(5);
    if !sees(&harness, "中文") {
        assert!(sees(&harness, "Chinese"), "neither the language nor why it cannot be taken");
        println!("the Chinese window is skipped: no font with Chinese letters");
        return;
    }
    click(&mut harness, "中文");
    harness.run_steps(3);
    let there = |harness: &Window, labels: &[&str]| {
        for label in labels {
            assert!(harness.query_all_by_label_contains(label).next().is_some(), "{label} is not there");
        }
    };
    there(&harness, &["文件", "编辑", "视图", "将零件拖到此处", "机器人单元"]);
    assert!(!sees(&harness, "File"));
    // It is remembered.
    drop(harness);
    let mut harness = studio(folder.path());
    assert!(sees(&harness, "文件"));
    harness.state_mut().open_example("cross");
    super::window::wait(&mut harness);
    assert!(sees(&harness, "完成") && sees(&harness, "沉积长度"));
    there(&harness, &["参数", "总计", "填充策略", "焊道宽度"]);
    // And back again.
    click(&mut harness, "视图");
    // The dialect of the program is a language too.
    let starts = |node: &egui_kittest::Node<'_>| node.accesskit_node().label().unwrap().starts_with("语言");
    harness.query_all_by_label_contains("语言").find(starts).unwrap().click();
    harness.run_steps(5);
    click(&mut harness, "English");
    assert!(sees(&harness, "File") && !sees(&harness, "文件"));
}

#[test]
fn the_window_is_dark_or_light() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = example(folder.path(), "cross");
    let brightness = |harness: &mut Window| {
        let picture = harness.render().unwrap();
        let sum: u64 = picture.pixels().map(|p| u64::from(p.0[0]) + u64::from(p.0[1]) + u64::from(p.0[2])).sum();
        sum as f64 / (3.0 * f64::from(picture.width() * picture.height()))
    };
    assert_eq!(harness.ctx.theme(), Theme::Dark);
    let dark = has_adapter().then(|| brightness(&mut harness));
    harness.key_press_modifiers(Modifiers::COMMAND, Key::T);
    harness.run_steps(3);
    assert_eq!(harness.ctx.theme(), Theme::Light);
    if let Some(dark) = dark {
        let light = brightness(&mut harness);
        assert!(dark < 80.0 && light > 180.0, "mean of all pixels: dark {dark:.0}, light {light:.0}");
    }
    drop(harness);
    // Asked of the store: the harness sets a theme of its own at first.
    assert!(Store::at(folder.path().to_owned()).settings().light);
}

#[test]
fn every_sign_of_the_window_is_in_the_built_in_fonts() {
    let code: String = [
        "app",
        "panels/layers",
        "panels/menu",
        "panels/start",
        "panels/solid",
        "panels/basic",
        "panels/messages",
        "panels/parameters",
        "panels/plots",
    ]
    .map(|name| Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("src/{name}.rs")))
    .map(|path| std::fs::read_to_string(path).unwrap())
    .concat();
    let ctx = Context::default();
    beadwright_studio::fonts::set(&ctx);
    ctx.begin_pass(RawInput::default());
    let definitions = ctx.fonts(|fonts| fonts.definitions().clone());
    // What a computer without further fonts has.
    let plain = FontDefinitions {
        families: definitions.families.into_iter().map(|(family, names)| (family, without(names))).collect(),
        ..definitions
    };
    ctx.set_fonts(plain);
    ctx.end_pass().textures_delta.clear();
    ctx.begin_pass(RawInput::default());
    let english: String = table().values().map(|[english, _]| english.as_str()).collect();
    let chinese = |c: &char| ('\u{2e80}'..'\u{a000}').contains(c) || ('\u{ff00}'..'\u{fff0}').contains(c);
    for sign in code.chars().chain(english.chars()).filter(|c| !c.is_ascii() && !chinese(c)) {
        let there = ctx.fonts_mut(|fonts| fonts.has_glyph(&FontId::proportional(14.0), sign));
        assert!(there, "{sign} (U+{:04X}) is a box on a computer without further fonts", sign as u32);
    }
    ctx.end_pass().textures_delta.clear();
}

fn without(names: Vec<String>) -> Vec<String> {
    names.into_iter().filter(|name| name != "chinese").collect()
}
