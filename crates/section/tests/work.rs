//! Cost of one section's coefficients in unknowns: half a second of one core corresponds to about 50 000 on the finest
//! mesh.

mod common;

use common::paper;
use slcbeam_section::coefficients::Options;

/// Goal: errors of 1e-3 in every coefficient of the paper's cell with this number of unknowns. Measured: 34 636
/// unknowns with sharp corners, 6716 with rounded ones, in 0.2 s and 0.06 s.
#[test]
fn errors_of_a_thousandth_take_few_unknowns() {
    for (fillet, most) in [(0.0, 45_000), (0.0025, 9_000)] {
        let c = paper(0.49, fillet).coefficients(&Options::default()).unwrap();
        let e = &c.errors;
        let all = [
            e.axial_stiffness_factor,
            e.bending_stiffness_factor,
            e.area_per_pressure_m2_per_pa,
            e.area_per_moment_m2_per_n_m,
            e.area_per_force_m2_per_n,
            e.shear_stiffness_n,
            e.permeability_m4,
        ];
        println!("fillet {fillet}: {} unknowns, {all:?}", c.unknowns);
        assert!(
            c.unknowns < most && all.iter().all(|e| *e < 1e-3),
            "{} {all:?}",
            c.unknowns
        );
    }
}
