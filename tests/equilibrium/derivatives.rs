//! Derivatives with respect to numbers of the case.

use slcbeam::case::parameter::Parameter;
use slcbeam::run::equilibrium::{EquilibriumOptions, columns, differentiate, system};

use crate::common::{path_of, shipped};

/// Goal: derivatives agree with differences of complete solutions. Fourth-order differences over steps of 1e-3 and 2e-3, of solutions with
/// corrections below 1e-10: 1e-6 of the derivative.
#[test]
fn sensitivities_are_those_of_differences() {
    let columns_and_case = [
        (
            shipped("curl", &[]),
            vec![
                "/bladders/area_per_moment_m2_per_n_m/opening",
                "/beam/young_modulus_pa",
                "/network/chains/0/ends/0/pressure_pa/ramp/to",
                "/beam/length_m",
            ],
        ),
        (
            shipped(
                "pluck",
                &[
                    "/start/equilibrium/loads_at_s=0",
                    "/ends/tip={\"free\":{\"force_x_n\":1}}",
                ],
            ),
            vec![
                "/ends/tip/free/force_x_n",
                "/tubes/permeability_m4",
                "/bladders/area_per_pressure_m2_per_pa",
            ],
        ),
    ];
    for (case, pointers) in columns_and_case {
        let options = EquilibriumOptions::at(case.time.end_s);
        let base = path_of(&case, &options);
        let names = columns(&system(&case, options.at_s).unwrap());
        let parameters: Vec<Parameter> = pointers
            .iter()
            .map(|p| Parameter::find(&case, p).expect("a number"))
            .collect();
        let found = differentiate(&case, &options, &base, &parameters).expect("derivatives");
        for s in found {
            let at = |steps: f64| {
                let value = s.parameter.value * (1.0 + 1e-3 * steps);
                let changed = s.parameter.changed(&case, value).expect("a valid case");
                path_of(&changed, &options).last().row.clone()
            };
            let rows = [at(1.0), at(-1.0), at(2.0), at(-2.0)];
            // reactions of a beam bent only by pressure are rounding errors
            let round_off = |k: usize| names[k].name.starts_with("reaction_") && base.last().row[k].abs() < 1e-9;
            for k in (0..base.last().row.len()).filter(|k| !round_off(*k)) {
                let difference =
                    (8.0 * (rows[0][k] - rows[1][k]) - (rows[2][k] - rows[3][k])) / (12e-3 * s.parameter.value);
                // Rounding errors scale with the largest value of the unit: for a vented bladder's pressure, with the other pressures.
                let alike = |j: &usize| names[*j].unit == names[k].unit && names[*j].name != "load_factor";
                let largest = (0..names.len())
                    .filter(alike)
                    .map(|j| base.last().row[j].abs())
                    .fold(0.0, f64::max);
                let size = largest / s.parameter.value.abs();
                let error = (s.row[k] - difference).abs();
                assert!(
                    error <= 1e-6 * difference.abs() + 1e-7 * size,
                    "{} {k}: {} {difference}",
                    s.parameter.pointer,
                    s.row[k]
                );
            }
        }
    }
}

/// Goal: a number without a derivative is rejected with one sentence.
#[test]
fn parameters_that_are_none_are_refused() {
    let case = shipped("curl", &[]);
    for (pointer, words) in [
        ("/bladders/per_row", "count"),
        ("/solver/rtol", "not a part of the model"),
        ("/fluid/viscosity", "/fluid/viscosity_pa_s"),
        ("/ends/tip", "no number"),
        ("/network/chains/1/ends/0/pressure_pa", "it is 0"),
    ] {
        let error = Parameter::find(&case, pointer).expect_err("refused").to_string();
        assert!(error.contains(words), "{pointer}: {error}");
    }
}
