//! Normal forces of an inextensible beam, by statics from the free end.

use super::System;
use super::time_data::Frame;
use crate::case::Translation;
use crate::case::schema::Effect;
use crate::functions::signals::{Jet, SmoothTime};
use crate::model::loads::LoadKind;

/// `[E28]` Without axial stretch (EA → ∞) a beam with one held and one free end has the axial motion
///
/// ```text
/// u3' = λ_p - g u1'²/2      u3 = U at the end that is held
/// ```
///
/// without an unknown for it. Its normal force is the sum of the loads beyond a section and of the inertia and drag of
/// the mass beyond it, a function of time alone:
///
/// ```text
/// N_c = Σ_{i beyond c} [F_i + h_i (b_z,i - c U' - m U'')]
/// ```
///
/// It acts on bending, `n_x = g N φ - V`, and on areas, `A_N(Nbar)`. The energy balance is that of `[E27]` with this u3 and without
/// `Σ h N²/2EA`. The reason: `Σ h N u3'_t` is the work of the same loads, of the held end, and of `-m U''` on u3, which consists of the
/// shortening by bending and the stretch by pressure.
#[derive(Clone, Debug, Default)]
pub struct Statics {
    /// `N` of each cell [N].
    pub force: Vec<f64>,
    /// `dN/dt` of each cell [N/s].
    pub rate: Vec<f64>,
    /// `Nbar` of each segment [N].
    pub mean: Vec<f64>,
    /// `dNbar/dt` of each segment [N/s].
    pub mean_rate: Vec<f64>,
    /// Force on each node [N], and its rate [N/s].
    nodes: Vec<(f64, f64)>,
}

impl Statics {
    /// Allocates the forces of a system.
    pub fn new(system: &System) -> Self {
        if system.model.effects.has(Effect::AxialStretch) {
            return Self::default();
        }
        let (cells, segments) = (system.mesh.cells, system.mesh.segments);
        Self {
            force: vec![0.0; cells],
            rate: vec![0.0; cells],
            mean: vec![0.0; segments],
            mean_rate: vec![0.0; segments],
            nodes: vec![(0.0, 0.0); cells + 1],
        }
    }

    /// Evaluates the forces at `clock`, with the motion of the held end.
    pub fn update(&mut self, system: &System, frame: Option<Frame>, clock: SmoothTime) {
        if system.model.effects.has(Effect::AxialStretch) {
            return;
        }
        self.load(system, frame.map_or(Jet::default(), |frame| frame.at(0.0)), clock);
        let root_held = matches!(system.model.ends[0].axial, Translation::Displacement(_));
        let last = system.mesh.cells;
        let mut beyond = (0.0, 0.0);
        for k in 0..last {
            // Starts with the section next to the free end; the outward direction is that of the tip or of the root.
            let (node, cell, outward) = if root_held {
                (last - k, last - 1 - k, 1.0)
            } else {
                (k, k, -1.0)
            };
            beyond.0 += self.nodes[node].0;
            beyond.1 += self.nodes[node].1;
            (self.force[cell], self.rate[cell]) = (outward * beyond.0, outward * beyond.1);
        }
        let k = system.mesh.cells_per_segment;
        let share = 1.0 / k as f64;
        for j in 0..system.mesh.segments {
            self.mean[j] = share * self.force[j * k..(j + 1) * k].iter().sum::<f64>();
            self.mean_rate[j] = share * self.rate[j * k..(j + 1) * k].iter().sum::<f64>();
        }
    }

    /// Computes the forces on nodes: loads, drag, ends, and inertia of the prescribed motion.
    fn load(&mut self, system: &System, held: Jet, clock: SmoothTime) {
        let (section, mesh) = (&system.model.section, &system.mesh);
        for (i, node) in self.nodes.iter_mut().enumerate() {
            let mass = if system.layout.inertia { system.masses[i] } else { 0.0 };
            let drag = system.lengths[i] * section.drag;
            *node = (
                -mass * held.acceleration - drag * held.rate,
                -mass * held.jerk - drag * held.acceleration,
            );
        }
        for load in system.loads.iter().filter(|load| load.kind == LoadKind::ForceZ) {
            let factor = load.signal.jet(clock);
            for ((i, node), shape) in self.nodes.iter_mut().enumerate().skip(load.first).zip(&load.shape) {
                let size = mesh.node_lengths[i] * shape;
                node.0 += size * factor.value;
                node.1 += size * factor.rate;
            }
        }
        for attached in &system.attached {
            let forces = &system.model.attachments[attached.number].forces;
            for given in forces.iter().filter(|given| given.axis == 1) {
                let force = given.signal.jet(clock).scaled(given.factor);
                for (node, weight) in self.nodes[attached.node..].iter_mut().zip(attached.weights) {
                    node.0 += weight * force.value;
                    node.1 += weight * force.rate;
                }
            }
        }
        let last = mesh.nodes - 1;
        for (end, node, outward) in [(&system.model.ends[0], 0, -1.0), (&system.model.ends[1], last, 1.0)] {
            let mut force = Jet::default();
            if let Translation::Force(dead) = &end.axial {
                force = force + dead.jet(clock);
            }
            if let Some(follower) = &end.follower {
                force = force + follower.normal.jet(clock).scaled(outward);
            }
            self.nodes[node].0 += force.value;
            self.nodes[node].1 += force.rate;
        }
    }
}
