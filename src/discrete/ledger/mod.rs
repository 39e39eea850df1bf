//! Energies, powers and impulses, exact in the semi-discrete system: the residual of their balance is the error of the
//! time integration alone.

pub mod beams;
mod compressed;
mod fluid;
mod jump;
pub mod ports;
mod reactions;
mod solid;
mod solid_state;
mod stored;
mod tubes;

pub use compressed::{area_rate, lumped_slopes, pressure_rate};
pub use fluid::pressure_rates;
pub use jump::{side, strokes, travel};
pub use reactions::compared;
pub use solid::reaction;

use crate::case::schema::Effect;
use serde::{Deserialize, Serialize};

use super::{CompleteState, System, TimeData, Workspace, beam_contacts, contact_points, readings, residual};

/// Rates that are integrated during a run, for the balances.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EnergyRate {
    /// Power of distributed loads and given end forces.
    Loads,
    /// Power of driven ends and end moments.
    Ends,
    /// Power of ports and pumps.
    Ports,
    /// Dissipation in the bladders.
    Bladders,
    /// Dissipation in the tubes.
    Tubes,
    /// Power harvested by the turbines.
    Turbines,
    /// Dissipation in check valves, of rectifiers and in tubes.
    Rectifiers,
    /// Dissipation by material damping and drag.
    Damping,
    /// Power added by the published form of the momentum balance.
    Formulation,
    /// Power added by a coupling without reciprocity.
    Reciprocity,
    /// External force in x (its integral is the impulse).
    ImpulseX,
    /// External force in z.
    ImpulseZ,
    /// External torque about the origin.
    AngularImpulse,
}

/// All rates, in the order of their storage. They are followed by outflow and throughput of every open network, then for each network by
/// the outflow according to the ports' law and its noise level, then by the inflow of each port, then by the rates of each beam of a
/// structure.
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

/// One value for each rate.
type Rates = [f64; ENERGY_RATES.len()];

impl EnergyRate {
    /// Sign of the rate in the energy balance; 0 for impulses.
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
pub struct StoredEnergies {
    /// `Σ h_i m |v_i|²/2`.
    pub kinetic: f64,
    /// Rotary energy of the sections.
    pub rotary: f64,
    /// `Σ h N²/2EA`.
    pub axial: f64,
    /// `Σ h_i M²/2EI`.
    pub bending: f64,
    /// Energy stored in the bladders.
    pub bladders: f64,
    /// Kinetic energy of the fluid in tubes and along bladders.
    #[serde(default)]
    pub tubes: f64,
    /// Energy of the section at finite strain, beyond its quadratic part.
    #[serde(default)]
    pub section: f64,
    /// Energy of the relaxing parts of the section forces.
    #[serde(default)]
    pub relaxing: f64,
    /// Energy of the compressed fluid.
    #[serde(default)]
    pub compression: f64,
    /// Energy in accumulators.
    #[serde(default)]
    pub accumulators: f64,
    /// Energy stored in walls in contact.
    #[serde(default)]
    pub contacts: f64,
    /// Energy of springs to ground and in joints.
    #[serde(default)]
    pub springs: f64,
    /// Kinetic energy of the surrounding fluid.
    #[serde(default)]
    pub around: f64,
}

impl StoredEnergies {
    /// Total energy.
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

/// Momentum, angular momentum and stored volumes: the other conserved quantities.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Invariants {
    /// `Σ h_i m v` in x and z [kg m/s].
    pub momentum: [f64; 2],
    /// Angular momentum about the origin, positive in the direction of growing phi [kg m^2/s].
    pub angular_momentum: f64,
    /// Volume change stored in each component of the network [m^3].
    pub volumes: Vec<f64>,
}

/// Energy balance at an instant.
#[derive(Clone, Copy, Debug, Default)]
pub struct EnergyBalance {
    /// Energy stored now.
    pub stored: StoredEnergies,
    /// Residual [J].
    pub residual: f64,
}

/// Computes the present energy minus that at the start minus all work and losses (`integrals` of [`ENERGY_RATES`]).
pub fn balance(stored: StoredEnergies, at_start: f64, integrals: &[f64]) -> EnergyBalance {
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
    beams::first(system) + beams::count(system)
}

/// Outflow of the `open`-th open network through its ports, and the volume that has passed them in either direction
/// [m^3].
pub fn passed(integrals: &[f64], open: usize) -> (f64, f64) {
    (
        integrals[ENERGY_RATES.len() + 2 * open],
        integrals[ENERGY_RATES.len() + 2 * open + 1],
    )
}

/// Outflow of the `open`-th of `count` open networks according to the law of its ports, and the reference volume of conductances times
/// pressures [m^3]. A fraction of the latter, the rounding error of pressures, is noise.
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
/// The workspace must contain [`residual::evaluate`] of the same state; rates are added to it here.
pub fn flows(system: &System, now: &TimeData, yp: &[f64], w: &mut Workspace<f64>, out: &mut [f64]) {
    out.fill(0.0);
    add_rates(system, now, yp, w);
    let curvature_rate = fluid::rates(system, w, out);
    solid::flows(system, now, curvature_rate, w, out);
    fluid::flows(system, now, w, out);
    ports::rates(system, now, w, out);
}

/// Completes a workspace with quantities that balances and samples need, but no equation: rates of strain, means, and
/// axial motion without unknowns. The workspace must contain [`residual::evaluate`] of the same state.
pub fn complete<'w>(system: &System, now: &TimeData, yp: &[f64], w: &'w mut Workspace<f64>) -> CompleteState<'w> {
    add_rates(system, now, yp, w);
    readings::read(system, now, w);
    CompleteState(w)
}

/// Completes a workspace directly after [`flows`]: only output values are missing.
pub fn complete_after_flows<'w>(system: &System, now: &TimeData, w: &'w mut Workspace<f64>) -> CompleteState<'w> {
    readings::read(system, now, w);
    CompleteState(w)
}

/// Adds the quantities for balances: everything in [`complete`] except output values.
fn add_rates(system: &System, now: &TimeData, yp: &[f64], w: &mut Workspace<f64>) {
    residual::complete(system, now, yp, w);
    fluid::complete(system, now, yp, w);
    if !system.model.effects.has(Effect::AxialStretch) {
        fluid::foreshorten(system, now, w);
    }
}

/// Stored energies of a state.
pub fn energies(system: &System, now: &TimeData, w: CompleteState) -> StoredEnergies {
    let mut e = solid_state::energies(system, now, &w);
    e.bladders = stored::energy(system, &w);
    let [walls, held] = stored::in_vessels(system, &w);
    e.compression = compressed::energy(system, &w) + held;
    e.accumulators = walls;
    e.tubes = tubes::kinetic(system, &w);
    e.contacts = contact_points::energy(system, &w) + beam_contacts::energy(system, &w);
    e.springs = system
        .attached
        .iter()
        .map(|attached| attached.energy(system, now, &w))
        .sum();
    e.springs += system.joints.energies(now, &w)[0];
    let in_bed = system.foundation.iter().zip(&w.motion.u);
    e.springs += in_bed
        .map(|([x, z], u)| 0.5 * (x * u.x * u.x + z * u.z * u.z))
        .sum::<f64>();
    let each = system.mesh.beams.iter();
    e.relaxing = each
        .map(|beam| residual::relaxation::energy_and_loss(system, now, &w, beam)[0])
        .sum();
    e.section = residual::nonlinear::energy(system, &w);
    e.around = (0..system.mesh.nodes)
        .map(|i| system.lengths[i] * residual::ambient_fluid::kinetic(system, now, &w, i))
        .sum();
    e
}

/// Conserved quantities of a state.
pub fn invariants(system: &System, now: &TimeData, w: CompleteState) -> Invariants {
    let (momentum, angular_momentum) = solid_state::momenta(system, now, &w);
    Invariants {
        momentum: [momentum.x, momentum.z],
        angular_momentum,
        volumes: stored::volumes(system, &w),
    }
}

/// Adds to all rates.
fn add_all(out: &mut [f64], rates: Rates) {
    for (out, rate) in out.iter_mut().zip(rates) {
        *out += rate;
    }
}

/// Adds `value` to one rate.
fn add(out: &mut [f64], flow: EnergyRate, value: f64) {
    out[flow as usize] += value;
}
