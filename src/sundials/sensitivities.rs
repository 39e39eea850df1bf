//! Sensitivities to parameters, computed along with the solution by IDA's own formula (IDAS), also of the integrals.

use std::ffi::{c_int, c_void};

use sundials_sys as s;

use super::callbacks::seen;
use super::ida::Ida;
use super::integrals::Correction;
use super::vector::{Vector, entries, entries_mut};
use crate::dae::{Dae, EvaluationError};
use crate::integrate::IntegrationError;
use crate::numerics::kernels;

/// Derivatives `∂F/∂σₖ` at one state, stored because a corrector needs them repeatedly.
#[derive(Default)]
pub(super) struct Slopes {
    t: f64,
    y: Vec<f64>,
    yp: Vec<f64>,
    of: Vec<Vec<f64>>,
}

impl Slopes {
    /// Evaluates the derivatives unless they belong to this state.
    fn look<D: Dae>(&mut self, dae: &mut D, t: f64, y: &[f64], yp: &[f64]) -> Result<(), EvaluationError> {
        if self.t == t && self.y == y && self.yp == yp {
            return Ok(());
        }
        self.forget();
        self.of.resize_with(dae.parameters(), Vec::new);
        for (k, slope) in self.of.iter_mut().enumerate() {
            slope.resize(y.len(), 0.0);
            dae.parameter_derivative(k, t, y, yp, slope)?;
        }
        self.t = t;
        self.y.extend_from_slice(y);
        self.yp.extend_from_slice(yp);
        Ok(())
    }

    /// Discards the derivatives after a change of the equations.
    fn forget(&mut self) {
        self.y.clear();
        self.yp.clear();
    }
}

/// Vectors of an integrator for its sensitivities.
pub(super) struct SensitivityVectors {
    s: Vec<Vector>,
    sp: Vec<Vector>,
    pub(super) integrals: Vec<Vector>,
    pub(super) corrections: Vec<Correction>,
}

fn raws(vectors: &[Vector]) -> Vec<s::N_Vector> {
    vectors.iter().map(Vector::raw).collect()
}

/// Slices of `count` vectors that C passes as an array.
///
/// # Safety
/// The array contains `count` valid serial vectors, which nobody writes to while the slices are used.
unsafe fn slices<'v>(array: *mut s::N_Vector, count: usize) -> Vec<&'v [f64]> {
    // SAFETY: by contract.
    (0..count).map(|k| unsafe { entries(*array.add(k)) }).collect()
}

/// Mutable slices of `count` vectors that C passes as an array.
///
/// # Safety
/// The array contains `count` different valid serial vectors, which nobody else accesses while the slices are used.
unsafe fn slices_mut<'v>(array: *mut s::N_Vector, count: usize) -> Vec<&'v mut [f64]> {
    // SAFETY: by contract.
    (0..count).map(|k| unsafe { entries_mut(*array.add(k)) }).collect()
}

/// `IDASensResFn` with a [`CallbackData`] as user data.
#[allow(clippy::too_many_arguments)] // SUNDIALS' signature
unsafe extern "C" fn residuals<D: Dae>(
    count: c_int,
    t: f64,
    y: s::N_Vector,
    yp: s::N_Vector,
    _: s::N_Vector,
    along: *mut s::N_Vector,
    along_rates: *mut s::N_Vector,
    out: *mut s::N_Vector,
    data: *mut c_void,
    _: s::N_Vector,
    _: s::N_Vector,
    _: s::N_Vector,
) -> c_int {
    let count = count as usize;
    // SAFETY: user data is the bridge, which nobody else borrows while C runs; the arrays contain `count` vectors each, and
    // those of `out` differ from all that are read.
    let (bridge, y, yp) = unsafe { seen::<D>(data, y, yp) };
    // SAFETY: as above.
    let (along, along_rates) = unsafe { (slices(along, count), slices(along_rates, count)) };
    // SAFETY: as above.
    let mut out = unsafe { slices_mut(out, count) };
    let begin = std::time::Instant::now();
    let mut slopes = std::mem::take(&mut bridge.slopes);
    let code = bridge.call(|dae| {
        slopes.look(dae, t, y, yp)?;
        dae.tangent(t, y, yp, [&along, &along_rates], &mut out)?;
        for (out, slope) in out.iter_mut().zip(&slopes.of) {
            out.iter_mut().zip(slope).for_each(|(out, slope)| *out += slope);
            if let Some(i) = kernels::first_not_finite(out) {
                let what = format!("the equation of the sensitivity of {} gives {}", dae.name(i), out[i]);
                return Err(EvaluationError::Recoverable(what));
            }
        }
        Ok(())
    });
    bridge.slopes = slopes;
    bridge.residual_wall += begin.elapsed();
    code
}

/// `IDAQuadSensRhsFn` with a [`CallbackData`] as user data.
#[allow(clippy::too_many_arguments)] // SUNDIALS' signature
unsafe extern "C" fn integrands<D: Dae>(
    count: c_int,
    t: f64,
    y: s::N_Vector,
    yp: s::N_Vector,
    along: *mut s::N_Vector,
    along_rates: *mut s::N_Vector,
    _: s::N_Vector,
    out: *mut s::N_Vector,
    data: *mut c_void,
    _: s::N_Vector,
    _: s::N_Vector,
    _: s::N_Vector,
) -> c_int {
    let count = count as usize;
    // SAFETY: as in `residuals`.
    let (bridge, y, yp) = unsafe { seen::<D>(data, y, yp) };
    // SAFETY: as above.
    let (along, along_rates) = unsafe { (slices(along, count), slices(along_rates, count)) };
    // SAFETY: as above.
    let mut out = unsafe { slices_mut(out, count) };
    let begin = std::time::Instant::now();
    let code = bridge.call(|dae| {
        for (k, out) in out.iter_mut().enumerate() {
            dae.integrand_derivative(k, t, [y, yp], [along[k], along_rates[k]], out)?;
        }
        Ok(())
    });
    bridge.integrand_wall += begin.elapsed();
    code
}

impl<D: Dae> Ida<D> {
    /// `[E41]` For `F(t, y, y', σ) = 0` with integrals `I' = g(t, y, y', σ)`, every `s = ∂y/∂σ` satisfies
    ///
    /// ```text
    /// F_y s + F_y' s' + ∂F/∂σ = 0        (∂I/∂σ)' = g_y s + g_y' s' + ∂g/∂σ
    /// ```
    ///
    /// Staggered method: sensitivities are solved for after a step's state has converged and passed its error test. A rejected step
    /// therefore needs no sensitivities, ∂F/∂σ is evaluated once per step, and the state differs from a run without sensitivities only by
    /// the steps. The sensitivities' own error test affects the choice of steps.
    ///
    /// Starts to compute sensitivities from the present time, from `sₖ` and `sₖ'` for each of the equations' parameters. These must be
    /// consistent, see [`super::consistent_sensitivities`]. Tolerances are the relative one and the smallest absolute one of the
    /// unknowns. `integrals` adds the sensitivities of the integrals. Must be called before the first step.
    ///
    /// Panics if a sensitivity and the unknowns differ in length.
    pub fn carry(
        &mut self,
        from: &[Vec<f64>],
        rates: &[Vec<f64>],
        integrals: bool,
    ) -> Result<(), Box<IntegrationError>> {
        let (count, n) = (self.dae().parameters(), self.dae().len());
        let integrals = if integrals { self.dae().integrals() } else { 0 };
        assert!(from.len() == count && rates.len() == count && from.iter().chain(rates).all(|s| s.len() == n));
        if count == 0 {
            return Ok(());
        }
        let time = self.time;
        let vectors = |all: &[Vec<f64>]| -> Result<Vec<Vector>, Box<IntegrationError>> {
            let vector = |entries: &Vec<f64>| Vector::new(entries, self.context.raw());
            let made: Result<_, _> = all.iter().map(vector).collect();
            made.map_err(|message| IntegrationError::request(message, time))
        };
        let carried = SensitivityVectors {
            s: vectors(from)?,
            sp: vectors(rates)?,
            integrals: vectors(&vec![vec![0.0; integrals]; if integrals == 0 { 0 } else { count }])?,
            corrections: (0..count)
                .map(|_| Correction::new(self.dae().integrals_of_powers()))
                .collect(),
        };
        let bridge = self.bridge.get();
        let (relative, least) = (
            bridge.relative,
            bridge.absolute.iter().copied().fold(f64::INFINITY, f64::min),
        );
        let (mut from, mut rates, mut absolute) = (raws(&carried.s), raws(&carried.sp), vec![least; count]);
        let mut zeros = raws(&carried.integrals);
        let memory = self.memory.0;
        // SAFETY: IDA is alive and copies vectors and tolerances; the arrays have `count` entries each.
        let flags = unsafe {
            [
                s::IDASensInit(
                    memory,
                    count as c_int,
                    s::IDA_STAGGERED,
                    Some(residuals::<D>),
                    from.as_mut_ptr(),
                    rates.as_mut_ptr(),
                ),
                s::IDASensSStolerances(memory, relative, absolute.as_mut_ptr()),
                s::IDASetSensErrCon(memory, 1),
                if zeros.is_empty() {
                    s::IDA_SUCCESS
                } else {
                    s::IDAQuadSensInit(memory, Some(integrands::<D>), zeros.as_mut_ptr())
                },
            ]
        };
        self.sensitivities = Some(carried);
        match flags.into_iter().find(|&flag| flag < 0) {
            Some(flag) => Err(self.failure(flag)),
            None => Ok(()),
        }
    }

    /// Continues with new sensitivities after [`Ida::restart`]; those of the integrals start at zero.
    ///
    /// Panics if a sensitivity and the unknowns differ in length.
    pub fn carry_on(&mut self, from: &[Vec<f64>], rates: &[Vec<f64>]) -> Result<(), Box<IntegrationError>> {
        self.bridge.get_mut().slopes.forget();
        let Some(carried) = &mut self.sensitivities else {
            return Ok(());
        };
        for (vector, from) in carried.s.iter_mut().zip(from).chain(carried.sp.iter_mut().zip(rates)) {
            vector.entries_mut().copy_from_slice(from);
        }
        carried
            .integrals
            .iter_mut()
            .for_each(|zeros| zeros.entries_mut().fill(0.0));
        carried.corrections.iter_mut().for_each(Correction::restart);
        let (mut from, mut rates, mut zeros) = (raws(&carried.s), raws(&carried.sp), raws(&carried.integrals));
        // SAFETY: IDA and the vectors, which it copies, are alive; the arrays have one entry per parameter.
        let flag = unsafe {
            match s::IDASensReInit(self.memory.0, s::IDA_STAGGERED, from.as_mut_ptr(), rates.as_mut_ptr()) {
                s::IDA_SUCCESS if !zeros.is_empty() => s::IDAQuadSensReInit(self.memory.0, zeros.as_mut_ptr()),
                flag => flag,
            }
        };
        if flag < 0 { Err(self.failure(flag)) } else { Ok(()) }
    }

    /// Sensitivity to parameter k and its rate, at a time [s] within the last step; the initial ones before the first step.
    ///
    /// Panics if a slice and the unknowns differ in length.
    pub fn sensitivity(&mut self, k: usize, time: f64, out: [&mut [f64]; 2]) -> Result<(), Box<IntegrationError>> {
        let Some(carried) = &self.sensitivities else {
            return Ok(());
        };
        let (places, mut flag) = ([&carried.s[k], &carried.sp[k]], s::IDA_SUCCESS);
        if self.stepped {
            for (derivative, place) in places.iter().enumerate() {
                // SAFETY: IDA and the vector are alive.
                let next =
                    unsafe { s::IDAGetSensDky1(self.memory.0, time, derivative as c_int, k as c_int, place.raw()) };
                flag = flag.min(next);
            }
        }
        for (out, place) in out.into_iter().zip(places) {
            out.copy_from_slice(place.entries());
        }
        if flag < 0 { Err(self.failure(flag)) } else { Ok(()) }
    }

    /// Sensitivities of the integrals since the last restart to parameter k, at a time [s] within the last step.
    ///
    /// Panics if the length of `out` differs from the number of integrals.
    pub fn integral_sensitivity(&mut self, k: usize, time: f64, out: &mut [f64]) -> Result<(), Box<IntegrationError>> {
        let Some(vector) = self.sensitivities.as_ref().and_then(|carried| carried.integrals.get(k)) else {
            return Ok(());
        };
        if !self.stepped {
            out.fill(0.0);
            return Ok(());
        }
        // SAFETY: IDA and the vector are alive.
        let flag = unsafe { s::IDAGetQuadSensDky1(self.memory.0, time, 0, k as c_int, vector.raw()) };
        if flag < 0 {
            return Err(self.failure(flag));
        }
        out.copy_from_slice(vector.entries());
        if let Some(carried) = &self.sensitivities {
            carried.corrections[k].add(time, out);
        }
        Ok(())
    }
}
