//! Ledgers of the beams of a structure.

use super::fluid::SegmentRates;
use super::{EnergyRate, Rates, StoredEnergies, ports, solid, solid_state};
use crate::discrete::residual::relaxation;
use crate::discrete::{System, TimeData, Workspace};

/// Powers that a beam takes from its surroundings, and what it loses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BeamRate {
    /// Power of loads, driven ends, springs and contacts.
    Work,
    /// Power of its joints.
    Joints,
    /// Power of the pressures of its bladders.
    Fluid,
    /// Dissipation by material damping, drag, dashpots and contacts.
    Loss,
}

/// Number of rates of a beam.
const RATES: usize = 4;

/// Number of rates of all beams of a structure; 0 for a single beam.
pub fn count(system: &System) -> usize {
    match system.model.structure {
        Some(_) => RATES * system.mesh.beams.len(),
        None => 0,
    }
}

/// Index of the first rate of the first beam among the integrals.
pub fn first(system: &System) -> usize {
    let wet = system.model.wet.as_ref();
    wet.map_or(super::ENERGY_RATES.len(), |wet| ports::first(wet) + ports::count(wet))
}

/// Index of a rate among the integrals, of the beam with this number on the mesh.
pub fn index(system: &System, beam: usize, rate: BeamRate) -> usize {
    first(system) + RATES * beam + rate as usize
}

/// `[E108]` Sets the rates of the ledger of a beam, from the `rates` of all its nodes and cells and the power `held` of springs and contacts:
///
/// ```text
/// d/dt (T + U) = P_work + P_joints + P_fluid - D      P_fluid = -l_seg Σ_j (Nbar λ_p,t + Mbar α_p,t)
/// P_joints = Σ_e (f_e·v_e + c_e φ_t)      f_e and c_e what the balances of the joined end e lack without its joint
/// ```
pub fn put(
    (system, now, w): (&System, &TimeData, &Workspace<f64>),
    beam: usize,
    rates: &Rates,
    held: f64,
    out: &mut [f64],
) {
    let mut set = |rate: BeamRate, value: f64| out[index(system, beam, rate)] = value;
    let of = |rate: EnergyRate| rates[rate as usize];
    let nodes = &system.mesh.beams[beam].nodes;
    let turning = system.attached.iter().filter(|attached| nodes.contains(&attached.node));
    let turning: f64 = turning.map(|attached| attached.turning_power(system, now, w)).sum();
    set(
        BeamRate::Work,
        of(EnergyRate::Loads) + of(EnergyRate::Ends) + held + turning,
    );
    let ends = [2 * beam, 2 * beam + 1];
    set(
        BeamRate::Joints,
        ends.map(|end| power_on_end(system, now, w, end)).iter().sum(),
    );
    set(BeamRate::Fluid, fluid_power(system, w, beam));
    set(BeamRate::Loss, of(EnergyRate::Damping));
}

/// Power of the pressures of its bladders on a beam [W].
fn fluid_power(system: &System, w: &Workspace<f64>, beam: usize) -> f64 {
    let Some(wet) = system.model.wet.as_ref().filter(|wet| wet.per_row > 0) else {
        return 0.0;
    };
    let of = |j: usize| {
        let segment = SegmentRates::new(system, wet, w, j);
        let (stretch, curvature) = segment.strain_rates(wet.strains_of(j));
        -system.mesh.segment_lengths[j] * (segment.force * stretch + segment.moment * curvature)
    };
    system.mesh.beams[beam].segments.clone().map(of).sum()
}

/// Removes the dissipation of beams from the rates of a jump, which takes no time.
pub fn lose_nothing(system: &System, out: &mut [f64]) {
    for beam in 0..count(system) / RATES {
        out[index(system, beam, BeamRate::Loss)] = 0.0;
    }
}

/// Power that a joint takes: that of springs, dampers and the rotation of its body. Ends that share their motion take none, [E105] [W].
pub fn power_of_joint(system: &System, now: &TimeData, w: &Workspace<f64>, number: usize) -> f64 {
    let joints = &system.joints;
    let hinges = joints.hinges.iter().filter(|hinge| hinge.joint == number);
    let hinges = hinges.map(|hinge| hinge.power(now, w));
    let elastic = joints.elastic.iter().filter(|one| one.joint == number);
    let elastic = elastic.map(|one| one.power(w));
    let turning = &w.shape.joints;
    let bodies = joints.angles.iter().zip(turning.rate.iter().zip(&turning.acceleration));
    let bodies = bodies.filter(|(angle, _)| angle.joint == number);
    let bodies = bodies.map(|(angle, (rate, acceleration))| angle.inertia * rate * acceleration);
    hinges.chain(elastic).chain(bodies).fold(0.0, |all, one| all + one)
}

/// Power of its joint on an end [W]; 0 without a joint.
fn power_on_end(system: &System, now: &TimeData, w: &Workspace<f64>, end: usize) -> f64 {
    if !system.joints.holds(end) {
        return 0.0;
    }
    let place = system.mesh.beams[end / 2].ends()[end % 2];
    let by_force = solid::reaction(system, now, w, place.node).dot(w.motion.v[place.node]);
    let angle = system.joints.angle_of(end);
    let rate = angle.map_or(0.0, |angle| w.shape.joints.rate[angle]);
    by_force - place.outward * system.total_moment(w, place.node) * rate
}

/// Energies of the beam with this number on the mesh.
pub fn energies(system: &System, now: &TimeData, w: &Workspace<f64>, beam: usize) -> StoredEnergies {
    let own = &system.mesh.beams[beam];
    let mut e = solid_state::energies_between(system, now, w, own.nodes.clone(), own.cells.clone());
    e.relaxing = relaxation::energy_and_loss(system, now, w, own)[0];
    for body in system.bodies.iter().filter(|body| own.nodes.contains(&body.node)) {
        let [kinetic, rotary] = body.energies(system, w);
        e.kinetic += kinetic;
        e.rotary += rotary;
    }
    e
}
