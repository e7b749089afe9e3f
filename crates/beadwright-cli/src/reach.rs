//! `beadwright reach`: whether a robot can weld a plan, and with what margins.

use crate::{file, profile, program};
use anyhow::{Context, bail};
use beadwright::files::write_file;
use beadwright::profile::Misfit;
use beadwright::robot::{
    self, Cell, External, PartPlace, Reach, Station, Suggestion, TableAngle, Track, Trajectory, cell,
};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// plan.json, as `beadwright plan` writes it.
    #[arg(required_unless_present_any = ["list", "show"])]
    plan: Option<PathBuf>,
    /// Cell: a built-in name or a TOML file.
    #[arg(long, value_name = "NAME|FILE", required_unless_present_any = ["list", "show"])]
    cell: Option<String>,
    /// Take the arm from this URDF file instead of the cell's; torch and part stay where the cell places them.
    #[arg(long, value_name = "FILE")]
    urdf: Option<PathBuf>,
    /// Place of the part's origin, instead of the one in the cell: x,y,z in mm and the turn about the vertical in °.
    #[arg(long, value_name = "X,Y,Z[,TURN]", value_parser = parse_place, allow_hyphen_values = true)]
    at: Option<PartPlace>,
    #[command(flatten)]
    wanted: profile::Wanted,
    /// Search for a place for the part that gives more margin.
    #[arg(long)]
    suggest: bool,
    /// HTML page to write, with joint angles and margins over the program.
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Write the joint angles over the program: .csv (a table, °) or .json (ROS 2's trajectory_msgs/JointTrajectory, rad).
    #[arg(long, value_name = "FILE", value_parser = parse_trajectory)]
    trajectory: Option<PathBuf>,
    /// Print machine-readable JSON.
    #[arg(long)]
    json: bool,
    /// List the built-in cells.
    #[arg(long)]
    list: bool,
    /// Print a built-in cell, to save and edit.
    #[arg(long, value_name = "NAME")]
    show: Option<String>,
}

pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let mut out = std::io::stdout().lock();
    if arguments.list {
        return cell::BUILT_IN
            .iter()
            .try_for_each(|(name, text)| Ok(writeln!(out, "{name:<18} {}", Cell::parse(text)?.description)?));
    }
    if let Some(name) = &arguments.show {
        return Ok(write!(out, "{}", Cell::built_in_text(name)?)?);
    }
    let (Some(path), Some(name)) = (&arguments.plan, &arguments.cell) else { bail!("a plan and --cell are needed") };
    let mut cell = load_cell(name)?;
    if let Some(path) = &arguments.urdf {
        cell = cell.with_urdf(&file::text(path)?).with_context(|| path.display().to_string())?;
    }
    let source = program::Source::open(path)?;
    let Some(plan) = source.plan() else { bail!("{}: give the plan.json of the program", path.display()) };
    let profile = source.profile(&arguments.wanted)?;
    let track = profile.track(&plan.layers);
    if track.stops.is_empty() {
        bail!("{}: the plan has no passes.", path.display());
    }
    let misfits: Vec<String> = profile.misfits(&cell).iter().map(Misfit::sentence).collect();
    let place = arguments.at.unwrap_or(cell.part);
    let External { cell, place, station, table } = robot::external_axes(&cell, place, &track);
    let start = Instant::now();
    let reach = robot::reach(&cell, place, &track);
    let seconds = start.elapsed().as_secs_f64();
    let suggestion = arguments.suggest.then(|| robot::suggest(&cell, place, &track));
    let better = suggestion.flatten();
    if let Some(page) = &arguments.output {
        let page_text = beadwright::report::reach::page(&plan.header.part, &cell, &reach, better.as_ref()).html();
        write_file(page, page_text.as_bytes())?;
    }
    let trajectory = arguments.trajectory.as_ref().zip(Trajectory::of(&cell, &reach));
    if let Some((path, trajectory)) = &trajectory {
        let is_table = path.extension().is_some_and(|end| end.eq_ignore_ascii_case("csv"));
        let text = if is_table { trajectory.csv() } else { format!("{:#}\n", trajectory.ros()) };
        write_file(path, text.as_bytes())?;
    }
    if arguments.json {
        let mut value = json(&cell, &reach, (station, table), suggestion);
        value["misfits"] = serde_json::json!(misfits);
        writeln!(out, "{value:#}")?;
    } else {
        print(&mut out, &plan.header.part, &cell, &track, &reach, (station, table))?;
        if reach.reached().next().is_some() {
            let rate = reach.computed as f64 / seconds.max(1e-9);
            writeln!(out, "  poses computed         {} ({rate:.0} a second)", reach.computed)?;
        }
        misfits.iter().try_for_each(|sentence| writeln!(out, "note: {sentence}"))?;
        // The first bad one is the error below.
        let others = reach.findings.iter().filter(|f| reach.first_bad() != Some(f));
        others.into_iter().try_for_each(|f| writeln!(out, "note: {}", f.sentence()))?;
        match suggestion {
            Some(Some(better)) => writeln!(out, "\n{}", better.sentence())?,
            Some(None) => writeln!(
                out,
                "\nThe arm cannot reach all of the part from any of the places tried: the part is too large."
            )?,
            None if !reach.is_reachable() => writeln!(out, "\n--suggest looks for a better place for the part.")?,
            None => {}
        }
        if let Some(page) = &arguments.output {
            writeln!(out, "\nplots in {}", page.display())?;
        }
        if let Some((path, trajectory)) = &trajectory {
            writeln!(out, "\njoint angles at {} points in {}", trajectory.points.len(), path.display())?;
        }
    }
    match reach.first_bad() {
        Some(bad) => bail!("{} cannot weld this plan. {}", cell.name, bad.sentence()),
        None => Ok(()),
    }
}

fn print(
    out: &mut impl Write,
    part: &str,
    cell: &Cell,
    track: &Track,
    reach: &Reach,
    (station, table): (Option<Station>, Option<TableAngle>),
) -> std::io::Result<()> {
    writeln!(out, "{part} on {}: {}", cell.name, cell.description)?;
    writeln!(out, "origin of the part at {}\n", reach.place.sentence())?;
    if reach.reached().next().is_none() {
        return writeln!(out, "  none of the {} points can be reached", track.stops.len());
    }
    writeln!(out, "  joint      from       to    margin   speed with arc   on travel     limit")?;
    for j in 0..6 {
        let Some(r) = reach.joint(j) else { continue };
        writeln!(
            out,
            "  J{}    {:8.1}° {:7.1}° {:8.1}° {:12.1} °/s {:7.1} °/s {:5.0} °/s",
            j + 1,
            r.low,
            r.high,
            r.margin,
            r.arc_speed,
            r.travel_speed,
            cell.arm.speeds[j]
        )?;
    }
    let least = |value: fn(&robot::Pose) -> f64| {
        let least = reach.reached().map(|(_, pose)| value(pose)).min_by(f64::total_cmp);
        least.map_or("-".to_owned(), |v| format!("{v:.1}°"))
    };
    let t = &reach.turning;
    let turned = match t.range {
        (low, high) if high - low < 0.5 => format!("{low:.0}° throughout"),
        (low, high) => format!("{low:.0}° to {high:.0}°"),
    };
    let single = match t.single_margin {
        m if m > -500.0 => format!("{:.0}°, least margin {m:.1}°", t.single),
        _ => "none reaches all".to_owned(),
    };
    let rows = [
        ("wrist singularity", least(|pose| pose.margins.wrist)),
        ("straight arm", least(|pose| pose.margins.elbow)),
        ("least margin", least(|pose| pose.margins.least())),
        ("torch angle", turned),
        ("best single angle", single),
        ("posture", reach.branch.name()),
        ("points", format!("{} on {:.2} m", track.stops.len(), track.length() / 1e3)),
    ];
    writeln!(out)?;
    rows.iter().try_for_each(|(name, value)| writeln!(out, "  {name:<22} {value}"))?;
    if let Some(Station { position, margin, at_zero, .. }) = station {
        let at_zero = at_zero.map_or("out of reach".to_owned(), |margin| format!("{margin:.1}°"));
        writeln!(
            out,
            "  linear axis            {position:.0} mm, margin of the outermost points {margin:.1}° (at 0 mm {at_zero})"
        )?;
    }
    if let Some(table) = table {
        let unturned = table.unturned.map_or("out of reach".to_owned(), |margin| format!("{margin:.1}°"));
        let (angle, margin) = (table.angle, table.margin);
        writeln!(
            out,
            "  turn table             {angle:.0}°, margin of the outermost points {margin:.1}° (at 0° {unturned})"
        )?;
    }
    let torch = t.program_angle().map(|angle| format!("--set program.torch_angle={angle:.0}"));
    let table = table.map(|table| format!("--set program.table_angle={:.0}", table.angle));
    let station = station.map(|station| format!("--set program.linear_axis={:.0}", station.position));
    let settings: Vec<String> = torch.into_iter().chain(station).chain(table).collect();
    if settings.is_empty() { Ok(()) } else { writeln!(out, "  plan with              {}", settings.join(" ")) }
}

fn json(
    cell: &Cell,
    reach: &Reach,
    (station, table): (Option<Station>, Option<TableAngle>),
    suggestion: Option<Option<Suggestion>>,
) -> serde_json::Value {
    let findings: Vec<_> = reach
        .findings
        .iter()
        .map(|f| serde_json::json!({ "fatal": f.trouble.is_fatal(), "sentence": f.sentence(), "finding": f }))
        .collect();
    let joints: Vec<_> = (0..6).map(|j| reach.joint(j)).collect();
    let least = reach.least_margin();
    let points = reach.poses.len();
    let value = serde_json::json!({
        "cell": cell.name, "place": reach.place, "reachable": reach.is_reachable(), "least_margin": least,
        "posture": reach.branch.name(), "joints": joints, "turning": reach.turning, "torch_angle": reach.turning.program_angle(), "linear_axis": station, "table": table, "points": points,
        "findings": findings,
    });
    match (value, suggestion) {
        (serde_json::Value::Object(mut map), Some(suggestion)) => {
            map.insert("suggestion".to_owned(), serde_json::json!(suggestion));
            map.into()
        }
        (value, _) => value,
    }
}

pub(crate) fn load_cell(name: &str) -> anyhow::Result<Cell> {
    let path = Path::new(name);
    let is_file = path.extension().is_some_and(|e| e == "toml") || path.components().count() > 1 || path.is_file();
    if !is_file {
        return Ok(Cell::built_in(name)?);
    }
    parse_cell(path, &file::text(path)?)
}

/// Whether a text is meant as a cell, with or without faults: a cell has an arm, and a profile has none.
pub(crate) fn is_cell(text: &str) -> bool {
    let rest = text.lines().filter_map(|line| line.trim_start_matches([' ', '\t', '[']).strip_prefix("arm"));
    rest.map(str::trim_start).any(|rest| rest.starts_with([']', '.', '=']))
}

/// The cell in the text of a file, which may name another one beside it.
pub(crate) fn parse_cell(path: &Path, text: &str) -> anyhow::Result<Cell> {
    let beside = |urdf: &str| file::text(&path.with_file_name(urdf)).map_err(|e| format!("{e:#}"));
    Cell::parse_with(text, beside).with_context(|| path.display().to_string())
}

fn parse_trajectory(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    let known = path.extension().is_some_and(|end| ["csv", "json"].iter().any(|known| end.eq_ignore_ascii_case(known)));
    if known { Ok(path) } else { Err("the extension gives the format: .csv or .json".to_owned()) }
}

fn parse_place(text: &str) -> Result<PartPlace, String> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|v| v.trim().parse::<f64>()).collect();
    match numbers.as_deref() {
        Ok(all) if all.iter().any(|v| v.is_nan() || v.abs() > 1e5) => Err("the place must lie within 100 m".to_owned()),
        Ok(&[x, y, z]) => Ok(PartPlace { position: [x, y, z], rotation: 0.0 }),
        Ok(&[x, y, z, rotation]) => Ok(PartPlace { position: [x, y, z], rotation }),
        _ => Err("x,y,z in mm is expected, such as 1200,0,500, or x,y,z,turn with the turn in °".to_owned()),
    }
}
