//! Newton's matrix `∂F/∂y + cj ∂F/∂y'`, its factors, and the criteria for renewing it.

use std::time::{Duration, Instant};

use super::equations::{Equations, StageError};
use crate::dae::{Corotation, Dae};
use crate::sparse::{KluError, Lu};

/// Contraction rate assumed before one is measured: the remaining error then equals the correction.
const UNKNOWN_RATE: f64 = 0.5;
/// Measured contraction rate above which a new matrix is worthwhile.
const SLOW: f64 = 0.1;
/// Relative change of `cj` that requires a new matrix once two successive steps have equal sizes.
const STEADY_BAND: f64 = 5e-3;
/// Relative difference up to which two sizes count as equal.
const SAME_SIZE: f64 = 1e-6;

/// Factors of Newton's matrix with their history.
pub(super) struct Matrix {
    pub lu: Lu,
    /// True if the beam has rotated since a matrix was computed, now or before.
    pub has_turned: bool,
    /// Rotation of the beam since the present matrix was computed.
    pub corotation: Corotation,
    values: Vec<f64>,
    /// `cj` of the factors; 0 without factors.
    cj: f64,
    /// `cj` of the last step attempt; 0 before the first.
    attempted: f64,
    /// Last measured contraction rate of Newton's iteration with these factors.
    pub rate: f64,
    /// Requires new factors at the next stage.
    pub stale: bool,
    /// True if the factors were computed in the present attempt.
    pub fresh: bool,
    slow: bool,
    pub solves: u64,
    pub wall: Duration,
    /// Column of the last matrix that had no pivot.
    pub singular: Option<usize>,
}

impl Matrix {
    pub fn new(lu: Lu, corotation: Corotation) -> Self {
        Self {
            values: vec![0.0; lu.entries()],
            lu,
            corotation,
            cj: 0.0,
            attempted: 0.0,
            rate: UNKNOWN_RATE,
            stale: true,
            fresh: false,
            slow: false,
            solves: 0,
            wall: Duration::ZERO,
            singular: None,
            has_turned: false,
        }
    }

    /// Resets everything but the counters.
    pub fn forget(&mut self) {
        self.lu.forget();
        (self.cj, self.rate, self.stale) = (0.0, UNKNOWN_RATE, true);
        (self.fresh, self.slow, self.attempted) = (false, false, 0.0);
        self.singular = None;
        self.has_turned = false;
    }

    /// Discards the measured contraction rate.
    pub fn doubt(&mut self) {
        self.rate = UNKNOWN_RATE;
    }

    /// Begins a new step attempt. Steps of constant size get a matrix for that size. Linear equations then need one iteration, and its
    /// remaining error does not accumulate over a long undamped motion.
    pub fn begin(&mut self, cj: f64) {
        let apart = |other: f64| (cj / other - 1.0).abs();
        let steady = apart(self.attempted) <= SAME_SIZE && apart(self.cj) > STEADY_BAND;
        self.attempted = cj;
        self.stale |= steady || std::mem::take(&mut self.slow) && !self.fresh;
        self.fresh = false;
    }

    /// Computes factors for `cj` at a state, unless the present ones are adequate.
    pub fn prepare<D: Dae>(
        &mut self,
        equations: &mut Equations<D>,
        (t, y, yp): (f64, &[f64], &[f64]),
        cj: f64,
        band: f64,
    ) -> Result<(), StageError> {
        if !self.stale && (cj / self.cj - 1.0).abs() <= band {
            return Ok(());
        }
        self.stale = true;
        equations.jacobian(t, y, yp, cj, &mut self.values)?;
        let begin = Instant::now();
        let factored = self.lu.factor(&self.values);
        self.corotation.renew();
        self.wall += begin.elapsed();
        match factored {
            Ok(()) => {
                (self.cj, self.rate, self.stale, self.fresh) = (cj, UNKNOWN_RATE, false, true);
                self.singular = None;
                Ok(())
            }
            Err(KluError::Singular { column }) => {
                self.singular = Some(column);
                Err(StageError::Singular(column))
            }
            Err(KluError::Package { status }) => Err(StageError::Fatal(format!("KLU failed (status {status})"))),
        }
    }

    /// Replaces `b` by the solution; returns the factor by which it must be multiplied for an old `cj`.
    ///
    /// `2 / (1 + cj/cj_old)` halves the error at both ends of the spectrum (IDA's choice).
    pub fn solve(&mut self, b: &mut [f64], cj: f64) -> f64 {
        let begin = Instant::now();
        self.corotation.back(b);
        self.lu.solve(b);
        self.corotation.forth(b);
        self.solves += 1;
        self.wall += begin.elapsed();
        2.0 / (1.0 + cj / self.cj)
    }

    /// Records a measured contraction rate. A slow one requires a new matrix in the next step, unless the iteration has settled.
    pub fn measured(&mut self, rate: f64, settled: bool) {
        self.rate = rate.min(UNKNOWN_RATE);
        self.slow |= rate > SLOW && !settled;
    }

    /// Contraction rate to be assumed, measured in the present iteration or before. An earlier measurement is invalid if the beam has
    /// rotated since, because other changes are unknown.
    pub fn rate_of(&self, measured: bool) -> f64 {
        if measured || !self.corotation.turned() {
            self.rate
        } else {
            UNKNOWN_RATE
        }
    }

    /// Reduces the confidence in an old measurement (Hairer & Wanner IV.8).
    pub fn trust_less(&mut self) {
        self.rate = self.rate.max(1e-12).powf(0.8).min(UNKNOWN_RATE);
    }
}
