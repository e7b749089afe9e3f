//! Numbers as programs and files want them: fixed decimals, a point, no exponent, no negative zero.

/// Appends `value` with that many decimals (at most 9). What is not finite is written as 0; callers keep such
/// values out.
pub fn push_fixed(text: &mut String, value: f64, decimals: usize) {
    const POWERS: [u64; 10] = [1, 10, 100, 1_000, 10_000, 100_000, 1_000_000, 10_000_000, 100_000_000, 1_000_000_000];
    let power = POWERS[decimals.min(9)];
    debug_assert!(value.is_finite());
    let scaled = (value * power as f64).abs();
    // Halves are rounded away from zero; a call of `round` costs more than all else here.
    let whole = scaled as u64;
    let digits = whole + u64::from(scaled - whole as f64 >= 0.5);
    if value < 0.0 && digits > 0 {
        text.push('-');
    }
    push_digits(text, digits / power, 1);
    if decimals > 0 {
        text.push('.');
        push_digits(text, digits % power, decimals.min(9));
    }
}

/// `value` with that many decimals.
pub fn fixed(value: f64, decimals: usize) -> String {
    let mut text = String::with_capacity(12);
    push_fixed(&mut text, value, decimals);
    text
}

/// Appends digits, with zeros in front up to `width`.
fn push_digits(text: &mut String, mut value: u64, width: usize) {
    let mut digits = [b'0'; 20];
    let mut start = digits.len();
    while value > 0 || digits.len() - start < width {
        start -= 1;
        digits[start] = b'0' + (value % 10) as u8;
        value /= 10;
    }
    text.push_str(std::str::from_utf8(&digits[start..]).unwrap_or_default());
}

/// Seconds as `1 h 02 min 03 s`.
pub fn hours(seconds: f64) -> String {
    let s = seconds.round() as u64;
    format!("{} h {:02} min {:02} s", s / 3600, s / 60 % 60, s % 60)
}
