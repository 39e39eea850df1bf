//! All effects that the program knows: what each adds, what it brings with it, what decides, what it costs.

use crate::case::schema::{Case, Effect, Load};
use crate::model::Network;

/// An effect: what is to be known of it before it is decided, in words and otherwise.
#[derive(Clone, Copy, Debug)]
pub struct About {
    /// What it adds physically, as an equation.
    pub adds: &'static str,
    /// Unknowns and terms that come with it.
    pub brings: &'static str,
    /// The number that decides: small where the effect may be left out.
    pub number: &'static str,
    /// What it costs.
    pub cost: &'static str,
    /// Other effects without which it has no meaning.
    pub needs: &'static [Effect],
    /// How it comes to be there.
    pub presence: Presence,
}

/// How an effect comes to be there.
#[derive(Clone, Copy, Debug)]
pub enum Presence {
    /// A case or the program chooses.
    Chosen,
    /// Where the case gives it, and only there: whether a case does, with the network of its bladders where they hold fluid.
    Given(fn(&Case, Option<&Network>) -> bool),
}

fn gravity(load: &Load) -> bool {
    matches!(load, Load::Gravity { .. })
}

/// What is to be known of an effect.
pub fn about(effect: Effect) -> About {
    use Effect::*;
    match effect {
        Effect::TransverseMotion => About {
            adds: "x = u1, φ, κ, M = EI (κ - α_p), V = -M'/λ; without it a bar, N = EA (u3' - λ_p)",
            brings: "u1, v1 of every node; mean moments; turning, curvature, moments, shear",
            number: "0 where nothing moves or loads the beam across and p_u = p_d",
            cost: "half the unknowns of the solid, most of its arithmetic",
            needs: &[],
            presence: Presence::Chosen,
        },
        Effect::FiniteRotation => About {
            adds: "x' = λ sin φ, z' = λ cos φ; without it e = u3' + u1'²/2, φ = u1'",
            brings: "roots and arcs in every cell, neighbours of u3 in the rows of u1 and the other way round",
            number: "φ², the square of the largest angle",
            cost: "most of the arithmetic of the solid",
            needs: &[TransverseMotion],
            presence: Presence::Chosen,
        },
        Effect::AxialForceOnBending => About {
            adds: "N u1' in n_x, u1'²/2 in e",
            brings: "geometric stiffness: buckling, tension, parametric excitation; without it bending and stretch are apart",
            number: "N l_s²/(π² EI), and (u1/h_s)² where both ends hold u3",
            cost: "entries that couple u1 and u3",
            needs: &[TransverseMotion],
            presence: Presence::Chosen,
        },
        Effect::AxialStretch => About {
            adds: "N = EA (e - λ_p); without it u3' = λ_p - g u1'²/2, N from statics",
            brings: "u3 and v3 of every node; mean forces",
            number: "N/EA: the stretch, and with inertia (f/f_axial)²",
            cost: "half the unknowns of the solid; axial waves",
            needs: &[],
            presence: Presence::Chosen,
        },
        Effect::Shear => About {
            adds: "V = kGA γ, γ the angle between a section's normal and the beam; without it V = -M'/λ",
            brings: "an angle of every cell; with rotary_inertia its rate",
            number: "EI k²/(kGA) (1 + r ω T/2), k and ω of the second bending mode, T the run, r the part that vibrates; kept where something acts suddenly",
            cost: "a third more unknowns of the solid; fast waves of sections that swing",
            needs: &[TransverseMotion],
            presence: Presence::Chosen,
        },
        Effect::SolidInertia => About {
            adds: "m a",
            brings: "v1, v3 of every node",
            number: "(ω/ω1)², ω1 the first bending frequency",
            cost: "half the unknowns of the solid; the waves that limit steps and orders",
            needs: &[],
            presence: Presence::Chosen,
        },
        Effect::AxialInertia => About {
            adds: "m u3_tt; without it m U'', U the motion of the driven ends",
            brings: "v3 of every node; axial waves",
            number: "(f/f_axial)², and (u1/l_s)² where the beam bends",
            cost: "a quarter of the unknowns of the solid; its fastest waves where the mesh is coarse",
            needs: &[SolidInertia, AxialStretch],
            presence: Presence::Chosen,
        },
        Effect::RotaryInertia => About {
            adds: "r = m y11 φ_tt/λ² in n = N e_t + V e_n + r d1",
            brings: "neighbouring accelerations coupled in every cell",
            number: "y11 k²/2 (1 + ω T), k and ω of the second bending mode, T the run; kept where something acts suddenly",
            cost: "arithmetic in every cell",
            needs: &[SolidInertia, TransverseMotion],
            presence: Presence::Chosen,
        },
        Effect::Fluid => About {
            adds: "da1/dt + dq/ds = 0, λ_p and α_p",
            brings: "areas, junction pressures, mean moments and forces",
            number: "2 EI φ_b l_b am²/a_p and 2 EA φ_b l_b an²/a_p: how much sealed bladders stiffen the beam",
            cost: "the unknowns of the fluid and its times",
            needs: &[],
            presence: Presence::Chosen,
        },
        Effect::Flow => About {
            adds: "q = g (p_a - p_b) between bladders; without it a1 = const, p = (a0 - R A_M - A_N)/a_p",
            brings: "an area for each cell of each bladder that is not sealed",
            number: "1/(ω τ), τ the slowest time of the network; by itself only where next to nothing leaks in the whole run",
            cost: "cells_per_bladder unknowns a bladder; the stiffness of the network",
            needs: &[Fluid],
            presence: Presence::Chosen,
        },
        Effect::NetworkPressureDifferences => About {
            adds: "p of its own in each bladder; without it one p for all that is joined, l_b Σ a1 = V",
            brings: "areas, junction pressures; without it one pressure for each closed network, none where a port gives it",
            number: "ω τ, τ the slowest time of the network",
            cost: "the unknowns and the stiffness of the network",
            needs: &[Fluid, Flow],
            presence: Presence::Chosen,
        },
        Effect::FlowAlongBladders => About {
            adds: "q = -(q1b/μ) dp/ds inside a bladder",
            brings: "cells_per_bladder areas in each bladder instead of one",
            number: "ω a_p l_b² μ/(π² q1b), or that of bladder_inertia, whichever is more",
            cost: "cells_per_bladder - 1 unknowns a bladder",
            needs: &[Fluid, Flow, NetworkPressureDifferences],
            presence: Presence::Chosen,
        },
        Effect::Compressibility => About {
            adds: "c = r(p) (A_0 + a1) - A_0 in place of a1, q = g (Ψ(p_a) - Ψ(p_b)), Ψ = ∫ r dp",
            brings: "stored gas; a root for the pressure of each cell",
            number: "A_0/K over a_p, with (1 + χ ω T) of vibrations whose stiffness is fluid to the part χ; at vessels and where tubes end its share of what stores, times the departure from rest at 1/√(I C); gas stays",
            cost: "arithmetic in every cell and link; an unknown stays one where tubes with inertia meet",
            needs: &[Fluid],
            presence: Presence::Chosen,
        },
        Effect::TubeInertia => About {
            adds: "I dq/dt, I = 4/3 ρ l/A in each tube",
            brings: "the flow of each tube; its pressure jumps no more with its flow",
            number: "ω I/R, ω of the fastest motion",
            cost: "an unknown a tube; waves of fluid against bladders",
            needs: &[Fluid, Flow, NetworkPressureDifferences],
            presence: Presence::Chosen,
        },
        Effect::BladderInertia => About {
            adds: "I dq/dt, I = β ρ Δs/A_0 between cells of a bladder and in the half cells at its ends",
            brings: "the flow of each face between cells",
            number: "(ω/ω_s)², ω_s the frequency of fluid that swings along a bladder; where flow passes through bladders ω β ρ l_b/(A_0 R) or that of a row of n bladders, n² (ω/ω_s)², whichever is less",
            cost: "cells_per_bladder - 1 unknowns a bladder; waves of fluid along bladders",
            needs: &[TubeInertia],
            presence: Presence::Chosen,
        },
        Effect::UnsteadyFriction => About {
            adds: "Σ r_i (q - j_i), dj_i/dt = n_i (ν/r²) (q - j_i); I = ρ l/A",
            brings: "ten states a tube, the memory of its friction; with bladder_inertia ten a face of a bladder, too",
            number: "Wo⁴/1152, Wo = r √(ω/ν); of bladders times their bladder_inertia",
            cost: "10 unknowns a tube and a face",
            needs: &[TubeInertia],
            presence: Presence::Chosen,
        },
        Effect::TubeLosses => About {
            adds: "(f - 64/Re) (l/D) ρ v²/2 + K ρ v²/2, f by Churchill",
            brings: "the flow of each tube, where it is no unknown yet; nonlinear friction",
            number: "Δp_loss/(R q) at the largest flow",
            cost: "an algebraic unknown a tube",
            needs: &[Fluid, Flow, NetworkPressureDifferences],
            presence: Presence::Chosen,
        },
        Effect::PressureToCurvature => About {
            adds: "α_p = φ_b l_b am (p_u - p_d), published φ_b ψ' (p_u - p_d)/E",
            brings: "a term in every moment",
            number: "α_p l_s over the slope without it",
            cost: "entries of pressure in the rows of bending",
            needs: &[Fluid, TransverseMotion],
            presence: Presence::Chosen,
        },
        Effect::PressureToStretch => About {
            adds: "λ_p = φ_b l_b A_N' (p_u + p_d), published φ_b ζ' (p_u + p_d)/E",
            brings: "a term in every normal force",
            number: "λ_p over the stretch without it",
            cost: "entries of pressure in the rows of stretch",
            needs: &[Fluid],
            presence: Presence::Chosen,
        },
        Effect::MomentToArea => About {
            adds: "R A_M(Mbar) in a1 = a_p p + R A_M + A_N",
            brings: "a mean moment a segment",
            number: "am Mbar/(a_p p)",
            cost: "an unknown a segment, with K + 1 entries",
            needs: &[Fluid, TransverseMotion],
            presence: Presence::Chosen,
        },
        Effect::ForceToArea => About {
            adds: "A_N(Nbar) in a1 = a_p p + R A_M + A_N",
            brings: "a mean force a segment",
            number: "an Nbar/(a_p p)",
            cost: "an unknown a segment, with K entries",
            needs: &[Fluid],
            presence: Presence::Chosen,
        },
        Effect::Asymmetry => About {
            adds: "-dm σ(M), -dn σ(N) in the areas",
            brings: "kinks",
            number: "dm/am, dn/an",
            cost: "square roots a segment; steps at the kinks",
            needs: &[Fluid],
            presence: Presence::Chosen,
        },
        Effect::NonlinearSection => About {
            adds: "Ω = Ω_2 + P(y): P_1 in N, P_2 in M, -∂P/∂p_R/(φ_b l_b) in the areas",
            brings: "a nonlinear area a bladder",
            number: "P over the quadratic energy at the scene's loads, bounded",
            cost: "a polynomial of degree 4 to 6 in every segment",
            needs: &[
                TransverseMotion,
                AxialStretch,
                Fluid,
                PressureToCurvature,
                PressureToStretch,
                MomentToArea,
                ForceToArea,
            ],
            presence: Presence::Chosen,
        },
        Effect::Damping => About {
            adds: "EA τ_a λ_t, EI τ_b κ_t, -c v",
            brings: "rates of strain",
            number: "the least damping ratio; present where given",
            cost: "arithmetic in every cell; saves steps",
            needs: &[],
            presence: Presence::Given(|case, _| {
                let damping = &case.beam.damping;
                damping.axial_time_s > 0.0 || damping.bending_time_s > 0.0 || damping.drag_n_s_m2 > 0.0
            }),
        },
        Effect::Viscoelasticity => About {
            adds: "EI Σ g_k (κ - κ_k), EA Σ g_k (ε - ε_k), dκ_k/dt = (κ - κ_k)/τ_k",
            brings: "a curvature a node and branch, a stretch a cell and branch",
            number: "present where given; what is decided by the scene's numbers stays then",
            cost: "as many unknowns; steps of its relaxation times",
            needs: &[],
            presence: Presence::Given(|case, _| case.beam.viscoelasticity.is_some()),
        },
        Effect::QuadraticDrag => About {
            adds: "b = -c₂ √(v_n²) v_n e_n, v_n = v·e_n",
            brings: "a force across at every node",
            number: "c₂ u1/m, u1 the swing: what a swing loses of itself; present where given",
            cost: "a root in every node",
            needs: &[TransverseMotion],
            presence: Presence::Given(|case, _| {
                let around = case.surroundings.as_ref();
                case.beam.damping.quadratic_drag_n_s2_m3 > 0.0 || around.is_some_and(|s| s.drag_coefficient > 0.0)
            }),
        },
        Effect::Closing => About {
            adds: "p = (a1 - R A_M - A_N)/a_p - P (ε/x - 1)², x = (A_0 + a1)/A_0 < ε",
            brings: "pressure of walls on each other, which keeps areas positive",
            number: "present where given",
            cost: "a comparison in every cell",
            needs: &[Fluid],
            presence: Presence::Given(|case, network| {
                network.is_some()
                    && case
                        .bladders
                        .as_ref()
                        .is_some_and(|bladders| bladders.closing.is_some())
            }),
        },
        Effect::Valves => About {
            adds: "g = o/(o R_half + R), o(t) given",
            brings: "conductances that change in time",
            number: "present where given",
            cost: "a signal a valve",
            needs: &[Fluid],
            presence: Presence::Given(|_, network| {
                network.is_some_and(|n| n.links.iter().any(|l| l.opening.is_some()))
            }),
        },
        Effect::CheckValves => About {
            adds: "q = G_r Δ + (G_f - G_r) s(Δ - p_c) in series with the tube",
            brings: "a conductance that its pressure drop changes, linear and quadratic in pieces",
            number: "present where given",
            cost: "a root a valve; steps where it opens and shuts",
            needs: &[Fluid, Flow, NetworkPressureDifferences],
            presence: Presence::Given(|_, network| {
                network.is_some_and(|n| n.links.iter().any(|l| l.check_valve.is_some()))
            }),
        },
        Effect::Pumps => About {
            adds: "p_a - p_b + p_pump(t) - R_pump q along a tube",
            brings: "a pressure that drives flow",
            number: "present where given",
            cost: "a signal a pump",
            needs: &[Fluid, Flow, NetworkPressureDifferences],
            presence: Presence::Given(|_, network| network.is_some_and(|n| n.links.iter().any(|l| l.pump.is_some()))),
        },
        Effect::Accumulators => About {
            adds: "dV/dt = Σ q, p = p(V)",
            brings: "a volume each, in place of the pressure of a junction",
            number: "present where given",
            cost: "an unknown each",
            needs: &[Fluid, Flow, NetworkPressureDifferences],
            presence: Presence::Given(|_, network| network.is_some_and(|n| !n.accumulators.is_empty())),
        },
        Effect::Turbines => About {
            adds: "q = G (p_a - p_b), and a bridge of check valves where given",
            brings: "conductances; a pressure drop behind each real rectifier",
            number: "present where given",
            cost: "an unknown a real rectifier",
            needs: &[Fluid],
            presence: Presence::Given(|_, network| network.is_some_and(|n| !n.turbines.is_empty())),
        },
        Effect::Loads => About {
            adds: "b, b1, end forces and moments",
            brings: "terms of time and place",
            number: "present where given",
            cost: "signals",
            needs: &[],
            presence: Presence::Given(|case, _| case.loads.iter().any(|load| !gravity(load))),
        },
        Effect::Gravity => About {
            adds: "m g",
            brings: "a constant load",
            number: "m g l_s³/EI; present where given",
            cost: "nothing",
            needs: &[],
            presence: Presence::Given(|case, _| case.loads.iter().any(gravity)),
        },
        Effect::Attachments => About {
            adds: "M a, J φ_tt, -k u, -k φ, -c v, dead forces and followers at places along the beam, masses beside it",
            brings: "masses of nodes; forces at their neighbours",
            number: "present where given; what is decided by the scene's numbers stays then",
            cost: "arithmetic in two nodes each",
            needs: &[],
            presence: Presence::Given(|case, _| !case.attachments.is_empty()),
        },
        Effect::Contacts => About {
            adds: "k s(g) n behind a wall, damped, with friction",
            brings: "forces that set in at depth 0",
            number: "present where given; what is decided by the scene's numbers stays then",
            cost: "arithmetic in every node, or in two; steps where the beam strikes",
            needs: &[],
            presence: Presence::Given(|case, _| !case.contacts.is_empty()),
        },
        Effect::Surroundings => About {
            adds: "-m_a (v·e_n)_t e_n, drag on v less the stream's velocity, -ρ h_s w_s g",
            brings: "accelerations of both directions coupled in every node",
            number: "present where given; what is decided by the scene's numbers stays then",
            cost: "arithmetic in every node",
            needs: &[],
            presence: Presence::Given(|case, _| case.surroundings.is_some()),
        },
    }
}
