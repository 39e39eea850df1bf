//! Relaxation of the solid.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Relaxation of the solid (generalised Maxwell solid): by a Prony series, or with a loss factor that is the same over a band of frequencies.
/// `young_modulus_pa` is then the modulus in the long term; bladders keep to it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Viscoelasticity {
    /// Branches of a Prony series, `E(t) = E (1 + sum g_k e^(-t/tau_k))`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 64))]
    pub prony: Vec<Branch>,
    /// A loss factor over a band.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub loss_factor: Option<LossFactor>,
}

/// A spring and a dashpot in series, beside the spring of the long term.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Branch {
    /// `g`: modulus of its spring over that in the long term.
    #[schemars(extend("exclusiveMinimum" = 0), range(max = 1e6))]
    pub modulus_ratio: f64,
    /// Relaxation time `tau` [s].
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub time_s: f64,
}

/// Loss modulus over storage modulus, constant over a band.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LossFactor {
    /// `eta = E''/E'`.
    #[schemars(extend("exclusiveMinimum" = 0), range(max = 2.0))]
    pub value: f64,
    /// Lower end of the band [Hz].
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub from_hz: f64,
    /// Upper end [Hz].
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub to_hz: f64,
}
