//! Numbers, names and patterns.

/// A finite number.
pub(in crate::dialect) fn number(text: &str) -> Option<f64> {
    text.trim().parse().ok().filter(|v: &f64| v.is_finite())
}

fn in_name(c: char) -> bool {
    c.is_ascii_alphanumeric() || c == '_'
}

/// The text after `word` (in any case) at the start, trimmed, if the word ends there.
pub(in crate::dialect) fn strip_word<'a>(text: &'a str, word: &str) -> Option<&'a str> {
    let (head, rest) = text.split_at_checked(word.len())?;
    (head.eq_ignore_ascii_case(word) && !rest.starts_with(in_name)).then(|| rest.trim_start())
}

/// A condition without a trailing word (in any case) such as THEN or DO.
pub(in crate::dialect) fn without_end<'a>(condition: &'a str, word: &str) -> &'a str {
    let end = condition.len().checked_sub(word.len()).filter(|at| {
        let bounded = condition.get(..*at).is_some_and(|before| !before.ends_with(in_name));
        bounded && condition[*at..].eq_ignore_ascii_case(word)
    });
    end.map_or(condition, |at| condition[..at].trim_end())
}

/// A line without its scope word (`GLOBAL` or `LOCAL`).
pub(in crate::dialect) fn unscoped(line: &str) -> &str {
    ["GLOBAL", "LOCAL"].iter().find_map(|scope| strip_word(line, scope)).unwrap_or(line)
}

/// Whether a text begins with one of the words, in any case.
pub(in crate::dialect) fn begins_with(text: &str, words: &[&str]) -> bool {
    words.iter().any(|word| strip_word(text, word).is_some())
}

/// The name at the start of the text (letters, digits, `_`; may be empty) and the trimmed rest.
pub(in crate::dialect) fn name(text: &str) -> (&str, &str) {
    let end = text.find(|c| !in_name(c)).unwrap_or(text.len());
    (&text[..end], text[end..].trim_start())
}

/// The text without blanks, in upper case.
pub(in crate::dialect) fn compact(text: &str) -> String {
    text.chars().filter(|c| !c.is_whitespace()).map(|c| c.to_ascii_uppercase()).collect()
}

/// The text before a comment sign outside quotes.
pub(in crate::dialect) fn before_comment(line: &str, sign: char) -> &str {
    let mut quoted = false;
    let found = line.find(|c| {
        quoted ^= c == '"';
        c == sign && !quoted
    });
    &line[..found.unwrap_or(line.len())]
}

/// The pieces between commas, trimmed; commas inside brackets or quotes do not separate.
pub(in crate::dialect) fn arguments(text: &str) -> Vec<&str> {
    let (mut depth, mut quoted, mut start, mut pieces) = (0, false, 0, Vec::new());
    for (i, b) in text.bytes().enumerate() {
        match b {
            b'"' => quoted = !quoted,
            _ if quoted => {}
            b'(' | b'[' | b'{' => depth += 1,
            b')' | b']' | b'}' => depth -= 1,
            b',' if depth <= 0 => {
                pieces.push(text[start..i].trim());
                start = i + 1;
            }
            _ => {}
        }
    }
    pieces.push(text[start..].trim());
    pieces
}

/// Statements that switch something, without blanks and in upper case.
pub(in crate::dialect) struct Patterns(Vec<String>);

impl Patterns {
    pub(in crate::dialect) fn new(patterns: &[String]) -> Self {
        Self(patterns.iter().map(|p| compact(p)).filter(|p| !p.is_empty()).collect())
    }

    /// Whether a compact statement contains one of them, but not as part of a longer name or number.
    pub(in crate::dialect) fn matches(&self, statement: &str) -> bool {
        self.0.iter().any(|pattern| {
            let whole = |at: usize| {
                let before = statement[..at].ends_with(in_name) && pattern.starts_with(in_name);
                let after = statement[at + pattern.len()..].starts_with(in_name) && pattern.ends_with(in_name);
                !before && !after
            };
            statement.match_indices(pattern.as_str()).any(|(at, _)| whole(at))
        })
    }
}
