//! What logs measure, and in which units.

/// A measured quantity.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// Wire feed speed, m/min.
    Feed,
    /// Arc current, A.
    Current,
    /// Arc voltage, V.
    Voltage,
    /// Speed of the torch, mm/s.
    Speed,
    /// Temperature seen by a pyrometer, °C.
    Temperature,
    /// Whether the arc burns: 1 or 0.
    Arc,
}

impl Quantity {
    /// All of them.
    pub const ALL: [Self; 6] = [Self::Feed, Self::Current, Self::Voltage, Self::Speed, Self::Temperature, Self::Arc];

    /// Those that a plan prescribes.
    pub const PLANNED: [Self; 4] = [Self::Feed, Self::Current, Self::Voltage, Self::Speed];

    /// The name of its column.
    pub fn name(self) -> &'static str {
        match self {
            Self::Feed => "wire_feed_speed",
            Self::Current => "current",
            Self::Voltage => "voltage",
            Self::Speed => "speed",
            Self::Temperature => "temperature",
            Self::Arc => "arc",
        }
    }

    /// What people call it.
    pub fn word(self) -> &'static str {
        match self {
            Self::Feed => "wire feed",
            _ => self.name(),
        }
    }

    /// Its unit; none for the arc.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Feed => "m/min",
            Self::Current => "A",
            Self::Voltage => "V",
            Self::Speed => "mm/s",
            Self::Temperature => "°C",
            Self::Arc => "",
        }
    }

    /// The quantity in a column of this name, without its unit.
    pub fn named(name: &str) -> Option<Self> {
        Some(match name {
            "wire_feed_speed" | "wire_feed" | "feed" | "wfs" => Self::Feed,
            "current" | "i" => Self::Current,
            "voltage" | "u" => Self::Voltage,
            "speed" | "travel_speed" | "deposition_speed" | "tcp_speed" => Self::Speed,
            "temperature" | "interpass_temperature" => Self::Temperature,
            "arc" | "arc_on" => Self::Arc,
            _ => return None,
        })
    }

    /// Values of a column in `unit` become this quantity: `scale` × value + `shift`. An empty unit is its own.
    pub fn from_unit(self, unit: &str) -> Option<(f64, f64)> {
        if unit.is_empty() || unit == self.unit() {
            return Some((1.0, 0.0));
        }
        let scale = match (self, unit) {
            (Self::Feed, "mm/s") => 0.06,
            (Self::Feed, "mm/min") => 1e-3,
            (Self::Feed, "cm/min") => 0.01,
            (Self::Feed, "in/min" | "ipm") => 0.0254,
            (Self::Speed, "mm/min") => 1.0 / 60.0,
            (Self::Speed, "cm/min") => 1.0 / 6.0,
            (Self::Speed, "m/min") => 1000.0 / 60.0,
            (Self::Speed, "m/s") | (Self::Current, "kA") => 1000.0,
            (Self::Speed, "in/min" | "ipm") => 25.4 / 60.0,
            (Self::Current | Self::Voltage, "mA" | "mV") => 1e-3,
            (Self::Temperature, "K") => return Some((1.0, -273.15)),
            (Self::Temperature, "°F" | "F") => return Some((5.0 / 9.0, -160.0 / 9.0)),
            (Self::Temperature, "C") => 1.0,
            _ => return None,
        };
        Some((scale, 0.0))
    }
}
