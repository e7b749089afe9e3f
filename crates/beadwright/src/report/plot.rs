//! A line plot as SVG, with shaded bands and single points where wanted.

use super::escape;
use crate::number::fixed;
use crate::palette::{self, CURVES, hex};
use glam::DVec2;

/// One curve.
#[derive(Debug, Clone)]
pub struct Curve {
    /// Name in the legend.
    pub name: String,
    /// Points, x ascending.
    pub points: Vec<DVec2>,
}

/// A plot.
#[derive(Debug, Clone, Default)]
pub struct Plot {
    /// Title.
    pub title: String,
    /// Name of the x axis with its unit.
    pub x: String,
    /// Name of the y axis with its unit.
    pub y: String,
    /// The curves.
    pub curves: Vec<Curve>,
    /// Vertical lines: the value of x and a label.
    pub marks: Vec<(f64, String)>,
    /// Values of y that the curves should not exceed, and a label each.
    pub limits: Vec<(f64, String)>,
    /// Shaded ranges of y: from, to and a label.
    pub bands: Vec<(f64, f64, String)>,
    /// Single points, in the colours of the curves with the same numbers.
    pub dots: Vec<Vec<DVec2>>,
    /// Whether the y axis begins near the data instead of at 0.
    pub floating: bool,
}

const SIZE: DVec2 = DVec2::new(720.0, 400.0);
const LEFT: f64 = 70.0;
const RIGHT: f64 = 20.0;
const TOP: f64 = 44.0;
const BOTTOM: f64 = 56.0;
/// Height of a row of the legend.
const ROW: f64 = 18.0;
/// How lines are dashed: when the colours repeat, the dashes differ.
const DASHES: [&str; 3] = ["none", "9 4", "2 4"];

impl Plot {
    /// The picture.
    pub fn svg(&self) -> String {
        let all = || self.curves.iter().flat_map(|c| c.points.iter().copied());
        let Some(first) = all().next() else { return String::new() };
        let marks = self.marks.iter().map(|(x, _)| DVec2::new(*x, first.y));
        let bands = self.bands.iter().flat_map(|(low, high, _)| [*low, *high]).map(|y| DVec2::new(first.x, y));
        let limits = self.limits.iter().map(|(y, _)| DVec2::new(first.x, *y));
        let dots = self.dots.iter().flatten().copied();
        let Some(bounds) = planar::Bounds::of(all().chain(marks).chain(bands).chain(limits).chain(dots)) else {
            return String::new();
        };
        let low = if self.floating { bounds.min.y } else { bounds.min.y.min(0.0) };
        let (x, y) = (Axis::new(bounds.min.x, bounds.max.x), Axis::new(low, bounds.max.y));
        let legend = self.legend();
        let top = TOP + legend.last().map_or(0.0, |last| last.y - legend[0].y);
        let place = |p: DVec2| {
            let inner = SIZE - DVec2::new(LEFT + RIGHT, top + BOTTOM);
            DVec2::new(LEFT + x.part(p.x) * inner.x, top + (1.0 - y.part(p.y)) * inner.y)
        };
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\" font-family=\"system-ui, sans-serif\" font-size=\"13\" class=\"plot\" role=\"img\" aria-label=\"{}\">\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
            SIZE.x,
            SIZE.y,
            escape(&self.words())
        );
        text(&mut svg, DVec2::new(LEFT, 20.0), "start", &self.title, "font-weight=\"600\"");
        for (low, high, word) in &self.bands {
            let (a, b) = (place(DVec2::new(x.low, *high)), place(DVec2::new(x.high, *low)));
            band(&mut svg, a, b);
            text(
                &mut svg,
                DVec2::new(b.x - 6.0, b.y - 6.0),
                "end",
                word,
                &format!("fill=\"{}\"", hex(palette::good(false))),
            );
        }
        for at in x.ticks() {
            let (a, b) = (place(DVec2::new(at, y.low)), place(DVec2::new(at, y.high)));
            line(&mut svg, a, b, "#e5e7eb", 1.0);
            text(&mut svg, a + DVec2::Y * 18.0, "middle", &tick(at, x.step), "");
        }
        for at in y.ticks() {
            let (a, b) = (place(DVec2::new(x.low, at)), place(DVec2::new(x.high, at)));
            line(&mut svg, a, b, "#e5e7eb", 1.0);
            text(&mut svg, a + DVec2::new(-8.0, 4.0), "end", &tick(at, y.step), "");
        }
        for (at, word) in &self.marks {
            let (a, b) = (place(DVec2::new(*at, y.low)), place(DVec2::new(*at, y.high)));
            line(&mut svg, a, b, "#6b7280", 1.5);
            text(&mut svg, b + DVec2::new(5.0, 12.0), "start", word, "fill=\"#374151\"");
        }
        let bad = hex(palette::bad(false));
        for (at, word) in &self.limits {
            let (a, b) = (place(DVec2::new(x.low, *at)), place(DVec2::new(x.high, *at)));
            line(&mut svg, a, b, &format!("{bad}\" stroke-dasharray=\"6 4"), 1.5);
            text(&mut svg, b + DVec2::new(-6.0, -6.0), "end", word, &format!("fill=\"{bad}\""));
        }
        for (i, curve) in self.curves.iter().enumerate() {
            let points: Vec<String> = curve.points.iter().map(|p| numbers(place(*p))).collect();
            svg += &format!(
                "<polyline fill=\"none\" {} stroke-width=\"2.2\" stroke-linejoin=\"round\" points=\"{}\"/>\n",
                stroke(i),
                points.join(" ")
            );
        }
        for (points, colour) in self.dots.iter().zip(CURVES.iter().cycle()) {
            points.iter().for_each(|p| dot(&mut svg, place(*p), &hex(*colour)));
        }
        let middle = LEFT + (SIZE.x - LEFT - RIGHT) / 2.0;
        text(&mut svg, DVec2::new(middle, SIZE.y - 14.0), "middle", &self.x, "");
        svg += &format!(
            "<text transform=\"translate(16 {}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n",
            SIZE.y / 2.0,
            escape(&self.y)
        );
        for (i, (curve, at)) in self.curves.iter().zip(legend).enumerate() {
            let y = fixed(at.y - 4.0, 1);
            let (from, to) = (fixed(at.x, 1), fixed(at.x + 22.0, 1));
            svg += &format!("<path d=\"M{from} {y}H{to}\" {} stroke-width=\"3\"/>\n", stroke(i));
            text(&mut svg, at + DVec2::X * 28.0, "start", &curve.name, "");
        }
        svg + "</svg>\n"
    }

    /// Where the names of the curves are, row by row.
    fn legend(&self) -> Vec<DVec2> {
        let mut at = DVec2::new(LEFT, 36.0);
        let place = |curve: &Curve| {
            let wide = 46.0 + 7.2 * curve.name.chars().count() as f64;
            if at.x > LEFT && at.x + wide > SIZE.x {
                at = DVec2::new(LEFT, at.y + ROW);
            }
            at.x += wide;
            at - DVec2::X * wide
        };
        self.curves.iter().map(place).collect()
    }

    /// Text for a reader who does not see the plot: the range of every curve.
    fn words(&self) -> String {
        let range = |curve: &Curve| {
            let ys = || curve.points.iter().map(|p| p.y);
            let (low, high) = (ys().fold(f64::MAX, f64::min), ys().fold(f64::MIN, f64::max));
            format!("{} {low:.2} to {high:.2}", curve.name)
        };
        let drawn = self.curves.iter().filter(|curve| !curve.points.is_empty());
        let limits = self.limits.iter().map(|(_, word)| word.clone());
        let ranges: Vec<String> = drawn.map(range).chain(limits).collect();
        format!("{}: {} over {}; {}", self.title, self.y, self.x, ranges.join(", "))
    }
}

/// Colour and dashes of a curve, by its number.
fn stroke(number: usize) -> String {
    let colour = hex(CURVES[number % CURVES.len()]);
    format!("stroke=\"{colour}\" stroke-dasharray=\"{}\"", DASHES[number / CURVES.len() % DASHES.len()])
}

struct Axis {
    low: f64,
    high: f64,
    step: f64,
}

impl Axis {
    /// About six ticks at 1, 2 or 5 times a power of ten.
    fn new(low: f64, high: f64) -> Self {
        let span = (high - low).max(1e-9);
        let power = 10_f64.powf((span / 6.0).log10().floor());
        let step = [1.0, 2.0, 5.0, 10.0].into_iter().map(|f| f * power).find(|s| span / s <= 7.0).unwrap_or(span);
        Self { low: (low / step).floor() * step, high: (high / step).ceil() * step, step }
    }

    fn part(&self, value: f64) -> f64 {
        (value - self.low) / (self.high - self.low).max(1e-12)
    }

    fn ticks(&self) -> impl Iterator<Item = f64> + '_ {
        let count = ((self.high - self.low) / self.step).round() as usize;
        (0..=count).map(|k| self.low + k as f64 * self.step)
    }
}

fn tick(value: f64, step: f64) -> String {
    fixed(value, (-step.log10().floor()).clamp(0.0, 6.0) as usize)
}

fn numbers(p: DVec2) -> String {
    format!("{},{}", fixed(p.x, 1), fixed(p.y, 1))
}

fn line(svg: &mut String, a: DVec2, b: DVec2, colour: &str, width: f64) {
    *svg += &format!(
        "<line x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\" stroke=\"{colour}\" stroke-width=\"{width}\"/>\n",
        fixed(a.x, 1),
        fixed(a.y, 1),
        fixed(b.x, 1),
        fixed(b.y, 1)
    );
}

fn band(svg: &mut String, a: DVec2, b: DVec2) {
    *svg += &format!(
        "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"{}\" fill-opacity=\"0.15\"/>\n",
        fixed(a.x, 1),
        fixed(a.y, 1),
        fixed(b.x - a.x, 1),
        fixed(b.y - a.y, 1),
        hex(palette::good(false))
    );
}

fn dot(svg: &mut String, at: DVec2, colour: &str) {
    *svg += &format!(
        "<circle cx=\"{}\" cy=\"{}\" r=\"3.2\" fill=\"#fff\" stroke=\"{colour}\" stroke-width=\"1.6\"/>\n",
        fixed(at.x, 1),
        fixed(at.y, 1)
    );
}

fn text(svg: &mut String, at: DVec2, anchor: &str, words: &str, more: &str) {
    *svg += &format!(
        "<text x=\"{}\" y=\"{}\" text-anchor=\"{anchor}\" {more}>{}</text>\n",
        fixed(at.x, 1),
        fixed(at.y, 1),
        escape(words)
    );
}
