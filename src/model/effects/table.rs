//! Table of all effects: required effects, and effects given by a case. `docs/effects.md` lists the benefit, the cost
//! and the decision rule of each.

use Effect::*;

use crate::case::schema::{Case, Effect, Load};
use crate::model::ResolvedNetwork;

/// Effects that an effect requires.
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

/// True or false for an effect that is on exactly where the case gives its data; none for effects that the case or the
/// program chooses. `network` is that of the bladders, if they contain fluid.
pub fn given(effect: Effect, case: &Case, network: Option<&ResolvedNetwork>) -> Option<bool> {
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
        Valves => network.is_some_and(|n| n.links.iter().any(|l| l.opening.is_some() || l.pilot.is_some())),
        CheckValves => network.is_some_and(|n| n.links.iter().any(|l| l.check_valve.is_some())),
        Pumps => network.is_some_and(|n| n.links.iter().any(|l| l.pump.is_some())),
        Accumulators => network.is_some_and(|n| !n.accumulators.is_empty()),
        Turbines => network.is_some_and(|n| !n.turbines.is_empty()),
        Loads => case.loads.iter().any(|load| !gravity(load)) || case.rotating_frame.is_some(),
        Gravity => case.loads.iter().any(gravity),
        Attachments => !case.attachments.is_empty() || case.foundation.is_some(),
        Contacts => !case.contacts.is_empty(),
        Surroundings => case.surroundings.is_some(),
        _ => return None,
    })
}
