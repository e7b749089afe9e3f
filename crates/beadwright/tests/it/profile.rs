//! Profiles: the built-in ones, and what is said of a wrong one, with its line and key.

use beadwright::bead::MassBalance;
use beadwright::deposit::Judge;
use beadwright::dialect;
use beadwright::fill::StrategyName;
use beadwright::plan::deposit_settings;
use beadwright::process::StartStop;
use beadwright::profile::{BUILT_IN, Profile};
use toml_edit::{Document, DocumentMut, Item, Value};

const KUKA: &str = "cmt-al2319-kuka";
const CNC: &str = "plasma-304-cnc";
const ROBOTS: &str = "cmt-steel-robots";
const ABB: &str = "cmt-steel-abb";

fn text(name: &str) -> &'static str {
    Profile::built_in_text(name).unwrap()
}

/// Line, from 1, on which the first occurrence of `words` stands.
fn line_of(text: &str, words: &str) -> usize {
    text[..text.find(words).unwrap()].matches('\n').count() + 1
}

/// The message about a profile names the line and contains the words.
fn check_text(text: &str, line: usize, expect: &[&str]) {
    let error = Profile::parse(text).expect_err("the profile was taken").to_string();
    assert!(error.starts_with(&format!("line {line} of the profile: ")), "{error:?} is not about line {line}");
    assert!(expect.iter().all(|words| error.contains(words)), "{error:?} lacks one of {expect:?}");
}

/// Replaces `old` in the profile and expects a message about the line of `new`.
fn check(profile: &str, old: &str, new: &str, expect: &[&str]) {
    let edited = text(profile).replacen(old, new, 1);
    assert_ne!(edited, text(profile), "{old:?} does not stand in {profile}");
    check_text(&edited, line_of(&edited, new), expect);
}

#[test]
fn built_in_profiles_have_no_notes() {
    for (name, _) in BUILT_IN {
        let profile = Profile::built_in(name).unwrap();
        assert_eq!(profile.name, name);
        assert_eq!(profile.notes(), [""; 0], "{name}");
        assert!((profile.mass_balance().ratio() - 1.0).abs() < 0.01, "{name}: {}", profile.mass_balance().ratio());
        assert!(!profile.posts.is_empty() && !profile.description.is_empty());
        for post in &profile.posts {
            assert!(dialect::writer(post, &profile.job("part")).is_ok(), "{name} names the post {post}");
        }
    }
}

#[test]
fn a_misspelt_name_gets_the_nearest_or_all() {
    let error = |name: &str| Profile::built_in(name).unwrap_err().to_string();
    assert!(error("plasma-304-cn").contains("Did you mean \"plasma-304-cnc\"?"));
    assert!(
        error("zzz").contains(&format!("Known profiles: {KUKA}, {ABB}, {ROBOTS}, {CNC}, plasma-304-fanuc")),
        "{}",
        error("zzz")
    );
}

#[test]
fn a_post_without_its_section_is_refused() {
    let Err(error) = dialect::writer("krl", &Profile::built_in(CNC).unwrap().job("part")) else {
        panic!("it was taken")
    };
    let error = error.to_string();
    assert!(error.contains("no [krl] section") && error.ends_with('.'), "{error}");
}

#[test]
fn twenty_mm_per_second_breaks_the_mass_balance_of_zhao() {
    let mut profile = Profile::built_in(KUKA).unwrap();
    profile.process.deposition_speed = 20.0;
    let notes = profile.notes();
    assert_eq!(notes.len(), 1);
    assert!(notes[0].contains("A deposition_speed of 10.49 mm/s would fit"), "{}", notes[0]);
    // 6 m/min of 1.2 mm wire against 2/3 · 7.54 · 2.145 mm².
    let expect = 100.0 * std::f64::consts::PI * 0.36 / (2.0 / 3.0 * 7.54 * 2.145);
    assert!((profile.mass_balance().fitting_speed - expect).abs() < 1e-9);
}

#[test]
fn layers_that_beads_do_not_rise_to_are_noted() {
    let mut profile = Profile::built_in(KUKA).unwrap();
    profile.layers.height = 3.0;
    let notes = profile.notes();
    assert_eq!(notes.len(), 1);
    assert!(notes[0].contains("rise 2.00 mm per layer, but layers are 3.00 mm"), "{}", notes[0]);
    assert!(notes[0].contains("A bead.height of 3.22 mm or a layers.height of 2.00 mm would fit"), "{}", notes[0]);
    profile.layers.height = 2.0 * (1.0 + 0.9 * MassBalance::TOLERANCE);
    assert_eq!(profile.notes(), [""; 0]);
}

#[test]
fn stepover_comes_from_the_overlap() {
    let stepover = |name: &str| Profile::built_in(name).unwrap().stepover();
    assert!((stepover(KUKA) - 0.715 * 7.54).abs() < 1e-12);
    assert!((stepover(CNC) - 0.738 * 5.0).abs() < 1e-12);
    let free = text(CNC).replace("overlap = \"tangent\"", "overlap = \"free\"\nstepover = 3.5");
    assert_eq!(Profile::parse(&free).unwrap().stepover(), 3.5);
}

#[test]
fn raster_angles_turn_as_the_profile_says() {
    let angles = |turn: &str, increment: f64| {
        let text = text(KUKA).replace("raster_turn = \"alternate\"", &format!("raster_turn = \"{turn}\""));
        let mut profile = Profile::parse(&text).unwrap();
        profile.fill.raster_increment = increment;
        [0, 1, 2, 3].map(|k| profile.fill_settings(k).raster_angle.to_degrees().round())
    };
    assert_eq!(angles("fixed", 67.0), [0.0; 4]);
    assert_eq!(angles("alternate", 67.0), [0.0, 90.0, 0.0, 90.0]);
    assert_eq!(angles("increment", 67.0), [0.0, 67.0, 134.0, 21.0]);
}

#[test]
fn unknown_keys_get_the_nearest() {
    check(KUKA, "diameter =", "diametre =", &["unknown key \"diametre\"", "Did you mean \"diameter\"?"]);
    check(KUKA, "deposition_speed =", "depositon_speed =", &["Did you mean \"deposition_speed\"?"]);
    check(KUKA, "[travel]", "[travels]", &["unknown key \"travels\"", "Did you mean \"travel\"?"]);
    check(
        CNC,
        "decimals =",
        "qqq = 1\ndecimals =",
        &["unknown key \"qqq\"", "Possible here: extension, block_numbers"],
    );
    check(CNC, "close_gap =", "closegap =", &["Did you mean \"close_gap\"?"]);
}

#[test]
fn unknown_words_get_the_nearest() {
    check(
        KUKA,
        "\"inclined-flat-top\"",
        "\"inclined-flat\"",
        &["unknown value", "Did you mean \"inclined-flat-top\"?"],
    );
    check(KUKA, "\"outside-in\"", "\"outside_in\"", &["Did you mean \"outside-in\"?"]);
    check(KUKA, "\"alternate\"", "\"alternating\"", &["Did you mean \"alternate\"?"]);
    check(
        KUKA,
        "\"loop\"",
        "\"serpentine\"",
        &["unknown value \"serpentine\"", "loop, raster, zigzag, contour, compound"],
    );
    check(KUKA, "\"loop\"", "\"lop\"", &["Did you mean \"loop\"?"]);
    check(KUKA, "\"fitted\"", "\"zzz\"", &["unknown value \"zzz\"", "even, exact"]);
}

#[test]
fn a_strategy_has_the_same_name_in_profiles_and_commands() {
    for &name in StrategyName::ALL {
        assert_eq!((serde_json::json!(name), name.name().parse()), (serde_json::json!(name.name()), Ok(name)));
    }
}

#[test]
fn missing_keys_are_named_at_their_section() {
    for (section, key) in
        [("wire", "density"), ("process", "ctwd"), ("bead", "height"), ("fill", "strategy"), ("krl", "home")]
    {
        let mut document: DocumentMut = text(KUKA).parse().unwrap();
        document[section].as_table_mut().unwrap().remove(key).unwrap();
        let edited = document.to_string();
        check_text(&edited, line_of(&edited, &format!("\n[{section}]\n")) + 1, &[&format!("\"{key}\" is missing")]);
    }
    let error = Profile::parse(text(CNC).split("[travel]").next().unwrap()).unwrap_err().to_string();
    let keys = ["travel.clearance", "travel.speed"];
    assert!(keys.iter().all(|key| error.contains(key)) && error.contains("keys are missing: "), "{error}");
}

#[test]
fn all_missing_keys_are_reported_at_once() {
    for (name, full) in BUILT_IN {
        // What a profile without one key lacks, it lacks together with all others.
        let document: DocumentMut = full.parse().unwrap();
        let alone = |section: &str, key: &str| {
            let mut without = document.clone();
            without[section].as_table_mut().unwrap().remove(key);
            Profile::parse(&without.to_string()).is_err_and(|error| error.to_string().contains("is missing here"))
        };
        let mut bare = document.clone();
        let mut needed = Vec::new();
        for (section, item) in document.iter() {
            let Some(table) = item.as_table() else { continue };
            for (key, _) in table.iter().filter(|(key, _)| alone(section, key)) {
                bare[section].as_table_mut().unwrap().remove(key);
                needed.push(format!("{section}.{key}"));
            }
        }
        let error = Profile::parse(&bare.to_string()).unwrap_err().to_string();
        let reported = error.split_once("keys are missing: ").unwrap().1.trim_end_matches('.');
        let mut reported: Vec<&str> = reported.split(", ").collect();
        reported.sort_unstable();
        needed.sort_unstable();
        assert_eq!(reported, needed, "{name}");
    }
    // Missing sections are reported key by key; keys that are there are not.
    let error = Profile::parse("name = \"empty\"\n[wire]\ndiameter = 1.2\n").unwrap_err().to_string();
    assert!(error.starts_with("line 1 of the profile: ") || error.starts_with("line 2 of the profile: "), "{error}");
    for key in ["description", "posts", "wire.density", "process.deposition_speed", "bead.width", "travel.clearance"] {
        assert!(error.contains(&format!(" {key}")), "{key}: {error}");
    }
    assert!(!error.contains("wire.diameter") && !error.contains("name,"), "{error}");
}

#[test]
fn only_optional_keys_may_be_missing() {
    let optional = [
        "process.current",
        "process.voltage",
        "slice.close_gap",
        "slice.simplify",
        "fill.perimeters_first",
        "fill.infill_density",
        "fill.solid_layers",
        "gcode.comments",
        "gcode.hooks",
        "gcode.dwell",
        "gcode.percent_signs",
        "gcode.program_number",
        "gcode.wire_axis",
        "krl.arc",
        "krl.arctech",
        "krl.hooks",
        "krl.routines",
        "layers.level",
        "urscript.hooks",
        "urscript.routines",
        "safety.supplies",
        "safety.arc_timeout",
        "safety.arc_tries",
        "safety.gas_halt",
        "rapid.hooks",
        "gcode.control",
        "marlin.bed",
        "rapid.tool_frame",
        "rapid.part_frame",
        "start_stop.crater_fill_time",
        "urscript.tool_frame",
    ];
    for (name, full) in BUILT_IN {
        let document: DocumentMut = full.parse().unwrap();
        for (section, item) in document.iter() {
            let Some(table) = item.as_table() else { continue };
            for (key, _) in table.iter() {
                let mut without = document.clone();
                without[section].as_table_mut().unwrap().remove(key);
                let path = format!("{section}.{key}");
                let taken = Profile::parse(&without.to_string()).is_ok();
                assert_eq!(taken, optional.contains(&path.as_str()), "{name} without {path}");
            }
        }
    }
    let without_slice =
        text(KUKA).replace("[slice]\nclose_gap = 0.5           # mm\nsimplify = 0.01           # mm\n", "");
    assert_ne!(without_slice, text(KUKA));
    assert_eq!(Profile::parse(&without_slice).unwrap().slice, Profile::built_in(KUKA).unwrap().slice);
}

/// The example in the comments of a built-in profile is one: it is taken as it stands, without its `#`.
#[test]
fn the_example_of_starts_and_stops_is_valid() {
    let (head, rest) = text(KUKA).split_once("# [start_stop]").unwrap();
    let (example, rest) = rest.split_once("\n\n").unwrap();
    let mut profile = Profile::parse(&format!("{head}[start_stop]{}\n{rest}", example.replace("\n# ", "\n"))).unwrap();
    assert!(profile.start_stop.end_overlap > 0.0 && profile.start_stop.min_layer_time > 0.0);
    assert_eq!(profile.notes(), [""; 0]);
    assert!(dialect::writer("krl", &profile.job("part")).is_ok());
    // It changes nothing else.
    profile.start_stop = StartStop::default();
    assert_eq!(profile, Profile::built_in(KUKA).unwrap());
    // What follows the bead is a word of its own.
    let text = text(ROBOTS).replace("deposition_speed = 8.0 ", "follow = \"wire\"\ndeposition_speed = 8.0 ");
    check_text(&text, line_of(&text, "follow ="), &["Did you mean \"wire-feed\"?"]);
}

#[test]
fn wrong_types_are_refused_with_their_line() {
    check(KUKA, "diameter = 1.2", "diameter = \"thick\"", &["string \"thick\"", "f64"]);
    check(KUKA, "perimeters = 1", "perimeters = 1.5", &["floating point `1.5`", "u32"]);
    check(KUKA, "perimeters = 1", "perimeters = -1", &["-1", "u32"]);
    check(KUKA, "posts = [\"krl\"]", "posts = \"krl\"", &["sequence"]);
    check(KUKA, "orientation = [0.0, 0.0, 180.0]", "orientation = [0.0, 0.0]", &["array of length 3"]);
    check(CNC, "block_numbers = true", "block_numbers = \"yes\"", &["string \"yes\"", "boolean"]);
    // Whole numbers are numbers.
    assert!(Profile::parse(&text(KUKA).replace("height = 2.0 ", "height = 2 ")).is_ok());
}

#[test]
fn what_is_no_toml_is_refused_with_its_line() {
    check(KUKA, "density = 2.82", "density = = 2.82", &[]);
    check(KUKA, "[bead]", "[bead", &[]);
    check(KUKA, "height = 2.0", "height = 2,0", &[]);
    check(KUKA, "density = 2.82", "diameter = 1.4", &["duplicate key"]);
    assert!(Profile::parse("").unwrap_err().to_string().contains("keys are missing: name, description"));
}

/// Sets `section.key` in a built-in profile and expects it to be called impossible, on its line.
fn impossible(profile: &str, path: &str, value: impl Into<Value>) {
    let mut document: DocumentMut = text(profile).parse().unwrap();
    let (section, key) = path.split_once('.').unwrap_or(("", path));
    let table = if section.is_empty() { document.as_table_mut() } else { document[section].as_table_mut().unwrap() };
    table[key] = Item::Value(value.into());
    let edited = document.to_string();
    let spans = Document::parse(edited.as_str()).unwrap();
    let table = if section.is_empty() { spans.as_table() } else { spans[section].as_table().unwrap() };
    let (at, item) = table.get_key_value(key).unwrap();
    let line = edited[..at.span().unwrap().start].matches('\n').count() + 1;
    let shown = item.to_string().to_lowercase();
    check_text(&edited, line, &[&format!("{path} = "), "is impossible"]);
    let error = Profile::parse(&edited).unwrap_err().to_string();
    assert!(
        item.is_array() || error.to_lowercase().contains(shown.trim().trim_end_matches(".0")),
        "{error:?} does not show {shown}"
    );
}

#[test]
fn impossible_numbers_are_refused_with_line_and_key() {
    let both = [
        ("wire.diameter", 0.09, 10.1),
        ("wire.density", 0.4, 25.5),
        ("process.wire_feed_speed", 0.0, 101.0),
        ("process.deposition_speed", 0.0, 2001.0),
        ("process.efficiency", 0.0, 1.01),
        ("process.arc_start_delay", -0.1, 61.0),
        ("process.arc_end_delay", -0.1, 61.0),
        ("process.gas_flow", -1.0, 201.0),
        ("process.gas_preflow", -0.1, 61.0),
        ("process.gas_postflow", -0.1, 61.0),
        ("process.ctwd", -1.0, 101.0),
        ("process.current", 0.0, 2001.0),
        ("process.voltage", -5.0, 501.0),
        ("bead.width", 0.0, 101.0),
        ("bead.height", -1.0, 51.0),
        ("layers.height", 0.0, 51.0),
        ("fill.contour_gap", 0.05, 2.1),
        ("fill.machining_allowance", -0.1, 51.0),
        ("fill.raster_angle", -361.0, 361.0),
        ("fill.raster_increment", -361.0, 361.0),
        ("fill.min_pass_length", -1.0, 1001.0),
        ("slice.close_gap", -0.1, 1001.0),
        ("slice.simplify", -0.1, 3.0),
        ("travel.speed", 0.0, 3001.0),
        ("travel.clearance", -1.0, 1001.0),
    ];
    for (path, low, high) in [
        ("end_overlap", -0.1, 201.0),
        ("lead_in_length", -0.1, 201.0),
        ("lead_in_power", 0.99, 4.1),
        ("lead_out_length", -0.1, 201.0),
        ("lead_out_power", 0.05, 1.01),
        ("crater_fill_time", -0.1, 61.0),
        ("crater_power", 0.0, 1.01),
        ("wire_retract", -0.1, 51.0),
        ("interpass_time", -0.1, 36_001.0),
        ("min_layer_time", -0.1, 36_001.0),
        ("dwell_height", -0.1, 2001.0),
    ] {
        for value in [low, high] {
            let edited = format!("{}\n[start_stop]\n{path} = {value}\n", text(KUKA));
            let key = format!("start_stop.{path} = {value}");
            check_text(&edited, line_of(&edited, &format!("\n{path} = {value}")) + 1, &[&key, "is impossible"]);
        }
    }
    let both = both.map(|(path, low, high)| (KUKA, path, low, high)).into_iter().chain([
        (KUKA, "krl.ptp_speed", 0.5, 101.0),
        (KUKA, "krl.blend", -0.1, 51.0),
        (CNC, "bead.width", f64::NEG_INFINITY, 1e9),
        (ABB, "rapid.home_speed", 0.0, 3001.0),
        (ABB, "rapid.orientation_speed", 0.0, 1001.0),
        (ABB, "rapid.zone", -0.1, 51.0),
        (ABB, "rapid.speed_step", 0.0, 101.0),
        (ABB, "rapid.voltage", -101.0, 101.0),
        (ABB, "rapid.control", -101.0, 101.0),
        (ROBOTS, "fanuc.home_speed", 0.5, 101.0),
        (ROBOTS, "inform.home_speed", 0.0, 101.0),
        (ROBOTS, "urscript.home_speed", 0.0, 181.0),
        (ROBOTS, "urscript.acceleration", 0.0, 20_001.0),
        (ROBOTS, "urscript.blend", -0.1, 51.0),
    ]);
    for (profile, path, low, high) in both {
        for value in [low, high, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            impossible(profile, path, value);
        }
    }
}

#[test]
fn impossible_counts_are_refused_with_line_and_key() {
    for (profile, path, low, high) in [
        (KUKA, "fill.perimeters", 0, 1001),
        (KUKA, "krl.tool", 0, 17),
        (KUKA, "krl.base", 0, 33),
        (CNC, "gcode.decimals", 0, 5),
        (ROBOTS, "fanuc.tool_frame", 0, 30),
        (ROBOTS, "fanuc.max_points", 9, 3001),
        (ROBOTS, "inform.user_frame", 0, 64),
        (ROBOTS, "inform.max_name", 7, 33),
        (ROBOTS, "inform.max_points", 9, 2001),
    ] {
        impossible(profile, path, low);
        impossible(profile, path, high);
    }
    impossible(ABB, "rapid.schedule", 10_000);
    impossible(ABB, "rapid.mode", 100);
    impossible(ROBOTS, "fanuc.user_frame", 62);
    impossible(ROBOTS, "fanuc.continuity", 101);
    impossible(ROBOTS, "inform.tool", 64);
    impossible(ROBOTS, "inform.position_level", 9);
    impossible(KUKA, "krl.orientation", [0.0, 400.0, 0.0].into_iter().collect::<Value>());
}

#[test]
fn impossible_words_are_refused_with_line_and_key() {
    impossible(KUKA, "posts", ["krl", "abb"].into_iter().collect::<Value>());
    check(
        KUKA,
        "[\"krl\"]",
        "[\"abb\"]",
        &["posts = \"abb\"", "the posts are krl, gcode, marlin, rapid, fanuc, inform, urscript"],
    );
    impossible(CNC, "gcode.extension", "../nc");
    impossible(CNC, "gcode.extension", "");
    impossible(KUKA, "krl.home", "X 0,Y 0");
    impossible(ROBOTS, "fanuc.configuration", "N'U");
    impossible(ROBOTS, "inform.group", "RB 1");
    impossible(ROBOTS, "inform.configuration", "x");
    impossible(ROBOTS, "inform.date", "today");
    impossible(KUKA, "krl.home", "A1 0}; HALT");
    for name in ["tool0", "1st", "a b", "smBead", "v100", "a_name_of_more_than_32_characters"] {
        impossible(ABB, "rapid.tool", name);
    }
    impossible(ABB, "rapid.wobj", "fine");
    impossible(ABB, "rapid.wobj", "TTORCH");
    for folder in ["", "HOME:/part/", "HOME:/my part", "HOME:/a_folder_of_more_than_forty_characters"] {
        impossible(ABB, "rapid.folder", folder);
    }
}

#[test]
fn frames_loads_and_seams_of_rapid_are_checked() {
    check(ABB, "orientation = [0.0, 1.0", "orientation = [0.5, 1.0", &["rapid.orientation = 1.118", "quaternion"]);
    check(ABB, "0.9238795, 0.0, 0.3826834", "0.9, 0.0, 0.3", &["rapid.tool_frame", "quaternion"]);
    check(ABB, "part_frame = [900.0", "part_frame = [9e9", &["rapid.part_frame", "mm"]);
    check(ABB, "tool_load = [4.5, 30.0, 0.0, 120.0]", "tool_load = [4.5, 0.0, 0.0, 0.0]", &["centre of gravity"]);
    check(ABB, "tool_load = [4.5", "tool_load = [0.0", &["rapid.tool_load = 0", "kg"]);
    check(ABB, "arc = \"instructions\"", "arc = \"plane\"", &["Did you mean \"plain\"?"]);
    check(ABB, "wire_feed_unit = \"m/min\"", "wire_feed_unit = \"m/h\"", &["m/min", "mm/s"]);
    check(ABB, "fill_time = 0.3\n", "fill_time = -1.0\n", &["rapid.seam.fill_time = -1", "between 0 and 60 s"]);
    check(ABB, "heat_feed = 1.0", "heat_feed = 6.0", &["rapid.seam.heat_feed", "of the wire feed"]);
}

#[test]
fn ranges_depend_on_the_bead() {
    let free = |stepover: &str| {
        text(CNC).replace("overlap = \"tangent\"", &format!("overlap = \"free\"\nstepover = {stepover}"))
    };
    assert!(Profile::parse(&free("1.0")).is_ok() && Profile::parse(&free("10.0")).is_ok());
    for bad in ["0.9", "10.1"] {
        let line = line_of(&free(bad), "stepover = ");
        check_text(&free(bad), line, &["fill.stepover", "between 1 and 10 mm (0.2 to 2 bead widths)"]);
    }
    check(
        CNC,
        "simplify = 0.01",
        "simplify = 1.1",
        &["slice.simplify", "between 0 and 1 mm (at most 0.2 bead widths)"],
    );
}

#[test]
fn a_stepover_is_given_exactly_with_a_free_overlap() {
    let both = "overlap = \"tangent\"\nstepover = 3.5";
    let edited = text(CNC).replace("overlap = \"tangent\"", both);
    check_text(
        &edited,
        line_of(&edited, "stepover = 3.5"),
        &["fill.stepover = 3.5 is impossible", "overlap = \"free\""],
    );
}

#[test]
fn tolerances_of_programs_are_checked() {
    let with = |lines: &str| format!("{}\n[program]\n{lines}", text(CNC));
    for (lines, line, part) in [
        ("chord_tolerance = 0.01", "chord_tolerance", "0.015 mm or more"),
        ("chord_tolerance = 3.0", "chord_tolerance", "half a bead width"),
        ("arcs = true", "[program]", "needs a tolerance"),
        ("speed_tolerance = 0.5", "speed_tolerance", "of the speed"),
        ("torch_angle = 361.0", "torch_angle", "between -360 and 360 °"),
        ("follow_wall = 1.2", "follow_wall", "between 0 and 1"),
        ("max_work_angle = 50.0", "max_work_angle", "between 0 and 45 °"),
        ("travel_angle = -31.0", "travel_angle", "between -30 and 30 °"),
        ("table_angle = 5.0\ntable_side = 90.0", "table_side", "remove one of them"),
        ("min_point_time = 1.5", "min_point_time", "between 0 and 1 s"),
        ("min_point_time = 0.012", "[program]", "needs a tolerance"),
    ] {
        let edited = with(lines);
        check_text(&edited, line_of(&edited, line), &["program.", "is impossible", part]);
    }
    let coarse = with("chord_tolerance = 0.05\narcs = true").replace("decimals = 3", "decimals = 2");
    check_text(&coarse, line_of(&coarse, "chord_tolerance"), &["3 gcode.decimals"]);
    assert!(Profile::parse(&with("chord_tolerance = 0.05\narcs = true")).is_ok());
}

#[test]
fn a_free_overlap_without_a_stepover_is_refused_at_its_line() {
    check(CNC, "overlap = \"tangent\"", "overlap = \"free\"", &["stepover", "free"]);
}

#[test]
fn templates_with_unknown_placeholders_are_refused() {
    let key = |name: &str, key: &str, line: &str| {
        let mut document: DocumentMut = text(name).parse().unwrap();
        let (section, item) = key.split_once('.').unwrap();
        document[section][item] = Item::Value([line].into_iter().collect::<Value>());
        let edited = document.to_string();
        let head = edited.find(&format!("\n[{section}]")).unwrap();
        let line = line_of(&edited[head..], &format!("\n{item} = ")) + edited[..head].matches('\n').count() + 1;
        check_text(&edited, line, &[key, "is impossible"]);
        Profile::parse(&edited).unwrap_err().to_string()
    };
    for part in ["start", "layer_start", "arc_on", "arc_off", "end"] {
        let error = key(KUKA, &format!("krl.{part}"), "WAIT SEC {{gas_preflw}}");
        assert!(error.contains("{{gas_preflw}} is not a placeholder; the placeholders are program, layer"), "{error}");
    }
    for part in ["start", "layer_start", "arc_on", "arc_off", "end"] {
        key(ABB, &format!("rapid.{part}"), "SetDO doGas,{{gas}};");
        for section in ["fanuc", "inform", "urscript"] {
            key(ROBOTS, &format!("{section}.{part}"), "WAIT {{gas}}");
        }
    }
    for part in ["wire_feed", "crater"] {
        for (name, section) in
            [(KUKA, "krl"), (CNC, "gcode"), (ABB, "rapid"), (ROBOTS, "fanuc"), (ROBOTS, "inform"), (ROBOTS, "urscript")]
        {
            key(name, &format!("{section}.{part}"), "{{wire_feed_rate}}");
        }
    }
    key(CNC, "gcode.dwell", "G4 P{{dwel}}");
    for part in ["header", "layer_start", "arc_on", "arc_off", "footer"] {
        let error = key(CNC, &format!("gcode.{part}"), "(Grüße)");
        assert!(error.contains("printable ASCII"), "{error}");
        key(CNC, &format!("gcode.{part}"), "M3\nM5");
    }
}

#[test]
fn templates_with_a_placeholder_that_does_not_end_are_refused() {
    check(CNC, "arc_on = [", "arc_on = [\"G4 P{{gas_preflow}\", ", &["gcode.arc_on", "is impossible"]);
    check(CNC, "arc_on = [", "arc_on = [\"G4 P{{gas_preflow}} S{{\", ", &["gcode.arc_on", "is impossible"]);
}

#[test]
fn values_written_in_another_style_have_their_line_too() {
    let inline = text(CNC).replace("[bead]\nwidth = 5.0               # mm\nheight = 1.5              # mm\n", "");
    let inline = inline.replace("[wire]", "[bead]\nheight = 1.5\n\"width\" = 500.0\n\n[wire]");
    check_text(&inline, line_of(&inline, "\"width\""), &["bead.width = 500"]);
    let inline = inline.replace("[bead]\nheight = 1.5\n\"width\" = 500.0\n", "");
    let inline = inline.replace("posts =", "bead = { height = 1.5, width = 500.0 }\nposts =");
    check_text(&inline, line_of(&inline, "bead = {"), &["bead.width = 500"]);
}

#[test]
fn profiles_survive_being_written() {
    for (name, _) in BUILT_IN {
        let mut profile = Profile::built_in(name).unwrap();
        assert_eq!(Profile::parse(&toml::to_string(&profile).unwrap()).unwrap(), profile);
        profile.process.current = Some(120.0);
        profile.process.voltage = Some(20.5);
        assert_eq!(Profile::parse(&toml::to_string_pretty(&profile).unwrap()).unwrap(), profile);
        assert!((profile.heat_input().unwrap() - 120.0 * 20.5 / profile.process.deposition_speed).abs() < 1e-9);
    }
}

#[cfg(feature = "schema")]
mod schema {
    use super::{BUILT_IN, Profile};
    use serde_json::Value;

    /// Every object with properties, with its path.
    fn walk(value: &Value, path: &str, visit: &mut impl FnMut(&str, &Value)) {
        if let Some(properties) = value.get("properties").and_then(Value::as_object) {
            properties.iter().for_each(|(key, property)| visit(&format!("{path}.{key}"), property));
        }
        match value {
            Value::Object(map) => map.iter().for_each(|(key, inner)| walk(inner, &format!("{path}/{key}"), visit)),
            Value::Array(items) => items.iter().for_each(|inner| walk(inner, path, visit)),
            _ => {}
        }
    }

    #[test]
    fn every_key_is_described() {
        let mut count = 0;
        walk(&Profile::schema(), "", &mut |path, property| {
            count += 1;
            let text = property["description"].as_str().unwrap_or_default();
            assert!(text.len() > 5 && text.ends_with('.'), "{path}: {text:?}");
        });
        // Twelve sections and what is in them.
        assert!(count > 60, "{count}");
    }

    /// Editors read the schema beside the profile that a `#:schema` line names.
    #[test]
    fn the_schema_beside_the_profiles_is_that_of_the_library() {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("profiles/profile.schema.json");
        let text = format!("{:#}\n", Profile::schema());
        if std::env::var("BEADWRIGHT_GOLDEN").is_ok_and(|value| value == "write") {
            std::fs::write(&path, &text).unwrap();
        }
        assert_eq!(std::fs::read_to_string(path).unwrap(), text, "BEADWRIGHT_GOLDEN=write writes it anew");
        for (name, text) in BUILT_IN {
            assert!(text.starts_with("#:schema ./profile.schema.json\n"), "{name}");
            let without = text.split_once('\n').unwrap().1;
            assert_eq!(Profile::parse(without).unwrap(), Profile::parse(text).unwrap(), "{name}");
        }
    }

    #[test]
    fn every_word_of_a_choice_is_described() {
        let schema = Profile::schema();
        for choice in ["Overlap", "RasterTurn", "ContourOrder", "RasterSpacing"] {
            let words = schema["$defs"][choice]["oneOf"].as_array().unwrap();
            assert!(words.len() > 1);
            assert!(
                words.iter().all(|w| w["const"].is_string() && w["description"].is_string()),
                "{choice}: {words:?}"
            );
        }
    }

    #[test]
    fn the_schema_knows_exactly_the_keys_of_the_profiles() {
        let schema = Profile::schema();
        for (name, text) in BUILT_IN {
            let profile: toml::Table = text.parse().unwrap();
            for (section, value) in &profile {
                assert!(schema["properties"][section].is_object(), "{name}: {section}");
                let Some(table) = value.as_table() else { continue };
                let property = schema["properties"][section].to_string();
                let place = property.split("#/$defs/").nth(1).and_then(|rest| rest.split('"').next()).unwrap();
                let known = &schema["$defs"][place]["properties"];
                assert!(table.keys().all(|key| known[key].is_object()), "{name}: [{section}] {table:?}");
            }
        }
    }
}

#[test]
fn built_in_profiles_fill_a_plate_without_voids() {
    for (name, _) in BUILT_IN.iter().filter(|(name, _)| !name.starts_with("fdm")) {
        let profile = Profile::built_in(name).unwrap();
        let plan = crate::common::planned("plate", &profile);
        let mut judge = Judge::new(deposit_settings(&profile));
        let voids = plan.layers.iter().map(|layer| judge.layer(layer).figures.void_percent());
        let worst = voids.fold(0.0, f64::max);
        assert!(worst < 3.0, "{name}: {worst:.1} % of a layer stays empty");
    }
}

#[test]
fn what_is_usual_covers_every_built_in_profile_but_no_slip() {
    let wrong = |profile: &Profile| {
        let limits = profile.limits().into_iter();
        let wrong = limits.filter(|l| profile.usual(l.key).is_some_and(|(low, high)| !(low..=high).contains(&l.value)));
        wrong.map(|limit| limit.key).collect::<Vec<_>>()
    };
    for (name, text) in BUILT_IN {
        assert_eq!(wrong(&Profile::parse(text).unwrap()), [""; 0], "{name}");
    }
    let mut slip = Profile::built_in(KUKA).unwrap();
    slip.process.wire_feed_speed = 99.0;
    assert_eq!(wrong(&slip), ["process.wire_feed_speed"]);
}
