//! Profiles: everything that belongs to a process, a material and a cell, as a TOML file people can edit.
//!
//! There are no hidden process values: every key below [`Profile`] must stand in the file, except those marked
//! optional. Unknown keys and impossible values are refused with their line (`read.rs`, `limits.rs`).

mod arctech;
mod check;
mod dry_run;
pub mod edit;
mod fanuc;
mod gcode;
mod hybrid;
mod inform;
mod krl;
mod limits;
mod marlin;
mod one_loop;
mod process;
mod rapid;
mod read;
mod reasons;
mod start_stop;
mod urscript;

pub use arctech::{ArcTech, ArcTechCrater, ArcTechStrike, ArcTechWeld, KrlArc};
pub use check::CheckLimits;
pub use fanuc::{Fanuc, FanucSpeed};
pub use gcode::{Gcode, GcodeComments};
pub use hybrid::Hybrid;
pub use inform::{Inform, InformSpeed};
pub use krl::Krl;
pub use marlin::Marlin;
pub use one_loop::Loop;
pub use process::{Follow, Process};
pub use rapid::{Rapid, RapidArc, RapidModules, RapidSeam, WireFeedUnit};
pub use read::ProfileError;
pub(crate) use read::{explain, line_of, line_of_key, nearest};
pub use start_stop::StartStop;
pub use urscript::Urscript;

use crate::bead::wall::{WallBead, WallError};
use crate::bead::{Bead, Law, MassBalance, Overlap, Section};
use crate::fill::hybrid::HybridSettings;
use crate::fill::wall::WallSettings;
use crate::fill::{ContourOrder, FillSettings, RasterSpacing};
use crate::motion::Motion;
use crate::order::{Method, OrderSettings, Seam};
use crate::slice::SliceOptions;
use glam::DVec2;
use serde::{Deserialize, Serialize};

/// The built-in profiles as (name, TOML text).
pub const BUILT_IN: [(&str, &str); 5] = [
    ("cmt-al2319-kuka", include_str!("../../../../profiles/cmt-al2319-kuka.toml")),
    ("cmt-steel-abb", include_str!("../../../../profiles/cmt-steel-abb.toml")),
    ("cmt-steel-robots", include_str!("../../../../profiles/cmt-steel-robots.toml")),
    ("plasma-304-cnc", include_str!("../../../../profiles/plasma-304-cnc.toml")),
    ("fdm-abs-0.4", include_str!("../../../../profiles/fdm-abs-0.4.toml")),
];

/// A process on a cell.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Profile {
    /// Name by which the profile is chosen.
    pub name: String,
    /// One line for lists.
    pub description: String,
    /// Dialects written when none is asked for: `krl`, `gcode`, `marlin`, `rapid`, `fanuc`, `inform`, `urscript`.
    pub posts: Vec<String>,
    /// The wire.
    pub wire: Wire,
    /// Arc, wire feed, speed and gas.
    pub process: Process,
    /// The single bead.
    pub bead: BeadShape,
    /// The layers.
    pub layers: Layers,
    /// How layers are filled.
    pub fill: Fill,
    /// Thresholds of the strategy `hybrid`; optional.
    #[serde(default)]
    pub hybrid: Hybrid,
    /// How the strategy `loop` lays; optional.
    #[serde(default, rename = "loop")]
    pub one_loop: Loop,
    /// How the strategy `wall` lays; optional.
    #[serde(default)]
    pub wall: Wall,
    /// Order of passes; optional.
    #[serde(default)]
    pub order: Order,
    /// Tolerances of slicing; optional.
    #[serde(default)]
    pub slice: Slice,
    /// Limits of `beadwright check`; optional.
    #[serde(default)]
    pub check: CheckLimits,
    /// Moves without arc.
    pub travel: Travel,
    /// How paths become moves of a program; optional.
    #[serde(default)]
    pub program: Program,
    /// How passes begin and end, and how long layers wait; optional.
    #[serde(default)]
    pub start_stop: StartStop,
    /// Acceleration, for machines whose time depends on it; optional.
    pub motion: Option<Motion>,
    /// KUKA KRL; needed for the post `krl`.
    pub krl: Option<Krl>,
    /// CNC G-code; needed for the post `gcode`.
    pub gcode: Option<Gcode>,
    /// Printers' G-code; needed for the post `marlin`.
    pub marlin: Option<Marlin>,
    /// ABB RAPID; needed for the post `rapid`.
    pub rapid: Option<Rapid>,
    /// FANUC TP; needed for the post `fanuc`.
    pub fanuc: Option<Fanuc>,
    /// Yaskawa INFORM; needed for the post `inform`.
    pub inform: Option<Inform>,
    /// URScript; needed for the post `urscript`.
    pub urscript: Option<Urscript>,
    /// Whether programs only move: a way of writing them, no value of the file.
    #[serde(skip)]
    dry_run: bool,
}

/// The wire.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Wire {
    /// Material, for the report.
    pub material: String,
    /// Diameter, mm.
    pub diameter: f64,
    /// Density, g/cm³.
    pub density: f64,
}

/// The single bead.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct BeadShape {
    /// Width at the foot, mm.
    pub width: f64,
    /// Height at the crown, mm.
    pub height: f64,
    /// Cross-section: `parabola`, `ellipse`, or `stadium` for the flat beads of printers; default parabola.
    #[serde(default)]
    pub section: Section,
    /// How the height follows the width at a constant wire feed: `constant-height`, `constant-ratio`, or measured beads as
    /// `{ library = [[width, height], …] }` in mm; default constant-height.
    #[serde(default)]
    pub law: Law,
}

/// The layers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Layers {
    /// Thickness, mm; of walls only where their height is not foretold.
    pub height: f64,
    /// Whether the layers lie where the wall's beads will be (Li et al., eqs 5 to 8) instead of one thickness apart:
    /// `auto` for the strategy `wall`, `always` or `never`; default auto.
    #[serde(default)]
    pub foretell: Foretell,
}

/// When the heights of layers are foretold from the bead.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Foretell {
    /// For the strategy `wall`.
    #[default]
    Auto,
    /// For every strategy.
    Always,
    /// Layers are one thickness apart.
    Never,
}

/// How the raster angle changes from layer to layer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum RasterTurn {
    /// The same angle on every layer.
    Fixed,
    /// Turned by 90° on every second layer.
    Alternate,
    /// Turned by `raster_increment` from layer to layer.
    Increment,
    /// The angle with the fewest turns, chosen for every two layers, the second turned by 90° (Han et al. 2018, 3.1).
    Best,
}

/// How layers are filled.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Fill {
    /// Strategy: `loop`, `raster`, `zigzag`, `contour`, `compound`, `hybrid` or `wall`.
    pub strategy: String,
    /// Model of the overlap of neighbouring beads, which gives the stepover.
    pub overlap: Overlap,
    /// Stepover, mm; only with `overlap = "free"`.
    pub stepover: Option<f64>,
    /// Distance from the innermost perimeter to the infill, in bead widths (0.591 by Liu et al. 2022).
    pub contour_gap: f64,
    /// Perimeters around the infill of `compound`.
    pub perimeters: u32,
    /// Order of contours: `outside-in` or `inside-out`.
    pub contour_order: ContourOrder,
    /// Extra metal outside the part for machining, mm.
    pub machining_allowance: f64,
    /// Angle of the scan lines on the first layer, ° from x.
    pub raster_angle: f64,
    /// Change of the angle from layer to layer: `fixed`, `alternate`, `increment`, or `best` for the angle with the fewest
    /// turns, chosen for every two layers.
    pub raster_turn: RasterTurn,
    /// Turn per layer for `increment`, °.
    pub raster_increment: f64,
    /// Scan lines spread evenly (`even`) or exactly one stepover apart (`exact`, Liu et al. 2022, eq 11).
    pub raster_spacing: RasterSpacing,
    /// Shorter passes are left out with a warning, mm.
    pub min_pass_length: f64,
    /// Whether `compound` lays the perimeters before the infill; default false.
    #[serde(default)]
    pub perimeters_first: bool,
    /// Part of the infill of `compound` that is filled inside the part, 0 to 1; default 1.
    #[serde(default = "full")]
    pub infill_density: f64,
    /// Layers at every top and bottom that are filled solid when the infill is sparse; default 3.
    #[serde(default = "three")]
    pub solid_layers: u32,
}

fn full() -> f64 {
    1.0
}

fn three() -> u32 {
    3
}

/// How the strategy `wall` lays (Li et al.); every key has a default.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Wall {
    /// Ends and crossings of centre-lines nearer than this are one junction, in bead widths; default 0.5.
    pub junction_tolerance: f64,
    /// How far the path may leave the middle of the wall where it is smooth, mm; default 0.02.
    pub chord_error: f64,
    /// Radius of the path's corners, in bead widths; default 0.5.
    pub corner_radius: f64,
    /// How far paths that touch at a junction and turn away keep from its middle, in bead widths; default 0.4.
    pub junction_gap: f64,
    /// How far the end of a path at a junction stays away from the paths that pass there, in bead widths; default 0.4.
    pub end_gap: f64,
    /// The narrowest bead of the process, in bead widths: thinner walls are welded with it; default 0.7.
    pub min_width: f64,
    /// The widest bead of the process, in bead widths; default 1.4.
    pub max_width: f64,
}

impl Default for Wall {
    fn default() -> Self {
        Self {
            junction_tolerance: 0.5,
            chord_error: 0.02,
            corner_radius: 0.5,
            junction_gap: 0.4,
            end_gap: 0.4,
            min_width: 0.7,
            max_width: 1.4,
        }
    }
}

/// Order of passes.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Order {
    /// How order and start points are found: `nearest`, `improved-nearest`, `ant-colony`, `local-search` or `exact`;
    /// default local-search.
    pub method: Method,
    /// Where closed passes begin: `nearest`, `aligned`, `rotate` (two bead widths further on every layer) or `spread` (as far
    /// as can be from the seams below); default nearest.
    pub seam: Seam,
    /// Whether passes run the other way on every second layer, so that ends come to lie over starts: closed passes turn
    /// round, open ones begin at their left end on one layer (least x, then least y) and at their right end on the next;
    /// default false.
    pub alternate: bool,
}

/// Tolerances of slicing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Slice {
    /// Widest gap in an open contour that is bridged, mm; default 0.5.
    pub close_gap: f64,
    /// Contour vertices within this distance of the remaining line are dropped, mm; default 0.01.
    pub simplify: f64,
}

impl Default for Slice {
    fn default() -> Self {
        Self { close_gap: 0.5, simplify: 0.01 }
    }
}

/// Moves without arc.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Travel {
    /// Speed, mm/s.
    pub speed: f64,
    /// Height of the move above the layer, mm.
    pub clearance: f64,
}

/// How paths become moves of a program; every key has a default.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Program {
    /// How far the moves may leave the planned path so that they are fewer, mm, 0.015 or more; default 0: every point
    /// is kept.
    pub chord_tolerance: f64,
    /// Whether arcs are fitted, and not straight moves only; default false.
    pub arcs: bool,
    /// Speeds along a pass that differ by no more than this part become one, with the same time along it: fewer changes,
    /// longer moves; default 0.
    pub speed_tolerance: f64,
    /// Least time between two points of a pass, s: nearer ones are merged where that keeps the chord tolerance, since
    /// controllers read ahead only so fast (KRC4 interpolates every 0.012 s); default 0: none are.
    pub min_point_time: f64,
    /// Turn of the torch about its own axis, on top of the orientation in the robot's section, °: counter-clockwise seen from
    /// behind the torch. Robots only; `beadwright reach` tells the best one. Default 0.
    pub torch_angle: f64,
    /// Angle of the turn table under the part, the same for the whole program, °; `beadwright reach` tells the best one. The
    /// part's frame must turn with the table. KRL writes it as E1, RAPID as the first external axis; other posts refuse it.
    /// Left out where there is no table.
    pub table_angle: Option<f64>,
}

/// What a number of a profile can be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limit {
    /// Full key, such as `bead.width`.
    pub key: &'static str,
    /// The value, or one to begin with where it is left out.
    pub value: f64,
    /// Least value.
    pub least: f64,
    /// Greatest value.
    pub greatest: f64,
    /// The unit, and what the range depends on.
    pub unit: &'static str,
    /// Why, as part of a sentence.
    pub reason: &'static str,
}

impl Profile {
    /// Reads and checks a profile from TOML text.
    ///
    /// # Errors
    /// [`ProfileError`] with the line, the key and what would be right.
    pub fn parse(text: &str) -> Result<Self, ProfileError> {
        read::parse(text)
    }

    /// A built-in profile.
    ///
    /// # Errors
    /// [`ProfileError::UnknownName`] with the nearest name.
    pub fn built_in(name: &str) -> Result<Self, ProfileError> {
        Self::parse(Self::built_in_text(name)?)
    }

    /// The TOML text of a built-in profile.
    ///
    /// # Errors
    /// [`ProfileError::UnknownName`] with the nearest name.
    pub fn built_in_text(name: &str) -> Result<&'static str, ProfileError> {
        let found = BUILT_IN.iter().find(|(known, _)| *known == name);
        found.map(|(_, text)| *text).ok_or_else(|| read::unknown_name(name))
    }

    /// JSON schema of the TOML file, for editors.
    #[cfg(feature = "schema")]
    pub fn schema() -> serde_json::Value {
        schemars::schema_for!(Self).to_value()
    }

    /// What the numbers of this profile can be, for forms.
    pub fn limits(&self) -> Vec<Limit> {
        let limit = |(key, value, least, greatest, unit): limits::Range| {
            let reason = reasons::reason(key);
            Limit { key, value, least, greatest, unit, reason }
        };
        limits::ranges(self).into_iter().map(limit).collect()
    }

    /// The single bead.
    pub fn bead(&self) -> Bead {
        let BeadShape { width, height, section, .. } = self.bead;
        Bead { width, height, section }
    }

    /// The wall whose heights tell where the layers lie; `None` where they are one thickness apart.
    ///
    /// # Errors
    /// [`WallError`] for a bead of which no wall can be foretold.
    pub fn wall_bead(&self) -> Result<Option<WallBead>, WallError> {
        let foretold = match self.layers.foretell {
            Foretell::Auto => self.fill.strategy == "wall",
            Foretell::Always => true,
            Foretell::Never => false,
        };
        foretold.then(|| WallBead::new(self.bead.width, self.bead.height)).transpose()
    }

    /// Distance between neighbouring centre-lines, mm.
    pub fn stepover(&self) -> f64 {
        match self.fill.overlap.ratio() {
            Some(ratio) => ratio * self.bead.width,
            None => self.fill.stepover.unwrap_or(self.bead.width),
        }
    }

    /// Wire against bead.
    pub fn mass_balance(&self) -> MassBalance {
        let Process { wire_feed_speed, efficiency, deposition_speed, .. } = self.process;
        MassBalance::new(self.bead(), wire_feed_speed, self.wire.diameter, efficiency, deposition_speed)
    }

    /// Heat input, J/mm: current × voltage / speed; `None` where the profile gives no current or voltage.
    pub fn heat_input(&self) -> Option<f64> {
        Some(self.process.current? * self.process.voltage? / self.process.deposition_speed)
    }

    /// How slicing is done.
    pub fn slice_options(&self) -> SliceOptions {
        let Slice { close_gap, simplify } = self.slice;
        SliceOptions { layer_height: self.layers.height, close_gap, simplify }
    }

    /// How a layer is filled.
    pub fn fill_settings(&self, layer: usize) -> FillSettings<'_> {
        let fill = &self.fill;
        let turned = match fill.raster_turn {
            // The plan chooses the best angle, which depends on the layer.
            RasterTurn::Fixed | RasterTurn::Best => 0.0,
            RasterTurn::Alternate => 90.0 * (layer % 2) as f64,
            RasterTurn::Increment => fill.raster_increment * layer as f64,
        };
        FillSettings {
            bead: self.bead(),
            law: &self.bead.law,
            stepover: self.stepover(),
            contour_gap: fill.contour_gap * self.bead.width,
            perimeters: fill.perimeters,
            contour_order: fill.contour_order,
            perimeters_first: fill.perimeters_first,
            infill_density: fill.infill_density,
            solid: None,
            machining_allowance: fill.machining_allowance,
            raster_angle: ((fill.raster_angle + turned) % 180.0).to_radians(),
            raster_spacing: fill.raster_spacing,
            min_pass_length: fill.min_pass_length.max(self.soonest_arc_end() * self.process.deposition_speed),
            layer,
            hybrid: self.hybrid_settings(),
            wall: self.wall_settings(),
            one_loop: self.one_loop.options(self.bead.width),
            datum: DVec2::ZERO,
        }
    }

    /// A pass that is over sooner than this, s, is over before its arc is steady. Where the hybrid follows its paper to the
    /// letter it lays such passes all the same.
    pub fn soonest_arc_end(&self) -> f64 {
        if self.hybrid.literal { 0.0 } else { self.process.arc_start_delay }
    }

    fn wall_settings(&self) -> WallSettings {
        let (wall, w) = (&self.wall, self.bead.width);
        WallSettings {
            tolerance: wall.junction_tolerance * w,
            chord_error: wall.chord_error,
            corner_radius: wall.corner_radius,
            junction_gap: wall.junction_gap,
            end_gap: wall.end_gap,
            width_limits: (wall.min_width * w, wall.max_width * w),
        }
    }

    /// How the passes of a layer are put in order.
    pub fn order_settings(&self, layer: usize) -> OrderSettings {
        let Order { method, seam, alternate } = self.order;
        OrderSettings { method, seam, alternate, layer, bead_width: self.bead.width }
    }

    fn hybrid_settings(&self) -> HybridSettings {
        let (h, w, d) = (&self.hybrid, self.bead.width, self.stepover());
        HybridSettings {
            literal: h.literal,
            pocket_depth: h.pocket_depth * d,
            tolerance: h.tolerance * d,
            min_pocket_area: h.min_pocket_area * w * w,
            min_pocket_length: h.min_pocket_length * w,
            skeleton_gap: h.skeleton_gap * d,
            least_gap: h.least_gap * d,
            region_width: h.region_width * d,
            scan_along: h.scan_along,
            order: h.order,
            end_overlap: h.end_overlap * w,
            tip_reach: h.tip_reach,
            width_limits: (h.min_width * w, h.max_width * w),
        }
    }

    /// What does not fit together although every value is possible, as sentences.
    pub fn notes(&self) -> Vec<String> {
        let rise = self.bead().rise(self.stepover());
        let height = self.layers.height;
        let foretold = self.wall_bead().is_ok_and(|wall| wall.is_some());
        let rise_note = (!foretold && (rise / height - 1.0).abs() > MassBalance::TOLERANCE).then(|| {
            let fitting = self.bead().for_rise(self.stepover(), height);
            format!(
                "Beads {:.2} mm high at a stepover of {:.2} mm rise {rise:.2} mm a layer, but layers are {height:.2} mm \
                 high. A bead.height of {:.2} mm or a layers.height of {rise:.2} mm would fit.",
                self.bead.height,
                self.stepover(),
                fitting.height,
            )
        });
        let ends = self.start_stop.notes(self.fill.min_pass_length);
        self.mass_balance().warning().into_iter().chain(rise_note).chain(ends).collect()
    }
}
