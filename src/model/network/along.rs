//! What flow along a bladder needs beyond the resistance of creeping flow.

use super::ladder::Ladder;
use super::tube::FlowLaw;
use crate::case::schema::{Bladders, CrossSection, Effect, Fluid};
use crate::model::{EffectSet, duct};

/// `[E74]` Momentum along a bladder of rest area `A_0`, over the length Δs between two cells' middles, β and r of its cross-section, [E73], and its ladder, [E72]:
///
/// ```text
/// I dq/dt + Σ_i r_i (q - j_i) + (μ Δs/q1b) q = p_a - p_b        I = ρ Δs/A_0, without the branches β of it
/// ```
///
/// The half cell at an end of a bladder adds its part to the flow of what is joined there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AlongBladder {
    /// `ρ/A_0` [kg/m^5].
    inertance: f64,
    /// β.
    momentum: f64,
    /// Memory of friction in a length of 1 m.
    memory: Option<Ladder>,
    /// `ν/r²` [1/s].
    pub viscous_rate: f64,
}

impl AlongBladder {
    /// Of the bladders of a case, everything included; none where the fluid has no mass.
    pub(super) fn new(bladders: &Bladders, fluid: &Fluid) -> Option<Self> {
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

    /// What effects leave of it.
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

    /// Along a length [m].
    pub fn over(&self, length: f64) -> FlowLaw {
        let inertance = match self.memory {
            Some(_) => self.inertance,
            None => self.steady_inertance(),
        };
        FlowLaw::of_bladder(length * inertance, self.memory.map(|ladder| ladder.over(length)))
    }
}
