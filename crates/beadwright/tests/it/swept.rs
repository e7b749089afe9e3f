//! The shape as built: bodies that are closed and hold the metal of the plan, in files that their readers take.

use crate::common;

use beadwright::export::{self, Beads};
use beadwright::glam::{DVec3, Vec3};
use beadwright::layer::{Extent, Layer};
use beadwright::pass::{Along, Pass, PassKind};
use beadwright::plan::Header;
use beadwright::profile::Profile;
use common::{planned, profile, profile_by};
use std::collections::HashMap;

type Facet = [DVec3; 3];

fn written(extension: &str, header: &Header, layers: &[Layer], profile: &Profile) -> Vec<u8> {
    (export::format(extension).unwrap().write)(&Beads { header, layers, profile, heat: None }).unwrap()
}

/// The triangles of a binary STL file.
fn facets(stl: &[u8]) -> Vec<Facet> {
    let number = |b: &[u8]| f64::from(f32::from_le_bytes(b.try_into().unwrap()));
    let corner = |b: &[u8]| DVec3::new(number(&b[..4]), number(&b[4..8]), number(&b[8..12]));
    assert_eq!(stl.len(), 84 + 50 * u32::from_le_bytes(stl[80..84].try_into().unwrap()) as usize);
    stl[84..].chunks(50).map(|r| [corner(&r[12..]), corner(&r[24..]), corner(&r[36..])]).collect()
}

fn volume(facets: &[Facet]) -> f64 {
    facets.iter().map(|[a, b, c]| a.dot(b.cross(*c))).sum::<f64>() / 6.0
}

/// Every edge runs as often one way as the other: the surface has no rim.
fn assert_closed(facets: &[Facet]) {
    let mut edges: HashMap<[[u64; 3]; 2], i32> = HashMap::new();
    // Adding 0 makes -0 the same.
    let key = |p: DVec3| (p + 0.0).to_array().map(f64::to_bits);
    for facet in facets {
        for k in 0..3 {
            let (a, b) = (key(facet[k]), key(facet[(k + 1) % 3]));
            *edges.entry([a.min(b), a.max(b)]).or_default() += if a < b {
                1
            } else if a > b {
                -1
            } else {
                0
            };
        }
    }
    assert!(edges.values().all(|&sum| sum == 0), "{} open edges", edges.values().filter(|s| **s != 0).count());
}

/// mm³ of beads without their craters.
fn metal(profile: &Profile, layers: &[Layer], header: &Header) -> f64 {
    let pieces = Beads { header, layers, profile, heat: None }.pieces();
    let laid = profile.bead().area() * profile.process.deposition_speed;
    pieces.iter().map(|p| p.from.distance(p.to) / p.pace * laid).sum()
}

#[test]
fn the_shape_holds_the_metal_of_the_plan() {
    for (part, profile) in [
        ("cross", profile_by("cmt-al2319-kuka", "hybrid")),
        ("star", profile_by("cmt-al2319-kuka", "contour")),
        ("gear", profile_by("plasma-304-cnc", "zigzag")),
        ("star", profile_by("fdm-abs-0.4", "contour")),
        ("blade", profile("cmt-steel-robots")),
    ] {
        let mut plan = planned(part, &profile);
        plan.layers.truncate(4);
        let expected = metal(&profile, &plan.layers, &plan.header);
        let facets = facets(&written("stl", &plan.header, &plan.layers, &profile));
        assert_closed(&facets);
        let built = volume(&facets);
        // Coordinates of 24 bits.
        assert!((built / expected - 1.0).abs() < 2e-3, "{part}: {built} mm³ for {expected}");
        let low = facets.iter().flatten().map(|p| p.z).fold(f64::INFINITY, f64::min);
        assert!(low.abs() < 1e-3, "{part} stands at {low} mm");
    }
}

/// A bead around a square: a frame of four prisms with mitred corners.
#[test]
fn a_square_has_the_volume_of_its_prisms() {
    let mut profile = profile("cmt-al2319-kuka");
    profile.start_stop = Default::default();
    for turn in [0.0_f64, 20.0, 45.0, 77.0] {
        let at = |x: f64, y: f64| {
            let (sin, cos) = turn.to_radians().sin_cos();
            DVec3::new(x * cos - y * sin, x * sin + y * cos, 2.0)
        };
        let points = vec![at(-40.0, -40.0), at(40.0, -40.0), at(40.0, 40.0), at(-40.0, 40.0)];
        let pace = profile.process.deposition_speed;
        let pass = |closed| Pass {
            kind: PassKind::Contour,
            closed,
            points: points.clone(),
            width: Along::Same(profile.bead.width),
            pace: Along::Same(pace),
            wait: 0.0,
        };
        for (closed, length) in [(true, 320.0), (false, 240.0)] {
            let layer = Layer { z: 2.0, height: 2.0, passes: vec![pass(closed)], ..Layer::default() };
            let header = Header {
                part: "square".into(),
                profile: String::new(),
                strategy: String::new(),
                extent: Extent { layers: 1, ..Extent::default() },
            };
            let facets = facets(&written("stl", &header, std::slice::from_ref(&layer), &profile));
            assert_closed(&facets);
            let (built, expected) = (volume(&facets), length * profile.bead().area());
            assert!((built / expected - 1.0).abs() < 1e-5, "{turn}°, {closed}: {built} mm³ for {expected}");
            let high = facets.iter().flatten().map(|p| p.z).fold(0.0, f64::max);
            assert!((high / profile.bead.height - 1.0).abs() < 0.03, "{high} mm high");
        }
    }
}

/// GLB as its specification has it: two chunks, and accessors that fit their views.
#[test]
fn glb_holds_the_same_bodies() {
    let profile = profile_by("cmt-al2319-kuka", "compound");
    let plan = planned("cross", &profile);
    let stl = facets(&written("stl", &plan.header, &plan.layers, &profile));
    let glb = written("glb", &plan.header, &plan.layers, &profile);
    let word = |at: usize| u32::from_le_bytes(glb[at..at + 4].try_into().unwrap()) as usize;
    assert_eq!((&glb[..4], word(4), word(8)), (&b"glTF"[..], 2, glb.len()));
    let json_length = word(12);
    assert_eq!((&glb[16..20], json_length % 4), (&b"JSON"[..], 0));
    let json: serde_json::Value = serde_json::from_slice(&glb[20..20 + json_length]).unwrap();
    let bin = 20 + json_length;
    assert_eq!((&glb[bin + 4..bin + 8], word(bin) % 4, bin + 8 + word(bin)), (&b"BIN\0"[..], 0, glb.len()));
    let data = &glb[bin + 8..];
    assert_eq!(json["buffers"][0]["byteLength"], data.len());
    let view = |accessor: &serde_json::Value| {
        let view = &json["bufferViews"][accessor["bufferView"].as_u64().unwrap() as usize];
        let [offset, length] = ["byteOffset", "byteLength"].map(|key| view[key].as_u64().unwrap() as usize);
        &data[offset..offset + length]
    };
    let mut facets: Vec<Facet> = Vec::new();
    for primitive in json["meshes"][0]["primitives"].as_array().unwrap() {
        let accessor = |key: &serde_json::Value| &json["accessors"][key.as_u64().unwrap() as usize];
        let places = accessor(&primitive["attributes"]["POSITION"]);
        let number = |b: &[u8]| f32::from_le_bytes(b.try_into().unwrap());
        let corners: Vec<Vec3> =
            view(places).chunks(12).map(|b| [0, 4, 8].map(|k| number(&b[k..k + 4])).into()).collect();
        assert_eq!(places["count"], corners.len());
        let high = corners.iter().copied().fold(Vec3::NEG_INFINITY, Vec3::max);
        assert_eq!(serde_json::json!(high.to_array()), places["max"]);
        let indices = accessor(&primitive["indices"]);
        let index = |b: &[u8]| corners[u32::from_le_bytes(b.try_into().unwrap()) as usize].as_dvec3();
        let triangles = view(indices).chunks(12).map(|b| [index(&b[..4]), index(&b[4..8]), index(&b[8..])]);
        facets.extend(triangles);
        assert!(view(indices).len() == 4 * indices["count"].as_u64().unwrap() as usize);
    }
    assert_eq!(facets.len(), stl.len());
    assert!((volume(&facets) / volume(&stl) - 1.0).abs() < 1e-6);
    assert_closed(&facets);
}
