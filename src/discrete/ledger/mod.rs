//! Energies, powers and impulses, exact in the semi-discrete system: their balance is the integrator's error alone.

mod compressed;
mod fluid;
mod jump;
pub mod ports;
mod reactions;
mod solid;
mod stored;
mod tubes;

pub use compressed::{area_rate, lumped_slopes, pressure_rate};
pub use fluid::pressure_rates;
pub use jump::{side, strokes, travel};
pub use reactions::compared;
pub use solid::reaction;

use crate::case::schema::Effect;
use serde::{Deserialize, Serialize};

use super::{State, System, TimeData, Workspace, readings, residual, touching};

/// Rates that are integrated along the run, and what they add up to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EnergyRate {
    /// Power of distributed loads and given end forces.
    Loads,
    /// Power of driven ends and end moments.
    Ends,
    /// Power of ports and pumps.
    Ports,
    /// Dissipated in the bladders.
    Bladders,
    /// Dissipated in the tubes.
    Tubes,
    /// Harvested by the turbines.
    Turbines,
    /// Dissipated in check valves, of rectifiers and in tubes.
    Rectifiers,
    /// Dissipated by material damping and drag.
    Damping,
    /// Power that the published form of the momentum balance adds.
    Formulation,
    /// Power that a coupling without reciprocity adds.
    Reciprocity,
    /// External force in x (its integral is the impulse).
    ImpulseX,
    /// External force in z.
    ImpulseZ,
    /// External torque about the origin.
    AngularImpulse,
}

/// All flows, in the order in which they are stored; outflow and throughput of every open network follow, then of each what its
/// ports' law gives and how finely that can be known, then what has come in through each port by itself.
pub const ENERGY_RATES: [EnergyRate; 13] = [
    EnergyRate::Loads,
    EnergyRate::Ends,
    EnergyRate::Ports,
    EnergyRate::Bladders,
    EnergyRate::Tubes,
    EnergyRate::Turbines,
    EnergyRate::Rectifiers,
    EnergyRate::Damping,
    EnergyRate::Formulation,
    EnergyRate::Reciprocity,
    EnergyRate::ImpulseX,
    EnergyRate::ImpulseZ,
    EnergyRate::AngularImpulse,
];

/// One of each.
type Rates = [f64; ENERGY_RATES.len()];

impl EnergyRate {
    /// Sign with which the flow enters the energy balance; 0 for impulses.
    pub fn energy_sign(self) -> f64 {
        match self {
            Self::Loads | Self::Ends | Self::Ports | Self::Formulation | Self::Reciprocity => 1.0,
            Self::Bladders | Self::Tubes | Self::Turbines | Self::Rectifiers | Self::Damping => -1.0,
            Self::ImpulseX | Self::ImpulseZ | Self::AngularImpulse => 0.0,
        }
    }
}

/// Stored energies [J].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Energies {
    /// `Σ h_i m |v_i|²/2`.
    pub kinetic: f64,
    /// Rotation of the sections.
    pub rotary: f64,
    /// `Σ h N²/2EA`.
    pub axial: f64,
    /// `Σ h_i M²/2EI`.
    pub bending: f64,
    /// Stored in the bladders.
    pub bladders: f64,
    /// Kinetic, of the fluid in tubes and along bladders.
    #[serde(default)]
    pub tubes: f64,
    /// Of the section at finite strain, beyond all these.
    #[serde(default)]
    pub section: f64,
    /// Of the parts of the section's forces that relax.
    #[serde(default)]
    pub relaxing: f64,
    /// Of compressed fluid.
    #[serde(default)]
    pub compression: f64,
    /// In accumulators.
    #[serde(default)]
    pub accumulators: f64,
    /// Of walls that are pressed.
    #[serde(default)]
    pub contacts: f64,
    /// Of springs to ground.
    #[serde(default)]
    pub springs: f64,
    /// Kinetic, of the fluid around the beam.
    #[serde(default)]
    pub around: f64,
}

impl Energies {
    /// Sum.
    pub fn total(&self) -> f64 {
        self.kinetic
            + self.rotary
            + self.axial
            + self.bending
            + self.bladders
            + self.tubes
            + self.relaxing
            + self.compression
            + self.section
            + self.accumulators
            + self.contacts
            + self.springs
            + self.around
    }
}

/// Momentum, angular momentum and stored volumes: what else is conserved.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Invariants {
    /// `Σ h_i m v` in x and z [kg m/s].
    pub momentum: [f64; 2],
    /// About the origin, positive in the sense of growing phi [kg m^2/s].
    pub angular_momentum: f64,
    /// Volume change stored in each component of the network [m^3].
    pub volumes: Vec<f64>,
}

/// Balance of energy at an instant.
#[derive(Clone, Copy, Debug, Default)]
pub struct EnergyBalance {
    /// Stored now.
    pub stored: Energies,
    /// Residual [J].
    pub residual: f64,
}

/// Energy now, less at the start, less all that came in and went out (`integrals` of [`ENERGY_RATES`]).
pub fn balance(stored: Energies, at_start: f64, integrals: &[f64]) -> EnergyBalance {
    let passed: f64 = ENERGY_RATES
        .iter()
        .map(|f| f.energy_sign() * integrals[*f as usize])
        .sum();
    EnergyBalance {
        stored,
        residual: stored.total() - at_start - passed,
    }
}

/// Number of integrated rates of a system.
pub fn rate_count(system: &System) -> usize {
    let wet = system.model.wet.as_ref();
    wet.map_or(ENERGY_RATES.len(), |wet| ports::first(wet) + ports::count(wet))
}

/// Volume that has left the `open`-th open network through its ports, and volume that has passed them either way [m^3].
pub fn passed(integrals: &[f64], open: usize) -> (f64, f64) {
    (
        integrals[ENERGY_RATES.len() + 2 * open],
        integrals[ENERGY_RATES.len() + 2 * open + 1],
    )
}

/// Volume that has left the `open`-th of `count` open networks by the law of its ports, and the volume that conductances times
/// pressures would have passed [m^3]: a share of it, the last digits of pressures, is noise.
pub fn by_law(integrals: &[f64], open: usize, count: usize) -> (f64, f64) {
    let first = ENERGY_RATES.len() + 2 * count + 2 * open;
    (integrals[first], integrals[first + 1])
}

/// `[E19]` Rates of all integrals (SI) at a state given in SI units:
///
/// ```text
/// dE/dt = P_loads + P_ends + P_ports - D_bladders - D_tubes - D_turbines - D_rectifiers - D_damping
///         + P_formulation + P_reciprocity
/// ```
///
/// The workspace must hold [`residual::evaluate`] of the same state; rates are added to it here.
pub fn flows(system: &System, now: &TimeData, yp: &[f64], w: &mut Workspace<f64>, out: &mut [f64]) {
    out.fill(0.0);
    add_rates(system, now, yp, w);
    let curvature_rate = fluid::rates(system, w, out);
    add_all(out, solid::flows(system, now, curvature_rate, w));
    fluid::flows(system, now, w, out);
    ports::rates(system, now, w, out);
}

/// What balances and samples need and no equation does: rates of strain, means, motion along where it has no unknowns.
/// The workspace must hold [`residual::evaluate`] of the same state.
pub fn complete<'w>(system: &System, now: &TimeData, yp: &[f64], w: &'w mut Workspace<f64>) -> State<'w> {
    add_rates(system, now, yp, w);
    readings::read(system, now, w);
    State(w)
}

/// The same of a workspace that [`flows`] has left and nobody has touched since: what is read off is all that is missing.
pub fn complete_after_flows<'w>(system: &System, now: &TimeData, w: &'w mut Workspace<f64>) -> State<'w> {
    readings::read(system, now, w);
    State(w)
}

/// What balances need: all of [`complete`] but what is read off.
fn add_rates(system: &System, now: &TimeData, yp: &[f64], w: &mut Workspace<f64>) {
    residual::complete(system, now, yp, w);
    fluid::complete(system, now, yp, w);
    if !system.model.effects.has(Effect::AxialStretch) {
        fluid::foreshorten(system, now, w);
    }
}

/// Energies of a state.
pub fn energies(system: &System, now: &TimeData, w: State) -> Energies {
    let mut e = solid::energies(system, now, &w);
    e.bladders = stored::energy(system, &w);
    let [walls, held] = stored::in_vessels(system, &w);
    e.compression = compressed::energy(system, &w) + held;
    e.accumulators = walls;
    e.tubes = tubes::kinetic(system, &w);
    e.contacts = touching::energy(system, &w);
    e.springs = system
        .attached
        .iter()
        .map(|attached| attached.energy(system, now, &w))
        .sum();
    e.relaxing = residual::relaxation::energy_and_loss(system, now, &w)[0];
    e.section = residual::nonlinear::energy(system, &w);
    e.around = (0..system.mesh.nodes)
        .map(|i| system.lengths[i] * residual::around::kinetic(system, now, &w, i))
        .sum();
    e
}

/// Invariants of a state.
pub fn invariants(system: &System, now: &TimeData, w: State) -> Invariants {
    let (momentum, angular_momentum) = solid::momenta(system, now, &w);
    Invariants {
        momentum: [momentum.x, momentum.z],
        angular_momentum,
        volumes: stored::volumes(system, &w),
    }
}

/// Adds to all flows.
fn add_all(out: &mut [f64], rates: Rates) {
    for (out, rate) in out.iter_mut().zip(rates) {
        *out += rate;
    }
}

/// Adds `value` to a flow.
fn add(out: &mut [f64], flow: EnergyRate, value: f64) {
    out[flow as usize] += value;
}
