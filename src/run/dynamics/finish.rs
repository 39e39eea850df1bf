//! End of a run: its cost and its summary.

use super::{End, Outcome, Run};
use crate::case::schema::Method;
use crate::dae::BeamDae;
use crate::discrete::System;
use crate::discrete::quantities::{Group, Interest};
use crate::error::Code;
use crate::integrate::SolverWallTimes;
use crate::model::{characteristic, water_hammer};
use crate::run::method::{Integrator, IntegratorOptions};
use crate::run::order;
use crate::run::sensitivity::forward::ForwardSensitivities;
use crate::run::summary::{Status, WallTimes};
use crate::run::unbounded;

impl Run<'_> {
    pub(super) fn count(&mut self, solver: &Integrator<BeamDae>) {
        self.summary.solver = solver.counters();
        self.summary.solver.add(&self.earlier);
        let s = &self.summary.solver;
        self.held = match self.options {
            IntegratorOptions::OneStep(_) => None,
            IntegratorOptions::Ida(_) => order::held_by_stability(
                solver.dae().system(),
                s.max_order,
                self.summary.time_s,
                s.steps,
                s.error_test_failures,
            )
            .or_else(|| {
                let chosen = self.case.solver.method == Method::Auto;
                order::stuck(s.steps, s.error_test_failures, chosen)
            }),
        };
    }

    /// Adds the wall time since the last call to a part.
    pub(super) fn spent(&mut self, on: fn(&mut WallTimes) -> &mut f64) {
        *on(&mut self.summary.wall_s) += self.laps.lap();
    }

    /// Subtracts the parts that the solver measured from the wall time of the steps.
    pub(super) fn divide(&mut self, solver: &SolverWallTimes) {
        let wall = &mut self.summary.wall_s;
        wall.residual = solver.residual.as_secs_f64();
        wall.jacobian = solver.jacobian.as_secs_f64();
        wall.linear_solver = solver.linear_solver.as_secs_f64();
        let integrands = solver.integrands.as_secs_f64();
        wall.watching += integrands;
        wall.steps -= wall.residual + wall.jacobian + wall.linear_solver + integrands;
    }

    /// Adds the figures of ports, and warnings of flows that valves stopped and of flows without a largest value.
    pub(super) fn judge_network(&mut self, system: &System) {
        let (s, seen) = (&mut self.summary, &self.observer.seen);
        s.ports = seen.probes.ports.quantities();
        let hammers = water_hammer::confirmed(self.case, &system.model, s.time_s, &seen.valve_flows);
        s.warnings.extend(hammers);
        let unbounded = unbounded::leave_out(self.case, system, s.time_s, &mut s.ports);
        s.warnings.extend(unbounded);
    }

    pub(super) fn finish(mut self, end: End) -> Outcome {
        let s = &mut self.summary;
        let fault = match end {
            End::Finished => {
                s.status = Status::Finished;
                None
            }
            End::Stopped(reason) => {
                s.status = Status::Stopped;
                s.reason = Some(reason);
                None
            }
            End::Left(fault) => {
                s.status = Status::OutOfRange;
                s.reason = Some(fault.what.clone());
                s.time_s = fault.at.time_s().unwrap_or(s.time_s);
                Some(fault)
            }
            End::Failed(fault) => {
                s.reason = Some(fault.what.clone());
                s.time_s = fault.at.time_s().unwrap_or(s.time_s);
                Some(fault)
            }
        };
        let o = &self.observer.seen;
        s.quantities = o.figures.quantities();
        s.probes = o.probes.quantities();
        let finished = s.status == Status::Finished;
        s.step_response = o.steps.as_ref().map(|steps| steps.judge(finished)).unwrap_or_default();
        o.energies.complete(&mut s.quantities, self.case.solver.rtol);
        s.warnings.extend(o.energies.warning(&s.quantities));
        s.sensitivities = self
            .forward
            .as_ref()
            .map(ForwardSensitivities::summary)
            .unwrap_or_default();
        let of = Interest::Efficiency.name();
        let value = s.quantities.get(of).copied().unwrap_or_default();
        for slope in s.sensitivities.values_mut().filter_map(|by| by.quantities.get_mut(of)) {
            slope.last = slope.last.filter(|_| value.final_absent.is_none());
            slope.window = slope.window.filter(|_| value.window_absent.is_none());
        }
        let b = &mut s.balances;
        b.energy_residual_relative = o.residuals.energy_relative();
        b.volume_residual_relative = o.residuals.volume_relative();
        b.closed_volume_residual_relative = o.residuals.closed_volume_relative();
        b.port_flow_residual_relative = o.residuals.port_flow_relative();
        b.reaction_difference_relative = o.residuals.reaction_relative();
        b.momentum_residual_relative = o.residuals.momentum_relative();
        b.angular_momentum_residual_relative = o.residuals.angular_relative();
        let energies = o
            .row
            .each()
            .filter(|(one, _)| one.unit() == "J" && one.group() != Group::Open);
        b.energy_j = energies.map(|(one, value)| (one.name().into(), value)).collect();
        s.growth = o.growth.judge(self.case.beam.length_m, &self.linear);
        let periodic = characteristic::forcing_period(self.case).is_some();
        s.warnings
            .extend(s.growth.as_ref().map(|g| Code::Growth.warning(g.warning(periodic))));
        s.growing_wave = self.waves.as_ref().and_then(|watch| watch.judge(&o.waves));
        s.warnings
            .extend(s.growing_wave.as_ref().map(|wave| Code::Growth.warning(wave.warning())));
        if !self.inertia {
            let buckled = o.growth.straight_beyond_buckling(self.case.beam.length_m, &self.linear);
            s.warnings.extend(buckled.map(|w| Code::Buckling.warning(w)));
        }
        s.warnings.extend(self.held.take().map(|w| Code::OrderHeld.warning(w)));
        s.warnings.extend(self.observer.warnings());
        s.warnings.extend(self.control.warnings());
        self.spent(|wall| &mut wall.output);
        self.summary.wall_s.close(self.laps.total());
        Outcome {
            summary: self.summary,
            fault,
        }
    }
}
