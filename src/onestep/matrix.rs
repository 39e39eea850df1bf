//! Newton's matrix `∂F/∂y + cj ∂F/∂y'`, its factors, and when they are too old.

use std::time::{Duration, Instant};

use super::equations::{Equations, StageError};
use crate::dae::{Corotation, Dae};
use crate::sparse::{KluError, Lu};

/// Contraction that is assumed before one is measured: corrections are then taken for what is left.
const UNKNOWN_RATE: f64 = 0.5;
/// Measured contraction from which on a new matrix pays.
const SLOW: f64 = 0.1;
/// Relative change of `cj` that asks for a new matrix once two steps in a row have the same size.
const STEADY_BAND: f64 = 5e-3;
/// Relative difference up to which two sizes are the same.
const SAME_SIZE: f64 = 1e-6;

/// The factors and what is known of them.
pub(super) struct Matrix {
    pub lu: Lu,
    /// True if the beam has turned since a matrix was made, now or before.
    pub has_turned: bool,
    /// How the beam has turned since.
    pub corotation: Corotation,
    values: Vec<f64>,
    /// `cj` of the factors; 0 without factors.
    cj: f64,
    /// `cj` of the last attempt at a step; 0 before the first.
    attempted: f64,
    /// Contraction of Newton's iteration with these factors, as last measured.
    pub rate: f64,
    /// Asks for new factors at the next stage.
    pub stale: bool,
    /// Whether the factors were made in the present attempt.
    pub fresh: bool,
    slow: bool,
    pub solves: u64,
    pub wall: Duration,
    /// Column that had no pivot, of the last matrix.
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

    /// As new, counters apart.
    pub fn forget(&mut self) {
        self.lu.forget();
        (self.cj, self.rate, self.stale) = (0.0, UNKNOWN_RATE, true);
        (self.fresh, self.slow, self.attempted) = (false, false, 0.0);
        self.singular = None;
        self.has_turned = false;
    }

    /// What was measured of the factors no longer holds.
    pub fn doubt(&mut self) {
        self.rate = UNKNOWN_RATE;
    }

    /// A new attempt at a step begins. Steps that keep their size get a matrix of that size: linear equations then take one
    /// iteration, and its leftover does not add up over a long undamped motion.
    pub fn begin(&mut self, cj: f64) {
        let apart = |other: f64| (cj / other - 1.0).abs();
        let steady = apart(self.attempted) <= SAME_SIZE && apart(self.cj) > STEADY_BAND;
        self.attempted = cj;
        self.stale |= steady || std::mem::take(&mut self.slow) && !self.fresh;
        self.fresh = false;
    }

    /// Makes factors for `cj` at a state, when there are none that will do.
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
            Err(KluError::Package { status }) => Err(StageError::Fatal(format!("KLU cannot go on (status {status})"))),
        }
    }

    /// Replaces `b` by the solution; returns the factor by which it is to be multiplied for an old `cj`.
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

    /// Notes a measured contraction; a slow one asks for a new matrix in the next step, unless all that is to be gained is
    /// there already.
    pub fn measured(&mut self, rate: f64, settled: bool) {
        self.rate = rate.min(UNKNOWN_RATE);
        self.slow |= rate > SLOW && !settled;
    }

    /// Contraction to be reckoned with, measured in the present iteration or before; one that was measured before does not hold for a beam that has turned
    /// since: what else has changed is not known.
    pub fn rate_of(&self, measured: bool) -> f64 {
        if measured || !self.corotation.turned() {
            self.rate
        } else {
            UNKNOWN_RATE
        }
    }

    /// Trust in an old measurement fades (Hairer & Wanner IV.8).
    pub fn trust_less(&mut self) {
        self.rate = self.rate.max(1e-12).powf(0.8).min(UNKNOWN_RATE);
    }
}
