//! Sensitivities along a run: their start, their jumps at switching times, and the derivatives read from them.
//!
//! Internally, a sensitivity is `s = ∂y/∂σ` by the relative change σ of a number p. It then has the size of the unknowns, and their
//! tolerances apply. Results are `∂/∂p = (∂/∂σ)/p`.

use std::collections::BTreeMap;

use super::figures::{DerivativeAccumulator, FigureSensitivity};
use super::kept::StoredSensitivities;
use crate::case::parameter::{self, Parameter, STEPS};
use crate::case::schema::Case;
use crate::dae::{BeamDae, Dae as _, PerturbedSystems};
use crate::discrete::quantities::probes::{self, HistoryColumn};
use crate::discrete::quantities::stations;
use crate::discrete::quantities::{Observable, QuantitySource};
use crate::discrete::{System, start};
use crate::error::{Code, Error, Result, SolverError, StopPoint};
use crate::integrate::{IntegrationError, consistent_sensitivities};
use crate::run::equilibrium::{self, EquilibriumOptions};
use crate::run::schedule::{self, ScheduledStop};
use crate::sundials::Ida;

/// Sensitivities of a run to some numbers of its case.
pub struct ForwardSensitivities<'a> {
    pub(super) parameters: &'a [Parameter],
    /// Changed cases, four for each number in the order of [`STEPS`].
    cases: Vec<[Case; 4]>,
    /// Stops of the changed cases.
    stops: Vec<[Vec<ScheduledStop>; 4]>,
    /// Quantities of the history that are differentiated.
    pub(super) columns: Vec<Observable>,
    /// Columns of ports, accumulators, walls and reactions.
    pub(super) stations: Vec<HistoryColumn>,
    /// For each of these columns, the integrals of which it is the sum, if it is no part of a state.
    pub(super) integrated: Vec<Vec<usize>>,
    /// Columns at probes.
    pub(super) probes: Vec<HistoryColumn>,
    pub(super) s: Vec<Vec<f64>>,
    pub(super) sp: Vec<Vec<f64>>,
    /// Derivatives of the integrals up to the last restart.
    pub(super) carried: Vec<Vec<f64>>,
    pub(super) figures: Vec<DerivativeAccumulator>,
    pub(super) row: Vec<f64>,
    pub(super) states_only: bool,
}

/// Returns the system of a changed case in the unknowns and scales of that of the case; `None` if its unknowns differ.
pub type Alike<'a> = dyn Fn(&Case) -> Result<Option<System>> + 'a;

/// Returns the case with a value of the parameter at this index.
pub type Changed<'a> = dyn Fn(usize, f64) -> Result<Case> + 'a;

/// Numbers by which a run is differentiated, and functions for changed cases and their systems.
#[derive(Clone, Copy, Default)]
pub struct DerivativeParameters<'a> {
    /// The numbers.
    pub parameters: &'a [Parameter],
    /// Systems of changed cases, if not those that follow from each case alone.
    pub alike: Option<&'a Alike<'a>>,
    /// Changed cases, if not by pointers: a parameter is then a name, and its changes are fractions of its value.
    pub changed: Option<&'a Changed<'a>>,
    /// True for derivatives of states at output times only, of beam and probes: no figures and no integrals, which cost most.
    pub states_only: bool,
}

impl<'a> DerivativeParameters<'a> {
    /// Numbers given by their pointers.
    pub fn pointers(parameters: &'a [Parameter]) -> Self {
        Self {
            parameters,
            ..Self::default()
        }
    }
}

/// Data of the instant before a switch.
pub struct BeforeSwitch {
    state: Vec<f64>,
    rates: Vec<f64>,
    s: Vec<Vec<f64>>,
    integrands: Vec<f64>,
}

impl<'a> ForwardSensitivities<'a> {
    /// Sensitivities of a run of a case to some of its numbers. Also returns the equations with the changed systems.
    ///
    /// # Errors
    /// [`Error::Usage`] if a change of a number changes the unknowns or the number of switching times.
    pub fn new(case: &Case, dae: BeamDae, by: DerivativeParameters<'a>) -> Result<(Self, BeamDae)> {
        let (mut perturbed, mut all_cases, mut all_stops) = (vec![], vec![], vec![]);
        let parameters = by.parameters;
        if let Some(one) = dae.system().model.controllers.first() {
            return Err(Error::Usage(format!(
                "derivatives of a run with the controller \"{}\": its samples have none. Use `slcbeam sweep --vary`, or a signal in \
                 place of the controller",
                one.controller.name
            )));
        }
        let change = parameter::change(case);
        let own = schedule::stops(case, &dae.system().model);
        for (k, parameter) in parameters.iter().enumerate() {
            let refuse = |what: &str| {
                Error::Usage(format!(
                    "--sensitivity {}: a small change of it {what}",
                    parameter.pointer
                ))
            };
            let like = |case: &Case| {
                let system = by.alike.map_or_else(|| dae.system().like(case), |alike| alike(case))?;
                system.ok_or_else(|| refuse("changes the set of unknowns"))
            };
            let changed = |value: f64| match by.changed {
                Some(changed) => changed(k, value),
                None => parameter.changed(case, value),
            };
            let [a, b, c, d] = STEPS.map(|(step, _)| changed(parameter.value * (1.0 + step * change)));
            let cases = [a?, b?, c?, d?];
            let [a, b, c, d] = cases.each_ref().map(like);
            let systems = [a?, b?, c?, d?];
            let stops = [0, 1, 2, 3].map(|j| schedule::stops(&cases[j], &systems[j].model));
            let kinds =
                |stops: &[ScheduledStop]| -> Vec<_> { stops.iter().map(|s| (s.switches, s.checkpoint)).collect() };
            if stops.iter().any(|other| kinds(other) != kinds(&own)) {
                return Err(refuse(
                    "changes the order of switching times, or moves one past the end of the run",
                ));
            }
            perturbed.push(PerturbedSystems::new(&dae, systems, change));
            all_cases.push(cases);
            all_stops.push(stops);
        }
        let count = parameters.len();
        let columns = Observable::recorded(dae.system()).into_iter();
        let read_off = |one: &Observable| !by.states_only || matches!(one.read(), QuantitySource::State(_));
        let columns: Vec<_> = columns.filter(|one| one.has_derivative() && read_off(one)).collect();
        let turbines = case.network.as_ref().is_some_and(|n| !n.turbines.is_empty());
        let window_start = case.time.end_s - case.time.window() * (1.0 + schedule::SAME);
        let forward = Self {
            parameters,
            cases: all_cases,
            stops: all_stops,
            columns,
            stations: match by.states_only {
                true => vec![],
                false => stations::columns(dae.system(), false),
            },
            integrated: match by.states_only {
                true => vec![],
                false => stations::integrated(dae.system()),
            },
            states_only: by.states_only,
            probes: probes::columns(dae.system()).collect(),
            s: vec![vec![0.0; dae.len()]; count],
            sp: vec![vec![0.0; dae.len()]; count],
            carried: vec![vec![0.0; dae.integrals()]; count],
            figures: vec![DerivativeAccumulator::new(window_start, turbines); count],
            row: vec![],
        };
        Ok((forward, dae.with_perturbed(perturbed)))
    }

    /// Names of the recorded columns, units included; a derivative is per unit of the number at its pointer.
    pub fn names(&self) -> Vec<String> {
        let of = |parameter: &Parameter| -> Vec<String> {
            let name = |(name, unit)| format!("d {name}/d {} [{unit} per unit]", parameter.pointer);
            let own = self.columns.iter().map(|one| (one.name(), one.unit()));
            let behind = self.stations.iter().chain(&self.probes);
            own.chain(behind.map(|one| (one.name.as_str(), one.unit)))
                .map(name)
                .collect()
        };
        let names = self.parameters.iter().flat_map(of);
        std::iter::once("t [s]".to_owned()).chain(names).collect()
    }

    /// Sets the changed systems to their own smooth interval before stop number `stop`.
    fn look(&self, dae: &mut BeamDae, stop: usize) {
        for (perturbed, stops) in dae.perturbed_mut().iter_mut().zip(&self.stops) {
            for (beam, stops) in perturbed.beams_mut().iter_mut().zip(stops) {
                beam.enter_smooth_interval(middle(stops, stop));
            }
        }
    }

    /// Computes the sensitivities at t = 0 of the differential unknowns, from the state in which the run starts.
    pub fn begin(&mut self, dae: &mut BeamDae) -> std::result::Result<(), SolverError> {
        self.look(dae, 0);
        for ((perturbed, cases), s) in dae.perturbed_mut().iter_mut().zip(&self.cases).zip(&mut self.s) {
            perturbed.derivative(s, |j, beam, out| {
                let case = &cases[j];
                let (system, now) = beam.instant(0.0);
                let mut state = start::state(system, case, now);
                if let Some(start) = &case.start.equilibrium {
                    state = equilibrium::at_start(case, &EquilibriumOptions::of_start(start), beam, &state)?;
                }
                out.copy_from_slice(&state);
                Ok(())
            })?;
        }
        Ok(())
    }

    /// Sets the sensitivities at t = 0 of the differential unknowns to given values.
    pub fn begin_from(&mut self, dae: &mut BeamDae, s: &[Vec<f64>]) {
        self.look(dae, 0);
        self.s.clone_from_slice(s);
    }

    /// Completes the sensitivities at a consistent state.
    pub fn complete(&mut self, dae: &mut BeamDae, t: f64, state: [&[f64]; 2]) -> std::result::Result<(), SolverError> {
        consistent_sensitivities(dae, t, state, &mut self.s, &mut self.sp).map_err(|what| SolverError {
            code: Code::Singular,
            at: StopPoint::Time(t),
            what: format!("no consistent sensitivities at t = {t:.6} s: {what}"),
            unknown: None,
            cause: Some("the state is not unique: the beam buckles, or the coupling is not convex".into()),
            hint: Some("run without --sensitivity".into()),
        })
    }

    /// Passes the sensitivities to the integrator: at the start of the run, or after a restart.
    pub fn hand_over(&self, ida: &mut Ida<BeamDae>, again: bool) -> std::result::Result<(), Box<IntegrationError>> {
        if again {
            ida.carry_on(&self.s, &self.sp)
        } else {
            ida.carry(&self.s, &self.sp, !self.states_only)
        }
    }

    /// Reads the sensitivities on the left side of a stop, at the state that the integrator has reached there.
    pub fn leave(
        &mut self,
        ida: &mut Ida<BeamDae>,
        t: f64,
        [y, yp]: [&[f64]; 2],
    ) -> std::result::Result<BeforeSwitch, Box<IntegrationError>> {
        let mut totals = self.carried.clone();
        self.read(ida, t, &mut totals)?;
        self.carried = totals;
        Ok(BeforeSwitch {
            state: y.to_vec(),
            rates: yp.to_vec(),
            s: self.s.clone(),
            integrands: integrands(ida.dae_mut(), t, [y, yp]),
        })
    }

    /// Data for a checkpoint, to be called after [`Forward::leave`].
    pub fn kept(&self) -> StoredSensitivities {
        StoredSensitivities {
            parameters: self.parameters.to_vec(),
            s: self.s.clone(),
            sp: self.sp.clone(),
            carried: self.carried.clone(),
            figures: self.figures.clone(),
        }
    }

    /// Restores the data of a checkpoint at a state there, on the left side of its stop.
    pub fn take_up(
        &mut self,
        kept: &StoredSensitivities,
        dae: &mut BeamDae,
        t: f64,
        [y, yp]: [&[f64]; 2],
    ) -> BeforeSwitch {
        self.s.clone_from(&kept.s);
        self.sp.clone_from(&kept.sp);
        self.carried.clone_from(&kept.carried);
        self.figures.clone_from(&kept.figures);
        BeforeSwitch {
            state: y.to_vec(),
            rates: yp.to_vec(),
            s: self.s.clone(),
            integrands: integrands(dae, t, [y, yp]),
        }
    }

    /// Passes a switch, at the consistent state after it. If the number changes the switching time t*, or the ends' signals at it, the
    /// sensitivities of differential unknowns and of integrals jump:
    ///
    /// ```text
    /// s⁺ = s⁻ + (y'⁻ - y'⁺) dt*/dσ + dΔ/dσ        (∂I/∂σ)⁺ = (∂I/∂σ)⁻ + (g⁻ - g⁺) dt*/dσ
    /// ```
    ///
    /// Δ is the change by [`BeamDae::switch`] of unknowns that are relative to the driven ends, and of velocities that these impose.
    pub fn pass(
        &mut self,
        dae: &mut BeamDae,
        stop: usize,
        t: f64,
        before: &BeforeSwitch,
        state: [&[f64]; 2],
    ) -> std::result::Result<(), SolverError> {
        let after = integrands(dae, t, state);
        let differential = dae.differential().to_vec();
        let mut restated = vec![0.0; differential.len()];
        for (k, perturbed) in dae.perturbed_mut().iter_mut().enumerate() {
            let stops = &self.stops[k];
            let mut moved = [0.0];
            let change = perturbed.change();
            let never = perturbed.derivative(&mut moved, |j, _, out| {
                out[0] = stops[j][stop].t;
                Ok::<(), std::convert::Infallible>(())
            });
            let never = never.and_then(|()| {
                perturbed.derivative(&mut restated, |j, beam, out| {
                    let (change, own) = (STEPS[j].0 * change, stops[j][stop].t);
                    let from = moved_by([change, own - t], [&before.state, &before.rates, &before.s[k]]);
                    out.copy_from_slice(&from);
                    beam.enter_smooth_interval(middle(&stops[j], stop));
                    beam.switch(own, middle(&stops[j], stop + 1), out);
                    out.iter_mut().zip(&from).for_each(|(out, from)| *out -= from);
                    Ok(())
                })
            });
            let Ok(()) = never;
            let [moved] = moved;
            for (i, s) in self.s[k].iter_mut().enumerate().filter(|(i, _)| differential[*i]) {
                *s += (before.rates[i] - state[1][i]) * moved + restated[i];
            }
            for ((total, before), after) in self.carried[k].iter_mut().zip(&before.integrands).zip(&after) {
                *total += (before - after) * moved;
            }
        }
        self.complete(dae, t, state)?;
        self.jump(dae, stop, t, before, state);
        Ok(())
    }

    /// Derivatives of the works of the jump at a switch, between states that each of the changed systems has at its own time.
    fn jump(&mut self, dae: &mut BeamDae, stop: usize, t: f64, before: &BeforeSwitch, state: [&[f64]; 2]) {
        let mut jumped = vec![0.0; dae.integrals()];
        for (k, perturbed) in dae.perturbed_mut().iter_mut().enumerate() {
            let stops = &self.stops[k];
            let (left, right) = (&before.s[k], &self.s[k]);
            let change = perturbed.change();
            let never = perturbed.derivative(&mut jumped, |j, beam, out| {
                let (change, own) = (STEPS[j].0 * change, stops[j][stop].t);
                let by = [change, own - t];
                let from = moved_by(by, [&before.state, &before.rates, left]);
                let to = moved_by(by, [state[0], state[1], right]);
                out.fill(0.0);
                beam.enter_smooth_interval(middle(&stops[j], stop + 1));
                beam.jump(own, (&from, middle(&stops[j], stop)), &to, out);
                Ok::<(), std::convert::Infallible>(())
            });
            let Ok(()) = never;
            for (total, jumped) in self.carried[k].iter_mut().zip(&jumped) {
                *total += jumped;
            }
        }
    }

    /// Passes a stop without a switch.
    pub fn go_on(&self, dae: &mut BeamDae, stop: usize) {
        self.look(dae, stop + 1);
    }

    /// Derivatives for the summary.
    pub fn summary(&self) -> BTreeMap<String, FigureSensitivity> {
        let names: Vec<String> = self.probes.iter().map(|one| probes::key(&one.name, one.unit)).collect();
        let of = |(parameter, figures): (&Parameter, &DerivativeAccumulator)| {
            let sensitivity = FigureSensitivity {
                value: parameter.value,
                quantities: figures.quantities(),
                probes: figures.at_probes(&names),
            };
            (parameter.pointer.clone(), sensitivity)
        };
        self.parameters.iter().zip(&self.figures).map(of).collect()
    }
}

/// State for a number changed by `change`, at an instant later by `later` [s], to first order.
fn moved_by([change, later]: [f64; 2], [y, yp, s]: [&[f64]; 3]) -> Vec<f64> {
    let rates = y.iter().zip(yp).zip(s);
    rates.map(|((y, yp), s)| y + change * s + later * yp).collect()
}

/// The middle of the interval before a stop [s].
fn middle(stops: &[ScheduledStop], stop: usize) -> f64 {
    let start = stop.checked_sub(1).map_or(0.0, |before| stops[before].t);
    0.5 * (start + stops[stop].t)
}

fn integrands(dae: &mut BeamDae, t: f64, [y, yp]: [&[f64]; 2]) -> Vec<f64> {
    let mut out = vec![0.0; dae.integrals()];
    // the integrands of the beam return no errors of their own
    let _ = dae.integrands(t, y, yp, &mut out);
    out
}
