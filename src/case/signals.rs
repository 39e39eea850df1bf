//! Functions of time with exact first and second derivatives.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Value of a signal with its first and second time derivative.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Jet {
    /// Value.
    pub value: f64,
    /// First derivative [1/s].
    pub rate: f64,
    /// Second derivative [1/s^2].
    pub acceleration: f64,
}

/// Time, and the smooth interval in which it is looked at.
///
/// Signals with kinks or jumps choose their branch by `within`, an instant inside the interval between two
/// switching times, and evaluate that branch at `t`: inside one interval the model is smooth up to and at both ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clock {
    /// Time [s].
    pub t: f64,
    /// An instant strictly inside the current smooth interval [s].
    pub within: f64,
}
