//! Inline forms of KUKA ArcTech Basic 3.x: ARCON and ARCOFF as the pendant folds them, and their data.
//!
//! A form moves to its point and switches there: ARCON moves to the start and ignites, ARCOFF moves to the end and fills the
//! crater. What lies between are plain motions with their own `$VEL.CP`: an ARCSWI is for other channels of the power
//! source, takes about 1.5 kB, and cannot be run every few tenths of a millimetre. ARCOFF moves at the speed of the seam
//! that ARCON has set: that of the last piece. Every module declares the data of its forms in its own `.dat`: a point (`XPn`, `FPn`, `WPn`) for each form,
//! and one `WDATn` for each distinct set of parameters. Not supported: switching without delay, weaving, and the
//! package ArcTech Advanced.

use crate::number::{fixed, push_fixed};
use super::arctech_section::ArcTech;
use super::section::{Krl, KrlMotion};
use crate::dialect::{DialectError, Job};
use crate::program::Weave;
use crate::process::{Follow, Process};
use std::fmt::Write as _;

/// What a form does at its point.
#[derive(Clone, Copy, PartialEq)]
enum Form {
    On,
    Off,
}

impl Form {
    fn word(self) -> &'static str {
        match self {
            Self::On => "ARCON",
            Self::Off => "ARCOFF",
        }
    }
}

/// A motion of a form: poses as KRL aggregates.
#[derive(Clone, Copy)]
pub(super) struct Target<'a> {
    /// A point of the circle before its end.
    pub(super) via: Option<&'a str>,
    /// Where it ends.
    pub(super) to: &'a str,
}

/// A form with the numbers of its points and its data set.
struct Placed {
    form: Form,
    via: Option<usize>,
    point: usize,
    set: usize,
}

impl Placed {
    fn motion(&self) -> &'static str {
        if self.via.is_some() { "CIRC" } else { "LIN" }
    }
}

/// The forms of one module.
pub(super) struct Forms {
    arctech: ArcTech,
    version: u64,
    tool: u32,
    base: u32,
    blend: f64,
    start_time: f64,
    preflow: f64,
    postflow: f64,
    /// Speed without arc, m/s.
    travel: String,
    /// Contents of the weave's data.
    weave: String,
    /// Contents of the weld data sets so far, in order: set n is at index n − 1.
    sets: Vec<String>,
    points: usize,
    data: String,
}

/// Refuses what the forms cannot do: the end of a pass has its own data in them, and the wire feed comes from the
/// weld's parameter set.
pub(super) fn check(krl: &Krl, job: &Job<'_>) -> Result<(), DialectError> {
    let cannot = |what, remedy| Err(DialectError::Cannot { dialect: "krl", what, remedy });
    if job.weld.process.follow == Follow::WireFeed {
        return cannot("process.follow = \"wire-feed\" with arc = \"arctech\"", "Take process.follow = \"speed\".");
    }
    if !job.weld.process.layers.is_empty() {
        return cannot("[[process.layers]] with arc = \"arctech\"", "Take arc = \"outputs\", or the same speed for all layers.");
    }
    if krl.motion == KrlMotion::Slin {
        return cannot("krl.motion = \"slin\" with arc = \"arctech\"", "Take motion = \"lin\": the forms move by LIN and CIRC.");
    }
    if job.weld.ends.crater_fill_time > 0.0 {
        return cannot("a start_stop.crater_fill_time with arc = \"arctech\"", "Take krl.arctech.crater.time instead.");
    }
    if job.weld.ends.wire_retract > 0.0 {
        let remedy = "Take krl.arctech.crater.burnback_time instead.";
        return cannot("a start_stop.wire_retract with arc = \"arctech\"", remedy);
    }
    Ok(())
}

impl Forms {
    /// Forms of a module; `travel_speed` in mm/s.
    pub(super) fn new(arctech: &ArcTech, krl: &Krl, process: &Process, weave: Option<&Weave>, travel_speed: f64) -> Self {
        Self {
            version: arctech.number().unwrap_or_default(),
            arctech: arctech.clone(),
            tool: krl.tool,
            base: krl.base,
            blend: krl.blend,
            start_time: process.arc_start_delay,
            preflow: process.gas_preflow,
            postflow: process.gas_postflow,
            travel: fixed(travel_speed / 1000.0, 6),
            weave: pattern(weave),
            sets: Vec::new(),
            points: 0,
            data: String::new(),
        }
    }

    /// Moves to the start of a pass and lights the arc; the seam ends at `speed`, mm/s.
    pub(super) fn on(&mut self, text: &mut String, to: &str, speed: f64) {
        let ArcTech { strike, .. } = &self.arctech;
        let set = format!(
            "Strike {{JobModeId[] \"{}\",ParamSetId[] \"{}\",StartTime {},PreFlowTime {},{},PurgeTime {}}},{}",
            strike.mode,
            strike.set,
            fixed(self.start_time, 5),
            fixed(self.preflow, 5),
            channels(&strike.channels),
            fixed(strike.purge_time, 5),
            self.weld_set(speed)
        );
        self.form(text, Form::On, Target { via: None, to }, set);
    }

    /// Moves to the end of a pass and ends the arc.
    pub(super) fn off(&mut self, text: &mut String, target: Target<'_>) {
        let ArcTech { crater, .. } = &self.arctech;
        let set = format!(
            "Crater {{JobModeId[] \"{}\",ParamSetId[] \"{}\",CraterTime {},PostflowTime {},{},BurnBackTime {}}}",
            crater.mode,
            crater.set,
            fixed(crater.time, 5),
            fixed(self.postflow, 5),
            channels(&crater.channels),
            fixed(crater.burnback_time, 5)
        );
        self.form(text, Form::Off, target, set);
    }

    fn weld_set(&self, speed: f64) -> String {
        let ArcTech { weld, .. } = &self.arctech;
        format!(
            "Weld {{JobModeId[] \"{}\",ParamSetId[] \"{}\",Velocity {},{}}},Weave {{{}}}",
            weld.mode,
            weld.set,
            fixed(speed / 1000.0, 6),
            channels(&weld.channels),
            self.weave
        )
    }

    /// Number of the data set with these contents, which is declared if it is new.
    fn set_number(&mut self, contents: String) -> usize {
        if let Some(known) = self.sets.iter().position(|s| *s == contents) {
            return known + 1;
        }
        let number = self.sets.len() + 1;
        let _ = write!(self.data, "DECL stArcDat_T WDAT{number}={{WdatId[] \"WDAT{number}\",{contents}}}\r\n");
        self.sets.push(contents);
        number
    }

    /// Declares a point of a form and returns its number.
    fn point(&mut self, pose: &str) -> usize {
        self.points += 1;
        let n = self.points;
        let _ = write!(
            self.data,
            "DECL E6POS XP{n}={pose}\r\nDECL stArcDat_T WP{n}={{WdatId[] \"WP{n}\",Info {{Version {}}},Strike {{SeamName[] \" \",PartName[] \" \",\
             SeamNumber 0,PartNumber 0,DesiredLength 0.0,LengthTolNeg 0.0,LengthTolPos 0.0,LengthCtrlActive FALSE}}}}\r\n",
            self.version
        );
        n
    }

    /// Declares the end point of a form, with its frames.
    fn end_point(&mut self, pose: &str) -> usize {
        let (n, tool, base) = (self.point(pose), self.tool, self.base);
        let _ =
            write!(self.data, "DECL FDAT FP{n}={{TOOL_NO {tool},BASE_NO {base},IPO_FRAME #BASE,POINT2[] \" \"}}\r\n");
        n
    }

    /// One form: the fold's title, what the pendant reads, and the statements that the interpreter runs.
    fn form(&mut self, text: &mut String, form: Form, target: Target<'_>, set: String) {
        let via = target.via.map(|pose| self.point(pose));
        let (point, set) = (self.end_point(target.to), self.set_number(set));
        let placed = Placed { form, via, point, set };
        self.title(text, &placed);
        let speed = if form == Form::On { &*self.travel } else { "gArcBasVelDefinition" };
        let _ = write!(
            text,
            "$BWDSTART = FALSE\r\nLDAT_ACT = LCPDAT1\r\nFDAT_ACT = FP{point}\r\nBAS(#CP_PARAMS, {speed})\r\nSET_CD_PARAMS (0)\r\n"
        );
        let of = format!("WDAT{set}, WP{point}{}", via.map_or(String::new(), |via| format!(", WP{via}")));
        triggers(text, form, set, &of);
        let name = match form {
            Form::On => "ArcOn",
            Form::Off => "ArcOff",
        };
        let (motion, to) = (placed.motion(), via.map_or(format!("XP{point}"), |via| format!("XP{via}, XP{point}")));
        let _ = write!(
            text,
            "ArcMainNG(#{name}BeforeMoveStd, {of})\r\n{motion} {to}\r\nArcMainNG(#{name}AfterMoveStd, {of})\r\n;ENDFOLD\r\n"
        );
    }

    fn title(&self, text: &mut String, placed: &Placed) {
        let Placed { form, via, point, set } = *placed;
        let (word, motion) = (form.word(), placed.motion());
        let help = via.map_or(String::new(), |via| format!("P{via} "));
        let parameter = via.map_or(String::new(), |via| format!(" Kuka.HelpPointName=P{via};"));
        let provider = format!("{}{}", word.to_lowercase(), motion.to_lowercase());
        // The way to the start has a speed of its own; the seam has that of its data.
        let speed = if form == Form::On { format!("Vel={} m/s ", self.travel.trim_end_matches('0').trim_end_matches('.')) } else { String::new() };
        let _ = write!(
            text,
            ";FOLD {word} WDAT{set} {motion} {help}P{point} {speed}CPDAT1 Tool[{}] Base[{}] ;%{{PE}}\r\n;FOLD Parameters ;%{{h}}\r\n\
             ;Params IlfProvider=kukaroboter.arctech.{provider}; Kuka.IsGlobalPoint=False; Kuka.PointName=P{point};{parameter} \
             Kuka.BlendingEnabled=False; Kuka.MoveDataName=CPDAT1; Kuka.VelocityPath={}; Kuka.CurrentCDSetIndex=0; \
             Kuka.MovementParameterFieldEnabled=True; ArcTech.WdatVarName=WDAT{set}; ArcTech.Basic={}\r\n;ENDFOLD\r\n",
            self.tool, self.base, self.travel, self.arctech.version
        );
    }

    /// The declarations for the module's `.dat`; empty if no form was written.
    pub(super) fn declarations(&self) -> String {
        let mut text = String::new();
        if self.points > 0 {
            let (speed, blend) = (&self.travel, fixed(self.blend, 3));
            let _ = write!(
                text,
                "DECL LDAT LCPDAT1={{VEL {speed},ACC 100.000,APO_DIST {blend},APO_FAC 50.0000,AXIS_VEL 100.000,\
                 AXIS_ACC 100.000,ORI_TYP #VAR,CIRC_TYP #BASE,JERK_FAC 50.0000,GEAR_JERK 100.000,EXAX_IGN 0}}\r\n"
            );
            text.push_str(&self.data);
        }
        text
    }
}

/// Writes the triggers that act before or at the end of the next motion.
fn triggers(text: &mut String, form: Form, set: usize, of: &str) {
    let mut trigger = |when: &str, delay: &str, what: &str| {
        let _ = write!(text, "TRIGGER WHEN {when} DELAY = {delay} DO ArcMainNG(#{what}, {of}) PRIO = -1\r\n");
    };
    let path = |what: &str| format!("PATH = ArcGetPath(#{what}, WDAT{set})");
    let delay = |what: &str| format!("ArcGetDelay(#{what}, WDAT{set})");
    match form {
        Form::On => {
            trigger("DISTANCE = 1", &delay("PreDefinition"), "PreDefinition");
            trigger(&path("OnTheFlyArcOn"), &delay("GasPreflow"), "GasPreflow");
            trigger(&path("OnTheFlyArcOn"), "0", "ArcOnMoveStd");
        }
        Form::Off => {
            trigger(&path("ArcOffBefore"), "0", "ArcOffBeforeOffStd");
            trigger(&path("OnTheFlyArcOff"), "0", "ArcOffMoveStd");
        }
    }
}

/// How the torch swings; the lengths of no pattern are those of the package.
fn pattern(weave: Option<&Weave>) -> String {
    let (name, length, amplitude, dwell) = match weave {
        Some(weave) => ("Triangle", weave.length, weave.amplitude, weave.dwell),
        None => ("None", 4.0, 2.0, 0.0),
    };
    let dwell = fixed(dwell, if weave.is_some() { 3 } else { 1 });
    let [length, amplitude] = [length, amplitude].map(|v| fixed(v, 5));
    format!(
        "Pattern #{name},Length {length},Amplitude {amplitude},Angle 0.0,LeftSideDelay {dwell},RightSideDelay {dwell}"
    )
}

fn channels(values: &[f64; 8]) -> String {
    let mut text = String::new();
    for (i, &value) in values.iter().enumerate() {
        let _ = write!(text, "{}Channel{} ", if i > 0 { "," } else { "" }, i + 1);
        push_fixed(&mut text, value, 5);
    }
    text
}
