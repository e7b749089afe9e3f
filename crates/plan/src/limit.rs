//! The limits of the values of a profile: a row for every number, with its range, unit and reason.

/// The limits of a number in a profile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limit {
    /// Full key, such as `bead.width`.
    pub key: &'static str,
    /// The value, or a starting value if the key is omitted.
    pub value: f64,
    /// Smallest possible value.
    pub least: f64,
    /// Largest possible value.
    pub greatest: f64,
    /// The unit, and what the range depends on.
    pub unit: &'static str,
    /// The reason for the range, as part of a sentence.
    pub reason: &'static str,
}

impl Limit {
    /// Whether the value is within the limits; NaN is not.
    ///
    /// ```
    /// use bead_plan::limit::{Limit, limit};
    ///
    /// let width = limit("bead.width", 6.0, (0.05, 100.0), "mm", "no bead is wider");
    /// assert!(width.holds());
    /// assert!(!Limit { value: 0.0, ..width }.holds() && !Limit { value: f64::NAN, ..width }.holds());
    /// ```
    pub fn holds(&self) -> bool {
        (self.least..=self.greatest).contains(&self.value)
    }
}

/// A section of the profile in which every key has a default: a row for each key, with its default and, for numbers,
/// the least and greatest value, the unit and the reason.
#[macro_export]
macro_rules! section {
    ($(#[$about:meta])* $name:ident $key:literal {
        $($(#[$doc:meta])*
        $field:ident: $type:ty = $default:expr $(, $least:expr, $greatest:expr, $unit:expr, $reason:expr)?;)*
    }) => {
        $(#[$about])*
        #[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
        #[serde(deny_unknown_fields, default)]
        #[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
        pub struct $name {
            $($(#[$doc])* pub $field: $type,)*
        }

        impl Default for $name {
            fn default() -> Self {
                Self { $($field: $default),* }
            }
        }

        impl $name {
            /// The limits of the numbers.
            pub fn limits(&self) -> Vec<$crate::limit::Limit> {
                [$($({
                    let (key, value) = (concat!($key, ".", stringify!($field)), $crate::limit::Given::from(self.$field));
                    $crate::limit::limit(key, value.or_between($least, $greatest), ($least, $greatest), $unit, $reason)
                },)?)*].to_vec()
            }
        }
    };
}
pub use section;

/// A number of a profile; none if the key is omitted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Given(Option<f64>);

impl Given {
    /// The number, or the middle of the range.
    pub fn or_between(self, least: f64, greatest: f64) -> f64 {
        self.0.unwrap_or(least.midpoint(greatest))
    }
}

impl From<f64> for Given {
    fn from(value: f64) -> Self {
        Self(Some(value))
    }
}

impl From<u32> for Given {
    fn from(value: u32) -> Self {
        Self(Some(value.into()))
    }
}

impl From<Option<f64>> for Given {
    fn from(value: Option<f64>) -> Self {
        Self(value)
    }
}

/// Why no layers, counted from 1, lie from the first to the last of these.
pub(crate) fn no_layers(from: usize, to: usize) -> Option<String> {
    let wrong = from == 0 || to < from;
    wrong.then(|| "layers count from 1, and the last must not come before the first.".to_owned())
}

/// What is impossible in a row for some layers, given the limits of what holds in them.
pub fn broken_row(section: &str, from: usize, to: usize, limits: &[Limit]) -> Option<Broken> {
    let out_of_range = || {
        let Limit { key, least, greatest, unit, reason, .. } = limits.iter().find(|limit| !limit.holds())?;
        let name = key.rsplit_once('.').map_or(*key, |(_, name)| name);
        Some(format!("its {name} must lie between {least} and {greatest} {unit}: {reason}."))
    };
    let reason = no_layers(from, to).or_else(out_of_range)?;
    let value = format!("{{ from = {from}, to = {to}, … }}");
    Some(Broken { key: format!("{section}.layers"), value, reason })
}

/// Rows of limits: key, value, least and greatest value, unit, reason.
#[macro_export]
macro_rules! limits {
    ($($key:literal: $value:expr, $least:expr, $greatest:expr, $unit:expr, $reason:expr;)*) => {
        vec![$($crate::limit::limit($key, $value, ($least, $greatest), $unit, $reason)),*]
    };
}
pub use limits;

/// A row: key, value, least and greatest value, unit, reason.
pub fn limit(
    key: &'static str,
    value: f64,
    (least, greatest): (f64, f64),
    unit: &'static str,
    reason: &'static str,
) -> Limit {
    Limit { key, value, least, greatest, unit, reason }
}

/// The reason for the limits of most keys of a dialect.
pub const CONTROLLER: &str = "the controller accepts no other values, or no real cell needs them";

/// The least value of numbers that must be above 0.
pub const TINY: f64 = 1e-3;

/// An impossible value.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Broken {
    /// Full key.
    pub key: String,
    /// The value as written in the profile.
    pub value: String,
    /// What would be right.
    pub reason: String,
}

impl Broken {
    /// An impossible text.
    pub fn text(key: &str, value: &str, reason: impl Into<String>) -> Self {
        Self { key: key.to_owned(), value: format!("\"{value}\""), reason: reason.into() }
    }
}
