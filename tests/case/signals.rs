//! Functions of time and place: exact derivatives, smooth joins, switching times.

use proptest::prelude::*;
use slcbeam::functions::{Jet, Profile, Signal, SmoothTime};

fn signal(json: &str) -> Signal {
    serde_json::from_str(json).unwrap()
}

fn jet(signal: &Signal, t: f64) -> Jet {
    signal.jet(SmoothTime { t, within: t })
}

fn simple() -> BoxedStrategy<Signal> {
    let json = prop_oneof![
        (-3.0..3.0).prop_map(|v: f64| format!("{v}")),
        (-2.0..2.0, 0.1..3.0, -3.0..3.0, 0.0..4.0).prop_map(|(a, f, p, r)| format!(
            r#"{{"sine":{{"amplitude":{a},"frequency_hz":{f},"phase_rad":{p},"ramp_cycles":{r}}}}}"#
        )),
        (-2.0..2.0, -20.0..20.0, -1.0..2.0).prop_map(|(a, k, t)| format!(
            r#"{{"sigmoid":{{"amplitude":{a},"steepness_per_s":{k},"midpoint_s":{t}}}}}"#
        )),
        (-2.0..2.0, -2.0..2.0, 0.0..1.0, 0.2..1.0, any::<bool>()).prop_map(|(a, b, s, d, smooth)| format!(
            r#"{{"ramp":{{"from":{a},"to":{b},"start_s":{s},"duration_s":{d},"shape":"{}"}}}}"#,
            if smooth { "smooth" } else { "linear" }
        )),
        prop::collection::vec(-2.0..2.0, 1..5).prop_map(|c| format!(r#"{{"polynomial":{{"coefficients":{c:?}}}}}"#)),
        (prop::collection::vec((0.05..0.5, -1.0..1.0), 1..7), 0..3_usize).prop_map(|(points, kind)| {
            let times: Vec<f64> = points
                .iter()
                .scan(0.0, |t, p| {
                    *t += p.0;
                    Some(*t)
                })
                .collect();
            let values: Vec<f64> = points.iter().map(|p| p.1).collect();
            let kind = ["linear", "monotone", "cubic"][kind];
            format!(r#"{{"table":{{"times_s":{times:?},"values":{values:?},"interpolation":"{kind}"}}}}"#)
        }),
    ];
    json.prop_map(|json| signal(&json)).boxed()
}

fn any_signal() -> impl Strategy<Value = Signal> {
    let several = prop::collection::vec(simple(), 1..4);
    prop_oneof![
        simple(),
        several.clone().prop_map(Signal::Sum),
        several.prop_map(Signal::Product)
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, ..ProptestConfig::default() })]

    /// Central differences of the same branch; their error is O(h^2) in smooth pieces, O(h) next to a C2 join.
    #[test]
    fn derivatives_agree_with_differences(signal in any_signal(), t in 0.01..2.5f64) {
        let h = 1e-5;
        let at = |t: f64, within: f64| signal.jet(SmoothTime { t, within });
        let (before, here, after) = (at(t - h, t), at(t, t), at(t + h, t));
        let scale = 1.0 + here.rate.abs() + here.acceleration.abs();
        let rate = (after.value - before.value) / (2.0 * h);
        let acceleration = (after.rate - before.rate) / (2.0 * h);
        prop_assert!((rate - here.rate).abs() < 1e-5 * scale, "{rate} {here:?}");
        // Third derivatives reach 1e4 here.
        prop_assert!((acceleration - here.acceleration).abs() < 0.2 * scale, "{acceleration} {here:?}");
    }

    /// Away from the switching times value, rate and acceleration are continuous.
    #[test]
    fn nothing_jumps_between_switching_times(signal in any_signal(), t in 0.01..2.5f64) {
        let mut breaks: Vec<f64> = vec![];
        signal.breaks(5.0, &mut breaks);
        let e = 1e-7;
        prop_assume!(breaks.iter().all(|b: &f64| (b - t).abs() > 2.0 * e));
        let (left, right) = (jet(&signal, t - e), jet(&signal, t + e));
        let scale = 1.0 + left.acceleration.abs() + left.rate.abs();
        prop_assert!((left.value - right.value).abs() < 1e-5 * scale);
        prop_assert!((left.rate - right.rate).abs() < 1e-5 * scale);
        prop_assert!((left.acceleration - right.acceleration).abs() < 1e-2 * scale);
    }

    #[test]
    fn signals_read_back_as_written(signal in any_signal()) {
        let text = serde_json::to_string(&signal).unwrap();
        prop_assert_eq!(serde_json::from_str::<Signal>(&text).unwrap(), signal);
    }
}

#[test]
fn a_smooth_start_joins_twice_differentiably() {
    let sine = signal(r#"{"sine":{"amplitude":2,"frequency_hz":4,"ramp_cycles":2}}"#);
    assert_eq!(jet(&sine, 0.0), Jet::default());
    let (left, right) = (jet(&sine, 0.5 - 1e-9), jet(&sine, 0.5 + 1e-9));
    assert!((left.rate - right.rate).abs() < 1e-4 && (left.acceleration - right.acceleration).abs() < 1e-2);
    let impulsive = signal(r#"{"sine":{"amplitude":2,"frequency_hz":4}}"#);
    assert_eq!(jet(&impulsive, 0.0).rate, 2.0 * std::f64::consts::TAU * 4.0);
}

#[test]
fn a_branch_is_chosen_by_the_interval_not_by_the_instant() {
    let step = signal(r#"{"ramp":{"to":3,"start_s":0.5,"duration_s":0}}"#);
    assert_eq!(step.jet(SmoothTime { t: 0.5, within: 0.4 }).value, 0.0);
    assert_eq!(step.jet(SmoothTime { t: 0.5, within: 0.6 }).value, 3.0);
    let zigzag = signal(r#"{"table":{"times_s":[0,1,2],"values":[0,1,0],"interpolation":"linear"}}"#);
    assert_eq!(zigzag.jet(SmoothTime { t: 1.0, within: 0.5 }).rate, 1.0);
    assert_eq!(zigzag.jet(SmoothTime { t: 1.0, within: 1.5 }).rate, -1.0);
    assert_eq!(zigzag.smooth_intervals(1.5), [(0.0, 1.0), (1.0, 1.5)]);
}

#[test]
fn a_sigmoid_does_not_overflow() {
    let sigmoid = signal(r#"{"sigmoid":{"amplitude":1,"steepness_per_s":1e6,"midpoint_s":0.5}}"#);
    for (t, value) in [(-1e3, 0.0), (0.5, 0.5), (1e3, 1.0)] {
        assert_eq!(jet(&sigmoid, t).value, value);
        assert!(jet(&sigmoid, t).acceleration.is_finite());
    }
}

/// Values of a natural spline through (0, 0), (1, 1), (2, 0): second derivative -3 in the middle.
#[test]
fn a_cubic_table_is_the_natural_spline() {
    let table = signal(r#"{"table":{"times_s":[0,1,2],"values":[0,1,0],"interpolation":"cubic"}}"#);
    let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-14, "{a} {b}");
    close(jet(&table, 1.0).acceleration, -3.0);
    close(jet(&table, 0.5).value, 0.5 + 3.0 * 0.375 / 6.0);
    assert_eq!(jet(&table, 3.0), Jet::constant(0.0));
    let mut breaks: Vec<f64> = vec![];
    table.breaks(5.0, &mut breaks);
    assert_eq!(breaks, [0.0, 2.0]);
}

/// Goal: a pump profile of six points, given without a word of what happens in between, never pumps more than its points say.
#[test]
fn a_table_stays_within_its_points_by_default() {
    let pump = signal(r#"{"table":{"times_s":[0,1,1.001,2,2.001,4],"values":[0,0,1e-6,1e-6,0,0]}}"#);
    for k in 0..=4000 {
        let value = jet(&pump, 1e-3 * f64::from(k)).value;
        assert!((-1e-20..=1.000_000_1e-6).contains(&value), "{k} {value}");
    }
    assert_eq!(pump.overshoot(), 0.0);
    let spline =
        signal(r#"{"table":{"times_s":[0,1,1.001,2,2.001,4],"values":[0,0,1e-6,1e-6,0,0],"interpolation":"cubic"}}"#);
    assert!(spline.overshoot() > 0.5);
    let mut breaks: Vec<f64> = vec![];
    pump.breaks(5.0, &mut breaks);
    assert_eq!(breaks, [0.0, 1.0, 1.001, 2.0, 2.001, 4.0]);
}

#[test]
fn the_shortest_time_scale() {
    let period = |json: &str| signal(json).fastest_period_s();
    assert_eq!(period("2"), None);
    assert_eq!(period(r#"{"sine":{"amplitude":1,"frequency_hz":4}}"#), Some(0.25));
    assert_eq!(period(r#"{"sine":{"amplitude":0,"frequency_hz":4}}"#), None);
    assert_eq!(
        period(r#"{"sigmoid":{"amplitude":1,"steepness_per_s":-8,"midpoint_s":1}}"#),
        Some(0.5)
    );
    assert_eq!(period(r#"{"ramp":{"to":1,"duration_s":0.3}}"#), Some(0.3));
    assert_eq!(
        period(r#"{"table":{"times_s":[0,0.5,0.75],"values":[0,1,0]}}"#),
        Some(0.25)
    );
    let two = r#"[{"sine":{"amplitude":1,"frequency_hz":4}},{"sine":{"amplitude":1,"frequency_hz":1}}]"#;
    assert_eq!(period(&format!(r#"{{"sum":{two}}}"#)), Some(0.25));
    assert_eq!(period(&format!(r#"{{"product":{two}}}"#)), Some(0.2));
}

#[test]
fn profiles_and_their_slopes() {
    let read = |json: &str| serde_json::from_str::<Profile>(json).unwrap();
    let profiles = [
        r#"{"cosine":{"waves":0.95,"phase_rad":0.2}}"#,
        r#"{"sine":{"amplitude":3,"waves":2}}"#,
        r#"{"polynomial":{"coefficients":[1,2,3]}}"#,
        r#"{"table":{"positions":[0,0.3,1],"values":[1,2,0]}}"#,
        r#"{"sum":[1,{"sine":{"waves":1}}]}"#,
        r#"{"product":[2,{"cosine":{"waves":1}},{"polynomial":{"coefficients":[0,1]}}]}"#,
    ];
    let h = 1e-6;
    for profile in profiles.map(read) {
        for x in [0.1, 0.4, 0.77] {
            let slope = (profile.value(x + h) - profile.value(x - h)) / (2.0 * h);
            assert!(
                (slope - profile.slope(x)).abs() < 1e-6 * (1.0 + slope.abs()),
                "{profile:?} at {x}"
            );
        }
    }
    assert_eq!(read(r#"{"cosine":{"waves":0}}"#).value(0.3), 1.0);
    assert_eq!(Profile::one().value(0.3), 1.0);
    // The slope at an end is that of the curve, not of the constant beyond.
    assert_eq!(read(r#"{"table":{"positions":[0,1],"values":[0,2]}}"#).slope(0.0), 2.0);
}

/// Third derivatives, where nothing joins: fourth-order differences of the second.
#[test]
fn third_derivatives_agree_with_differences() {
    for (text, t) in [
        (
            r#"{"sine": {"amplitude": 2, "frequency_hz": 1.5, "phase_rad": 0.3}}"#,
            0.41,
        ),
        (
            r#"{"sine": {"amplitude": 2, "frequency_hz": 1.5, "ramp_cycles": 2}}"#,
            0.41,
        ),
        (
            r#"{"sigmoid": {"amplitude": 3, "steepness_per_s": 4, "midpoint_s": 0.5}}"#,
            0.41,
        ),
        (
            r#"{"sigmoid": {"amplitude": 3, "steepness_per_s": 4, "midpoint_s": 0.5}}"#,
            0.7,
        ),
        (
            r#"{"ramp": {"from": 1, "to": 4, "start_s": 0.1, "duration_s": 1}}"#,
            0.41,
        ),
        (r#"{"polynomial": {"coefficients": [1, 2, 3, 4, 5]}}"#, 0.41),
        (
            r#"{"table": {"times_s": [0, 0.3, 1], "values": [0, 2, 1], "interpolation": "cubic"}}"#,
            0.41,
        ),
        (
            r#"{"product": [{"polynomial": {"coefficients": [1, 2, 3, 4]}}, {"sine": {"amplitude": 2, "frequency_hz": 0.5}}]}"#,
            0.41,
        ),
    ] {
        let signal: Signal = serde_json::from_str(text).unwrap();
        let h = 1e-3;
        let a = |k: f64| {
            signal
                .jet(SmoothTime {
                    t: t + k * h,
                    within: t,
                })
                .acceleration
        };
        let expected = (a(-2.0) - 8.0 * a(-1.0) + 8.0 * a(1.0) - a(2.0)) / (12.0 * h);
        let jerk = signal.jet(SmoothTime { t, within: t }).jerk;
        assert!(
            (jerk - expected).abs() < 1e-6 * (1.0 + jerk.abs()),
            "{text}: {jerk} {expected}"
        );
    }
}

/// Goal: a time that stands twice is a jump, whatever is between the other points, and a curve of its own ends and begins there.
#[test]
fn a_time_that_stands_twice_is_a_jump() {
    for kind in ["linear", "monotone", "cubic"] {
        let step = signal(&format!(
            r#"{{"table":{{"times_s":[0,0.25,0.5,0.5,0.75,1],"values":[0,0.5,1,3,2,1],"interpolation":"{kind}"}}}}"#
        ));
        let at = |t: f64, within: f64| step.jet(SmoothTime { t, within });
        for (t, within, value, rate) in [(0.5, 0.4, 1.0, 2.0), (0.5, 0.6, 3.0, -4.0), (0.25, 0.3, 0.5, 2.0)] {
            let jet = at(t, within);
            assert!(
                (jet.value - value).abs() + (jet.rate - rate).abs() < 1e-12,
                "{kind} {t} {jet:?}"
            );
        }
        assert_eq!(step.value(0.5), 3.0);
        assert_eq!(step.first_jump(1.0), Some([0.5, 1.0, 3.0]));
        let range = step.range(0.0, 1.0);
        assert!(
            (range.low - 0.0).abs() + (range.high - 3.0).abs() < 1e-9,
            "{kind} {range:?}"
        );
        let mut breaks = vec![];
        step.breaks(1.0, &mut breaks);
        assert!(breaks.contains(&0.5), "{breaks:?}");
        assert!(
            (step.integral(1.0) - 1.25).abs() < 1e-12,
            "{kind} {}",
            step.integral(1.0)
        );
    }
}

/// Goal: a table that repeats is the same in every period, before its first point too, as smooth at its seam as anywhere. Source: the periodic
/// spline through 16 points of a sine, whose largest error is `(2 π/16)^4/384 = 6e-5`.
#[test]
fn a_table_that_repeats_is_periodic() {
    let points = |n: usize| (0..=n).map(move |k| (k % n) as f64 / n as f64);
    let times: Vec<f64> = (0..=16).map(|k| 1.0 + 0.125 * f64::from(k)).collect();
    let values: Vec<f64> = points(16).map(|x| (std::f64::consts::TAU * x).sin()).collect();
    let text = |kind: &str| {
        format!(r#"{{"table":{{"times_s":{times:?},"values":{values:?},"interpolation":"{kind}","repeat":true}}}}"#)
    };
    let spline = signal(&text("cubic"));
    let sine = |t: f64| (std::f64::consts::PI * (t - 1.0)).sin();
    for k in 0..=1000 {
        let t = -4.0 + 0.0137 * f64::from(k);
        let jet = spline.jet(SmoothTime { t, within: 0.0 });
        assert!((jet.value - sine(t)).abs() < 7e-5, "{t} {jet:?}");
        let e = 1e-6;
        let beside = [t - e, t + e].map(|t| spline.value(t));
        assert!(((beside[1] - beside[0]) / (2.0 * e) - jet.rate).abs() < 1e-4, "{t}");
    }
    let mut breaks = vec![];
    spline.breaks(9.0, &mut breaks);
    assert!(breaks.is_empty());
    let largest = spline.largest(100.0);
    assert!((largest.value - 1.0).abs() < 1e-3 && (largest.rate / std::f64::consts::PI - 1.0).abs() < 1e-3);
    for kind in ["linear", "monotone"] {
        let table = signal(&text(kind));
        for k in 0..=400 {
            let t = 1.0 + 0.00517 * f64::from(k);
            for periods in [-2.0, 1.0, 50.0] {
                let far = table.value(t + 2.0 * periods);
                assert!((far - table.value(t)).abs() < 1e-11, "{kind} {t} {periods}");
            }
        }
        let mut breaks = vec![];
        table.breaks(9.0, &mut breaks);
        for t in [0.0, 1.0, 1.125, 3.0, 3.125, 8.875] {
            assert!(breaks.contains(&t), "{kind} {t} {breaks:?}");
        }
    }
    // a saw: the seam is a jump
    let saw = signal(r#"{"table":{"times_s":[0,1],"values":[0,2],"interpolation":"linear","repeat":true}}"#);
    assert_eq!(saw.first_jump(3.0), Some([1.0, 2.0, 0.0]));
    assert_eq!(saw.value(2.25), 0.5);
    assert!((saw.integral(10.0) - 10.0).abs() < 1e-12);
    let range = saw.range(0.25, 1.5);
    assert!(range.low.abs() + (range.high - 2.0).abs() < 1e-9, "{range:?}");
    assert_eq!(serde_json::to_value(&saw).unwrap()["table"]["repeat"], true);
}
