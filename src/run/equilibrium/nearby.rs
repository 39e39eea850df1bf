//! Equilibria under loads that differ a little from those of a known equilibrium.

use super::sensitivity::{Derivative, ParameterDirection, along};
use super::stages::{begin, follow, grow};
use super::state::EquilibriumState;
use super::{EquilibriumOptions, Path};
use crate::case::schema::Case;
use crate::error::{Error, Result};
use crate::run::record::Control;
use crate::sundials::{Kinsol, KinsolOptions};

/// Number of Newton steps after which a known state counts as too far away.
const PATIENCE: u32 = 25;

/// An equilibrium, from which those under other loads are found without the path from rest.
#[derive(Clone, Debug)]
pub struct KnownEquilibrium {
    /// Path to the equilibrium; if it was found from another one, the path has only this state.
    pub path: Path,
    /// Unknowns in SI units, since their scales depend on the loads.
    unknowns: Vec<f64>,
}

impl KnownEquilibrium {
    /// Follows the path from rest.
    ///
    /// # Errors
    /// Those of [`follow`], and [`Error::Solver`] if the path ends early.
    pub fn follow(case: &Case, options: &EquilibriumOptions) -> Result<Self> {
        let options = &options.resolved(case)?;
        let mut path = follow(case, options, &mut |_| Control::Continue)?;
        if let Some(fault) = path.fault.take() {
            return Err(Error::Solver(Box::new(fault)));
        }
        let stages = options.stages();
        let scales = match stages.last() {
            Some(stage) => grow(case, stage)?.system.layout.scales.clone(),
            None => vec![],
        };
        let y = &path.last().y;
        let unknowns = y.iter().zip(&scales).map(|(y, scale)| y * scale).collect();
        Ok(Self { path, unknowns })
    }

    /// Finds the equilibrium of a case that differs only in its loads, by Newton's method from this one. `None` if the method fails, or
    /// if there are several stages of loads: the result then depends on the path.
    ///
    /// # Errors
    /// Those of [`crate::discrete::System::new`].
    pub fn beside(&self, case: &Case, options: &EquilibriumOptions) -> Result<Option<Self>> {
        let stages = options.resolved(case)?.stages();
        let [stage] = stages.as_slice() else {
            return Ok(None);
        };
        let (statics, _) = begin(case, grow(case, stage)?, None);
        let scales = statics.system().layout.scales.clone();
        if scales.len() != self.unknowns.len() {
            return Ok(None);
        }
        let mut y: Vec<f64> = self.unknowns.iter().zip(&scales).map(|(x, scale)| x / scale).collect();
        let Ok(mut solver) = Kinsol::new(statics) else {
            return Ok(None);
        };
        let options = KinsolOptions {
            max_iterations: PATIENCE,
            ..KinsolOptions::default()
        };
        let Ok(work) = solver.solve(1.0, &mut y, &options) else {
            return Ok(None);
        };
        let unknowns = y.iter().zip(&scales).map(|(y, scale)| y * scale).collect();
        y.push(1.0);
        let state = EquilibriumState::read(solver.dae_mut(), &y, 0);
        let path = Path {
            states: vec![state],
            work,
            ..Path::default()
        };
        Ok(Some(Self { path, unknowns }))
    }

    /// Values of the equilibrium, in the order of [`super::columns`].
    pub fn row(&self) -> &[f64] {
        &self.path.last().row
    }

    /// Derivatives along changes of its case.
    ///
    /// # Errors
    /// As [`along`].
    pub fn along(
        &self,
        case: &Case,
        options: &EquilibriumOptions,
        directions: &[ParameterDirection],
    ) -> Result<Vec<Derivative>> {
        along(case, options, &self.path, directions)
    }
}
