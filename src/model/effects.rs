//! Which effects are simulated, chosen once, each with the number that decided.

use super::Section;
use crate::case::schema::{Case, Choice, Coupling, EffectChoices, Effects};

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
    /// Inertia of the section's rotation.
    pub rotary_inertia: bool,
    /// Inertia of the solid.
    pub solid_inertia: bool,
    /// Different opening and closing slopes of the bladder area.
    pub asymmetry: bool,
    /// Every decision, in a fixed order.
    pub decisions: Vec<Decision>,
}

/// Below this relative change of the second bending frequency the automatic choice leaves rotary inertia out.
const ROTARY_THRESHOLD: f64 = 1e-3;

impl EffectSet {
    /// Chooses the effects of a case.
    pub fn choose(case: &Case, section: &Section) -> Self {
        let choices = match &case.effects {
            Effects::Auto => EffectChoices::default(),
            Effects::Full => EffectChoices {
                rotary_inertia: Choice::On,
                solid_inertia: Choice::On,
                asymmetry: Choice::On,
            },
            Effects::Chosen(choices) => choices.clone(),
        };
        let full = case.effects == Effects::Full;
        let asked = |choice: Choice| {
            if full {
                "full model asked for"
            } else if choice == Choice::On {
                "asked for"
            } else {
                "left out as asked"
            }
        };
        let mut decisions = Vec::new();
        let mut decide = |name, choice: Choice, auto: (bool, String), possible: Result<(), &str>| {
            let (on, reason) = match (possible, choice) {
                (Err(why), _) => (false, why.to_string()),
                (Ok(()), Choice::Auto) => auto,
                (Ok(()), _) => (choice == Choice::On, asked(choice).to_string()),
            };
            decisions.push(Decision { name, on, reason });
            on
        };

        let fluid = case.fluid.is_some() && case.bladders.is_some();
        decide(
            "fluid",
            Choice::Auto,
            (
                fluid,
                if fluid {
                    "bladders and fluid are given"
                } else {
                    "no bladders, no fluid"
                }
                .into(),
            ),
            Ok(()),
        );
        let solid_inertia = decide(
            "solid_inertia",
            choices.solid_inertia,
            (true, "kept unless left out by name".into()),
            Ok(()),
        );
        let wave_number = 4.694_091_132_974 / case.beam.length_m;
        let shift = 0.5 * section.gyration_radius_squared * wave_number * wave_number;
        let rotary_inertia = decide(
            "rotary_inertia",
            choices.rotary_inertia,
            (
                shift >= ROTARY_THRESHOLD,
                format!(
                    "second bending frequency changes by {shift:.1e} {} {ROTARY_THRESHOLD:.0e}",
                    if shift >= ROTARY_THRESHOLD { ">=" } else { "<" }
                ),
            ),
            if solid_inertia { Ok(()) } else { Err("no solid inertia") },
        );
        let kinked = case
            .bladders
            .as_ref()
            .is_some_and(|b| b.coupling != Coupling::Reciprocal);
        let possible = if !fluid {
            Err("no fluid")
        } else if !kinked {
            Err("the reciprocal coupling takes mean slopes: the kinked potential is not convex")
        } else {
            Ok(())
        };
        let asymmetry = decide("asymmetry", choices.asymmetry, (true, asymmetry_reason(case)), possible);
        let damping = &case.beam.damping;
        let damped = damping.axial_time_s > 0.0 || damping.bending_time_s > 0.0 || damping.drag_n_s_m2 > 0.0;
        decide(
            "damping",
            Choice::Auto,
            (
                damped,
                if damped { "damping is given" } else { "no damping given" }.into(),
            ),
            Ok(()),
        );
        Self {
            rotary_inertia,
            solid_inertia,
            asymmetry,
            decisions,
        }
    }
}

fn asymmetry_reason(case: &Case) -> String {
    case.bladders.as_ref().map_or_else(String::new, |b| {
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
    })
}
