//! Profiles: everything that belongs to a process, a material and a cell, as a TOML file that people can edit.
//!
//! There are no hidden process values: every key below [`Profile`] must be in the file, except those marked optional.
//! Unknown keys and impossible values are refused with their line number (`read.rs`, `limits.rs`).

mod bead;
mod bodies;
mod check;
mod dry_run;
pub mod edit;
mod fill;
mod hybrid;
mod layers;
mod limits;
mod measured;
mod misfit;
mod missing;
mod one_loop;
mod order;
mod read;
mod slice;
mod usual;
mod wall;

pub use bead::BeadSection;
pub use bodies::{BodiesError, Body, Solid};
pub use check::CheckLimits;
pub use fill::{FillSection, RasterTurn};
pub use hybrid::HybridSection;
pub use layers::{LayersSection, Predict};
pub use misfit::Misfit;
pub use one_loop::LoopSection;
pub use order::OrderSection;
pub use read::ProfileError;
pub use slice::SliceSection;
pub use wall::WallSection;

use crate::bead::pace::PaceSettings;
use crate::bead::wall::{WallBead, WallError};
use crate::bead::{Bead, MassBalance};
use crate::chart::Chart;
use crate::dialect::inform::InformSpeed;
use crate::dialect::reading::{Options, Station};
use crate::dialect::{Job, Sections};
use crate::fill::around::Around;
use crate::fill::{FillSettings, StrategyName};
use crate::heat::{HeatError, HeatSection, HeatSettings, Interpass, Material, Substrate};
use crate::layer::Layer;
use crate::limit::Limit;
use crate::motion::Motion;
use crate::order::{Balance, OrderSettings};
use crate::preform::PreformSettings;
use crate::preform::figures::Rates;
use crate::preform::section::PreformSection;
use crate::process::{Cost, Dot, Process, Spot, StartStop, TorchShape, Travel, Wire};
use crate::program::{Positioner, ProgramSettings, Programmer, Safety, Weave};
use crate::robot::Track;
use crate::slice::{LayerFit, SliceOptions};
use crate::weld::WeldSettings;
use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};
use std::borrow::Borrow;

/// The text of a profile for plasma on a CNC: one process, and a controller's flavour of G-code.
macro_rules! plasma_304 {
    ($name:literal, $control:literal, $gcode:literal) => {
        concat!(
            "#:schema ./profile.schema.json\n# CNC plasma-arc deposition of stainless steel, after Liu et al. 2022 (doi 10.11951/j.issn.1005-0299.20210131).\n",
            "# The paper gives single beads 3-6 mm wide and 1-2 mm high; what it does not give is marked \"ours\".\n",
            "name = \"",
            $name,
            "\"\ndescription = \"Plasma arc, 304 stainless wire 0.8 mm, three-axis ",
            $control,
            "\"\nposts = [\"gcode\"]\n\n",
            include_str!("../../profiles/plasma-304/process.toml"),
            include_str!(concat!("../../profiles/plasma-304/", $gcode, ".toml"))
        )
    };
}

/// The built-in profiles as (name, TOML text).
pub const BUILT_IN: [(&str, &str); 8] = [
    ("cmt-al2319-kuka", include_str!("../../profiles/cmt-al2319-kuka.toml")),
    ("cmt-steel-abb", include_str!("../../profiles/cmt-steel-abb.toml")),
    ("cmt-steel-robots", include_str!("../../profiles/cmt-steel-robots.toml")),
    ("plasma-304-cnc", plasma_304!("plasma-304-cnc", "CNC", "linuxcnc")),
    ("plasma-304-fanuc", plasma_304!("plasma-304-fanuc", "CNC by Fanuc", "fanuc")),
    ("plasma-304-siemens", plasma_304!("plasma-304-siemens", "CNC by Siemens (Sinumerik)", "siemens")),
    ("plasma-304-twincat", plasma_304!("plasma-304-twincat", "machine with Beckhoff TwinCAT NC I", "twincat")),
    ("fdm-abs-0.4", include_str!("../../profiles/fdm-abs-0.4.toml")),
];

/// A process on a cell.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Profile {
    /// Name by which the profile is chosen.
    pub name: String,
    /// One-line description for lists.
    pub description: String,
    /// The profile whose values apply where this one gives none: a built-in name, or the path of a file relative to this
    /// one's folder; optional.
    #[serde(default, skip_serializing)]
    pub inherits: Option<String>,
    /// Names of the dialects in which programs are written if none is requested, such as `krl`; a path such as `./gantry`,
    /// relative to the profile's folder, is that of a folder with a dialect of your own.
    pub posts: Vec<String>,
    /// The wire.
    pub wire: Wire,
    /// Arc, wire feed, speed and gas.
    pub process: Process,
    /// The single bead.
    pub bead: BeadSection,
    /// The layers.
    pub layers: LayersSection,
    /// How layers are filled.
    pub fill: FillSection,
    /// Thresholds of the strategy `hybrid`; optional.
    #[serde(default)]
    pub hybrid: HybridSection,
    /// How the strategy `loop` lays beads; optional.
    #[serde(default, rename = "loop")]
    pub one_loop: LoopSection,
    /// How the strategy `wall` lays beads; optional.
    #[serde(default)]
    pub wall: WallSection,
    /// Order of passes; optional.
    #[serde(default)]
    pub order: OrderSection,
    /// Tolerances of slicing; optional.
    #[serde(default)]
    pub slice: SliceSection,
    /// Limits of `beadwright check`; optional.
    #[serde(default)]
    pub check: CheckLimits,
    /// Moves with the arc off.
    pub travel: Travel,
    /// How much room the torch takes, for parts that are welded one after another; optional.
    pub torch: Option<TorchShape>,
    /// How paths become moves of a program; optional.
    #[serde(default)]
    pub program: ProgramSettings,
    /// What the cell must supply; optional.
    #[serde(default)]
    pub safety: Safety,
    /// How the torch swings along a pass; optional.
    pub weave: Option<Weave>,
    /// How passes begin and end, and how long layers wait; optional.
    #[serde(default)]
    pub start_stop: StartStop,
    /// How a dot is welded, for islands too small for a bead; optional.
    pub spot: Option<Spot>,
    /// Acceleration, for machines on which it affects the time; optional.
    pub motion: Option<Motion>,
    /// How a part becomes its preform; optional.
    #[serde(default)]
    pub preform: PreformSection,
    /// Prices; optional.
    #[serde(default)]
    pub cost: Cost,
    /// Heat from the arc and to the surroundings, for temperatures; optional.
    pub heat: Option<HeatSection>,
    /// Thermal values of the part; optional.
    pub material: Option<Material>,
    /// The plate on which the part is built; optional.
    pub substrate: Option<Substrate>,
    /// How warm the metal may be where passes begin; optional.
    pub interpass: Option<Interpass>,
    /// Settings of the dialects; each has a section of its own.
    #[serde(flatten, skip_deserializing)]
    #[cfg_attr(feature = "schema", schemars(!skip_deserializing))]
    pub dialects: Sections,
    /// Whether programs only move the torch: a way of writing them, not a value in the file.
    #[serde(skip)]
    dry_run: bool,
}

impl Profile {
    /// Reads and checks a profile from TOML text.
    ///
    /// ```
    /// use beadwright::{Profile, ProfileError};
    ///
    /// // The refusal names the line of the impossible value.
    /// let text = Profile::built_in_text("cmt-al2319-kuka")?.replace("width = 7.54", "width = -1.0");
    /// let wrong = 1 + text.lines().take_while(|line| !line.starts_with("width = -1.0")).count();
    /// let refused = Profile::parse(&text);
    /// assert!(matches!(refused, Err(ProfileError::Value { line, .. }) if line == wrong));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`ProfileError`], which names the line, the key and what would be right.
    pub fn parse(text: &str) -> Result<Self, ProfileError> {
        read::parse(text, &mut read::built_in_base)
    }

    /// The same, where `inherits` may name more than built-in profiles: `base` gives the text for what it names.
    ///
    /// # Errors
    /// [`ProfileError`], including that of `base`.
    pub fn parse_with(
        text: &str,
        base: &mut dyn FnMut(&str) -> Result<String, ProfileError>,
    ) -> Result<Self, ProfileError> {
        read::parse(text, base)
    }

    /// Reads and checks a profile as [`serde_json`] writes it: a part of `plan.json`.
    ///
    /// # Errors
    /// [`ProfileError`]; its lines are those of [`Self::toml_text`].
    pub fn from_json(value: &serde_json::Value) -> Result<Self, ProfileError> {
        read::from_json(value)
    }

    /// The profile as TOML text, with every key that has a value.
    ///
    /// ```
    /// use beadwright::Profile;
    ///
    /// let profile = Profile::built_in("cmt-steel-abb")?;
    /// assert_eq!(Profile::parse(&profile.toml_text()?)?, profile);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`ProfileError::Text`] for numbers that TOML cannot hold.
    pub fn toml_text(&self) -> Result<String, ProfileError> {
        read::toml_text(&serde_json::json!(self))
    }

    /// A built-in profile.
    ///
    /// ```
    /// use beadwright::Profile;
    ///
    /// let profile = Profile::built_in("cmt-al2319-kuka")?;
    /// assert_eq!((profile.wire.material.as_str(), profile.wire.diameter), ("ER2319", 1.2));
    /// // Inclined flat tops lie 0.715 bead widths apart.
    /// assert!((profile.stepover() - 0.715 * profile.bead.width).abs() < 1e-9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
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

    /// The limits of this profile's numbers, for forms.
    pub fn limits(&self) -> Vec<Limit> {
        limits::limits(self)
    }

    /// How a part becomes its preform.
    pub fn preform_settings(&self) -> PreformSettings {
        let fill = self.fill_settings(0);
        self.preform.settings([self.bead.width, fill.double()], fill.min_pass_length, self.slice_options())
    }

    /// What a preform weighs, takes and costs.
    pub fn preform_rates(&self) -> Rates {
        let deposition = self.bead().area() * self.process.deposition_speed;
        Rates { density: self.wire.density, deposition, cost: self.cost.clone(), preform: self.preform.clone() }
    }

    /// The single bead.
    pub fn bead(&self) -> Bead {
        let BeadSection { width, height, section, .. } = self.bead;
        Bead { width, height, section }
    }

    /// The wall whose heights determine where the layers lie; `None` where they are one thickness apart.
    ///
    /// # Errors
    /// [`WallError`] for a bead from which no wall can be predicted.
    pub fn wall_bead(&self) -> Result<Option<WallBead>, WallError> {
        let predicted = match self.layers.predict {
            Predict::Auto => self.fill.strategy == StrategyName::Wall,
            Predict::Always => true,
            Predict::Never => false,
        };
        predicted.then(|| self.single_wall()).transpose()
    }

    /// Whether layers are as high as their metal fills them: not where walls are predicted from their beads, where an
    /// infill leaves gaps on purpose, or where a paper is followed to the letter.
    pub fn is_level(&self) -> bool {
        let walls = self.wall_bead().is_ok_and(|wall| wall.is_some());
        let literal = self.hybrid.literal && self.fill.strategy == StrategyName::Hybrid;
        self.layers.level && self.fill.infill_density >= 1.0 && !walls && !literal
    }

    /// The wall as thick as the bead is wide, one bead per layer, with the metal that a bead holds.
    ///
    /// # Errors
    /// [`WallError`] for a bead from which no wall can be predicted.
    pub fn single_wall(&self) -> Result<WallBead, WallError> {
        WallBead::for_wall(self.bead.width, self.bead().area())
    }

    /// What determines the pace of beads. Layers fitted evenly to a part, or to its walls, get the metal that fills them.
    pub fn pace_settings(&self) -> PaceSettings<'_> {
        let fitted = self.layers.fit == LayerFit::Even && !self.is_level();
        PaceSettings {
            bead: self.bead(),
            law: &self.bead.law,
            nominal: self.process.deposition_speed,
            stepover: self.stepover(),
            wall: self.wall_bead().ok().flatten(),
            filled: fitted.then_some(self.layers.height),
        }
    }

    /// The dot that the process lays; `None` without `[spot]`.
    pub fn dot(&self) -> Option<Dot> {
        self.spot.map(|spot| spot.dot(self.process.deposition_speed * self.bead().area()))
    }

    /// Distance between neighbouring centre-lines, mm.
    pub fn stepover(&self) -> f64 {
        match self.fill.overlap.ratio() {
            Some(ratio) => ratio * self.bead.width,
            None => self.fill.stepover.unwrap_or(self.bead.width),
        }
    }

    /// Balance of the wire fed and the bead laid.
    pub fn mass_balance(&self) -> MassBalance {
        let Process { wire_feed_speed, efficiency, deposition_speed, .. } = self.process;
        MassBalance::new(self.bead(), wire_feed_speed, self.wire.diameter, efficiency, deposition_speed)
    }

    /// Whether this is a process without arc and gas whose programs are for a printer: its wire is filament.
    pub fn prints(&self) -> bool {
        self.process.gas == "none" && self.posts.iter().any(|post| post == "marlin")
    }

    /// Heat input of the nominal bead, J/mm; `None` where the profile gives no current or voltage.
    pub fn heat_input(&self) -> Option<f64> {
        self.process.heat_at(self.process.deposition_speed)
    }

    /// How slicing is done.
    pub fn slice_options(&self) -> SliceOptions {
        let SliceSection { close_gap, simplify, .. } = self.slice;
        SliceOptions { layer_height: self.layers.height, close_gap, simplify }
    }

    /// How a layer is filled.
    ///
    /// ```
    /// use beadwright::planar::{DVec2, Polygon, Ring};
    /// use beadwright::{Profile, StrategyName};
    ///
    /// // Half a bead of 7.54 mm stays free at each edge; the 42.46 mm in between take nine lines, at most 5.39 mm apart.
    /// let profile = Profile::built_in("cmt-al2319-kuka")?;
    /// let plate = Polygon::simple(Ring::new([(0.0, 0.0), (60.0, 0.0), (60.0, 50.0), (0.0, 50.0)].map(DVec2::from).to_vec()));
    /// let laid = StrategyName::Raster.strategy().fill(&plate, &profile.fill_settings(0));
    /// assert_eq!(laid.stages[0].len(), 9);
    /// assert!(laid.stages[0].iter().all(|line| (line.length() - (60.0 - 7.54)).abs() < 0.01));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn fill_settings(&self, layer: usize) -> FillSettings<'_> {
        let fill = &self.fill;
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
            raster_angle: fill.angle(layer),
            raster_spacing: fill.raster_spacing,
            line_ends: fill.line_ends,
            // If a strategy has the choice, its passes last longer than the start of their arc.
            min_pass_length: fill.min_pass_length.max(self.steady_after() * self.process.deposition_speed),
            layer,
            hybrid: self.hybrid.settings(self.bead.width, self.stepover()),
            wall: self.wall.settings(self.bead.width),
            one_loop: self.one_loop.settings(self.bead.width),
            turn: None,
            datum: DVec2::ZERO,
        }
    }

    /// A pass that takes less time than this, s, ends before its arc is steady: 0 where the torch waits until then.
    pub(crate) fn soonest_arc_end(&self) -> f64 {
        let stands = |post: &String| self.dialects.get(post).is_some_and(|section| section.stands_at_start());
        let stands = !self.posts.is_empty() && self.posts.iter().all(stands);
        if stands { 0.0 } else { self.steady_after() }
    }

    /// How long an arc takes to become steady, s; a hybrid that follows its paper to the letter ignores it.
    fn steady_after(&self) -> f64 {
        if self.hybrid.literal { 0.0 } else { self.process.arc_start_delay }
    }

    /// The most instructions that a pass may have, so that all posts can write it; `None` where it may have any number.
    pub(crate) fn longest_pass(&self) -> Option<usize> {
        self.posts.iter().filter_map(|post| self.dialects.get(post)?.longest_pass(&self.program)).min()
    }

    /// Whether the pace of passes is that at which they fill the height of their layer, before metal is shared out;
    /// otherwise they fill the height of a usual layer.
    pub(crate) fn fills_layers(&self) -> bool {
        let paces = self.pace_settings();
        paces.filled.is_some() || paces.wall.is_some()
    }

    /// How the passes of a layer are put in order.
    pub fn order_settings(&self, layer: usize) -> OrderSettings {
        /// The time in which the heat of a bead fades to 1/e, s, and how much longer travels may take, as a fraction of the
        /// time of the arc, for the sake of balanced heat; our own choice.
        const BALANCE: (f64, f64) = (60.0, 0.05);
        let OrderSection { method, seam, alternate, distortion } = self.order;
        let speed = self.process.deposition_speed;
        let balance = distortion.then(|| Balance {
            middle: DVec2::ZERO,
            fading: BALANCE.0 * speed,
            detour: BALANCE.1 * self.travel.speed / speed,
        });
        OrderSettings { method, seam, alternate, layer, bead_width: self.bead.width, balance }
    }

    /// Settings for welding.
    pub fn weld_settings(&self) -> WeldSettings {
        let (process, ends) = (self.process.clone(), self.start_stop.clone());
        let (travel, motion) = (self.travel.clone(), self.motion);
        let charts = self.layers.charts().cloned().collect();
        let base = self.layers.base.map(|corners| corners.map(DVec3::from_array));
        let weld = WeldSettings { process, ends, travel, motion, arc_end_time: None, standing: 0.0, charts, base };
        let arc_end_time = self.posts.iter().find_map(|post| self.dialects.get(post)?.arc_end_time(&weld));
        WeldSettings { arc_end_time, ..weld }
    }

    /// What the heat model needs.
    ///
    /// # Errors
    /// [`HeatError`] names what the profile lacks.
    pub fn heat_settings(&self) -> Result<HeatSettings, HeatError> {
        let heat = self.heat.ok_or(HeatError("section [heat]"))?;
        let material = self.material.ok_or(HeatError("section [material]"))?;
        let substrate = self.substrate.ok_or(HeatError("section [substrate]"))?;
        self.process.current.ok_or(HeatError("process.current"))?;
        self.process.voltage.ok_or(HeatError("process.voltage"))?;
        Ok(HeatSettings {
            material,
            density: self.wire.density,
            substrate,
            heat,
            interpass: self.interpass,
            bead_area: self.bead().area(),
            bead_width: self.bead.width,
            on_stock: self.layers.bodies.iter().map(|body| body.on_stock).collect(),
            over: None,
        })
    }

    /// The programmer that makes the instructions of layers.
    pub fn programmer(&self) -> Programmer {
        Programmer::of(&self.weld_settings(), &self.program, self.dry_run)
    }

    /// The path of the torch through layers, as programs made with the profile follow it.
    pub fn track<L: Borrow<Layer>>(&self, layers: &[L]) -> Track {
        Track::of(layers, self.programmer(), self.travel.speed)
    }

    /// What a program of a part needs besides its layers. In a dry run the part's name says so at the beginning, since
    /// long names are cut off at the end.
    ///
    /// ```
    /// use beadwright::dialect::{self, reading::Options};
    /// use beadwright::{Along, Layer, Pass, PassKind, Profile, glam::DVec3};
    ///
    /// // A program with a pass of 60 mm, written and read back.
    /// let points = vec![DVec3::new(0.0, 0.0, 1.35), DVec3::new(60.0, 0.0, 1.35)];
    /// let (width, pace) = (Along::Same(5.0), Along::Same(4.0));
    /// let pass = Pass { kind: PassKind::Wall, closed: false, points, width, pace, wait: 0.0 };
    /// let layer = Layer { z: 1.35, height: 1.35, passes: vec![pass], ..Layer::default() };
    /// let files = dialect::write("gcode", &[layer], &Profile::built_in("plasma-304-cnc")?.job("bar"))?;
    /// let program = dialect::read(&files["bar.nc"], &mut |_| None, &Options::default())?;
    /// assert!((program.totals().deposited_length_mm - 60.0).abs() < 1e-6);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn job(&self, part: &str) -> Job<'_> {
        Job {
            part: if self.dry_run { format!("dry_{part}") } else { part.to_owned() },
            profile: self.name.clone(),
            sections: &self.dialects,
            bead: self.bead(),
            layer_height: self.layers.height,
            wire_diameter: self.wire.diameter,
            weld: self.weld_settings(),
            program: &self.program,
            safety: &self.safety,
            weave: self.weave.as_ref(),
            dry_run: self.dry_run,
        }
    }

    /// How programs of this profile are read back: the lines that switch the arc, and what the controller accepts. `file` is
    /// the name of the main file, `post` its dialect.
    pub fn reading_options(&self, file: Option<&str>, post: Option<&str>) -> Options {
        let sections = &self.dialects;
        let inform_cm_per_min = sections.inform.as_ref().is_some_and(|i| i.speed == InformSpeed::CentimetresPerMinute);
        let max_megabytes = match post {
            Some("krl") => sections.krl.as_ref().map(|krl| krl.max_megabytes),
            Some("urscript") => sections.urscript.as_ref().map(|script| script.max_megabytes),
            _ => None,
        };
        let turning = self.program.positioner.clone();
        let turning = turning.or_else(|| self.program.has_table().then(Positioner::table));
        let inform_station = sections.inform.as_ref().zip(turning).and_then(|(inform, positioner)| {
            Some(Station { positioner, pulses: inform.station_pulses?, frame_turns: inform.frame_turns? })
        });
        let (arc, file) = (sections.arc_codes(), file.map(str::to_owned));
        Options { arc, filament_diameter: None, inform_cm_per_min, inform_station, file, max_megabytes }
    }

    /// Why no program should be written with this profile, as sentences.
    pub fn forbidden(&self) -> Vec<String> {
        // A printer's nozzle touches the layer and may glide over it; a torch may not.
        let drags = self.process.ctwd > 0.0 && self.travel.clearance <= 0.0;
        let sentence = || "travel.clearance = 0: the wire would be dragged over fresh beads.".to_owned();
        drags.then(sentence).into_iter().collect()
    }

    /// Values that are possible but do not fit together, as sentences.
    pub fn notes(&self) -> Vec<String> {
        let rise = self.bead().rise(self.stepover());
        let height = self.layers.height;
        let predicted = self.wall_bead().is_ok_and(|wall| wall.is_some());
        let rise_note = (!predicted && (rise / height - 1.0).abs() > MassBalance::TOLERANCE).then(|| {
            let fitting = self.bead().for_rise(self.stepover(), height);
            format!(
                "Beads {:.2} mm high at a stepover of {:.2} mm rise {rise:.2} mm per layer, but layers are {height:.2} mm \
                 high. A bead.height of {:.2} mm or a layers.height of {rise:.2} mm would fit.",
                self.bead.height,
                self.stepover(),
                fitting.height,
            )
        });
        let nothing_around = self.fill.around == Some(Around::Helix) && !self.layers.charts().any(Chart::goes_around);
        let helix =
            nothing_around.then(|| "No layer goes around an axis, so none is a helix (fill.around).".to_owned());
        let ends = self.start_stop.notes(self.fill.min_pass_length);
        self.mass_balance().warning().into_iter().chain(rise_note).chain(helix).chain(ends).collect()
    }
}
