//! Recorded places, and the step whose response is reported.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A place of the beam at which motion, strains, forces and pressures are recorded, a column of the history each.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Probe {
    /// Beginning of the names of its columns: letters, digits, `-` and `_`.
    pub name: String,
    /// Place `theta/l_s`, 0 at the root and 1 at the tip.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub at: f64,
}

/// A step whose response is in `summary.json`, of the tip and at probes: rise time, settling times, overshoot.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Step {
    /// When the step is: times count from here, and the way from the value here \[s\].
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub at_s: f64,
}
