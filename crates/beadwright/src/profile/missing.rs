//! All keys that a profile lacks, not only the first: each is given a stand-in that fits, until nothing is missing.

use serde::de::DeserializeOwned;
use std::borrow::Cow;
use std::collections::BTreeMap;
use toml::Spanned;
use toml::de::{DeTable, DeValue, Deserializer};

/// Values that a key may accept, tried in this order; arrays have the lengths found in profiles.
const STAND_INS: [&str; 10] = ["1", "''", "false", "[]", "{}", "[1]", "[1,1]", "[1,1,1]", "[1,1,1,1]", "[1,1,1,1,1,1]"];

/// More attempts than any profile needs.
const MOST_ATTEMPTS: usize = 5000;

/// The full names of the keys that `T` requires and the table lacks. If another fault is met, those found before it.
pub(super) fn missing<T: DeserializeOwned>(table: DeTable<'_>) -> Vec<String> {
    let mut trial = Trial::of(table);
    for _ in 0..MOST_ATTEMPTS {
        let Err(error) = T::deserialize(Deserializer::from(trial.root.clone())) else { break };
        let Some(id) = error.span().map(|span| span.start) else { break };
        let word = error.message().split('`').nth(1).unwrap_or_default();
        let goes_on = if error.message().starts_with("missing field") {
            trial.add(id, word)
        } else if error.message().starts_with("unknown variant") {
            let first = error.message().split('`').nth(3).unwrap_or_default();
            trial.replace(id, DeValue::String(Cow::Owned(first.to_owned())))
        } else {
            trial.next(id)
        };
        if !goes_on {
            break;
        }
    }
    trial.lacks
}

/// A table whose values are numbered by their spans, so that an error shows which of them it is about.
struct Trial<'a> {
    root: Spanned<DeTable<'a>>,
    /// Full names by number.
    names: BTreeMap<usize, String>,
    /// Which stand-in is tried, by number.
    tried: BTreeMap<usize, usize>,
    lacks: Vec<String>,
}

impl<'a> Trial<'a> {
    const ROOT: usize = 0;

    fn of(mut table: DeTable<'a>) -> Self {
        let mut names = BTreeMap::from([(Self::ROOT, String::new())]);
        number_table(&mut table, "", &mut names);
        Self { root: Spanned::new(Self::ROOT..1, table), names, tried: BTreeMap::new(), lacks: Vec::new() }
    }

    /// Adds the first stand-in for a key that a table lacks.
    fn add(&mut self, table: usize, key: &str) -> bool {
        let (Some(section), id) = (self.names.get(&table), self.names.len()) else { return false };
        let name = joined(section, key);
        // The section is named by its keys.
        let section = section.clone();
        self.lacks.retain(|lack| *lack != section);
        let Some(holder) = self.table(table) else { return false };
        holder.insert(Spanned::new(id..id + 1, Cow::Owned(key.to_owned())), stand_in(0, id));
        self.names.insert(id, name.clone());
        self.tried.insert(id, 0);
        self.lacks.push(name);
        true
    }

    /// Puts the next stand-in in the place of one that does not fit; false for a value of the profile itself.
    fn next(&mut self, id: usize) -> bool {
        let Some(tried) = self.tried.get_mut(&id).filter(|tried| **tried + 1 < STAND_INS.len()) else { return false };
        *tried += 1;
        let value = stand_in(*tried, id).into_inner();
        self.replace(id, value)
    }

    fn replace(&mut self, id: usize, value: DeValue<'a>) -> bool {
        let found = self.root.get_mut().iter_mut().find_map(|(_, inner)| find(inner, id));
        match found.filter(|_| self.tried.contains_key(&id)) {
            None => false,
            Some(place) => {
                *place.get_mut() = value;
                true
            }
        }
    }

    fn table(&mut self, id: usize) -> Option<&mut DeTable<'a>> {
        if id == Self::ROOT {
            return Some(self.root.get_mut());
        }
        match self.root.get_mut().iter_mut().find_map(|(_, inner)| find(inner, id))?.get_mut() {
            DeValue::Table(table) => Some(table),
            _ => None,
        }
    }
}

fn joined(section: &str, key: &str) -> String {
    if section.is_empty() { key.to_owned() } else { format!("{section}.{key}") }
}

fn number_table(table: &mut DeTable<'_>, name: &str, names: &mut BTreeMap<usize, String>) {
    for (key, value) in table.iter_mut() {
        number(value, joined(name, key.get_ref()), names);
    }
}

fn number(value: &mut Spanned<DeValue<'_>>, name: String, names: &mut BTreeMap<usize, String>) {
    let id = names.len();
    names.insert(id, name.clone());
    match value.get_mut() {
        DeValue::Table(table) => number_table(table, &name, names),
        DeValue::Array(array) => array.iter_mut().for_each(|inner| number(inner, name.clone(), names)),
        _ => {}
    }
    respan(value, id);
}

/// Moves a value to the span of its number.
fn respan(value: &mut Spanned<DeValue<'_>>, id: usize) {
    let own = std::mem::replace(value.get_mut(), DeValue::Boolean(false));
    *value = Spanned::new(id..id + 1, own);
}

fn find<'t, 'a>(value: &'t mut Spanned<DeValue<'a>>, id: usize) -> Option<&'t mut Spanned<DeValue<'a>>> {
    if value.span().start == id {
        return Some(value);
    }
    match value.get_mut() {
        DeValue::Table(table) => table.iter_mut().find_map(|(_, inner)| find(inner, id)),
        DeValue::Array(array) => array.iter_mut().find_map(|inner| find(inner, id)),
        _ => None,
    }
}

/// A stand-in, all of it with the span of its number.
fn stand_in(index: usize, id: usize) -> Spanned<DeValue<'static>> {
    let parsed = DeValue::parse(STAND_INS[index]).map_or(DeValue::Boolean(false), Spanned::into_inner);
    let mut value = Spanned::new(id..id + 1, parsed);
    if let DeValue::Array(array) = value.get_mut() {
        array.iter_mut().for_each(|inner| respan(inner, id));
    }
    value
}
