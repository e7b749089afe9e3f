//! Inline forms of KUKA ArcTech Basic 3.x: ARCON and ARCOFF as the pendant folds them, and their data.
//!
//! A form moves to its point and switches there: ARCON moves to the start and ignites, ARCOFF moves to the end and
//! fills the crater. Between them are plain motions with their own `$VEL.CP`. Where the wire feed changes, and a
//! channel holds it, the motion before the change is an ARCSWI, which takes about 1.5 kB. ARCOFF moves at the seam
//! speed set by the preceding form: that of the last piece. Every module declares the data of its forms in its own
//! `.dat`: a point (`XPn`, `FPn`, `WPn`) for each form, and one `WDATn` for each distinct set of parameters. Not
//! supported: switching without delay, and the package ArcTech Advanced.

use super::arctech_section::ArcTech;
use super::section::{Krl, KrlMotion};
use crate::dialect::{DialectError, Job};
use crate::number::{fixed, push_fixed};
use crate::program::Weave;
use bead_plan::process::{Follow, Process};
use std::fmt::Write as _;

/// What a form does at its point.
#[derive(Clone, Copy, PartialEq)]
enum Form {
    On,
    Switch,
    Off,
}

impl Form {
    fn word(self) -> &'static str {
        match self {
            Self::On => "ARCON",
            Self::Switch => "ARCSWI",
            Self::Off => "ARCOFF",
        }
    }

    /// The package's name for the form.
    fn name(self) -> &'static str {
        match self {
            Self::On => "ArcOn",
            Self::Switch => "ArcSwi",
            Self::Off => "ArcOff",
        }
    }
}

/// Weld parameters set by a form.
#[derive(Clone, Copy)]
pub(super) struct Seam {
    /// Speed, mm/s.
    pub(super) speed: f64,
    /// The wire feed as a multiple of the nominal one.
    pub(super) feed: f64,
    /// Job of the power source.
    pub(super) job: u32,
}

/// How a crater is filled.
#[derive(Clone, Copy)]
pub(super) struct Filling {
    /// Filling time, s.
    pub(super) seconds: f64,
    /// The wire feed as a multiple of the nominal one; `None` if it stays as in the section.
    pub(super) feed: Option<f64>,
}

/// A motion of a form: poses as KRL aggregates.
#[derive(Clone, Copy)]
pub(super) struct Target<'a> {
    /// The auxiliary point of a circular motion.
    pub(super) via: Option<&'a str>,
    /// The end point.
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
    /// Nominal wire feed, m/min.
    wire_feed: f64,
    /// Job of the power source set in the section's channels.
    job: u32,
    /// Travel speed, m/s.
    travel: String,
    /// Contents of the weave data.
    weave: String,
    /// Contents of the weld data sets, in order: set n is at index n − 1.
    sets: Vec<String>,
    points: usize,
    data: String,
}

/// Refuses jobs that the forms cannot carry out.
pub(super) fn check(krl: &Krl, arctech: &ArcTech, job: &Job<'_>) -> Result<(), DialectError> {
    let cannot = |what, remedy| Err(DialectError::Cannot { dialect: "krl", what, remedy });
    if krl.motion == KrlMotion::Slin {
        return cannot(
            "krl.motion = \"slin\" with arc = \"arctech\"",
            "Use motion = \"lin\": the forms move by LIN and CIRC.",
        );
    }
    if job.weld.ends.wire_retract > 0.0 {
        let remedy = "Use krl.arctech.crater.burnback_time instead.";
        return cannot("a start_stop.wire_retract with arc = \"arctech\"", remedy);
    }
    if job.program.layer_offsets {
        let remedy = "The forms set the base again by its number: remove layer_offsets, or use arc = \"outputs\".";
        return cannot("program.layer_offsets with arc = \"arctech\"", remedy);
    }
    let lacks = |key: &str, why: &str, remedy: &str| {
        let [key, why, remedy] = [key, why, remedy].map(str::to_owned);
        Err(DialectError::NoKey { profile: job.profile.clone(), key, why, remedy })
    };
    let process = &job.weld.process;
    // A job of the power source defines its own wire feed.
    let by_job = process.layers.iter().all(|row| row.job.is_some()) && arctech.job_channel.is_some();
    let why = match process.follow {
        Follow::WireFeed => Some("process.follow = \"wire-feed\" with arc = \"arctech\""),
        Follow::Speed if !process.layers.is_empty() && !by_job => Some("[[process.layers]] with arc = \"arctech\""),
        Follow::Speed => job.weld.ends.crater_is_weaker().then_some("a start_stop.crater_power below 1"),
    };
    if let Some(why) = why.filter(|_| arctech.wire_feed_channel.is_none()) {
        let remedy = "It is the channel of the WorkVisual project that holds the wire feed in m/min.";
        return lacks("krl.arctech.wire_feed_channel", why, remedy);
    }
    let jobs = process.layers.iter().any(|row| row.job.is_some_and(|own| own != process.job));
    if jobs && arctech.job_channel.is_none() {
        let remedy = "It is the channel of the WorkVisual project that holds the number of the job.";
        return lacks("krl.arctech.job_channel", "a job in [[process.layers]]", remedy);
    }
    Ok(())
}

impl Forms {
    /// Forms of a module; `travel_speed` in mm/s.
    pub(super) fn new(
        arctech: &ArcTech,
        krl: &Krl,
        process: &Process,
        weave: Option<&Weave>,
        travel_speed: f64,
    ) -> Self {
        Self {
            version: arctech.number().unwrap_or_default(),
            arctech: arctech.clone(),
            tool: krl.tool,
            base: krl.base,
            blend: krl.blend,
            start_time: process.arc_start_delay,
            preflow: process.gas_preflow,
            postflow: process.gas_postflow,
            wire_feed: process.wire_feed_speed,
            job: process.job,
            travel: fixed(travel_speed / 1000.0, 6),
            weave: pattern(weave),
            sets: Vec::new(),
            points: 0,
            data: String::new(),
        }
    }

    /// Moves to the start of a pass and strikes the arc.
    pub(super) fn on(&mut self, text: &mut String, to: &str, seam: Seam) {
        let ArcTech { strike, .. } = &self.arctech;
        let set = format!(
            "Strike {{JobModeId[] \"{}\",ParamSetId[] \"{}\",StartTime {},PreFlowTime {},{},PurgeTime {}}},{}",
            strike.mode,
            strike.set,
            fixed(self.start_time, 5),
            fixed(self.preflow, 5),
            self.channels(&strike.channels, seam.job, None),
            fixed(strike.purge_time, 5),
            self.weld_set(seam)
        );
        self.form(text, Form::On, Target { via: None, to }, set);
    }

    /// Moves on along the pass and switches at the end of the move to the parameters that follow.
    pub(super) fn switch(&mut self, text: &mut String, target: Target<'_>, seam: Seam) {
        let set = self.weld_set(seam);
        self.form(text, Form::Switch, target, set);
    }

    /// Moves to the end of a pass and ends the arc.
    pub(super) fn off(&mut self, text: &mut String, target: Target<'_>, filling: Option<Filling>, job: u32) {
        let ArcTech { crater, .. } = &self.arctech;
        let set = format!(
            "Crater {{JobModeId[] \"{}\",ParamSetId[] \"{}\",CraterTime {},PostflowTime {},{},BurnBackTime {}}}",
            crater.mode,
            crater.set,
            fixed(filling.map_or(crater.time, |filling| filling.seconds), 5),
            fixed(self.postflow, 5),
            self.channels(&crater.channels, job, filling.and_then(|filling| filling.feed)),
            fixed(crater.burnback_time, 5)
        );
        self.form(text, Form::Off, target, set);
    }

    fn weld_set(&self, seam: Seam) -> String {
        let ArcTech { weld, .. } = &self.arctech;
        format!(
            "Weld {{JobModeId[] \"{}\",ParamSetId[] \"{}\",Velocity {},{}}},Weave {{{}}}",
            weld.mode,
            weld.set,
            fixed(seam.speed / 1000.0, 6),
            self.channels(&weld.channels, seam.job, Some(seam.feed)),
            self.weave
        )
    }

    /// The section's channels, with the wire feed and the job in the channels that the profile names for them.
    fn channels(&self, values: &[f64; 8], job: u32, feed: Option<f64>) -> String {
        let mut values = *values;
        let mut put = |channel: Option<u32>, value: f64| {
            let place = channel.and_then(|channel| values.get_mut(channel as usize - 1));
            place.into_iter().for_each(|place| *place = value);
        };
        feed.into_iter().for_each(|feed| put(self.arctech.wire_feed_channel, feed * self.wire_feed));
        if job != self.job {
            put(self.arctech.job_channel, job.into());
        }
        channels(&values)
    }

    /// Number of the data set with these contents; a new one is declared.
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
        let name = form.name();
        let (motion, to) = (placed.motion(), via.map_or(format!("XP{point}"), |via| format!("XP{via}, XP{point}")));
        let blend = if form == Form::Switch { " C_DIS" } else { "" };
        let _ = write!(
            text,
            "ArcMainNG(#{name}BeforeMoveStd, {of})\r\n{motion} {to}{blend}\r\nArcMainNG(#{name}AfterMoveStd, {of})\r\n;ENDFOLD\r\n"
        );
    }

    fn title(&self, text: &mut String, placed: &Placed) {
        let Placed { form, via, point, set } = *placed;
        let (word, motion) = (form.word(), placed.motion());
        let help = via.map_or(String::new(), |via| format!("P{via} "));
        let parameter = via.map_or(String::new(), |via| format!(" Kuka.HelpPointName=P{via};"));
        let provider = format!("{}{}", word.to_lowercase(), motion.to_lowercase());
        // The move to the start has its own speed; the seam has the speed in its data.
        let speed = if form == Form::On {
            format!("Vel={} m/s ", self.travel.trim_end_matches('0').trim_end_matches('.'))
        } else {
            String::new()
        };
        let (blend, blends) = if form == Form::Switch { ("CONT ", "True") } else { ("", "False") };
        let _ = write!(
            text,
            ";FOLD {word} WDAT{set} {motion} {help}P{point} {blend}{speed}CPDAT1 Tool[{}] Base[{}] ;%{{PE}}\r\n;FOLD Parameters ;%{{h}}\r\n\
             ;Params IlfProvider=kukaroboter.arctech.{provider}; Kuka.IsGlobalPoint=False; Kuka.PointName=P{point};{parameter} \
             Kuka.BlendingEnabled={blends}; Kuka.MoveDataName=CPDAT1; Kuka.VelocityPath={}; Kuka.CurrentCDSetIndex=0; \
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
        Form::Switch => trigger("DISTANCE = 1", "0", "ArcSwiMoveStd"),
        Form::Off => {
            trigger(&path("ArcOffBefore"), "0", "ArcOffBeforeOffStd");
            trigger(&path("OnTheFlyArcOff"), "0", "ArcOffMoveStd");
        }
    }
}

/// Weave parameters; without a weave, lengths are the package's defaults.
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
