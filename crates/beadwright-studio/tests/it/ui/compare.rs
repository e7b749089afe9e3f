//! Two strategies side by side, and findings that lead to their place.

use crate::window::{Window, click, has_adapter, planned, press, sees, wait};
use beadwright::fill::{StrategyName, hybrid, one_loop};
use beadwright::plan;
use beadwright::profile::Profile;
use beadwright::report::rows;
use beadwright::task::Task;
use beadwright_studio::view::Mode;
use eframe::egui::{Key, Pos2, Rect, Role, vec2};
use egui_kittest::kittest::Queryable;
use glam::DVec2;

/// Length and passes of the cross under a strategy, as the library plans it.
fn totals(strategy: &str) -> Vec<(&'static str, String)> {
    let mut profile = Profile::built_in("cmt-al2319-kuka").unwrap();
    profile.fill.strategy = strategy.parse().unwrap();
    let mesh = beadwright::example::find("cross").unwrap().mesh();
    rows::totals(&plan::plan("cross", &mesh, &profile, &Task::new()).unwrap().summary.metrics)
}

#[test]
fn two_strategies_are_compared() {
    let (_folder, mut harness) = planned("cross");
    press(&mut harness, Key::F4);
    assert_eq!(harness.state_mut().view().mode, Mode::Compare);
    harness.get_by_role_and_label(Role::ComboBox, "Other strategy").click();
    harness.run_steps(3);
    click(&mut harness, "hybrid");
    wait(&mut harness);
    let (own, other) = (totals("loop"), totals("hybrid"));
    let mut different = 0;
    for ((name, value), (_, theirs)) in own.iter().zip(&other) {
        assert!(sees(&harness, value) && sees(&harness, theirs), "{name}: {value}, {theirs}");
        different += usize::from(value != theirs);
    }
    assert!(different > 3, "the strategies do the same");
    assert!(sees(&harness, "Layer view") && sees(&harness, "Layer view, other strategy"));
    // The project keeps its own strategy.
    assert!(harness.state().project().profile.contains("strategy = \"loop\""));
}

#[test]
fn a_finding_leads_to_its_bead() {
    let (_folder, mut harness) = planned("cross");
    harness.state_mut().set_value("check.max_speed", "1.0");
    wait(&mut harness);
    let findings = harness.state().plan().findings.clone().unwrap();
    let finding = findings.iter().filter(|f| f.pass.is_some() && f.layer > Some(0)).nth(2).unwrap();
    let (layer, pass) = (finding.layer.unwrap(), finding.pass.unwrap());
    click(&mut harness, &format!("Findings ({})", findings.len()));
    // All that say the same are one line, which opens.
    let same: Vec<_> = findings.iter().filter(|f| f.kind == finding.kind).collect();
    let ends = [same[0], same[same.len() - 1]].map(|f| f.layer.unwrap() + 1);
    click(&mut harness, &format!("{} alike (layers {}–{})", same.len(), ends[0], ends[1]));
    harness.run_steps(20);
    // A sentence begins with a capital letter.
    click(&mut harness, &finding.text.replacen("layer", "Layer", 1));
    let view = harness.state_mut().view();
    assert_eq!((view.mode, view.last), (Mode::Layer, layer));
    assert_eq!(view.chosen.map(|(l, p, _)| (l, p)), Some((layer, pass)));
    let pin = view.pin.as_ref().expect("the place is not marked");
    assert_eq!((pin.layer, Some(pin.at)), (layer, finding.place));
    click(&mut harness, "Totals");
    let length = harness.state().plan().layers[layer].passes[pass].length();
    assert!(sees(&harness, &format!("{length:.2} mm")));
}

#[test]
fn two_strategies_are_seen_in_3d_with_one_camera() {
    if !has_adapter() {
        return;
    }
    let (_folder, mut harness) = planned("cross");
    harness.state_mut().compare_with(Some(StrategyName::Zigzag));
    wait(&mut harness);
    press(&mut harness, Key::F4);
    click(&mut harness, "In 3-D");
    harness.remove_cursor();
    harness.run_steps(4);
    let views = ["3-D view", "3-D view, other strategy"];
    let picture = |harness: &mut Window, view: &str| {
        let rect = harness.get_by_label(view).rect();
        let whole = harness.render().unwrap();
        let (x, y) = (rect.left().ceil() as u32, rect.top().ceil() as u32);
        let size = [rect.width() as u32 - 2, rect.height() as u32 - 2];
        image::imageops::crop_imm(&whole, x, y, size[0], size[1]).to_image()
    };
    // The plate is the same, at the same place; the beads are others.
    let alike = |harness: &mut Window| {
        let [own, other] = views.map(|view| picture(harness, view));
        let same = own.pixels().zip(other.pixels()).filter(|(a, b)| a == b).count();
        same as f64 / f64::from(own.width() * own.height())
    };
    let before = alike(&mut harness);
    assert!((0.4..0.98).contains(&before), "{before:.2} of the pixels are the same");
    // When either is turned, the other follows.
    for view in views {
        let (middle, was) = (harness.get_by_label(view).rect().center(), picture(&mut harness, views[0]));
        harness.drag_at(middle);
        harness.run_steps(1);
        harness.hover_at(middle + eframe::egui::vec2(60.0, 10.0));
        harness.run_steps(2);
        harness.drop_at(middle + eframe::egui::vec2(60.0, 10.0));
        harness.remove_cursor();
        harness.run_steps(6);
        let now = alike(&mut harness);
        assert!((0.4..0.98).contains(&now), "{view} turned: {now:.2} of the pixels are the same");
        assert!(picture(&mut harness, views[0]) != was, "{view} was not turned");
    }
}

/// The colour in the picture of the window at a place.
fn colour(picture: &image::RgbaImage, pos: Pos2) -> [u8; 3] {
    let [r, g, b, _] = picture.get_pixel(pos.x.floor() as u32, pos.y.floor() as u32).0;
    [r, g, b]
}

#[test]
fn the_steps_of_both_strategies_are_seen() {
    if !has_adapter() {
        return;
    }
    let (_folder, mut harness) = planned("cross");
    // Left to itself, the hybrid fills no region of the cross.
    harness.state_mut().set_value("hybrid.pocket_depth", "1.5");
    wait(&mut harness);
    harness.state_mut().compare_with(Some(StrategyName::Hybrid));
    wait(&mut harness);
    press(&mut harness, Key::F4);
    // Only lines and marks of the steps are to be seen.
    for hidden in ["Beads", "Path", "Travels", "Starts and ends"] {
        click(&mut harness, hidden);
    }
    click(&mut harness, "Steps");
    wait(&mut harness);
    harness.remove_cursor();
    harness.run_steps(4);
    let picture = harness.render().unwrap();
    let [own, theirs] = ["Layer view", "Layer view, other strategy"].map(|view| harness.get_by_label(view).rect());
    // The 100 mm of the cross fill a view but for a margin of 15 %.
    let at = |rect: Rect, p: DVec2| {
        let scale = f64::from(rect.width().min(rect.height())) / 115.0;
        rect.center() + vec2((p.x * scale) as f32, (-p.y * scale) as f32)
    };
    // Flips and rings, as the library has them for this layer.
    let plan = harness.state().plan();
    let (profile, layer) = (plan.profile.clone().unwrap(), plan.layers.last().unwrap().clone());
    let steps = one_loop::steps(&layer.islands[0], &profile.fill_settings(layer.index));
    let [(steps, middle)] = &steps[..] else { panic!("one island") };
    assert!(!steps.flips.is_empty());
    for flip in &steps.flips {
        assert_eq!(colour(&picture, at(own, *flip + *middle)), [0xf2, 0xd0, 0x2c], "no mark at {flip}");
    }
    let near = |pos: Pos2, wanted: fn([u8; 3]) -> bool| {
        let around = (-2..=2).flat_map(|x| (-2..=2).map(move |y| vec2(x as f32, y as f32)));
        around.into_iter().any(|by| wanted(colour(&picture, pos + by)))
    };
    let pink = |[r, g, b]: [u8; 3]| r > 150 && g < 100 && b > 90;
    let marked = |point: &DVec2| steps.flips.iter().any(|flip| flip.distance(*point) < 4.0);
    for point in steps.rings.iter().flat_map(|ring| &ring.points).filter(|point| !marked(point)) {
        assert!(near(at(own, *point + *middle), pink), "no ring at {point}");
    }
    // The regions of the hybrid lie in the other view only.
    let settings = profile.fill_settings(layer.index);
    let regions = hybrid::Steps::of(&layer.islands[0], &settings).regions;
    let teal = |[r, g, b]: [u8; 3]| r < 70 && g > 110 && b > 110;
    let mut corners = 0;
    for point in regions.rings().flat_map(|ring| ring.points()) {
        assert!(near(at(theirs, *point), teal), "no region at {point}");
        corners += 1;
    }
    assert!(corners > 3, "the hybrid has no region in this layer");
    for legend in [own, theirs] {
        assert!(near(legend.right_top() + vec2(-40.0, 14.0), |c| c.iter().all(|v| *v > 90)), "no legend");
    }
}

#[test]
fn the_totals_of_a_comparison_fit_the_window() {
    let (_folder, mut harness) = planned("propeller");
    harness.state_mut().compare_with(Some(StrategyName::Hybrid));
    wait(&mut harness);
    harness.key_press(Key::F4);
    harness.run_steps(4);
    let plan = harness.state().plan();
    let values = rows::totals(&plan.summary.as_ref().unwrap().metrics);
    let cells: Vec<Rect> =
        values.iter().flat_map(|(_, value)| harness.query_all_by_label(value)).map(|n| n.rect()).collect();
    assert!(cells.len() >= 2 * values.len() - 2, "{} of {} totals are shown twice", cells.len(), values.len());
    for (i, cell) in cells.iter().enumerate() {
        assert!(cell.left() >= 0.0 && cell.right() <= 1280.0, "{cell} is cut off");
        assert!(
            cells[..i].iter().all(|other| other == cell || !other.shrink(1.0).intersects(*cell)),
            "{cell} overlaps"
        );
    }
}
