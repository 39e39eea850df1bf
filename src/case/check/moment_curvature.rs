//! Checks of moment-curvature laws: points of an increasing curve through zero, and settings of which the equations are linear in bending.

use crate::case::faults::Violations;
use crate::case::numbers::plain;
use crate::case::schema::{Case, Formulation, MomentCurvature};
use crate::case::spans;
use crate::error::numbers::significant;
use crate::error::{Code, Violation};

/// Least slope between two points over the largest; a flatter law has no unique curvature.
const FLATTEST: f64 = 1e-6;

/// Accepted range of `EI` by the slope at zero over that of the full section, as for `bending_stiffness_factor`.
const FACTORS: [f64; 2] = [1e-6, 1e5];

pub(super) fn check(case: &Case, faults: &mut Violations) {
    let beam = &case.beam;
    if let Some(law) = &beam.moment_curvature {
        points(law, "/beam/moment_curvature", faults);
        if beam.bending_stiffness_factor != 1.0 {
            twofold("/beam/bending_stiffness_factor", "set it to 1", faults);
        }
        let factor = beam.bending_factor();
        if faults.is_empty() && !(FACTORS[0]..=FACTORS[1]).contains(&factor) {
            let what = format!(
                "the slope at zero is {} times the bending stiffness of the full section",
                significant(factor, 2)
            );
            let fault = Violation::new(Code::Implausible, "/beam/moment_curvature", what);
            let fault = fault.allowed(format!("{} to {}", FACTORS[0], FACTORS[1]));
            faults.push_beside(
                &["/beam/young_modulus_pa", "/beam/height_m", "/beam/width_m"],
                fault.hint("curvatures are in 1/m, moments in N m; is this in N mm?"),
            );
        }
    }
    for (k, span) in case.spans.iter().enumerate() {
        let at = format!("/spans/{k}/beam");
        if let Some(law) = &span.beam.moment_curvature {
            points(law, &format!("{at}/moment_curvature"), faults);
        }
        let bends = span.beam.moment_curvature.is_some() || beam.moment_curvature.is_some();
        if bends && span.beam.bending_stiffness_factor.is_some() {
            twofold(&format!("{at}/bending_stiffness_factor"), "remove it", faults);
        }
    }
    if !spans::bends_nonlinearly(case) {
        return;
    }
    let mut refuse = |pointer: &str, what: &str, hint: &str| {
        let what = format!("{what} with a moment-curvature law");
        faults.push(Violation::new(Code::Together, pointer, what).hint(hint));
    };
    if case.formulation == Formulation::Published {
        refuse("/formulation", "the published form", "use \"conservative\"");
    }
    if case
        .bladders
        .as_ref()
        .is_some_and(|bladders| bladders.strain_energy.is_some())
    {
        let hint = "remove one of them: both describe the nonlinear section";
        refuse("/bladders/strain_energy", "an energy at finite strain", hint);
    }
}

/// Rejects a factor of the bending stiffness beside a law.
fn twofold(pointer: &str, hint: &str, faults: &mut Violations) {
    let what = "a factor of the bending stiffness beside a moment-curvature law";
    let fault = Violation::new(Code::Together, pointer, what);
    faults.push(fault.hint(format!("{hint}: the slope of the law at zero is the bending stiffness")));
}

/// Checks the points of a law.
fn points(law: &MomentCurvature, at: &str, faults: &mut Violations) {
    let (curvatures, moments) = (&law.curvature_1_m, &law.moment_n_m);
    if curvatures.len() != moments.len() {
        let what = format!("{} curvatures for {} moments", curvatures.len(), moments.len());
        let fault = Violation::new(Code::Count, format!("{at}/curvature_1_m"), what);
        faults.push(fault.allowed(moments.len().to_string()));
        return;
    }
    if let Some(k) = curvatures.windows(2).position(|pair| pair[0] >= pair[1]) {
        let what = format!(
            "curvature {} after curvature {}",
            plain(curvatures[k + 1]),
            plain(curvatures[k])
        );
        let fault = Violation::new(Code::Range, format!("{at}/curvature_1_m/{}", k + 1), what);
        faults.push(fault.allowed("ascending curvatures"));
        return;
    }
    let zero = curvatures.iter().position(|curvature| *curvature == 0.0);
    match zero {
        Some(k) if moments[k] != 0.0 => {
            let what = format!("moment {} at curvature 0", plain(moments[k]));
            let fault = Violation::new(Code::Range, format!("{at}/moment_n_m/{k}"), what).allowed("0");
            faults.push(fault.hint("give a curvature without load as a load of the kind rest_curvature_1_m"));
        }
        Some(k) if k + 1 < curvatures.len() => {}
        _ => {
            let fault = Violation::new(
                Code::Range,
                format!("{at}/curvature_1_m"),
                "no curvature 0 before others",
            );
            faults.push(fault.allowed("0 and larger curvatures, or curvatures of both signs with 0"));
        }
    }
    let pieces = || curvatures.windows(2).zip(moments.windows(2));
    let slopes = || pieces().map(|(x, y)| (y[1] - y[0]) / (x[1] - x[0]));
    let least = FLATTEST * slopes().fold(0.0, f64::max);
    if let Some(k) = slopes().position(|slope| slope <= 0.0 || slope < least) {
        let slope = (moments[k + 1] - moments[k]) / (curvatures[k + 1] - curvatures[k]);
        let what = format!(
            "moment {} after moment {}: a slope of {} N m^2, below a millionth of the steepest one",
            plain(moments[k + 1]),
            plain(moments[k]),
            significant(slope, 3)
        );
        let fault = Violation::new(Code::Range, format!("{at}/moment_n_m/{}", k + 1), what);
        let fault = fault.allowed(format!(
            "rising moments, here at least {} N m",
            significant(moments[k] + least.max(0.0) * (curvatures[k + 1] - curvatures[k]), 8)
        ));
        faults.push(fault.hint("give a plateau a small slope; falling moments (snap-through) are not available"));
    } else if !law
        .curve()
        .is_some_and(|curve| curve.rates().iter().all(|rate| rate.is_finite()))
    {
        let fault = Violation::new(
            Code::Range,
            format!("{at}/curvature_1_m"),
            "curvatures too close to each other",
        );
        faults.push(fault.hint("curvatures are in 1/m"));
    }
}
