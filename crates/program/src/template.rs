//! Templates of the profiles: lines with `{{placeholders}}`.

/// Text and placeholders in turn.
fn parts(template: &str) -> impl Iterator<Item = (&str, Option<&str>)> {
    template.split("{{").enumerate().map(|(i, part)| match part.split_once("}}") {
        Some((name, text)) if i > 0 => (text, Some(name.trim())),
        _ => (part, None),
    })
}

/// Replaces every placeholder with its value; one without a value becomes nothing (profiles are checked for that).
///
/// ```
/// use bead_program::template::expand;
///
/// let values = [("gas_preflow", "0.5".to_owned())];
/// assert_eq!(expand("WAIT SEC {{gas_preflow}}", &values), "WAIT SEC 0.5");
/// ```
pub fn expand(template: &str, values: &[(&str, String)]) -> String {
    let value = |name: &str| values.iter().find(|(known, _)| *known == name).map(|(_, v)| v.as_str());
    parts(template).fold(String::new(), |mut line, (text, name)| {
        line.push_str(name.and_then(value).unwrap_or_default());
        line.push_str(text);
        line
    })
}

/// The first placeholder that is not among the known ones.
///
/// ```
/// use bead_program::template::unknown_placeholder;
///
/// assert_eq!(unknown_placeholder("G4 P{{dwell}}", &["dwell"]), None);
/// assert_eq!(unknown_placeholder("G4 P{{dwel}}", &["dwell"]), Some("dwel"));
/// ```
pub fn unknown_placeholder<'a>(template: &'a str, known: &[&str]) -> Option<&'a str> {
    let open = template.rfind("{{").filter(|&at| !template[at..].contains("}}"));
    let unknown = parts(template).find_map(|(_, name)| name.filter(|n| !known.contains(n)));
    unknown.or_else(|| open.map(|at| &template[at + 2..]))
}

/// Whether a template has a placeholder.
pub fn has_placeholder(template: &str) -> bool {
    parts(template).any(|(_, name)| name.is_some())
}
