//! Integrals computed along with the solution by IDA's own formula (IDAS' quadratures): no feedback, no error control.
//!
//! A sum by that formula satisfies the linear balances of the equations exactly, as volumes and momenta require. Powers are quadratic in
//! the state. If the state is linear in time, the formula of order 1 follows it exactly in steps of any length `h`, but the error of its
//! sum of a power `g` is `h² g'/2`. Steps of order 1 therefore add a limited correction to integrals of powers, like slope limiters in
//! finite-volume schemes:
//!
//! ```text
//! ∫ g dt over a step = h g_1 - h² s/2        s = minmod(slope of g in this step, slope in the step before)
//! ```
//!
//! The correction is exact for linear powers, and zero if a power jumps. If the state is not linear, rates are means over the step and
//! not those at its end. The correction is therefore reduced to zero if the local error of the state exceeds the remaining error of
//! Newton's iteration: the tolerance of the state then limits the step.

use std::ffi::{c_int, c_void};
use std::ops::Range;

use sundials_sys as s;

use super::callbacks::seen;
use super::ida::Ida;
use super::vector::{Vector, entries_mut};
use crate::dae::Dae;
use crate::integrate::IntegrationError;

/// `IDAQuadRhsFn` with a [`CallbackData`] as user data.
pub(super) unsafe extern "C" fn integrands<D: Dae>(
    t: f64,
    y: s::N_Vector,
    yp: s::N_Vector,
    out: s::N_Vector,
    data: *mut c_void,
) -> c_int {
    // SAFETY: user data is the bridge, which nobody else borrows while C runs; the vectors are different serial ones.
    let ((bridge, y, yp), out) = unsafe { (seen::<D>(data, y, yp), entries_mut(out)) };
    let begin = std::time::Instant::now();
    let code = bridge.call(|dae| dae.integrands(t, y, yp, out));
    bridge.integrand_wall += begin.elapsed();
    code
}

/// Choice of a limited slope: zero, that of the step, or that of the step before.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Limit {
    None,
    Now,
    Before,
}

impl Limit {
    /// `minmod`: the smaller of two slopes of equal sign, zero for opposite signs.
    fn minmod(now: f64, before: f64) -> Self {
        if now * before <= 0.0 {
            Self::None
        } else if now.abs() < before.abs() {
            Self::Now
        } else {
            Self::Before
        }
    }

    fn limit_slope(self, now: f64, before: f64) -> f64 {
        match self {
            Self::None => 0.0,
            Self::Now => now,
            Self::Before => before,
        }
    }
}

/// Root mean square of the corrector of the state, in units of its tolerances: full correction below the first limit, none above the
/// second.
const LINEAR: [f64; 2] = [0.005, 0.02];

/// Correction of the sums of powers in steps of order 1.
pub(super) struct Correction {
    range: Range<usize>,
    /// Sum of corrections up to the beginning of the last step.
    total: Vec<f64>,
    /// Integrands at the end of the last step, if known.
    integrand: Option<Vec<f64>>,
    /// Slopes of the integrands in the last step, and slopes limited by the step before; the latter are zero above
    /// order 1.
    slope: Vec<f64>,
    limited: Vec<f64>,
    /// Choice of each limited slope.
    limits: Vec<Limit>,
    /// End and size of the last step [s].
    end: f64,
    size: f64,
}

impl Correction {
    /// Creates an empty correction; `range` contains the integrals of powers.
    pub fn new(range: Range<usize>) -> Self {
        let zeros = vec![0.0; range.len()];
        Self {
            limits: vec![Limit::None; range.len()],
            range,
            total: zeros.clone(),
            integrand: None,
            slope: zeros.clone(),
            limited: zeros,
            end: 0.0,
            size: 0.0,
        }
    }

    /// Updates the correction after a step [s], from the integrands at its end; `weight` of the correction is 0 above order 1.
    /// Sensitivities use the limits of their integrals, so that they are exact derivatives.
    fn follow(&mut self, [end, size]: [f64; 2], weight: f64, integrands: &[f64], limits: Option<&[Limit]>) {
        let finished = 0.5 * self.size * self.size;
        let now = &integrands[self.range.clone()];
        for (total, limited) in self.total.iter_mut().zip(&self.limited) {
            *total -= finished * limited;
        }
        self.limited.fill(0.0);
        self.limits.fill(Limit::None);
        if let Some(before) = &mut self.integrand {
            for (k, (before, now)) in before.iter_mut().zip(now).enumerate() {
                let slope = (now - *before) / size;
                if weight > 0.0 {
                    let own = || Limit::minmod(slope, self.slope[k]);
                    self.limits[k] = limits.map_or_else(own, |limits| limits[k]);
                    self.limited[k] = weight * self.limits[k].limit_slope(slope, self.slope[k]);
                }
                (self.slope[k], *before) = (slope, *now);
            }
        } else {
            self.integrand = Some(now.to_vec());
        }
        (self.end, self.size) = (end, size);
    }

    /// Adds the correction at a time [s] within the last step.
    pub fn add(&self, time: f64, out: &mut [f64]) {
        let left = (self.end - time).clamp(0.0, self.size);
        let weight = 0.5 * (self.size * self.size - left * left);
        let out = &mut out[self.range.clone()];
        for (out, (total, limited)) in out.iter_mut().zip(self.total.iter().zip(&self.limited)) {
            *out += total - weight * limited;
        }
    }

    /// Resets the correction to zero.
    pub fn restart(&mut self) {
        *self = Self::new(self.range.clone());
    }
}

/// Initializes the integrals of a new integrator with `zeros`, if the system has any.
pub(super) fn begin<D: Dae>(memory: *mut c_void, zeros: Option<&Vector>) -> c_int {
    match zeros {
        None => s::IDA_SUCCESS,
        // SAFETY: IDA and the vector, which it copies, are alive.
        Some(zeros) => match unsafe { s::IDAQuadInit(memory, Some(integrands::<D>), zeros.raw()) } {
            // SAFETY: IDA is alive.
            s::IDA_SUCCESS => unsafe { s::IDASetQuadErrCon(memory, 0) },
            refused => refused,
        },
    }
}

impl<D: Dae> Ida<D> {
    /// Integrals `∫ g dt` since the last restart, at the present time or at a time [s] within the last step. `out` has
    /// length `dae.integrals()`.
    pub fn integrals(&mut self, time: Option<f64>, out: &mut [f64]) -> Result<(), Box<IntegrationError>> {
        let Some(quadratures) = &mut self.quadratures else {
            return Ok(());
        };
        if self.stepped {
            let mut reached = self.time;
            // SAFETY: IDA and the vector are alive.
            let flag = unsafe {
                match time {
                    Some(t) => s::IDAGetQuadDky(self.memory.0, t, 0, quadratures.raw()),
                    None => s::IDAGetQuad(self.memory.0, &mut reached, quadratures.raw()),
                }
            };
            if flag < 0 {
                return Err(self.failure(flag));
            }
        }
        if let Some(quadratures) = &self.quadratures {
            out.copy_from_slice(quadratures.entries());
        }
        self.correction.add(time.unwrap_or(self.time), out);
        Ok(())
    }

    /// Corrects the sums of powers, and their sensitivities, after a step.
    pub(super) fn correct_integrals(&mut self, size: f64, order: u8) -> c_int {
        let step = [self.time, size];
        let weight = if order == 1 { self.weight_of_correction() } else { 0.0 };
        let Some(quadratures) = &self.quadratures else {
            return s::IDA_SUCCESS;
        };
        // SAFETY: IDA and the vector are alive.
        let mut flag = unsafe { s::IDAGetQuadDky(self.memory.0, self.time, 1, quadratures.raw()) };
        self.correction.follow(step, weight, quadratures.entries(), None);
        if let Some(carried) = &mut self.sensitivities {
            for (k, (vector, correction)) in carried.integrals.iter().zip(&mut carried.corrections).enumerate() {
                // SAFETY: IDA and the vector are alive.
                let next = unsafe { s::IDAGetQuadSensDky1(self.memory.0, self.time, 1, k as c_int, vector.raw()) };
                flag = flag.min(next);
                correction.follow(step, weight, vector.entries(), Some(&self.correction.limits));
            }
        }
        flag
    }

    /// Weight of the correction after a step of order 1.
    fn weight_of_correction(&mut self) -> f64 {
        if self.quadratures.is_none() || self.local_errors().is_empty() {
            return 0.0;
        }
        let (corrector, bridge) = (self.scratch.entries(), self.bridge.get());
        let tolerances = self.y.entries().iter().zip(&bridge.absolute);
        let tolerances = tolerances.map(|(y, absolute)| bridge.relative * y.abs() + absolute);
        let squares: f64 = corrector
            .iter()
            .zip(tolerances)
            .map(|(e, tolerance)| (e / tolerance).powi(2))
            .sum();
        let size = (squares / corrector.len().max(1) as f64).sqrt();
        let [full, none] = LINEAR;
        ((none - size) / (none - full)).clamp(0.0, 1.0)
    }

    /// Resets the integrals to zero at a restart.
    pub(super) fn reset_integrals(&mut self) -> c_int {
        let Some(quadratures) = &mut self.quadratures else {
            return s::IDA_SUCCESS;
        };
        self.correction.restart();
        quadratures.entries_mut().fill(0.0);
        // SAFETY: IDA and the vector, which it copies, are alive.
        unsafe { s::IDAQuadReInit(self.memory.0, quadratures.raw()) }
    }
}
