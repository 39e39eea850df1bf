//! Decides on effects one by one; each decision depends on the earlier ones.

use super::cause::{DecisionCause, DecisiveNumber, Keeps, MeasuredAgainst};
use super::obstacles::{self, Obstacle};
use super::table::{given, needs};
use super::{Decision, EffectScene, EffectSet};
use crate::case::schema::{
    Case, Choice, Coupling, Effect, EffectChoices, Effects, Fluid, FluidKind, Formulation, Load,
};
use crate::case::spans;
use crate::error::{Code, Violation};
use crate::model::ResolvedNetwork;

/// State of the effect chooser.
pub(super) struct Chooser<'a> {
    pub case: &'a Case,
    /// Network of the bladders.
    pub network: Option<&'a ResolvedNetwork>,
    /// Scene for automatic choices; none keeps every effect.
    pub scene: Option<&'a EffectScene<'a>>,
    choices: EffectChoices,
    tolerance: f64,
    /// Decisions so far.
    set: EffectSet,
}

impl<'a> Chooser<'a> {
    pub fn new(case: &'a Case, network: Option<&'a ResolvedNetwork>, scene: Option<&'a EffectScene>) -> Self {
        Self {
            case,
            network,
            scene: scene.filter(|_| case.effects != Effects::Full),
            choices: case.effects.choices(),
            tolerance: case.effects_tolerance(),
            set: EffectSet::default(),
        }
    }

    pub fn all(mut self) -> EffectSet {
        for &effect in Effect::ALL {
            let (on, cause) = match self.given(effect) {
                Some(given) => (given, DecisionCause::Given(given)),
                None => self.decide(effect),
            };
            self.set.push(Decision { effect, on, cause });
        }
        self.set
    }

    /// True or false for an effect that is on exactly where the case gives its data; none for others.
    fn given(&self, effect: Effect) -> Option<bool> {
        given(effect, self.case, self.network.filter(|_| self.set.has(Effect::Fluid)))
    }

    /// Decides on an effect. It is off where a required effect or input is missing, whatever the choice. It stays on
    /// where an obstacle prevents omission; the case is rejected if omission was requested.
    fn decide(&mut self, effect: Effect) -> (bool, DecisionCause) {
        if let Err(why) = self.possible(effect) {
            if self.choices.choice(effect) == Choice::On {
                self.contradicts(effect, &why);
            }
            return (false, why);
        }
        self.decide_possible(effect)
    }

    /// Rejects an effect that is switched on by name while the case itself rules it out: a required effect is off by
    /// name, its data are missing, or the form has no such effect. If the program omits a required effect, the named
    /// effect is omitted without error.
    fn contradicts(&mut self, effect: Effect, why: &DecisionCause) {
        let (what, hint) = match why {
            DecisionCause::Needs(missing) => {
                let Some(off) = self.off_by_name(*missing) else {
                    return;
                };
                let hint = format!("leave it out, or set {off} to \"on\"");
                (format!("{effect} is on, but {off}, which it needs, is off"), hint)
            }
            DecisionCause::Filled(false) if self.case.network.is_some() => (
                format!("{effect} is on, but the case has no bladders"),
                "give /bladders, or leave the effect out".into(),
            ),
            DecisionCause::Given(false) if effect == Effect::Compressibility => (
                format!("{effect} is on, but the fluid is incompressible"),
                "give bulk_modulus_pa or gas_fraction of the liquid, or a gas, in /fluid; or leave it out".into(),
            ),
            DecisionCause::Unsheared => (
                format!("{effect} is on, but the published form has no shear"),
                "leave it out, or set \"formulation\" to \"conservative\"".into(),
            ),
            DecisionCause::Given(false) if effect == Effect::Shear => (
                format!("{effect} is on, but no shear_stiffness_n is given"),
                "give /beam/shear_stiffness_n (solid rectangle: about 5/6 of its area times the shear modulus), or a section that \
                 supplies it; or leave shear out"
                    .into(),
            ),
            DecisionCause::Given(false) => (
                format!("{effect} is on, but no strain_energy is given"),
                "give /bladders/strain_energy, or a section that supplies it; or leave the effect out".into(),
            ),
            _ => return,
        };
        self.refuse(effect, &what, &hint);
    }

    /// The effect switched off by name that disables `missing`, directly or through required effects. None for the
    /// fluid, which disables all its effects.
    fn off_by_name(&self, missing: Effect) -> Option<Effect> {
        match self.set.decision(missing).cause {
            DecisionCause::LeftOut if missing == Effect::Fluid => None,
            DecisionCause::LeftOut => Some(missing),
            DecisionCause::Needs(further) => self.off_by_name(further),
            _ => None,
        }
    }

    fn refuse(&mut self, effect: Effect, what: &str, hint: &str) {
        let refusal = Violation::new(Code::Effect, format!("/effects/{effect}"), what);
        self.set.refusals.push(refusal.hint(hint));
    }

    fn decide_possible(&mut self, effect: Effect) -> (bool, DecisionCause) {
        match self.choices.choice(effect) {
            Choice::On => (true, DecisionCause::Asked),
            Choice::Off => match self.obstacle(effect) {
                None => (false, DecisionCause::LeftOut),
                Some(obstacle) => {
                    let what = format!("{effect} cannot be left out: {}", obstacle.what);
                    self.refuse(effect, &what, &obstacle.hint);
                    (true, DecisionCause::Refused(obstacle))
                }
            },
            Choice::Auto if effect == Effect::TubeInertia && self.asked_with_inertia() => {
                (true, DecisionCause::Kept(Keeps::AskedWithInertia))
            }
            Choice::Auto
                if effect == Effect::TubeInertia && !self.feeds_junction() && self.obstacle(effect).is_some() =>
            {
                (
                    true,
                    self.obstacle(effect)
                        .map_or(DecisionCause::Full, DecisionCause::Obstacle),
                )
            }
            Choice::Auto if effect.by_name(self.case.formulation) => (false, DecisionCause::Unasked),
            Choice::Auto if effect.of_inertia() && self.feeds_junction() => (false, DecisionCause::FedJunction),
            Choice::Auto => match self.scene {
                None => (true, DecisionCause::Full),
                Some(scene) => match self.obstacle(effect) {
                    Some(obstacle) => (true, DecisionCause::Obstacle(obstacle)),
                    None => self.automatic(effect, scene),
                },
            },
        }
    }

    /// Reason that rules an effect out, as an error.
    fn possible(&self, effect: Effect) -> Result<(), DecisionCause> {
        if let Some(missing) = needs(effect).iter().find(|needed| !self.set.has(**needed)) {
            return Err(DecisionCause::Needs(*missing));
        }
        let bladders = self.case.bladders.as_ref();
        match effect {
            Effect::NonlinearSection if bladders.is_none_or(|b| b.strain_energy.is_none()) => {
                Err(DecisionCause::Given(false))
            }
            Effect::Shear if self.case.formulation == Formulation::Published => Err(DecisionCause::Unsheared),
            Effect::Shear if self.case.beam.shear_stiffness_n.is_none() => Err(DecisionCause::Given(false)),
            Effect::Compressibility if self.fluid().is_none_or(|fluid| !fluid.is_compressible()) => {
                Err(DecisionCause::Given(false))
            }
            _ if effect.of_flow() && self.fluid().is_some_and(|fluid| fluid.density_kg_m3 == 0.0) => {
                Err(DecisionCause::Massless)
            }
            Effect::Fluid if self.case.fluid.is_none() || self.case.network_bladders().is_none() => {
                Err(DecisionCause::Filled(false))
            }
            _ if bladders.is_none() && effect.of_bladders() => Err(DecisionCause::Filled(false)),
            Effect::Asymmetry if bladders.is_some_and(|b| b.coupling == Coupling::Reciprocal) => {
                Err(DecisionCause::NoKinks)
            }
            _ => Ok(()),
        }
    }

    /// True if an effect that requires tube inertia is switched on by name.
    fn asked_with_inertia(&self) -> bool {
        let with = [Effect::BladderInertia, Effect::UnsteadyFriction];
        with.iter().any(|&effect| self.choices.choice(effect) == Choice::On)
    }

    /// The sloshing number, if inertia along bladders is still possible: no choice by name and no earlier decision
    /// excludes it.
    fn may_swing(&self, scene: &EffectScene) -> Option<f64> {
        let bladders = Effect::BladderInertia;
        let massless = self.fluid().is_some_and(|fluid| fluid.density_kg_m3 == 0.0);
        let named = self.choices.choice(bladders);
        let off = named == Choice::Off || self.choices.choice(Effect::TubeInertia) == Choice::Off;
        let unasked = bladders.by_name(self.case.formulation) && named != Choice::On;
        (!massless && !off && !unasked).then(|| scene.sloshing(self.tolerance))
    }

    /// True if a port's flow enters a junction of tubes only, without compression to store it.
    fn feeds_junction(&self) -> bool {
        let stores = self.set.has(Effect::Compressibility);
        !stores && self.network.is_some_and(|network| network.fed_junction().is_some())
    }

    fn fluid(&self) -> Option<&Fluid> {
        self.case.fluid.as_ref()
    }

    /// Obstacle to omitting an effect.
    fn obstacle(&self, effect: Effect) -> Option<Obstacle> {
        let (case, network) = (self.case, self.network);
        let [across, turning] = [Effect::TransverseMotion, Effect::FiniteRotation].map(|e| self.set.has(e));
        if case.is_structure() && obstacles::OF_STRUCTURES.contains(&effect) {
            return Some(obstacles::structure());
        }
        match effect {
            Effect::TransverseMotion => obstacles::transverse_motion(case),
            Effect::FiniteRotation => obstacles::finite_rotation(case),
            Effect::AxialForceOnBending => obstacles::axial_force_on_bending(case, turning),
            Effect::AxialStretch => obstacles::axial_stretch(case, across, turning),
            Effect::SolidInertia => obstacles::solid_inertia(case, [across, self.set.has(Effect::AxialStretch)]),
            Effect::AxialInertia => obstacles::axial_inertia(case, turning),
            Effect::RotaryInertia => obstacles::rotary_inertia(case, self.set.has(Effect::Shear)),
            Effect::Flow => network.and_then(obstacles::flow),
            Effect::NetworkPressureDifferences => network.and_then(obstacles::network_pressure_differences),
            Effect::Compressibility => network.and_then(obstacles::compressibility),
            Effect::TubeInertia => network.and_then(|network| obstacles::tube_inertia(case, network)),
            _ => None,
        }
    }

    /// Automatic choice for an effect.
    fn automatic(&self, effect: Effect, scene: &EffectScene) -> (bool, DecisionCause) {
        let kept = |keeps: Keeps| (true, DecisionCause::Kept(keeps));
        let unstable = |why: String| (true, DecisionCause::Unstable(why));
        let weighed = |what: DecisiveNumber, value: f64| MeasuredAgainst {
            what,
            value,
            tolerance: self.tolerance,
        };
        let weigh = |what: DecisiveNumber, value: f64| {
            let weighed = weighed(what, value);
            (weighed.on(), DecisionCause::Weighed(weighed))
        };
        // keep bending effects whose omission might hide an instability or a resonance
        let bending = |choice: (bool, DecisionCause)| match scene.unstable() {
            _ if choice.0 => choice,
            Some(why) => unstable(why),
            None if scene.resonant() => kept(Keeps::Resonance),
            None => choice,
        };
        let case = self.case;
        let unbounded = !case.attachments.is_empty()
            || case.foundation.is_some()
            || case.rotating_frame.is_some()
            || case.loads.iter().any(Load::follows);
        match effect {
            _ if unbounded && by_motion(effect) => kept(Keeps::Attachments),
            _ if !self.case.contacts.is_empty() && by_motion(effect) => kept(Keeps::Contacts),
            _ if self.case.loads.iter().any(Load::is_rest) && by_motion(effect) => kept(Keeps::RestCurvature),
            _ if self.case.beam.viscoelasticity.is_some() && by_motion(effect) => kept(Keeps::Viscoelasticity),
            _ if spans::bends_nonlinearly(self.case) && by_motion(effect) => kept(Keeps::MomentCurvature),
            _ if self.case.surroundings.is_some() && by_motion(effect) => kept(Keeps::Surroundings),
            _ if needs(Effect::NonlinearSection).contains(&effect) && scene.strain_energy() >= self.tolerance => {
                kept(Keeps::FiniteStrain)
            }
            Effect::NonlinearSection => weigh(DecisiveNumber::StrainEnergy, scene.strain_energy()),
            Effect::TransverseMotion => match scene.unstable() {
                _ if !scene.mirrored() => kept(Keeps::RowsDiffer),
                Some(why) => unstable(why),
                None => (false, DecisionCause::Straight(scene.compression())),
            },
            Effect::FiniteRotation => bending(weigh(DecisiveNumber::Rotation, scene.rotation())),
            Effect::AxialForceOnBending => {
                let (force, drawn_in) = (scene.normal_force(), scene.drawn_in());
                bending(match drawn_in.is_nan() || drawn_in > force {
                    true => weigh(DecisiveNumber::DrawnIn, drawn_in),
                    false => weigh(DecisiveNumber::NormalForce, force),
                })
            }
            Effect::AxialStretch => weigh(DecisiveNumber::Stretch, scene.stretch()),
            Effect::SolidInertia => match scene.unstable() {
                _ if scene.driven() => kept(Keeps::DrivenEnds),
                _ if !scene.held() => kept(Keeps::NotHeld),
                Some(why) => unstable(why),
                None => weigh(DecisiveNumber::BendingInertia, scene.bending_inertia()),
            },
            Effect::AxialInertia => {
                let across = self.set.has(Effect::TransverseMotion);
                let shortening = if across { scene.shortening() } else { 0.0 };
                weigh(DecisiveNumber::AxialWaves, scene.axial_waves().max(shortening))
            }
            Effect::Shear if scene.sudden(self.tolerance) => kept(Keeps::Sudden),
            Effect::Shear => bending(weigh(DecisiveNumber::Shear, scene.shear())),
            Effect::RotaryInertia if scene.sudden(self.tolerance) => kept(Keeps::Sudden),
            Effect::RotaryInertia => weigh(DecisiveNumber::RotaryInertia, scene.rotary()),
            Effect::Flow => {
                let count = |n: &ResolvedNetwork| (n.sealed().filter(|s| *s).count(), n.component_of_bladder.len());
                match self.network.map_or((0, 0), count) {
                    (_, 0) => kept(Keeps::Dissipation),
                    _ if scene.fed() => kept(Keeps::Fed),
                    (sealed, all) if sealed == all => (true, DecisionCause::Sealed(all)),
                    // without loads across, only the flow bends the beam, however small
                    _ if !scene.mirrored() && obstacles::transverse_motion(self.case).is_none() => {
                        kept(Keeps::RowsDiffer)
                    }
                    (sealed, all) => {
                        let leaks = weighed(DecisiveNumber::Leakage, scene.leakage());
                        (leaks.on(), DecisionCause::PartlySealed { sealed, all, leaks })
                    }
                }
            }
            Effect::NetworkPressureDifferences => kept(Keeps::Dissipation),
            Effect::FlowAlongBladders => match self.network.and_then(obstacles::network_pressure_differences) {
                Some(through) => (true, DecisionCause::Obstacle(through)),
                None if scene.uneven_start() => kept(Keeps::UnevenStart),
                None => {
                    let lag = scene.lag_along_bladders(self.tolerance);
                    match self.may_swing(scene).filter(|swing| *swing > lag) {
                        Some(swing) => weigh(DecisiveNumber::Sloshing, swing),
                        None => weigh(DecisiveNumber::LagAlongBladders, lag),
                    }
                }
            },
            Effect::Compressibility if self.fluid().is_some_and(|fluid| fluid.kind == FluidKind::Gas) => {
                kept(Keeps::Gas)
            }
            Effect::Compressibility => weigh(DecisiveNumber::Compression, scene.compression_of_fluid()),
            Effect::TubeInertia => {
                let (tubes, bladders) = (scene.tubes(self.tolerance).inertia, scene.sloshing(self.tolerance));
                match self.choices.choice(Effect::BladderInertia) {
                    Choice::Auto if bladders > tubes => weigh(DecisiveNumber::Sloshing, bladders),
                    _ => weigh(DecisiveNumber::Inertance, tubes),
                }
            }
            Effect::BladderInertia => weigh(DecisiveNumber::Sloshing, scene.sloshing(self.tolerance)),
            Effect::UnsteadyFriction => {
                let in_tubes = scene.tubes(self.tolerance).memory;
                weigh(
                    DecisiveNumber::UnsteadyFriction,
                    match self.set.has(Effect::BladderInertia) {
                        true if in_tubes.is_finite() => in_tubes.max(scene.memory_of_bladders(self.tolerance)),
                        _ => in_tubes,
                    },
                )
            }
            Effect::TubeLosses => weigh(DecisiveNumber::TubeLosses, scene.tubes(self.tolerance).losses),
            Effect::PressureToCurvature => weigh(DecisiveNumber::PressureStrain, scene.strains_of_pressure()[0]),
            Effect::PressureToStretch => weigh(DecisiveNumber::PressureStrain, scene.strains_of_pressure()[1]),
            Effect::MomentToArea | Effect::ForceToArea => kept(Keeps::MakesPressure),
            Effect::Asymmetry => {
                let [m, n] = scene.asymmetries();
                weigh(DecisiveNumber::Asymmetry, m.max(n))
            }
            Effect::Fluid => (true, DecisionCause::Filled(true)),
            // all others are on where the case gives their data
            _ => (true, DecisionCause::Given(true)),
        }
    }
}

/// True if numbers for a beam without attachments decide on an effect.
fn by_motion(effect: Effect) -> bool {
    use Effect::*;
    let by_fluid = [
        Fluid,
        Flow,
        NetworkPressureDifferences,
        Compressibility,
        MomentToArea,
        ForceToArea,
        Asymmetry,
    ];
    !by_fluid.contains(&effect)
}
