//! Flow along a bladder beyond the resistance of creeping flow.

use super::tube::FlowLaw;
use super::unsteady_friction::Ladder;
use crate::case::schema::{Bladders, CrossSection, Effect, Fluid};
use crate::model::{EffectSet, duct};

/// `[E74]` Momentum along a bladder with the area `A_0` at rest, over the length Δs between the centers of two cells. β
/// and r are those of its cross-section, [E73], the ladder is [E72]:
///
/// ```text
/// I dq/dt + Σ_i r_i (q - j_i) + (μ Δs/q1b) q = p_a - p_b        I = ρ Δs/A_0, without the branches β of it
/// ```
///
/// The half cell at a bladder's end adds its part to the flow in the link there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AlongBladder {
    /// `ρ/A_0` [kg/m^5].
    inertance: f64,
    /// β.
    momentum: f64,
    /// Unsteady friction for a length of 1 m.
    memory: Option<Ladder>,
    /// `ν/r²` [1/s].
    pub viscous_rate: f64,
}

impl AlongBladder {
    /// Law for the bladders of a case, with all effects; none for massless fluid.
    pub(in crate::model) fn new(bladders: &Bladders, fluid: &Fluid) -> Option<Self> {
        let (density, viscosity) = (fluid.density_kg_m3, fluid.viscosity_pa_s);
        let section = bladders.cross_section.clone().unwrap_or(CrossSection::Rectangle {
            height_m: bladders.height_m,
            width_m: bladders.width_m,
        });
        let area = bladders.height_m * bladders.width_m;
        let momentum = duct::momentum_factor(&section);
        let radius = duct::hydraulic_radius(&section);
        let viscous_rate = viscosity / (density * radius * radius);
        let laminar = 8.0 * viscosity / (area * radius * radius);
        (density > 0.0).then(|| Self {
            inertance: density / area,
            momentum,
            memory: Some(Ladder::of_profile(momentum, laminar, viscous_rate)),
            viscous_rate,
        })
    }

    /// Applies the choice of effects; none without inertia along bladders.
    pub(in crate::model) fn reduced(mut self, effects: &EffectSet) -> Option<Self> {
        if !effects.has(Effect::UnsteadyFriction) {
            self.memory = None;
        }
        effects.has(Effect::BladderInertia).then_some(self)
    }

    /// Inertance of the steady profile [kg/m^5].
    pub fn steady_inertance(&self) -> f64 {
        self.momentum * self.inertance
    }

    /// Flow law for a length [m].
    pub fn over(&self, length: f64) -> FlowLaw {
        let inertance = match self.memory {
            Some(_) => self.inertance,
            None => self.steady_inertance(),
        };
        FlowLaw::of_bladder(length * inertance, self.memory.map(|ladder| ladder.over(length)))
    }
}
