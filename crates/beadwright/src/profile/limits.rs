//! The limits of values: the rows of all sections, and the few rules that tie keys together.

use super::Profile;
use crate::dialect::{self, PLACEHOLDERS, own};
use crate::limit::{Broken, Limit};
use crate::process::Follow;
use crate::template;

pub(super) fn first_broken(p: &Profile) -> Option<Broken> {
    out_of_range(p).or_else(|| contradiction(p)).or_else(|| bad_template(p))
}

fn out_of_range(p: &Profile) -> Option<Broken> {
    let broken = limits(p).into_iter().find(|limit| !limit.holds());
    broken.map(|Limit { key, value, least, greatest, unit, reason }| Broken {
        key: key.to_owned(),
        value: format!("{value}"),
        reason: format!("it must lie between {least} and {greatest} {unit}: {reason}."),
    })
}

/// The limits of every number that is given.
pub(super) fn limits(p: &Profile) -> Vec<Limit> {
    let w = p.bead.width;
    let general = [
        p.wire.limits(),
        p.process.limits(),
        p.bead.limits(),
        p.layers.limits(),
        p.fill.limits(w),
        p.hybrid.limits(),
        p.wall.limits(),
        p.slice.limits(w),
        p.check.limits(),
        p.travel.limits(),
        p.torch.iter().flat_map(|torch| torch.limits()).collect(),
        p.program.limits(w),
        p.safety.limits(),
        p.weave.iter().flat_map(|weave| weave.limits()).collect(),
        p.one_loop.limits(),
        p.start_stop.limits(),
        p.spot.iter().flat_map(|spot| spot.limits()).collect(),
        p.preform.limits(),
        p.cost.limits(),
        p.motion.iter().flat_map(|motion| motion.limits()).collect(),
        p.heat.iter().flat_map(|heat| heat.limits()).collect(),
        p.material.iter().flat_map(|material| material.limits()).collect(),
        p.substrate.iter().flat_map(|substrate| substrate.limits()).collect(),
        p.interpass.iter().flat_map(|interpass| interpass.limits()).collect(),
    ];
    general.into_iter().flatten().chain(p.dialects.iter().flat_map(|section| section.limits())).collect()
}

fn contradiction(p: &Profile) -> Option<Broken> {
    let fill = &p.fill;
    match (fill.overlap.ratio(), fill.stepover) {
        (Some(_), Some(stepover)) => {
            let reason = "it may be given only with overlap = \"free\".".to_owned();
            return Some(Broken { key: "fill.stepover".to_owned(), value: format!("{stepover}"), reason });
        }
        (None, None) => return Some(Broken::text("fill.overlap", "free", "fill.stepover must then be given, mm.")),
        _ => {}
    }
    if let (thin, thick) = p.layers.window()
        && thin >= thick
    {
        let (key, value, reason) = match p.layers.min_height {
            Some(_) => ("layers.min_height", thin, format!("must be less than layers.max_height ({thick} mm).")),
            None => ("layers.max_height", thick, format!("must be more than layers.min_height ({thin} mm).")),
        };
        return Some(Broken { key: key.to_owned(), value: value.to_string(), reason });
    }
    if let (Some(_), Err(lacks)) = (&p.bead.by_heat, p.heat_settings()) {
        let reason = lacks.to_string();
        return Some(Broken { key: "bead.by_heat".to_owned(), value: "a law".to_owned(), reason });
    }
    if let (Some(_), Err(lacks)) = (&p.interpass, p.heat_settings()) {
        let reason = lacks.to_string();
        return Some(Broken { key: "interpass".to_owned(), value: "a limit".to_owned(), reason });
    }
    if let (Some(limits), Some(heat)) = (&p.interpass, &p.heat)
        && limits.max_temperature < heat.ambient + 10.0
    {
        let (key, value) = ("interpass.max_temperature".to_owned(), limits.max_temperature.to_string());
        let reason = format!("no part cools that far: its surroundings are at {} °C (heat.ambient).", heat.ambient);
        return Some(Broken { key, value, reason });
    }
    if let Some(limits) = &p.interpass {
        let preheat = p.substrate.as_ref().and_then(|plate| plate.preheat);
        let colder = preheat.filter(|preheat| *preheat > limits.max_temperature).map(|_| "substrate.preheat");
        let least = limits.min_temperature.filter(|least| *least >= limits.max_temperature);
        if let Some(other) = colder.or(least.map(|_| "interpass.min_temperature")) {
            let (key, value) = ("interpass.max_temperature".to_owned(), limits.max_temperature.to_string());
            return Some(Broken { key, value, reason: format!("{other} is not below it.") });
        }
    }
    let factors = [("cost.energy_kwh", p.cost.energy_kwh), ("cost.co2_kwh", p.cost.co2_kwh)];
    if let Some((key, value)) = factors.into_iter().find(|(_, value)| *value > 0.0)
        && p.heat_input().is_none()
    {
        let reason = "energy is known only with process.current and process.voltage: give both.".to_owned();
        return Some(Broken { key: key.to_owned(), value: value.to_string(), reason });
    }
    if let (Some(spot), Some(_)) = (&p.spot, &p.weave) {
        let reason = "the torch stands still for a dot, so [spot] cannot be combined with [weave].".to_owned();
        return Some(Broken { key: "spot.time".to_owned(), value: spot.time.to_string(), reason });
    }
    if let (Some(spot), Follow::WireFeed) = (&p.spot, p.process.follow) {
        let reason = "the size of a dot depends on its time, so process.follow must be \"speed\".".to_owned();
        return Some(Broken { key: "spot.time".to_owned(), value: spot.time.to_string(), reason });
    }
    if p.wall.helix {
        let rows = [("start_stop.layers", p.start_stop.layers.len())];
        let weaves = ("weave.layers", p.weave.as_ref().map_or(0, |weave| weave.layers.len()));
        if let Some((key, count)) = rows.into_iter().chain([weaves]).find(|(_, count)| *count > 0) {
            let reason =
                "the turns of a helix are one pass, which begins and ends once: leave out the rows, or wall.helix.";
            let reason = reason.to_owned();
            return Some(Broken { key: key.to_owned(), value: format!("{count} rows"), reason });
        }
    }
    if let Some(post) = p.posts.iter().find(|post| !own::is_folder(post) && dialect::find(post).is_none()) {
        return Some(Broken::text("posts", post, format!("the posts are {}.", dialect::names().join(", "))));
    }
    let sections = p
        .process
        .broken()
        .or_else(|| p.start_stop.broken())
        .or_else(|| p.weave.as_ref()?.broken())
        .or_else(|| p.safety.broken())
        .or_else(|| p.program.broken());
    sections.or_else(|| p.dialects.iter().find_map(|section| section.broken(&p.program)))
}

/// Templates may use known placeholders and printable ASCII only: controllers read nothing else.
fn bad_template(p: &Profile) -> Option<Broken> {
    let templates = p.dialects.templates();
    let mut lines = templates.flat_map(|(key, lines)| lines.iter().map(move |line| (key.clone(), line)));
    lines.find_map(|(key, line)| {
        let known = PLACEHOLDERS.map(|(name, _)| name);
        let reason = match template::unknown_placeholder(line, &known) {
            Some(name) => format!("{{{{{name}}}}} is not a placeholder; the placeholders are {}.", known.join(", ")),
            None if !line.bytes().all(|b| b.is_ascii_graphic() || b == b' ') => {
                "a line of a template may hold printable ASCII characters only.".to_owned()
            }
            None => return None,
        };
        Some(Broken::text(&key, line, reason))
    })
}
