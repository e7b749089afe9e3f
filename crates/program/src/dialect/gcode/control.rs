//! What CNC controls write in languages of their own: branches, heights added to layers, file names.

use serde::{Deserialize, Serialize};

/// A control.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub enum GcodeControl {
    /// LinuxCNC: O words, `G52`.
    Linuxcnc,
    /// Fanuc: custom macro B (`IF[#100GT0]GOTO1`), `G52`.
    Fanuc,
    /// Siemens Sinumerik: `IF R90>0 GOTOF LB1`, `TRANS`.
    Siemens,
    /// Beckhoff TwinCAT NC I, the classic interpreter: `@126 R90 K0 K1`, `G58`.
    Twincat,
}

/// Names that Sinumerik and Windows reserve.
const TAKEN: [&str; 4] = ["CON", "PRN", "AUX", "NUL"];

/// Names of programs have this many characters at most (SINUMERIK ONE, Programming Manual, 12/2019).
const MAX_NAME: usize = 24;

impl GcodeControl {
    /// Whether the control accepts a program name, without its extension.
    pub(super) fn takes(self, name: &str) -> bool {
        self.file_name(name).eq_ignore_ascii_case(name)
    }

    /// The name of a part's file, without its extension.
    pub(super) fn file_name(self, part: &str) -> String {
        if self != Self::Siemens {
            return part.to_owned();
        }
        // Letters, digits and _, of which the first two are letters.
        let legal = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_uppercase() } else { '_' };
        let mut name: String = part.chars().map(legal).collect();
        let letters = name.chars().take(2).filter(char::is_ascii_alphabetic).count() == 2;
        let numbered = ["COM", "LPT"].iter().any(|port| name.starts_with(port) && name.len() == 4);
        if !letters || numbered || TAKEN.contains(&name.as_str()) || name.starts_with("CYCLE") {
            name.insert_str(0, "PART_");
        }
        name.truncate(MAX_NAME);
        name
    }

    /// The variable that holds the pass at which to begin.
    pub(super) fn variable(self) -> &'static str {
        match self {
            Self::Linuxcnc => "#<_start>",
            Self::Fanuc => "#100",
            Self::Siemens | Self::Twincat => "R90",
        }
    }

    /// Sets the variable to 0.
    pub(super) fn reset(self) -> String {
        let sign = if self == Self::Linuxcnc { " = " } else { "=" };
        format!("{}{sign}0", self.variable())
    }

    /// Whether its jumps go to block numbers, so that no other block may have one.
    pub(super) fn jumps_to_numbers(self) -> bool {
        matches!(self, Self::Fanuc | Self::Twincat)
    }

    /// A forward jump to a label if the variable is greater than a number; `None` for controls that use blocks instead
    /// of jumps.
    pub(super) fn jump_if_above(self, number: usize, label: usize) -> Option<String> {
        let variable = self.variable();
        match self {
            Self::Linuxcnc => None,
            Self::Fanuc => Some(format!("IF[{variable}GT{number}]GOTO{label}")),
            Self::Siemens => Some(format!("IF {variable}>{number} GOTOF LB{label}")),
            Self::Twincat => Some(format!("@126 {variable} K{number} K{label}")),
        }
    }

    /// A forward jump to a label if the variable is 0.
    pub(super) fn jump_if_zero(self, label: usize) -> Option<String> {
        let variable = self.variable();
        match self {
            Self::Linuxcnc => None,
            Self::Fanuc => Some(format!("IF[{variable}EQ0]GOTO{label}")),
            Self::Siemens => Some(format!("IF {variable}==0 GOTOF LB{label}")),
            Self::Twincat => Some(format!("@122 {variable} K0 K{label}")),
        }
    }

    /// A forward jump to a label.
    pub(super) fn jump(self, label: usize) -> Option<String> {
        match self {
            Self::Linuxcnc => None,
            Self::Fanuc => Some(format!("GOTO{label}")),
            Self::Siemens => Some(format!("GOTOF LB{label}")),
            Self::Twincat => Some(format!("@100 K{label}")),
        }
    }

    /// The block that a jump leads to.
    pub(super) fn label(self, label: usize) -> Option<String> {
        match self {
            Self::Linuxcnc => None,
            Self::Fanuc => Some(format!("N{label}")),
            Self::Siemens => Some(format!("LB{label}:")),
            Self::Twincat => Some(format!("N{label} G90")),
        }
    }

    /// The block that adds a height (mm, as text) to the following ones; 0 removes it.
    pub(super) fn raise(self, height: &str) -> String {
        match self {
            Self::Linuxcnc | Self::Fanuc => format!("G52 X0.0 Y0.0 Z{height}"),
            Self::Siemens => format!("TRANS Z{height}"),
            Self::Twincat => format!("G58 X0.0 Y0.0 Z{height}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::GcodeControl::{Linuxcnc, Siemens};

    #[test]
    fn names_of_siemens_begin_with_two_letters() {
        for (part, name) in [
            ("bracket", "BRACKET"),
            ("123", "PART_123"),
            ("b2", "PART_B2"),
            ("Gr\u{fc}n 7", "GR_N_7"),
            ("aux", "PART_AUX"),
            ("com1", "PART_COM1"),
            ("cycle832", "PART_CYCLE832"),
            ("", "PART_"),
            ("the long name of a part that goes on", "THE_LONG_NAME_OF_A_PART_"),
        ] {
            assert_eq!(Siemens.file_name(part), name);
        }
        assert_eq!(Linuxcnc.file_name("123"), "123");
    }
}
