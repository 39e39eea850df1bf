//! Modes beside a cluster of decays, such as the overdamped vibrations of a solid with material damping, whose rates tend to one
//! value. A search from zero cannot separate these and stops at them. Further oscillations are searched one by one along the
//! imaginary axis, which is far from the cluster.

use nalgebra::Complex;

use super::{FluidBehavior, Linearised, Mode, Shapes, Tally, failed, mode, reach};
use crate::error::Result;
use crate::spectral::{self, EigenvalueOptions, Pencil, SpectralError};

/// Numbers of pairs searched beside a place on the imaginary axis: several, or fewer if they do not converge.
const BESIDE: [usize; 3] = [4, 2, 1];
/// Ratio of successive places.
const STEP: f64 = 1.25;
/// Number of places without a new oscillation after which the search ends.
const PATIENCE: usize = 8;
/// Relative distance up to which two eigenvalues count as equal.
const SAME: f64 = 1e-6;

/// A search from zero of which only a part of the eigenvalues converged.
pub struct PartialSearch {
    /// Start of the search.
    pub shift: Complex<f64>,
    /// Number of eigenvalues that converged.
    pub converged: usize,
    /// Number of requested modes.
    pub wanted: usize,
}

impl PartialSearch {
    /// Finds the modes nearer than the cluster, and the oscillations beyond it. Also returns the distance from zero within which
    /// every mode is found.
    ///
    /// # Errors
    /// The search was interrupted.
    pub fn modes(
        &self,
        about: &Linearised,
        fluid: FluidBehavior,
        pencil: &Pencil,
        tally: &mut Tally,
    ) -> Result<(Vec<Mode>, f64)> {
        let fewer = |count: &usize| (*count > 3).then_some(count / 2);
        let counts: Vec<usize> = std::iter::successors(Some(self.converged), fewer).collect();
        let (mut modes, radius) = near(about, fluid, pencil, (self.shift, &counts), tally)?;
        let size = |modes: &[Mode]| modes.iter().map(|mode| mode.s.norm()).fold(0.0, f64::max);
        let moving = |modes: &[Mode]| modes.iter().filter(|mode| !mode.kind.stays()).count();
        let (mut place, mut without) = (STEP * size(&modes), 0);
        while moving(&modes) < self.wanted && without < PATIENCE && place > 0.0 {
            let (found, _) = near(about, fluid, pencil, (Complex::new(0.0, place), &BESIDE), tally)?;
            let before = modes.len();
            for one in found.into_iter().filter(|one| one.kind.swings()) {
                let known = |own: &Mode| (own.s - one.s).norm() <= SAME * one.s.norm();
                if !modes.iter().any(known) {
                    modes.push(one);
                }
            }
            without = if modes.len() > before { 0 } else { without + 1 };
            place *= STEP;
        }
        Ok((modes, radius))
    }
}

/// Modes nearest to a place, for the first of the counts that converges, and the distance from zero within which these are all.
fn near(
    about: &Linearised,
    fluid: FluidBehavior,
    pencil: &Pencil,
    (shift, counts): (Complex<f64>, &[usize]),
    tally: &mut Tally,
) -> Result<(Vec<Mode>, f64)> {
    for &count in counts {
        match spectral::nearest(pencil, shift, count, &EigenvalueOptions::default()) {
            Ok(found) => {
                tally.factorizations += found.factorizations;
                tally.solves += found.solves;
                if fluid == FluidBehavior::Flowing {
                    tally.finite = found.finite;
                }
                let mut shapes = Shapes::new(about);
                let modes = found.pairs.iter().filter_map(|pair| mode(about, &mut shapes, pair));
                return Ok((modes.collect(), reach(&found.pairs, shift, Complex::default())));
            }
            Err(SpectralError::Interrupted) => return Err(failed(about, &SpectralError::Interrupted)),
            Err(_) => {}
        }
    }
    Ok((vec![], 0.0))
}
