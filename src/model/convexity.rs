//! Convexity of the kinked potential of bladders.

use super::audit::AuditFinding;
use super::bladder::over_compliance;
use super::{AreaLaw, CouplingLaw, Model, ROWS, Wet};
use crate::case::schema::{Bladders, Case, Coupling as Choice, Effect};
use crate::error::numbers::{quantity, significant};
use crate::error::{Code, Violation};

/// Largest sum of pressures `p_u + p_d` at which the kinked potential is convex, in bending and in stretch [Pa].
pub fn convex_up_to(model: &Model, wet: &Wet) -> (f64, f64) {
    if !model.sections.is_empty() {
        let parts = model.uniform_parts();
        let limits = parts.filter_map(|part| Some(convex_up_to(&part, part.wet.as_ref()?)));
        return limits.fold((f64::INFINITY, f64::INFINITY), |a, b| (a.0.min(b.0), a.1.min(b.1)));
    }
    let CouplingLaw::Reciprocal { length_ratio } = wet.coupling else {
        return (f64::INFINITY, f64::INFINITY);
    };
    // The rows add their concave parts, and their stiffening without flow.
    let there = wet.rows();
    let laws = || {
        wet.area
            .iter()
            .zip(there)
            .filter(|(_, there)| *there)
            .map(|(law, _)| law)
    };
    let own = wet.area.map(|law| law.per_pressure);
    let limit = |stiffness: f64, of: fn(&AreaLaw) -> [f64; 3], signs: [f64; 2]| {
        let scale = stiffness * length_ratio;
        let slopes = [0, 1].map(|row| f64::from(there[row]) * signs[row] * of(&wet.area[row])[2]);
        let stiffening = scale * over_compliance(own, wet.per_other_pressure, slopes);
        let limits = laws().map(of).filter(|[_, half_difference, _]| *half_difference > 0.0);
        let limits = limits.map(|[width, half_difference, _]| width / (scale * half_difference) * (1.0 - stiffening));
        limits.fold(f64::INFINITY, f64::min)
    };
    (
        limit(
            model.section.steepest_bending,
            |law| [law.moment_width, law.moment_half_difference, law.moment_mean],
            ROWS,
        ),
        limit(
            model.section.axial_stiffness,
            |law| [law.force_width, law.force_half_difference, law.force_mean],
            [1.0; 2],
        ),
    )
}

/// Findings about the convexity of the kinked potential.
pub(super) fn convexity(model: &Model, bladders: &Bladders, wet: &Wet) -> Vec<AuditFinding> {
    let (bending, stretch) = convex_up_to(model, wet);
    let expected = 2.0 * model.scales.pressure;
    [
        ("convex in bending up to p_u + p_d [Pa]", bending),
        ("convex in stretch up to p_u + p_d [Pa]", stretch),
    ]
    .into_iter()
    .map(|(name, value)| AuditFinding {
        code: Code::CouplingLaw,
        name,
        value,
        wanted: "above the expected pressures",
        good: value > expected,
        consequence: format!(
            "the expected p_u + p_d is {}. The kinked potential is not convex there, and the state is not unique. \
             Widen /bladders/kink_width (now {}), or use \"reciprocal\"",
            quantity(expected, "Pa", 4),
            significant(bladders.kink_width, 2)
        ),
    })
    .collect()
}

/// Errors of a case with valid text: a kinked reciprocal potential that is not convex at the expected pressures.
pub fn refusals(case: &Case, model: &Model) -> Vec<Violation> {
    let (Some(bladders), Some(wet)) = (&case.bladders, &model.wet) else {
        return vec![];
    };
    if bladders.coupling != Choice::ReciprocalKinked || !model.effects.has(Effect::Asymmetry) {
        return vec![];
    }
    convexity(model, bladders, wet)
        .into_iter()
        .filter(|f| !f.good)
        .map(|f| {
            Violation::new(
                Code::Slopes,
                "/bladders/coupling",
                format!("the kinked potential is only {}: {}", f.name, significant(f.value, 4)),
            )
            .allowed(f.wanted)
            .hint(f.consequence)
        })
        .collect()
}
