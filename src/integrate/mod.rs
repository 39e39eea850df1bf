//! What every integrator shares: what is asked of it, where it begins, what it tells of its work and its failures.
//!
//! | file | what stands there |
//! |---|---|
//! | [`tolerances`] | absolute tolerances |
//! | [`start`], [`sensitivity_start`] | consistent initial values, and those of derivatives by parameters |
//! | `request` | what is checked before it begins, and before a step |
//! | [`counters`] | what it did, and where the time went |
//! | [`halt`] | whether whoever asked wants it to end |
//! | [`failure`] | why it could not go on |

pub mod counters;
pub mod failure;
pub mod halt;
pub(crate) mod request;
pub mod sensitivity_start;
pub mod start;
pub mod tolerances;

pub use counters::{Counters, Wall};
pub(crate) use failure::not_finite;
pub use failure::{IntegrationError, Worst};
pub use sensitivity_start::consistent_sensitivities;
pub use start::{Start, StartError, StartOptions, Starter, consistent_start};
pub use tolerances::Absolute;
