//! The beam with its bladders as a [`Dae`]: scaled unknowns for the integrator, SI units inside.

use std::ops::Range;

use super::jacobian::{self, ChainRule, LANES};
use super::sparsity_tracer::Dependence;
use super::{Dae, EvaluationError, Pattern, PerturbedSystems, RotatedVectors, Seeds};
use crate::discrete::ledger::EnergyRate;
use crate::discrete::residual::ambient_fluid::mean_direction;
use crate::discrete::{CompleteState, System, TimeData, Workspace, ledger, residual};
use crate::functions::signals::SmoothTime;
use crate::model::Kinematics;
use crate::numerics::{Dual, Planar, kernels, wide};

/// Equations `F(t, y, y') = 0` of a [`System`]; each unknown and each equation is divided by its characteristic size.
#[derive(Clone, Debug)]
pub struct BeamDae {
    pub(super) system: System,
    pub(super) within: f64,
    pub(super) now: TimeData,
    /// Time data from before the last switch.
    pub(super) before: TimeData,
    pattern: Pattern,
    chain: ChainRule,
    /// Inverse of the characteristic size of each equation.
    per_row: Vec<f64>,
    pub(super) plain: Buffers<f64>,
    dual: Buffers<Dual<LANES>>,
    pub(super) perturbed: Vec<PerturbedSystems>,
    /// Time for which the workspace contains a complete state, including its integrands.
    pub(super) held: Option<f64>,
}

#[derive(Clone, Debug)]
pub(super) struct Buffers<T> {
    pub(super) workspace: Workspace<T>,
    pub(super) y: Vec<T>,
    pub(super) yp: Vec<T>,
    pub(super) residual: Vec<T>,
}

impl<T: crate::numerics::Scalar> Buffers<T> {
    fn new(system: &System, numbers: usize) -> Self {
        let zeros = vec![T::zero(); system.layout.len];
        Self {
            workspace: Workspace::new(system),
            y: zeros.clone(),
            yp: zeros,
            residual: vec![T::zero(); numbers],
        }
    }
}

impl Buffers<f64> {
    /// Evaluates a scaled state of positions and velocities, with zero rates.
    pub(super) fn take_up(&mut self, system: &System, now: &TimeData, state: &[f64]) {
        kernels::products(state, &system.layout.scales, &mut self.y);
        self.yp.fill(0.0);
        residual::evaluate(system, now, &self.y, &self.yp, &mut self.workspace);
    }
}

impl Buffers<Dual<LANES>> {
    /// Copies unknowns and rates, with zero derivatives.
    fn take(&mut self, plain: &Buffers<f64>) {
        let pairs = [(&mut self.y, &plain.y), (&mut self.yp, &plain.yp)];
        for (dual, plain) in pairs {
            for (dual, &value) in dual.iter_mut().zip(plain) {
                *dual = Dual {
                    value,
                    derivative: [0.0; LANES],
                };
            }
        }
    }
}

impl BeamDae {
    /// Creates the DAE of a system; determines the Jacobian's pattern and its coloring.
    pub fn new(system: System) -> Self {
        let (mut now, before) = (TimeData::new(&system), TimeData::new(&system));
        now.update(&system, SmoothTime { t: 0.0, within: 0.0 });
        let per_row: Vec<f64> = system.layout.row_scales.iter().map(|row| 1.0 / row).collect();
        let (pattern, chain) = ChainRule::new(&system, &Dependence::new(&system, &now), &per_row);
        let (plain, dual) = (
            Buffers::new(&system, 0),
            Buffers::new(&system, jacobian::width(&system)),
        );
        Self {
            per_row,
            system,
            within: 0.0,
            before,
            now,
            pattern,
            chain,
            plain,
            dual,
            perturbed: vec![],
            held: None,
        }
    }

    /// Equations of another system with the same unknowns.
    pub(super) fn with_system(&self, system: System) -> Self {
        Self {
            plain: Buffers::new(&system, 0),
            now: TimeData::new(&system),
            before: TimeData::new(&system),
            perturbed: vec![],
            held: None,
            system,
            ..self.clone()
        }
    }

    /// Adds the systems with perturbed parameters, which sensitivities to these parameters need.
    pub fn with_perturbed(self, perturbed: Vec<PerturbedSystems>) -> Self {
        Self { perturbed, ..self }
    }

    /// Systems with perturbed parameters.
    pub fn perturbed_mut(&mut self) -> &mut [PerturbedSystems] {
        &mut self.perturbed
    }

    /// The system being solved.
    pub fn system(&self) -> &System {
        &self.system
    }

    /// Selects the smooth interval in which signals are evaluated, by an instant inside it [s].
    pub fn enter_smooth_interval(&mut self, t: f64) {
        self.within = t;
    }

    /// Instant that selects the smooth interval in which signals are evaluated [s].
    pub fn within(&self) -> f64 {
        self.within
    }

    /// Time data of the last evaluation.
    pub(super) fn now(&self) -> &TimeData {
        &self.now
    }

    /// The system, and its time data at an instant.
    pub fn instant(&mut self, t: f64) -> (&System, &TimeData) {
        self.held = None;
        self.now.update(&self.system, SmoothTime { t, within: self.within });
        (&self.system, &self.now)
    }

    /// Replaces integrals of the flow rate of ports with prescribed volume by the volume injected until `t` [s].
    pub fn settle(&mut self, t: f64, integrals: &mut [f64]) {
        if self.held != Some(t) {
            self.held = None;
        }
        self.now.update(&self.system, SmoothTime { t, within: self.within });
        ledger::ports::settle(&self.system, &self.now, integrals);
    }

    /// Evaluates the model at a scaled state; returns time data and workspace, for balances and samples.
    pub fn evaluate(&mut self, t: f64, y: &[f64], yp: &[f64]) -> (&System, &TimeData, CompleteState<'_>) {
        self.unscale(t, y, yp);
        let b = &mut self.plain;
        residual::evaluate(&self.system, &self.now, &b.y, &b.yp, &mut b.workspace);
        let state = ledger::complete(&self.system, &self.now, &b.yp, &mut b.workspace);
        (&self.system, &self.now, state)
    }

    /// Like [`BeamDae::evaluate`], for a state that the integrator has just accepted at `t` [s]. If its integrands were the last
    /// evaluation, the workspace still contains them.
    pub fn accepted(&mut self, t: f64, y: &[f64], yp: &[f64]) -> (&System, &TimeData, CompleteState<'_>) {
        if self.held != Some(t) {
            return self.evaluate(t, y, yp);
        }
        let state = ledger::complete_after_flows(&self.system, &self.now, &mut self.plain.workspace);
        (&self.system, &self.now, state)
    }

    /// Evaluates the model at a scaled state and passes time data, rates in SI units and workspace to `read`.
    pub(super) fn visit<R>(
        &mut self,
        t: f64,
        y: &[f64],
        yp: &[f64],
        read: impl FnOnce(&System, &TimeData, &[f64], &mut Workspace<f64>) -> R,
    ) -> R {
        self.unscale(t, y, yp);
        let b = &mut self.plain;
        residual::evaluate(&self.system, &self.now, &b.y, &b.yp, &mut b.workspace);
        read(&self.system, &self.now, &b.yp, &mut b.workspace)
    }

    fn unscale(&mut self, t: f64, y: &[f64], yp: &[f64]) {
        self.held = None;
        self.now.update(&self.system, SmoothTime { t, within: self.within });
        let scales = &self.system.layout.scales;
        for (own, given) in [(&mut self.plain.y, y), (&mut self.plain.yp, yp)] {
            kernels::products(given, scales, own);
        }
    }
}

impl Dae for BeamDae {
    fn len(&self) -> usize {
        self.system.layout.len
    }

    fn differential(&self) -> &[bool] {
        &self.system.layout.differential
    }

    fn pattern(&self) -> &Pattern {
        &self.pattern
    }

    fn residual(&mut self, t: f64, y: &[f64], yp: &[f64], residual: &mut [f64]) -> Result<(), EvaluationError> {
        self.unscale(t, y, yp);
        let b = &mut self.plain;
        residual::residual(&self.system, &self.now, &b.y, &b.yp, &mut b.workspace, residual);
        kernels::multiply(residual, &self.per_row);
        Ok(())
    }

    fn approach(&mut self, cj: f64) {
        self.now.cj = cj;
    }

    /// Vectors of displacements and, if both are unknowns, of velocities.
    fn vectors(&self) -> Vec<RotatedVectors> {
        let l = &self.system.layout;
        if self.system.model.kinematics != Kinematics::FiniteRotation || self.system.model.structure.is_some() {
            return vec![];
        }
        let blocks = match l.lines.each_ref().map(|line| (line.u.start, line.v.as_ref())) {
            [(across, None), (along, None)] => vec![[across, along]],
            [(across, Some(rates_across)), (along, Some(rates_along))] => {
                vec![[across, along], [rates_across.start, rates_along.start]]
            }
            _ => return vec![], // inertia across alone does not turn
        };
        let [across, along] = l.lines.each_ref().map(|line| line.free.clone());
        let kept = [&across, &along].map(|free| free.len() == self.system.mesh.nodes);
        if kept[0] != kept[1] {
            return vec![]; // no turn keeps momentum in one direction alone
        }
        let both = across.start.max(along.start)..across.end.min(along.end);
        if both.is_empty() {
            return vec![];
        }
        let vectors = blocks.into_iter().map(|[x, z]| {
            let (x, z) = (x + both.start - across.start, z + both.start - along.start);
            RotatedVectors {
                across: x..x + both.len(),
                along: z..z + both.len(),
                node: both.start,
                free: kept == [true; 2],
                size: l.scales[z] / l.scales[x],
                row_size: l.row_scales[z] / l.row_scales[x],
            }
        });
        vectors.collect()
    }

    /// Mean direction of the cells adjacent to a node.
    fn directions(&self, out: &mut [Planar<f64>]) {
        let cells = &self.plain.workspace.shape.tangent;
        let last = cells.len();
        out[0] = cells[0];
        wide!({
            for (out, pair) in out[1..].iter_mut().zip(cells.windows(2)) {
                *out = mean_direction([pair[0], pair[1]]);
            }
        });
        if out.len() > last {
            out[last] = cells[last - 1];
        }
    }

    fn jacobian(
        &mut self,
        t: f64,
        y: &[f64],
        yp: &[f64],
        seeds: Seeds<'_>,
        values: &mut [f64],
    ) -> Result<(), EvaluationError> {
        self.unscale(t, y, yp);
        let scales = &self.system.layout.scales;
        self.dual.take(&self.plain);
        let of = (&self.system, &self.now);
        let b = &mut self.dual;
        match seeds {
            Seeds::Step { cj } => {
                let seeds = |k: usize| [scales[k], cj * scales[k]];
                self.chain.differentiate(of, b, seeds, &self.per_row, values);
            }
            Seeds::Columns { y, yp } => {
                let seeds = |k: usize| [y[k] * scales[k], yp[k] * scales[k]];
                self.chain.differentiate(of, b, seeds, &self.per_row, values);
            }
        }
        Ok(())
    }

    /// Computes [`LANES`] directions per sweep; does not allocate.
    fn tangent(
        &mut self,
        t: f64,
        y: &[f64],
        yp: &[f64],
        [dy, dyp]: [&[&[f64]]; 2],
        out: &mut [&mut [f64]],
    ) -> Result<(), EvaluationError> {
        self.unscale(t, y, yp);
        let scales = &self.system.layout.scales;
        let b = &mut self.dual;
        for (first, out) in (0..).step_by(LANES).zip(out.chunks_mut(LANES)) {
            b.take(&self.plain);
            for lane in 0..out.len() {
                for (k, scale) in scales.iter().enumerate() {
                    b.y[k].derivative[lane] = dy[first + lane][k] * scale;
                    b.yp[k].derivative[lane] = dyp[first + lane][k] * scale;
                }
            }
            let r = &mut b.residual[..self.system.layout.len];
            residual::residual(&self.system, &self.now, &b.y, &b.yp, &mut b.workspace, r);
            for (lane, out) in out.iter_mut().enumerate() {
                for ((out, r), per) in out.iter_mut().zip(&b.residual).zip(&self.per_row) {
                    *out = r.derivative[lane] * per;
                }
            }
        }
        Ok(())
    }

    fn parameters(&self) -> usize {
        self.perturbed.len()
    }

    fn parameter_derivative(
        &mut self,
        k: usize,
        t: f64,
        y: &[f64],
        yp: &[f64],
        out: &mut [f64],
    ) -> Result<(), EvaluationError> {
        let cj = self.now.cj;
        self.perturbed[k].derivative(out, |_, beam, out| {
            beam.approach(cj);
            beam.residual(t, y, yp, out)
        })
    }

    fn integrand_derivative(
        &mut self,
        k: usize,
        t: f64,
        state: [&[f64]; 2],
        along: [&[f64]; 2],
        out: &mut [f64],
    ) -> Result<(), EvaluationError> {
        self.read_slope(k, t, state, along, out, ledger::flows);
        Ok(())
    }

    fn integrals(&self) -> usize {
        ledger::rate_count(&self.system)
    }

    fn integrals_of_powers(&self) -> Range<usize> {
        0..EnergyRate::ImpulseX as usize
    }

    fn integrands(&mut self, t: f64, y: &[f64], yp: &[f64], out: &mut [f64]) -> Result<(), EvaluationError> {
        self.unscale(t, y, yp);
        let b = &mut self.plain;
        residual::evaluate(&self.system, &self.now, &b.y, &b.yp, &mut b.workspace);
        ledger::flows(&self.system, &self.now, &b.yp, &mut b.workspace, out);
        self.held = Some(t);
        Ok(())
    }

    fn name(&self, unknown: usize) -> String {
        self.system.layout.name(unknown)
    }
}
