//! Profiles that inherit from others.

use beadwright::profile::{BUILT_IN, Profile, ProfileError};

const FIVE_LINES: &str =
    "inherits = \"cmt-steel-abb\"\nname = \"ours\"\n[process]\ndeposition_speed = 9.0\nwire_feed_speed = 3.05\n";

/// A profile that no longer says where its values come from.
fn alone(mut profile: Profile) -> Profile {
    profile.inherits = None;
    profile
}

#[test]
fn five_lines_make_a_profile() {
    let (ours, base) = (Profile::parse(FIVE_LINES).unwrap(), Profile::built_in("cmt-steel-abb").unwrap());
    assert_eq!((ours.name.as_str(), ours.process.deposition_speed), ("ours", 9.0));
    assert_eq!(
        (&ours.dialects, &ours.start_stop, ours.bead.width),
        (&base.dialects, &base.start_stop, base.bead.width)
    );
    // What is written holds everything by itself.
    let text = ours.toml_text().unwrap();
    assert!(!text.contains("inherits"));
    assert_eq!(alone(ours), Profile::parse(&text).unwrap());
}

#[test]
fn nothing_changes_but_what_is_said() {
    for (name, _) in BUILT_IN {
        let same = Profile::parse(&format!("inherits = \"{name}\"\n")).unwrap();
        assert_eq!(alone(same), Profile::built_in(name).unwrap(), "{name}");
    }
}

#[test]
fn files_inherit_from_files() {
    let mut asked = Vec::new();
    let mut base = |name: &str| {
        asked.push(name.to_owned());
        match name {
            "steel.toml" => Ok(FIVE_LINES.to_owned()),
            other => Profile::built_in_text(other).map(str::to_owned),
        }
    };
    let text = "inherits = \"steel.toml\"\n[krl]\ntool = 3\n";
    // The section of a dialect that no ancestor has lacks its keys.
    assert!(Profile::parse_with(text, &mut base).is_err());
    let text = "inherits = \"steel.toml\"\n[bead]\nwidth = 5.0\n[rapid]\ntool = \"tGun\"\n";
    let profile = Profile::parse_with(text, &mut base).unwrap();
    assert_eq!((profile.bead.width, profile.process.deposition_speed), (5.0, 9.0));
    assert_eq!(profile.dialects.rapid.unwrap().tool, "tGun");
    assert_eq!(asked[asked.len() - 2..], ["steel.toml", "cmt-steel-abb"]);
}

#[test]
fn what_cannot_be_inherited_is_reported() {
    let unknown = Profile::parse("inherits = \"cmt-steel-abc\"\n").unwrap_err();
    assert!(unknown.to_string().contains("Did you mean \"cmt-steel-abb\"?"), "{unknown}");
    let circle =
        Profile::parse_with("name = \"x\"\ninherits = \"me\"\n", &mut |_| Ok("inherits = \"me\"\n".to_owned()));
    assert!(matches!(&circle, Err(ProfileError::Text { line: 2, reason }) if reason.contains("circle")), "{circle:?}");
    // Faults are reported where they are in the profile itself.
    let fault = Profile::parse(&FIVE_LINES.replace("9.0", "\"fast\"")).unwrap_err();
    assert!(matches!(fault, ProfileError::Text { line: 4, .. }), "{fault}");
    let fault = Profile::parse(&FIVE_LINES.replace("9.0", "-1.0")).unwrap_err();
    assert!(matches!(fault, ProfileError::Value { line: 4, .. }), "{fault}");
}

#[cfg(feature = "schema")]
#[test]
fn editors_complete_the_key() {
    let schema = Profile::schema();
    assert!(schema["properties"]["inherits"]["description"].as_str().unwrap().contains("built-in name"));
    for section in ["process", "bead", "interpass", "heat", "material", "substrate"] {
        assert!(schema["properties"][section].is_object(), "{section}");
    }
}
