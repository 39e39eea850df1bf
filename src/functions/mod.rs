//! Functions of time and place in a case, with bounds that also cover the points between samples.
//!
//! | file | content |
//! |---|---|
//! | [`signals`], `evaluate` | functions of time: types, values, derivatives, switching times |
//! | [`control`] | controllers: laws and outputs |
//! | `integral` | integrals of functions of time |
//! | [`profile`] | functions of place: values, integrals, waves |
//! | `curve` | curves through points, for tables of both |
//! | `moved_curve` | curves that are extended piece by piece |
//! | `jet` | a value with its first three derivatives |
//! | [`bounds`] | bounds of values, rates, variation and excitation, by interval arithmetic |
//! | `number_or_object` | JSON format |

pub mod bounds;
pub mod control;
mod curve;
mod evaluate;
mod integral;
mod jet;
mod moved_curve;
mod number_or_object;
pub mod profile;
pub mod signals;

pub use curve::{Interpolation, PiecewiseCurve};
pub use evaluate::MOST_KNOTS;
pub use profile::Profile;
pub use signals::{Jet, Ramp, RampShape, Signal, SmoothTime};
