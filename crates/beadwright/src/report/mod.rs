//! Showing a plan: `report.html`, a page that needs no network, and the [picture](svg) of one layer.
//!
//! | file | what it holds |
//! | --- | --- |
//! | [`encode`] | the layers in compact form |
//! | `tables` | totals, process, files and warnings as HTML |
//! | `lie` | how layers lie in space |
//! | [`rows`] | totals as people read them |
//! | `words` | what the terms of the figures mean |
//! | [`svg`] | one layer as a standalone picture |
//! | [`bent`], [`coloured`] | a body that bends, and surfaces in several colours, for a page |
//! | [`sheet`], [`plot`], [`sketch`] | other pages: height fields side by side, tables, curves, pictures of steps |
//! | `colours` | the palette for styles and scripts |
//! | [`angles`] | plots over the raster angle |
//! | [`bead_window`] | width/height of a bead library over its first input |
//! | `positioner` | the angles of the axes that turn the part |
//! | [`overhang`] | overhanging faces, seen from below |
//! | [`reach`] | joint angles and margins over a program |
//! | [`steps`] | the steps of the hybrid and of the loop as pictures |
//! | `page.html`, `page.css` | the page |
//! | `layers.js`, `layout.js`, `lie.js`, `heat.js`, `ramp.js`, `colour.js` | reading layers, those of the page, where they lie, height fields, ramps of colours, what beads are coloured by |
//! | `picture.js`, `pick.js`, `timeline.js`, `page.js` | a layer from above, the pass pointed out, the build in time, the controls |
//! | `camera.js`, `steer.js`, `strands.js`, `shaders.js`, `scene.js`, `pace.js` | beads in 3-D (WebGL 2): camera and its handling, points, programs, buffers, how much is drawn |
//! | `solid.js`, `twins.js`, `mesh.js`, `bent.js`, `coloured.js` | the part in 3-D on the report; on other pages strategies side by side, and surfaces that bend or have several colours |

pub mod angles;
pub mod bead_window;
pub mod bent;
pub mod coloured;
mod colours;
pub mod encode;
mod lie;
pub mod overhang;
pub mod plot;
mod positioner;
pub mod reach;
pub mod rows;
pub mod sheet;
pub mod sketch;
pub mod steps;
pub mod svg;
mod tables;
pub mod temperature;
mod words;

use crate::deposit::{Figures, Judgement};
use crate::finding::Finding;
use crate::layer::Layer;
use crate::metrics::Metrics;
use crate::model::RepairReport;
use crate::pass::{Pass, PassKind};
use crate::plan::{self, Header, Summary};
use crate::profile::Profile;
use crate::template;
use glam::DVec2;
use serde_json::json;
use std::collections::BTreeSet;

/// Collects the layers of a plan for `report.html`; it keeps them in compact form only.
///
/// ```
/// use beadwright::{Profile, StrategyName, Task, example, model::RepairReport, plan, report::Report};
///
/// let mut profile = Profile::built_in("cmt-al2319-kuka")?;
/// profile.fill.strategy = StrategyName::Zigzag;
/// let cross = example::find("cross").ok_or("no such example")?.mesh();
/// let plan = plan("cross", &cross, &profile, &Task::new())?;
/// let mut report = Report::new(&plan.header, &profile);
/// plan.layers.iter().for_each(|layer| report.layer(layer, None));
/// let page = report.finish(&plan.summary, &RepairReport::default(), &[], &[]);
/// assert!(page.contains("<h1>cross</h1>"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Report {
    header: Header,
    profile: Profile,
    layers: Vec<String>,
    /// How each layer lies in space; none where all are level.
    lies: Vec<serde_json::Value>,
    maps: Vec<String>,
    /// For each layer: temperatures where its passes begin, °C, and the seconds that the torch waits.
    warmth: Vec<(Vec<f64>, f64)>,
    /// For each layer: arc, waits, and the rest of its time, s.
    times: Vec<[f64; 3]>,
    clock: Metrics,
    turns: Option<positioner::Turns>,
    widths: Range,
    speeds: Range,
    kinds: BTreeSet<PassKind>,
    figures: Option<Figures>,
    /// The worst layer's void, overfill and metal outside, % of its area.
    worst: [f64; 3],
    /// The layer in the middle, for plots over the raster angle.
    middle: Layer,
}

impl Report {
    /// A report with no layers yet.
    pub fn new(header: &Header, profile: &Profile) -> Self {
        let positioner = profile.program.positioner.clone();
        Self {
            header: header.clone(),
            profile: profile.clone(),
            layers: Vec::new(),
            lies: Vec::new(),
            maps: Vec::new(),
            warmth: Vec::new(),
            times: Vec::new(),
            clock: Metrics::new(profile),
            turns: positioner.map(|positioner| positioner::Turns::new(positioner, profile.programmer())),
            widths: Range::default(),
            speeds: Range::default(),
            kinds: BTreeSet::new(),
            figures: None,
            worst: [0.0; 3],
            middle: Layer::default(),
        }
    }

    /// Takes the next layer, and what the deposit model says about it.
    pub fn layer(&mut self, layer: &Layer, judgement: Option<&Judgement>) {
        if layer.index == self.header.extent.layers / 2 {
            self.middle = layer.clone();
        }
        self.layers.push(encode::layer(
            &plan::drawn(layer, &self.profile),
            &self.profile.process,
            judgement.map(|j| &j.figures),
        ));
        if !self.profile.layers.are_level() {
            self.lies.push(lie::lie(self.profile.layers.chart_of(layer), layer));
        }
        let waits = layer.passes.iter().map(|pass| pass.wait).sum();
        self.warmth.push((layer.temperatures.iter().map(|t| t.start).collect(), waits));
        self.measure(layer);
        if let Some(judgement) = judgement {
            let figures = &judgement.figures;
            self.figures.get_or_insert_default().add(figures);
            let worse = [figures.void_percent(), figures.overfill_percent(), figures.outside_percent()];
            self.worst = [0, 1, 2].map(|i| f64::max(self.worst[i], worse[i]));
            self.maps.push(judgement.picture.as_ref().map(encode::map).unwrap_or_default());
        }
    }

    /// Adds the layer's time, and what its beads are coloured by.
    fn measure(&mut self, layer: &Layer) {
        let now = |clock: &Metrics| [clock.arc_time_s, clock.dwell_time_s, clock.total_time_s];
        let before = now(&self.clock);
        self.clock.add(layer);
        self.turns.iter_mut().for_each(|turns| turns.layer(layer));
        let after = now(&self.clock);
        let [arc, wait, whole] = [0, 1, 2].map(|i| after[i] - before[i]);
        self.times.push([arc, wait, (whole - arc - wait).max(0.0)]);
        self.kinds.extend(layer.passes.iter().map(|pass| pass.kind));
        let process = self.profile.process.at_layer(layer.index);
        for piece in layer.passes.iter().flat_map(Pass::segments) {
            self.widths.take(piece.width);
            self.speeds.take(process.speed_at(piece.pace));
        }
    }

    /// The page. `files` are the names of the files that were written, `findings` everything to report about the plan
    /// ([`check::all_findings`](crate::check::all_findings)).
    pub fn finish(self, summary: &Summary, repair: &RepairReport, files: &[String], findings: &[Finding]) -> String {
        let (header, profile) = (&self.header, &self.profile);
        let middle = profile.fill_settings(self.middle.index);
        let values = [
            ("title", escape(&header.part)),
            ("css", colours::css() + include_str!("page.css")),
            ("sentence", tables::sentence(header, summary, profile)),
            ("state", tables::state(summary, findings)),
            ("refused", tables::refused(summary)),
            ("kinds", tables::kinds(&self.kinds)),
            ("totals", tables::totals(header, summary, profile, self.figures.as_ref().map(|all| (all, self.worst)))),
            ("process", tables::process(header, profile)),
            ("angles", angles::section(&self.middle, profile.fill.strategy.strategy(), &middle)),
            ("positioner", self.turns.as_ref().map(positioner::Turns::section).unwrap_or_default()),
            ("model", tables::model(repair)),
            ("files", tables::files(files)),
            ("warnings", tables::warnings(summary, findings)),
            ("words", words::list()),
            ("data", self.data()),
            (
                "js",
                [
                    &*colours::js(),
                    include_str!("inflate.js"),
                    include_str!("layers.js"),
                    include_str!("layout.js"),
                    include_str!("lie.js"),
                    include_str!("ramp.js"),
                    include_str!("heat.js"),
                    include_str!("colour.js"),
                    include_str!("picture.js"),
                    include_str!("camera.js"),
                    include_str!("steer.js"),
                    include_str!("strands.js"),
                    include_str!("shaders.js"),
                    include_str!("scene.js"),
                    include_str!("pace.js"),
                    include_str!("solid.js"),
                    include_str!("pick.js"),
                    include_str!("timeline.js"),
                    include_str!("page.js"),
                ]
                .concat(),
            ),
        ];
        template::expand(include_str!("page.html"), &values)
    }

    /// What the scripts need, as JSON that is safe in a `script` element.
    fn data(&self) -> String {
        let bead = json!({ "width": self.profile.bead.width }).to_string().replace('<', "\\u003c");
        // Base64 needs no escaping.
        let list = |texts: &[String]| texts.iter().map(|text| format!("\n\"{text}\"")).collect::<Vec<_>>().join(",");
        let (layers, maps) = (list(&self.layers), list(&self.maps));
        let times: Vec<[f64; 3]> = self.times.iter().map(|parts| parts.map(|s| (s * 10.0).round() / 10.0)).collect();
        let (times, warmth) = (json!(times), self.warmth());
        let lies = json!(self.lies);
        // Whether each layer lies on the one before it as the page shows them.
        let stacked = self.profile.layers.are_level() && self.profile.layers.bodies.len() < 2;
        let surfaces: Vec<_> = self.profile.layers.charts().map(lie::surface).collect();
        let surfaces = json!(surfaces);
        let ranges = json!({ "width": self.widths.ends(), "speed": self.speeds.ends() });
        let check = &self.profile.check;
        let mut limits = json!({ "voids": check.max_void, "overfill": check.max_overfill });
        if let Some(interpass) = &self.profile.interpass {
            limits["hottest"] = interpass.max_temperature.into();
        }
        format!(
            "{{\"bead\":{bead},\"stacked\":{stacked},\"ranges\":{ranges},\"limits\":{limits},\"times\":{times},\"warmth\":{warmth},\"lies\":{lies},\"surfaces\":{surfaces},\"layers\":[{layers}],\"maps\":[{maps}]}}"
        )
    }

    /// Starts in whole °C and waits in seconds, layer by layer; nothing where no temperature was computed.
    fn warmth(&self) -> serde_json::Value {
        if self.warmth.iter().all(|(starts, _)| starts.is_empty()) {
            return json!([]);
        }
        let layer = |(starts, wait): &(Vec<f64>, f64)| {
            let starts: Vec<i64> = starts.iter().map(|celsius| celsius.round() as i64).collect();
            json!({ "starts": starts, "wait": wait.round() as i64 })
        };
        self.warmth.iter().map(layer).collect()
    }
}

/// The least and the greatest of some values.
#[derive(Debug, Clone, Copy, Default)]
struct Range(Option<[f64; 2]>);

impl Range {
    fn take(&mut self, value: f64) {
        let [least, greatest] = self.0.unwrap_or([value; 2]);
        self.0 = Some([least.min(value), greatest.max(value)]);
    }

    /// Both, in thousandths; zeros where there was no value.
    fn ends(self) -> [f64; 2] {
        self.0.unwrap_or_default().map(|value| (value * 1e3).round() / 1e3)
    }
}

/// Moves without arc within a layer: from the end of a pass to the start of the next.
fn travels(layer: &Layer) -> impl Iterator<Item = (DVec2, DVec2)> + '_ {
    let passes: Vec<&Pass> = layer.passes.iter().filter(|pass| !pass.points.is_empty()).collect();
    let ends: Vec<_> = passes.windows(2).filter_map(|w| Some((w[0].end()?, w[1].start()?))).collect();
    ends.into_iter().map(|(from, to)| (from.truncate(), to.truncate()))
}

/// Text for HTML and XML, in elements and in attributes.
pub(crate) fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\'' => escaped.push_str("&#39;"),
            // XML does not allow control characters.
            c if c.is_control() && !c.is_whitespace() => escaped.push('\u{fffd}'),
            c => escaped.push(c),
        }
    }
    escaped
}
