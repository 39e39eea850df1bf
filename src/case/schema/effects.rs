//! Choice of the simulated physical effects.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Formulation;

/// Choice of the simulated physical effects: `"auto"`, `"full"` or effect by effect.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Effects {
    /// The program chooses and reports the reasons.
    #[default]
    Auto,
    /// Everything the case describes.
    Full,
    /// Named choices; the others are `auto`.
    Chosen(EffectChoices),
}

/// Defines [`Effect`] with all effects, and [`EffectChoices`] with those that a case chooses. The others are active if the case gives them.
macro_rules! effects {
    (
        chosen { $($(#[doc = $about:literal])* $Chosen:ident $chosen:ident,)* }
        given { $($(#[doc = $note:literal])* $Given:ident $given:ident,)* }
    ) => {
        /// A physical effect, in the order of the decisions.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
        #[serde(rename_all = "snake_case")]
        pub enum Effect {
            $($(#[doc = $about])* $Chosen,)*
            $($(#[doc = $note])* $Given,)*
        }

        impl Effect {
            /// All effects.
            pub const ALL: &[Self] = &[$(Self::$Chosen,)* $(Self::$Given,)*];
            /// Effects that a case chooses.
            pub const CHOSEN: &[Self] = &[$(Self::$Chosen,)*];

            /// Key in a case, and name in every report.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$Chosen => stringify!($chosen),)*
                    $(Self::$Given => stringify!($given),)*
                }
            }

            /// Description, as in the schema.
            pub const fn note(self) -> &'static str {
                match self {
                    $(Self::$Chosen => concat!($($about),*),)*
                    $(Self::$Given => concat!($($note),*),)*
                }
            }
        }

        /// Named effects.
        #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
        #[serde(deny_unknown_fields)]
        pub struct EffectChoices {
            $($(#[doc = $about])* #[serde(default)] pub $chosen: Choice,)*
        }

        impl EffectChoices {
            /// Choice of an effect; `Auto` for an effect that cannot be chosen.
            pub fn choice(&self, effect: Effect) -> Choice {
                match effect {
                    $(Effect::$Chosen => self.$chosen,)*
                    $(Effect::$Given => Choice::Auto,)*
                }
            }

            /// Sets the choice of an effect; ignores an effect that cannot be chosen.
            pub fn set(&mut self, effect: Effect, choice: Choice) {
                match effect {
                    $(Effect::$Chosen => self.$chosen = choice,)*
                    $(Effect::$Given => {})*
                }
            }
        }
    };
}

effects! {
    chosen {
        /// Motion across the beam, with slopes and moments; off: a bar, which can only stretch. Needs that nothing moves or loads it
        /// across.
        TransverseMotion transverse_motion,
        /// Rotations of any size; off: small ones, `u3' + u1'^2/2` the strain and `u1'` the angle. Needs the conservative
        /// formulation.
        FiniteRotation finite_rotation,
        /// The normal force that acts on bending (geometric stiffness); off: the linear beam. Needs `finite_rotation` off.
        AxialForceOnBending axial_force_on_bending,
        /// Stretch along the beam; off: the beam draws in only as it bends, and the normal force follows from the loads. Needs
        /// `finite_rotation` off, one end that holds or drives `u3`, and one that is free along.
        AxialStretch axial_stretch,
        /// Shear: sections turn by angles of their own; off: they stay across the beam. Needs `shear_stiffness_n` of the beam and the
        /// conservative formulation.
        Shear shear,
        /// Inertia of the solid; off: quasi-static solid.
        SolidInertia solid_inertia,
        /// Inertia along the beam, axial waves; off: the beam is carried along by its driven ends, with the force that this
        /// takes. Needs an end that holds or drives `u3`.
        AxialInertia axial_inertia,
        /// Inertia of the section's rotation, `m y11`.
        RotaryInertia rotary_inertia,
        /// The fluid in the bladders; off: a dry beam with the mass of the filled one.
        Fluid fluid,
        /// Flow between bladders; off: every bladder keeps its volume.
        Flow flow,
        /// Pressure differences within each network; off: one pressure for all bladders that are joined. Not possible with
        /// turbines, valves that move, check valves, pumps, accumulators, or ports of different pressures.
        NetworkPressureDifferences network_pressure_differences,
        /// Pressure differences along each bladder; off: one finite volume a bladder, regardless of `/mesh/cells_per_bladder`.
        FlowAlongBladders flow_along_bladders,
        /// Compression of the fluid: gas, or a liquid with `bulk_modulus_pa` or `gas_fraction`; off: it keeps its density at ambient
        /// pressure.
        Compressibility compressibility,
        /// Inertia of the fluid in tubes: flow is an unknown of each tube. Left out of the published form unless it is named.
        TubeInertia tube_inertia,
        /// Inertia of the fluid along bladders: flow is an unknown of each face between cells. Needs `tube_inertia`.
        BladderInertia bladder_inertia,
        /// Laminar friction that depends on how flow has changed, ten states a tube, and a face of a bladder with `bladder_inertia`; off:
        /// that of a steady profile. Needs `tube_inertia`.
        UnsteadyFriction unsteady_friction,
        /// Turbulent friction in tubes, and losses at their ends: `loss_coefficient`, `roughness_m`. Left out of the published form
        /// unless it is named.
        TubeLosses tube_losses,
        /// Pressure bends the beam, `alpha_p`.
        PressureToCurvature pressure_to_curvature,
        /// Pressure stretches the beam, `lambda_p`.
        PressureToStretch pressure_to_stretch,
        /// Bending changes the area of bladders, `A_M`.
        MomentToArea moment_to_area,
        /// Normal force changes the area of bladders, `A_N`.
        ForceToArea force_to_area,
        /// Different opening and closing slopes of the bladder area.
        Asymmetry asymmetry,
        /// Finite strain of the section, `strain_energy` of the bladders; off: forces and areas linear in strains and pressures.
        NonlinearSection nonlinear_section,
    }
    given {
        /// Damping of the material, and drag.
        Damping damping,
        /// Relaxation of the material: a Prony series, or a loss factor over a band.
        Viscoelasticity viscoelasticity,
        /// Drag across the beam that grows with the square of its velocity.
        QuadraticDrag quadratic_drag,
        /// Walls of bladders that meet.
        Closing closing,
        /// Valves that move.
        Valves valves,
        /// Check valves and relief valves in tubes.
        CheckValves check_valves,
        /// Pumps in tubes.
        Pumps pumps,
        /// Vessels that take in fluid as their pressure rises.
        Accumulators accumulators,
        /// Turbines that harvest energy.
        Turbines turbines,
        /// Loads along the beam.
        Loads loads,
        /// Weight.
        Gravity gravity,
        /// Masses, springs, dashpots and forces at places along the beam.
        Attachments attachments,
        /// Walls that the beam may come to lie against.
        Contacts contacts,
        /// Fluid around the beam: its inertia and stream.
        Surroundings surroundings,
    }
}

impl std::fmt::Display for Effect {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

impl Effect {
    /// True if the effect is active only when a case names it: flow is creeping in the published form.
    pub fn by_name(self, formulation: Formulation) -> bool {
        formulation == Formulation::Published && self.of_flow()
    }

    /// True if the effect concerns flow that is not creeping.
    pub const fn of_flow(self) -> bool {
        self.of_inertia() || matches!(self, Self::TubeLosses)
    }

    /// True if the effect concerns the inertia of flow.
    pub const fn of_inertia(self) -> bool {
        matches!(self, Self::TubeInertia | Self::BladderInertia | Self::UnsteadyFriction)
    }

    /// True if the effect concerns bladders, or their coupling with the beam.
    pub const fn of_bladders(self) -> bool {
        matches!(
            self,
            Self::PressureToCurvature
                | Self::PressureToStretch
                | Self::MomentToArea
                | Self::ForceToArea
                | Self::Asymmetry
                | Self::FlowAlongBladders
                | Self::BladderInertia
                | Self::NonlinearSection
        )
    }

    /// Names of the effects, joined by `separator`.
    pub fn names(effects: &[Self], separator: &str) -> String {
        let names: Vec<&str> = effects.iter().map(|effect| effect.name()).collect();
        names.join(separator)
    }
}

impl Effects {
    /// Named choices; none for `"auto"` and `"full"`.
    pub fn choices(&self) -> EffectChoices {
        match self {
            Self::Auto | Self::Full => EffectChoices::default(),
            Self::Chosen(choices) => choices.clone(),
        }
    }
}

/// On, off, or chosen by the program.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Choice {
    /// Chosen by the program.
    #[default]
    Auto,
    /// Simulated.
    On,
    /// Left out.
    Off,
}
