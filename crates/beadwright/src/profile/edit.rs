//! Changes values in the text of a profile; its comments and its order are kept.

use super::{Body, Profile, ProfileError};
use serde::Serialize;
use toml_edit::{ArrayOfTables, DocumentMut, Item, Table, Value};

/// The text of a profile with one value set, such as `45` for `fill.raster_angle`; a value that is not TOML is treated as
/// text. In a list, the place of an element, from 0, is a part of the key: `program.positioner.axes.0.speed`. The only check
/// is that the key can be placed there; [`Profile::parse`] checks the rest.
///
/// ```
/// use beadwright::profile::edit::with_value;
///
/// let text = "[bead]\nwidth = 4.5  # mm\n";
/// assert_eq!(with_value(text, "bead.width", "5.0")?, "[bead]\nwidth = 5.0  # mm\n");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`ProfileError::Key`] for a key inside a value that is not a table, [`ProfileError::Text`] if the text is not TOML.
pub fn with_value(text: &str, key: &str, value: &str) -> Result<String, ProfileError> {
    let mut document = document(text)?;
    let mut value: Value = value.trim().parse().unwrap_or_else(|_| value.trim().into());
    let parts: Vec<&str> = key.trim().split('.').collect();
    let mut item = document.as_item_mut();
    for (i, part) in parts.iter().enumerate() {
        if let Ok(index) = part.parse::<usize>() {
            let is_list = item.is_array() || item.is_array_of_tables();
            let element = if is_list { item.get_mut(index) } else { None };
            item = element.ok_or_else(|| ProfileError::Key { key: key.to_owned() })?;
            continue;
        }
        let table = item.as_table_like_mut().ok_or_else(|| ProfileError::Key { key: key.to_owned() })?;
        // A section whose keys all have defaults may be missing.
        let missing = if i + 1 < parts.len() { Item::Table(Table::new()) } else { Item::None };
        item = table.entry(part).or_insert(missing);
    }
    // What follows the old value, usually a comment, is kept after the new one.
    if let Some(old) = item.as_value() {
        *value.decor_mut() = old.decor().clone();
    }
    *item = Item::Value(value);
    Ok(document.to_string())
}

/// The text of a profile with a value removed, so that its default applies.
///
/// # Errors
/// [`ProfileError::Text`] if the text is not TOML.
pub fn without_value(text: &str, key: &str) -> Result<String, ProfileError> {
    let mut document = document(text)?;
    let (section, name) = key.rsplit_once('.').unwrap_or(("", key));
    let mut sections = section.split('.').filter(|part| !part.is_empty());
    let holder = sections.try_fold(document.as_item_mut(), |item, part| item.get_mut(part));
    if let Some(table) = holder.and_then(Item::as_table_like_mut) {
        table.remove(name);
    }
    Ok(document.to_string())
}

/// The text of a profile with these bodies in place of those it has, as tables `[[layers.bodies]]`; without bodies the part is
/// welded as one.
///
/// ```
/// use beadwright::chart::Chart;
/// use beadwright::profile::{Body, edit::with_bodies};
///
/// let text = with_bodies("[layers]\nheight = 2.0\n", &[Body::of("trunk", Chart::default())])?;
/// assert_eq!(text, "[layers]\nheight = 2.0\n\n[[layers.bodies]]\nname = \"trunk\"\n");
/// assert_eq!(with_bodies(&text, &[])?, "[layers]\nheight = 2.0\n");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`ProfileError::Key`] if `layers` is not a table of its own, [`ProfileError::Text`] if the text is not TOML.
pub fn with_bodies(text: &str, bodies: &[Body]) -> Result<String, ProfileError> {
    #[derive(Serialize)]
    struct File<'a> {
        body: &'a [Body],
    }

    let mut document = document(&without_value(text, "layers.bodies")?)?;
    if bodies.is_empty() {
        return Ok(document.to_string());
    }
    let wrong = || ProfileError::Key { key: "layers.bodies".to_owned() };
    let written = toml::to_string(&File { body: bodies }).map_err(|_| wrong())?;
    let written = self::document(&written)?;
    let tables = written["body"].as_array_of_tables().ok_or_else(wrong)?;
    let layers = document.entry("layers").or_insert(Item::Table(Table::new()));
    let mut own = ArrayOfTables::new();
    // Without the places that they have in their own text, they follow the section.
    for table in tables {
        let mut table = table.clone();
        table.set_position(None);
        table.decor_mut().clear();
        own.push(table);
    }
    layers.as_table_mut().ok_or_else(wrong)?.insert("bodies", Item::ArrayOfTables(own));
    Ok(document.to_string())
}

fn document(text: &str) -> Result<DocumentMut, ProfileError> {
    text.parse().map_err(|_| match Profile::parse(text) {
        Err(error) => error,
        Ok(_) => ProfileError::Text { line: 1, reason: "the text cannot be edited.".to_owned() },
    })
}
