//! Which effects are simulated, chosen once, each with the number that decided.
//!
//! [`TABLE`] says in words what each effect is. A new effect needs: its physics in a module of its own, a row of the
//! table, a field of [`EffectChoices`], a line in [`EffectSet::choose`], and its place in
//! [`crate::discrete::recipe::evaluate`].

mod obstacles;
mod table;

use super::{Network, Section};
use crate::case::schema::{Case, Choice, Coupling, EffectChoices, Effects, Load};
use crate::error::Violation;

use obstacles::Obstacle;
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

/// Below this relative change of the second bending frequency the automatic choice leaves rotary inertia out.
const ROTARY_THRESHOLD: f64 = 1e-3;

/// What the program chooses by itself, and why.
type Automatic = (bool, String);

fn kept() -> Automatic {
    (true, "kept unless left out by name".into())
}

impl EffectSet {
    /// Chooses the effects of a case; `network` is that of its bladders.
    pub fn choose(case: &Case, section: &Section, network: Option<&Network>) -> Self {
        let choices = match &case.effects {
            Effects::Auto | Effects::Full => &EffectChoices::default(),
            Effects::Chosen(choices) => choices,
        };
        let mut table = Decisions {
            full: case.effects == Effects::Full,
            decisions: vec![],
            refusals: vec![],
        };
        let c = choices;
        let transverse_motion = table.decide(
            "transverse_motion",
            c.transverse_motion,
            Ok(()),
            || obstacles::transverse_motion(case),
            kept(),
        );
        let across = if transverse_motion {
            Ok(())
        } else {
            Err("no transverse motion")
        };
        let finite_rotation = table.decide(
            "finite_rotation",
            c.finite_rotation,
            across,
            || obstacles::finite_rotation(case),
            kept(),
        );
        let axial_force_on_bending = table.decide(
            "axial_force_on_bending",
            c.axial_force_on_bending,
            across,
            || obstacles::axial_force_on_bending(finite_rotation),
            kept(),
        );
        let axial_stretch = table.decide(
            "axial_stretch",
            c.axial_stretch,
            Ok(()),
            || obstacles::axial_stretch(case, transverse_motion, finite_rotation),
            kept(),
        );
        let solid_inertia = table.decide("solid_inertia", c.solid_inertia, Ok(()), || None, kept());
        let moving = if solid_inertia { Ok(()) } else { Err("no solid inertia") };
        let stretching = if axial_stretch { Ok(()) } else { Err("no axial stretch") };
        let axial_inertia = table.decide(
            "axial_inertia",
            c.axial_inertia,
            moving.and(stretching),
            || obstacles::axial_inertia(case),
            kept(),
        );
        let rotary = rotary(case, section);
        let rotary_inertia = table.decide("rotary_inertia", c.rotary_inertia, moving.and(across), || None, rotary);

        let filled = if case.fluid.is_some() && case.bladders.is_some() {
            Ok(())
        } else {
            Err("no bladders, no fluid")
        };
        let given = (true, "bladders and fluid are given".into());
        let fluid = table.decide("fluid", c.fluid, filled, || None, given);
        let wet = if fluid { Ok(()) } else { Err("no fluid") };
        let sealed = network.map_or((0, 0), |n| {
            (n.sealed().filter(|s| *s).count(), n.component_of_bladder.len())
        });
        let flow = table.decide(
            "flow",
            c.flow,
            wet,
            || network.and_then(obstacles::flow),
            (
                true,
                match sealed {
                    (0, all) => format!("none of {all} bladders is sealed"),
                    (some, all) => format!("{some} of {all} bladders are sealed: exact without unknowns"),
                },
            ),
        );
        let flowing = wet.and(if flow { Ok(()) } else { Err("no flow") });
        let network_pressure_differences = table.decide(
            "network_pressure_differences",
            c.network_pressure_differences,
            flowing,
            || network.and_then(obstacles::network_pressure_differences),
            kept(),
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
            (true, "as fine as /mesh/cells_per_bladder".into()),
        );
        let bends = wet.and(across);
        let mut coupling = |name, choice, possible| table.decide(name, choice, possible, || None, kept());
        let pressure_to_curvature = coupling("pressure_to_curvature", c.pressure_to_curvature, bends);
        let pressure_to_stretch = coupling("pressure_to_stretch", c.pressure_to_stretch, wet);
        let moment_to_area = coupling("moment_to_area", c.moment_to_area, bends);
        let force_to_area = coupling("force_to_area", c.force_to_area, wet);
        let asymmetry = table.decide("asymmetry", c.asymmetry, kinked(case, fluid), || None, asymmetry(case));
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

/// Decisions as they are made.
struct Decisions {
    full: bool,
    decisions: Vec<Decision>,
    refusals: Vec<Violation>,
}

impl Decisions {
    /// Decides on one effect. Where it has no meaning (`possible` says why not) it is off, whatever was asked; where
    /// something stands against leaving it out it stays, and the case is refused if that was asked for.
    fn decide(
        &mut self,
        name: &'static str,
        choice: Choice,
        possible: Result<(), &str>,
        obstacle: impl FnOnce() -> Option<Obstacle>,
        automatic: Automatic,
    ) -> bool {
        let (on, reason) = match (possible, choice) {
            (Err(why), _) => (false, why.to_string()),
            (Ok(()), _) if self.full => (true, "full model asked for".to_string()),
            (Ok(()), Choice::Auto) => automatic,
            (Ok(()), Choice::On) => (true, "asked for".to_string()),
            (Ok(()), Choice::Off) => match obstacle() {
                Some(obstacle) => {
                    self.refusals.push(
                        Violation::new(
                            format!("/effects/{name}"),
                            format!("{name} cannot be left out: {}", obstacle.what),
                        )
                        .hint(obstacle.hint),
                    );
                    (true, format!("cannot be left out: {}", obstacle.what))
                }
                None => (false, "left out as asked".to_string()),
            },
        };
        self.decisions.push(Decision { name, on, reason });
        on
    }

    /// Effects that are there where the case gives them, and only there.
    fn report(&mut self, case: &Case, network: Option<&Network>) {
        let damping = &case.beam.damping;
        let gravity = |load: &Load| matches!(load, Load::Gravity { .. });
        let wet = self.decisions.iter().any(|d| d.name == "fluid" && d.on);
        let network = network.filter(|_| wet);
        let present = [
            (
                "damping",
                damping.axial_time_s > 0.0 || damping.bending_time_s > 0.0 || damping.drag_n_s_m2 > 0.0,
            ),
            (
                "valves",
                network.is_some_and(|n| n.links.iter().any(|l| l.opening.is_some())),
            ),
            ("turbines", network.is_some_and(|n| !n.turbines.is_empty())),
            ("loads", case.loads.iter().any(|load| !gravity(load))),
            ("gravity", case.loads.iter().any(gravity)),
        ];
        for (name, on) in present {
            let reason = if on { "given" } else { "not given" }.to_string();
            self.decisions.push(Decision { name, on, reason });
        }
    }
}

fn rotary(case: &Case, section: &Section) -> Automatic {
    let wave_number = 4.694_091_132_974 / case.beam.length_m;
    let shift = 0.5 * section.gyration_radius_squared * wave_number * wave_number;
    let on = shift >= ROTARY_THRESHOLD;
    let sign = if on { ">=" } else { "<" };
    (
        on,
        format!("second bending frequency changes by {shift:.1e} {sign} {ROTARY_THRESHOLD:.0e}"),
    )
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

fn asymmetry(case: &Case) -> Automatic {
    let reason = case.bladders.as_ref().map_or_else(String::new, |b| {
        let (m, n) = (&b.area_per_moment_m2_per_n_m, &b.area_per_force_m2_per_n);
        let ratio = |large: f64, small: f64| {
            if large + small > 0.0 {
                (large - small) / (large + small)
            } else {
                0.0
            }
        };
        format!(
            "slopes differ by dm/am = {:.3}, dn/an = {:.3}",
            ratio(m.closing, m.opening),
            ratio(n.compression, n.tension)
        )
    });
    (true, reason)
}
