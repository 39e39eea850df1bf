//! States at rest under loads that differ a little from those of a known state.

use super::sensitivity::{Derivative, Direction, along};
use super::stages::{begin, follow, grow};
use super::state::State;
use super::{Options, Path};
use crate::case::schema::Case;
use crate::error::{Error, Result};
use crate::run::record::Control;
use crate::sundials::{Kinsol, KinsolOptions};

/// Newton steps after which a known state counts as too far away.
const PATIENCE: u32 = 25;

/// A state at rest, from which those under other loads are found without the path from rest.
#[derive(Clone, Debug)]
pub struct Resting {
    /// The path to it; of a state found from another one it has that state alone.
    pub path: Path,
    /// Unknowns in SI units: their scales go with the loads.
    unknowns: Vec<f64>,
}

impl Resting {
    /// Along the path from rest.
    ///
    /// # Errors
    /// Those of [`follow`], and [`Error::Solver`] where the path ends early.
    pub fn follow(case: &Case, options: &Options) -> Result<Self> {
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

    /// The state of a case that differs in its loads alone, by Newton's method from this one. None where that finds none, or where loads
    /// follow one another: what is found then depends on the path.
    ///
    /// # Errors
    /// Those of [`crate::discrete::System::new`].
    pub fn beside(&self, case: &Case, options: &Options) -> Result<Option<Self>> {
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
        let state = State::read(solver.dae_mut(), &y, 0);
        let path = Path {
            states: vec![state],
            work,
            ..Path::default()
        };
        Ok(Some(Self { path, unknowns }))
    }

    /// What is read off it, in the order of [`super::columns`].
    pub fn row(&self) -> &[f64] {
        &self.path.last().row
    }

    /// Derivatives along changes of its case.
    ///
    /// # Errors
    /// As [`along`].
    pub fn along(&self, case: &Case, options: &Options, directions: &[Direction]) -> Result<Vec<Derivative>> {
        along(case, options, &self.path, directions)
    }
}
