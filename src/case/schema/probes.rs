//! Places that are recorded.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A place of the beam at which motion, strains, forces and pressures are recorded, a column of the history each.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Probe {
    /// What its columns begin with: letters, digits, `-` and `_`.
    pub name: String,
    /// Place `theta/l_s`, 0 at the root and 1 at the tip.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub at: f64,
}
