//! Equations of equilibrium with the load factor as an additional unknown.

use crate::dae::{Dae, EvaluationError, Seeds, StaticBeam};
use crate::discrete::ValveTangents;
use crate::sparse::Pattern;

/// `[E30]` A point of the load path: n equations of equilibrium for n unknowns y and the share s of the loads. One more equation
/// fixes the position along the path (Keller's pseudo-arclength):
///
/// ```text
/// F(s, y) = 0        d·(y, s) = a        the path follower chooses d and a
/// ```
///
/// At a limit point, where the path turns back in s, this system remains regular, unlike F alone. With `d = (0, 1)` it describes
/// equilibrium under the share a.
pub struct Arclength {
    statics: StaticBeam,
    pattern: Pattern,
    /// `d`, length n + 1.
    pub direction: Vec<f64>,
    /// `a`.
    pub position: f64,
    inner: Vec<f64>,
    above: Vec<f64>,
    below: Vec<f64>,
    none: Vec<bool>,
}

/// Difference of shares for `∂F/∂s`. Dead and follower loads are linear in s; driven ends are not.
const DIFFERENCE: f64 = 1e-4;

impl Arclength {
    /// Creates the equations for a beam under a share of its loads.
    pub fn new(statics: StaticBeam) -> Self {
        let n = statics.len();
        let inner = statics.pattern();
        let columns = |j: usize| inner.rows[inner.column(j)].iter().map(|&row| row as usize);
        let mut all: Vec<Vec<usize>> = (0..n).map(|j| columns(j).chain([n]).collect()).collect();
        all.push((0..=n).collect());
        let mut direction = vec![0.0; n + 1];
        direction[n] = 1.0;
        Self {
            inner: vec![0.0; inner.entries()],
            pattern: Pattern::from_columns(&all),
            direction,
            position: 0.0,
            above: vec![0.0; n],
            below: vec![0.0; n],
            none: vec![false; n + 1],
            statics,
        }
    }

    /// The beam, read-only.
    pub fn statics_ref(&self) -> &StaticBeam {
        &self.statics
    }

    /// The beam, mutable.
    pub fn statics(&mut self) -> &mut StaticBeam {
        &mut self.statics
    }

    /// Selects equilibrium under a load factor.
    pub fn at_share(&mut self, share: f64) {
        self.direction.fill(0.0);
        self.direction[self.none.len() - 1] = 1.0;
        self.position = share;
    }

    /// Computes `∂F/∂s` into `above`, with linearized valves: the opening pressure of a valve may be small relative to the difference.
    fn by_share(&mut self, y: &[f64], s: f64) -> Result<(), EvaluationError> {
        if ValveTangents::needed(self.statics.system()) {
            self.statics.residual(s, y, &[], &mut self.above)?;
            self.statics.linearize_valves(true);
        }
        let above = self.statics.residual(s + DIFFERENCE, y, &[], &mut self.above);
        let below = self.statics.residual(s - DIFFERENCE, y, &[], &mut self.below);
        self.statics.linearize_valves(false);
        above.and(below)?;
        for (above, below) in self.above.iter_mut().zip(&self.below) {
            *above = (*above - below) / (2.0 * DIFFERENCE);
        }
        Ok(())
    }
}

impl Dae for Arclength {
    fn len(&self) -> usize {
        self.none.len()
    }

    fn differential(&self) -> &[bool] {
        &self.none
    }

    fn pattern(&self) -> &Pattern {
        &self.pattern
    }

    fn residual(&mut self, _: f64, y: &[f64], _: &[f64], residual: &mut [f64]) -> Result<(), EvaluationError> {
        let n = y.len() - 1;
        self.statics.residual(y[n], &y[..n], &[], &mut residual[..n])?;
        residual[n] = self.direction.iter().zip(y).map(|(d, x)| d * x).sum::<f64>() - self.position;
        Ok(())
    }

    fn jacobian(
        &mut self,
        _: f64,
        y: &[f64],
        _: &[f64],
        seeds: Seeds<'_>,
        values: &mut [f64],
    ) -> Result<(), EvaluationError> {
        let n = y.len() - 1;
        self.statics.jacobian(y[n], &y[..n], &[], seeds, &mut self.inner)?;
        self.by_share(&y[..n], y[n])?;
        let mut to = 0;
        for column in 0..n {
            for entry in self.statics.pattern().column(column) {
                values[to] = self.inner[entry];
                to += 1;
            }
            values[to] = self.direction[column];
            to += 1;
        }
        values[to..to + n].copy_from_slice(&self.above);
        values[to + n] = self.direction[n];
        Ok(())
    }

    fn name(&self, unknown: usize) -> String {
        if unknown + 1 == self.none.len() {
            "the load factor".into()
        } else {
            self.statics.name(unknown)
        }
    }
}
