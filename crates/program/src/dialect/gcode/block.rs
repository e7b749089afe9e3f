//! G-code blocks: the words of one line, without allocation.

use crate::dialect::reading::words::Patterns;

/// Most codes of one letter in a block; further ones are dropped, as no control accepts more.
const MAX_CODES: usize = 12;

/// G or M codes in tenths: G92.1 is 921.
#[derive(Clone, Copy, Default)]
pub(super) struct Codes {
    codes: [i32; MAX_CODES],
    count: usize,
}

impl Codes {
    fn push(&mut self, code: f64) {
        if let Some(free) = self.codes.get_mut(self.count) {
            *free = (code * 10.0).round() as i32;
            self.count += 1;
        }
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = i32> + use<> {
        self.codes.into_iter().take(self.count)
    }

    pub(super) fn has(&self, code: i32) -> bool {
        self.codes[..self.count].contains(&code)
    }
}

/// The words of a line.
pub(super) struct Block {
    values: [f64; 26],
    /// Bit i: letter i has a value.
    set: u32,
    /// Letters without a value, as in `G28 X Y`.
    bare: u32,
    pub(super) g: Codes,
    pub(super) m: Codes,
}

/// What a line is.
pub(super) enum Line<'a> {
    /// Nothing to do.
    Empty,
    /// Words, now in the block.
    Words,
    /// A named command (Klipper), or a line in another language.
    Macro,
    /// A word whose value is not a number.
    Malformed(&'a [u8]),
}

/// M codes that take a text: message, file names, object names.
const WITH_TEXT: [i32; 8] = [23, 28, 30, 32, 98, 117, 118, 486];

fn bit(letter: u8) -> u32 {
    1 << (letter - b'A')
}

impl Block {
    pub(super) fn new() -> Self {
        Self { values: [0.0; 26], set: 0, bare: 0, g: Codes::default(), m: Codes::default() }
    }

    /// The value of a letter.
    pub(super) fn get(&self, letter: u8) -> Option<f64> {
        self.has(letter).then(|| self.values[usize::from(letter - b'A')])
    }

    pub(super) fn has(&self, letter: u8) -> bool {
        self.set & bit(letter) != 0
    }

    /// Whether the letter is present, with or without a value.
    pub(super) fn names(&self, letter: u8) -> bool {
        (self.set | self.bare) & bit(letter) != 0
    }

    pub(super) fn has_any(&self, letters: &[u8]) -> bool {
        letters.iter().any(|&l| self.has(l))
    }

    /// Reads a line into the block.
    pub(super) fn read<'a>(&mut self, line: &'a [u8]) -> Line<'a> {
        (self.set, self.bare, self.g.count, self.m.count) = (0, 0, 0, 0);
        let mut i = 0;
        let mut any = false;
        while let Some(&b) = line.get(i) {
            i += 1;
            match b {
                b' ' | b'\t' | b'\r' | b'/' => {}
                b';' | b'*' | b'%' => break,
                b'(' => i += line[i..].iter().position(|&b| b == b')').map_or(line.len(), |p| p + 1),
                b if b.is_ascii_alphabetic() => {
                    if !any && line.get(i).is_some_and(|n| n.is_ascii_alphabetic() || *n == b'_') {
                        return Line::Macro;
                    }
                    match self.word(b.to_ascii_uppercase(), line, &mut i) {
                        Some(goes_on) if goes_on => any = true,
                        Some(_) => return Line::Words,
                        None => return Line::Malformed(word_at(line, i)),
                    }
                }
                _ if any => return Line::Malformed(word_at(line, i - 1)),
                _ => return Line::Macro,
            }
            i = i.min(line.len());
        }
        if any { Line::Words } else { Line::Empty }
    }

    /// Reads the word whose letter was just passed. False: the rest of the line is ignored; `None`: the word is
    /// malformed.
    fn word(&mut self, letter: u8, line: &[u8], i: &mut usize) -> Option<bool> {
        let mut start = *i + line[*i..].iter().take_while(|b| matches!(b, b' ' | b'\t')).count();
        // Siemens writes `A=30`, where a name could continue.
        start += usize::from(line.get(start) == Some(&b'='));
        let digits = line[start..].iter().take_while(|b| matches!(b, b'0'..=b'9' | b'.' | b'+' | b'-')).count();
        if digits == 0 {
            let ends = line.get(start).is_none_or(|b| b.is_ascii_alphabetic() || b"\r;(*".contains(b));
            self.bare |= bit(letter);
            // Texts in quotes belong to codes that move nothing.
            return if ends { Some(true) } else { (line.get(start) == Some(&b'"')).then_some(false) };
        }
        let value = parse(&line[start..start + digits])?;
        *i = start + digits;
        // An address with a number, such as `Q1=5.0`, is an axis or a parameter other than those that move the torch.
        if let Some((b'=', rest)) = line[*i..].split_first() {
            *i += 1 + rest.iter().take_while(|b| matches!(b, b'0'..=b'9' | b'.' | b'+' | b'-')).count();
            return Some(true);
        }
        match letter {
            b'G' => self.g.push(value),
            b'M' => {
                self.m.push(value);
                return Some(!WITH_TEXT.contains(&(value as i32)));
            }
            _ => {
                self.values[usize::from(letter - b'A')] = value;
                self.set |= bit(letter);
            }
        }
        Some(true)
    }
}

/// The letter at or before `i` with what follows it, for messages.
fn word_at(line: &[u8], i: usize) -> &[u8] {
    let start = i.saturating_sub(1).min(line.len());
    let length = line[start..].iter().take_while(|b| !b.is_ascii_whitespace()).count();
    &line[start..start + length]
}

/// A decimal number without exponent.
pub(super) fn parse(digits: &[u8]) -> Option<f64> {
    std::str::from_utf8(digits).ok()?.parse().ok().filter(|v: &f64| v.is_finite())
}

/// Whether a line begins with a word of G-code, such as `N10 G1`, `g28`, `M3` or `X5`.
pub(super) fn begins_block(line: &[u8]) -> bool {
    let mut rest = line.trim_ascii_start();
    if let Some((b'N' | b'n', numbered)) = rest.split_first() {
        let digits = numbered.iter().take_while(|b| b.is_ascii_digit()).count();
        rest = if digits > 0 { numbered[digits..].trim_ascii_start() } else { rest };
    }
    matches!(rest, [b'G' | b'M' | b'T' | b'X' | b'Y' | b'Z' | b'g' | b'm' | b'x' | b'y' | b'z', next, ..]
        if next.is_ascii_digit() || b"+-.".contains(next))
}

/// A code that strikes or ends the arc.
pub(super) enum Code {
    /// All of these words in one block.
    Words(Vec<(u8, f64)>),
    /// A macro.
    Text(Patterns),
}

impl Code {
    pub(super) fn new(pattern: &str) -> Self {
        let upper = pattern.trim().to_ascii_uppercase();
        let mut block = Block::new();
        if !matches!(block.read(upper.as_bytes()), Line::Words) || block.bare != 0 {
            return Self::Text(Patterns::new(&[upper]));
        }
        let codes =
            |letter, codes: &Codes| codes.iter().map(move |c| (letter, f64::from(c) / 10.0)).collect::<Vec<_>>();
        let mut words = codes(b'G', &block.g);
        words.extend(codes(b'M', &block.m));
        words.extend((b'A'..=b'Z').filter_map(|l| block.get(l).map(|v| (l, v))));
        Self::Words(words)
    }

    /// Whether the block holds the code.
    pub(super) fn is_in(&self, block: &Block) -> bool {
        let Self::Words(words) = self else { return false };
        words.iter().all(|&(letter, value)| match letter {
            b'G' => block.g.has((value * 10.0).round() as i32),
            b'M' => block.m.has((value * 10.0).round() as i32),
            _ => block.get(letter).is_some_and(|v| (v - value).abs() < 1e-9),
        })
    }

    /// Whether the line of a macro, in compact form, is this code.
    pub(super) fn is_macro(&self, line: &str) -> bool {
        matches!(self, Self::Text(patterns) if patterns.matches(line))
    }
}
