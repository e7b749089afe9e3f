//! The section `[arm]` of a cell: six lengths, Denavit-Hartenberg rows, or the name of a URDF file.

use crate::arm::Joints;
use crate::arm_table::{ArmTable, OpwTable, Shape};
use crate::chain::Chain;
use crate::error::CellError;
use crate::urdf;
use bead_part::text::toml::line_of_key;
use serde::Deserialize;
use std::sync::Arc;

/// The keys of `[arm]` as written in a cell.
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(crate) struct ArmKeys {
    a1: Option<f64>,
    a2: Option<f64>,
    b: Option<f64>,
    c1: Option<f64>,
    c2: Option<f64>,
    c3: Option<f64>,
    c4: Option<f64>,
    offsets: Option<Joints>,
    signs: Option<[i8; 6]>,
    parallelogram: Option<bool>,
    dh: Option<[[f64; 3]; 6]>,
    urdf: Option<String>,
    base: Option<String>,
    tip: Option<String>,
    limits: Option<[[f64; 2]; 6]>,
    speeds: Option<[f64; 6]>,
}

/// What is wrong with the keys.
pub(crate) enum Wrong {
    Missing(&'static str),
    Mixed(&'static str),
    Rows(String),
    Other(CellError),
}

impl Wrong {
    /// The error with its line.
    pub(crate) fn at(self, text: &str) -> CellError {
        let at = |key: &str, reason: String| CellError::Text { line: line_of_key(text, key), reason };
        match self {
            Self::Missing(key) => at("arm", format!("the key \"{key}\" is missing here.")),
            Self::Mixed(key) => at(
                &format!("arm.{key}"),
                format!(
                    "the key \"{key}\" does not go with the others: an arm has lengths (a1 to c4), or rows \"dh\", or a file \
                     \"urdf\" with \"base\" and \"tip\"."
                ),
            ),
            Self::Rows(reason) => at("arm.dh", reason),
            Self::Other(error) => error,
        }
    }
}

impl ArmKeys {
    /// The arm they describe; `read` gives the text of a URDF file.
    pub(crate) fn table(self, read: impl FnOnce(&str) -> Result<String, String>) -> Result<ArmTable, Wrong> {
        let (limits, speeds) = (self.limits, self.speeds);
        if let Some(file) = &self.urdf {
            self.alone(&["urdf", "base", "tip"])?;
            let text = read(file).map_err(|reason| Wrong::Other(CellError::File { file: file.clone(), reason }))?;
            let ends = urdf::Ends { base: self.base.clone(), tip: self.tip.clone() };
            let table = urdf::read(&text, &ends).map_err(|e| Wrong::Other(e.into()))?;
            let (limits, speeds) = (limits.unwrap_or(table.limits), speeds.unwrap_or(table.speeds));
            return Ok(ArmTable { limits, speeds, ..table });
        }
        let shape = match self.dh {
            Some(rows) => {
                self.alone(&["dh"])?;
                Shape::Chain(Arc::new(chain(&rows)?))
            }
            None => Shape::Opw(self.lengths()?),
        };
        let limits = limits.ok_or(Wrong::Missing("limits"))?;
        Ok(ArmTable { shape, limits, speeds: speeds.ok_or(Wrong::Missing("speeds"))? })
    }

    /// Refuses keys that belong to other kinds of arm.
    fn alone(&self, own: &[&str]) -> Result<(), Wrong> {
        let set = [
            ("a1", self.a1.is_some()),
            ("a2", self.a2.is_some()),
            ("b", self.b.is_some()),
            ("c1", self.c1.is_some()),
            ("c2", self.c2.is_some()),
            ("c3", self.c3.is_some()),
            ("c4", self.c4.is_some()),
            ("offsets", self.offsets.is_some()),
            ("signs", self.signs.is_some()),
            ("parallelogram", self.parallelogram.is_some()),
            ("dh", self.dh.is_some()),
            ("base", self.base.is_some()),
            ("tip", self.tip.is_some()),
        ];
        match set.iter().find(|(key, set)| *set && !own.contains(key)) {
            Some((key, _)) => Err(Wrong::Mixed(key)),
            None => Ok(()),
        }
    }

    fn lengths(&self) -> Result<OpwTable, Wrong> {
        if let Some((key, _)) = [("base", &self.base), ("tip", &self.tip)].iter().find(|(_, link)| link.is_some()) {
            return Err(Wrong::Mixed(key));
        }
        Ok(OpwTable {
            a1: self.a1.ok_or(Wrong::Missing("a1"))?,
            a2: self.a2.ok_or(Wrong::Missing("a2"))?,
            b: self.b.ok_or(Wrong::Missing("b"))?,
            c1: self.c1.ok_or(Wrong::Missing("c1"))?,
            c2: self.c2.ok_or(Wrong::Missing("c2"))?,
            c3: self.c3.ok_or(Wrong::Missing("c3"))?,
            c4: self.c4.ok_or(Wrong::Missing("c4"))?,
            offsets: self.offsets.ok_or(Wrong::Missing("offsets"))?,
            signs: self.signs.ok_or(Wrong::Missing("signs"))?,
            parallelogram: self.parallelogram.ok_or(Wrong::Missing("parallelogram"))?,
        })
    }
}

fn chain(rows: &[[f64; 3]; 6]) -> Result<Chain, Wrong> {
    let far = |[a, d, alpha]: &[f64; 3]| [a, d].into_iter().any(|v| !(-5e3..=5e3).contains(v)) || !alpha.is_finite();
    if let Some(row) = rows.iter().position(far) {
        let reason =
            format!("row {}: a and d must lie between -5000 and 5000 mm, and alpha must be an angle in °.", row + 1);
        return Err(Wrong::Rows(reason));
    }
    Chain::from_dh(rows).map_err(|e| Wrong::Rows(format!("{e}.")))
}
