//! Unknowns and stored entries of the Jacobian, in closed form: what is left out is gone.

use slcbeam::dae::{BeamDae, Dae};
use slcbeam::discrete::System;

use super::common::shipped;

/// Effects, coefficients of the unknowns in m, s, s k and 1, and of the stored entries in m, m k, s, s k, k and 1, with
/// m = K S cells of the beam, s = S segments and k >= 3 volumes a bladder.
type Row = (&'static str, [i64; 4], [i64; 6]);

const SIZES: &[Row] = &[
    ("{}", [4, 2, 2, 0], [44, 4, 36, 30, -16, -68]),
    (r#"{"rotary_inertia":"off"}"#, [4, 2, 2, 0], [34, 4, 36, 30, -16, -60]),
    (r#"{"solid_inertia":"off"}"#, [2, 2, 2, 0], [28, 4, 36, 30, -16, -60]),
    (r#"{"finite_rotation":"off"}"#, [4, 2, 2, 0], [29, 4, 29, 26, -12, -43]),
    (
        r#"{"finite_rotation":"off","rotary_inertia":"off"}"#,
        [4, 2, 2, 0],
        [27, 4, 29, 26, -12, -41],
    ),
    (
        r#"{"finite_rotation":"off","axial_force_on_bending":"off","rotary_inertia":"off"}"#,
        [4, 2, 2, 0],
        [20, 4, 28, 26, -12, -36],
    ),
    (
        r#"{"finite_rotation":"off","axial_force_on_bending":"off","rotary_inertia":"off","fluid":"off"}"#,
        [4, 0, 0, 0],
        [14, 0, 0, 0, 0, -8],
    ),
    (
        r#"{"axial_inertia":"off","rotary_inertia":"off"}"#,
        [3, 2, 2, 0],
        [31, 4, 36, 30, -16, -60],
    ),
    (
        r#"{"axial_inertia":"off","finite_rotation":"off","rotary_inertia":"off"}"#,
        [3, 2, 2, 0],
        [24, 4, 29, 26, -12, -41],
    ),
    (
        r#"{"axial_inertia":"off","transverse_motion":"off"}"#,
        [1, 1, 2, 0],
        [5, 2, 7, 12, -2, -12],
    ),
    (
        r#"{"axial_inertia":"off","fluid":"off","rotary_inertia":"off"}"#,
        [3, 0, 0, 0],
        [23, 0, 0, 0, 0, -24],
    ),
    (
        r#"{"axial_stretch":"off","finite_rotation":"off","rotary_inertia":"off"}"#,
        [2, 1, 2, 0],
        [10, 2, 13, 20, -10, -22],
    ),
    (
        r#"{"axial_stretch":"off","finite_rotation":"off","rotary_inertia":"off","fluid":"off"}"#,
        [2, 0, 0, 0],
        [8, 0, 0, 0, 0, -6],
    ),
    (r#"{"transverse_motion":"off"}"#, [2, 1, 2, 0], [8, 2, 7, 12, -2, -12]),
    (
        r#"{"fluid":"off","rotary_inertia":"off"}"#,
        [4, 0, 0, 0],
        [26, 0, 0, 0, 0, -24],
    ),
    (
        r#"{"fluid":"off","transverse_motion":"off"}"#,
        [2, 0, 0, 0],
        [6, 0, 0, 0, 0, -2],
    ),
    (
        r#"{"flow":"off","rotary_inertia":"off"}"#,
        [4, 2, 0, 0],
        [34, 0, 28, 0, 0, -48],
    ),
    (
        r#"{"network_pressure_differences":"off","rotary_inertia":"off"}"#,
        [4, 2, 0, 2],
        [38, 0, 28, 0, 0, -40],
    ),
    (
        r#"{"network_pressure_differences":"off","moment_to_area":"off","force_to_area":"off","rotary_inertia":"off"}"#,
        [4, 0, 0, 2],
        [30, 0, 0, 0, 0, -22],
    ),
    (
        r#"{"flow_along_bladders":"off","rotary_inertia":"off"}"#,
        [4, 4, 0, 0],
        [38, 0, 66, 0, 0, -76],
    ),
    (
        r#"{"moment_to_area":"off","rotary_inertia":"off"}"#,
        [4, 1, 2, 0],
        [30, 4, 13, 22, -12, -40],
    ),
    (
        r#"{"force_to_area":"off","rotary_inertia":"off"}"#,
        [4, 1, 2, 0],
        [30, 4, 19, 26, -16, -46],
    ),
    (
        r#"{"pressure_to_curvature":"off","rotary_inertia":"off"}"#,
        [4, 2, 2, 0],
        [34, 4, 23, 16, -4, -48],
    ),
    (
        r#"{"pressure_to_stretch":"off","rotary_inertia":"off"}"#,
        [4, 2, 2, 0],
        [34, 4, 35, 28, -16, -60],
    ),
];

/// A cantilever whose upper bladders are one closed chain and the lower ones another: unknowns and stored entries.
fn count(cells: i64, segments: i64, volumes: i64, effects: &str) -> (i64, i64) {
    let row = |sign: i64| (1..=segments).map(|b| (sign * b).to_string()).collect::<Vec<_>>();
    let chain = |sign: i64| format!(r#"{{"bladders":[{}]}}"#, row(sign).join(","));
    let sets = [
        format!("/bladders/per_row={segments}"),
        format!(r#"/network={{"chains":[{},{}]}}"#, chain(1), chain(-1)),
        format!("/mesh/cells_per_segment={cells}"),
        format!("/mesh/cells_per_bladder={volumes}"),
        format!("/effects={}", creeping(effects)),
        r#"/bladders/coupling="reciprocal""#.into(),
        r#"/formulation="conservative""#.into(),
    ];
    let dae = BeamDae::new(System::new(&shipped("wiring-2", &sets)).unwrap());
    (dae.len() as i64, dae.pattern().entries() as i64)
}

/// Flow in tubes creeps: what it brings otherwise is counted in `tests/laws/tubes.rs`.
fn creeping(effects: &str) -> String {
    let off = r#""tube_inertia":"off","tube_losses":"off""#;
    match effects {
        "{}" => format!("{{{off}}}"),
        named => named.replacen('{', &format!("{{{off},"), 1),
    }
}

#[test]
fn unknowns_and_entries_are_those_of_the_effects() {
    for (effects, unknowns, entries) in SIZES {
        for (cells, s, k) in [(2, 3, 3), (4, 5, 4), (3, 6, 5)] {
            let m = cells * s;
            let sum =
                |coefficients: &[i64], of: &[i64]| -> i64 { coefficients.iter().zip(of).map(|(c, x)| c * x).sum() };
            let expected = (
                sum(unknowns, &[m, s, s * k, 1]),
                sum(entries, &[m, m * k, s, s * k, k, 1]),
            );
            let found = count(cells, s, k, effects);
            println!(
                "{effects}, m = {m}, s = {s}, k = {k}: {} unknowns, {} entries",
                found.0, found.1
            );
            assert_eq!(found, expected, "{effects}, m = {m}, s = {s}, k = {k}");
        }
    }
}
