//! Programs too large for a controller's memory, in volumes: each is a separate main program with its modules, and they
//! are loaded and run one after another.

use crate::program::Instruction;

/// The sizes of the volumes.
#[derive(Debug, Clone)]
pub(in crate::dialect) struct Volumes {
    /// The language, and the extension of main programs.
    language: &'static str,
    extension: &'static str,
    /// Most bytes of a volume.
    most: usize,
    /// Size of the current one, bytes.
    size: usize,
    /// Whether the current one has a module yet.
    begun: bool,
    /// Names of the main programs.
    names: Vec<String>,
    /// Size of the largest, bytes.
    largest: usize,
    /// Size of all, bytes.
    total: usize,
}

/// Bytes in a megabyte, as controllers count them.
pub(in crate::dialect) const MEGABYTE: f64 = 1e6;

impl Volumes {
    /// Volumes of at most this many megabytes, of programs in a language whose main programs have this extension.
    pub(in crate::dialect) fn new(megabytes: f64, language: &'static str, extension: &'static str) -> Self {
        let most = (megabytes * MEGABYTE) as usize;
        Self { language, extension, most, size: 0, begun: false, names: Vec::new(), largest: 0, total: 0 }
    }

    /// Begins a volume and returns its name: that of the program, with a number from the second one on.
    pub(in crate::dialect) fn begin(&mut self, program: &str) -> String {
        let number = self.names.len() + 1;
        let name = if number == 1 { program.to_owned() } else { format!("{program}_{number}") };
        self.names.push(name.clone());
        (self.size, self.begun) = (0, false);
        name
    }

    /// Whether the text of a module still fits.
    pub(in crate::dialect) fn has_room(&self, bytes: usize) -> bool {
        !self.begun || self.size + bytes <= self.most
    }

    /// Adds the text that every volume has: the head and the end of its main program.
    pub(in crate::dialect) fn add_frame(&mut self, bytes: usize) {
        self.size += bytes;
        self.total += bytes;
        self.largest = self.largest.max(self.size);
    }

    /// Adds the text of a module.
    pub(in crate::dialect) fn add(&mut self, bytes: usize) {
        self.add_frame(bytes);
        self.begun = true;
    }

    /// A remark about the volumes, if there are several, or if one exceeds the limit.
    pub(in crate::dialect) fn note(&self) -> Option<String> {
        let Self { language, extension, .. } = self;
        let megabytes = |bytes: usize| bytes as f64 / MEGABYTE;
        let (total, largest, most) = (megabytes(self.total), megabytes(self.largest), megabytes(self.most));
        match &self.names[..] {
            [first, .., last] if self.largest <= self.most => Some(format!(
                "The {language} program has {total:.1} MB and comes in {} volumes of at most {most:.1} MB, {first}.{extension} \
                 to {last}.{extension}: load and run them one after another.",
                self.names.len(),
            )),
            [.., last] if self.largest > self.most => Some(format!(
                "A volume of the {language} program has {largest:.1} MB, more than the {most:.1} MB that the controller accepts \
                 ({last}.{extension} is the last of {}): one pass of it cannot be cut. Use longer moves \
                 (program.chord_tolerance = 0.05, program.arcs = true).",
                self.names.len(),
            )),
            _ => None,
        }
    }
}

/// The instructions at the beginning of a volume: the machine moves from anywhere to above the start of the first pass,
/// and down to it.
pub(in crate::dialect) fn from_anywhere(instructions: &[Instruction]) -> Vec<Instruction> {
    let way = instructions.iter().position(|i| matches!(i, Instruction::Above)).unwrap_or(0);
    let come = |(i, instruction): (usize, &Instruction)| match *instruction {
        Instruction::PassStart { above, .. } if i < way => vec![*instruction, Instruction::Approach { to: above }],
        Instruction::Approach { .. } | Instruction::Travel { .. } if i < way => Vec::new(),
        other => vec![other],
    };
    instructions.iter().enumerate().flat_map(come).collect()
}
