//! `sense.json`: loads estimated from measured pressures.

use super::Kept;
pub use crate::study::sense::sensed::{BandKind, Banded, Chosen, Combination, Noise, NoiseFrom, Row, Sensed, Unknown};

impl Kept for Sensed {
    // 2: values of a profile are means around its places
    const FORMAT: u32 = 2;
}
