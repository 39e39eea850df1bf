//! Choice of the integrator of a run with its reason, and a common interface of the integrators.

use super::order::{self, OrderChoice};
use crate::case::schema::{self, Case, MaxOrder};
use crate::dae::Dae;
use crate::discrete::System;
use crate::integrate::{AbsoluteTolerances, Counters, IntegrationError, SolverWallTimes};
use crate::onestep::{OneStep, OneStepOptions, TableauMethod};
use crate::sundials::IdaOptions;
use crate::sundials::{AcceptedStep, Ida};

/// Method and highest order of a case, with reasons.
#[derive(Clone, Debug, PartialEq)]
pub struct MethodChoice {
    /// A one-step method; `None` for IDA.
    pub one_step: Option<TableauMethod>,
    /// Reason for the method, as text.
    pub reason: String,
    /// Highest order.
    pub order: OrderChoice,
}

impl MethodChoice {
    /// Name of the method for messages.
    pub fn name(&self) -> String {
        self.one_step.map_or("IDA".into(), |method| method.to_string())
    }
}

/// Loosest tolerance at which ESDIRK46 integrates undamped waves. From 1e-3 on it costs a half to a ninth of BDF 2 at equal error.
/// At 1e-2 it costs as much or twice, but BDF 2 is then wrong by 10 to 80 % (docs/accuracy.md).
const LOOSEST: f64 = 1e-2;

/// Chooses the method of a case: the requested one, else ESDIRK46 if undamped waves limit BDF to order 2, else IDA.
pub fn choose(case: &Case, system: &System) -> MethodChoice {
    let (method, rtol) = (case.solver.method, case.solver.rtol);
    let bdf = || order::choose(case, system);
    let one_step = |method: TableauMethod, reason: &str| MethodChoice {
        one_step: Some(method),
        reason: reason.into(),
        order: OrderChoice {
            order: method.order(),
            reason: format!("the order of {method}"),
        },
    };
    let ida = |reason: &str, order| MethodChoice {
        one_step: None,
        reason: reason.into(),
        order,
    };
    match method {
        schema::Method::Ida => ida("as requested", bdf()),
        schema::Method::Trbdf2 => one_step(TableauMethod::TrBdf2, "as requested"),
        schema::Method::Esdirk34 => one_step(TableauMethod::Esdirk34, "as requested"),
        schema::Method::Esdirk46 => one_step(TableauMethod::Esdirk46, "as requested"),
        schema::Method::Esdirk57 => one_step(TableauMethod::Esdirk57, "as requested"),
        schema::Method::Auto if case.solver.max_order != MaxOrder::Auto => {
            ida("max_order is set, which applies to BDF only", bdf())
        }
        schema::Method::Auto if !system.model.controllers.is_empty() && rtol <= LOOSEST => one_step(
            TableauMethod::Esdirk46,
            "controllers restart the integrator at samples; a one-step method needs no history",
        ),
        schema::Method::Auto => match bdf() {
            order if order.order > 2 => ida("BDF may use its high orders", order),
            order if rtol > LOOSEST => ida(
                &format!("rtol {rtol:e} > {LOOSEST:e}: no method is accurate, and BDF of order 2 costs least"),
                order,
            ),
            _ => one_step(
                TableauMethod::Esdirk46,
                "undamped waves limit BDF to order 2; an L-stable method of order 4 needs a tenth of its steps",
            ),
        },
    }
}

/// Chooses the method of a case with sensitivities: IDA, the only one that integrates them.
pub fn with_sensitivities(case: &Case, system: &System) -> MethodChoice {
    let usual = choose(case, system);
    if usual.one_step.is_none() {
        return usual;
    }
    MethodChoice {
        one_step: None,
        reason: format!(
            "only IDA integrates sensitivities; without them the method would be {}",
            usual.name()
        ),
        order: order::choose(case, system),
    }
}

/// Fraction of the tolerance at which IDA's Newton iteration ends if the solid has inertia. IDA's default, a third, leaves noise
/// that its error test mistakes for truncation error at each step of slow motions. Elsewhere the default costs a tenth less.
const NONLINEAR: f64 = 0.033;

/// Fraction for a solid without inertia. The smoother the motion, the smaller is the truncation error relative to the noise.
const NONLINEAR_STATIC: f64 = 1e-4;

/// Settings of the integrator of a case.
#[derive(Clone, Debug, PartialEq)]
pub enum IntegratorOptions {
    /// IDA's settings.
    Ida(IdaOptions),
    /// Settings of a one-step method.
    OneStep(OneStepOptions),
}

impl IntegratorOptions {
    /// Settings for a case and its chosen method.
    pub fn new(case: &Case, system: &System, choice: &MethodChoice, max_step: f64) -> Self {
        let solver = &case.solver;
        let (relative, absolute) = (solver.rtol, AbsoluteTolerances::Same(solver.rtol));
        let (initial_step, max_step) = (solver.initial_step_s, Some(max_step));
        match choice.one_step {
            None => Self::Ida(IdaOptions {
                relative,
                absolute,
                max_order: choice.order.order,
                nonlinear_coefficient: solver
                    .nonlinear_coefficient
                    .unwrap_or(if system.layout.waves() != [false; 2] {
                        NONLINEAR
                    } else {
                        NONLINEAR_STATIC
                    }),
                delta_cj_setup: solver.delta_cj_setup,
                initial_step,
                max_step,
                ..IdaOptions::default()
            }),
            Some(method) => {
                let usual = OneStepOptions::default();
                Self::OneStep(OneStepOptions {
                    method,
                    relative,
                    absolute,
                    newton_tolerance: solver.nonlinear_coefficient,
                    initial_step,
                    max_step,
                    ..usual
                })
            }
        }
    }
}

/// An integrator: IDA or a one-step method. See [`Ida`] for the contracts of its functions.
#[allow(clippy::large_enum_variant)] // there is one of it in a run
pub enum Integrator<D: Dae> {
    /// Variable-order BDF.
    Ida(Ida<D>),
    /// A one-step method.
    OneStep(OneStep<D>),
}

/// Calls the same function of either integrator.
macro_rules! either {
    ($this:expr, $one:ident => $call:expr) => {
        match $this {
            Integrator::Ida($one) => $call,
            Integrator::OneStep($one) => $call,
        }
    };
}

impl<D: Dae> Integrator<D> {
    /// An integrator at time `t0` [s] with consistent values and derivatives.
    pub fn new(
        dae: D,
        t0: f64,
        y0: &[f64],
        yp0: &[f64],
        options: &IntegratorOptions,
    ) -> Result<Self, Box<IntegrationError>> {
        match options {
            IntegratorOptions::Ida(options) => Ida::new(dae, t0, y0, yp0, options).map(Self::Ida),
            IntegratorOptions::OneStep(options) => OneStep::new(dae, t0, y0, yp0, options).map(Self::OneStep),
        }
    }

    /// Makes one accepted step, which does not pass `stop` [s].
    pub fn step(&mut self, stop: f64) -> Result<AcceptedStep, Box<IntegrationError>> {
        either!(self, one => one.step(stop))
    }

    /// Sets the largest step [s] from now on, and keeps the history of the integrator.
    pub fn limit(&mut self, largest: f64) -> Result<(), Box<IntegrationError>> {
        match self {
            Self::Ida(ida) => ida.limit(largest),
            Self::OneStep(one) => {
                one.limit(largest);
                Ok(())
            }
        }
    }

    /// Present time [s].
    pub fn time(&self) -> f64 {
        either!(self, one => one.time())
    }

    /// Unknowns at the present time.
    pub fn y(&self) -> &[f64] {
        either!(self, one => one.y())
    }

    /// Derivatives of the unknowns at the present time [1/s].
    pub fn yp(&self) -> &[f64] {
        either!(self, one => one.yp())
    }

    /// Derivative number `k` of the unknowns at a time [s] within the last step.
    pub fn interpolate(&mut self, time: f64, k: u8, out: &mut [f64]) -> Result<(), Box<IntegrationError>> {
        either!(self, one => one.interpolate(time, k, out))
    }

    /// Integrals since the last restart, at the present time or at `time` [s] within the last step.
    pub fn integrals(&mut self, time: Option<f64>, out: &mut [f64]) -> Result<(), Box<IntegrationError>> {
        either!(self, one => one.integrals(time, out))
    }

    /// Restarts from consistent values at time `t` [s], without the history of past steps.
    pub fn restart(&mut self, t: f64, y: &[f64], yp: &[f64]) -> Result<(), Box<IntegrationError>> {
        either!(self, one => one.restart(t, y, yp))
    }

    /// Accepted steps since the integrator was created.
    pub fn steps(&self) -> u64 {
        either!(self, one => one.steps())
    }

    /// Work done since the integrator was created.
    pub fn counters(&self) -> Counters {
        either!(self, one => one.counters())
    }

    /// Wall time spent in the equations and the linear solver.
    pub fn wall(&self) -> SolverWallTimes {
        either!(self, one => one.wall())
    }

    /// Returns IDA if it is the integrator.
    pub fn ida_mut(&mut self) -> Option<&mut Ida<D>> {
        match self {
            Self::Ida(ida) => Some(ida),
            Self::OneStep(_) => None,
        }
    }

    /// The equations.
    pub fn dae(&self) -> &D {
        either!(self, one => one.dae())
    }

    /// The equations, mutable. Call [`Integrator::restart`] after changing their meaning.
    pub fn dae_mut(&mut self) -> &mut D {
        either!(self, one => one.dae_mut())
    }
}
