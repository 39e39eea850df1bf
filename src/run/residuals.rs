//! Residuals of the balances of a run.

use serde::{Deserialize, Serialize};

use super::rounding_scales::RoundingScales;
use crate::discrete::ledger::EnergyBalance;
use crate::discrete::ledger::{self, EnergyRate, Invariants};
use crate::discrete::{CompleteState, System, TimeData};
use crate::error::Code;
use crate::error::numbers::significant;

/// Relative residual above which the run warns that a balance does not close.
const OPEN: f64 = 0.01;

/// Relative error that an iteration may leave in pressures, over the tolerance: 0.02 in a network 10^8 times stiffer than the
/// paper's. Times the conductance of a port it is an undetermined flow, which may be large although the pressure is accurate.
const DIGITS: f64 = 0.1;
/// Upper limit of this relative error, however loose the tolerance.
const MOST_DIGITS: f64 = 1e-6;

/// Largest residuals and reference values of a run.
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
    /// For each component: largest difference between the volumes through its ports by law and by storage, the volume passed, and
    /// the volume that conductances times pressures would have passed.
    port_flow: Vec<[f64; 3]>,
    /// Fraction of conductance times pressure that is noise.
    digits: f64,
    /// Squares of reactions and of their differences, integrated over time.
    reactions: [f64; 2],
    /// Rounding scales.
    #[serde(default)]
    floors: RoundingScales,
}

impl Residuals {
    /// Creates the residuals of a system in a run with relative tolerance `rtol`. Reference values are limited from below by `floors`.
    pub fn new(system: &System, rtol: f64, floors: RoundingScales) -> Self {
        let network = system.model.wet.as_ref().map(|wet| &wet.network);
        let closed: Vec<bool> = network.map_or(vec![], |n| (0..n.components).map(|c| n.is_closed(c)).collect());
        Self {
            volume: vec![0.0; closed.len()],
            volume_seen: vec![0.0; closed.len()],
            port_flow: vec![[0.0; 3]; closed.len()],
            closed,
            digits: (DIGITS * rtol).min(MOST_DIGITS),
            floors,
            ..Self::default()
        }
    }

    /// Adds the balances at an instant; `first` are the invariants at the start.
    pub fn take(
        &mut self,
        system: &System,
        w: CompleteState,
        balance: &EnergyBalance,
        [first, invariants]: [&Invariants; 2],
        integrals: &[f64],
    ) {
        self.energy = self.energy.max(balance.residual.abs());
        let put_in = [EnergyRate::Loads, EnergyRate::Ends, EnergyRate::Ports].map(|f| integrals[f as usize].abs());
        let stored = balance.stored.total().abs();
        self.energy_seen = put_in.into_iter().fold(self.energy_seen.max(stored), f64::max);
        for c in 0..invariants.volumes.len() {
            let wet = system.model.wet.as_ref();
            let open = wet.and_then(|w| w.network.open_number(c));
            let (left, through) = open.map_or((0.0, 0.0), |k| ledger::passed(integrals, k));
            self.volume[c] = self.volume[c].max((invariants.volumes[c] - first.volumes[c] + left).abs());
            self.volume_seen[c] = self.volume_seen[c].max(through);
            if let (Some(k), Some(wet)) = (open, wet) {
                let (by_law, finest) = ledger::by_law(integrals, k, wet.network.open.len());
                let [missed, passed, most] = &mut self.port_flow[c];
                *missed = missed.max((by_law - left).abs());
                *most = most.max(finest);
                *passed = passed.max(through);
            }
        }
        displaced(system, &w.fluid.area, &w.fluid.pressure, &mut self.volume_seen);
        if !system.layout.inertia {
            return;
        }
        // Reference: the momentum that the largest energy could carry. Loads and reactions may cancel throughout.
        let model = &system.model;
        let mass: f64 = system.masses.iter().sum();
        let carried = (2.0 * mass * self.energy_seen).sqrt();
        self.momentum_seen = self.momentum_seen.max(carried);
        self.angular_seen = self.angular_seen.max(carried * model.length);
        for (k, flow) in [EnergyRate::ImpulseX, EnergyRate::ImpulseZ].into_iter().enumerate() {
            let gained = integrals[flow as usize];
            let lost = invariants.momentum[k] - first.momentum[k] - gained;
            self.momentum = self.momentum.max(lost.abs());
            self.momentum_seen = self.momentum_seen.max(invariants.momentum[k].abs()).max(gained.abs());
        }
        let gained = integrals[EnergyRate::AngularImpulse as usize];
        let lost = invariants.angular_momentum - first.angular_momentum - gained;
        self.angular = self.angular.max(lost.abs());
        self.angular_seen = self
            .angular_seen
            .max(invariants.angular_momentum.abs())
            .max(gained.abs());
    }

    /// Adds the reactions over a step of `dt` [s] that ends in the state `w`.
    pub fn follow(&mut self, system: &System, now: &TimeData, w: CompleteState, dt: f64) {
        for (sum, square) in self.reactions.iter_mut().zip(ledger::compared(system, now, w)) {
            *sum += dt * square;
        }
    }

    /// Root mean square of the difference between two evaluations of the reactions, over that of the reactions.
    pub fn reaction_relative(&self) -> f64 {
        let [size, difference] = self.reactions;
        if size > 0.0 { (difference / size).sqrt() } else { 0.0 }
    }

    /// Largest difference of a network's volume through its ports, by law and by storage, less noise, over the volume passed.
    pub fn port_flow_relative(&self) -> f64 {
        let floor = self.floors.volume;
        let each = self.port_flow.iter().filter(|[_, passed, _]| *passed > floor);
        each.map(|[missed, passed, finest]| (missed - self.digits * finest) / passed)
            .fold(0.0, f64::max)
    }

    fn relative(residual: f64, seen: f64) -> f64 {
        if seen > 0.0 { residual / seen } else { residual }
    }

    /// Energy residual over the largest energy stored or put in.
    pub fn energy_relative(&self) -> f64 {
        Self::relative(self.energy, self.energy_seen.max(self.floors.energy))
    }

    /// Largest volume residual over the largest volume displaced in the same network, or passed through its ports.
    pub fn volume_relative(&self) -> f64 {
        self.volume
            .iter()
            .zip(&self.volume_seen)
            .map(|(r, s)| Self::relative(*r, *s))
            .fold(0.0, f64::max)
    }

    /// Largest relative volume residual of the networks without ports, which close to round-off.
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
        Self::relative(self.momentum, self.momentum_seen.max(self.floors.momentum))
    }

    /// Angular momentum residual over the largest angular momentum or angular impulse.
    pub fn angular_relative(&self) -> f64 {
        let floor = self.floors.momentum * self.floors.length;
        Self::relative(self.angular, self.angular_seen.max(floor))
    }

    /// Warnings of balances that do not close.
    pub fn warnings(&self) -> Vec<String> {
        let mut all = Vec::new();
        let open = self.energy_relative();
        if open > OPEN {
            all.push(Code::EnergyOpen.warning(format!(
                "energy balance: its error is {} of the largest energy (limit {OPEN}). Reduce /solver/rtol until \
                 results no longer change. At a jump to which a beam without inertia responds far from linearly, the \
                 error remains at any tolerance.",
                significant(open, 2)
            )));
        }
        let missed = self.port_flow_relative();
        if missed > OPEN {
            all.push(Code::PortFlow.warning(format!(
                "flow through ports: the volume by the ports' law and the volume that the network stores differ by {} \
                 of the volume passed (limit {OPEN}). The pressure differences that drive the flow are near rounding \
                 error. Flows and volumes of ports are computed from the stored volume. Only their distribution among \
                 several ports of one network is uncertain. Tighten solver/rtol until it no longer changes.",
                significant(missed, 2)
            )));
        }
        let (momentum, angular) = (self.momentum_relative(), self.angular_relative());
        if momentum > OPEN || angular > OPEN {
            let open = |share: f64| format!("{} %", significant(100.0 * share, 2));
            let residual = match (momentum > OPEN, angular > OPEN) {
                (true, true) => format!(
                    "momentum balance has a residual of {}, and that of angular momentum {},",
                    open(momentum),
                    open(angular)
                ),
                (true, false) => format!("momentum balance has a residual of {}", open(momentum)),
                _ => format!("angular momentum balance has a residual of {}", open(angular)),
            };
            all.push(Code::EnergyOpen.warning(format!(
                "the {residual} of the largest momentum or impulse (limit {:.0} %). Reduce /solver/rtol until results \
                 no longer change.",
                100.0 * OPEN
            )));
        }
        all
    }
}

/// Raises the largest volume of each component: displaced, `Σ |a1| ds`, or exchanged by compliance, `Σ a_p |p| ds`. The latter
/// counts if pressure is uniform and the volume constant, since area changes are then round-off.
fn displaced(system: &System, area: &[f64], pressure: &[f64], seen: &mut [f64]) {
    let (Some(wet), Some(fluid)) = (&system.model.wet, &system.fluid) else {
        return;
    };
    let size = |cell: usize| area[cell].abs().max(wet.compliance() * pressure[cell].abs());
    let mut displaced = vec![0.0; seen.len()];
    for (bladder, &of) in wet.network.component_of_bladder.iter().enumerate() {
        displaced[of] += fluid.cells_of(bladder).map(size).sum::<f64>() * fluid.ds;
    }
    for (seen, displaced) in seen.iter_mut().zip(displaced) {
        *seen = seen.max(displaced);
    }
}
