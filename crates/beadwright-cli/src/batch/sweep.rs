//! Keys of the profile with the values they take: `layers.height=1.8,2.0` or `layers.height=1.8:2.2:3`.

/// A key of the profile with its values, as text.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Sweep {
    key: String,
    values: Vec<String>,
}

/// Maximum number of values of a key.
const MOST_VALUES: usize = 10_000;

impl Sweep {
    /// Number of values.
    pub(super) fn len(&self) -> usize {
        self.values.len()
    }
}

/// Reads `KEY=V1,V2,…` or `KEY=A:B:N`.
pub(super) fn parse(text: &str) -> Result<Sweep, String> {
    let expected = || "a key and its values are expected, such as layers.height=1.8,2.0,2.2 or layers.height=1.8:2.2:3";
    let (key, values) = text.split_once('=').ok_or_else(expected)?;
    let (key, values) = (key.trim(), values.trim());
    if key.is_empty() || values.is_empty() {
        return Err(expected().to_owned());
    }
    let ends: Vec<&str> = values.split(':').collect();
    let values: Vec<String> = match ends[..] {
        [from, to, count] if from.trim().parse::<f64>().is_ok() => range(from, to, count)?,
        _ => values.split(',').map(|value| value.trim().to_owned()).collect(),
    };
    if values.iter().any(String::is_empty) {
        return Err("there is an empty value between two commas".to_owned());
    }
    Ok(Sweep { key: key.to_owned(), values })
}

/// Evenly spaced values with both ends, rounded to 1e-9.
fn range(from: &str, to: &str, count: &str) -> Result<Vec<String>, String> {
    let number = |text: &str| text.trim().parse::<f64>().ok().filter(|n| n.is_finite());
    let ends = number(from).zip(number(to)).ok_or("the first and the last value must be numbers, such as 1.8:2.2:3")?;
    let count: usize = count.trim().parse().ok().filter(|n| (2..=MOST_VALUES).contains(n)).ok_or_else(|| {
        format!("the number of values must be a whole number between 2 and {MOST_VALUES}, such as 1.8:2.2:3")
    })?;
    let value = |i: usize| ends.0 + (ends.1 - ends.0) * i as f64 / (count - 1) as f64;
    let rounded = |value: f64| if value.abs() < 1e6 { (value * 1e9).round() / 1e9 } else { value };
    Ok((0..count).map(|i| rounded(value(i)).to_string()).collect())
}

/// Every value of one key with every value of the others; the last key changes fastest. One empty point without sweeps.
pub(super) fn points(sweeps: &[Sweep]) -> Vec<Vec<(String, String)>> {
    sweeps.iter().fold(vec![Vec::new()], |points, sweep| {
        let with = |point: &Vec<(String, String)>, value: &String| {
            point.iter().cloned().chain([(sweep.key.clone(), value.clone())]).collect()
        };
        points.iter().flat_map(|point| sweep.values.iter().map(move |value| with(point, value))).collect()
    })
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn ranges_hold_both_ends_and_even_steps() {
        assert_eq!(parse("layers.height=1.8:2.2:3").unwrap().values, ["1.8", "2", "2.2"]);
        assert_eq!(parse("a.b = 0 : -0.3 : 4").unwrap().values, ["0", "-0.1", "-0.2", "-0.3"]);
        assert_eq!(parse("a.b=loop, zigzag").unwrap().values, ["loop", "zigzag"]);
        // Text with a colon is a value like others.
        assert_eq!(parse("a.b=COM1:x").unwrap().values, ["COM1:x"]);
    }

    #[test]
    fn what_is_no_sweep_is_refused_with_an_example() {
        for text in ["layers.height", "=1,2", "a.b=", "a.b=1:2:1", "a.b=1:x:3", "a.b=1:2:x", "a.b=1:inf:3"] {
            assert!(parse(text).is_err_and(|said| said.contains("1.8:2.2:3")), "{text}");
        }
        assert!(parse("a.b=1,,2").is_err());
    }

    #[test]
    fn every_value_meets_every_other() {
        let sweeps = [parse("a=1,2").unwrap(), parse("b=x,y,z").unwrap()];
        let points = points(&sweeps);
        let written: Vec<String> = points.iter().map(|point| point.iter().map(|(_, v)| v.as_str()).collect()).collect();
        assert_eq!(written, ["1x", "1y", "1z", "2x", "2y", "2z"]);
        assert_eq!(super::points(&[]), [Vec::new()]);
    }
}
