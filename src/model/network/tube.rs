//! Flow in a round tube beyond creeping flow: inertia, unsteady friction, turbulence, losses.

use std::f64::consts::PI;
use std::ops::Range;

use super::unsteady_friction::{BRANCHES, Ladder};
use super::{Link, LinkKind, ResolvedNetwork};
use crate::case::schema::{Effect, Fluid};
use crate::case::wiring::WiringTube;
use crate::model::{EffectSet, duct};
use crate::numerics::Scalar;

/// Momentum factor of Poiseuille's profile: its inertance over that of plug flow.
const PARABOLIC: f64 = 4.0 / 3.0;

/// Reynolds number below which Churchill's factor equals the laminar one to machine precision.
const LAMINAR: f64 = 100.0;

/// Reynolds number below which losses are smoothed through zero flow.
const SLOW: f64 = 1e-3;

/// `[E51]` Flow q of a round tube of radius r and area `A = π r²`, in series with a valve of opening o; R as in `[E6]`,
/// `R_0 = 8 μ l/(π r⁴)`:
///
/// ```text
/// o [I dq/dt + Σ_i r_i (q - j_i) + Δp_loss(q) + R_half q - (p_a - p_b)] + R q = 0
/// dj_i/dt = n_i (ν/r²) (q - j_i)        r_i = R_0 m_i/2
/// I = ρ l/A, without the branches 4/3 of it: the inertance of Poiseuille's profile
/// ```
///
/// The branches model unsteady laminar friction (Zielke 1968). Each is a resistance in parallel to an inertance
/// `r_i r²/(n_i ν)`. This passive network stores `I q²/2 + Σ r_i r² j_i²/(2 n_i ν)` and dissipates
/// `(R/o) q² + q Δp_loss + Σ r_i (q - j_i)²`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TubeFlow {
    /// `A l` [m^3].
    pub volume: f64,
    /// `ν/r²` [1/s].
    pub viscous_rate: f64,
    /// Flow law.
    pub law: FlowLaw,
}

/// Flow law beyond resistance: of a tube, of a part of a bladder, or of both in series.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FlowLaw {
    /// `I` [kg/m^4]; 0 without inertia.
    pub inertance: f64,
    /// Unsteady friction in the tube.
    pub in_tube: Option<Ladder>,
    /// Unsteady friction in bladders.
    pub in_bladders: Option<Ladder>,
    losses: Option<Losses>,
}

/// `[E52]` Losses beyond laminar friction, D = 2 r, roughness e, `Re = ρ |v| D/μ`:
///
/// ```text
/// Δp_loss = (f - 64/Re) (l/D) ρ v |v|/2 + K ρ v |v|/2        |v| -> √(v² + v_s²) - v_s in K's part, v_s that of Re = 10^-3
/// f = 8 [(8/Re)^12 + (a + b)^(-3/2)]^(1/12)      a = (2.457 ln(1/((7/Re)^0.9 + 0.27 e/D)))^16      b = (37530/Re)^16
/// ```
///
/// Churchill, Chem. Eng. 84 (1977) 91. K includes both ends, bends and orifices.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Losses {
    /// Reynolds number over flow [s/m^3].
    reynolds_per_flow: f64,
    /// `8 μ l/(π r⁴)` [Pa s/m^3].
    laminar: f64,
    /// `K ρ/(2 A²)` [kg/m^7].
    local: f64,
    /// `e/D`.
    roughness: f64,
}

/// Churchill's friction factor over the laminar one, `f Re/64`, and its derivative by Re, for `Re >= 0`.
pub fn friction_ratio(reynolds: f64, roughness: f64) -> (f64, f64) {
    if reynolds < LAMINAR {
        return (1.0, 0.0);
    }
    let smooth = (7.0 / reynolds).powf(0.9);
    let inside = smooth + 0.27 * roughness;
    let logarithm = -inside.ln();
    let a = (2.457 * logarithm).powi(16);
    let b = (37530.0 / reynolds).powi(16);
    let a_slope = 16.0 * a / logarithm * (0.9 * smooth / (reynolds * inside));
    let b_slope = -16.0 * b / reynolds;
    let eighth = (reynolds / 8.0).powi(12);
    let turbulent = eighth * (a + b).powf(-1.5);
    let slope = turbulent * (12.0 / reynolds - 1.5 * (a_slope + b_slope) / (a + b));
    let ratio = (1.0 + turbulent).powf(1.0 / 12.0);
    (ratio, ratio / (12.0 * (1.0 + turbulent)) * slope)
}

impl TubeFlow {
    /// Law of a tube with its radius [m], with all effects.
    pub(super) fn new(tube: &WiringTube, radius: f64, fluid: &Fluid) -> Self {
        let (density, viscosity) = (fluid.density_kg_m3, fluid.viscosity_pa_s);
        let area = PI * radius * radius;
        let laminar = viscosity * tube.length_m / duct::circle(radius);
        let viscous_rate = viscosity / (density * radius * radius);
        Self {
            volume: area * tube.length_m,
            viscous_rate,
            law: FlowLaw {
                inertance: density * tube.length_m / area,
                in_tube: Some(Ladder::round(laminar, viscous_rate)),
                in_bladders: None,
                losses: Some(Losses {
                    reynolds_per_flow: 2.0 * density / (PI * viscosity * radius),
                    laminar,
                    local: 0.5 * tube.loss_coefficient * density / (area * area),
                    roughness: 0.5 * tube.roughness_m / radius,
                }),
            },
        }
    }

    /// Applies the choice of effects; none for creeping flow.
    pub(in crate::model) fn reduced(mut self, effects: &EffectSet) -> Option<Self> {
        let has = |effect| effects.has(effect);
        let (inertia, losses) = (has(Effect::TubeInertia), has(Effect::TubeLosses));
        if !has(Effect::UnsteadyFriction) {
            self.law.in_tube = None;
            self.law.inertance = self.steady_inertance();
        }
        if !inertia {
            self.law.inertance = 0.0;
        }
        self.law.losses = self.law.losses.filter(|_| losses);
        (inertia || losses).then_some(self)
    }

    /// Inertance of Poiseuille's profile [kg/m^4], for a tube with all effects.
    pub fn steady_inertance(&self) -> f64 {
        PARABOLIC * self.law.inertance
    }
}

impl FlowLaw {
    /// Law of a part of a bladder with inertance [kg/m^4].
    pub(super) fn of_bladder(inertance: f64, memory: Option<Ladder>) -> Self {
        Self {
            inertance,
            in_bladders: memory,
            ..Self::default()
        }
    }

    /// This law in series with a part of a bladder.
    pub fn behind(self, part: &Self) -> Self {
        Self {
            inertance: self.inertance + part.inertance,
            in_bladders: part.in_bladders,
            ..self
        }
    }

    /// Derivative of the pressure drop by inertia and unsteady friction with respect to flow in an implicit step,
    /// `I c_j + Σ r_i c_j/(c_j + n_i ν/r²)` [Pa s/m^3].
    pub fn resistance_along_a_step(&self, cj: f64) -> f64 {
        let memory = |(resistance, rate): (f64, f64)| resistance * cj / (cj + rate);
        self.inertance * cj + self.branches().map(memory).sum::<f64>()
    }

    /// Resistances `r_i` [Pa s/m^3] and rates `n_i ν/r²` [1/s] of all branches, those of the tube first.
    pub fn branches(&self) -> impl Iterator<Item = (f64, f64)> {
        self.ladders(0)
            .into_iter()
            .flatten()
            .flat_map(|(_, ladder)| ladder.branches())
    }

    /// Ladders of tube and bladders with the index ranges of their branches, the first of which has the index `first`.
    /// Residuals iterate over branches by ladder.
    #[inline]
    pub fn ladders(&self, first: usize) -> [Option<(Range<usize>, Ladder)>; 2] {
        let behind = first + self.in_tube.map_or(0, |_| BRANCHES);
        let own = |ladder: Option<Ladder>, at| ladder.map(|ladder| (at..at + BRANCHES, ladder));
        [own(self.in_tube, first), own(self.in_bladders, behind)]
    }

    /// `Δp_loss(q)` [Pa].
    #[inline]
    pub fn loss<T: Scalar>(&self, flow: T) -> T {
        let Some(losses) = &self.losses else { return T::zero() };
        flow.lift(|q| losses.at(q))
    }
}

impl Losses {
    /// Loss [Pa] and its derivative at a flow.
    fn at(&self, q: f64) -> (f64, f64) {
        let (ratio, slope) = friction_ratio(self.reynolds_per_flow * q.abs(), self.roughness);
        let slow = SLOW / self.reynolds_per_flow;
        let root = (q * q + slow * slow).sqrt();
        let friction = self.laminar * (ratio - 1.0);
        let value = q * (friction + self.local * (root - slow));
        let steeper = self.laminar * slope * self.reynolds_per_flow * q.abs();
        (value, friction + steeper + self.local * (root - slow + q * q / root))
    }
}

impl ResolvedNetwork {
    /// Index of a link among the tubes.
    pub fn tube(&self, link: usize) -> usize {
        let tubes = self.links[..link].iter().filter(|l| l.kind == LinkKind::Tube);
        tubes.count()
    }

    /// [`Self::tube`] of every link; a link that is no tube has the index of the next tube.
    pub fn tube_numbers(&self) -> Vec<usize> {
        let count = |before: &mut usize, link: &Link| {
            let number = *before;
            *before += usize::from(link.kind == LinkKind::Tube);
            Some(number)
        };
        self.links.iter().scan(0, count).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Goal: the derivative for Newton's iteration is that of the loss, in all regimes.
    #[test]
    fn slopes_of_losses_are_their_derivatives() {
        let losses = Losses {
            reynolds_per_flow: 2e9,
            laminar: 1e9,
            local: 1e15,
            roughness: 1e-3,
        };
        for reynolds in [1e-4, 1e-2, 1.0, 99.0, 101.0, 1e3, 2.2e3, 3e3, 1e4, 1e6] {
            let q = -reynolds / losses.reynolds_per_flow;
            let h = 1e-5 * q;
            let difference = (losses.at(q + h).0 - losses.at(q - h).0) / (2.0 * h);
            let (_, slope) = losses.at(q);
            assert!(
                (slope / difference - 1.0).abs() < 1e-6,
                "Re {reynolds}: {slope:e} {difference:e}"
            );
        }
    }
}
