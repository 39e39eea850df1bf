//! The beam as a sensor: loads from measured pressures of its bladders.
//!
//! ```text
//! basis      loads that are looked for, by their amplitudes
//! pressures  what was measured
//! rest       pressures at rest under loads
//! estimate   amplitudes from measurements, with bands
//! weight     that of what is known before
//! choose     which bladders to measure
//! find       all of it, of a case
//! sensed     what was found
//! ```

pub mod basis;
pub mod choose;
pub mod estimate;
pub mod find;
pub mod pressures;
pub mod rest;
pub mod sensed;
mod weight;
