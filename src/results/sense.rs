//! `sense.json`: loads estimated from measured pressures.

use super::ResultFile;
pub use crate::study::sense::sensed::{
    BandKind, Banded, ChosenSensors, Combination, MeasurementRow, Noise, NoiseFrom, Sensed, Unknown,
};

impl ResultFile for Sensed {
    // 2: values of a profile are means around its places
    const FORMAT: u32 = 2;
}
