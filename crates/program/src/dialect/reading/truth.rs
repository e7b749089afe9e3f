//! Conditions combined with OR, AND, NOT and brackets.

use super::words::strip_word;

/// Whether a condition holds, if that follows from those of its parts that `part` can evaluate.
pub(in crate::dialect) fn truth(condition: &str, part: &impl Fn(&str) -> Option<bool>) -> Option<bool> {
    let condition = condition.trim();
    for (word, decides) in [("or", true), ("and", false)] {
        let parts = split(condition, word);
        if parts.len() > 1 {
            let known: Vec<Option<bool>> = parts.into_iter().map(|inner| truth(inner, part)).collect();
            let all = || known.iter().all(|known| *known == Some(!decides)).then_some(!decides);
            return known.contains(&Some(decides)).then_some(decides).or_else(all);
        }
    }
    if let Some(rest) = strip_word(condition, "not") {
        return truth(rest, part).map(|holds| !holds);
    }
    let inside = condition.strip_prefix('(').and_then(|rest| rest.strip_suffix(')'));
    inside.map_or_else(|| part(condition), |inside| truth(inside, part))
}

/// The parts of a condition between occurrences of a word outside brackets.
fn split<'a>(condition: &'a str, word: &str) -> Vec<&'a str> {
    let (mut parts, mut depth, mut start) = (Vec::new(), 0, 0);
    for (at, c) in condition.char_indices() {
        match c {
            '(' | '[' => depth += 1,
            ')' | ']' => depth -= 1,
            _ => {}
        }
        let begins = condition[..at].ends_with([' ', ')', ']']);
        if depth == 0 && begins && strip_word(&condition[at..], word).is_some() {
            parts.push(&condition[start..at]);
            start = at + word.len();
        }
    }
    parts.push(&condition[start..]);
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_condition_follows_from_the_parts_that_are_known() {
        let part = |part: &str| match part.trim() {
            "$IN[1]" | "get_in(0)" => Some(true),
            "late" | "i <= (2)" => Some(false),
            _ => None,
        };
        for (condition, holds) in [
            ("$IN[1]", Some(true)),
            ("NOT $IN[1]", Some(false)),
            ("NOT ($IN[1] AND $OUT[1])", None),
            ("NOT ($IN[1] AND NOT late)", Some(false)),
            ("(x > 3) OR NOT late", Some(true)),
            ("late OR x", None),
            ("late or late", Some(false)),
            ("late and x or get_in(0)", Some(true)),
            ("(late) and (x)", Some(false)),
            ("not(get_in(0))and(x)", Some(false)),
            ("i <= (2) or notlate", None),
        ] {
            assert_eq!(truth(condition, &part), holds, "{condition}");
        }
    }
}
