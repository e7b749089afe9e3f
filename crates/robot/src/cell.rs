//! Cells: an arm with its torch and the position of the part, as a TOML file that people can edit.

use crate::arm::{Arm, Frame};
use crate::arm_keys::ArmKeys;
use crate::arm_table::ArmTable;
use crate::body::{Body, Fixture};
use crate::error::CellError;
use crate::home::Home;
use crate::urdf;
use bead_part::text::toml::{explain, line_of, line_of_key, nearest};
use glam::{DQuat, DVec3};
use serde::{Deserialize, Serialize};

/// The built-in cells as (name, TOML text).
pub const BUILT_IN: [(&str, &str); 8] = [
    ("kuka-kr20-r1810", include_str!("../cells/kuka-kr20-r1810.toml")),
    ("abb-irb1410", include_str!("../cells/abb-irb1410.toml")),
    ("abb-irb2600-12-165", include_str!("../cells/abb-irb2600-12-165.toml")),
    ("kuka-kr8-r1440-arc", include_str!("../cells/kuka-kr8-r1440-arc.toml")),
    ("fanuc-arc-mate-100id", include_str!("../cells/fanuc-arc-mate-100id.toml")),
    ("yaskawa-ar2010", include_str!("../cells/yaskawa-ar2010.toml")),
    ("ur5e", include_str!("../cells/ur5e.toml")),
    ("ur10e", include_str!("../cells/ur10e.toml")),
];

/// An arm, its torch and the position of the part; with the arm's keys while it is being read.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cell<A = ArmTable> {
    /// Name.
    pub name: String,
    /// One line of description.
    pub description: String,
    /// The dialect that its controller reads, such as `krl`; optional: without it no program is known not to fit.
    #[serde(default)]
    pub dialect: Option<String>,
    /// Whether the part lies on a positioner: its axes stand in the profile (`program.positioner`), and the part is where it is with all
    /// of them at 0°; default no.
    #[serde(default)]
    pub positioner: bool,
    /// The robot.
    pub arm: A,
    /// Tool frame on the flange.
    pub torch: Torch,
    /// Frame of the part in that of the robot; on a turn table, with the table at 0°.
    pub part: PartPlace,
    /// Frame of a scanner in that of the robot; optional.
    #[serde(default)]
    pub scanner: Option<ScannerPlace>,
    /// Linear axis on which the robot stands; optional.
    #[serde(default)]
    pub linear_axis: Option<LinearAxis>,
    /// Turn table that carries the part; optional.
    #[serde(default)]
    pub table: Option<Table>,
    /// Where programs begin and end; optional: without it the moves from and to home are not checked.
    #[serde(default)]
    pub home: Option<Home>,
    /// Thickness of the arm and size of the table; optional: without it collisions are not checked.
    #[serde(default)]
    pub body: Option<Body>,
}

/// The torch: its tool frame on the flange, z along the wire.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Torch {
    /// The wire's tip, mm.
    pub position: [f64; 3],
    /// Turns about z, the new y and the new x, °.
    pub rotation: [f64; 3],
}

/// Position of the part's origin relative to the foot of the robot.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PartPlace {
    /// Position, mm.
    pub position: [f64; 3],
    /// Turn about the vertical, °.
    pub rotation: f64,
}

/// Place and orientation of a scanner relative to the foot of the robot.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ScannerPlace {
    /// Its origin, mm.
    pub position: [f64; 3],
    /// Turns about z, the new y and the new x, °.
    pub rotation: [f64; 3],
}

/// A linear axis (track, carriage) on which the robot stands.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LinearAxis {
    /// The direction in which the robot's foot moves as the axis value increases, in the robot's x, y and z; of any
    /// length.
    pub direction: [f64; 3],
    /// Least and greatest position, mm. Part and table are given with the axis at 0.
    pub limits: [f64; 2],
}

/// A turn table with a vertical axis.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Table {
    /// Position of its axis relative to the foot of the robot: x and y, mm.
    pub axis: [f64; 2],
    /// 1 if its positive direction is counter-clockwise seen from above, −1 otherwise.
    pub direction: i8,
    /// Least and greatest angle, °.
    pub limits: [f64; 2],
}

impl Cell {
    /// A built-in cell.
    ///
    /// ```
    /// use bead_robot::Cell;
    /// use glam::DVec3;
    ///
    /// // With all joints at 0° the forearm lies level: 150 + 720 + 85 mm forward, 475 + 600 + 120 mm up.
    /// let cell = Cell::built_in("abb-irb1410")?;
    /// let flange = cell.arm().forward(&[0.0; 6]);
    /// assert!(flange.position.distance(DVec3::new(955.0, 0.0, 1195.0)) < 1e-6);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`CellError::UnknownName`] with the nearest name.
    pub fn built_in(name: &str) -> Result<Self, CellError> {
        Self::parse(Self::built_in_text(name)?)
    }

    /// The text of a built-in cell, to be saved and edited.
    ///
    /// ```
    /// use bead_robot::Cell;
    ///
    /// assert!(Cell::built_in_text("ur10e").is_ok());
    /// let error = Cell::built_in_text("ur10").err().map(|error| error.to_string());
    /// assert!(error.is_some_and(|text| text.contains("Did you mean \"ur10e\"?")));
    /// ```
    ///
    /// # Errors
    /// [`CellError::UnknownName`] with the nearest name.
    pub fn built_in_text(name: &str) -> Result<&'static str, CellError> {
        let known = BUILT_IN.map(|(name, _)| name);
        let found = BUILT_IN.iter().find(|(known, _)| *known == name).map(|(_, text)| *text);
        found.ok_or_else(|| CellError::UnknownName {
            name: name.to_owned(),
            hint: match nearest(name, known) {
                Some(near) => format!("Did you mean \"{near}\"?"),
                None => format!("Known: {}. A path to a TOML file is accepted too.", known.join(", ")),
            },
        })
    }

    /// Reads a cell whose arm is not in another file.
    ///
    /// # Errors
    /// [`CellError`] with the line.
    pub fn parse(text: &str) -> Result<Self, CellError> {
        Self::parse_with(text, |_| Err("only cells that are files can name another file.".to_owned()))
    }

    /// Reads a cell; `read` returns the text of the URDF file that it names, or a reason why not.
    ///
    /// # Errors
    /// [`CellError`] with the line.
    pub fn parse_with(text: &str, read: impl FnOnce(&str) -> Result<String, String>) -> Result<Self, CellError> {
        let cell: Cell<ArmKeys> = toml::from_str(text).map_err(|e| {
            let line = e.span().map_or(1, |span| line_of(text, span.start));
            CellError::Text { line, reason: explain(e.message()) }
        })?;
        let arm = cell.arm.clone().table(read).map_err(|wrong| wrong.at(text))?;
        let Cell {
            name, description, dialect, positioner, torch, part, scanner, linear_axis, table, home, body, ..
        } = cell;
        let cell =
            Self { name, description, dialect, positioner, arm, torch, part, scanner, linear_axis, table, home, body };
        match cell.first_broken() {
            None => Ok(cell),
            Some((key, value, reason)) => Err(CellError::Value { line: line_of_key(text, key), key, value, reason }),
        }
    }

    /// The same cell with the arm of a URDF file.
    ///
    /// # Errors
    /// [`CellError::Urdf`] if the file is not understood, or its arm is of an unsupported kind.
    pub fn with_urdf(self, text: &str) -> Result<Self, CellError> {
        Ok(Self { arm: urdf::read(text, &urdf::Ends::default())?, ..self })
    }

    /// The arm, ready to be moved.
    pub fn arm(&self) -> Arm {
        self.arm.arm()
    }

    /// The torch's frame on the flange.
    pub fn flange_from_tool(&self) -> Frame {
        Frame::from_zyx(self.torch.position, self.torch.rotation)
    }

    /// The frame of the scanner in that of the part, if the cell has a scanner: points that it sees, where they lie on the part, with
    /// turn table and linear axis at 0.
    ///
    /// ```
    /// use bead_robot::{Cell, ScannerPlace};
    /// use glam::DVec3;
    ///
    /// // A scanner above the part that looks down at it.
    /// let mut cell = Cell::built_in("ur10e")?;
    /// let [x, y, z] = cell.part.position;
    /// cell.scanner = Some(ScannerPlace { position: [x, y, z + 400.0], rotation: [cell.part.rotation, 0.0, 180.0] });
    /// let seen = cell.part_from_scanner().map(|frame| frame.apply(DVec3::new(10.0, 20.0, 390.0)));
    /// assert!(seen.is_some_and(|seen| seen.distance(DVec3::new(10.0, -20.0, 10.0)) < 1e-9));
    /// # Ok::<(), bead_robot::CellError>(())
    /// ```
    pub fn part_from_scanner(&self) -> Option<Frame> {
        let ScannerPlace { position, rotation } = self.scanner?;
        Some(self.part.base_from_part().inverse().then(&Frame::from_zyx(position, rotation)))
    }

    fn first_broken(&self) -> Option<(&'static str, String, String)> {
        let mut ranges = self.arm.ranges();
        ranges.push(("part.rotation", self.part.rotation, -360.0, 360.0, "°"));
        ranges.extend(self.torch.position.map(|v| ("torch.position", v, -5e3, 5e3, "mm")));
        ranges.extend(self.torch.rotation.map(|v| ("torch.rotation", v, -360.0, 360.0, "°")));
        ranges.extend(self.part.position.map(|v| ("part.position", v, -1e5, 1e5, "mm")));
        if let Some(scanner) = &self.scanner {
            ranges.extend(scanner.position.map(|v| ("scanner.position", v, -1e5, 1e5, "mm")));
            ranges.extend(scanner.rotation.map(|v| ("scanner.rotation", v, -360.0, 360.0, "°")));
        }
        if let Some(axis) = &self.linear_axis {
            ranges.extend(axis.direction.map(|v| ("linear_axis.direction", v, -1e3, 1e3, "(of any length)")));
            ranges.extend(axis.limits.map(|v| ("linear_axis.limits", v, -1e5, 1e5, "mm")));
        }
        if let Some(table) = &self.table {
            ranges.extend(table.axis.map(|v| ("table.axis", v, -1e5, 1e5, "mm")));
            ranges.extend(table.limits.map(|v| ("table.limits", v, -7200.0, 7200.0, "°")));
        }
        if let Some(home) = &self.home {
            ranges.extend(home.joints.map(|v| ("home.joints", v, -7200.0, 7200.0, "°")));
        }
        if let Some(body) = &self.body {
            let sizes = [
                ("body.base", body.base),
                ("body.upper_arm", body.upper_arm),
                ("body.forearm", body.forearm),
                ("body.hand", body.hand),
                ("body.torch", body.torch),
                ("body.stick_out", body.stick_out),
            ];
            ranges.extend(sizes.map(|(key, v)| (key, v, 0.0, 2e3, "mm")));
            ranges.extend(body.table.map(|v| ("body.table", v, 0.0, 1e5, "mm")));
            for fixture in &body.fixtures {
                ranges.extend(fixture.low.map(|v| ("body.fixtures.low", v, -1e5, 1e5, "mm")));
                ranges.extend(fixture.high.map(|v| ("body.fixtures.high", v, -1e5, 1e5, "mm")));
            }
        }
        // Written so that NaN is also out of range.
        if let Some((key, value, low, high, unit)) =
            ranges.into_iter().find(|&(_, v, low, high, _)| !(v >= low && v <= high))
        {
            return Some((key, format!("{value}"), format!("it must lie between {low} and {high} {unit}.")));
        }
        if let Some(axis) = &self.linear_axis {
            if axis.direction == [0.0; 3] {
                let reason = "it must not be zero.".to_owned();
                return Some(("linear_axis.direction", format!("{:?}", axis.direction), reason));
            }
            if axis.limits[0] >= axis.limits[1] {
                let reason = "the least position comes first, then the greatest.".to_owned();
                return Some(("linear_axis.limits", format!("{:?}", axis.limits), reason));
            }
        }
        if let Some(table) = self.table.as_ref().filter(|t| t.direction.abs() != 1) {
            return Some(("table.direction", table.direction.to_string(), "it is 1 or -1.".to_owned()));
        }
        if let Some(table) = self.table.as_ref().filter(|t| t.limits[0] >= t.limits[1]) {
            let reason = "the least angle comes first, then the greatest.".to_owned();
            return Some(("table.limits", format!("{:?}", table.limits), reason));
        }
        let is_box = |fixture: &Fixture| (0..3).all(|axis| fixture.low[axis] < fixture.high[axis]);
        if let Some(fixture) = self.body.iter().flat_map(|body| &body.fixtures).find(|fixture| !is_box(fixture)) {
            let reason = "each coordinate must be less than that of body.fixtures.high.".to_owned();
            return Some(("body.fixtures.low", format!("{:?}", fixture.low), reason));
        }
        self.arm.first_broken()
    }
}

impl PartPlace {
    /// The frame of the part in that of the robot.
    pub fn base_from_part(&self) -> Frame {
        Frame { position: DVec3::from(self.position), rotation: DQuat::from_rotation_z(self.rotation.to_radians()) }
    }

    /// The position of the part when the table under it is at that angle, °.
    ///
    /// ```
    /// use bead_robot::{PartPlace, Table};
    /// use glam::DVec3;
    ///
    /// // 100 mm beyond the table's axis, as the robot sees it; a quarter of a turn later, beside it.
    /// let table = Table { axis: [1000.0, 0.0], direction: 1, limits: [-180.0, 180.0] };
    /// let part = PartPlace { position: [1100.0, 0.0, 500.0], rotation: 0.0 };
    /// let turned = part.turned_about(&table, 90.0);
    /// assert!(DVec3::from(turned.position).distance(DVec3::new(1000.0, 100.0, 500.0)) < 1e-9);
    /// assert_eq!(turned.rotation, 90.0);
    /// ```
    pub fn turned_about(&self, table: &Table, angle: f64) -> Self {
        let turn = f64::from(table.direction) * angle;
        let axis = DVec3::new(table.axis[0], table.axis[1], 0.0);
        let position = axis + DQuat::from_rotation_z(turn.to_radians()) * (DVec3::from(self.position) - axis);
        Self { position: position.to_array(), rotation: crate::arm::turned_near(self.rotation + turn, 0.0) }
    }

    /// The position in words.
    pub fn sentence(&self) -> String {
        let [x, y, z] = self.position;
        format!("x {x:.0} y {y:.0} z {z:.0} mm, turned by {:.0}°", self.rotation)
    }
}
