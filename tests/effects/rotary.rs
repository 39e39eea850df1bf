//! Rotary inertia: leaving it out changes frequencies by `y11 k²/2`, so answers at equal phase by an amount proportional
//! to `(h_s/l_s)²`.

use super::common::{run, written};
use super::limits::falls;

#[test]
fn rotary_inertia_vanishes_with_the_square_of_the_height() {
    let of = |height: f64, rotary: &str| {
        // First mode of a dry beam between pins, a third of its period.
        let end = 0.35 * std::f64::consts::TAU / 9.87 * (950.0 * 12.0 / 2e6_f64).sqrt() * 0.01 / height;
        let text = format!(
            r#"{{"name":"free","beam":{{"length_m":0.1,"height_m":{height},"width_m":0.01,"young_modulus_pa":2e6,"density_kg_m3":950}},
              "ends":{{"root":"pinned","tip":"pinned"}},
              "start":{{"u1_m":{{"sine":{{"amplitude":1e-8,"waves":0.5}}}}}},
              "mesh":{{"segments":8,"cells_per_segment":2}},
              "effects":{{"rotary_inertia":"{rotary}"}},
              "time":{{"end_s":{end},"output_interval_s":{end}}},"solver":{{"rtol":1e-9,"transverse_scale_m":1e-8}}}}"#
        );
        run(&written::<&str>(&text, &[]))
    };
    let heights = [8e-3, 4e-3, 2e-3];
    let pair = |h| (of(h, "off"), of(h, "on"));
    falls("rotary inertia", &heights, 2.0, 0.1, pair, "bending_energy");
}
