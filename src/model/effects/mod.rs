//! Which effects are simulated, chosen once, each with the number that decided.
//!
//! [`TABLE`] says in words what each effect is. A new effect needs: its physics in a module of its own, a row of the
//! table, a field of [`EffectChoices`], a line in [`EffectSet::choose`], and its place in
//! [`crate::discrete::recipe::evaluate`].

mod decisions;
mod obstacles;
pub mod scene;
mod table;

use super::Network;
use crate::case::schema::{Case, Coupling, EffectChoices, Effects};
use crate::error::Violation;

use decisions::{Automatic, Decisions, kept, weigh};
pub use scene::Scene;
pub use table::{Effect, TABLE};

/// A decision with its reason.
#[derive(Clone, Debug, PartialEq)]
pub struct Decision {
    /// Name of the effect.
    pub name: &'static str,
    /// Whether it is simulated.
    pub on: bool,
    /// The number that decided, in words.
    pub reason: String,
}

/// The effects that a model contains.
#[derive(Clone, Debug, PartialEq)]
pub struct EffectSet {
    /// Motion across the beam.
    pub transverse_motion: bool,
    /// Rotations of any size.
    pub finite_rotation: bool,
    /// The normal force acts on bending.
    pub axial_force_on_bending: bool,
    /// Stretch along the beam.
    pub axial_stretch: bool,
    /// Inertia of the solid.
    pub solid_inertia: bool,
    /// Inertia along the beam.
    pub axial_inertia: bool,
    /// Inertia of the section's rotation.
    pub rotary_inertia: bool,
    /// Fluid in the bladders.
    pub fluid: bool,
    /// Flow between bladders.
    pub flow: bool,
    /// Pressure differences within each network.
    pub network_pressure_differences: bool,
    /// Pressure differences along each bladder.
    pub flow_along_bladders: bool,
    /// Pressure bends the beam.
    pub pressure_to_curvature: bool,
    /// Pressure stretches the beam.
    pub pressure_to_stretch: bool,
    /// Bending changes areas.
    pub moment_to_area: bool,
    /// Normal force changes areas.
    pub force_to_area: bool,
    /// Different opening and closing slopes of the bladder area.
    pub asymmetry: bool,
    /// Every decision, in the order of [`TABLE`].
    pub decisions: Vec<Decision>,
    /// Why a case is refused: effects that were to be left out and cannot be.
    pub refusals: Vec<Violation>,
}

impl EffectSet {
    /// The same without inertia of the solid.
    pub fn at_rest(self) -> Self {
        Self {
            solid_inertia: false,
            axial_inertia: false,
            rotary_inertia: false,
            ..self
        }
    }

    /// Everything that a case describes; `network` is that of its bladders.
    pub fn whole(case: &Case, network: Option<&Network>) -> Self {
        Self::decide(case, network, None)
    }

    /// Chooses the effects of a case for the scene it describes: what it names as it says, the rest so that what is left out
    /// changes results by less than `effects_tolerance`.
    pub fn choose(case: &Case, network: Option<&Network>, scene: &Scene) -> Self {
        Self::decide(case, network, Some(scene))
    }

    fn decide(case: &Case, network: Option<&Network>, scene: Option<&Scene>) -> Self {
        let c = match &case.effects {
            Effects::Auto | Effects::Full => &EffectChoices::default(),
            Effects::Chosen(choices) => choices,
        };
        let scene = scene.filter(|_| case.effects != Effects::Full);
        let mut table = Decisions {
            scene,
            decisions: vec![],
            refusals: vec![],
        };
        let tolerance = case.effects_tolerance();
        let transverse_motion = table.decide(
            "transverse_motion",
            c.transverse_motion,
            Ok(()),
            || obstacles::transverse_motion(case),
            |scene| {
                if !scene.mirrored() {
                    kept("the rows of bladders are not each other's mirror image")
                } else if let Some(why) = scene.unstable() {
                    kept(&why)
                } else {
                    let why = "nothing acts across, the rows mirror each other";
                    (
                        false,
                        format!("{why}, {:.1e} of the buckling load", scene.compression()),
                    )
                }
            },
        );
        let across = if transverse_motion {
            Ok(())
        } else {
            Err("no transverse motion")
        };
        let bending = |scene: &Scene, choice: Automatic| match scene.unstable() {
            Some(why) if !choice.0 => kept(&why),
            None if !choice.0 && scene.resonant() => kept("something acts near or above the first bending frequency"),
            _ => choice,
        };
        let finite_rotation = table.decide(
            "finite_rotation",
            c.finite_rotation,
            across,
            || obstacles::finite_rotation(case),
            |scene| bending(scene, weigh(scene.rotation(), tolerance, "square of the largest angle")),
        );
        let axial_force_on_bending = table.decide(
            "axial_force_on_bending",
            c.axial_force_on_bending,
            across,
            || obstacles::axial_force_on_bending(finite_rotation),
            |scene| {
                let (force, drawn_in) = (scene.normal_force(), scene.drawn_in());
                bending(
                    scene,
                    if drawn_in.is_nan() || drawn_in > force {
                        weigh(drawn_in, tolerance, "how much bending draws in over the stretch")
                    } else {
                        weigh(force, tolerance, "normal force over the buckling load")
                    },
                )
            },
        );
        let axial_stretch = table.decide(
            "axial_stretch",
            c.axial_stretch,
            Ok(()),
            || obstacles::axial_stretch(case, transverse_motion, finite_rotation),
            |scene| weigh(scene.stretch(), tolerance, "stretch over how much bending draws in"),
        );
        let solid_inertia = table.decide(
            "solid_inertia",
            c.solid_inertia,
            Ok(()),
            || None,
            |scene| {
                if scene.driven() {
                    kept("driven ends act by inertia")
                } else if !scene.held() {
                    kept("the ends do not hold the beam without it")
                } else if let Some(why) = scene.unstable() {
                    kept(&why)
                } else {
                    weigh(
                        scene.bending_inertia(),
                        tolerance,
                        "inertia of bending over its stiffness",
                    )
                }
            },
        );
        let moving = if solid_inertia { Ok(()) } else { Err("no solid inertia") };
        let stretching = if axial_stretch { Ok(()) } else { Err("no axial stretch") };
        let axial_inertia = table.decide(
            "axial_inertia",
            c.axial_inertia,
            moving.and(stretching),
            || obstacles::axial_inertia(case),
            |scene| {
                let shortening = if transverse_motion { scene.shortening() } else { 0.0 };
                let number = scene.axial_waves().max(shortening);
                weigh(number, tolerance, "axial waves over the stretch without them")
            },
        );
        let rotary_inertia = table.decide(
            "rotary_inertia",
            c.rotary_inertia,
            moving.and(across),
            || None,
            |scene| {
                if scene.sudden(tolerance) {
                    kept("something acts suddenly and excites waves of every length")
                } else {
                    weigh(
                        scene.rotary(),
                        tolerance,
                        "phase of the second bending mode in the whole run",
                    )
                }
            },
        );

        let filled = if case.fluid.is_some() && case.bladders.is_some() {
            Ok(())
        } else {
            Err("no bladders, no fluid")
        };
        let given = |_: &Scene| (true, "bladders and fluid are given".into());
        let fluid = table.decide("fluid", c.fluid, filled, || None, given);
        let wet = if fluid { Ok(()) } else { Err("no fluid") };
        let flow = table.decide(
            "flow",
            c.flow,
            wet,
            || network.and_then(obstacles::flow),
            |scene| {
                let sealed = network.map_or((0, 0), |n| {
                    (n.sealed().filter(|s| *s).count(), n.component_of_bladder.len())
                });
                match sealed {
                    _ if scene.fed() => kept("ports or turbines take fluid through the network"),
                    (some, all) if some == all => {
                        (true, format!("all {all} bladders are sealed: exact without unknowns"))
                    }
                    (some, all) => {
                        let (on, why) = weigh(scene.leakage(), tolerance, "what leaks in the whole run");
                        (on, format!("{some} of {all} bladders are sealed; {why}"))
                    }
                }
            },
        );
        let flowing = wet.and(if flow { Ok(()) } else { Err("no flow") });
        let network_pressure_differences = table.decide(
            "network_pressure_differences",
            c.network_pressure_differences,
            flowing,
            || network.and_then(obstacles::network_pressure_differences),
            |_| kept("all that the fluid dissipates goes with them"),
        );
        let differing = flowing.and(if network_pressure_differences {
            Ok(())
        } else {
            Err("each network has one pressure")
        });
        let flow_along_bladders = table.decide(
            "flow_along_bladders",
            c.flow_along_bladders,
            differing,
            || None,
            |scene| match network.and_then(obstacles::network_pressure_differences) {
                Some(through) => kept(&through.what),
                None if scene.uneven_start() => kept("the start has differences along a bladder"),
                None => {
                    let number = scene.lag_along_bladders(tolerance);
                    weigh(number, tolerance, "a bladder's own time against that of the motion")
                }
            },
        );
        let bends = wet.and(across);
        let strains = |k: usize| {
            move |scene: &Scene| {
                let number = scene.strains_of_pressure()[k];
                weigh(number, tolerance, "what pressure does over what loads do")
            }
        };
        let pressure_to_curvature = table.decide(
            "pressure_to_curvature",
            c.pressure_to_curvature,
            bends,
            || None,
            strains(0),
        );
        let pressure_to_stretch = table.decide("pressure_to_stretch", c.pressure_to_stretch, wet, || None, strains(1));
        let source = |_: &Scene| kept("it is what makes pressure");
        let moment_to_area = table.decide("moment_to_area", c.moment_to_area, bends, || None, source);
        let force_to_area = table.decide("force_to_area", c.force_to_area, wet, || None, source);
        let asymmetry = table.decide(
            "asymmetry",
            c.asymmetry,
            kinked(case, fluid),
            || None,
            |scene| {
                let [m, n] = scene.asymmetries();
                weigh(m.max(n), tolerance, "larger of dm/am, dn/an")
            },
        );
        table.report(case, network);
        Self {
            transverse_motion,
            finite_rotation,
            axial_force_on_bending,
            axial_stretch,
            solid_inertia,
            axial_inertia,
            rotary_inertia,
            fluid,
            flow,
            network_pressure_differences,
            flow_along_bladders,
            pressure_to_curvature,
            pressure_to_stretch,
            moment_to_area,
            force_to_area,
            asymmetry,
            decisions: table.decisions,
            refusals: table.refusals,
        }
    }
}

/// Whether the coupling has kinks at all.
fn kinked(case: &Case, fluid: bool) -> Result<(), &'static str> {
    let reciprocal = case
        .bladders
        .as_ref()
        .is_some_and(|b| b.coupling == Coupling::Reciprocal);
    if !fluid {
        Err("no fluid")
    } else if reciprocal {
        Err("the reciprocal coupling takes mean slopes: the kinked potential is not convex")
    } else {
        Ok(())
    }
}
