//! `report.html` in a real browser, without a window: what a reader does, and nothing on the console. Where there is no
//! chromium, the tests say so and pass.
#![allow(clippy::print_stderr, reason = "says why nothing was tested")]

use crate::common;

use beadwright::check;
use beadwright::compare;
use beadwright::deposit::{Judge, Picture, picture};
use beadwright::example;
use beadwright::fill::StrategyName;
use beadwright::finding::{Finding, Severity};
use beadwright::model::RepairReport;
use beadwright::palette;
use beadwright::pass::Along;
use beadwright::plan::{self, Plan};
use beadwright::profile::Profile;
use beadwright::report::Report;
use beadwright::report::bent::Bent;
use beadwright::report::coloured::Coloured;
use beadwright::report::sheet::Sheet;
use beadwright::task::Task;
use glam::{DVec2, DVec3};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

const FLAGS: &str = "--headless --no-sandbox --disable-gpu --use-gl=angle --use-angle=swiftshader \
    --enable-unsafe-swiftshader --disable-quic --no-first-run --disable-background-networking --disable-component-update \
    --disable-sync --virtual-time-budget=300000 --dump-dom";

/// Reports faults and the steps of a test in the title of the page, which is then in the text that comes back.
const BEFORE: &str = "<script>
const faults = [];
addEventListener('error', event => faults.push(event.message));
addEventListener('unhandledrejection', event => faults.push(String(event.reason)));
console.error = (...words) => faults.push(words.join(' '));
</script>";

fn chromium() -> Option<PathBuf> {
    let named = std::env::var_os("CHROMIUM").map(PathBuf::from);
    let paths = std::env::var_os("PATH").unwrap_or_default();
    let found = std::env::split_paths(&paths).map(|folder| folder.join("chromium")).find(|file| file.is_file());
    let program = named.or(found);
    if program.is_none() {
        eprintln!("no chromium here (CHROMIUM names one): not tested");
    }
    program
}

fn page(plan: &Plan, profile: &Profile) -> String {
    let mut report = Report::new(&plan.header, profile);
    plan.layers.iter().for_each(|layer| report.layer(layer, None));
    let findings = beadwright::check::all_findings(&plan.summary, &[], &[]);
    report.finish(&plan.summary, &RepairReport::default(), &["a.src".to_owned()], &findings)
}

/// What a script (the body of an asynchronous function) gives in the page, as JSON; faults of the page fail the test.
fn ask(html: &str, script: &str) -> Option<serde_json::Value> {
    let after = format!(
        "<script>(async () => {{
           const rest = ms => new Promise(done => setTimeout(done, ms));
           while (!shown.layer || (space.scene && !solid.dataset.ready)) await rest(20);
           {script}
         }})()"
    );
    answer(html, &after)
}

/// What the promise at the end of a script, whose element is still open, gives in the page.
fn answer(html: &str, script: &str) -> Option<serde_json::Value> {
    let program = chromium()?;
    // Every test has a folder of its own, as each runs in its own thread.
    let name = std::thread::current().name().unwrap_or("page").replace(':', "-");
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("report-{name}"));
    std::fs::create_dir_all(&folder).unwrap();
    let after = format!(
        "{script}.catch(error => {{ faults.push(String(error)); return null; }})
           .then(value => {{ document.body.dataset.answer = JSON.stringify({{ value, faults }}); }});
         </script></body>"
    );
    let html = html.replace("<head>", &format!("<head>{BEFORE}")).replace("</body>", &after);
    let file = folder.join("report.html");
    std::fs::write(&file, html).unwrap();
    let mut command = Command::new(program);
    command.args(FLAGS.split_whitespace()).arg(format!("--user-data-dir={}", folder.join("user").display()));
    let output = command.arg(format!("file://{}", file.display())).stderr(Stdio::null()).output().unwrap();
    let dom = String::from_utf8(output.stdout).unwrap();
    let answer = dom.split_once("data-answer=\"").expect("the page answers").1.split_once('"').unwrap().0;
    let answer: serde_json::Value =
        serde_json::from_str(&answer.replace("&quot;", "\"").replace("&amp;", "&")).unwrap();
    assert_eq!(answer["faults"], serde_json::json!([]));
    Some(answer["value"].clone())
}

#[test]
fn layers_and_views_are_shared_by_both_pictures() {
    let profile = common::profile("cmt-al2319-kuka");
    let plan = common::planned("propeller", &profile);
    let script = "
        const first = shown.index;
        slider.value = 3;
        slider.oninput();
        while (shown.index !== 3) await rest(5);
        document.body.dispatchEvent(new KeyboardEvent('keydown', { key: 'ArrowRight', bubbles: true }));
        while (shown.index !== 4) await rest(5);
        const ramps = ['order', 'width', 'speed', 'time', 'kind'].map(by => {
          document.querySelector(`[name=colour][value=${by}]`).click();
          return [shown.by, $('key-ramp').hidden, $('range-low').value, $('ramp-high').textContent];
        });
        pointOutNext(1);
        await rest(50);
        return { first, now: $('layer-now').textContent, ramps, tip: $('tip').textContent, layers: space.scene?.layers.filter(Boolean).length };";
    let Some(answer) = ask(&page(&plan, &profile), script) else { return };
    assert_eq!(answer["first"], plan.layers.len() - 1, "the whole part is shown first");
    assert!(answer["now"].as_str().unwrap().starts_with(&format!("5 of {}", plan.layers.len())));
    let pieces = || plan.layers.iter().flat_map(|layer| &layer.passes).flat_map(|pass| pass.segments());
    let least = pieces().map(|piece| piece.width).fold(f64::MAX, f64::min);
    assert_eq!(answer["ramps"][1], serde_json::json!(["width", false, format!("{least:.2}"), "mm"]));
    assert_eq!(answer["ramps"][4][1], true);
    let tip = answer["tip"].as_str().unwrap();
    let first = plan.layers[4].passes[0].segments().next().unwrap();
    let speed = profile.process.speed_at(first.pace);
    for word in ["Layer 5, pass 1 of", &format!("{:.2} mm wide", first.width), &format!("{speed:.1} mm/s")] {
        assert!(tip.contains(word), "{word}: {tip}");
    }
    // Null where the browser has no WebGL 2.
    assert!(answer["layers"].is_null() || answer["layers"] == plan.layers.len());
}

#[test]
fn the_bead_under_the_pointer_is_the_one_that_lies_there() {
    let profile = common::profile("cmt-al2319-kuka");
    let plan = common::planned("cross", &profile);
    let top = plan.layers.last().unwrap();
    let pass = &top.passes[0];
    let middle = pass.points[0].lerp(pass.points[1], 0.5);
    let script = format!(
        "const flat = pickLayer({x}, {y}), beside = pickLayer(1e4, 1e4);
         Object.assign(space.camera, {{ yaw: 0, pitch: 1.55, fitted: true }});
         if (!space.scene) return {{ flat, beside }};
         while (space.drawing) await rest(5);
         drawSolid();
         const at = projected(space.matrix, [{x}, {y}, {z}], solid.clientWidth, solid.clientHeight);
         return {{ flat, beside, deep: pickSolid(...at), sky: pickSolid(1, 1) }};",
        x = middle.x,
        y = middle.y,
        z = top.z
    );
    let Some(answer) = ask(&page(&plan, &profile), &script) else { return };
    assert_eq!((&answer["flat"]["layer"], &answer["flat"]["pass"]), (&top.index.into(), &0.into()));
    assert!(answer["beside"].is_null());
    if !answer["deep"].is_null() {
        assert_eq!((&answer["deep"]["layer"], &answer["deep"]["pass"]), (&top.index.into(), &0.into()));
        assert!(answer["sky"].is_null());
    }
}

#[test]
fn without_webgl_a_sentence_says_so_and_the_layers_stay() {
    let profile = common::profile("cmt-al2319-kuka");
    let plan = common::planned("cross", &profile);
    let none = "<script>HTMLCanvasElement.prototype.getContext = (ask => function (kind, ...more) {
        return kind === 'webgl2' ? null : ask.call(this, kind, ...more);
    })(HTMLCanvasElement.prototype.getContext);</script></head>";
    let html = page(&plan, &profile).replace("</head>", none);
    let script = "return { view: $('stages').dataset.view, sentence: $('no-solid').textContent, passes: shown.layer.passes.length };";
    let Some(answer) = ask(&html, script) else { return };
    assert_eq!(answer["view"], "layer");
    assert!(answer["sentence"].as_str().unwrap().contains("no WebGL 2"));
    assert_eq!(answer["passes"], plan.layers.last().unwrap().passes.len());
}

/// With the layer below, beads are pink along their middle where none lies under them, and only there.
#[test]
fn what_hangs_over_the_layer_below_is_pink() {
    let profile = common::profile("cmt-al2319-kuka");
    let mut plan = common::planned("cross", &profile);
    plan.layers.truncate(2);
    for (layer, length) in plan.layers.iter_mut().zip([40.0, 80.0]) {
        let mut pass = layer.passes[0].clone();
        pass.points = [0.0, length].map(|x| DVec3::new(x, 0.0, layer.z)).to_vec();
        (pass.closed, pass.width, pass.pace) = (false, Along::Same(6.0), Along::Same(1.0));
        (layer.islands, layer.passes) = (Vec::new(), vec![pass]);
    }
    let script = "
        const pink = x => {
          const ratio = picture.width / view.width, at = v => Math.round(ratio * v);
          const [r, g, b] = picture.getContext('2d').getImageData(at(view.x + view.scale * x), at(view.y), 1, 1).data;
          return r > 200 && g < 60 && b > 100;
        };
        const seen = [];
        for (const on of [true, false]) {
          $('show-below').click();
          await show(1);
          shown.ends = false;
          draw();
          seen.push([20, 60].map(pink));
        }
        return seen;";
    let Some(answer) = ask(&page(&plan, &profile), script) else { return };
    assert_eq!(answer, serde_json::json!([[false, true], [false, false]]));
}

#[test]
fn a_finding_shows_its_layer_its_place_and_its_pass() {
    let profile = common::profile("cmt-al2319-kuka");
    let plan = common::planned("cross", &profile);
    let mut report = Report::new(&plan.header, &profile);
    plan.layers.iter().for_each(|layer| report.layer(layer, None));
    let finding = |layer, pass, place| Finding {
        layer: Some(layer),
        pass,
        place,
        ..Finding::new("void", Severity::Doubt, format!("Layer {layer}."))
    };
    let findings = [finding(3, Some(0), Some(DVec3::new(5.5, -2.25, 8.0))), finding(6, None, None)];
    let html = report.finish(&plan.summary, &RepairReport::default(), &[], &findings);
    let script = "
        const seen = [];
        for (const button of document.querySelectorAll('#warnings [data-layer]')) {
          button.click();
          await rest(200);
          const { index, picked, mark } = shown;
          seen.push({ index, pass: picked?.pass, mark: mark && [mark.x, mark.y], whole: view.fitted });
        }
        return seen;";
    let Some(answer) = ask(&html, script) else { return };
    assert_eq!(answer[0], serde_json::json!({ "index": 3, "pass": 0, "mark": [5.5, -2.25], "whole": false }));
    assert_eq!((&answer[1]["index"], &answer[1]["whole"]), (&6.into(), &true.into()));
    assert!(answer[1]["mark"].is_null());
}

#[test]
fn the_range_of_the_colours_is_chosen_and_given_back() {
    let profile = common::profile("cmt-al2319-kuka");
    let plan = common::planned("cross", &profile);
    let script = "
        document.querySelector('[name=colour][value=speed]').click();
        await rest(50);
        const seen = () => ['range-low', 'range-high'].map(id => $(id).value);
        const bead = () => { draw(); const { xy } = shown.layer.passes[0]; return [...picture.getContext('2d').getImageData(
          Math.round((view.x + view.scale * xy[0]) * picture.width / view.width) + 4, Math.round((view.y - view.scale * xy[1]) * picture.height / view.height), 1, 1).data]; };
        shown.ends = shown.travels = shown.outline = false;
        const type = (id, text) => { $(id).value = text; $(id).dispatchEvent(new Event('change')); };
        const before = seen(), paint = bead(), hidden = $('range-reset').hidden;
        type('range-high', '60');
        const wide = seen(), painted = bead(), range = lookNow({}).range;
        // Ends cannot change places, and a field cannot be empty.
        type('range-low', '90');
        const crossed = seen();
        type('range-low', '');
        const empty = seen();
        document.querySelector('[name=colour][value=width]').click();
        const other = CHOICES.width.whole;
        document.querySelector('[name=colour][value=speed]').click();
        const kept = seen();
        $('range-reset').click();
        return { before, paint, hidden, wide, painted, range, crossed, empty, other: other ?? null, kept, after: seen(), left: CHOICES.speed.whole ?? null };";
    let Some(answer) = ask(&page(&plan, &profile), script) else { return };
    let low = answer["before"][0].clone();
    assert!(answer["hidden"] == true && answer["before"] != answer["wide"], "{answer}");
    assert_eq!(answer["wide"], serde_json::json!([low, "60.0"]), "{answer}");
    assert_eq!(answer["range"][1], 60.0, "{answer}");
    assert_ne!(answer["paint"], answer["painted"], "the picture keeps its colours: {answer}");
    for same in ["crossed", "empty", "kept"] {
        assert_eq!(answer[same], answer["wide"], "{same}: {answer}");
    }
    assert!(answer["other"].is_null() && answer["left"].is_null() && answer["after"] == answer["before"], "{answer}");
}

#[test]
fn the_range_of_heights_is_chosen_and_given_back() {
    // From 0.5 mm too low to 0.5 mm too high: the left half at the lower end, the right half a quarter millimetre too high.
    let values = vec![picture::FIRST_HEIGHT, picture::FIRST_HEIGHT + 190];
    let picture = Picture { low: DVec2::ZERO, pixel: 1.0, width: 2, height: 1, values };
    let mut sheet = Sheet::new("Heights", "");
    sheet.heights(0.5, &["layer 1".to_owned()], &[("scan".to_owned(), vec![Some(&picture)])]);
    let script = "<script>(async () => {
        const rest = ms => new Promise(done => setTimeout(done, ms));
        await rest(300);
        const card = document.querySelector('.maps'), [low, high] = card.querySelectorAll('input');
        const reset = card.querySelector('button'), canvas = card.querySelector('.grid canvas');
        const seen = () => [low.value, high.value];
        const paint = async () => { await rest(300);
          return [0.25, 0.75].map(x => [...canvas.getContext('2d').getImageData(x * canvas.width, canvas.height / 2, 1, 1).data].slice(0, 3)); };
        const type = (field, text) => { field.value = text; field.dispatchEvent(new Event('change')); };
        const before = seen(), hidden = reset.hidden, whole = await paint();
        type(high, '0.2');
        const narrow = seen(), given = !reset.hidden, narrowed = await paint();
        // Ends cannot change places, and a field cannot be empty.
        type(low, '0.3');
        const crossed = seen();
        type(low, '');
        const empty = seen();
        reset.click();
        return { before, hidden, whole, narrow, given, narrowed, crossed, empty, after: seen(), back: await paint(), gone: reset.hidden,
          names: [low, high, reset].map(part => part.getAttribute('aria-label')) };
      })()";
    let Some(answer) = answer(&sheet.html(), script) else { return };
    assert_eq!(answer["before"], serde_json::json!(["-0.50", "0.50"]), "{answer}");
    assert_eq!(answer["narrow"], serde_json::json!(["-0.50", "0.20"]), "{answer}");
    assert!(answer["hidden"] == true && answer["given"] == true && answer["gone"] == true, "{answer}");
    // What is too high has the last colour of the scale, what is too low the first, as before.
    let last = palette::HEIGHTS[palette::HEIGHTS.len() - 1].1;
    assert_eq!(answer["narrowed"], serde_json::json!([palette::HEIGHTS[0].1, last]), "{answer}");
    assert_ne!(answer["whole"][1], answer["narrowed"][1], "{answer}");
    for same in ["crossed", "empty"] {
        assert_eq!(answer[same], answer["narrow"], "{same}: {answer}");
    }
    assert!(answer["after"] == answer["before"] && answer["back"] == answer["whole"], "{answer}");
    let names = ["Lowest value of the colours", "Highest value of the colours", "The whole range"];
    assert_eq!(answer["names"], serde_json::json!(names));
}

/// A report with what the deposit model says about each layer.
fn judged(plan: &Plan, profile: &Profile) -> String {
    let mut report = Report::new(&plan.header, profile);
    let judge = Judge::new(plan::deposit_settings(profile));
    let take = |i: usize, judgement| report.layer(&plan.layers[i], Some(&judgement));
    check::judge_layers(&plan.layers, profile, judge, None, &Task::new(), take).unwrap();
    report.finish(&plan.summary, &RepairReport::default(), &[], &[])
}

#[test]
fn totals_and_bars_say_whether_limits_are_kept() {
    let mut profile = common::profile("cmt-al2319-kuka");
    let plan = common::planned("cross", &profile);
    let script = "
        const seen = measure => { $('measure').value = measure; $('measure').onchange();
          const { data: pixels } = bars.getContext('2d').getImageData(0, 0, bars.width, bars.height), bad = channels(colours.bad);
          let red = 0;
          for (let i = 0; i < pixels.length; i += 4) if (bad.every((v, k) => Math.abs(pixels[i + k] - v) < 12) && pixels[i + 3] > 40) red++;
          return [bars.getAttribute('aria-label'), $('bars-now').textContent, red];
        };
        const marks = [...document.querySelectorAll('.kept, .broken')].map(mark => `${mark.className} ${mark.textContent}`);
        return { marks, voids: seen('voids'), overfill: seen('overfill'), length: seen('length') };";
    let Some(kept) = ask(&judged(&plan, &profile), script) else { return };
    let marks = kept["marks"].as_array().unwrap();
    assert_eq!(marks.len(), 3, "{kept}");
    assert!(marks.iter().all(|mark| mark.as_str().unwrap().starts_with("kept ✔ worst layer")), "{kept}");
    let count = plan.layers.len();
    assert!(kept["voids"][0].as_str().unwrap().ends_with(&format!("0 of {count} above the limit of 3.00 %")), "{kept}");
    assert!(kept["voids"][1].as_str().unwrap().ends_with(" · limit 3.00 %"), "{kept}");
    assert!(kept["voids"][2].as_u64() > Some(100), "no line: {kept}");
    assert_eq!(kept["length"][0], "Bead length of every layer as a bar");
    assert_eq!(kept["length"][2], 0, "{kept}");
    profile.check.max_overfill = 0.01;
    let Some(broken) = ask(&judged(&plan, &profile), script) else { return };
    assert!(broken["marks"][1].as_str().unwrap().starts_with("broken ✖ worst layer"), "{broken}");
    assert!(
        broken["overfill"][0].as_str().unwrap().ends_with(&format!("{count} of {count} above the limit of 0.01 %"))
    );
    assert!(broken["overfill"][2].as_u64() > kept["overfill"][2].as_u64(), "{broken}");
}

/// What a script gives of a page (`page`, its document) that is as wide as a phone.
fn on_a_phone(html: &str, script: &str) -> Option<serde_json::Value> {
    let inner = html.replace('&', "&amp;").replace('"', "&quot;");
    let outer = format!(
        "<html><head></head><body><iframe id=\"phone\" width=390 height=800 srcdoc=\"{inner}\"></iframe></body></html>"
    );
    let after = format!(
        "<script>new Promise(done => {{
           const phone = document.getElementById('phone');
           phone.onload = () => setTimeout(() => {{
             const page = phone.contentDocument, width = page.documentElement.clientWidth;
             const wide = [...page.querySelectorAll('svg.plot, canvas')].filter(node => node.getBoundingClientRect().right > width);
             done((() => {{ {script} }})());
           }}, 500);
         }})"
    );
    answer(&outer, &after)
}

#[test]
fn on_a_phone_charts_scale_and_the_first_column_stays() {
    let profile = common::profile("cmt-al2319-kuka");
    let (mesh, settings) = (example::find("cross").unwrap().mesh(), plan::deposit_settings(&profile));
    let entry = |name| compare::strategy(&mesh, &profile, name, settings, &None, &Task::new()).unwrap();
    let html = compare::page("cross", "", &[StrategyName::Loop, StrategyName::Zigzag].map(entry), None).html();
    let script = "
        const card = page.querySelector('.card.wide'), cell = card.querySelector('td');
        const before = cell.getBoundingClientRect().left;
        card.scrollLeft = 300;
        const letters = page.querySelector('svg.plot text'), shrunk = page.querySelector('svg.plot').getBoundingClientRect().width / 720;
        return {
          moved: cell.getBoundingClientRect().left - before, scrolled: card.scrollLeft, wide: wide.length,
          plots: page.querySelectorAll('svg.plot').length, maps: page.querySelectorAll('.maps canvas').length,
          letters: parseFloat(getComputedStyle(letters).fontSize) * shrunk, page: page.documentElement.scrollWidth - width,
        };";
    let Some(answer) = on_a_phone(&html, script) else { return };
    assert!(answer["scrolled"].as_f64().unwrap() > 100.0 && answer["moved"].as_f64().unwrap().abs() < 20.0, "{answer}");
    assert!(answer["plots"] == 2 && answer["maps"].as_u64() >= Some(2) && answer["wide"] == 0, "{answer}");
    assert!(answer["letters"].as_f64().unwrap() > 7.0 && answer["page"] == 0, "{answer}");

    let plan = common::planned("cross", &profile);
    let script = "
        page.querySelector('[name=colour][value=time]').click();
        const reset = page.getElementById('range-reset');
        reset.hidden = false;
        return {
          plots: page.querySelectorAll('.plots svg').length, wide: wide.length, page: page.documentElement.scrollWidth - width,
          beside: width - reset.getBoundingClientRect().right,
        };";
    for html in [page(&plan, &profile), judged(&plan, &profile)] {
        let Some(answer) = on_a_phone(&html, script) else { return };
        assert!(answer["wide"] == 0 && answer["page"] == 0, "{answer}");
        assert!(answer["beside"].as_f64().unwrap() > 16.0, "the legend leaves its card: {answer}");
    }
}

/// Surfaces of pages are drawn with all their triangles, in colours that a key names; a browser without WebGL says so.
#[test]
fn surfaces_of_pages_are_drawn() {
    let [cross, star] = ["cross", "star"].map(|name| example::find(name).unwrap().mesh());
    let mut coloured = Coloured::default();
    coloured.add("cross <b>", &cross, [200, 40, 40]);
    coloured.add("star", &star, [40, 160, 40]);
    let moved = cross.vertices.iter().map(|p| DVec3::Z * p.x.abs() * 0.01).collect();
    let (nodes, triangles) = (cross.vertices.clone(), cross.triangles.clone());
    let bent = Bent { nodes, triangles, shapes: vec![("released".to_owned(), moved)] };
    let mut sheet = Sheet::new("Surfaces", "");
    sheet.coloured("Bodies", &coloured).bent(&bent);
    let script = "<script>(async () => {
        const rest = ms => new Promise(done => setTimeout(done, ms));
        const cards = ['.coloured', '.bent'].map(name => document.querySelector(name));
        const ready = card => !card.querySelector('canvas') || [...card.querySelectorAll('canvas')].some(canvas => canvas.dataset.ready);
        while (!cards.every(ready)) await rest(20);
        const triangles = cards.map(card => Number([...card.querySelectorAll('canvas')].find(canvas => canvas.dataset.ready)?.dataset.ready));
        const pixels = card => {
          const canvas = [...card.querySelectorAll('canvas')].find(canvas => canvas.dataset.ready), gl = canvas?.getContext('webgl2');
          if (!gl) return null;
          const colours = new Uint8Array(4 * canvas.width * canvas.height);
          gl.readPixels(0, 0, canvas.width, canvas.height, gl.RGBA, gl.UNSIGNED_BYTE, colours);
          let red = 0, green = 0;
          for (let i = 0; i < colours.length; i += 4) {
            red += colours[i] > 2 * colours[i + 1];
            green += colours[i + 1] > 2 * colours[i];
          }
          return red > 100 && green > 100;
        };
        return { triangles, coloured: pixels(cards[0]), key: [...cards[0].querySelectorAll('.entry')].map(entry => entry.textContent) };
    })()";
    let Some(answer) = answer(&sheet.html(), script) else { return };
    if answer["coloured"].is_null() {
        return;
    }
    let both = cross.triangles.len() + star.triangles.len();
    assert_eq!(answer["triangles"], serde_json::json!([both, cross.triangles.len()]));
    assert_eq!(answer["coloured"], true, "both surfaces have their colours");
    assert_eq!(answer["key"], serde_json::json!(["cross <b>", "star"]));
}
