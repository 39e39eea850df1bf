//! `sense.json`: loads behind measured pressures.

use super::Kept;
pub use crate::study::sense::sensed::{BandKind, Banded, Chosen, Combination, Noise, NoiseFrom, Row, Sensed, Unknown};

impl Kept for Sensed {}
