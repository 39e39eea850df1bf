//! Functions of time and place as a case writes them, what is known of them everywhere and not at samples alone.
//!
//! | file | what stands there |
//! |---|---|
//! | [`signals`], `evaluate` | functions of time: forms, values, derivatives, times at which they switch |
//! | `integral` | what a function of time adds up to |
//! | [`profile`] | functions of place: values, integrals, waves |
//! | `curve` | curves through points: tables of both |
//! | `jet` | a value with its first three derivatives |
//! | [`bounds`] | all values, largest rates, variation, what they excite: bounds, by interval arithmetic |
//! | `number_or_object` | how they are written in JSON |

pub mod bounds;
mod curve;
mod evaluate;
mod integral;
mod jet;
mod number_or_object;
pub mod profile;
pub mod signals;

pub use curve::{Curve, Interpolation};
pub use evaluate::MOST_KNOTS;
pub use profile::Profile;
pub use signals::{Clock, Jet, Ramp, RampShape, Signal};
