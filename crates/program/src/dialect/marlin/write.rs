//! Writes G-code for printers (Marlin, Klipper): E gives the filament, in mm, extruded in every move.
//!
//! Comments name layers, kinds of pass and widths as G-code viewers expect them. Filament is retracted before long
//! travels.

use super::section::Marlin;
use crate::dialect::DialectError;
use crate::dialect::gcode::write::push_centre;
use crate::dialect::writing::{Chunk, Job, Values, Writer, ascii};
use crate::number::{fixed, push_fixed};
use crate::program::{Circle, Instruction, LayerProgram};
use bead_plan::bead::wire_area;
use bead_plan::layer::Extent;
use bead_plan::pass::PassKind;
use glam::DVec3;

/// Most characters of a comment: lines stay under Marlin's 96.
const MAX_COMMENT: usize = 80;

/// Decimals of E: a hundredth of a micrometre, so that small moves keep their share.
const E_DECIMALS: usize = 5;

/// Writes printers' G-code.
pub(super) struct MarlinGcode {
    file: String,
    comment: String,
    marlin: Marlin,
    values: Values,
    width: f64,
    height: f64,
    /// Filament per second of deposition, mm/s: supplies the metal of the bead at its nominal speed.
    filament_speed: f64,
    /// Fraction of `filament_speed` that is used from here on.
    filament_ratio: f64,
    /// Whether moves lay metal; false in a dry run.
    lays: bool,
    travel_speed: f64,
    at: Option<DVec3>,
    /// Filament since the last G92, mm; the sum of the written values.
    extruded: f64,
    retracted: bool,
    /// Feed last written, mm/s.
    feed: f64,
    kind: Option<PassKind>,
    /// The shift of the part to the middle of the bed, mm.
    offset: DVec3,
    failure: Option<DialectError>,
}

impl MarlinGcode {
    /// Begins the program of a part.
    pub(super) fn new(job: &Job<'_>, mut marlin: Marlin) -> Self {
        if job.dry_run {
            marlin.retract_length = 0.0;
        }
        let metal = job.bead.area() * job.weld.process.deposition_speed;
        Self {
            file: format!("{}.{}", job.part, marlin.extension),
            comment: job.comment(),
            values: Values::new(&ascii(&job.part), job),
            marlin,
            width: job.bead.width,
            height: job.layer_height,
            filament_speed: metal / wire_area(job.wire_diameter) / job.weld.process.efficiency,
            filament_ratio: 1.0,
            lays: false,
            travel_speed: job.weld.travel.speed,
            at: None,
            extruded: 0.0,
            retracted: false,
            feed: 0.0,
            kind: None,
            offset: DVec3::ZERO,
            failure: None,
        }
    }

    fn comment(text: &mut String, comment: &str) {
        text.push_str(&format!(";{}\n", &comment[..comment.len().min(MAX_COMMENT)]));
    }

    fn lines(&self, text: &mut String, template: &[String]) {
        for line in self.values.expand(template) {
            text.push_str(&line);
            text.push('\n');
        }
    }

    /// A straight move; axes that do not move are omitted.
    fn go(&mut self, text: &mut String, word: &str, to: DVec3, filament: Option<f64>, speed: f64) {
        self.motion(text, word, to, None, filament, speed);
    }

    fn weld(&mut self, text: &mut String, to: DVec3, circle: Option<Circle>, speed: f64) {
        let straight = self.at.map_or(0.0, |at| at.distance(to));
        let (word, length) = circle.map_or(("G1", straight), |circle| (circle.word(), circle.length()));
        let filament = self.filament_speed * self.filament_ratio * length / speed;
        self.motion(text, word, to, circle, self.lays.then_some(filament), speed);
    }

    /// A move; arcs need ARC_SUPPORT in the firmware, or `[gcode_arcs]` in Klipper.
    fn motion(
        &mut self,
        text: &mut String,
        word: &str,
        to: DVec3,
        circle: Option<Circle>,
        filament: Option<f64>,
        speed: f64,
    ) {
        let before = self.at;
        let moved = (0..3).filter(|&axis| before.is_none_or(|at| at[axis] != to[axis]));
        let axes: Vec<usize> = moved.collect();
        if axes.is_empty() {
            return;
        }
        text.push_str(word);
        for axis in axes {
            text.push_str([" X", " Y", " Z"][axis]);
            push_fixed(text, to[axis] + self.offset[axis], 3);
        }
        if let (Some(circle), Some(at)) = (circle, before) {
            push_centre(text, circle.centre - at, 3);
        }
        if let Some(filament) = filament {
            self.push_e(text, filament);
        }
        self.end_line(text, speed);
        self.at = Some(to);
    }

    /// Adds filament and writes E; the rounding error of one move is carried over to the next.
    fn push_e(&mut self, text: &mut String, filament: f64) {
        let step = 10_f64.powi(-(E_DECIMALS as i32));
        let place = |e: f64| (e / step).round() * step;
        let (before, after) = (place(self.extruded), place(self.extruded + filament));
        self.extruded += filament;
        text.push_str(" E");
        push_fixed(text, if self.marlin.relative_extrusion { after - before } else { after }, E_DECIMALS);
    }

    fn end_line(&mut self, text: &mut String, speed: f64) {
        if speed != self.feed {
            self.feed = speed;
            text.push_str(" F");
            push_fixed(text, speed * 60.0, 1);
        }
        text.push('\n');
    }

    /// Retracts the filament, or pushes it back.
    fn retract(&mut self, text: &mut String, back: bool) {
        if self.marlin.retract_length > 0.0 && self.retracted != back {
            self.retracted = back;
            text.push_str("G1");
            self.push_e(text, if back { -self.marlin.retract_length } else { self.marlin.retract_length });
            self.end_line(text, self.marlin.retract_speed);
        }
    }

    fn reset_e(&mut self, text: &mut String) {
        text.push_str("G92 E0\n");
        self.extruded = 0.0;
    }

    fn instruction(&mut self, text: &mut String, instruction: Instruction) {
        match instruction {
            Instruction::Approach { to } | Instruction::Travel { to } | Instruction::Retract { to } => {
                let far = self.at.is_none_or(|at| at.distance(to) >= self.marlin.retract_from);
                if far && self.at.is_some() {
                    self.retract(text, true);
                }
                self.go(text, "G0", to, None, self.travel_speed);
            }
            Instruction::ArcOn { kind, .. } => {
                if self.kind != Some(kind) {
                    self.kind = Some(kind);
                    Self::comment(text, &format!("TYPE:{}", type_name(kind)));
                    Self::comment(text, &format!("WIDTH:{}", self.width));
                }
                self.retract(text, false);
                self.lays = true;
            }
            Instruction::WireFeed { ratio } => self.filament_ratio = ratio,
            Instruction::Weld { to, circle, speed, .. } => self.weld(text, to, circle, speed),
            // Craters are refused before a printer's program begins.
            Instruction::Crater { seconds, .. } | Instruction::Dwell { seconds } => {
                text.push_str(&format!("G4 P{}\n", fixed(seconds * 1000.0, 0)));
            }
            Instruction::ArcOff { .. } => self.lays = false,
            Instruction::PassStart { .. } | Instruction::Turn { .. } | Instruction::Above | Instruction::PassEnd => {}
        }
    }

    fn chunk(&self, text: String) -> Vec<Chunk> {
        vec![Chunk { file: self.file.clone(), text }]
    }
}

/// The name by which G-code viewers know a kind of pass.
fn type_name(kind: PassKind) -> &'static str {
    match kind {
        PassKind::Contour | PassKind::Wall | PassKind::Spot => "External perimeter",
        PassKind::Infill => "Solid infill",
        PassKind::Skeleton => "Gap fill",
    }
}

impl Writer for MarlinGcode {
    fn begin(&mut self, extent: &Extent) -> Vec<Chunk> {
        match self.marlin.bed.map(|bed| bed.offset(extent)) {
            Some(Ok(offset)) => self.offset = offset.extend(0.0),
            Some(Err(failure)) => self.failure = Some(failure),
            None => {}
        }
        let mut text = String::new();
        Self::comment(&mut text, "FLAVOR:Marlin");
        Self::comment(&mut text, &self.comment);
        Self::comment(&mut text, &format!("LAYER_COUNT:{}", extent.layers));
        self.lines(&mut text, &self.marlin.header);
        text.push_str("G21\nG90\n");
        text.push_str(if self.marlin.relative_extrusion { "M83\n" } else { "M82\n" });
        self.reset_e(&mut text);
        self.chunk(text)
    }

    fn layer(&mut self, program: &LayerProgram) -> Vec<Chunk> {
        if program.instructions.is_empty() {
            return Vec::new();
        }
        let mut text = String::with_capacity(program.instructions.len() * 32);
        self.values.set("layer", program.index + 1);
        Self::comment(&mut text, "LAYER_CHANGE");
        Self::comment(&mut text, &format!("LAYER:{}", program.index));
        Self::comment(&mut text, &format!("Z:{:.3}", program.z));
        Self::comment(&mut text, &format!("HEIGHT:{}", self.height));
        self.lines(&mut text, &self.marlin.layer_start);
        // E restarts from 0, as small numbers keep their digits in the printer's 32-bit floats; but not while filament
        // is retracted.
        if !self.marlin.relative_extrusion && !self.retracted {
            self.reset_e(&mut text);
        }
        for &instruction in &program.instructions {
            self.instruction(&mut text, instruction);
        }
        self.chunk(text)
    }

    fn end(&mut self) -> Vec<Chunk> {
        let mut text = String::new();
        self.retract(&mut text, true);
        self.lines(&mut text, &self.marlin.footer);
        self.chunk(text)
    }

    fn failure(&self) -> Option<DialectError> {
        self.failure.clone()
    }
}
