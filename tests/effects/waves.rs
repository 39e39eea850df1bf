//! Axial waves: without them the beam is carried along by its driven ends. What is left out is the inertia of motion relative
//! to them, of the order (f/f_axial)²: `(ω l_s)² m/EA`.

use super::common::{Run, run, written};
use super::limits::falls;

/// Its fifth power starts smoothly.
const SINE: &str = r#"{"sine":{"amplitude":1,"frequency_hz":20}}"#;

/// A dry beam shaken along at 20 Hz, starting smoothly, and loaded across; `stiffness` times the paper's modulus, axially.
pub fn shaken(stiffness: f64, across: bool, effects: &str) -> Run {
    let loads = if across {
        r#"[{"force_x_n_m":{"signal":{"sine":{"amplitude":0.02,"frequency_hz":15,"ramp_cycles":0.5}}}}]"#
    } else {
        "[]"
    };
    let text = format!(
        r#"{{"name":"shaken","beam":{{"length_m":0.1,"height_m":0.02,"width_m":0.05,"young_modulus_pa":2e6,"density_kg_m3":950,
              "axial_stiffness_factor":{stiffness},"damping":{{"axial_time_s":1e-5,"bending_time_s":1e-4}}}},
          "ends":{{"root":{{"clamped":{{"u3_m":{{"product":[{{"sine":{{"amplitude":0.001,"frequency_hz":20}}}},{SINE},{SINE},{SINE},{SINE}]}}}}}},"tip":"free"}},
          "loads":{loads},"mesh":{{"segments":5,"cells_per_segment":2}},"effects":{effects},
          "time":{{"end_s":0.05,"output_interval_s":5e-4}},"solver":{{"rtol":1e-11}}}}"#
    );
    run(&written::<&str>(&text, &[]))
}

#[test]
fn axial_waves_vanish_with_the_square_of_the_frequency() {
    // The number is f/f_axial; forces in the beam, in which the waves show.
    for kinematics in ["\"transverse_motion\":\"off\"", "\"finite_rotation\":\"off\""] {
        let of = |number: f64, axial: &str| {
            let effects = format!("{{{kinematics},\"axial_inertia\":\"{axial}\"}}");
            shaken(1.0 / (number * number), false, &effects)
        };
        let pair = |number: f64| (of(number, "off"), of(number, "on"));
        falls(kinematics, &[0.5, 0.25, 0.125], 2.0, 0.2, pair, "axial_energy");
    }
}

#[test]
fn bending_feels_axial_waves_with_the_square_of_the_frequency() {
    let of = |number: f64, axial: &str| {
        // A small load: axial inertia of the shortening by bending, of the order (u1/l_s)², is left out whatever EA is,
        // and the rotary inertia of [E27] differs by y11 φ²/l_s².
        let effects = format!("{{\"axial_inertia\":\"{axial}\",\"rotary_inertia\":\"off\"}}");
        shaken(1.0 / (number * number), true, &effects)
    };
    let pair = |number: f64| (of(number, "off"), of(number, "on"));
    falls(
        "axial waves in bending",
        &[0.25, 0.125, 0.0625],
        2.0,
        0.2,
        pair,
        "tip_u1",
    );
}
