//! What is coloured in the studio has the colours of the library's palette (`crates/beadwright/tests/it/palette.rs` asks who can tell
//! them apart), and each of its scales uses a whole map.

use beadwright_studio::view3d::{Colour, palette};

#[test]
fn scales_are_those_of_the_palette() {
    use beadwright::palette::{height, kind, rising, warmth};
    for part in [0.0, 0.3, 1.0] {
        for colour in [Colour::Order, Colour::Speed, Colour::Width, Colour::Time, Colour::OffLevel, Colour::Movement] {
            assert_eq!(palette::at(colour, part), rising(part), "{colour:?}");
        }
        assert_eq!(palette::at(Colour::Temperature, part), warmth(part));
        assert_eq!(palette::at(Colour::HeightError, part), height(2.0 * part));
    }
    let bodies = palette::map(Colour::Body);
    assert!(bodies.iter().zip(beadwright::palette::BODIES.iter().cycle()).all(|(colour, of)| colour == of));
    let kinds = palette::map(Colour::Kind);
    assert!(kinds.iter().zip(palette::KINDS).all(|(colour, of)| *colour == kind(of)));
}
