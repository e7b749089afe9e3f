//! Tables as CSV: what separates their fields, and the units in the names of their columns.

/// Endings of column names, and the units they mean; longer ones first.
const UNITS: [(&str, &str); 18] = [
    ("_mm_min", "mm/min"),
    ("_cm_min", "cm/min"),
    ("_m_min", "m/min"),
    ("_l_min", "l/min"),
    ("_mm_s", "mm/s"),
    ("_j_mm", "J/mm"),
    ("_percent", "%"),
    ("_deg", "°"),
    ("_mm", "mm"),
    ("_cm", "cm"),
    ("_kw", "kW"),
    ("_hz", "Hz"),
    ("_ms", "ms"),
    ("_a", "A"),
    ("_v", "V"),
    ("_w", "W"),
    ("_c", "°C"),
    ("_s", "s"),
];

/// What separates the fields of a table with this header.
pub fn separator(header: &str) -> char {
    ['\t', ';'].into_iter().find(|s| header.contains(*s)).unwrap_or(',')
}

/// The name of a column in lower case, and its unit: `current_a` and `current (A)` both are `current` in A.
///
/// ```
/// use bead_part::text::table::name_and_unit;
///
/// assert_eq!(name_and_unit("Arc current (A)"), ("arc_current".to_owned(), "A".to_owned()));
/// assert_eq!(name_and_unit("wire_feed_speed_m_min"), ("wire_feed_speed".to_owned(), "m/min".to_owned()));
/// ```
pub fn name_and_unit(field: &str) -> (String, String) {
    let field = field.trim();
    if let Some((name, rest)) = field.split_once(['(', '[']) {
        let name = name.trim().to_lowercase().replace([' ', '-'], "_");
        return (name, rest.trim_end_matches([')', ']']).trim().to_owned());
    }
    let lower = field.to_lowercase().replace([' ', '-'], "_");
    let found = UNITS.iter().find_map(|(end, unit)| lower.strip_suffix(end).map(|name| (name.to_owned(), *unit)));
    found.filter(|(name, _)| !name.is_empty()).map_or((lower.clone(), String::new()), |(n, u)| (n, u.to_owned()))
}
