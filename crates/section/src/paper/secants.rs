//! The paper's plus and minus compliances as secants of a cell at finite strain.
//!
//! The paper's finite elements have "geometric nonlinearity yet limiting for a Hookean linear elastic material": the
//! Saint-Venant-Kirchhoff law. With this law a bladder closes more easily than it opens, as printed. A neo-Hookean
//! solid shows the opposite in extension, and near symmetry in bending. The asymmetry is a property of the law, not of
//! the structure.

use super::section;
use crate::cell::Cell;
use crate::coefficients::Options;
use crate::error::Error;
use crate::finite::{Drive, FiniteCell, Law, SectionState};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Secants of one cell under opposite loads.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Secants {
    /// Load: force [N] or moment [N m].
    pub load: f64,
    /// Area per load of the bladder that opens [m^2/N or m^2/(N m)]; the paper's "minus".
    pub opening: f64,
    /// Area per load of the bladder that closes; the paper's "plus".
    pub closing: f64,
    /// Load per strain under the opening load, relative to the full section: f_e or f_i.
    pub stiffness_factor: f64,
}

/// The paper's cell under a law, meshed once.
pub struct Experiment {
    cell: FiniteCell,
}

impl Experiment {
    /// Cell with square bladders of this fillet at this height.
    pub fn new(poisson_ratio: f64, fillet_m: f64, center_m: f64, law: Law) -> Result<Self, Error> {
        let section = section(poisson_ratio, fillet_m, center_m);
        let meshes = section.meshes(&Options {
            meshes: 1,
            ..Options::default()
        })?;
        Ok(Self {
            cell: FiniteCell::new(&section, Cell::new(&section, &meshes[0]), law)?,
        })
    }

    fn under(&self, force: f64, moment: f64) -> Result<SectionState, Error> {
        self.cell.equilibrium(Drive::Load([force, moment]), [0.0; 2])
    }

    /// Secants under axial forces of both signs.
    pub fn force(&self, load: f64) -> Result<Secants, Error> {
        let (pulled, pressed) = (self.under(load, 0.0)?, self.under(-load, 0.0)?);
        let [opening, closing] = [pulled.areas_m2[0] / load, -pressed.areas_m2[0] / load];
        Ok(Secants {
            load,
            opening,
            closing,
            stiffness_factor: self.extension(load)?,
        })
    }

    /// f_e as a secant under tension.
    pub fn extension(&self, load: f64) -> Result<f64, Error> {
        Ok(load / self.under(load, 0.0)?.strain[0] / (2e6 * 0.05 * 0.0216))
    }

    /// Secants under a moment: the upper row opens, the lower one closes.
    pub fn moment(&self, load: f64) -> Result<Secants, Error> {
        let bent = self.under(0.0, load)?;
        let [opening, closing] = [bent.areas_m2[0] / load, -bent.areas_m2[1] / load];
        let stiffness_factor = load / bent.strain[1] * 12.0 / (2e6 * 0.05 * 0.0216_f64.powi(3));
        Ok(Secants {
            load,
            opening,
            closing,
            stiffness_factor,
        })
    }
}
