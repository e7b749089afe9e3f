//! Trial beads measured in a scan of their plate: sizes, humps, craters and valleys are those with which the surface was made.

use crate::trial::series;
use bead_plan::bead::library::{Columns, Measured};
use bead_plan::random::Random;
use bead_plan::trial::{self, BeadSize, More, Shape, Slope, Sought};
use glam::DVec3;
use planar::DVec2;

/// A scan of beads of known size on a tilted plate, with noise, at any angle of the beads.
#[test]
fn beads_in_a_scan_have_the_size_that_they_were_made_with() {
    let mut random = Random::new(5);
    for (noise, most) in [(0.0, 0.01), (0.05, 0.03), (0.1, 0.05)] {
        for degrees in [0.0_f64, 33.0, 90.0, 200.0] {
            let turn = DVec2::from_angle(degrees.to_radians());
            let sizes = [(4.5, 1.6), (6.0, 2.0), (8.5, 3.2), (5.0, 3.0)];
            let bead = |k: usize| [0.0, 90.0].map(|x| turn.rotate(DVec2::new(x, 30.0 * k as f64)));
            // The last is not welded.
            let beads: Vec<[DVec2; 2]> = (0..=sizes.len()).map(bead).collect();
            let mut scan = Vec::new();
            for (i, j) in (0..280).flat_map(|i| (0..400).map(move |j| (i, j))) {
                let flat = DVec2::new(-25.0 + 0.5 * f64::from(i), -40.0 + 0.5 * f64::from(j));
                let own = |(k, (width, height)): (usize, &(f64, f64))| {
                    // It wanders by half a millimetre from where it was planned.
                    let across = flat.y - 30.0 * k as f64 - 0.5;
                    let on = (0.0..=90.0).contains(&flat.x) && across.abs() < width / 2.0;
                    if on { height * (1.0 - (2.0 * across / width).powi(2)) } else { 0.0 }
                };
                let bead: f64 = sizes.iter().enumerate().map(own).sum();
                let at = turn.rotate(flat);
                let z = 12.0 + 0.004 * at.x - 0.003 * at.y + bead + noise * random.normal();
                scan.push(DVec3::new(at.x, at.y, z));
            }
            let trials: Vec<Sought> = beads.iter().map(|bead| Sought { beads: vec![*bead], reach: 8.0 }).collect();
            let found = trial::measured(&scan, &trials).unwrap();
            for (size, (width, height)) in found.iter().zip(sizes) {
                let size = size.unwrap();
                assert!((size.width / width - 1.0).abs() < most, "{noise} {degrees}: {size:?} {width}");
                assert!((size.height / height - 1.0).abs() < most, "{noise} {degrees}: {size:?} {height}");
            }
            assert_eq!(found.last().unwrap(), &None, "{noise} {degrees}");
        }
    }
    assert!(trial::measured(&[], &[Sought { beads: vec![[DVec2::ZERO, DVec2::X]], reach: 5.0 }]).is_err());
}

/// A scan at this angle of a plate that tilts, with points half a millimetre apart; `height` is that of the beads above a place.
fn scanned(degrees: f64, noise: f64, random: &mut Random, height: impl Fn(DVec2) -> f64) -> Vec<DVec3> {
    let turn = DVec2::from_angle(degrees.to_radians());
    let mut scan = Vec::new();
    for (i, j) in (0..280).flat_map(|i| (0..200).map(move |j| (i, j))) {
        let flat = DVec2::new(-25.0 + 0.5 * f64::from(i), -40.0 + 0.5 * f64::from(j));
        let at = turn.rotate(flat);
        let z = 3.0 - 0.002 * at.x + 0.004 * at.y + height(flat) + noise * random.normal();
        scan.push(DVec3::new(at.x, at.y, z));
    }
    scan
}

/// Across a bead of this width (mm), its height as a fraction of that of the crown.
fn across(y: f64, width: f64) -> f64 {
    (1.0 - (2.0 * y / width).powi(2)).max(0.0)
}

/// A bead with a hump and a crater that fade evenly, or with neither, at any angle and with noise.
#[test]
fn humps_and_craters_in_a_scan_are_as_high_and_as_long_as_they_were_made() {
    let mut random = Random::new(9);
    let slope = |from: f64, height: f64, length: f64| height * (1.0 - from / length).max(0.0);
    for (noise, most) in [(0.0, 0.03), (0.05, 0.1), (0.1, 0.15)] {
        for degrees in [0.0_f64, 37.0, 90.0, 211.0] {
            let turn = DVec2::from_angle(degrees.to_radians());
            let bead = [0.0, 90.0].map(|x| turn.rotate(DVec2::new(x, 0.0)));
            let seen = |hump: [f64; 2], crater: [f64; 2], random: &mut Random| {
                let height = |p: DVec2| {
                    let ends = slope(p.x, hump[0], hump[1]) - slope(90.0 - p.x, crater[0], crater[1]);
                    if (0.0..=90.0).contains(&p.x) { (2.0 + ends) * across(p.y - 0.4, 6.0) } else { 0.0 }
                };
                let scan = scanned(degrees, noise, random, height);
                match trial::measured(&scan, &[Sought { beads: vec![bead], reach: 8.0 }]).unwrap()[0].unwrap().more {
                    More::One { hump, crater, .. } => [hump, crater].map(Option::unwrap),
                    More::Beside { .. } => panic!("one bead was welded"),
                }
            };
            let [hump, crater] = seen([0.8, 9.0], [1.1, 24.0], &mut random);
            let case = format!("{noise} {degrees}: {hump:?} {crater:?}");
            assert!((hump.height - 0.8).abs() < most && (crater.height - 1.1).abs() < most, "{case}");
            assert!((hump.length.unwrap() - 9.0).abs() < 2.5 && (crater.length.unwrap() - 24.0).abs() < 2.5, "{case}");
            let [hump, crater] = seen([0.0, 1.0], [0.0, 1.0], &mut random);
            assert!(hump.height.abs() < most && crater.height.abs() < most, "{noise} {degrees}: {hump:?} {crater:?}");
            assert!(noise == 0.0 || hump.length.is_none() && crater.length.is_none(), "{hump:?} {crater:?}");
        }
    }
}

/// A scan that begins late shows the size of a bead and its crater, and says nothing of its hump; a later scan takes back what an
/// earlier one found.
#[test]
fn an_end_that_a_scan_does_not_show_is_left_empty() {
    let mut random = Random::new(3);
    let height = |p: DVec2| {
        let inside = (0.0..=90.0).contains(&p.x);
        if inside { (2.0 - (1.0 - (90.0 - p.x) / 20.0).max(0.0)) * across(p.y, 6.0) } else { 0.0 }
    };
    let mut scan = scanned(0.0, 0.05, &mut random, height);
    let sought = [Sought { beads: vec![[DVec2::ZERO, DVec2::new(90.0, 0.0)]], reach: 8.0 }];
    let whole = trial::measured(&scan, &sought).unwrap();
    scan.retain(|p| p.x > 7.0);
    let part = trial::measured(&scan, &sought).unwrap();
    let [More::One { hump: Some(_), .. }, More::One { hump: None, crater: Some(crater), .. }] =
        [whole[0].unwrap().more, part[0].unwrap().more]
    else {
        panic!("{whole:?} {part:?}")
    };
    assert!((crater.height - 1.0).abs() < 0.1 && (part[0].unwrap().height - 2.0).abs() < 0.1, "{part:?}");
    let series = series(&["lead_in_power=1.2..2"], Shape::Ends, 1, 1);
    let sheet = trial::csv("t", &series);
    let once = trial::filled(&sheet, 1, &[whole[0], None, None]).unwrap();
    let again = trial::filled(&once, 1, &[part[0], None, None]).unwrap();
    assert_eq!(again, trial::filled(&sheet, 1, &[part[0], None, None]).unwrap());
}

/// Three beads whose valleys are filled up to a known depth.
#[test]
fn valleys_between_beads_in_a_scan_are_as_deep_as_they_were_made() {
    let mut random = Random::new(11);
    for (noise, most) in [(0.0, 0.04), (0.05, 0.08), (0.1, 0.12)] {
        for degrees in [0.0_f64, 37.0, 90.0, 211.0] {
            for (stepover, depth) in [(4.0, 0.15), (4.8, 0.5), (5.7, 1.2)] {
                let turn = DVec2::from_angle(degrees.to_radians());
                let lines = [0.0, 1.0, 2.0].map(|k| [0.0, 90.0].map(|x| turn.rotate(DVec2::new(x, k * stepover))));
                let height = |p: DVec2| {
                    let own = |k: f64| 2.2 * across(p.y - 0.3 - k * stepover, 6.0);
                    let floor = if (0.0..2.0 * stepover).contains(&(p.y - 0.3)) { 2.2 - depth } else { 0.0 };
                    let highest = [0.0, 1.0, 2.0].map(own).into_iter().fold(floor, f64::max);
                    if (0.0..=90.0).contains(&p.x) { highest } else { 0.0 }
                };
                let scan = scanned(degrees, noise, &mut random, height);
                let found = trial::measured(&scan, &[Sought { beads: lines.to_vec(), reach: 8.0 }]).unwrap();
                let size = found[0].unwrap();
                let More::Beside { valley } = size.more else { panic!("three beads were welded") };
                let case = format!("{noise} {degrees} {stepover}: {size:?}");
                assert!((valley - depth).abs() < most, "{case}");
                assert!((size.height - 2.2).abs() < most, "{case}");
                assert!((size.width - (6.0 + 2.0 * stepover)).abs() < 0.4, "{case}");
                // What is seen goes into the sheet.
                let series = series(&["stepover=0.6..0.9"], Shape::Overlap(3), 1, 1);
                let sheet = trial::csv("t", &series);
                assert_eq!(trial::numbers_on(&sheet, 1).unwrap(), ["1", "2", "3"]);
                let filled = trial::filled(&sheet, 1, &[found[0], None, None]).unwrap();
                assert!(filled.contains(&format!(",{:.2},{:.2},{valley:.2},", size.width, size.height)), "{filled}");
            }
        }
    }
}

#[test]
fn a_scan_fills_in_the_lines_of_its_plate_only() {
    let series = series(&["deposition_speed=6..10"], Shape::Bead, 2, 1);
    let sheet = trial::csv("trials", &series);
    let level = Some(Slope { height: 0.0, length: None });
    let more = More::One { width_varies: 0.1, height_varies: 0.1, hump: level, crater: level };
    let size = BeadSize { width: 6.123, height: 2.0, more };
    let filled = trial::filled(&sheet, 2, &[Some(size), None, Some(size)]).unwrap();
    let changed: Vec<usize> =
        sheet.lines().zip(filled.lines()).enumerate().filter(|(_, (a, b))| a != b).map(|(k, _)| k).collect();
    assert_eq!(changed, [6, 8], "{filled}");
    assert!(filled.contains(",6.12,2.00,"));
    // As a spreadsheet of a country with decimal commas saves it, with remarks that contain separators.
    let european = sheet.replace(',', ";").replace(";;\n", ";;\"cold; wet\"\n");
    let filled = trial::filled(&european, 1, &[Some(size); 3]).unwrap();
    assert!(filled.contains(";6,12;2,00;") && filled.contains("\"cold; wet\""), "{filled}");
    assert_eq!(Measured::read(&filled, &Columns::default()).unwrap().widths, [6.12; 3]);
    let error = trial::filled(&sheet, 1, &[None]).unwrap_err();
    assert!(error.to_string().contains("do not belong together"));
    assert!(trial::filled("a,b\n1,2\n", 1, &[]).unwrap_err().to_string().contains("plate"));
}
