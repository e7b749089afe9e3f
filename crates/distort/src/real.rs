//! The two precisions: double for what is solved, single for what only makes it converge.

use std::ops::{Add, AddAssign, Mul, Sub};

/// A floating-point number.
pub(crate) trait Real:
    Copy + Default + Send + Sync + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + AddAssign
{
    fn of(value: f64) -> Self;
}

impl Real for f64 {
    fn of(value: f64) -> Self {
        value
    }
}

impl Real for f32 {
    fn of(value: f64) -> Self {
        value as f32
    }
}

/// One value per node and direction.
pub(crate) type Field<T> = Vec<[T; 3]>;
