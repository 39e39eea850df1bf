//! The beam as a sensor: loads from measured pressures of its bladders.
//!
//! ```text
//! basis              loads of known position and unknown amplitude
//! pressures          measured pressures
//! pressures_at_rest  pressures at rest under loads
//! estimate           amplitudes from measurements, with confidence bands
//! load_prior         prior and posterior of a distributed load
//! local_mean         means of a distributed load around places
//! misfit             chi-square test of the residuals
//! weight             weight of the prior
//! choose             optimal choice of bladders to measure
//! observability      observability of loads by pressures
//! diagnostics        reports and doubts of an estimate
//! estimate_at_rest   estimate of a case at rest
//! in_time            pressures over time under time-dependent loads
//! over_time          estimate of time-dependent loads
//! sensed             the result
//! ```

pub mod basis;
pub mod choose;
mod diagnostics;
pub mod estimate;
pub mod estimate_at_rest;
pub mod in_time;
pub mod load_prior;
pub mod local_mean;
pub mod misfit;
mod observability;
mod over_time;
pub mod pressures;
pub mod pressures_at_rest;
pub mod sensed;
mod weight;
