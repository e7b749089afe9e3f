//! Numbers as programs and files need them: fixed decimals, a point, no exponent, no negative zero.

/// Appends `value` with this many decimals (at most 9). Non-finite values are written as 0; callers keep them out.
///
/// ```
/// use bead_program::number::push_fixed;
///
/// let mut line = "G1 X".to_owned();
/// push_fixed(&mut line, 12.5, 3);
/// assert_eq!(line, "G1 X12.500");
/// ```
pub fn push_fixed(text: &mut String, value: f64, decimals: usize) {
    const POWERS: [f64; 10] = [1.0, 10.0, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9];
    debug_assert!(value.is_finite());
    let decimals = decimals.min(9);
    let scaled = if value.is_finite() { (value * POWERS[decimals]).abs() } else { 0.0 };
    // Halves are rounded away from zero; a call of `round` costs more than everything else here.
    let whole = scaled as u64;
    let digits = whole.saturating_add(u64::from(scaled - whole as f64 >= 0.5));
    let mut number = Number { bytes: [b'0'; 24], start: 24, left: digits };
    number.take(decimals);
    if decimals > 0 {
        number.put(b'.');
    }
    number.take(1);
    while number.left > 0 {
        number.take(1);
    }
    if value < 0.0 && digits > 0 {
        number.put(b'-');
    }
    text.push_str(std::str::from_utf8(&number.bytes[number.start..]).unwrap_or_default());
}

/// A number written from its last digit to its first; at most a sign, twenty digits and a point.
struct Number {
    bytes: [u8; 24],
    start: usize,
    left: u64,
}

impl Number {
    /// Writes the last digits of the remaining number.
    fn take(&mut self, digits: usize) {
        for _ in 0..digits / 2 {
            let pair = (self.left % 100) as u8;
            self.left /= 100;
            self.put(b'0' + pair % 10);
            self.put(b'0' + pair / 10);
        }
        if digits % 2 == 1 {
            let digit = (self.left % 10) as u8;
            self.left /= 10;
            self.put(b'0' + digit);
        }
    }

    fn put(&mut self, byte: u8) {
        self.start -= 1;
        self.bytes[self.start] = byte;
    }
}

/// `value` with this many decimals.
///
/// ```
/// use bead_program::number::fixed;
///
/// assert_eq!(fixed(-123.456, 2), "-123.46");
/// assert_eq!(fixed(1e9, 1), "1000000000.0");
/// assert_eq!(fixed(-0.0004, 3), "0.000", "no negative zero");
/// ```
pub fn fixed(value: f64, decimals: usize) -> String {
    let mut text = String::with_capacity(12);
    push_fixed(&mut text, value, decimals);
    text
}

/// The nearest whole number, halves away from zero, like `f64::round` except for numbers minutely below a half; without
/// a call into the maths library.
pub fn rounded(value: f64) -> f64 {
    /// Numbers from here on are whole.
    const WHOLE: f64 = 4_503_599_627_370_496.0;
    if value.abs() < WHOLE { (value + 0.5_f64.copysign(value)) as i64 as f64 } else { value }
}

/// Seconds as `1 h 02 min 03 s`.
///
/// ```
/// use bead_program::number::hours;
///
/// assert_eq!(hours(3723.4), "1 h 02 min 03 s");
/// ```
pub fn hours(seconds: f64) -> String {
    let s = seconds.round() as u64;
    format!("{} h {:02} min {:02} s", s / 3600, s / 60 % 60, s % 60)
}
