//! The beam as a sensor: loads from measured pressures of its bladders.
//!
//! ```text
//! basis      loads that are looked for, by their amplitudes
//! pressures  what was measured
//! rest       pressures at rest under loads
//! estimate   amplitudes from measurements, with bands
//! load_prior a distributed load before and after measurements
//! local_mean means of such a load around places
//! misfit     whether what they leave is noise
//! weight     that of what is known before
//! choose     which bladders to measure
//! sight      what pressures tell at all
//! told       what an estimate tells
//! find       all of it, of a case
//! in_time    pressures in time under loads that change
//! over_time  loads that change
//! sensed     what was found
//! ```

pub mod basis;
pub mod choose;
pub mod estimate;
pub mod find;
pub mod in_time;
pub mod load_prior;
pub mod local_mean;
pub mod misfit;
mod over_time;
pub mod pressures;
pub mod rest;
pub mod sensed;
mod sight;
mod told;
mod weight;
