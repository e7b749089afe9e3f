//! TOML as people write it: the line of a key, and what a parser's message means.

/// The number, from 1, of the line that contains a byte of a text.
pub fn line_of(text: &str, byte: usize) -> usize {
    text.as_bytes().iter().take(byte).filter(|b| **b == b'\n').count() + 1
}

/// The number of the line with a key such as `bead.width`.
///
/// ```
/// use bead_part::text::toml::line_of_key;
///
/// let text = "name = \"ours\"\n[bead]\nwidth = 6.0\nheight = 2.0\n";
/// assert_eq!(line_of_key(text, "bead.height"), 4);
/// ```
pub fn line_of_key(text: &str, key: &str) -> usize {
    let Ok(root) = toml::de::DeTable::parse(text) else { return 1 };
    let (mut table, mut at) = (Some(root.get_ref()), 0);
    for part in key.split('.') {
        let Some((key, value)) = table.and_then(|t| t.iter().find(|(k, _)| k.get_ref() == part)) else { break };
        at = key.span().start;
        table = value.get_ref().as_table();
    }
    line_of(text, at)
}

/// Turns the parser's message into a sentence and suggests the nearest of the words it expected.
///
/// ```
/// use bead_part::text::toml::explain;
///
/// let message = "unknown field `widht`, expected `width` or `height`";
/// assert_eq!(explain(message), "unknown key \"widht\". Did you mean \"width\"?");
/// ```
pub fn explain(message: &str) -> String {
    let mut quoted = message.split('`').skip(1).step_by(2);
    if message.starts_with("unknown field") || message.starts_with("unknown variant") {
        let (kind, got) =
            (if message.starts_with("unknown field") { "key" } else { "value" }, quoted.next().unwrap_or(""));
        let known: Vec<&str> = quoted.collect();
        return match nearest(got, known.iter().copied()) {
            Some(near) => format!("unknown {kind} \"{got}\". Did you mean \"{near}\"?"),
            None => format!("unknown {kind} \"{got}\". Possible here: {}.", known.join(", ")),
        };
    }
    if message.starts_with("missing field") {
        return format!("the key \"{}\" is missing here.", quoted.next().unwrap_or(""));
    }
    let end = if message.ends_with(['.', '?']) { "" } else { "." };
    format!("{message}{end}")
}

/// The most similar of the known words, if any is similar enough.
pub fn nearest<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let scored = known.into_iter().map(|k| (strsim::jaro_winkler(word, k), k));
    scored.filter(|(score, _)| *score > 0.75).max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, k)| k)
}
