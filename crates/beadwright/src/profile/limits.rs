//! What values can be: one table of ranges, and the few rules that tie keys together.

use super::reasons::reason;
use super::{Gcode, Profile, Program};
use crate::template;

/// The first value that cannot be.
pub(super) struct Broken {
    pub(super) key: String,
    pub(super) value: String,
    pub(super) reason: String,
}

/// A text that cannot be.
pub(super) fn broken_text(key: &str, value: &str, reason: &str) -> Broken {
    Broken { key: key.to_owned(), value: format!("\"{value}\""), reason: reason.to_owned() }
}

/// Placeholders that a template may use.
pub(crate) const PLACEHOLDERS: [&str; 21] = [
    "program",
    "layer",
    "pass",
    "wire_feed_speed",
    "deposition_speed",
    "arc_start_delay",
    "arc_end_delay",
    "gas_preflow",
    "gas_postflow",
    "gas_flow",
    "arc_start_delay_ms",
    "arc_end_delay_ms",
    "gas_preflow_ms",
    "gas_postflow_ms",
    "dwell",
    "dwell_ms",
    "wire_feed",
    "wire_feed_ratio",
    "wire_retract",
    "wire_retract_time",
    "wire_retract_time_ms",
];

pub(super) fn first_broken(p: &Profile) -> Option<Broken> {
    out_of_range(p).or_else(|| contradiction(p)).or_else(|| bad_template(p))
}

/// Key, value, least and greatest possible value, unit.
pub(super) type Range = (&'static str, f64, f64, f64, &'static str);

fn out_of_range(p: &Profile) -> Option<Broken> {
    // Written so that NaN is out of range too.
    let broken = ranges(p).into_iter().find(|&(_, value, low, high, _)| !(value >= low && value <= high));
    broken.map(|(key, value, low, high, unit)| Broken {
        key: key.to_owned(),
        value: format!("{value}"),
        reason: format!("it must lie between {low} and {high} {unit}: {}.", reason(key)),
    })
}

/// The range of every number that is given.
pub(super) fn ranges(p: &Profile) -> Vec<Range> {
    const TINY: f64 = 1e-3;
    let (w, process, fill) = (p.bead.width, &p.process, &p.fill);
    let mut ranges: Vec<Range> = vec![
        ("wire.diameter", p.wire.diameter, 0.1, 10.0, "mm"),
        ("wire.density", p.wire.density, 0.5, 25.0, "g/cm³"),
        ("process.wire_feed_speed", process.wire_feed_speed, TINY, 100.0, "m/min"),
        ("process.deposition_speed", process.deposition_speed, TINY, 2000.0, "mm/s"),
        ("process.efficiency", process.efficiency, 0.01, 1.0, "of the wire"),
        ("process.arc_start_delay", process.arc_start_delay, 0.0, 60.0, "s"),
        ("process.arc_end_delay", process.arc_end_delay, 0.0, 60.0, "s"),
        ("process.gas_flow", process.gas_flow, 0.0, 200.0, "L/min"),
        ("process.gas_preflow", process.gas_preflow, 0.0, 60.0, "s"),
        ("process.gas_postflow", process.gas_postflow, 0.0, 60.0, "s"),
        ("process.ctwd", process.ctwd, 0.0, 100.0, "mm"),
        ("process.current", process.current.unwrap_or(1.0), TINY, 2000.0, "A"),
        ("process.voltage", process.voltage.unwrap_or(1.0), TINY, 500.0, "V"),
        ("bead.width", w, 0.05, 100.0, "mm"),
        ("bead.height", p.bead.height, 0.01, 50.0, "mm"),
        ("layers.height", p.layers.height, 0.01, 50.0, "mm"),
        ("fill.stepover", fill.stepover.unwrap_or(w), 0.2 * w, 2.0 * w, "mm (0.2 to 2 bead widths)"),
        ("fill.contour_gap", fill.contour_gap, 0.1, 2.0, "bead widths"),
        ("fill.perimeters", fill.perimeters.into(), 1.0, 1000.0, "perimeters"),
        ("fill.machining_allowance", fill.machining_allowance, 0.0, 50.0, "mm"),
        ("fill.raster_angle", fill.raster_angle, -360.0, 360.0, "°"),
        ("fill.raster_increment", fill.raster_increment, -360.0, 360.0, "°"),
        ("fill.infill_density", fill.infill_density, 0.01, 1.0, "of full"),
        ("fill.solid_layers", fill.solid_layers.into(), 0.0, 32.0, "layers"),
        ("fill.min_pass_length", fill.min_pass_length, 0.0, 1000.0, "mm"),
        ("hybrid.pocket_depth", p.hybrid.pocket_depth, 0.5, 3.0, "stepovers"),
        ("hybrid.tolerance", p.hybrid.tolerance, 0.001, 0.2, "stepovers"),
        ("hybrid.min_pocket_area", p.hybrid.min_pocket_area, 0.0, 100.0, "squared bead widths"),
        ("hybrid.min_pocket_length", p.hybrid.min_pocket_length, 0.0, 100.0, "bead widths"),
        ("hybrid.skeleton_gap", p.hybrid.skeleton_gap, 0.3, 1.5, "stepovers"),
        ("hybrid.least_gap", p.hybrid.least_gap, 0.3, 1.5, "stepovers"),
        ("hybrid.region_width", p.hybrid.region_width, 0.0, 20.0, "stepovers"),
        ("hybrid.end_overlap", p.hybrid.end_overlap, 0.0, 1.0, "bead widths"),
        ("hybrid.tip_reach", p.hybrid.tip_reach, 0.0, 1.0, "of the way"),
        ("hybrid.min_width", p.hybrid.min_width, 0.2, 1.0, "bead widths"),
        ("hybrid.max_width", p.hybrid.max_width, 1.0, 3.0, "bead widths"),
        ("wall.junction_tolerance", p.wall.junction_tolerance, 0.01, 2.0, "bead widths"),
        ("wall.chord_error", p.wall.chord_error, TINY, 1.0, "mm"),
        ("wall.corner_radius", p.wall.corner_radius, 0.05, 10.0, "bead widths"),
        ("wall.junction_gap", p.wall.junction_gap, 0.0, 1.0, "bead widths"),
        ("wall.end_gap", p.wall.end_gap, 0.0, 1.0, "bead widths"),
        ("wall.min_width", p.wall.min_width, 0.2, 1.0, "bead widths"),
        ("wall.max_width", p.wall.max_width, 1.0, 3.0, "bead widths"),
        ("slice.close_gap", p.slice.close_gap, 0.0, 1000.0, "mm"),
        ("slice.simplify", p.slice.simplify, 0.0, 0.2 * w, "mm (at most 0.2 bead widths)"),
        ("check.max_void", p.check.max_void, 0.0, 100.0, "% of the area"),
        ("check.max_overfill", p.check.max_overfill, 0.0, 100.0, "% of the area"),
        ("check.max_outside", p.check.max_outside, 0.0, 100.0, "% of the area"),
        ("check.max_overhang", p.check.max_overhang, 0.0, 10.0, "bead widths"),
        ("check.min_speed", p.check.min_speed.unwrap_or(1.0), 0.0, 2000.0, "mm/s"),
        ("check.max_speed", p.check.max_speed.unwrap_or(1.0), TINY, 2000.0, "mm/s"),
        ("check.max_heat_input", p.check.max_heat_input.unwrap_or(1.0), TINY, 1e6, "J/mm"),
        ("check.min_layer_time", p.check.min_layer_time.unwrap_or(1.0), 0.0, 1e6, "s"),
        ("check.stacked_starts", p.check.stacked_starts.into(), 2.0, 1e6, "layers"),
        ("check.max_points", p.check.max_points.into(), 10.0, 1e8, "points"),
        ("check.max_plan_points", p.check.max_plan_points.unwrap_or(50_000).into(), 10.0, 1e9, "points"),
        ("travel.speed", p.travel.speed, TINY, 3000.0, "mm/s"),
        ("travel.clearance", p.travel.clearance, 0.0, 1000.0, "mm"),
        ("program.chord_tolerance", p.program.chord_tolerance, 0.0, 0.5 * w, "mm (at most half a bead width)"),
        ("program.speed_tolerance", p.program.speed_tolerance, 0.0, 0.3, "of the speed"),
        ("program.min_point_time", p.program.min_point_time, 0.0, 1.0, "s"),
        ("program.torch_angle", p.program.torch_angle, -360.0, 360.0, "°"),
        ("program.table_angle", p.program.table_angle.unwrap_or(0.0), -7200.0, 7200.0, "°"),
    ];
    ranges.extend(p.one_loop.ranges());
    ranges.extend(p.krl.iter().flat_map(|krl| krl.ranges()));
    if let Some(gcode) = &p.gcode {
        ranges.push(("gcode.decimals", gcode.decimals as f64, 1.0, 4.0, "decimals"));
        let number = gcode.program_number.unwrap_or(1);
        ranges.push(("gcode.program_number", number.into(), 1.0, 9999.0, "(O number)"));
    }
    if let Some(motion) = &p.motion {
        ranges.push(("motion.acceleration", motion.acceleration, 1.0, 1e6, "mm/s²"));
        ranges.push(("motion.corner_speed", motion.corner_speed, 0.01, 1000.0, "mm/s"));
    }
    if let Some(marlin) = &p.marlin {
        ranges.push(("marlin.retract_length", marlin.retract_length, 0.0, 50.0, "mm of filament"));
        ranges.push(("marlin.retract_speed", marlin.retract_speed, 0.1, 500.0, "mm/s"));
        ranges.push(("marlin.retract_from", marlin.retract_from, 0.0, 1000.0, "mm"));
    }
    ranges.extend(p.start_stop.ranges());
    ranges.extend(p.rapid.iter().flat_map(|rapid| rapid.ranges()));
    ranges.extend(p.fanuc.iter().flat_map(|fanuc| fanuc.ranges()));
    ranges.extend(p.inform.iter().flat_map(|inform| inform.ranges()));
    ranges.extend(p.urscript.iter().flat_map(|urscript| urscript.ranges()));
    ranges
}

fn contradiction(p: &Profile) -> Option<Broken> {
    let broken = |key: &str, value: String, reason: String| Some(Broken { key: key.to_owned(), value, reason });
    if crate::fill::strategy(&p.fill.strategy).is_none() {
        let names = crate::fill::STRATEGIES.map(|s| s.name());
        let value = format!("\"{}\"", p.fill.strategy);
        return broken("fill.strategy", value, format!("the strategies are {}.", names.join(", ")));
    }
    if (p.fill.overlap.ratio().is_none()) != p.fill.stepover.is_some() {
        return match p.fill.stepover {
            Some(stepover) => {
                broken("fill.stepover", format!("{stepover}"), "it is given only with overlap = \"free\".".to_owned())
            }
            None => broken("fill.overlap", "\"free\"".to_owned(), "fill.stepover must then be given, mm.".to_owned()),
        };
    }
    if let Some(post) = p.posts.iter().find(|post| !crate::post::NAMES.contains(&post.as_str())) {
        let names = crate::post::NAMES.join(", ");
        return broken("posts", format!("\"{post}\""), format!("the posts are {names}."));
    }
    if let Some(reason) = p.program.contradiction(p.gcode.as_ref()) {
        return broken("program.chord_tolerance", format!("{}", p.program.chord_tolerance), reason.to_owned());
    }
    let gcode = p.gcode.as_ref().map(|g| ("gcode.extension", &g.extension));
    let marlin = p.marlin.as_ref().map(|m| ("marlin.extension", &m.extension));
    for (key, extension) in gcode.into_iter().chain(marlin) {
        if extension.is_empty() || !extension.bytes().all(|b| b.is_ascii_alphanumeric()) {
            return broken(key, format!("\"{extension}\""), "letters and digits only.".to_owned());
        }
    }
    let home = p.krl.as_ref().map_or("A1 0", |k| &k.home);
    if !home.starts_with("A1 ") || !home.bytes().all(|b| b.is_ascii_graphic() || b == b' ') || home.contains('}') {
        return broken("krl.home", format!("\"{home}\""), "an axis position such as \"A1 0.0,A2 -90.0,…\".".to_owned());
    }
    let rapid = p.rapid.as_ref().and_then(|rapid| rapid.broken());
    let fanuc = || p.fanuc.as_ref().and_then(|fanuc| fanuc.broken());
    let krl = || p.krl.as_ref().and_then(|krl| krl.broken());
    rapid.or_else(krl).or_else(fanuc).or_else(|| p.inform.as_ref().and_then(|inform| inform.broken()))
}

impl Program {
    /// What does not fit together.
    fn contradiction(&self, gcode: Option<&Gcode>) -> Option<&'static str> {
        if self.chord_tolerance > 0.0 && self.chord_tolerance < 0.015 {
            return Some("0 keeps every point; else it must be 0.015 mm or more, over the 0.01 mm of the least move.");
        }
        if self.arcs && self.chord_tolerance == 0.0 {
            return Some("arcs = true needs a tolerance, such as 0.05 mm.");
        }
        if self.min_point_time > 0.0 && self.chord_tolerance == 0.0 {
            return Some("min_point_time needs a tolerance within which points are merged, such as 0.05 mm.");
        }
        let coarse = gcode.is_some_and(|g| g.decimals < 3);
        (self.arcs && coarse).then_some("arcs = true needs 3 gcode.decimals or more: the radius must be kept.")
    }
}

/// Templates may use known placeholders and printable ASCII only: controllers read nothing else.
fn bad_template(p: &Profile) -> Option<Broken> {
    let krl = p.krl.iter().flat_map(|k| {
        [
            ("krl.start", &k.start),
            ("krl.layer_start", &k.layer_start),
            ("krl.arc_on", &k.arc_on),
            ("krl.arc_off", &k.arc_off),
            ("krl.wire_feed", &k.wire_feed),
            ("krl.crater", &k.crater),
            ("krl.end", &k.end),
        ]
    });
    let gcode = p.gcode.iter().flat_map(|g| {
        [
            ("gcode.header", &g.header),
            ("gcode.layer_start", &g.layer_start),
            ("gcode.arc_on", &g.arc_on),
            ("gcode.arc_off", &g.arc_off),
            ("gcode.dwell", &g.dwell),
            ("gcode.wire_feed", &g.wire_feed),
            ("gcode.crater", &g.crater),
            ("gcode.footer", &g.footer),
        ]
    });
    let marlin = p.marlin.iter().flat_map(|m| {
        [("marlin.header", &m.header), ("marlin.layer_start", &m.layer_start), ("marlin.footer", &m.footer)]
    });
    let rapid = p.rapid.iter().flat_map(|r| r.templates());
    let fanuc = p.fanuc.iter().flat_map(|f| f.templates());
    let others = p.inform.iter().flat_map(|i| i.templates()).chain(p.urscript.iter().flat_map(|u| u.templates()));
    for (key, lines) in krl.chain(gcode).chain(marlin).chain(rapid).chain(fanuc).chain(others) {
        for line in lines {
            let reason = match template::unknown_placeholder(line, &PLACEHOLDERS) {
                Some(name) => format!("{{{{{name}}}}} is not a placeholder; known are {}.", PLACEHOLDERS.join(", ")),
                None if !line.bytes().all(|b| b.is_ascii_graphic() || b == b' ') => {
                    "a line of a template holds printable ASCII characters only.".to_owned()
                }
                None => continue,
            };
            return Some(Broken { key: key.to_owned(), value: format!("\"{line}\""), reason });
        }
    }
    None
}
