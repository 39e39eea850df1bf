//! Steps are short only near fast signals, and no fast signal is missed.

use super::common::{BEAM, finished, written};

const METHODS: [&str; 2] = ["ida", "esdirk46"];

fn tip(signal: &str) -> String {
    format!(r#"/ends/tip={{"free": {{"force_x_n": {signal}}}}}"#)
}

fn sigmoid(amplitude: f64, steepness: f64, at: f64) -> String {
    format!(r#"{{"sigmoid": {{"amplitude": {amplitude}, "steepness_per_s": {steepness}, "midpoint_s": {at}}}}}"#)
}

/// Goal: a fast change within a ten-thousandth of a second costs only its own steps and those that follow, in a run of ten seconds as in
/// one of a fifth of a second. Steps of a 16th of its time scale throughout would be four million in 10 s.
#[test]
fn a_steep_step_is_short_of_steps_for_itself_alone() {
    for method in METHODS {
        let method = format!(r#"/solver/method="{method}""#);
        let steps = |end: f64, at: f64| {
            let force = tip(&sigmoid(0.1, 1e5, at));
            let s = finished(&written(BEAM, &[&method, &force, &format!("/time/end_s={end}")]));
            (s.solver.steps, s.quantities["tip_u1_m"].max_abs.expect("it bends"))
        };
        let (long, short) = (steps(10.0, 7.3), steps(0.5, 0.1));
        assert!(long.0 < short.0 + 300, "{method}: {long:?} {short:?}");
        assert!((long.1 / short.1 - 1.0).abs() < 1e-3, "{method}: {long:?} {short:?}");
    }
}

/// Goal: a pulse of 40 microseconds after steps have reached their largest size has the same effect as one at the start, and so has a pulse
/// drawn by a spline. Tolerance: 1e-2 of its effect at rtol 1e-4; nothing else happens.
#[test]
fn a_pulse_late_in_a_run_is_felt() {
    let pulse = |at: f64| {
        format!(
            r#"{{"product": [{}, {{"sum": [1, {}]}}]}}"#,
            sigmoid(100.0, 1e6, at),
            sigmoid(-1.0, 1e6, at + 4e-5)
        )
    };
    let table = |at: f64| {
        let places: Vec<i32> = (-20..25).collect();
        let times: Vec<String> = places.iter().map(|k| (at + 1e-5 * f64::from(*k)).to_string()).collect();
        let values: Vec<&str> = places
            .iter()
            .map(|k| {
                ["50", "100", "50"]
                    .get(usize::try_from(*k - 1).unwrap_or(9))
                    .copied()
                    .unwrap_or("0")
            })
            .collect();
        format!(
            r#"{{"table": {{"times_s": [{}], "values": [{}], "interpolation": "cubic"}}}}"#,
            times.join(", "),
            values.join(", ")
        )
    };
    for signal in [&pulse as &dyn Fn(f64) -> String, &table] {
        for method in METHODS {
            let method = format!(r#"/solver/method="{method}""#);
            let felt = |end: f64, at: f64| {
                let s = finished(&written(
                    BEAM,
                    &[&method, &tip(&signal(at)), &format!("/time/end_s={end}")],
                ));
                (s.quantities["tip_u1_m"].max_abs.expect("it bends"), s.solver.steps)
            };
            let (late, soon) = (felt(20.0, 13.7), felt(0.5, 0.06));
            assert!((late.0 / soon.0 - 1.0).abs() < 1e-2, "{method}: {late:?} {soon:?}");
            assert!(soon.0 > 1e-6 && late.1 < soon.1 + 1000, "{method}: {late:?} {soon:?}");
        }
    }
}
