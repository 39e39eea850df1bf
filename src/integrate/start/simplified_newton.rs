//! Simplified Newton iteration with the factors of an earlier start, for values that have changed little since.

use super::{ConsistentStart, Newton, StartOptions};
use crate::dae::Dae;
use crate::numerics::kernels;

/// Maximum number of corrections with factors of an earlier start.
const CHORDS: u16 = 8;

/// Contraction rate above which factors of an earlier start are discarded.
const SLOW: f64 = 0.2;

impl<D: Dae> Newton<'_, D> {
    /// Returns the start if the iteration with the factors of an earlier one converges; otherwise restores the values.
    pub(super) fn with_old_factors(&mut self, options: &StartOptions) -> Option<ConsistentStart> {
        if !self.room.factored {
            return None;
        }
        let mut guess = std::mem::take(&mut self.room.guess);
        for (i, guess) in guess.iter_mut().enumerate() {
            *guess = self.unknown(i);
        }
        let start = self.chords(options);
        if start.is_none() {
            for (i, guess) in guess.iter().enumerate() {
                *self.unknown_mut(i) = *guess;
            }
            self.iterations = 0;
        }
        self.room.guess = guess;
        start
    }

    fn chords(&mut self, options: &StartOptions) -> Option<ConsistentStart> {
        let mut last = f64::INFINITY;
        while self.iterations < CHORDS {
            self.evaluate().ok()?;
            let residual = kernels::max_abs(&self.room.residual);
            let mut correction = std::mem::take(&mut self.room.correction);
            correction.copy_from_slice(&self.room.residual);
            self.room.klu.solve(&mut correction);
            let finite = kernels::all_finite(&correction);
            if finite {
                self.correct(&mut correction);
            }
            let size = kernels::max_abs(&correction);
            self.room.correction = correction;
            self.iterations += 1;
            let rate = size / last;
            if !(finite && rate <= SLOW) {
                return None;
            }
            // until a contraction rate is measured, assume the largest accepted one
            let rate = if last.is_finite() { rate } else { SLOW };
            if rate / (1.0 - rate) * size <= options.tolerance {
                return Some(ConsistentStart {
                    iterations: self.iterations,
                    residual_evaluations: self.residuals,
                    correction: size,
                    residual,
                });
            }
            last = size;
        }
        None
    }

    /// Subtracts a correction and then divides it by 1 + |z|. Masks of 0 and 1 replace branches, so that several entries are processed at
    /// once.
    fn correct(&mut self, correction: &mut [f64]) {
        let masks = self.room.y_seeds.iter().zip(&self.room.yp_seeds);
        let values = self.y.iter_mut().zip(self.yp.iter_mut());
        for ((correction, (algebraic, differential)), (y, yp)) in correction.iter_mut().zip(masks).zip(values) {
            let z = algebraic * *y + differential * *yp;
            *y -= algebraic * *correction;
            *yp -= differential * *correction;
            *correction /= 1.0 + z.abs();
        }
    }
}
