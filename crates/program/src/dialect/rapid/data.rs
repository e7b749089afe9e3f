//! Data of RAPID as literals: frames, speeds, zones, seams and welds.

use super::section::{Rapid, RapidSeam, WireFeedUnit};
use crate::number::{fixed, push_fixed};
use crate::program::{ProgramSettings, Weave};
use bead_plan::process::Process;
use glam::DVec3;

/// The external axes of a target: a linear axis (mm), and those that turn the part (°), in their positions.
pub(super) fn external_axes(program: &ProgramSettings, turned: Option<[f64; 2]>, rapid: &Rapid) -> String {
    let mut axes = [const { None }; 6];
    axes[0] = program.linear_axis;
    let free = usize::from(program.linear_axis.is_some());
    let place = rapid.table_axis.map_or(free, |axis| axis as usize - 1);
    let turning = turned.into_iter().flatten().take(program.turning_axes());
    axes.iter_mut().skip(place).zip(turning).for_each(|(axis, angle)| *axis = Some(angle));
    let texts = axes.map(|value| value.map_or_else(|| "9E+09".to_owned(), |value| fixed(value, 4)));
    format!("[{}]", texts.join(","))
}

/// Numbers in brackets, with `decimals` decimal places.
fn list(values: &[f64], decimals: usize) -> String {
    let texts: Vec<String> = values.iter().map(|&v| fixed(v, decimals)).collect();
    format!("[{}]", texts.join(","))
}

/// A unit quaternion with 7 decimals; the profile's is within 0.1 % of one.
pub(super) fn quaternion(q: &[f64]) -> String {
    let norm = q.iter().map(|v| v * v).sum::<f64>().sqrt().max(f64::MIN_POSITIVE);
    let unit: Vec<f64> = q.iter().map(|v| v / norm).collect();
    list(&unit, 7)
}

/// A frame: position and quaternion.
fn pose(frame: &[f64; 7]) -> String {
    format!("[{},{}]", list(&frame[..3], 3), quaternion(&frame[3..]))
}

/// A robtarget; its configuration is unknown here, which `ConfL \Off` allows.
pub(super) fn push_target(text: &mut String, to: DVec3, orientation: &str, axes: &str) {
    text.push_str("[[");
    push_fixed(text, to.x, 3);
    text.push(',');
    push_fixed(text, to.y, 3);
    text.push(',');
    push_fixed(text, to.z, 3);
    text.push_str("],");
    text.push_str(orientation);
    text.push_str(",[0,0,0,0],");
    text.push_str(axes);
    text.push(']');
}

/// Speeddata for a tool speed, mm/s.
pub(super) fn speed(tool_speed: f64, rapid: &Rapid) -> String {
    format!("[{},{},5000,1000]", fixed(tool_speed, 3), fixed(rapid.orientation_speed, 3))
}

/// Zonedata for a corner path of this radius, mm, in the proportions of `z1`.
fn zone(radius: f64) -> String {
    let (r, tenth) = (fixed(radius, 3), fixed(radius / 10.0, 3));
    format!("[FALSE,{r},{r},{r},{tenth},{r},{tenth}]")
}

/// Arcdata with the fraction `part` of the process's wire feed.
fn arc(process: &Process, rapid: &Rapid, part: f64, schedule: u32) -> String {
    let feed = part * process.wire_feed_speed;
    let feed = match rapid.wire_feed_unit {
        WireFeedUnit::MetresPerMinute => feed,
        WireFeedUnit::MillimetresPerSecond => feed * 1000.0 / 60.0,
    };
    let numbers = [rapid.voltage, feed, rapid.control, process.current.unwrap_or(0.0)];
    let [voltage, feed, control, current] = numbers.map(|v| fixed(v, 3));
    format!("[{schedule},{},{voltage},{feed},{control},{current},0,0,0]", rapid.mode)
}

/// The schedule of the power source in layers with this process: their job, if it is not the nominal one.
fn schedule(process: &Process, nominal: &Process, rapid: &Rapid) -> u32 {
    if process.job == nominal.job { rapid.schedule } else { process.job }
}

/// Seamdata of layers with this process.
pub(super) fn seam(process: &Process, nominal: &Process, rapid: &Rapid, seam: &RapidSeam) -> String {
    let time = |seconds: f64| fixed(seconds, 3);
    let arc = |part: f64| arc(process, rapid, part * process.rate(), schedule(process, nominal, rapid));
    let main = arc(1.0);
    [
        time(seam.purge_time),
        time(process.gas_preflow),
        main.clone(),
        time(process.arc_start_delay),
        seam.scrape_start.to_string(),
        fixed(seam.heat_speed, 3),
        time(seam.heat_time),
        fixed(seam.heat_distance, 3),
        arc(seam.heat_feed),
        time(seam.cool_time),
        time(seam.fill_time),
        arc(seam.fill_feed),
        time(seam.burnback_time),
        time(seam.rollback_time),
        main,
        time(process.gas_postflow),
    ]
    .join(",")
}

/// Welddata for a deposition speed, mm/s, and the fraction `feed` of the wire feed. The tuning values are 0, as in
/// ABB's examples. `process` is that of the layer; if it has its own job, that replaces the schedule.
pub(super) fn weld(speed: f64, feed: f64, process: &Process, nominal: &Process, rapid: &Rapid) -> String {
    let schedule = schedule(process, nominal, rapid);
    format!("[{},0,{},[0,0,0,0,0,0,0,0,0]]", fixed(speed, 3), arc(process, rapid, feed, schedule))
}

/// Weavedata for a speed, mm/s: a zigzag with all axes, whose length is a distance along the seam at any speed.
/// RobotWare measures its width from side to side, and its dwell there also as a distance, mm.
pub(super) fn weave(weave: &Weave, speed: f64) -> String {
    let [length, width, dwell] = [weave.length, 2.0 * weave.amplitude, weave.dwell * speed].map(|v| fixed(v, 3));
    format!("[1,0,{length},{width},0,{dwell},0,{dwell},0,0,0,0,0,0,0]")
}

/// The data of the main module: tool, part, home with its external `axes`, speeds, zone and seam, one declaration each.
/// A part on a turn table has its frame on the unit, whose own frame the controller knows.
pub(super) fn declarations(
    travel_speed: f64,
    rapid: &Rapid,
    seam: Option<&str>,
    table: Option<&str>,
    axes: &str,
) -> Vec<String> {
    let load = format!("[{},{},[1,0,0,0],0,0,0]", fixed(rapid.tool_load[0], 3), list(&rapid.tool_load[1..], 3));
    let tool =
        rapid.tool_frame.as_ref().map(|f| format!("TASK PERS tooldata {}:=[TRUE,{},{load}];", rapid.tool, pose(f)));
    let wobj = rapid.part_frame.as_ref().map(|frame| {
        let none = "[[0,0,0],[1,0,0,0]]";
        let frames = match table {
            Some(unit) => format!("FALSE,\"{unit}\",{none},{}", pose(frame)),
            None => format!("TRUE,\"\",{},{none}", pose(frame)),
        };
        format!("TASK PERS wobjdata {}:=[FALSE,{frames}];", rapid.wobj)
    });
    let seam = seam.map(|seam| format!("TASK PERS seamdata smBead:=[{seam}];"));
    let zone = (rapid.zone > 0.0).then(|| format!("CONST zonedata zBead:={};", zone(rapid.zone)));
    let always = [
        format!("CONST jointtarget jHome:=[{},{axes}];", list(&rapid.home, 3)),
        format!("CONST speeddata vHome:={};", speed(rapid.home_speed, rapid)),
        format!("CONST speeddata vTravel:={};", speed(travel_speed, rapid)),
    ];
    tool.into_iter().chain(wobj).chain(always).chain(zone).chain(seam).collect()
}
