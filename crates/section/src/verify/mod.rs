//! Comparison of computed values on successive meshes with exact results.

mod channels;
mod prisms;
mod symmetry;
mod tube;

pub use channels::compare as channels;
pub use prisms::{finite_strain, layers, patches, three_dimensions};
pub use symmetry::compare as symmetry;
pub use tube::compare as tubes;

use crate::error::Error;
use crate::estimate;
use crate::input::Material;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Comparison with one exact result.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Comparison {
    /// Compared quantity, with its unit.
    pub name: String,
    /// Source of the exact value.
    pub source: String,
    /// Exact value.
    pub exact: f64,
    /// Computed values on successive meshes, coarsest first.
    pub computed: Vec<f64>,
    /// Observed order of the last two errors; None if they are rounding errors or change sign.
    pub order: Option<f64>,
    /// Largest accepted error.
    pub tolerance: f64,
}

/// Relative errors below this are rounding errors: the condition number of a nearly incompressible cell times 1e-16.
pub const ROUND_OFF: f64 = 1e-10;
/// Largest error of values that three coarse meshes only approximate: the accuracy goal of every coefficient.
pub const APPROACHED: f64 = 1e-3;
/// Smallest accepted order: energies of quadratic elements converge with fourth order, slightly less on coarse meshes.
pub const LEAST_ORDER: f64 = 3.3;

impl Comparison {
    /// Compares values on successive meshes with an exact one.
    pub fn new(name: impl Into<String>, source: &str, exact: f64, computed: Vec<f64>) -> Self {
        let scale = if exact == 0.0 { 1.0 } else { exact.abs() };
        let errors: Vec<f64> = computed.iter().map(|c| (c - exact) / scale).collect();
        // Errors that change sign determine no order.
        let one_sided = errors.iter().all(|e| e * errors[0] > 0.0);
        let last = errors.last_chunk::<2>().filter(|e| one_sided && e[1].abs() > ROUND_OFF);
        let order = last.map(|[a, b]| (a / b).log2());
        Self {
            name: name.into(),
            source: source.to_owned(),
            exact,
            computed,
            order,
            tolerance: APPROACHED,
        }
    }

    /// Comparison for a field that the elements represent exactly.
    fn held_exactly(self) -> Self {
        self.within(ROUND_OFF)
    }

    fn within(self, tolerance: f64) -> Self {
        Self { tolerance, ..self }
    }

    /// Relative error on the finest mesh; absolute if the exact value is zero.
    pub fn error(&self) -> f64 {
        let scale = if self.exact == 0.0 { 1.0 } else { self.exact.abs() };
        self.computed
            .last()
            .map_or(f64::NAN, |c| (c - self.exact).abs() / scale)
    }

    /// Error estimated from the meshes; None for values that are exact up to rounding errors.
    pub fn estimate(&self) -> Option<f64> {
        (self.tolerance == APPROACHED).then(|| estimate::estimate(&self.computed, estimate::SMOOTH).relative_error)
    }
}

/// Material of an arbitrary density.
fn material(young_modulus_pa: f64, poisson_ratio: f64) -> Material {
    Material {
        young_modulus_pa,
        poisson_ratio,
        density_kg_m3: 1000.0,
        law: None,
    }
}

/// Function that computes the comparisons of one subject.
pub type Compare = fn() -> Result<Vec<Comparison>, Error>;

const ALL: [Compare; 7] = [
    layers,
    patches,
    tubes,
    channels,
    finite_strain,
    three_dimensions,
    symmetry,
];

/// Returns all comparisons.
pub fn verify() -> Result<Vec<Comparison>, Error> {
    ALL.iter().try_fold(vec![], |mut all, compare| {
        all.extend(compare()?);
        Ok(all)
    })
}
