//! What a run looks at on its way: samples, balances, and whether the model still holds.

use crate::case::schema::Case;
use crate::dae::BeamDae;
use crate::discrete::ledger::{self, Flow, Invariants};
use crate::discrete::{System, sample};
use crate::error::{Code, Result};
use crate::model::audit;
use crate::model::mapping::{NetworkCoordinate, TABLE_TUBE_RATIO};

use serde::{Deserialize, Serialize};

use super::energies::Energies;
use super::estimate::Estimator;
use super::figures::Figures;
use super::growth::Growth;
use super::record::{Axis, Column, Field, Header, Recorder};

/// Above this the run warns that the energy balance does not close.
const ENERGY_OPEN: f64 = 0.01;

/// Largest residuals and references seen.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Residuals {
    energy: f64,
    energy_seen: f64,
    volume: Vec<f64>,
    volume_seen: Vec<f64>,
    closed: Vec<bool>,
    momentum: f64,
    momentum_seen: f64,
    angular: f64,
    angular_seen: f64,
}

impl Residuals {
    fn relative(residual: f64, seen: f64) -> f64 {
        if seen > 0.0 { residual / seen } else { residual }
    }

    /// Energy residual over the largest energy stored or put in.
    pub fn energy_relative(&self) -> f64 {
        Self::relative(self.energy, self.energy_seen)
    }

    /// Worst volume residual over the largest volume displaced in the same network, or passed through its ports.
    pub fn volume_relative(&self) -> f64 {
        self.volume
            .iter()
            .zip(&self.volume_seen)
            .map(|(r, s)| Self::relative(*r, *s))
            .fold(0.0, f64::max)
    }

    /// The same for networks without ports alone: these close to round-off.
    pub fn closed_volume_relative(&self) -> f64 {
        let closed = self
            .volume
            .iter()
            .zip(&self.volume_seen)
            .zip(&self.closed)
            .filter(|(_, closed)| **closed);
        closed.map(|((r, s), _)| Self::relative(*r, *s)).fold(0.0, f64::max)
    }

    /// Momentum residual over the largest momentum or impulse.
    pub fn momentum_relative(&self) -> f64 {
        Self::relative(self.momentum, self.momentum_seen)
    }

    /// Angular momentum residual over the largest angular momentum or angular impulse.
    pub fn angular_relative(&self) -> f64 {
        Self::relative(self.angular, self.angular_seen)
    }
}

/// Limits of the model's range met on the way, with time and place.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Range {
    strain: Option<(f64, f64, usize)>,
    convexity: Option<(f64, f64)>,
    reynolds: Option<(f64, f64, usize)>,
}

/// What has been seen so far; a checkpoint keeps it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Observed {
    /// Energy and invariants at the start.
    start: Option<(f64, Invariants)>,
    range: Range,
    /// Balances.
    pub residuals: Residuals,
    /// Quantities of interest.
    pub figures: Figures,
    /// Errors of those that are energies.
    pub energies: Energies,
    /// What mesh and steps do to vibrations.
    #[serde(default)]
    pub estimate: Estimator,
    /// Growth of the response.
    pub growth: Growth,
    /// Integrals at the last sample.
    pub integrals: Vec<f64>,
    /// Stored energies at the last sample.
    pub stored: ledger::Energies,
}

/// Samples a run for its recorder and keeps what the summary needs.
pub struct Observer {
    half_height: f64,
    cell_order: Vec<usize>,
    fields_every: u64,
    row: Vec<f64>,
    convex_up_to: f64,
    /// Mass [kg] and length [m] of the beam.
    mass: f64,
    length: f64,
    /// `2 ρ/(π μ r_c)`: Reynolds number of a tube over its flow [s/m^3].
    reynolds_per_flow: f64,
    /// What has been seen so far.
    pub seen: Observed,
}

impl Observer {
    /// Observer of a case; `interval` is the output interval [s].
    pub fn new(case: &Case, system: &System, interval: f64) -> Self {
        let (cell_order, convex_up_to) = system.model.wet.as_ref().map_or((vec![], f64::INFINITY), |wet| {
            let map = network_coordinate(case, wet);
            let (bending, stretch) = audit::convex_up_to(&system.model, wet);
            (sample::cell_order(system, &map), bending.min(stretch))
        });
        let fields_every = (case.time.fields_interval() / interval).round().max(1.0) as u64;
        let closed: Vec<bool> = system.model.wet.as_ref().map_or(vec![], |w| {
            (0..w.network.components).map(|c| w.network.is_closed(c)).collect()
        });
        let columns: Vec<&str> = sample::columns(system).iter().map(|c| c.0).collect();
        let residuals = Residuals {
            volume: vec![0.0; closed.len()],
            volume_seen: vec![0.0; closed.len()],
            closed,
            ..Residuals::default()
        };
        Self {
            half_height: 0.5 * case.beam.height_m,
            cell_order,
            fields_every,
            row: Vec::new(),
            convex_up_to,
            mass: system.model.section.mass_per_length * system.model.length,
            length: system.model.length,
            reynolds_per_flow: match (&case.fluid, &case.tubes) {
                (Some(f), Some(t)) => 2.0 * f.density_kg_m3 / (std::f64::consts::PI * f.viscosity_pa_s * t.radius_m),
                _ => 0.0,
            },
            seen: Observed {
                residuals,
                figures: Figures::new(case, &columns),
                energies: Energies::new(case, &columns),
                estimate: Estimator::new(case, system),
                growth: Growth::new(case.time.end_s),
                integrals: vec![0.0; ledger::flow_count(system)],
                ..Observed::default()
            },
        }
    }

    /// What will be recorded.
    pub fn header(case: &Case, system: &System) -> Header {
        let tube = case.tubes.as_ref().map_or(0.0, |t| t.length_m);
        let axes: Vec<Axis> = sample::axes(system, tube)
            .into_iter()
            .map(|(name, unit, about, values)| Axis {
                name,
                unit,
                about,
                values,
            })
            .collect();
        let (nodes, cells) = (system.mesh.nodes, system.mesh.cells);
        let mut fields = vec![
            field("u1_m", "m", "theta_node_m", "transverse displacement", nodes),
            field("u3_m", "m", "theta_node_m", "axial displacement", nodes),
            field("v1_m_s", "m/s", "theta_node_m", "transverse velocity", nodes),
            field("v3_m_s", "m/s", "theta_node_m", "axial velocity", nodes),
            field(
                "curvature_1_m",
                "1/m",
                "theta_node_m",
                "curvature, positive with the +x fibre in tension",
                nodes,
            ),
            field("moment_n_m", "N m", "theta_node_m", "bending moment", nodes),
            field("normal_force_n", "N", "theta_cell_m", "normal force", cells),
        ];
        if let Some(fluid) = &system.fluid {
            fields.push(field(
                "pressure_pa",
                "Pa",
                "x_f",
                "pressure of the bladder cells",
                fluid.cells,
            ));
            fields.push(field(
                "area_change_m2",
                "m^2",
                "x_f",
                "area change of the bladder cells",
                fluid.cells,
            ));
        }
        let columns = sample::columns(system)
            .into_iter()
            .map(|(name, unit, about)| Column {
                name: name.into(),
                unit,
                about: about.into(),
            })
            .collect();
        Header {
            columns,
            axes,
            fields,
            sensitivities: vec![],
        }
    }

    /// Takes the sample number `number` at a scaled state. Returns why the run must end here, if it must.
    #[allow(clippy::too_many_arguments)]
    pub fn sample(
        &mut self,
        dae: &mut BeamDae,
        number: u64,
        t: f64,
        y: &[f64],
        yp: &[f64],
        integrals: &[f64],
        recorder: &mut dyn Recorder,
    ) -> Result<Option<String>> {
        let (system, now, w) = dae.evaluate(t, y, yp);
        let stored = ledger::energies(system, now, w);
        let invariants = ledger::invariants(system, now, w);
        let total = stored.total();
        let (at_start, first) = self.seen.start.get_or_insert_with(|| (total, invariants.clone()));
        let balance = sample::energy_balance(stored, *at_start, integrals);
        let r = &mut self.seen.residuals;
        r.energy = r.energy.max(balance.residual.abs());
        let put_in = [Flow::Loads, Flow::Ends, Flow::Ports].map(|f| integrals[f as usize].abs());
        r.energy_seen = put_in.into_iter().fold(r.energy_seen.max(total.abs()), f64::max);
        for c in 0..invariants.volumes.len() {
            let open = system
                .model
                .wet
                .as_ref()
                .and_then(|w| w.network.open.iter().position(|&o| o == c));
            let (left, through) = open.map_or((0.0, 0.0), |k| ledger::passed(integrals, k));
            r.volume[c] = r.volume[c].max((invariants.volumes[c] - first.volumes[c] + left).abs());
            r.volume_seen[c] = r.volume_seen[c].max(through);
        }
        displaced(system, &w.area, &w.pressure, &mut r.volume_seen);
        let impulse = [integrals[Flow::ImpulseX as usize], integrals[Flow::ImpulseZ as usize]];
        if system.layout.inertia {
            // The momentum that the largest energy could carry: loads and reactions may cancel all along.
            let carried = (2.0 * self.mass * r.energy_seen).sqrt();
            r.momentum_seen = r.momentum_seen.max(carried);
            r.angular_seen = r.angular_seen.max(carried * self.length);
            for (k, gained) in impulse.into_iter().enumerate() {
                let lost = invariants.momentum[k] - first.momentum[k] - gained;
                r.momentum = r.momentum.max(lost.abs());
                r.momentum_seen = r.momentum_seen.max(invariants.momentum[k].abs()).max(gained.abs());
            }
            let gained = integrals[Flow::AngularImpulse as usize];
            r.angular = r
                .angular
                .max((invariants.angular_momentum - first.angular_momentum - gained).abs());
            r.angular_seen = r.angular_seen.max(invariants.angular_momentum.abs()).max(gained.abs());
        }
        let deflection = w.u1.iter().fold(0.0_f64, |d, u| d.max((u - w.u1[0]).abs()));
        let least_force = w.force.iter().copied().fold(f64::INFINITY, f64::min);
        self.seen
            .growth
            .take(t, deflection, stored.bending, least_force, integrals, balance.residual);
        let reynolds = sample::largest_flow(system, now, w).map(|(q, place)| (q * self.reynolds_per_flow, t, place));
        if let Some(r) = reynolds
            && self
                .seen
                .range
                .reynolds
                .as_ref()
                .is_none_or(|(largest, ..)| r.0 > *largest)
        {
            self.seen.range.reynolds = Some(r);
        }
        sample::row(system, now, t, w, &balance, integrals, &mut self.row);
        recorder.history(&self.row)?;
        self.seen.figures.take(&self.row);
        self.seen.energies.take(&self.row);
        self.seen.integrals.copy_from_slice(integrals);
        self.seen.stored = stored;

        let (strain, node) = sample::largest_strain(system, self.half_height, w);
        if self.seen.range.strain.is_none_or(|(s, ..)| strain > s) {
            self.seen.range.strain = Some((strain, t, node));
        }
        let opening = sample::least_opening(system, w);
        let sum = (0..w.mean_force.len())
            .map(|j| w.mean_pressure[j] + w.mean_pressure[w.mean_force.len() + j])
            .fold(f64::NEG_INFINITY, f64::max);
        if sum > self.convex_up_to && self.seen.range.convexity.is_none() {
            self.seen.range.convexity = Some((sum, t));
        }
        if number.is_multiple_of(self.fields_every) {
            let along = |values: &[f64]| -> Vec<f64> { self.cell_order.iter().map(|&c| values[c]).collect() };
            let (pressure, area) = (along(&w.pressure), along(&w.area));
            let mut arrays: Vec<&[f64]> = vec![&w.u1, &w.u3, &w.v1, &w.v3, &w.kappa, &w.moment, &w.force];
            if system.fluid.is_some() {
                arrays.extend([pressure.as_slice(), area.as_slice()]);
            }
            recorder.fields(t, &arrays)?;
        }
        Ok((opening <= 0.0).then(|| {
            format!("a bladder is closed at t = {t:.6} s: its cross-section h_b w_b + a1 has reached zero, where the model ends")
        }))
    }

    /// The last row of the history.
    pub fn row(&self) -> &[f64] {
        &self.row
    }

    /// Limits of the model's range that were passed.
    pub fn warnings(&self) -> Vec<String> {
        let mut all = Vec::new();
        let open = self.seen.residuals.energy_relative();
        if open > ENERGY_OPEN {
            all.push(Code::EnergyOpen.warning(format!(
                "energy balance: it stays open by {open:.1e} of the largest energy; tighten solver/rtol \
                 until answers no longer change (a load or valve that jumps without inertia or damping leaves it open at any tolerance)"
            )));
        }
        if let Some((strain, t, node)) = self.seen.range.strain
            && strain > 0.5
        {
            all.push(Code::Strain.warning(format!(
                "range of the model: the largest fibre strain |lambda - 1| + |kappa| h_s/2 reached {strain:.2} at \
                 t = {t:.4} s, node {node}; strains are meant to be small"
            )));
        }
        if let Some((reynolds, t, tube)) = self.seen.range.reynolds
            && reynolds > 100.0
        {
            all.push(Code::FastFlow.warning(format!(
                "range of the model: the Reynolds number reached {reynolds:.0} at t = {t:.4} s in tube {}; flow is meant to \
                 creep",
                tube + 1
            )));
        }
        if let Some((sum, t)) = self.seen.range.convexity {
            all.push(Code::LostConvexity.warning(format!(
                "the kinked reciprocal potential lost convexity: p_u + p_d reached {sum:.3e} Pa at t = {t:.4} s, \
                 above {:.3e} Pa; results from then on are not to be trusted (use \"reciprocal\" or a larger kink_width)",
                self.convex_up_to
            )));
        }
        all
    }
}

fn field(name: &'static str, unit: &'static str, axis: &'static str, about: &'static str, len: usize) -> Field {
    Field {
        name,
        unit,
        axis,
        about,
        len,
    }
}

/// The network's coordinate as the paper's tables have it.
pub fn network_coordinate(case: &Case, wet: &crate::model::Wet) -> NetworkCoordinate {
    let tube = case.tubes.as_ref().map_or(0.0, |t| t.length_m);
    NetworkCoordinate::new(&wet.network, wet.per_row, wet.bladder_length, TABLE_TUBE_RATIO * tube)
}

/// Raises the largest volume displaced in each component, `Σ |a1| ds`, or pressed out of it and back in, `Σ a_p |p| ds`:
/// where pressure is one and the volume is kept, areas are nothing but round-off.
fn displaced(system: &System, area: &[f64], pressure: &[f64], seen: &mut [f64]) {
    let (Some(wet), Some(fluid)) = (&system.model.wet, &system.fluid) else {
        return;
    };
    let mut now = vec![0.0; seen.len()];
    for (cell, (a, p)) in area.iter().zip(pressure).enumerate() {
        let size = a.abs().max(wet.area.per_pressure * p.abs());
        now[wet.network.component_of_bladder[cell / fluid.cells_per_bladder]] += size * fluid.ds;
    }
    for (s, n) in seen.iter_mut().zip(now) {
        *s = s.max(n);
    }
}
