//! The motions of KRL and their targets.

use crate::dialect::reading::trace::Stated;
use crate::dialect::reading::words::{compact, number};

/// Motions with (circular, relative, point to point).
pub(super) const MOTIONS: [(&str, Motion); 14] = [
    ("LIN", Motion::LIN),
    ("SLIN", Motion::LIN),
    ("PTP", Motion::PTP),
    ("SPTP", Motion::PTP),
    ("CIRC", Motion::CIRC),
    ("SCIRC", Motion::CIRC),
    ("SPL", Motion::SPL),
    ("LIN_REL", Motion::LIN.relative()),
    ("SLIN_REL", Motion::LIN.relative()),
    ("SPL_REL", Motion::SPL.relative()),
    ("PTP_REL", Motion::PTP.relative()),
    ("SPTP_REL", Motion::PTP.relative()),
    ("CIRC_REL", Motion::CIRC.relative()),
    ("SCIRC_REL", Motion::CIRC.relative()),
];

#[derive(Clone, Copy, Default)]
pub(super) struct Motion {
    pub(super) circular: bool,
    pub(super) joint: bool,
    pub(super) relative: bool,
    /// A curve through the points of a spline block.
    pub(super) free: bool,
}

impl Motion {
    const LIN: Self = Self { circular: false, joint: false, relative: false, free: false };
    const PTP: Self = Self { joint: true, ..Self::LIN };
    const CIRC: Self = Self { circular: true, ..Self::LIN };
    const SPL: Self = Self { free: true, ..Self::LIN };

    const fn relative(self) -> Self {
        Self { relative: true, ..self }
    }
}

/// The target of a motion, and what else it states.
#[derive(Clone, Copy)]
pub(super) struct Target {
    /// X, Y, Z, mm; `None` for axis angles.
    pub(super) place: Option<[Option<f64>; 3]>,
    pub(super) stated: Stated,
}

/// Speed in mm/s from `WITH $VEL.CP=0.1` after a motion.
pub(super) fn with_speed(rest: &str) -> Option<f64> {
    let flat = compact(rest.get(rest.find('$')?..)?);
    number_before(flat.strip_prefix("$VEL.CP=")?).map(|v| v * 1000.0)
}

/// The number at the start of the text.
pub(super) fn number_before(text: &str) -> Option<f64> {
    number(text.trim_start().split([',', '}', ' ', '$']).next()?)
}
