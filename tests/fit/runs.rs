//! How often intervals of fits of runs hold the truth.

use crate::common::*;

const CASE: &str = "cases/two-bladders.json";
const TUBE: &str = "/tubes/permeability_m4";
const FIRST: &str = "/start/pressures/0/pressure_pa";
const COARSE: [&str; 2] = ["/mesh/cells_per_segment=1", "/mesh/cells_per_bladder=1"];

/// Sets of 54 pressures of two bladders that meet, with noise that is found from the fit: their time constant by the tube's permeability, and where
/// they begin. How many intervals of 95 % hold the truth, of each of the two.
fn held(seeds: u64) -> [u32; 2] {
    let case = load(CASE, &COARSE);
    let probed = load(
        CASE,
        &[&COARSE[..], &["/probes=[{\"name\": \"p\", \"at\": 0.5}]"]].concat(),
    );
    let truth = [9e-13, 1000.0];
    let memory = run(&probed, &[(TUBE, truth[0]), (FIRST, truth[1])]);
    let [times, upper, lower] =
        ["t", "p_pressure_upper", "p_pressure_lower"].map(|name| memory.column(name).expect("a column"));
    let asked = by_squares(
        &[(TUBE, 1e-13, 1e-11), (FIRST, 200.0, 5000.0)],
        &["first_pa=pressure@bladder 1", "second_pa=pressure@bladder -1"],
    );
    let mut held = [0; 2];
    for seed in 0..seeds {
        let mut noise = noise(500 + seed);
        let mut text = String::from("t_s,first_pa,second_pa\n");
        for k in (3..times.len()).step_by(37) {
            text += &format!(
                "{},{},{}\n",
                times[k],
                upper[k] + 5.0 * noise(),
                lower[k] + 5.0 * noise()
            );
        }
        count_held(&case, &asked, &text, truth, &mut held);
    }
    println!("held {held:?} of {seeds}");
    held
}

/// Goal: 92 to 98 of 100, as of equilibria: of 200 draws from 95 % less than 184 or more than 196 come in 3 and 2 of 100; of the seeds here they do not.
#[test]
#[ignore = "a minute"]
fn intervals_of_runs_hold_the_truth_as_often_as_they_say() {
    let held = held(200);
    assert!(held.iter().all(|held| (184..=196).contains(held)), "{held:?} of 200");
}
