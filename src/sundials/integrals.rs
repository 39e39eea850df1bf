//! Integrals over the polynomials that IDA accepts, by Lobatto's rule on every step.
//!
//! IDA's own quadratures are outside its error test: where the unknowns permit long steps, an integrand that is not as simple as they are is wrong at
//! every tolerance. Here an integral is as good as the polynomials, and steps are those of the unknowns alone.

use std::ffi::c_int;
use std::time::Instant;

use sundials_sys as s;

use super::ida::Ida;
use crate::dae::Dae;
use crate::integrate::IntegrationError;

/// Nodes of a rule at most.
const NODES: usize = 4;
/// Place of the integrands at the end of a step.
const END: usize = NODES - 1;
/// Simpson's rule, exact for cubics: for polynomials up to order 3.
const LOW: Rule = Rule(&[(0, 0.0), (1, 0.5), (END, 1.0)]);
/// Lobatto's rule of four nodes, exact for degree 5.
const HIGH: Rule = Rule(&[
    (0, 0.0),
    (1, 0.276_393_202_250_021),
    (2, 0.723_606_797_749_979),
    (END, 1.0),
]);

/// Nodes in a step: where their integrands are kept, and their places, 0 to 1.
#[derive(Clone, Copy)]
struct Rule(&'static [(usize, f64)]);

impl Rule {
    fn of_order(order: u8) -> Self {
        if order <= 3 { LOW } else { HIGH }
    }

    /// Weights of the integrands for the integral from the begin of a step to a place in it, over the length of the step: of Lagrange's polynomials, by
    /// Gauss' rule of two points, which is exact for them.
    fn weights(self, x: f64) -> [f64; NODES] {
        let mut weights = [0.0; NODES];
        for (j, &(_, node)) in self.0.iter().enumerate() {
            let basis = |place: f64| -> f64 {
                let others = self.0.iter().enumerate().filter(|(k, _)| *k != j);
                others
                    .map(|(_, &(_, other))| (place - other) / (node - other))
                    .product()
            };
            let gauss = 0.5 / 3.0_f64.sqrt();
            weights[j] = 0.5 * x * (basis(x * (0.5 - gauss)) + basis(x * (0.5 + gauss)));
        }
        weights
    }
}

/// Integrals since the last restart.
pub(super) struct Quadrature {
    rule: Rule,
    /// At the begin and at the end of the last step.
    total: [Vec<f64>; 2],
    /// Integrands at the nodes of the last step; those at its end are the first of the next.
    at: [Vec<f64>; NODES],
}

impl Quadrature {
    pub fn new(count: usize) -> Self {
        let zeros = || vec![0.0; count];
        Self {
            rule: LOW,
            total: [zeros(), zeros()],
            at: [zeros(), zeros(), zeros(), zeros()],
        }
    }

    /// Starts at zero.
    pub fn restart(&mut self) {
        self.total[1].fill(0.0);
    }

    /// A step begins where the last one ended.
    fn begin_step(&mut self, rule: Rule) {
        self.rule = rule;
        self.at.swap(0, END);
        let [before, after] = &mut self.total;
        before.copy_from_slice(after);
    }

    /// The integrands of a step of size `h` [s] are complete.
    fn end_step(&mut self, h: f64) {
        let mut end = std::mem::take(&mut self.total[1]);
        self.read(h, 1.0, &mut end);
        self.total[1] = end;
    }

    /// The integrals at a place in the last step, of size `h` [s].
    fn read(&self, h: f64, x: f64, out: &mut [f64]) {
        out.copy_from_slice(&self.total[0]);
        for (&(slot, _), weight) in self.rule.0.iter().zip(self.rule.weights(x)) {
            for (out, g) in out.iter_mut().zip(&self.at[slot]) {
                *out += h * weight * g;
            }
        }
    }
}

/// Integrals of an integrator.
pub(super) struct Integrals {
    of_state: Quadrature,
    /// Derivatives of the integrals, for each parameter; none where they are not asked for.
    pub of_parameters: Vec<Quadrature>,
    /// Begin [s] and size of the last step [s].
    step: [f64; 2],
    /// Whether the integrands at the present time have been evaluated.
    known: bool,
    y: Vec<f64>,
    yp: Vec<f64>,
}

impl Integrals {
    pub fn new(count: usize, unknowns: usize) -> Self {
        Self {
            of_state: Quadrature::new(count),
            of_parameters: vec![],
            step: [0.0; 2],
            known: false,
            y: vec![0.0; unknowns],
            yp: vec![0.0; unknowns],
        }
    }

    /// Starts at zero.
    pub fn restart(&mut self) {
        self.known = false;
        self.of_state.restart();
        self.of_parameters.iter_mut().for_each(Quadrature::restart);
    }

    fn none(&self) -> bool {
        self.of_state.total[1].is_empty()
    }

    /// A quadrature at a time [s], within the last step.
    fn read_at(&self, one: &Quadrature, time: f64, out: &mut [f64]) {
        let [begin, h] = self.step;
        if h > 0.0 {
            one.read(h, ((time - begin) / h).clamp(0.0, 1.0), out);
        } else {
            out.copy_from_slice(&one.total[1]);
        }
    }
}

impl<D: Dae> Ida<D> {
    /// The integrals `∫ g dt` since the last restart: at the present time, or at a time [s] within the last
    /// step. `out` has length `dae.integrals()`.
    pub fn integrals(&mut self, time: Option<f64>, out: &mut [f64]) -> Result<(), Box<IntegrationError>> {
        match time {
            Some(time) if self.stepped => self.integrals.read_at(&self.integrals.of_state, time, out),
            _ => out.copy_from_slice(&self.integrals.of_state.total[1]),
        }
        Ok(())
    }

    /// Sensitivities of the integrals since the last restart to parameter k, at a time [s] within the last step.
    ///
    /// Panics when `out` has another length than the integrals.
    pub fn integral_sensitivity(&mut self, k: usize, time: f64, out: &mut [f64]) -> Result<(), Box<IntegrationError>> {
        match self.integrals.of_parameters.get(k) {
            Some(one) if self.stepped => self.integrals.read_at(one, time, out),
            Some(_) => out.fill(0.0),
            None => {}
        }
        Ok(())
    }

    /// Evaluates the integrands at the present state, where that is not the end of a step.
    pub(super) fn begin_integrals(&mut self) -> Result<(), Box<IntegrationError>> {
        if self.integrals.none() || self.integrals.known {
            return Ok(());
        }
        self.integrals.y.copy_from_slice(self.y.entries());
        self.integrals.yp.copy_from_slice(self.yp.entries());
        self.integrals.step = [self.time, 0.0];
        self.evaluate_integrands(self.time, END)?;
        self.integrals.known = true;
        Ok(())
    }

    /// Carries the integrals over the step from a time [s] to the present.
    pub(super) fn advance_integrals(&mut self, from: f64, order: u8) -> Result<(), Box<IntegrationError>> {
        if self.integrals.none() {
            return Ok(());
        }
        let (rule, h) = (Rule::of_order(order), self.time - from);
        let all = &mut self.integrals;
        let each = std::iter::once(&mut all.of_state).chain(&mut all.of_parameters);
        each.for_each(|one| one.begin_step(rule));
        all.step = [from, h];
        // the end is evaluated last: the equations may keep what they know of the state accepted
        for &(slot, x) in &rule.0[1..] {
            let t = if slot == END { self.time } else { from + x * h };
            self.read_node(t, slot == END)?;
            self.evaluate_integrands(t, slot)?;
        }
        let all = &mut self.integrals;
        let each = std::iter::once(&mut all.of_state).chain(&mut all.of_parameters);
        each.for_each(|one| one.end_step(h));
        Ok(())
    }

    /// Reads values and rates at a node, of sensitivities too.
    fn read_node(&mut self, t: f64, end: bool) -> Result<(), Box<IntegrationError>> {
        if end {
            self.integrals.y.copy_from_slice(self.y.entries());
            self.integrals.yp.copy_from_slice(self.yp.entries());
        } else {
            for derivative in 0..2 {
                // SAFETY: IDA and the vector are alive.
                let flag = unsafe { s::IDAGetDky(self.memory.0, t, derivative, self.scratch.raw()) };
                if flag < 0 {
                    return Err(self.failure(flag));
                }
                let all = &mut self.integrals;
                let out = if derivative == 0 { &mut all.y } else { &mut all.yp };
                out.copy_from_slice(self.scratch.entries());
            }
        }
        match self.read_sensitivities(t, self.integrals.of_parameters.len()) {
            flag if flag < 0 => Err(self.failure(flag)),
            _ => Ok(()),
        }
    }

    /// Evaluates the integrands of the state that has been read, and their derivatives before.
    fn evaluate_integrands(&mut self, t: f64, slot: usize) -> Result<(), Box<IntegrationError>> {
        let Integrals {
            of_state,
            of_parameters,
            y,
            yp,
            ..
        } = &mut self.integrals;
        let (bridge, carried) = (self.bridge.get_mut(), self.sensitivities.as_ref());
        let begin = Instant::now();
        let code = bridge.call(|dae| {
            for (k, (one, along)) in of_parameters
                .iter_mut()
                .zip(carried.into_iter().flat_map(|c| c.along()))
                .enumerate()
            {
                dae.integrand_derivative(k, t, [y, yp], along, &mut one.at[slot])?;
            }
            dae.integrands(t, y, yp, &mut of_state.at[slot])
        });
        bridge.integrand_wall += begin.elapsed();
        self.raise_panic();
        match code {
            0 => Ok(()),
            _ => Err(self.failure(s::IDA_QRHS_FAIL as c_int)),
        }
    }
}
