//! Programs too large for a controller's memory, in volumes: each is a main program of its own with its layers, and they
//! are loaded and run one after another.

use crate::program::Instruction;

/// What has been written of each volume.
#[derive(Debug, Clone)]
pub(in crate::dialect) struct Volumes {
    /// Most that a volume may hold, bytes.
    most: usize,
    /// Size of the present one, bytes.
    size: usize,
    /// Names of the main programs.
    names: Vec<String>,
    /// Size of all, bytes.
    total: usize,
}

/// Bytes in a megabyte, as controllers count them.
const MEGABYTE: f64 = 1e6;

impl Volumes {
    /// Volumes of at most so many megabytes; only a longer layer makes a larger one.
    pub(in crate::dialect) fn new(megabytes: f64) -> Self {
        Self { most: (megabytes * MEGABYTE) as usize, size: 0, names: Vec::new(), total: 0 }
    }

    /// Begins a volume and returns its name: that of the program, with a number from the second on.
    pub(in crate::dialect) fn begin(&mut self, program: &str) -> String {
        let number = self.names.len() + 1;
        let name = if number == 1 { program.to_owned() } else { format!("{program}_{number}") };
        self.names.push(name.clone());
        self.size = 0;
        name
    }

    /// Whether the text of a layer still fits.
    pub(in crate::dialect) fn has_room(&self, bytes: usize) -> bool {
        self.size == 0 || self.size + bytes <= self.most
    }

    /// Adds the text of a layer.
    pub(in crate::dialect) fn add(&mut self, bytes: usize) {
        self.size += bytes;
        self.total += bytes;
    }

    /// What to tell of them, if there are several.
    pub(in crate::dialect) fn note(&self, language: &str, extension: &str) -> Option<String> {
        let [first, .., last] = &self.names[..] else { return None };
        Some(format!(
            "The {language} program has {:.1} MB and comes in {} volumes of at most {:.1} MB, {first}.{extension} to \
             {last}.{extension}: load and run them one after another.",
            self.total as f64 / MEGABYTE,
            self.names.len(),
            self.most as f64 / MEGABYTE
        ))
    }
}

/// The instructions of the first layer of a volume: the machine comes from anywhere to above the start of the first pass,
/// and goes down there.
pub(in crate::dialect) fn from_anywhere(instructions: &[Instruction]) -> Vec<Instruction> {
    let first = instructions.iter().position(|i| matches!(i, Instruction::Weld { .. })).unwrap_or(instructions.len());
    let ways: Vec<usize> = (0..first).filter(|&i| instructions[i].target().is_some()).collect();
    let Some(&above) = ways.get(ways.len().saturating_sub(2)) else { return instructions.to_vec() };
    let begin = |(i, instruction): (usize, &Instruction)| match *instruction {
        Instruction::Travel { to } if i == above => Some(Instruction::Approach { to }),
        Instruction::Travel { .. } if i < above => None,
        other => Some(other),
    };
    instructions.iter().enumerate().filter_map(begin).collect()
}
