//! `record.json`: the record with hashes, line by line, and whether they still hold.
//!
//! The first line holds what belongs to the whole part. Each pass has a line of its own, with the SHA-256 of that line and of
//! the hash before it. Then follow the hashes of the other files, and the seal: the hash of all text before it. Whoever changes the
//! record can compute all hashes again; only a seal that is kept elsewhere shows that.

use super::learnt::Values;
use super::{FileHash, JSON, Part, Totals, chain, link, sha256};
use serde::Deserialize;
use serde_json::json;

/// Version of the format.
const VERSION: u32 = 1;

const PASSES: &str = ",\"passes\":[\n";
const FILES: &str = "],\n\"files\":";
const SEAL: &str = ",\n\"seal\":\"";
const END: &str = "\"}\n";

/// The files of a record, and its seal.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Sealed {
    /// Names and content.
    pub files: Vec<(String, Vec<u8>)>,
    /// SHA-256 over all of it; kept elsewhere, it shows any later change.
    pub seal: String,
}

/// The passes with their hashes.
pub(super) struct Chained {
    head: String,
    rows: Vec<String>,
    hashes: Vec<String>,
}

impl Chained {
    pub(super) fn of(part: &Part<'_>) -> Result<Self, serde_json::Error> {
        let trace: Vec<_> = part.trace.iter().map(|(name, value)| json!({ "name": name, "value": value })).collect();
        let head = json!({
            "record": VERSION,
            "part": part.header.part,
            "profile": part.header.profile,
            "strategy": part.header.strategy,
            "trace": trace,
            "inputs": part.inputs,
            "settings": part.settings,
            "values": Values::of(part.profile),
            "planned": Totals::planned(part),
            "recorded": Totals::recorded(part),
            "logs": part.record.logs,
            "scans": part.scans,
            "findings": part.record.findings,
        });
        let head = head.to_string();
        let rows = part.record.passes.iter().map(serde_json::to_string).collect::<Result<Vec<_>, _>>()?;
        let hashes = chain(&head, &rows);
        Ok(Self { head, rows, hashes })
    }

    /// The hash that covers all passes.
    pub(super) fn last(&self) -> String {
        self.hashes.last().cloned().unwrap_or_else(|| sha256(self.head.as_bytes()))
    }

    /// The record together with the other files.
    pub(super) fn sealed(self, mut files: Vec<(String, Vec<u8>)>) -> Result<Sealed, serde_json::Error> {
        let own: Vec<FileHash> = files.iter().map(|(name, bytes)| FileHash::of(name, bytes)).collect();
        let row = |(row, hash): (&String, &String)| format!("{{\"hash\":\"{hash}\",\"pass\":{row}}}");
        let rows: Vec<String> = self.rows.iter().zip(&self.hashes).map(row).collect();
        let mut text = self.head[..self.head.len() - 1].to_owned() + PASSES;
        text += &rows.join(",\n");
        text += FILES;
        text += &serde_json::to_string(&own)?;
        let seal = sha256(text.as_bytes());
        text += SEAL;
        text += &seal;
        text += END;
        files.push((JSON.to_owned(), text.into_bytes()));
        Ok(Sealed { files, seal })
    }
}

/// What no longer holds.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Broken {
    /// Not a record of Beadwright.
    #[error("record.json is not a record of Beadwright, or its structure was changed")]
    Form,
    /// The seal is not that of the text.
    #[error("record.json was changed: its seal does not fit its text")]
    Seal,
    /// It was sealed anew.
    #[error("record.json has another seal than the one that was kept ({0})")]
    OtherSeal(String),
    /// A pass whose hash does not fit.
    #[error("record.json, line {line}: the row of a pass, or what comes before it, was changed, removed or moved{}", pass.map(|(layer, pass)| format!(" (layer {layer}, pass {pass})")).unwrap_or_default())]
    Row {
        /// Line, from 1.
        line: usize,
        /// Layer and pass, from 1, as the row names them.
        pass: Option<(usize, usize)>,
    },
    /// A file with other content.
    #[error("{0} was changed")]
    Changed(String),
    /// A file that is missing.
    #[error("{0} is missing")]
    Missing(String),
}

/// The end of the file.
#[derive(Deserialize)]
struct Tail {
    files: Vec<FileHash>,
}

/// What was changed in a record since it was sealed; nothing if it is whole. `text` is that of `record.json`, `file` gives the bytes
/// of the other files by name, and `seal` is the one that was kept elsewhere.
pub fn verify(text: &str, seal: Option<&str>, file: &mut dyn FnMut(&str) -> Option<Vec<u8>>) -> Vec<Broken> {
    let Some((sealed, own)) = text.rsplit_once(SEAL) else { return vec![Broken::Form] };
    let mut broken = Vec::new();
    let fits = sha256(sealed.as_bytes());
    if own.strip_suffix(END) != Some(fits.as_str()) {
        broken.push(Broken::Seal);
    }
    broken.extend(seal.filter(|seal| !seal.eq_ignore_ascii_case(&fits)).map(|seal| Broken::OtherSeal(seal.to_owned())));
    let parts = sealed.split_once(PASSES).and_then(|(head, rest)| Some((head, rest.rsplit_once(FILES)?)));
    let Some((head, (rows, files))) = parts else {
        broken.push(Broken::Form);
        return broken;
    };
    broken.extend(changed_rows(&format!("{head}}}"), rows));
    match serde_json::from_str::<Tail>(&format!("{{\"files\":{files}}}")) {
        Err(_) => broken.push(Broken::Form),
        Ok(tail) => broken.extend(tail.files.into_iter().filter_map(|known| match file(&known.name) {
            None => Some(Broken::Missing(known.name)),
            Some(bytes) => (FileHash::of(&known.name, &bytes) != known).then_some(Broken::Changed(known.name)),
        })),
    }
    broken
}

/// The rows that do not fit the hash before them.
fn changed_rows(head: &str, rows: &str) -> Vec<Broken> {
    let mut before = sha256(head.as_bytes());
    let mut broken = Vec::new();
    for (line, text) in (2..).zip(rows.lines()) {
        let text = text.strip_suffix(',').unwrap_or(text);
        let parts = text.strip_prefix("{\"hash\":\"").and_then(|rest| rest.split_once("\",\"pass\":"));
        let parts = parts.and_then(|(hash, row)| Some((hash, row.strip_suffix('}')?)));
        let fits = parts.is_some_and(|(hash, row)| hash == link(&before, row));
        if !fits {
            let row = parts.and_then(|(_, row)| serde_json::from_str::<Named>(row).ok());
            broken.push(Broken::Row { line, pass: row.map(|row| (row.layer, row.pass)) });
        }
        // A chain goes on with the hashes that it states, so that later rows are judged for themselves.
        if let Some((hash, _)) = parts {
            before = hash.to_owned();
        }
    }
    broken
}

#[derive(Deserialize)]
struct Named {
    layer: usize,
    pass: usize,
}

/// The inputs of a record in place of which other files are `given`. Several may have the same name: each of the given files stands for
/// the one with its hash, or else for one with its name.
pub fn other_inputs(text: &str, given: &[FileHash]) -> Vec<Broken> {
    #[derive(Deserialize)]
    struct Head {
        inputs: Vec<FileHash>,
    }
    let head = text.split_once(PASSES).and_then(|(head, _)| serde_json::from_str::<Head>(&format!("{head}}}")).ok());
    let inputs = head.map(|head| head.inputs).unwrap_or_default();
    let mut given = given.to_vec();
    let mut take = |is_it: &dyn Fn(&FileHash) -> bool| given.iter().position(is_it).map(|at| given.remove(at));
    let others: Vec<FileHash> = inputs.into_iter().filter(|known| take(&|own| own == known).is_none()).collect();
    let changed = others.into_iter().filter(|known| take(&|own| own.name == known.name).is_some());
    changed.map(|known| Broken::Changed(known.name)).collect()
}
