//! Colours can be told apart by everybody: with normal sight, and without the red, green or blue cones.

use crate::sight;

use beadwright_studio::view3d::{Colour, palette};
use sight::{SIGHTS, difference, lab};

#[test]
fn everybody_can_tell_kinds_and_marks_apart() {
    let kinds = palette::KINDS.map(palette::kind);
    for sight in &SIGHTS {
        for (i, a) in kinds.iter().enumerate() {
            for b in &kinds[..i] {
                assert!(difference(*a, *b, sight) > 30.0, "{a:?} and {b:?}: {:.0}", difference(*a, *b, sight));
            }
        }
        assert!(difference(palette::START, palette::END, sight) > 40.0);
    }
}

#[test]
fn everybody_can_tell_the_quarters_of_every_scale_apart() {
    let scales = [Colour::Order, Colour::Speed, Colour::Width, Colour::HeightError, Colour::Time];
    let scales = scales.into_iter().chain([Colour::Temperature, Colour::OffLevel]);
    for (scale, dark) in scales.flat_map(|scale| [(scale, false), (scale, true)]) {
        let stops: Vec<palette::Rgb> = (0..=4).map(|i| palette::at(scale, f64::from(i) / 4.0, dark)).collect();
        for (number, sight) in SIGHTS.iter().enumerate() {
            for (i, a) in stops.iter().enumerate() {
                for b in &stops[..i] {
                    let apart = difference(*a, *b, sight);
                    assert!(
                        apart > 12.0,
                        "{scale:?}, dark {dark}, sight {number}: {a:?} and {b:?} differ by {apart:.0}"
                    );
                }
            }
        }
    }
}

#[test]
fn scales_from_little_to_much_go_one_way_in_brightness() {
    for (scale, dark) in
        [(Colour::Speed, true), (Colour::Width, false), (Colour::Temperature, true), (Colour::Time, false)]
    {
        for sight in &SIGHTS {
            let light: Vec<f64> =
                (0..=20).map(|i| lab(palette::at(scale, f64::from(i) / 20.0, dark), sight)[0]).collect();
            assert!(light.windows(2).all(|pair| pair[1] > pair[0] - 0.3), "{scale:?}: {light:.0?}");
        }
    }
}
