//! How a layer lies in space, for the scripts of the report: `lie.js` takes its points there.

use crate::chart::{Chart, Plane, Sheet, Side};
use crate::layer::Layer;
use glam::DVec3;
use serde_json::{Value, json};
use std::f64::consts::TAU;

/// What places a layer, and how far its top lies above its middle. Lengths in mm.
pub(super) fn lie(chart: &Chart, layer: &Layer) -> Value {
    let mut lie = place(chart, layer.middle(), layer.body);
    lie["top"] = json!(layer.z - layer.middle());
    lie
}

/// The surface of a body, over which its layers lie, as splines.
pub(super) fn surface(chart: &Chart) -> Value {
    let Chart::Surface(surface) = chart else { return Value::Null };
    let control: Vec<f64> = surface.control().iter().map(|v| (v * 1e4).round() / 1e4).collect();
    json!({ "from": surface.from(), "step": surface.step(), "columns": surface.columns(), "control": control })
}

/// A plane with the bend of its guide, a surface around an axis, or the height over the surface of a body.
fn place(chart: &Chart, middle: f64, body: usize) -> Value {
    let sheet = chart.sheet(middle);
    let at = |u: f64, v: f64| sheet.at(DVec3::new(u, v, middle));
    let origin = at(0.0, 0.0);
    match chart {
        Chart::Plane(_) | Chart::Guide(_) => {
            let bend = [DVec3::X, DVec3::Y].map(|p| 1.0 - sheet.rise(p.truncate()));
            json!({ "flat": { "origin": origin.place, "along": origin.along, "normal": origin.normal, "bend": bend } })
        }
        Chart::Surface(surface) => {
            let axes = [DVec3::X, DVec3::Y, DVec3::Z]
                .map(|axis| Chart::Plane(Plane { up: surface.up(), origin: DVec3::ZERO }).sheet(0.0).at(axis).place);
            json!({ "over": { "axes": axes, "middle": middle, "body": body } })
        }
        Chart::Cylinder(cylinder) => {
            let [around, axis] = origin.along;
            let radius = radius(&sheet);
            // Inside a bore, layers follow one another towards the axis.
            let side = if cylinder.side == Side::Inner { -1.0 } else { 1.0 };
            let outward = origin.normal * side;
            let centre = origin.place - outward * radius;
            json!({ "around": { "centre": centre, "axis": axis, "out": outward, "around": around, "radius": radius, "side": side } })
        }
        Chart::Cone(cone) => {
            let half = cone.half_angle.to_radians();
            // On the straight line at the angle 0, v grows away from the tip.
            let [around, line] = at(0.0, 1.0).along;
            let outward = (line - cone.axis * half.cos()) / half.sin();
            let centre = cone.tip - cone.axis * (middle / half.sin());
            json!({ "around": { "centre": centre, "axis": cone.axis, "out": outward, "around": around, "radius": 1.0, "half": half } })
        }
    }
}

/// Radius of a layer around an axis, mm.
fn radius(sheet: &Sheet<'_>) -> f64 {
    let turns = sheet.turns_to(glam::DVec2::ZERO, glam::DVec2::X);
    if turns == 0.0 { 1.0 } else { 1.0 / (TAU * turns.abs()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What `lie.js` computes, in Rust.
    fn placed(lie: &Value, u: f64, v: f64, up: f64) -> DVec3 {
        let vector = |value: &Value| {
            let number = |i: usize| value[i].as_f64().unwrap_or(f64::NAN);
            DVec3::new(number(0), number(1), number(2))
        };
        if let Some(flat) = lie.get("flat") {
            let bend = |i: usize| flat["bend"][i].as_f64().unwrap_or(f64::NAN);
            let rise = 1.0 - bend(0) * u - bend(1) * v;
            let along = [0, 1].map(|i| vector(&flat["along"][i]));
            return vector(&flat["origin"]) + along[0] * u + along[1] * v + vector(&flat["normal"]) * (rise * up);
        }
        let around = &lie["around"];
        let [centre, axis, out, on] = ["centre", "axis", "out", "around"].map(|key| vector(&around[key]));
        let number = |key: &str| around[key].as_f64();
        let (radius, side) = (number("radius").unwrap_or(f64::NAN), number("side").unwrap_or(f64::NAN));
        let Some(half) = number("half") else {
            let outward = out * (u / radius).cos() + on * (u / radius).sin();
            return centre + axis * v + outward * (radius + side * up);
        };
        let angle = u.atan2(v) / half.sin();
        let outward = out * angle.cos() + on * angle.sin();
        let line = axis * half.cos() + outward * half.sin();
        centre + line * u.hypot(v) + (outward * half.cos() - axis * half.sin()) * up
    }

    #[test]
    fn the_report_places_layers_as_the_chart_does() -> Result<(), crate::chart::ChartError> {
        let charts = [
            "plane:up=1/2/3,through=4/5/6",
            "cylinder:axis=1/2/3,through=4/5/6,radius=30,seam=20",
            "cylinder:axis=x,radius=60,side=inner",
            "cone:axis=-1/0.2/1,tip=0/3/90,angle=35,seam=-70",
            "guide:points=0/0/0:0/0/145:145/0/145,radius=120",
        ];
        for text in charts {
            let (chart, middle): (Chart, f64) = (text.parse()?, 12.5);
            let (sheet, lie) = (chart.sheet(middle), place(&chart, middle, 0));
            for (u, v, up) in [(0.0_f64, 7.0_f64, 0.0), (3.0, 20.0, 0.8), (-40.0, 31.0, -0.9), (11.0, -5.0, 1.0)] {
                // A cone lies on one side of its tip only.
                let v = if matches!(chart, Chart::Cone(_)) { v.abs() + 30.0 } else { v };
                let (here, there) = (sheet.at(DVec3::new(u, v, middle + up)).place, placed(&lie, u, v, up));
                assert!(here.distance(there) < 1e-6, "{text}: {here} {there}");
            }
        }
        Ok(())
    }
}
