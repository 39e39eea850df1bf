//! Observer of a run: checks validity limits at every accepted step, and samples the results at output times.

use std::borrow::Cow;

use crate::case::schema::{Case, Thinning};
use crate::dae::BeamDae;
use crate::discrete::angle_unwrapping::AngleUnwrapping;
use crate::discrete::extrema::{MonitoredQuantity, MonitoredValues};
use crate::discrete::ledger::{self, EnergyBalance, Invariants};
use crate::discrete::quantities::{self, Observable, ObservableRow, StateView, probes, stations};
use crate::discrete::{CompleteState, System, TimeData, contact_points};
use crate::error::Result;
use crate::model::mapping::tube_length;

use serde::{Deserialize, Serialize};

use super::cubic::Cubic;
use super::energies::EnergyAccumulator;
use super::figures::{self, FigureAccumulator};
use super::growth::Growth;
use super::range::{Limits, Range};
use super::readings::{self, ProbeFigures, StepReadings};
use super::record::{Header, HistoryColumn, RecordedAxis, RecordedField, Recorder, Sampled};
use super::residuals::Residuals;
use super::rounding_scales::RoundingScales;
use super::step_response::StepResponses;
use super::thinned_statistics::{self, StretchStatistics, ThinningIntervals};
use super::valves::ValveFlows;

/// Quantities whose extrema between two steps are searched.
const TURNING: [MonitoredQuantity; MonitoredQuantity::COUNT] = [
    MonitoredQuantity::Tip1,
    MonitoredQuantity::Tip3,
    MonitoredQuantity::Angle,
    MonitoredQuantity::Middle1,
    MonitoredQuantity::Largest1,
    MonitoredQuantity::Largest3,
    MonitoredQuantity::High,
    MonitoredQuantity::Low,
    MonitoredQuantity::Opening,
    MonitoredQuantity::Swelling,
    MonitoredQuantity::Strain,
    MonitoredQuantity::Flow,
    MonitoredQuantity::Pressed,
    MonitoredQuantity::Outermost,
    MonitoredQuantity::Mach,
    MonitoredQuantity::Depth,
];
/// Extrema closer together than this fraction of the step are evaluated once.
const APART: f64 = 0.05;

/// Accumulated observations; part of a checkpoint.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Observed {
    /// Energy and invariants at the start.
    start: Option<(f64, Invariants)>,
    range: Range,
    /// Balances.
    pub residuals: Residuals,
    /// Quantities of interest.
    pub figures: FigureAccumulator,
    /// Figures at probes.
    pub probes: ProbeFigures,
    /// Step responses, if requested.
    pub steps: Option<StepResponses>,
    /// Errors of the energies among the quantities of interest.
    pub energies: EnergyAccumulator,
    /// Growth of the response.
    pub growth: Growth,
    /// Waves that grow in the linearized equations.
    #[serde(default, skip_serializing_if = "super::waves::SeenWaves::is_empty")]
    pub waves: super::waves::SeenWaves,
    /// Angle unwrapping at the end of the last step.
    #[serde(default)]
    pub turns: AngleUnwrapping,
    /// The last sample.
    #[serde(default)]
    pub row: ObservableRow,
    /// Statistics over the current stretch of outputs before the window.
    #[serde(default)]
    stretch: StretchStatistics,
    /// Flows through valves as they close [m^3/s].
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub valve_flows: Vec<f64>,
}

/// Observes a run: samples it for its recorder and collects the data of the summary.
pub struct Observer {
    cell_order: Vec<usize>,
    fields_every: u64,
    thinning: Thinning,
    stretches: ThinningIntervals,
    limits: Limits,
    /// End of the last step, or start of the first step after a switch.
    before: Option<MonitoredValues>,
    turning: Vec<f64>,
    /// Longest step that cannot pass over a disc [s].
    pub longest_step: f64,
    readings: StepReadings,
    valves: ValveFlows,
    /// Accumulated observations.
    pub seen: Observed,
}

impl Observer {
    /// Observer of a case; `interval` is the output interval [s].
    pub fn new(case: &Case, system: &System, interval: f64) -> Self {
        let fields_every = (case.time.fields_interval() / interval).round().max(1.0) as u64;
        let floors = RoundingScales::of_model(case, &system.model);
        Self {
            cell_order: quantities::fields::cell_order(system, tube_length(case)),
            fields_every,
            thinning: case.time.history,
            stretches: ThinningIntervals::new(case),
            limits: Limits::new(case, system),
            before: None,
            turning: vec![],
            longest_step: f64::INFINITY,
            readings: StepReadings::new(case, system),
            valves: ValveFlows::new(case, system),
            seen: Observed {
                residuals: Residuals::new(system, case.solver.rtol, floors),
                figures: FigureAccumulator::new(case, system),
                probes: ProbeFigures::new(case, system),
                steps: case
                    .step_response
                    .map(|step| StepResponses::new(readings::names(system), step.at_s)),
                energies: EnergyAccumulator::new(case, floors.energy),
                growth: Growth::new(case.time.end_s),
                row: ObservableRow::from_system(system),
                ..Observed::default()
            },
        }
    }

    /// Describes the recorded data.
    pub fn header(case: &Case, system: &System) -> Header {
        let axis = |axis: quantities::FieldAxis| RecordedAxis {
            name: axis.name(),
            unit: axis.unit(),
            about: axis.about(),
            values: axis.values(system, tube_length(case)),
        };
        let field = |field: quantities::BeamField| RecordedField {
            name: field.name(),
            unit: field.unit(),
            axis: field.axis().name(),
            about: field.about(),
            len: field.len(system),
        };
        let own = Observable::recorded(system).into_iter().map(HistoryColumn::from);
        let columns: Vec<HistoryColumn> = own
            .chain(stations::columns(system, false))
            .chain(probes::columns(system))
            .collect();
        let envelope = match case.time.history {
            Thinning::All => vec![],
            _ => thinned_statistics::names(&columns),
        };
        Header {
            columns,
            envelope,
            axes: quantities::FieldAxis::recorded(system).map(axis).collect(),
            fields: quantities::BeamField::recorded(system).map(field).collect(),
            sensitivities: vec![],
        }
    }

    /// Begins a smooth interval: at the start of a run, and after every switch. Returns the validity limit that is exceeded, if any.
    pub fn enter(&mut self, dae: &mut BeamDae, t: f64, y: &[f64], yp: &[f64], integrals: &[f64]) -> Option<String> {
        let (system, now, w) = dae.evaluate(t, y, yp);
        let glance = MonitoredValues::new(system, now, t, w);
        self.readings.arrive(t, true, system, now, w);
        self.longest_step = contact_points::longest_step(system, &w);
        self.watch(system, now, w, &glance, integrals);
        self.seen.range.take(&self.limits, None, &glance);
        self.before = Some(glance);
        self.seen.turns.clone_from(dae.keep_turns());
        self.limits.beyond(&glance)
    }

    /// Observes the end of an accepted step, and finds the times of possible extrema within it: see [`Observer::turning`].
    /// Returns the validity limit that is exceeded, if any; nothing of such a step is stored.
    pub fn arrive(&mut self, dae: &mut BeamDae, t: f64, y: &[f64], yp: &[f64], integrals: &[f64]) -> Option<String> {
        let (system, now, w) = dae.accepted(t, y, yp);
        let glance = MonitoredValues::new(system, now, t, w);
        self.turning.clear();
        let beyond = self.limits.beyond(&glance);
        if beyond.is_some() {
            return beyond;
        }
        self.readings.arrive(t, false, system, now, w);
        self.longest_step = contact_points::longest_step(system, &w);
        self.watch(system, now, w, &glance, integrals);
        if let Some(before) = self.before.filter(|before| before.t < t) {
            self.seen.range.take(&self.limits, Some(&before), &glance);
            self.seen.figures.span(&before, &glance);
            self.seen.residuals.follow(system, now, w, t - before.t);
            self.look_between(&before, &glance);
        }
        self.before = Some(glance);
        self.seen.turns.clone_from(dae.keep_turns());
        None
    }

    /// Times [s] of possible extrema inside the step that [`Observer::arrive`] observed, in order; to be evaluated as well.
    pub fn turning(&self) -> &[f64] {
        &self.turning
    }

    /// Observes a state inside the step. Returns the validity limit that is exceeded, if any.
    pub fn look(&mut self, dae: &mut BeamDae, t: f64, y: &[f64], yp: &[f64], integrals: &[f64]) -> Option<String> {
        let (system, now, w) = dae.evaluate(t, y, yp);
        let glance = MonitoredValues::new(system, now, t, w);
        let beyond = self.limits.beyond(&glance);
        if beyond.is_none() {
            self.watch(system, now, w, &glance, integrals);
            self.seen.range.take(&self.limits, None, &glance);
        }
        beyond
    }

    /// Times [s] inside the step at which [`Observer::read`] reads tip and probes.
    pub fn reading(&self) -> impl Iterator<Item = f64> + use<> {
        self.readings.times()
    }

    /// Reads tip and probes inside the step. The second reading adds the step to their figures.
    pub fn read(&mut self, dae: &mut BeamDae, second: bool, t: f64, y: &[f64], yp: &[f64]) {
        let (system, now, w) = dae.evaluate(t, y, yp);
        self.readings.within(second, system, now, w);
        if second {
            self.seen.probes.step(&self.readings);
            if let Some(steps) = &mut self.seen.steps {
                steps.step(&self.readings);
            }
        }
    }

    /// Times after `after` [s], in order, at which largest values were reached.
    pub fn reached(&self, after: f64) -> Vec<f64> {
        let mut all: Vec<f64> = self
            .seen
            .figures
            .reached(after)
            .chain(self.seen.probes.reached(after))
            .collect();
        all.sort_by(f64::total_cmp);
        all.dedup();
        all
    }

    /// Returns the validity limit that a state exceeds, if any; stores nothing.
    pub fn beyond(&self, dae: &mut BeamDae, t: f64, y: &[f64], yp: &[f64]) -> Option<String> {
        let (system, now, w) = dae.evaluate(t, y, yp);
        let glance = MonitoredValues::new(system, now, t, w);
        self.limits.beyond(&glance)
    }

    /// Updates balances, growth and largest values with a state, in any order of time.
    fn watch(
        &mut self,
        system: &System,
        now: &TimeData,
        w: CompleteState,
        glance: &MonitoredValues,
        integrals: &[f64],
    ) -> EnergyBalance {
        let stored = ledger::energies(system, now, w);
        let invariants = ledger::invariants(system, now, w);
        let (at_start, first) = self
            .seen
            .start
            .get_or_insert_with(|| (stored.total(), invariants.clone()));
        let balance = ledger::balance(stored, *at_start, integrals);
        let residuals = &mut self.seen.residuals;
        residuals.take(system, w, &balance, [first, &invariants], integrals);
        let least_force = w.normals().iter().copied().fold(f64::INFINITY, f64::min);
        self.seen.growth.take(
            now,
            glance.t,
            [glance.deflection, stored.bending, least_force],
            integrals,
            balance.residual,
        );
        self.valves.add(glance.t, w, &mut self.seen.valve_flows);
        self.seen.figures.see(glance);
        self.seen.energies.see(glance.t, balance.residual);
        balance
    }

    /// Notes the extrema of the cubics through the ends of the step that may exceed all previous values.
    fn look_between(&mut self, before: &MonitoredValues, now: &MonitoredValues) {
        let h = now.t - before.t;
        for which in TURNING {
            let cubic = Cubic::new(figures::sized(before, which), figures::sized(now, which), h);
            for x in cubic.turns() {
                let (t, value) = (before.t + x * h, cubic.at(x));
                let worth = self.seen.figures.turn(which, value, t);
                if worth || self.limits.matters(which, value, &self.seen.range) {
                    self.turning.push(t);
                }
            }
        }
        self.turning.sort_by(f64::total_cmp);
        self.turning.dedup_by(|next, kept| *next - *kept < APART * h);
    }

    /// Adds a scaled state to the figures, in order of time, and records it if it has an output number. A state beyond a validity
    /// limit is dropped, unless the run ends there.
    #[allow(clippy::too_many_arguments)]
    pub fn sample(
        &mut self,
        dae: &mut BeamDae,
        output: Option<u64>,
        t: f64,
        y: &[f64],
        yp: &[f64],
        integrals: &[f64],
        last: bool,
        recorder: &mut dyn Recorder,
    ) -> Result<Sampled> {
        let (system, now, w) = dae.evaluate(t, y, yp);
        let glance = MonitoredValues::new(system, now, t, w);
        if let Some(what) = self.limits.beyond(&glance).filter(|_| !last) {
            return Ok(Sampled::Beyond(what));
        }
        let balance = self.watch(system, now, w, &glance, integrals);
        // The end of the last step is later than `t`, unless the run ends within the step.
        let before = self.before.filter(|before| before.t < t);
        self.seen.range.take(&self.limits, before.as_ref(), &glance);
        if let Some(before) = before {
            self.seen.figures.span(&before, &glance);
        }
        let look = StateView::new(system, now, w, balance.stored);
        self.seen.row.take(t, &look, integrals, balance.residual);
        let seen = &mut self.seen;
        seen.figures.take(&seen.row, &glance);
        seen.probes.take(t, &seen.row);
        seen.energies.take(&seen.row);
        let Some(number) = output else {
            return Ok(Sampled::Taken);
        };
        if self.thinning != Thinning::All {
            let stretch = self.stretches.index_at(t);
            if let Some(row) = self.seen.stretch.take(stretch, self.seen.row.values()) {
                recorder.envelope(&row)?;
            }
            if stretch.is_some() && !self.thinning.keeps(number) {
                return Ok(Sampled::Taken);
            }
        }
        recorder.history(self.seen.row.values())?;
        if number.is_multiple_of(self.fields_every) {
            let along = |values: &[f64]| -> Vec<f64> { self.cell_order.iter().map(|&c| values[c]).collect() };
            let ordered: Vec<Cow<[f64]>> = quantities::BeamField::recorded(system)
                .map(|field| match field.axis() {
                    quantities::FieldAxis::Network => Cow::Owned(along(&field.values(&w))),
                    quantities::FieldAxis::Cells if system.model.structure.is_some() => {
                        let all = field.values(&w);
                        Cow::Owned(quantities::fields::cells(&system.mesh).map(|c| all[c]).collect())
                    }
                    _ => field.values(&w),
                })
                .collect();
            let arrays: Vec<&[f64]> = ordered.iter().map(AsRef::as_ref).collect();
            recorder.fields(t, &arrays)?;
        }
        Ok(Sampled::Written)
    }

    /// Records the pending statistics at the end of a run.
    pub fn close(&mut self, recorder: &mut dyn Recorder) -> Result<()> {
        match self.seen.stretch.close() {
            Some(row) => recorder.envelope(&row),
            None => Ok(()),
        }
    }

    /// The last row of the history.
    pub fn row(&self) -> &ObservableRow {
        &self.seen.row
    }

    /// Warnings of open balances and of exceeded limits of the model's range.
    pub fn warnings(&self) -> Vec<String> {
        let mut all = self.seen.residuals.warnings();
        all.extend(self.seen.range.warnings(&self.limits));
        all
    }
}
