//! Origin of a result: program, libraries and method. It contains nothing of the machine, so that the same program gives the same result of
//! a case on every machine.

use serde::{Deserialize, Serialize};

use crate::case::schema::Method;
use crate::integrate::Counters;
use crate::sparse::suitesparse_version;
use crate::sundials::sundials_version;

/// Origin of a result.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Provenance {
    /// Name of the program.
    pub program: String,
    /// Its version.
    pub version: String,
    /// Commit of its sources, followed by `+` if they had been changed; absent if they were built outside a checkout.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub commit: Option<String>,
    /// Version of SUNDIALS.
    pub sundials: String,
    /// Version of SuiteSparse.
    pub suitesparse: String,
    /// Method of time integration, if one method applies to the entire result.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub method: Option<IntegratorRecord>,
}

/// A method of time integration.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct IntegratorRecord {
    /// Its name; never "auto".
    pub name: Method,
    /// Its order; for IDA the highest allowed order.
    pub order: u8,
}

impl IntegratorRecord {
    /// Integrator recorded in counters.
    pub fn from_counters(counters: &Counters) -> Option<Self> {
        let order = counters.max_order;
        counters.method.map(|name| Self { name, order })
    }
}

impl Provenance {
    /// Origin of a result of this program.
    pub fn new(method: Option<IntegratorRecord>) -> Self {
        Self {
            program: env!("CARGO_PKG_NAME").into(),
            version: env!("CARGO_PKG_VERSION").into(),
            commit: option_env!("SLCBEAM_COMMIT").map(str::to_owned),
            sundials: sundials_version(),
            suitesparse: suitesparse_version(),
            method,
        }
    }

    /// `slcbeam 0.2.0 (0123456789ab) with SUNDIALS 6.4.1 and SuiteSparse 5.12.0`.
    pub fn describe(&self) -> String {
        let commit = self
            .commit
            .as_ref()
            .map_or(String::new(), |commit| format!(" ({commit})"));
        format!(
            "{} {}{commit} with SUNDIALS {} and SuiteSparse {}",
            self.program, self.version, self.sundials, self.suitesparse
        )
    }
}
