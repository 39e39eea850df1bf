//! Common parts of all integrators: requests, consistent initial values, work counters and errors.
//!
//! | file | content |
//! |---|---|
//! | [`tolerances`] | absolute tolerances |
//! | [`start`], [`sensitivity_start`] | consistent initial values, also of derivatives by parameters |
//! | `request` | checks before an integration and before a step |
//! | [`counters`] | work counters and wall times |
//! | [`halt`] | requests to stop early |
//! | [`failure`] | errors |

pub mod counters;
pub mod failure;
pub mod halt;
pub(crate) mod request;
pub mod sensitivity_start;
pub mod start;
pub mod tolerances;

pub use counters::{Counters, SolverWallTimes};
pub(crate) use failure::not_finite;
pub use failure::{IntegrationError, WorstUnknown};
pub use sensitivity_start::consistent_sensitivities;
pub use start::{ConsistentStart, StartError, StartOptions, Starter, consistent_start};
pub use tolerances::AbsoluteTolerances;
