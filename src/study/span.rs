//! `POINTER=LOW:HIGH`: a number of a case and the bounds within which it is sought.

use serde::{Deserialize, Serialize};

use super::sweep::vary::{check_pointer, numbers};
use crate::error::{Error, Result};

/// Ratio of the bounds from which on a number is sought by its logarithm.
const DECADE: f64 = 10.0;

/// A number that is sought, and where.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Span {
    /// JSON pointer into the case.
    pub pointer: String,
    /// Lower bound, in the unit that the key names.
    pub low: f64,
    /// Upper bound.
    pub high: f64,
}

impl Span {
    /// Of `POINTER=LOW:HIGH`.
    ///
    /// # Errors
    /// [`Error::Usage`] with what is wanted.
    pub fn parse(text: &str) -> Result<Self> {
        let wrong = |what: String| Error::Usage(format!("--vary '{text}': {what}"));
        let wanted = "a JSON pointer and two bounds are wanted, such as /fluid/viscosity_pa_s=1e-4:1e-2";
        let (pointer, bounds) = text.split_once('=').ok_or_else(|| wrong(wanted.into()))?;
        check_pointer(pointer).map_err(wrong)?;
        match numbers(bounds).map_err(wrong)?[..] {
            [low, high] if low < high => Ok(Self {
                pointer: pointer.into(),
                low,
                high,
            }),
            [low, high] => Err(wrong(format!("{low} is not below {high}; POINTER=LOW:HIGH"))),
            _ => Err(wrong(wanted.into())),
        }
    }

    /// Whether it is sought by its logarithm: bounds of one sign, a decade or more apart.
    pub fn logarithmic(&self) -> bool {
        let sizes = [self.low.abs(), self.high.abs()];
        self.low * self.high > 0.0 && sizes[0].max(sizes[1]) >= DECADE * sizes[0].min(sizes[1])
    }

    /// The value at a place between the bounds, 0 to 1.
    pub fn value(&self, place: f64) -> f64 {
        match place {
            0.0 => self.low,
            1.0 => self.high,
            _ if self.logarithmic() => self.low * (self.high / self.low).powf(place),
            _ => self.low + (self.high - self.low) * place,
        }
    }

    /// The place of a value between the bounds: 0 at the lower, 1 at the upper.
    pub fn place(&self, value: f64) -> f64 {
        if self.logarithmic() {
            (value / self.low).ln() / (self.high / self.low).ln()
        } else {
            (value - self.low) / (self.high - self.low)
        }
    }

    /// Derivative of the value by its place, at a value.
    pub fn slope(&self, value: f64) -> f64 {
        if self.logarithmic() {
            value * (self.high / self.low).ln()
        } else {
            self.high - self.low
        }
    }

    /// Whether a value is within the bounds.
    pub fn holds(&self, value: f64) -> bool {
        (self.low..=self.high).contains(&value)
    }
}
