//! A source: a broker or a server, and what is wanted of it, from TOML.

use crate::error::ListenError;
use bead_record::Quantity;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// What is listened to, and what becomes of it in the log.
#[derive(Debug, Clone)]
pub struct Source {
    /// Name of the log, without `.csv`.
    pub name: String,
    /// Address of the broker or server.
    pub url: String,
    pub(crate) address: Address,
    /// The name under which a broker keeps messages for us.
    pub(crate) client: String,
    /// Name and password.
    pub(crate) user: Option<(String, String)>,
    /// Where messages carry their time.
    pub(crate) time: Option<Time>,
    /// A topic without messages for this long is reported, s.
    pub(crate) silent: f64,
    /// How often a server should look at its values, ms.
    pub(crate) sampling: f64,
    /// The columns of the log after its time, in order: `event` and `note` first.
    pub(crate) columns: Vec<Column>,
}

/// The protocol.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Address {
    Mqtt { host: String, port: u16 },
    OpcUa,
}

/// A column of the log.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Column {
    pub(crate) name: String,
    /// With its unit, as the log has it.
    pub(crate) title: String,
    /// Topic or node; none for a column that only the listener fills.
    pub(crate) from: Option<String>,
    /// Where the value is in a message.
    pub(crate) field: Option<String>,
}

impl Column {
    /// Whether it holds words rather than numbers.
    pub(crate) fn is_text(&self) -> bool {
        WORDS.contains(&self.name.as_str())
    }
}

/// Where messages carry their time, and how.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Time {
    pub(crate) field: String,
    pub(crate) unit: TimeUnit,
}

/// How a time is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum TimeUnit {
    Iso,
    /// Seconds since 1970.
    Unix,
    UnixMs,
    /// Since the device was switched on.
    S,
    Ms,
    Us,
}

/// Columns of words, which every log has.
const WORDS: [&str; 2] = ["event", "note"];
/// The name of the column with the times.
pub(crate) const TIME: &str = "time";

const SILENT: f64 = 10.0;
const SAMPLING: f64 = 50.0;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Keys {
    url: String,
    client: Option<String>,
    user: Option<String>,
    password_file: Option<PathBuf>,
    time: Option<Time>,
    silent: Option<f64>,
    sampling: Option<f64>,
    columns: BTreeMap<String, ColumnKeys>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ColumnKeys {
    unit: Option<String>,
    topic: Option<String>,
    node: Option<String>,
    field: Option<String>,
}

impl Source {
    /// Reads a source; its log has the name of the file.
    ///
    /// # Errors
    /// [`ListenError::Source`], which names the key.
    pub fn read(path: &Path) -> Result<Self, ListenError> {
        let error = |reason: String| ListenError::Source { path: path.to_owned(), reason };
        let text = fs::read_to_string(path).map_err(|why| error(why.to_string()))?;
        let keys: Keys = toml::from_str(&text).map_err(|why| error(why.to_string()))?;
        let password = |file: &PathBuf| {
            let file = path.parent().unwrap_or(Path::new("")).join(file);
            let text = fs::read_to_string(&file);
            text.map_err(|why| format!("password_file = {}: {why}", file.display()))
        };
        let secret = keys.password_file.as_ref().map(password).transpose().map_err(error)?;
        let name = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
        Self::of(name, keys, secret).map_err(error)
    }

    fn of(name: String, keys: Keys, secret: Option<String>) -> Result<Self, String> {
        let address = address(&keys.url)?;
        let user = match (keys.user, secret) {
            (None, Some(_)) => return Err("password_file needs user.".to_owned()),
            (user, secret) => user.map(|user| (user, secret.unwrap_or_default().trim_end().to_owned())),
        };
        if keys.client.as_deref() == Some("") {
            return Err("client is empty: give a name, or leave the key out.".to_owned());
        }
        let is_mqtt = address != Address::OpcUa;
        if !is_mqtt && keys.time.is_some() {
            return Err("time is only for MQTT: an OPC UA server gives each value its own time.".to_owned());
        }
        let (silent, sampling) = (keys.silent.unwrap_or(SILENT), keys.sampling.unwrap_or(SAMPLING));
        for (key, value, high, unit) in [("silent", silent, 86_400.0, "s"), ("sampling", sampling, 60_000.0, "ms")] {
            if !(0.0..=high).contains(&value) {
                return Err(format!("{key} = {value} {unit}: the value must lie between 0 and {high} {unit}."));
            }
        }
        Ok(Self {
            client: keys.client.unwrap_or_else(|| format!("beadwright-{name}")),
            columns: columns(keys.columns, is_mqtt)?,
            time: keys.time,
            url: keys.url,
            name,
            address,
            user,
            silent,
            sampling,
        })
    }

    /// The topics or nodes, each once.
    pub(crate) fn places(&self) -> Vec<&str> {
        let mut places: Vec<&str> = self.columns.iter().filter_map(|column| column.from.as_deref()).collect();
        places.sort_unstable();
        places.dedup();
        places
    }

    /// Columns of the log that no record uses.
    pub fn unused(&self) -> impl Iterator<Item = &str> {
        let known = |name: &str| ["event", "note", "layer", "pass"].contains(&name) || Quantity::named(name).is_some();
        self.columns.iter().map(|column| column.name.as_str()).filter(move |name| !known(name))
    }
}

fn address(url: &str) -> Result<Address, String> {
    if url.starts_with("opc.tcp://") {
        return Ok(Address::OpcUa);
    }
    let wanted = || format!("url = \"{url}\": mqtt://HOST:PORT or opc.tcp://HOST:PORT is expected.");
    let host = url.strip_prefix("mqtt://").map(|rest| rest.trim_end_matches('/')).ok_or_else(wanted)?;
    let (host, port) = host.rsplit_once(':').unwrap_or((host, "1883"));
    let port = port.parse().map_err(|_| wanted())?;
    if host.is_empty() { Err(wanted()) } else { Ok(Address::Mqtt { host: host.to_owned(), port }) }
}

fn columns(keys: BTreeMap<String, ColumnKeys>, is_mqtt: bool) -> Result<Vec<Column>, String> {
    if keys.is_empty() {
        return Err("[columns] is empty: name at least one, such as current.".to_owned());
    }
    let mut columns: Vec<Column> = WORDS
        .iter()
        .filter(|name| !keys.contains_key(**name))
        .map(|name| Column { name: (*name).to_owned(), title: (*name).to_owned(), from: None, field: None })
        .collect();
    for (name, keys) in keys {
        columns.push(column(&name, keys, is_mqtt).map_err(|reason| format!("columns.{name}: {reason}"))?);
    }
    columns.sort_by_key(|column| !column.is_text());
    for (k, column) in columns.iter().enumerate() {
        let same = |other: &&Column| {
            Quantity::named(&other.name).is_some_and(|own| Some(own) == Quantity::named(&column.name))
        };
        if let Some(other) = columns[..k].iter().find(same) {
            return Err(format!(
                "columns.{0} and columns.{1} are the same quantity. Leave one out.",
                other.name, column.name
            ));
        }
    }
    Ok(columns)
}

fn column(name: &str, keys: ColumnKeys, is_mqtt: bool) -> Result<Column, String> {
    let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
    if name == TIME || name.is_empty() || !name.chars().all(plain) {
        return Err("a name of small letters, digits and _ is expected, other than time.".to_owned());
    }
    let unit = keys.unit.unwrap_or_default();
    if let Some(quantity) = Quantity::named(name)
        && quantity.from_unit(&unit).is_none()
    {
        return Err(format!("unit = \"{unit}\" is not understood; the usual one is {}.", quantity.unit()));
    }
    let from = match (is_mqtt, keys.topic, keys.node) {
        (true, Some(topic), None) if topic.contains(['+', '#']) => {
            return Err(format!("topic = \"{topic}\": name one topic, without + and #."));
        }
        (true, Some(topic), None) => topic,
        (false, None, Some(node)) => node,
        (true, ..) => return Err("topic is expected with mqtt://, and no node.".to_owned()),
        (false, ..) => return Err("node is expected with opc.tcp://, and no topic.".to_owned()),
    };
    if !is_mqtt && keys.field.is_some() {
        return Err("field is only for MQTT, whose messages may be JSON.".to_owned());
    }
    let title = if unit.is_empty() { name.to_owned() } else { format!("{name} ({unit})") };
    Ok(Column { name: name.to_owned(), title, from: Some(from), field: keys.field })
}
