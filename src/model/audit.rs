//! Audit of the coupling and of the model's validity limits when a case is read (`docs/model.md` section 4).

use std::collections::BTreeMap;

use super::bladder::over_compliance;
use super::convexity::convexity;
pub use super::convexity::{convex_up_to, refusals};
use super::{CouplingLaw, Model, ROWS, Wet, water_hammer};
use crate::case::numbers::digits;
use crate::case::schema::Effect;
use crate::case::schema::{Case, Coupling as Choice};
use crate::case::{inherited, overshoots, spans};
use crate::error::Code;
use crate::error::numbers::significant;

/// One audited number.
#[derive(Clone, Debug, PartialEq)]
pub struct AuditFinding {
    /// Code of its warning.
    pub code: Code,
    /// Name in the table of `slcbeam check`.
    pub name: &'static str,
    /// Value.
    pub value: f64,
    /// Required range, in words.
    pub wanted: &'static str,
    /// True if the value is in the required range.
    pub good: bool,
    /// Consequence of a value outside the range.
    pub consequence: String,
}

/// `[E21]` Reciprocity ratios, asymmetries, passivity and solvability of the coupling.
///
/// ```text
/// l_b am E/ψ' = 1, l_b an E/ζ' = 1                                       energy is conserved
/// EA φ_b l_b aN+·C⁻¹aN+ < 1,  EI φ_b l_b R aM·C⁻¹R aM < 1                passive, C = [a_p a_x; a_x a_p] of the rows
/// 1 - 2 EI φ_b ψ' am/(E a_p) > 0,  1 - 2 EA φ_b ζ' aN+/(E a_p) > 0       published law solvable
/// d_M ≥ EI φ_b l_b dm p_max/(1 - 2 EI φ_b l_b am²/a_p)                   kinked potential convex
/// ```
pub fn coupling(case: &Case, model: &Model) -> Vec<AuditFinding> {
    let (Some(bladders), Some(wet)) = (&case.bladders, &model.wet) else {
        return vec![];
    };
    if !model.sections.is_empty() {
        let parts = spans::uniform_cases(case).filter(|(segment, ..)| model.has_bladders(*segment));
        return worst(parts.flat_map(|(segment, _, uniform)| coupling(&uniform, &model.uniform_part(segment))));
    }
    let (m, n) = (&bladders.area_per_moment_m2_per_n_m, &bladders.area_per_force_m2_per_n);
    let (am, an) = (0.5 * (m.opening + m.closing), 0.5 * (n.tension + n.compression));
    let (ea, ei) = (model.section.axial_stiffness, model.section.steepest_bending);
    let ratio = wet.bladder_length * bladders.per_row as f64 / model.length;
    let ap = bladders.area_per_pressure_m2_per_pa;
    let mut found = Vec::new();
    if let Choice::Published(c) = &bladders.coupling {
        let e = case.beam.young_modulus_pa;
        let moment = wet.bladder_length * am * e / c.slope_per_pressure_rad;
        let force = wet.bladder_length * an * e / c.length_per_pressure_m;
        found.push(reciprocity("l_b am E/psi'", moment, "bending"));
        found.push(reciprocity("l_b an E/zeta'", force, "stretch"));
    }
    for (name, large, small) in [("dm/am", m.closing, m.opening), ("dn/an", n.compression, n.tension)] {
        let value = if large + small > 0.0 {
            (large - small) / (large + small)
        } else {
            0.0
        };
        found.push(AuditFinding {
            code: Code::CouplingLaw,
            name,
            value,
            wanted: "0 or more, below 1",
            good: (0.0..1.0).contains(&value),
            consequence: "the closing slope must be at least the opening slope".into(),
        });
    }
    let (along, across) = sealed_stiffening(case, wet);
    for (name, value, what) in [
        ("1/(EA phi_b l_b sum aN+^2/a_p)", 1.0 / (ea * ratio * along), "axial"),
        ("1/(EI phi_b l_b sum aM^2/a_p)", 1.0 / (ei * ratio * across), "bending"),
    ] {
        if value.is_finite() {
            found.push(AuditFinding {
                code: Code::CouplingLaw,
                name,
                value,
                wanted: "above 1",
                good: value > 1.0,
                consequence: format!(
                    "the {what} stiffness with sealed bladders is negative. The coupling is not passive, and any state grows"
                ),
            });
        }
    }
    solvability(model, wet, ap, am, n.compression, &mut found);
    if bladders.coupling == Choice::ReciprocalKinked && model.effects.has(Effect::Asymmetry) {
        found.extend(convexity(model, bladders, wet));
    }
    found
}

/// `aN+ · C⁻¹ aN+` and `R aM · C⁻¹ R aM`, C the areas per pressure of both rows; the moment closes one row and opens the other.
fn sealed_stiffening(case: &Case, wet: &Wet) -> (f64, f64) {
    let rows = [case.bladders.clone(), spans::lower_bladders(case)];
    let (mut own, mut along, mut across) = ([1.0; 2], [0.0; 2], [[0.0; 2]; 2]);
    for (k, (row, there)) in rows.iter().zip(wet.rows()).enumerate() {
        let Some(row) = row.as_ref().filter(|_| there) else {
            continue;
        };
        let (m, n) = (&row.area_per_moment_m2_per_n_m, &row.area_per_force_m2_per_n);
        own[k] = row.area_per_pressure_m2_per_pa;
        along[k] = n.compression;
        across[k][k] = ROWS[k] * m.closing;
        across[1 - k][k] = ROWS[k] * m.opening;
    }
    let stiffening = |slopes| over_compliance(own, wet.per_other_pressure, slopes);
    (stiffening(along), stiffening(across[0]).max(stiffening(across[1])))
}

/// One finding of each name: the first that is not good, or the first.
fn worst(findings: impl Iterator<Item = AuditFinding>) -> Vec<AuditFinding> {
    let mut all: Vec<AuditFinding> = vec![];
    for one in findings {
        match all.iter_mut().find(|other| other.name == one.name) {
            Some(other) if other.good && !one.good => *other = one,
            Some(_) => {}
            None => all.push(one),
        }
    }
    all
}

fn reciprocity(name: &'static str, value: f64, what: &str) -> AuditFinding {
    AuditFinding {
        code: Code::Reciprocity,
        name,
        value,
        wanted: "1 within 10 %",
        good: (0.9..=1.1).contains(&value),
        consequence: format!(
            "pressure and {what} do not share one potential ({what} returns {value:.4} times the work of the fluid over \
             a cycle)"
        ),
    }
}

/// One warning for all violated reciprocity conditions.
fn not_reciprocal(findings: &[&AuditFinding]) -> Option<String> {
    let first = findings.first()?;
    let returned = findings.iter().zip([" returns", ""]).map(|(f, verb)| {
        let part = if f.name.contains("psi") { "bending" } else { "stretch" };
        match f.value.is_infinite() {
            true => format!("{part}{verb} infinitely many times"),
            false => format!("{part}{verb} {} times", significant(f.value, 3)),
        }
    });
    let mut returned = returned.collect::<Vec<_>>().join(", and ");
    if findings.len() > 1 {
        returned.push(',');
    }
    Some(first.code.warning(format!(
        "coupling: over a cycle {returned} the work of the fluid (required: {}). Energies and efficiencies are not \
         valid, and motion may differ. Use --set '/bladders/coupling=\"reciprocal\"'",
        first.wanted
    )))
}

fn solvability(model: &Model, wet: &Wet, ap: f64, am: f64, compression: f64, found: &mut Vec<AuditFinding>) {
    let CouplingLaw::Published {
        stretch_per_pressure,
        curvature_per_pressure,
    } = wet.coupling
    else {
        return;
    };
    let (ea, ei) = (model.section.axial_stiffness, model.section.steepest_bending);
    // rows are pressed against each other by moments, alike by forces
    let cross = wet.per_other_pressure;
    for (name, value) in [
        (
            "1 - 2 EI phi_b psi' am/(E a_p)",
            1.0 - 2.0 * ei * curvature_per_pressure * am / (ap - cross),
        ),
        (
            "1 - 2 EA phi_b zeta' aN+/(E a_p)",
            1.0 - 2.0 * ea * stretch_per_pressure * compression / (ap + cross),
        ),
    ] {
        found.push(AuditFinding {
            code: Code::CouplingLaw,
            name,
            value,
            wanted: "above 0",
            good: value > 0.0,
            consequence: "the published law has no unique solution, so the state is undetermined".into(),
        });
    }
}

/// Warnings before a run: those of [`lasting`], and estimates beyond the validity limits, which a run measures instead.
pub fn warnings(case: &Case, model: &Model, numbers: &BTreeMap<String, f64>) -> Vec<String> {
    let mut all = lasting(case, model, numbers);
    if !model.effects.has(Effect::TubeLosses) {
        let what = "Flow in the tubes may not be creeping";
        all.extend(over(
            numbers,
            Code::FastFlow,
            ["reynolds_estimate", "the Reynolds number expected in the tubes"],
            100.0,
            what,
        ));
    }
    all.extend(over(
        numbers,
        Code::Strain,
        ["largest_strain_estimate", "the expected strain"],
        0.5,
        "Linear elasticity may not be valid locally",
    ));
    all
}

/// Warning about a characteristic number (name, description) above its limit.
fn over(
    numbers: &BTreeMap<String, f64>,
    code: Code,
    [name, words]: [&str; 2],
    limit: f64,
    what: &str,
) -> Option<String> {
    let value = numbers.get(name).filter(|value| **value > limit)?;
    Some(code.warning(format!(
        "range of the model: {words} is {} (limit {limit}). {what}",
        significant(*value, 3)
    )))
}

/// Fewest output times in the window for accurate derivatives of root mean squares.
const OUTPUTS_A_WINDOW: f64 = 10.0;
/// Fewest output times in a drive period that resolve its peaks.
const OUTPUTS_A_PERIOD: f64 = 10.0;

/// Warns that a run with sensitivities has too few output times in the window: derivatives of root mean squares use
/// only these.
pub fn derivatives(case: &Case) -> Option<String> {
    let within = case.time.window() / case.time.output_interval();
    (within < OUTPUTS_A_WINDOW).then(|| {
        Code::FewOutputs.warning(format!(
            "output: {within:.1} output times in the window ({OUTPUTS_A_WINDOW} are needed). Only these enter the derivatives of its root mean \
             squares. Reduce /time/output_interval_s"
        ))
    })
}

/// Warnings that do not depend on the results of a run: failed findings, and characteristic numbers beyond the validity
/// limits.
pub fn lasting(case: &Case, model: &Model, numbers: &BTreeMap<String, f64>) -> Vec<String> {
    let findings = coupling(case, model);
    let (twofold, others): (Vec<_>, Vec<_>) = findings
        .iter()
        .filter(|f| !f.good)
        .partition(|f| f.code == Code::Reciprocity);
    let mut all: Vec<String> = not_reciprocal(&twofold).into_iter().collect();
    all.extend(others.into_iter().map(|f| {
        f.code.warning(format!(
            "coupling: {} = {:.4}, required {}: {}",
            f.name, f.value, f.wanted, f.consequence
        ))
    }));
    all.extend(inherited::warnings(case));
    for (at, by) in overshoots(case) {
        all.push(Code::Overshoot.warning(format!(
            "{at}: the spline overshoots the points of its table by {:.0} % of the range of their values. Use \"interpolation\": \"monotone\" \
             or \"linear\", which stay within the points",
            (100.0 * by).max(1.0)
        )));
    }
    if !model.effects.has(Effect::TubeInertia) {
        let what = "Oscillating flow in the tubes is not creeping, but the model leaves out its inertia. Pressures are \
                    estimates. Use --set '/effects/tube_inertia=\"on\"'";
        all.extend(over(
            numbers,
            Code::FastFlow,
            ["womersley", "the Womersley number of the tubes"],
            1.0,
            what,
        ));
    }
    all.extend(stream(model));
    all.extend(water_hammer::warnings(case, model));
    if let Some(&f) = numbers.get("forcing_frequency_hz") {
        let outputs = 1.0 / (f * case.time.output_interval());
        if outputs < OUTPUTS_A_PERIOD {
            all.push(Code::FewOutputs.warning(format!(
                "output: {outputs:.1} output times in a period of the drive at {} Hz ({OUTPUTS_A_PERIOD} are needed). Written histories and fields \
                 miss its peaks. Reduce /time/output_interval_s",
                digits(f)
            )));
        }
    }
    if let Some(&bound) = numbers.get("mathieu_growth_bound_per_s")
        && let Some(&rate) = numbers.get("mathieu_growth_rate_per_s")
        && bound.max(rate) > 0.0
    {
        all.push(Code::Mathieu.warning(format!(
            "the root's axial motion lies inside a Mathieu tongue of the first bending mode, or at its edge. Any deflection may \
             grow at up to {:.3} 1/s (estimate for the first mode without damping and fluid; {rate:.3} 1/s for an \
             inextensible axis). Compute the stability with `slcbeam floquet CASE`",
            bound.max(rate)
        )));
    }
    let (limit, remedy) = match model.effects.has(Effect::Shear) {
        true => (2.0, "Use"),
        false => (4.0, "Add /beam/shear_stiffness_n, or use"),
    };
    if let Some(slender) = numbers.get("slenderness").filter(|slender| **slender < limit) {
        all.push(Code::Stocky.warning(format!(
            "range of the model: length over height is {slender:.2} (a rod model is valid from 5, from 2 with shear). \
             Results are estimates. {remedy} a 3-D model"
        )));
    }
    all
}

/// Warnings about streams that the model covers only in part.
fn stream(model: &Model) -> Vec<String> {
    let Some([across, along]) = model.surroundings.as_ref().and_then(|around| around.stream.as_ref()) else {
        return vec![];
    };
    let mut all = vec![];
    if !along.is_zero() && model.section.ambient.added_mass > 0.0 && model.effects.has(Effect::SolidInertia) {
        all.push(Code::PartOfStream.warning(
            "a stream along the beam: the model leaves out half of its first-order force on the moving beam. Growth, flutter and damping by the \
             stream are not reliable",
        ));
    }
    if model.section.ambient.drag == 0.0 && !across.is_zero() {
        all.push(Code::PartOfStream.warning(
            "a stream across the beam without drag (/surroundings/drag_coefficient is 0): only its acceleration acts on the beam. Give a coefficient \
             (2 for a plate)",
        ));
    }
    all
}
