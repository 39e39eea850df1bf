//! All effects that the program knows: which others each needs, and which of them a case gives. `docs/effects.md` has what each adds, brings with it and
//! costs, and what decides.

use Effect::*;

use crate::case::schema::{Case, Effect, Load};
use crate::model::Network;

/// Other effects without which an effect has no meaning.
pub fn needs(effect: Effect) -> &'static [Effect] {
    match effect {
        TransverseMotion | AxialStretch | SolidInertia | Fluid | Damping | Viscoelasticity | Loads | Gravity
        | Attachments | Contacts | Surroundings => &[],
        FiniteRotation | AxialForceOnBending | Shear | QuadraticDrag => &[TransverseMotion],
        AxialInertia => &[SolidInertia, AxialStretch],
        RotaryInertia => &[SolidInertia, TransverseMotion],
        Flow | Compressibility | PressureToStretch | ForceToArea | Asymmetry | Closing | Valves | Turbines => &[Fluid],
        NetworkPressureDifferences => &[Fluid, Flow],
        FlowAlongBladders | TubeInertia | TubeLosses | CheckValves | Pumps | Accumulators => {
            &[Fluid, Flow, NetworkPressureDifferences]
        }
        BladderInertia | UnsteadyFriction => &[TubeInertia],
        PressureToCurvature | MomentToArea => &[Fluid, TransverseMotion],
        NonlinearSection => &[
            TransverseMotion,
            AxialStretch,
            Fluid,
            PressureToCurvature,
            PressureToStretch,
            MomentToArea,
            ForceToArea,
        ],
    }
}

fn gravity(load: &Load) -> bool {
    matches!(load, Load::Gravity { .. })
}

/// Whether a case gives an effect, with the network of its bladders where they hold fluid; none of effects that a case or the program chooses.
pub fn given(effect: Effect, case: &Case, network: Option<&Network>) -> Option<bool> {
    Some(match effect {
        Damping => {
            let damping = &case.beam.damping;
            damping.axial_time_s > 0.0 || damping.bending_time_s > 0.0 || damping.drag_n_s_m2 > 0.0
        }
        Viscoelasticity => case.beam.viscoelasticity.is_some(),
        QuadraticDrag => {
            let around = case.surroundings.as_ref();
            case.beam.damping.quadratic_drag_n_s2_m3 > 0.0 || around.is_some_and(|s| s.drag_coefficient > 0.0)
        }
        Closing => network.is_some() && case.bladders.as_ref().is_some_and(|b| b.closing.is_some()),
        Valves => network.is_some_and(|n| n.links.iter().any(|l| l.opening.is_some())),
        CheckValves => network.is_some_and(|n| n.links.iter().any(|l| l.check_valve.is_some())),
        Pumps => network.is_some_and(|n| n.links.iter().any(|l| l.pump.is_some())),
        Accumulators => network.is_some_and(|n| !n.accumulators.is_empty()),
        Turbines => network.is_some_and(|n| !n.turbines.is_empty()),
        Loads => case.loads.iter().any(|load| !gravity(load)),
        Gravity => case.loads.iter().any(gravity),
        Attachments => !case.attachments.is_empty(),
        Contacts => !case.contacts.is_empty(),
        Surroundings => case.surroundings.is_some(),
        _ => return None,
    })
}
