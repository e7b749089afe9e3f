//! `beadwright calibrate`: tool, base, axes of a positioner and scanner from measured points.

use crate::{file, profile, reach, say};
use anyhow::Context;
use beadwright::files::write_file;
use beadwright::profile::{ProfileError, edit};
use beadwright::robot::Frame;
use beadwright::robot::calibrate::{self, AtAngle, Calibrated, Flange, Pair, Residuals, Touch, TurningAxis};
use glam::{DMat3, DQuat, DVec3};
use std::io::Write;
use std::path::{Path, PathBuf};

#[derive(clap::Args)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    what: What,
}

#[derive(clap::Subcommand)]
enum What {
    /// The tip of the wire on the flange: it touches one fixed point in four poses or more. Columns x, y, z and the angles of the flange,
    /// as the robot shows them without a tool.
    Tool(Kept),
    /// The frame of the part: columns touch, x, y, z. A touch is origin, x (on the x axis), top (or xy), front (where y is 0) or left
    /// (where x is 0).
    Base(Kept),
    /// The line about which an axis of a positioner turns: one point of the plate at three angles or more. Columns angle (°), x, y, z.
    Axis(Axis),
    /// The frame of a scanner: targets that it and the robot know. Columns sx, sy, sz (scanner), x, y, z (robot).
    Scanner(Seen),
}

#[derive(clap::Args)]
struct Points {
    /// Table of the points as CSV: a line with the names of the columns, then one line for each point, mm.
    points: PathBuf,
    /// Print machine-readable JSON.
    #[arg(long)]
    json: bool,
}

#[derive(clap::Args)]
struct Posed {
    #[command(flatten)]
    points: Points,
    /// Whose angles are meant: kuka (a, b, c), abb (q1, q2, q3, q4), fanuc (w, p, r), yaskawa (rx, ry, rz in °) or ur (rx, ry, rz, a
    /// rotation vector in rad).
    #[arg(long, value_enum, default_value_t = Robot::Kuka)]
    robot: Robot,
}

#[derive(clap::Args)]
struct Axis {
    #[command(flatten)]
    points: Points,
    /// File to change. Of a cell with a turn table, table.axis and table.direction: the points are then given in the robot's base. Of a
    /// profile, direction and through of an axis of program.positioner: the points are then given in the frame of the part, with all
    /// other axes at 0.
    #[arg(long, value_name = "FILE.toml")]
    write: Option<PathBuf>,
    /// Number of the axis in program.positioner of a profile, from the floor to the part; by default 1.
    #[arg(long, requires = "write", value_parser = clap::value_parser!(u8).range(1..=2), value_name = "N")]
    axis: Option<u8>,
}

#[derive(clap::Args)]
struct Seen {
    #[command(flatten)]
    posed: Posed,
    /// Cell to change: the frame goes into scanner.position and scanner.rotation. Commands that read scans take it with --scanner.
    #[arg(long, value_name = "CELL.toml")]
    write: Option<PathBuf>,
}

#[derive(clap::Args)]
struct Kept {
    #[command(flatten)]
    posed: Posed,
    /// Cell to change: the tip goes into torch.position, the frame of the part into part.position and part.rotation.
    #[arg(long, value_name = "CELL.toml")]
    write: Option<PathBuf>,
}

/// How a robot writes orientations.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Robot {
    Kuka,
    Abb,
    Fanuc,
    Yaskawa,
    Ur,
}

impl Robot {
    fn columns(self) -> &'static [&'static str] {
        match self {
            Self::Kuka => &["a", "b", "c"],
            Self::Abb => &["q1", "q2", "q3", "q4"],
            Self::Fanuc => &["w", "p", "r"],
            Self::Yaskawa | Self::Ur => &["rx", "ry", "rz"],
        }
    }

    fn turn(self, values: &[f64]) -> DQuat {
        let zyx = |turns| Frame::from_zyx([0.0; 3], turns).rotation;
        match (self, values) {
            (Self::Kuka, &[a, b, c]) => zyx([a, b, c]),
            (Self::Fanuc | Self::Yaskawa, &[x, y, z]) => zyx([z, y, x]),
            (Self::Ur, &[x, y, z]) => DQuat::from_scaled_axis(DVec3::new(x, y, z)),
            (Self::Abb, &[w, x, y, z]) => DQuat::from_xyzw(x, y, z, w).normalize(),
            _ => DQuat::IDENTITY,
        }
    }

    fn written(self, turn: DQuat) -> String {
        let [z, y, x] = zyx(turn);
        match self {
            Self::Kuka => format!("A {z:.4} B {y:.4} C {x:.4}°"),
            Self::Fanuc => format!("W {x:.4} P {y:.4} R {z:.4}°"),
            Self::Yaskawa => format!("Rx {x:.4} Ry {y:.4} Rz {z:.4}°"),
            Self::Ur => {
                let turn = (if turn.w < 0.0 { -turn } else { turn }).to_scaled_axis();
                format!("rotation vector {:.6}, {:.6}, {:.6} rad", turn.x, turn.y, turn.z)
            }
            Self::Abb => format!("[{:.7}, {:.7}, {:.7}, {:.7}]", turn.w, turn.x, turn.y, turn.z),
        }
    }
}

/// Turns about z, the new y and the new x, °.
fn zyx(rotation: DQuat) -> [f64; 3] {
    Frame { rotation, ..Frame::IDENTITY }.zyx()
}

pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    match &arguments.what {
        What::Tool(kept) => tool(&kept.posed, kept.write.as_deref()),
        What::Base(kept) => base(&kept.posed, kept.write.as_deref()),
        What::Axis(wanted) => axis(wanted),
        What::Scanner(seen) => scanner(&seen.posed, seen.write.as_deref()),
    }
}

fn tool(Posed { points, robot }: &Posed, cell: Option<&Path>) -> anyhow::Result<()> {
    let table = Table::read(&points.points)?;
    let columns: Vec<&str> = ["x", "y", "z"].iter().chain(robot.columns()).copied().collect();
    let poses: Vec<Flange> = table
        .rows(&columns)?
        .iter()
        .map(|row| Flange { at: DVec3::from_slice(row), turn: robot.turn(&row[3..]) })
        .collect();
    let found = calibrate::tool(&poses).with_context(|| table.name.clone())?;
    write(cell, &[("torch.position", array(found.tip))])?;
    let value = serde_json::json!({ "tip": found.tip.to_array(), "tip_within": finite(found.within),
        "touched": found.touched.to_array(), "residuals": residuals(&found.residuals) });
    let words = |out: &mut dyn Write| -> std::io::Result<()> {
        writeln!(out, "tip of the wire on the flange  {} mm{}", shown(found.tip, 3), give(found.within, "mm"))?;
        writeln!(out, "point that was touched         {} mm", shown(found.touched, 3))
    };
    say_it(points.json, &value, &found.residuals, "touch", words)
}

fn base(Posed { points, robot }: &Posed, cell: Option<&Path>) -> anyhow::Result<()> {
    let table = Table::read(&points.points)?;
    let names = table.words("touch")?;
    let rows = table.rows(&["x", "y", "z"])?;
    let touches = names.iter().zip(&rows).enumerate().map(|(k, (name, row))| {
        let touch = Touch::named(name).with_context(|| {
            format!("{}: line {}: \"{name}\" is no touch: write origin, x, top, front or left", table.name, k + 2)
        })?;
        Ok((touch, DVec3::from_slice(row)))
    });
    let touches = touches.collect::<anyhow::Result<Vec<_>>>()?;
    let found = calibrate::base(&touches).with_context(|| table.name.clone())?;
    let (place, z) = (found.place, found.place.turn * DVec3::Z);
    let leans = z.angle_between(DVec3::Z).to_degrees();
    anyhow::ensure!(
        cell.is_none() || leans < UPRIGHT,
        "{}: the frame is tilted by {leans:.1}°, but a cell can only hold a level one (within {UPRIGHT}°). Level the table, or leave out --write.",
        table.name
    );
    let [about_z, ..] = zyx(place.turn);
    let rotation = format!("{:.3}", about_z + 0.0);
    write(cell, &[("part.position", array(place.at)), ("part.rotation", rotation)])?;
    placed(points.json, &found, *robot, "frame of the part", "touch")
}

fn axis(Axis { points, write, axis }: &Axis) -> anyhow::Result<()> {
    let table = Table::read(&points.points)?;
    let rows = table.rows(&["angle", "x", "y", "z"])?;
    let measured: Vec<AtAngle> =
        rows.iter().map(|row| AtAngle { angle: row[0], at: DVec3::from_slice(&row[1..]) }).collect();
    let found = calibrate::axis(&measured).with_context(|| table.name.clone())?;
    if let Some(path) = write {
        write_axis(path, *axis, &found)?;
    }
    let [direction, through] = [found.direction, found.centre].map(|v| v.to_array());
    let value = serde_json::json!({ "direction": direction, "direction_within": finite(found.direction_within),
        "through": through, "through_within": finite(found.centre_within), "radius": found.radius,
        "residuals": residuals(&found.residuals) });
    let words = |out: &mut dyn Write| -> std::io::Result<()> {
        writeln!(out, "direction  {}{}", shown(found.direction, 6), give(found.direction_within, ""))?;
        writeln!(out, "through    {} mm{}", shown(found.centre, 3), give(found.centre_within, "mm"))?;
        writeln!(out, "radius     {:.3} mm", found.radius)?;
        let ([dx, dy, dz], [x, y, z]) = (direction, through);
        writeln!(
            out,
            "\nIn the frame of the points, for program.positioner.axes, with the limits (°) and the speed (°/s) of the axis:"
        )?;
        writeln!(
            out,
            "{{ direction = [{dx:.6}, {dy:.6}, {dz:.6}], through = [{x:.3}, {y:.3}, {z:.3}], limits = [-90, 90], speed = 30 }}"
        )
    };
    say_it(points.json, &value, &found.residuals, "angle", words)
}

/// Changes the axis of the turn table of a cell, or one of the positioner of a profile.
fn write_axis(path: &Path, number: Option<u8>, found: &TurningAxis) -> anyhow::Result<()> {
    let text = file::text(path)?;
    if !reach::is_cell(&text) {
        return write_positioner(path, text, number.unwrap_or(1), found);
    }
    let named = path.display();
    anyhow::ensure!(number.is_none(), "{named}: a cell has only one turn table. Leave out --axis, or give a profile.");
    anyhow::ensure!(
        reach::parse_cell(path, &text)?.table.is_some(),
        "{named}: the cell has no turn table. Add [table] with axis = [0, 0], direction = 1 and its limits, such as [-180, 180] (°), or \
         give the profile whose program.positioner holds the axis."
    );
    let leans = found.direction.z.abs().min(1.0).acos().to_degrees();
    anyhow::ensure!(
        leans < UPRIGHT,
        "{named}: the axis leans by {leans:.1}°, but the turn table of a cell is vertical (within {UPRIGHT}°). Write it into \
         program.positioner of a profile."
    );
    let (place, way) = (format!("[{:.3}, {:.3}]", found.centre.x, found.centre.y), found.direction.z.signum());
    write(Some(path), &[("table.axis", place), ("table.direction", format!("{way:.0}"))])
}

/// Changes an axis of the positioner of the profile in this text; `number` counts from 1.
fn write_positioner(path: &Path, text: String, number: u8, found: &TurningAxis) -> anyhow::Result<()> {
    let named = path.display().to_string();
    let key = |name: &str| format!("program.positioner.axes.{}.{name}", number - 1);
    let values =
        [(key("direction"), format!("[{}]", shown(found.direction, 6))), (key("through"), array(found.centre))];
    let text = values.iter().try_fold(text, |text, (key, value)| edit::with_value(&text, key, value));
    let text = text.map_err(|error| match error {
        ProfileError::Key { .. } => anyhow::anyhow!(
            "{named}: program.positioner.axes has no axis {number}. List the axes from the floor to the part with limits and speed; \
             `beadwright profile positioner NAME` prints those of a built-in machine."
        ),
        other => anyhow::Error::from(other).context(named.clone()),
    })?;
    profile::parse(&text, &profile::folder(&named)).with_context(|| named.clone())?;
    Ok(write_file(path, text.as_bytes())?)
}

fn scanner(Posed { points, robot }: &Posed, cell: Option<&Path>) -> anyhow::Result<()> {
    let table = Table::read(&points.points)?;
    let rows = table.rows(&["sx", "sy", "sz", "x", "y", "z"])?;
    let pairs: Vec<Pair> =
        rows.iter().map(|row| Pair { scanned: DVec3::from_slice(row), known: DVec3::from_slice(&row[3..]) }).collect();
    let found = calibrate::scanner(&pairs).with_context(|| table.name.clone())?;
    let rotation = format!("[{}]", shown(zyx(found.place.turn).into(), 4));
    write(cell, &[("scanner.position", array(found.place.at)), ("scanner.rotation", rotation)])?;
    placed(points.json, &found, *robot, "scanner in the robot's base", "target")
}

fn placed(json: bool, found: &Calibrated, robot: Robot, what: &str, point: &str) -> anyhow::Result<()> {
    let place = found.place;
    let matrix = DMat3::from_quat(place.turn);
    let axes = [matrix.x_axis, matrix.y_axis, matrix.z_axis].map(|axis| axis.to_array());
    let value = serde_json::json!({ "origin": place.at.to_array(), "origin_within": finite(found.at_within), "axes": axes,
        "turn_within_degrees": finite(found.turn_within), "residuals": residuals(&found.residuals) });
    let words = |out: &mut dyn Write| -> std::io::Result<()> {
        writeln!(out, "{what}: {} mm{}", shown(place.at, 3), give(found.at_within, "mm"))?;
        writeln!(out, "turned by {}{}", robot.written(place.turn), give(found.turn_within, "° about its x, y and z"))
    };
    say_it(json, &value, &found.residuals, point, words)
}

/// Prints a result, and how far the points lie from it.
fn say_it(
    json: bool,
    value: &serde_json::Value,
    residuals: &Residuals,
    point: &str,
    words: impl Fn(&mut dyn Write) -> std::io::Result<()>,
) -> anyhow::Result<()> {
    let mut out = say::done(false);
    if json {
        writeln!(std::io::stdout(), "{value:#}")?;
        return Ok(());
    }
    words(&mut out)?;
    let Residuals { rms, worst, at, spare } = residuals;
    writeln!(out, "\nresiduals  {rms:.3} mm (root mean square), {worst:.3} mm at most ({point} {})", at + 1)?;
    if *spare == 0 {
        writeln!(out, "There are only as many points as are needed: nothing is known of the errors. Measure more.")?;
    } else if *worst > WORST * rms && *worst > NOTHING {
        writeln!(out, "{} {} lies far from the others: measure it again.", capital(point), at + 1)?;
    }
    Ok(())
}

/// A frame that leans by less, °, counts as upright.
const UPRIGHT: f64 = 1.0;

/// Changes values of a cell, if one is given; its comments are kept.
fn write(cell: Option<&Path>, values: &[(&str, String)]) -> anyhow::Result<()> {
    let Some(path) = cell else { return Ok(()) };
    let text = values.iter().try_fold(file::text(path)?, |text, (key, value)| edit::with_value(&text, key, value));
    let text = text.with_context(|| path.display().to_string())?;
    reach::parse_cell(path, &text)?;
    Ok(write_file(path, text.as_bytes())?)
}

fn array(v: DVec3) -> String {
    format!("[{}]", shown(v, 3))
}

/// A point is suspicious from this many times the mean distance, and this many mm.
const WORST: f64 = 2.5;
const NOTHING: f64 = 0.05;

fn capital(word: &str) -> String {
    let mut letters = word.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}

fn shown(v: DVec3, digits: usize) -> String {
    let places = 10_f64.powi(digits as i32);
    // A negative zero becomes 0.
    let [x, y, z] = ((v * places).round() / places + DVec3::ZERO).to_array();
    format!("{x:.digits$}, {y:.digits$}, {z:.digits$}")
}

/// The widths of the intervals, if anything is known of them.
fn give(within: DVec3, unit: &str) -> String {
    let digits = if within.max_element() < 0.01 { 6 } else { 3 };
    if within.is_finite() { format!("  ± {} {unit} (95 %)", shown(within, digits)) } else { String::new() }
}

fn finite(v: DVec3) -> Option<[f64; 3]> {
    v.is_finite().then(|| v.to_array())
}

fn residuals(own: &Residuals) -> serde_json::Value {
    serde_json::json!({ "rms": own.rms, "worst": own.worst, "worst_point": own.at + 1, "spare": own.spare })
}

/// A table with named columns.
struct Table {
    name: String,
    columns: Vec<String>,
    lines: Vec<(usize, Vec<String>)>,
}

impl Table {
    fn read(path: &Path) -> anyhow::Result<Self> {
        let text = file::text(path)?;
        let between = if text.lines().next().is_some_and(|head| head.contains(';')) { ';' } else { ',' };
        let fields = |line: &str| -> Vec<String> { line.split(between).map(|field| field.trim().to_owned()).collect() };
        let mut lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty() && !line.starts_with('#'));
        let name = path.display().to_string();
        let (_, head) = lines.next().with_context(|| format!("{name}: the file is empty"))?;
        let columns = fields(head).into_iter().map(|column| column.to_lowercase()).collect();
        Ok(Self { name, columns, lines: lines.map(|(k, line)| (k + 1, fields(line))).collect() })
    }

    fn column(&self, name: &str) -> anyhow::Result<usize> {
        let found = self.columns.iter().position(|column| column == name);
        found.with_context(|| {
            format!("{}: there is no column \"{name}\"; the first line names {}", self.name, self.columns.join(", "))
        })
    }

    fn words(&self, name: &str) -> anyhow::Result<Vec<String>> {
        let at = self.column(name)?;
        let word =
            |(_, fields): &(usize, Vec<String>)| fields.get(at).map(|word| word.to_lowercase()).unwrap_or_default();
        Ok(self.lines.iter().map(word).collect())
    }

    fn rows(&self, names: &[&str]) -> anyhow::Result<Vec<Vec<f64>>> {
        let places = names.iter().map(|name| self.column(name)).collect::<anyhow::Result<Vec<_>>>()?;
        let row = |(line, fields): &(usize, Vec<String>)| {
            let number = |(at, column): (&usize, &&str)| {
                let field = fields.get(*at).map(String::as_str).unwrap_or_default();
                let number = field.parse::<f64>().ok().filter(|number| number.is_finite());
                number
                    .with_context(|| format!("{}: line {line}: \"{field}\" in column {column} is no number", self.name))
            };
            places.iter().zip(names).map(number).collect()
        };
        self.lines.iter().map(row).collect()
    }
}
