//! The profile as a form: fields from the schema, so that a new key of the library appears by itself.

use beadwright::limit::Limit;
use beadwright::profile::Profile;
use serde_json::Value;
use std::sync::OnceLock;

/// What a field holds.
#[derive(Debug, Clone, PartialEq)]
pub enum Kind {
    /// A number, whole or decimal.
    Number {
        /// Whether it is a whole number.
        whole: bool,
    },
    /// A line of text.
    Text,
    /// Lines of a template.
    Lines,
    /// Yes or no.
    Switch,
    /// One of several words, each with its meaning.
    Choice(Vec<(String, String)>),
    /// A fixed number of numbers.
    Numbers(usize),
}

/// A key of the profile.
#[derive(Debug, Clone, PartialEq)]
pub struct Field {
    /// Full key: `fill.raster_angle`.
    pub key: String,
    /// Its last part: `raster_angle`.
    pub name: String,
    /// What it is, with its unit.
    pub about: String,
    /// What it holds.
    pub kind: Kind,
    /// Whether it may be left out.
    pub optional: bool,
}

/// A section of the profile.
#[derive(Debug, Clone, PartialEq)]
pub struct Section {
    /// `fill`; empty for keys at the top.
    pub key: String,
    /// What it is.
    pub about: String,
    /// Its keys.
    pub fields: Vec<Field>,
}

/// All sections, the most frequently changed ones first.
pub fn sections() -> &'static [Section] {
    static SECTIONS: OnceLock<Vec<Section>> = OnceLock::new();
    SECTIONS.get_or_init(|| read(&Profile::schema()))
}

/// The keys shown before all others: those that change a part the most.
pub const BASIC: [&str; 10] = [
    "fill.strategy",
    "layers.height",
    "bead.width",
    "process.wire_feed_speed",
    "process.deposition_speed",
    "fill.perimeters",
    "fill.raster_angle",
    "fill.machining_allowance",
    "start_stop.interpass_time",
    "travel.speed",
];

/// The field of a key.
pub fn field(key: &str) -> Option<&'static Field> {
    sections().iter().flat_map(|section| &section.fields).find(|field| field.key == key)
}

/// The sections that come first; the others follow by name.
const FIRST: [&str; 13] = [
    "fill",
    "bead",
    "layers",
    "process",
    "wire",
    "order",
    "loop",
    "hybrid",
    "wall",
    "travel",
    "program",
    "start_stop",
    "check",
];

fn read(schema: &Value) -> Vec<Section> {
    let defs = &schema["$defs"];
    let mut top = Section { key: String::new(), about: String::new(), fields: Vec::new() };
    let mut sections = Vec::new();
    for (key, property) in schema["properties"].as_object().into_iter().flatten() {
        match definition(property, defs) {
            Some(definition) if definition["properties"].is_object() => {
                sections.extend(section(key, definition, text(property, "description"), defs));
            }
            _ => top.fields.extend(field_of(key, key, property, false, defs)),
        }
    }
    let rank = |section: &Section| FIRST.iter().position(|f| *f == section.key).unwrap_or(FIRST.len());
    sections.sort_by_key(rank);
    sections.push(top);
    sections
}

/// A section and its subsections.
fn section(key: &str, definition: &Value, about: String, defs: &Value) -> Vec<Section> {
    let (mut fields, mut inner) = (Vec::new(), Vec::new());
    let required: Vec<&str> =
        definition["required"].as_array().into_iter().flatten().filter_map(Value::as_str).collect();
    let place = |name: &str| required.iter().position(|r| *r == name).unwrap_or(required.len());
    let mut properties: Vec<_> = definition["properties"].as_object().into_iter().flatten().collect();
    properties.sort_by_key(|(name, _)| place(name));
    for (name, property) in properties {
        let full = format!("{key}.{name}");
        match self::definition(property, defs) {
            Some(found) if found["properties"].is_object() => {
                inner.extend(section(&full, found, text(property, "description"), defs));
            }
            _ => fields.extend(field_of(&full, name, property, !required.contains(&name.as_str()), defs)),
        }
    }
    [vec![Section { key: key.to_owned(), about, fields }], inner].concat()
}

fn field_of(key: &str, name: &str, property: &Value, optional: bool, defs: &Value) -> Option<Field> {
    let kind = kind(property, defs)?;
    Some(Field {
        key: key.to_owned(),
        name: name.to_owned(),
        about: text(property, "description").replace('`', ""),
        kind,
        optional,
    })
}

fn kind(property: &Value, defs: &Value) -> Option<Kind> {
    if let Some(definition) = definition(property, defs) {
        let choices = definition["oneOf"].as_array()?.iter();
        let word = |c: &Value| Some((c["const"].as_str()?.to_owned(), text(c, "description").replace('`', "")));
        return Some(Kind::Choice(choices.filter_map(word).collect()));
    }
    if let Some(words) = property["enum"].as_array() {
        return Some(Kind::Choice(
            words.iter().filter_map(|w| Some((w.as_str()?.to_owned(), String::new()))).collect(),
        ));
    }
    let kinds = match &property["type"] {
        Value::Array(kinds) => kinds.iter().filter_map(Value::as_str).collect(),
        kind => Vec::from_iter(kind.as_str()),
    };
    match kinds.first().copied()? {
        "number" => Some(Kind::Number { whole: false }),
        "integer" => Some(Kind::Number { whole: true }),
        "boolean" => Some(Kind::Switch),
        "string" => Some(Kind::Text),
        "array" if property["items"]["type"] == "string" => Some(Kind::Lines),
        "array" => Some(Kind::Numbers(property["maxItems"].as_u64()? as usize)),
        _ => None,
    }
}

/// The definition that a property refers to, even if the property is optional.
fn definition<'a>(property: &Value, defs: &'a Value) -> Option<&'a Value> {
    let any = property["anyOf"].as_array().and_then(|any| any.first()).unwrap_or(property);
    let name = any["$ref"].as_str()?.rsplit('/').next()?;
    defs.get(name)
}

fn text(value: &Value, key: &str) -> String {
    value[key].as_str().unwrap_or_default().to_owned()
}

/// A profile, with what the form needs from it.
pub struct Parsed {
    /// Its text.
    pub text: String,
    /// The profile.
    pub profile: Profile,
    /// Its values, with all defaults filled in.
    pub values: toml::Table,
    /// The limits of its numbers.
    pub limits: Vec<Limit>,
}

impl Parsed {
    /// Reads the text of a profile; `None` if it cannot be read.
    pub fn of(text: &str) -> Option<Self> {
        let profile = Profile::parse(text).ok()?;
        let (values, limits) = (toml::Table::try_from(&profile).ok()?, profile.limits());
        Some(Self { text: text.to_owned(), profile, values, limits })
    }
}

/// The value of a key, defaults included; `None` if it is left out.
pub fn value(profile: &toml::Table, key: &str) -> Option<toml::Value> {
    let mut parts = key.split('.');
    let first = profile.get(parts.next()?)?;
    parts.try_fold(first, |value, part| value.get(part)).cloned()
}

/// The limit of a key.
pub fn limit<'a>(limits: &'a [Limit], key: &str) -> Option<&'a Limit> {
    limits.iter().find(|limit| limit.key == key)
}
