//! What a profile asks of a dialect, beside the dialect's own section: refused here in words, so that no post has to.

use crate::profile::{Follow, KrlArc, Profile, ProfileError, RapidArc};

/// Lines of a dialect's section that others rely on.
struct Lines<'a> {
    arc_off: &'a [String],
    wire_feed: &'a [String],
    /// How the wire feed may be set there.
    example: &'static str,
}

/// Refuses a profile that asks for more than a post can write.
pub(super) fn check(name: &str, profile: &Profile) -> Result<(), ProfileError> {
    // Nothing is switched then.
    if profile.is_dry_run() {
        return Ok(());
    }
    if name == "marlin" {
        return printer(profile);
    }
    if name == "krl" && profile.krl.as_ref().is_some_and(|krl| krl.arc == KrlArc::Arctech) {
        return arctech(profile);
    }
    let Some(lines) = lines(name, profile) else { return Ok(()) };
    let ends = &profile.start_stop;
    let why = match profile.process.follow {
        Follow::WireFeed => Some("process.follow = \"wire-feed\""),
        Follow::Speed => ends.crater_is_weaker().then_some("a start_stop.crater_power below 1"),
    };
    if let Some(why) = why.filter(|_| lines.wire_feed.is_empty()) {
        let remedy = format!(
            "Put the lines there that set it on the cell, such as wire_feed = [\"{}\"], or take process.follow = \
             \"speed\" and a crater_power of 1.",
            lines.example
        );
        return Err(no_key(profile, format!("{name}.wire_feed"), why, remedy));
    }
    if ends.wire_retract > 0.0 && !lines.arc_off.iter().any(|line| line.contains("{{wire_retract")) {
        let remedy = "Use {{wire_retract}} (mm), {{wire_retract_time}} (s) or {{wire_retract_time_ms}} in its lines.";
        let key = format!("{name}.arc_off with {{{{wire_retract}}}}");
        return Err(no_key(profile, key, "start_stop.wire_retract", remedy.to_owned()));
    }
    Ok(())
}

fn no_key(profile: &Profile, key: String, why: &str, remedy: String) -> ProfileError {
    ProfileError::NoKey { profile: profile.name.clone(), key, why: why.to_owned(), remedy }
}

/// A printer's E tells the feed of every move, but nothing melts without one.
fn printer(profile: &Profile) -> Result<(), ProfileError> {
    let cannot = |what, remedy| Err(ProfileError::Cannot { post: "marlin", what, remedy });
    if profile.start_stop.crater_fill_time > 0.0 {
        return cannot("a start_stop.crater_fill_time", "Strands have no craters: leave it out.");
    }
    if profile.start_stop.wire_retract > 0.0 {
        return cannot("a start_stop.wire_retract", "Take marlin.retract_length instead.");
    }
    Ok(())
}

/// The forms of ArcTech have their own data for the end of a pass, and set the wire feed by the weld's own set.
fn arctech(profile: &Profile) -> Result<(), ProfileError> {
    let cannot = |what, remedy| Err(ProfileError::Cannot { post: "krl", what, remedy });
    if profile.process.follow == Follow::WireFeed {
        return cannot("process.follow = \"wire-feed\" with arc = \"arctech\"", "Take process.follow = \"speed\".");
    }
    if profile.start_stop.crater_fill_time > 0.0 {
        return cannot("a start_stop.crater_fill_time with arc = \"arctech\"", "Take krl.arctech.crater.time instead.");
    }
    if profile.start_stop.wire_retract > 0.0 {
        let remedy = "Take krl.arctech.crater.burnback_time instead.";
        return cannot("a start_stop.wire_retract with arc = \"arctech\"", remedy);
    }
    Ok(())
}

/// The lines of a dialect; none where it has its own instructions for all of it, or no section.
fn lines<'a>(name: &str, profile: &'a Profile) -> Option<Lines<'a>> {
    let (arc_off, wire_feed, example) = match name {
        "krl" => profile.krl.as_ref().map(|s| (&s.arc_off, &s.wire_feed, "$ANOUT[1] = {{wire_feed_ratio}}")),
        "gcode" => profile.gcode.as_ref().map(|s| (&s.arc_off, &s.wire_feed, "M67 E0 Q{{wire_feed_ratio}}")),
        "rapid" => {
            let plain = profile.rapid.as_ref().filter(|s| s.arc == RapidArc::Plain);
            plain.map(|s| (&s.arc_off, &s.wire_feed, "SetAO aoWire,{{wire_feed_ratio}};"))
        }
        "fanuc" => profile.fanuc.as_ref().map(|s| (&s.arc_off, &s.wire_feed, "AO[1]={{wire_feed_ratio}}")),
        "inform" => profile.inform.as_ref().map(|s| (&s.arc_off, &s.wire_feed, "AOUT AO#(1) {{wire_feed_ratio}}")),
        "urscript" => {
            let section = profile.urscript.as_ref();
            section.map(|s| (&s.arc_off, &s.wire_feed, "set_standard_analog_out(0, {{wire_feed_ratio}})"))
        }
        _ => None,
    }?;
    Some(Lines { arc_off, wire_feed, example })
}
