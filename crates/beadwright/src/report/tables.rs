//! The words and tables of the page, as HTML.

use super::escape;
use super::words::hinted;
use crate::bead::Overlap;
use crate::deposit::Figures;
use crate::fill::{ContourOrder, LineEnds, RasterSpacing, StrategyName};
use crate::finding::{Finding, Severity};
use crate::metrics::Metrics;
use crate::model::RepairReport;
use crate::number::hours;
use crate::pass::PassKind;
use crate::plan::{Header, Summary};
use crate::profile::{Body, Profile, RasterTurn};
use glam::DVec2;
use std::collections::BTreeSet;

/// One sentence about the whole plan.
pub(super) fn sentence(header: &Header, summary: &Summary, profile: &Profile) -> String {
    let m = &summary.metrics;
    format!(
        "{} and {} with the {} strategy: {} of bead from {} of {} wire, in {}.{}",
        count(header.extent.layers, "layer", "layers") + &empty(header, m),
        count(m.passes, "pass", "passes"),
        escape(&header.strategy),
        metres(m.deposited_length_mm),
        mass(m.wire_mass_kg),
        escape(&profile.wire.material),
        duration(m.total_time_s),
        escape(&lie(profile))
    )
}

/// How layers lie that are not level; bodies in a row with the same layers are named together.
fn lie(profile: &Profile) -> String {
    let (layers, bodies) = (&profile.layers, &profile.layers.bodies);
    if layers.are_level() {
        return String::new();
    }
    let lies = if bodies.is_empty() {
        layers.chart.in_words()
    } else {
        let same = bodies.chunk_by(|a, b| a.chart.in_words() == b.chart.in_words());
        let named = |group: &[Body]| {
            let names: Vec<&str> = group.iter().map(|body| &*body.name).collect();
            group.first().map(|body| format!("{} ({})", body.chart.in_words(), names.join(", ")))
        };
        same.filter_map(named).collect::<Vec<_>>().join("; ")
    };
    format!(" Layers lie {lies}. Each is shown unrolled, and in its place in 3-D.")
}

/// Hours, minutes and seconds, without hours where there are none.
fn duration(seconds: f64) -> String {
    let text = hours(seconds);
    text.strip_prefix("0 h ").map_or(text.clone(), |rest| rest.strip_prefix('0').unwrap_or(rest).to_owned())
}

/// How many of the layers hold nothing, in brackets.
fn empty(header: &Header, m: &Metrics) -> String {
    match header.extent.layers.saturating_sub(m.layers) {
        0 => String::new(),
        empty => format!(" ({empty} of them empty)"),
    }
}

/// The badge next to the heading.
pub(super) fn state(summary: &Summary, findings: &[Finding]) -> String {
    if !summary.forbidden.is_empty() {
        return "<a class=\"badge bad\" href=\"#warnings\">Do not start</a>".to_owned();
    }
    let serious = findings.iter().filter(|finding| finding.severity == Severity::Serious).count();
    if serious > 0 {
        let found = count(serious, "serious finding", "serious findings");
        return format!("<a class=\"badge bad\" href=\"#warnings\">{found}</a>");
    }
    match remarks(summary, findings).count() {
        0 => "<a class=\"badge good\" href=\"#warnings\">Nothing was lost</a>".to_owned(),
        n => format!("<a class=\"badge warn\" href=\"#warnings\">{}</a>", count(n, "remark", "remarks")),
    }
}

/// Why the program should not be started, with the places; nothing for a plan that can be welded.
pub(super) fn refused(summary: &Summary) -> String {
    let place = |reason: &String| {
        let warning = summary.warnings.summaries().find(|w| w.sentence() == *reason)?;
        Some(Seen { layer: warning.largest.layer, pass: None, place: Some(warning.largest.place) })
    };
    let item = |reason: &String| {
        let link = place(reason).map(link).unwrap_or_default();
        format!("<li><b>Do not start</b> {}{link}</li>", escape(reason))
    };
    let items: String = summary.forbidden.iter().map(item).collect();
    if items.is_empty() { items } else { format!("<ul class=\"warnings refused\">{items}</ul>") }
}

/// The totals of the plan; what the deposit model says with the void, overfill and metal outside of the worst layers, %, and a
/// mark that says whether all layers keep the limits.
pub(super) fn totals(
    header: &Header,
    summary: &Summary,
    profile: &Profile,
    figures: Option<(&Figures, [f64; 3])>,
) -> String {
    let m: &Metrics = &summary.metrics;
    let [starts, time, wire] =
        if profile.prints() { ["Starts", "Time extruding", "Filament"] } else { ["Arc starts", "Arc time", "Wire"] };
    let mut rows = vec![
        ("Layers", header.extent.layers.to_string() + &empty(header, m)),
        ("Passes", m.passes.to_string()),
        (starts, m.arc_starts.to_string()),
        ("Deposited length", metres(m.deposited_length_mm)),
        ("Travel length", metres(m.travel_length_mm)),
        (time, duration(m.arc_time_s)),
        ("Total time", duration(m.total_time_s)),
        (wire, format!("{:.2} m · {}", m.wire_length_m, mass(m.wire_mass_kg))),
    ];
    rows.extend(m.heat_input_j_per_mm.map(|heat| ("Heat input", format!("{heat:.0} J/mm"))));
    rows.push(("Part volume", volume(m.part_volume_mm3)));
    rows.extend(m.milled_part_volume_mm3.map(|part| ("Milled from it", volume(part))));
    rows.push(("Deposited volume", volume(m.deposited_volume_mm3)));
    rows.push(("Covered / slice area", format!("{:.2} %", 100.0 * m.coverage())));
    let mut lines: Vec<String> = rows.iter().map(row).collect();
    if let Some((f, [void, overfill, outside])) = figures {
        let limits = &profile.check;
        let judged = [
            ("Void", f.void_percent(), Some((void, limits.max_void))),
            ("Low", f.low_percent(), None),
            ("Overfill", f.overfill_percent(), Some((overfill, limits.max_overfill))),
            ("Outside", f.outside_percent(), Some((outside, limits.max_outside))),
        ];
        lines.extend(judged.map(|(name, percent, worst)| {
            let mark = worst.map(|(worst, limit)| marked(worst, limit)).unwrap_or_default();
            headed(name, &format!("{mark}{percent:.2} %"))
        }));
        lines.push(row(&("Height", format!("{:.2} mm ± {:.2} mm per layer", f.mean(), f.deviation()))));
    }
    tabled(&lines)
}

/// Whether all layers keep a limit, %, as a mark and in words.
fn marked(worst: f64, limit: f64) -> String {
    let (class, mark) = if worst <= limit { ("kept", "✔") } else { ("broken", "✖") };
    format!("<small class=\"{class}\">{mark} worst layer {worst:.2} %, limit {limit} %</small> ")
}

/// The values of the profile that a welder sets or checks.
pub(super) fn process(header: &Header, profile: &Profile) -> String {
    let Profile { wire, process: p, bead, layers, fill, travel, .. } = profile;
    let mut rows = vec![
        ("Profile", header.profile.clone()),
        (
            if profile.prints() { "Filament" } else { "Wire" },
            format!("{}, ⌀ {} mm, {} g/cm³", wire.material, wire.diameter, wire.density),
        ),
        (if profile.prints() { "Filament feed" } else { "Wire feed speed" }, format!("{} m/min", p.wire_feed_speed)),
        ("Deposition speed", format!("{} mm/s", p.deposition_speed)),
    ];
    rows.extend(p.current.map(|current| ("Current", format!("{current} A"))));
    rows.extend(p.voltage.map(|voltage| ("Voltage", format!("{voltage} V"))));
    rows.extend([
        ("Bead", format!("{} mm wide, {} mm high", bead.width, bead.height)),
        ("Layer height", format!("{} mm", layers.height)),
        ("Stepover", format!("{:.2} mm ({})", profile.stepover(), overlap(fill.overlap))),
        ("Strategy", strategy(&header.strategy, profile)),
    ]);
    if fill.machining_allowance != 0.0 {
        rows.push(("Machining allowance", format!("{} mm", fill.machining_allowance)));
    }
    let welding = [
        ("Shielding gas", format!("{}, {} L/min", p.gas, p.gas_flow)),
        ("Gas before / after the arc", format!("{} s / {} s", p.gas_preflow, p.gas_postflow)),
        ("Wait at arc start / end", format!("{} s / {} s", p.arc_start_delay, p.arc_end_delay)),
        ("Contact tip to work", format!("{} mm", p.ctwd)),
    ];
    rows.extend(welding.into_iter().filter(|_| !profile.prints()));
    rows.push(("Travel", format!("{} mm/s, {} mm above the layer", travel.speed, travel.clearance)));
    table(&rows)
}

fn overlap(overlap: Overlap) -> &'static str {
    match overlap {
        Overlap::Tangent => "tangent overlap",
        Overlap::InclinedFlatTop => "inclined flat top",
        Overlap::Free => "given",
    }
}

/// What a strategy lays, with the values of the profile that it uses.
fn strategy(name: &str, profile: &Profile) -> String {
    let fill = &profile.fill;
    let order = match fill.contour_order {
        ContourOrder::OutsideIn => "outside in",
        ContourOrder::InsideOut => "inside out",
    };
    let perimeters = count(fill.perimeters as usize, "perimeter", "perimeters");
    let laid = match name.parse() {
        Ok(StrategyName::Raster | StrategyName::Zigzag) => scan_lines(profile),
        Ok(StrategyName::Contour) => order.to_owned(),
        Ok(StrategyName::Compound) => format!("{perimeters} {order}, {}", scan_lines(profile)),
        Ok(StrategyName::Hilbert) => format!("{perimeters} {order}, a Hilbert curve inside"),
        Ok(StrategyName::Partition) => {
            format!("{perimeters} {order}, cells with scan lines of their own direction inside")
        }
        Ok(StrategyName::Loop) => "rings that fill the layer evenly, joined into one path".to_owned(),
        Ok(StrategyName::Hybrid) => "contours, and the pockets between them filled along their middle".to_owned(),
        Ok(StrategyName::Spiral) => "contours joined into one path".to_owned(),
        Ok(StrategyName::Fermat) => "connected Fermat spirals".to_owned(),
        Ok(StrategyName::Mat) => "rings from the middle outwards".to_owned(),
        Ok(StrategyName::Wall) => "along the middle of thin walls".to_owned(),
        // A strategy of one's own.
        _ => return name.to_owned(),
    };
    format!("{name}: {laid}")
}

fn scan_lines(profile: &Profile) -> String {
    let fill = &profile.fill;
    let spacing = match fill.raster_spacing {
        RasterSpacing::Even => "evenly spread",
        RasterSpacing::Fitted => "evenly spread between long edges",
        RasterSpacing::Exact => "one stepover apart",
    };
    let angle = match fill.raster_turn {
        RasterTurn::Fixed => format!("at {}°", fill.raster_angle),
        RasterTurn::Alternate => format!("at {}°, turned by 90° on every second layer", fill.raster_angle),
        RasterTurn::Increment => format!("at {}°, turned by {}° per layer", fill.raster_angle, fill.raster_increment),
        RasterTurn::Best => "at the fastest angle for each pair of layers".to_owned(),
    };
    let ends = match fill.line_ends {
        LineEnds::Plain => "",
        LineEnds::Hooked => ", with hooked ends",
    };
    format!("scan lines {angle}, {spacing}{ends}")
}

/// The colours of the kinds of passes that there are.
pub(super) fn kinds(kinds: &BTreeSet<PassKind>) -> String {
    let item = |kind: &PassKind| format!("<span><i class=\"swatch {0}\"></i>{0}</span>", kind.name());
    kinds.iter().map(item).collect()
}

/// What the model consists of.
pub(super) fn model(repair: &RepairReport) -> String {
    if repair.triangles_read == 0 {
        return table(&[("Given by", "its centre-lines".to_owned())]);
    }
    let closed = if repair.open_edges == 0 { "closed" } else { "with holes" };
    table(&[
        ("Triangles", repair.triangles.to_string()),
        ("Surfaces", format!("{}, {closed}", repair.shells)),
        ("Repairs", if repair.is_clean() { "none needed" } else { "see the warnings" }.to_owned()),
    ])
}

/// The names of the files that were written.
pub(super) fn files(files: &[String]) -> String {
    let items = files.iter().map(|name| format!("<li>{}</li>", escape(name))).collect::<Vec<_>>().join("\n");
    format!("<ul class=\"files\" tabindex=\"0\" aria-label=\"Files, a scrollable list\">\n{items}\n</ul>")
}

/// All findings, the worst first, or a line that says there are none. Of those of one kind the first is shown, and the
/// others on request.
pub(super) fn warnings(summary: &Summary, findings: &[Finding]) -> String {
    let all: Vec<&Finding> = remarks(summary, findings).collect();
    let alike = |a: &&Finding, b: &&Finding| (a.severity, a.kind) == (b.severity, b.kind);
    let items: Vec<String> = all.chunk_by(alike).filter_map(|found| found.split_first()).map(alike_ones).collect();
    if items.is_empty() {
        return "<p class=\"good\">Nothing was lost: the model needed no repair, no pass was left out, and the values \
                of the profile fit together.</p>"
            .to_owned();
    }
    format!("<ul class=\"warnings\">\n{}\n</ul>", items.join("\n"))
}

/// Most findings of one kind that the page lists, so that it opens quickly whatever is wrong.
const MOST_LISTED: usize = 500;

/// A finding, and others of its kind.
fn alike_ones((first, rest): (&&Finding, &[&Finding])) -> String {
    let (word, name) = (first.severity.title(), first.kind);
    let class = if first.severity == Severity::Serious { " class=\"serious\"" } else { "" };
    let item = |finding: &&Finding| format!("<li>{}{}</li>", escape(&finding.text), link_of(finding));
    let more: Vec<String> = rest.iter().take(MOST_LISTED).map(item).collect();
    let summary = match rest.len() {
        n if n > MOST_LISTED => format!("And {n} more, of which {MOST_LISTED} are listed"),
        n => format!("And {n} more"),
    };
    let more = match rest.len() {
        0 => String::new(),
        _ => format!("<details><summary>{summary}</summary><ul>\n{}\n</ul></details>", more.join("\n")),
    };
    format!("<li{class}><b title=\"{name}\">{word}</b> {}{}{more}</li>", escape(&first.sentence()), link_of(first))
}

/// A button that shows where a finding is; nothing for one about the whole plan.
fn link_of(finding: &Finding) -> String {
    let place = finding.place.map(|place| place.truncate());
    finding.layer.map(|layer| link(Seen { layer, pass: finding.pass, place })).unwrap_or_default()
}

/// The findings that are not at the head of the page, where those that forbid the program are.
fn remarks<'a>(summary: &'a Summary, findings: &'a [Finding]) -> impl Iterator<Item = &'a Finding> {
    findings.iter().filter(|finding| !summary.forbidden.contains(&finding.sentence()))
}

/// Where something is: a layer, and as far as known a pass of it, from 0, and a place on it, mm.
struct Seen {
    layer: usize,
    pass: Option<usize>,
    place: Option<DVec2>,
}

/// A button that shows where something is.
fn link(Seen { layer, pass, place }: Seen) -> String {
    let at = place.map(|at| format!(" data-x=\"{:.2}\" data-y=\"{:.2}\"", at.x, at.y)).unwrap_or_default();
    let (number, name) = match pass {
        Some(pass) => (format!(" data-pass=\"{pass}\""), format!(", pass {}", pass + 1)),
        None => Default::default(),
    };
    format!("<button data-layer=\"{layer}\"{at}{number}>Show on layer {}{name}</button>", layer + 1)
}

fn table(rows: &[(&str, String)]) -> String {
    tabled(&rows.iter().map(row).collect::<Vec<_>>())
}

fn tabled(rows: &[String]) -> String {
    format!("<table>\n{}\n</table>", rows.join("\n"))
}

fn row((name, value): &(&str, String)) -> String {
    headed(name, &escape(value))
}

/// A row of a name and of what is markup already.
fn headed(name: &str, value: &str) -> String {
    let name: Vec<String> = name.split(", ").map(hinted).collect();
    format!("<tr><th scope=\"row\">{}</th><td>{value}</td></tr>", name.join(", "))
}

fn count(n: usize, one: &str, many: &str) -> String {
    format!("{n} {}", if n == 1 { one } else { many })
}

fn metres(mm: f64) -> String {
    format!("{:.2} m", mm / 1000.0)
}

fn mass(kg: f64) -> String {
    if kg < 0.1 { format!("{:.1} g", kg * 1000.0) } else { format!("{kg:.3} kg") }
}

fn volume(mm3: f64) -> String {
    format!("{:.2} cm³", mm3 / 1000.0)
}
