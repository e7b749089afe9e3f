//! `heat.html`: how warm the metal is before each pass.

use super::escape;
use super::plot::{Curve, Plot};
use super::sheet::{Row, Sheet};
use crate::heat::{History, Interpass, LayerHeat};
use crate::layer::Layer;
use crate::number::push_fixed;
use crate::palette;
use crate::pass::Pass;
use glam::{DVec2, DVec3};
use planar::{Bounds, Polygon};

/// Maximum number of layers that are drawn.
const PICTURES: usize = 12;

/// Maximum number of rows of the table.
const ROWS: usize = 60;

/// The page of a plan.
pub fn page(part: &str, layers: &[Layer], history: &History, limits: Option<&Interpass>) -> Sheet {
    let mut sheet = Sheet::new(&format!("Heat: {part}"), &lead(history, limits));
    sheet.heading("Over the build").svg(&over_time(history, limits).svg());
    sheet.heading("Where it is hot");
    sheet.text("Each bead in the colour of the metal just ahead of the torch, with its start as a ring.");
    let scale = Scale::of(history);
    sheet.svg(&scale.svg());
    for index in spread(layers.len(), PICTURES) {
        let (Some(layer), Some(heat)) = (layers.get(index), history.layers.get(index)) else { continue };
        if !layer.passes.is_empty() {
            sheet.svg(&picture(layer, heat, history.spacing, &scale));
        }
    }
    let head =
        ["layer", "below °C", "coolest start °C", "hottest start °C", "hottest ahead °C", "waits s", "ends at min"];
    sheet.heading("Layers").table(&head, &rows(layers, history));
    sheet
}

fn lead(history: &History, limits: Option<&Interpass>) -> String {
    let hottest = history.hottest_start().map_or(f64::NAN, |(.., start)| start);
    let waits = history.waits() / 60.0;
    let limit = limits.map_or(String::new(), |limits| format!(" The limit is {:.0} °C.", limits.max_temperature));
    format!(
        "The hottest pass begins on metal at {hottest:.0} °C; the torch waits {waits:.1} min for metal to cool, of {:.1} min \
         in all.{limit} Computed from the program's own times with constant material values, in voxels ({}).",
        history.seconds / 60.0,
        history.voxels
    )
}

/// Temperature at the start of each pass, and of what lies below each layer, over time.
fn over_time(history: &History, limits: Option<&Interpass>) -> Plot {
    let starts =
        history.layers.iter().flat_map(|layer| &layer.passes).map(|pass| DVec2::new(pass.at / 60.0, pass.start));
    let first = |layer: &LayerHeat| layer.passes.first().map(|pass| pass.at / 60.0);
    let below = history.layers.iter().filter_map(|layer| Some(DVec2::new(first(layer)?, layer.below)));
    let limit = |limits: &Interpass| (limits.max_temperature, format!("limit {:.0} °C", limits.max_temperature));
    let curve = |name: &str, points: Vec<DVec2>| Curve { name: name.to_owned(), points };
    let curves = [curve("where passes begin", starts.collect()), curve("mean of the layer below", below.collect())];
    Plot {
        title: "Temperature before each pass".to_owned(),
        x: "time, min".to_owned(),
        y: "temperature, °C".to_owned(),
        curves: curves.to_vec(),
        limits: limits.map(limit).into_iter().collect(),
        ..Plot::default()
    }
}

fn rows(layers: &[Layer], history: &History) -> Vec<Row> {
    let row = |index: usize| {
        let (layer, heat) = (layers.get(index)?, history.layers.get(index)?);
        let starts = || heat.passes.iter().map(|pass| pass.start);
        let least = starts().min_by(f64::total_cmp)?;
        let peak = heat.passes.iter().map(|pass| pass.peak().1).fold(f64::MIN, f64::max);
        let values = [heat.below, least, heat.hottest_start()?, peak, heat.wait(), heat.end / 60.0];
        let cells = values.into_iter().map(|value| format!("{value:.0}"));
        Some([format!("{}", layer.index + 1)].into_iter().chain(cells).map(|text| (text, false)).collect())
    };
    spread(layers.len(), ROWS).filter_map(row).collect()
}

/// At most `most` indices out of `count`, evenly spread, with the first and the last.
fn spread(count: usize, most: usize) -> impl Iterator<Item = usize> {
    let shown = count.min(most);
    (0..shown).map(move |i| if shown > 1 { i * (count - 1) / (shown - 1) } else { i })
}

/// Colours from the coldest to the hottest metal ahead of a torch.
struct Scale {
    low: f64,
    high: f64,
}

impl Scale {
    fn of(history: &History) -> Self {
        let all = history.layers.iter().flat_map(|layer| &layer.passes).flat_map(|pass| &pass.along);
        let (low, high) = all.fold((f64::MAX, f64::MIN), |(low, high), t| (low.min(*t), high.max(*t)));
        Self { low, high: high.max(low + 1.0) }
    }

    fn colour(&self, temperature: f64) -> String {
        palette::hex(palette::warmth((temperature - self.low) / (self.high - self.low)))
    }

    /// The legend.
    fn svg(&self) -> String {
        const STEPS: usize = 40;
        let mut svg = String::from(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 720 44\" role=\"img\" aria-label=\"Colours of temperatures\" font-family=\"system-ui, sans-serif\" font-size=\"13\">\n",
        );
        for i in 0..STEPS {
            let at = self.low + (self.high - self.low) * (i as f64 + 0.5) / STEPS as f64;
            let colour = self.colour(at);
            svg += &format!("<rect x=\"{}\" y=\"4\" width=\"14.5\" height=\"14\" fill=\"{colour}\"/>\n", 70 + 14 * i);
        }
        for (x, part) in [(70, 0.0), (350, 0.5), (630, 1.0)] {
            let value = self.low + (self.high - self.low) * part;
            svg += &format!("<text x=\"{x}\" y=\"36\" text-anchor=\"middle\">{value:.0} °C</text>\n");
        }
        svg + "</svg>\n"
    }
}

/// The beads of a layer, each piece in the colour of its temperature.
fn picture(layer: &Layer, heat: &LayerHeat, spacing: f64, scale: &Scale) -> String {
    let points = layer.passes.iter().flat_map(|pass| &pass.points).map(|p| p.truncate());
    let outlines = layer.islands.iter().flat_map(Polygon::rings).flat_map(|ring| ring.points()).copied();
    let Some(bounds) = Bounds::of(points.chain(outlines)) else { return String::new() };
    let unit = bounds.size().max_element().max(1e-3) / 100.0;
    let (low, size) = (bounds.min - 6.0 * unit, bounds.size() + 12.0 * unit);
    let title = escape(&format!("Layer {}, z {:.2} mm", layer.index + 1, layer.z));
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"{:.3} {:.3} {:.3} {:.3}\" role=\"img\" aria-label=\"{title}\" \
         font-family=\"system-ui, sans-serif\" stroke-linecap=\"round\" stroke-linejoin=\"round\" fill=\"none\">\n<text x=\"{:.3}\" y=\"{:.3}\" \
         font-size=\"{:.3}\" fill=\"currentColor\">{title}</text>\n",
        low.x,
        -(low.y + size.y) - 5.0 * unit,
        size.x,
        size.y + 5.0 * unit,
        low.x + unit,
        -(low.y + size.y) - unit,
        3.6 * unit,
    );
    for (pass, heat) in layer.passes.iter().zip(&heat.passes) {
        let width = 0.8 * pass.width.max();
        for (line, temperature) in pieces(pass, &heat.along, spacing) {
            svg += &format!("<path stroke=\"{}\" stroke-width=\"{width:.3}\" d=\"", scale.colour(temperature));
            draw(&mut svg, &line);
            svg += "\"/>\n";
        }
        if let Some(start) = pass.start() {
            let (x, y, r) = (start.x, -start.y, 0.3 * width);
            svg += &format!(
                "<circle cx=\"{x:.3}\" cy=\"{y:.3}\" r=\"{r:.3}\" fill=\"#fff\" stroke=\"#111827\" stroke-width=\"{:.3}\"/>\n",
                0.3 * unit
            );
        }
    }
    svg + "</svg>\n"
}

fn draw(svg: &mut String, line: &[DVec3]) {
    for (i, p) in line.iter().enumerate() {
        svg.push(if i == 0 { 'M' } else { 'L' });
        push_fixed(svg, p.x, 2);
        svg.push(' ');
        push_fixed(svg, -p.y, 2);
    }
}

/// A pass cut every `spacing` mm, each piece with the temperature at its beginning.
fn pieces(pass: &Pass, along: &[f64], spacing: f64) -> Vec<(Vec<DVec3>, f64)> {
    let (mut found, mut way) = (Vec::new(), 0.0);
    let mut line: Vec<DVec3> = pass.start().into_iter().collect();
    let temperature = |piece: usize| along.get(piece).or(along.last()).copied().unwrap_or_default();
    for s in pass.segments() {
        let (length, mut done) = (s.length(), 0.0);
        while way + length - done > spacing {
            done += spacing - way;
            let cut = s.from.lerp(s.to, (done / length).min(1.0));
            line.push(cut);
            found.push((std::mem::replace(&mut line, vec![cut]), temperature(found.len())));
            way = 0.0;
        }
        way += length - done;
        line.push(s.to);
    }
    let last = temperature(found.len());
    found.push((line, last));
    found
}
