//! Languages and themes.

use crate::window::{Window, click, example, has_adapter, press, sees, studio, wait};
use beadwright::fill::StrategyName;
use beadwright_studio::settings::Store;
use beadwright_studio::text::table;
use beadwright_studio::view::Side;
use eframe::egui::{Context, FontDefinitions, FontId, Key, Modifiers, Pos2, RawInput, Rect, Role, Theme, vec2};
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
    wait(&mut harness);
    assert!(sees(&harness, "完成") && sees(&harness, "沉积长度"));
    there(&harness, &["参数", "总计", "填充策略", "焊道宽度"]);
    // Findings too: what they are, why they matter, what to do.
    harness.state_mut().set_value("check.max_void", "0.01");
    wait(&mut harness);
    harness.state_mut().view().side = Side::Findings;
    harness.run_steps(3);
    there(&harness, &["空洞 (", "空洞会成为零件中的气孔和未熔合", "选用空洞更少的策略", "层：面积的", "限值为 0.01 %"]);
    assert!(harness.query_by_label_contains("stays empty").is_none());
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

/// The labels of a kind of word that are seen, with where they are.
fn places(harness: &Window, word: &str) -> Vec<Pos2> {
    let says = |text: String| text.to_lowercase().split(|c: char| !c.is_alphabetic()).any(|part| part == word);
    let nodes = harness.query_all_by(|node| {
        let text = node.label().or_else(|| node.value()).unwrap_or_default();
        // Names of parameters have hints of their own.
        [Role::Label, Role::Link, Role::DisclosureTriangle].contains(&node.role()) && says(text)
    });
    nodes.map(|node| node.rect().left_center() + vec2(12.0, 0.0)).collect()
}

/// Rests the pointer on every word of the figures and looks for its hint, and for the link to the book.
fn every_word_is_explained(harness: &mut Window, least: usize, view: &str) {
    let mut seen = 0;
    for (word, hint) in [("void", "Void: "), ("low", "Low: "), ("overfill", "Overfill: "), ("outside", "Outside: ")] {
        for pos in places(harness, word) {
            if !Rect::from_min_size(Pos2::ZERO, vec2(1280.0, 740.0)).contains(pos) {
                continue;
            }
            harness.hover_at(pos);
            harness.run_steps(8);
            let shows = |harness: &Window, text: &str| harness.query_all_by_label_contains(text).next().is_some();
            assert!(
                shows(harness, hint) && shows(harness, "More in the book"),
                "{view}: {word} at {pos} is not explained"
            );
            harness.remove_cursor();
            harness.run_steps(4);
            seen += 1;
        }
    }
    assert!(seen >= least, "{view}: only {seen} words");
}

#[test]
fn every_word_of_the_figures_is_explained_where_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = example(folder.path(), "cross");
    every_word_is_explained(&mut harness, 4, "totals");
    for limit in ["check.max_void", "check.max_overfill", "check.max_outside"] {
        harness.state_mut().set_value(limit, "0.001");
    }
    wait(&mut harness);
    for (side, least) in [(Side::Findings, 2), (Side::Plots, 2)] {
        harness.state_mut().view().side = side;
        harness.run_steps(3);
        every_word_is_explained(&mut harness, least, &format!("{side:?}"));
    }
    harness.state_mut().compare_with(Some(StrategyName::Contour));
    wait(&mut harness);
    press(&mut harness, Key::F4);
    every_word_is_explained(&mut harness, 4, "compare");
}
