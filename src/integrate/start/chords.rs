//! Corrections with the factors of an earlier start, where values have changed by little since.

use super::{Newton, Start, StartOptions};
use crate::dae::Dae;
use crate::numerics::kernels;

/// Corrections with factors of an earlier start, at most.
const CHORDS: u16 = 8;

/// Contraction beyond which factors of an earlier start are given up.
const SLOW: f64 = 0.2;

impl<D: Dae> Newton<'_, D> {
    /// The start, if corrections with the factors of an earlier one lead to it; else values are as before.
    pub(super) fn with_old_factors(&mut self, options: &StartOptions) -> Option<Start> {
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

    fn chords(&mut self, options: &StartOptions) -> Option<Start> {
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
            // before there is a rate the worst that is let pass is taken for it
            let rate = if last.is_finite() { rate } else { SLOW };
            if rate / (1.0 - rate) * size <= options.tolerance {
                return Some(Start {
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

    /// Takes a correction, which becomes relative to 1 + |z|. Masks of 0 and 1 in place of a choice let this go several at a time.
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
