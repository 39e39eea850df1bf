//! Bounds of signals: rigorous and tight.

use proptest::prelude::*;
use slcbeam::functions::{Signal, SmoothTime};

const END: f64 = 2.0;

fn signal(json: &str) -> Signal {
    serde_json::from_str(json).unwrap()
}

/// One of the named signals; durations down to 1e-5 of the span, at any time.
fn simple() -> BoxedStrategy<Signal> {
    let short = (-5.0..0.0).prop_map(|e: f64| END * 10f64.powf(e));
    let json = prop_oneof![
        (-3.0..3.0).prop_map(|v: f64| format!("{v}")),
        (-2.0..2.0, -1.0..3.0, -3.0..3.0, prop::option::of(0.1..4.0)).prop_map(
            |(a, f, p, r): (f64, f64, f64, _)| format!(
                r#"{{"sine":{{"amplitude":{a},"frequency_hz":{},"phase_rad":{p},"ramp_cycles":{}}}}}"#,
                10f64.powf(f),
                r.unwrap_or(0.0)
            )
        ),
        (-2.0..2.0, any::<bool>(), short.clone(), 0.0..END).prop_map(|(a, up, d, t)| format!(
            r#"{{"sigmoid":{{"amplitude":{a},"steepness_per_s":{},"midpoint_s":{t}}}}}"#,
            if up { 4.0 / d } else { -4.0 / d }
        )),
        (
            -2.0..2.0,
            prop_oneof![Just(0.0), -2.0..2.0],
            0.0..END,
            short.clone(),
            any::<bool>()
        )
            .prop_map(|(a, b, s, d, smooth)| format!(
                r#"{{"ramp":{{"from":{a},"to":{b},"start_s":{s},"duration_s":{d},"shape":"{}"}}}}"#,
                if smooth { "smooth" } else { "linear" }
            )),
        prop::collection::vec(-2.0..2.0, 1..7).prop_map(|c| format!(r#"{{"polynomial":{{"coefficients":{c:?}}}}}"#)),
        (0.0..END, prop::collection::vec((short, -1.0..1.0), 1..9), 0..3_usize).prop_map(|(start, points, kind)| {
            let times: Vec<f64> = points
                .iter()
                .scan(start, |t, p: &(f64, f64)| {
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

/// A pulse: a step up, and shortly afterwards down.
fn pulse() -> impl Strategy<Value = Signal> {
    (0.0..1.9, -5.0..-1.0, any::<bool>()).prop_map(|(t, e, smooth): (f64, f64, bool)| {
        let d = END * 10f64.powf(e);
        let k = 8.0 / d;
        let text = if smooth {
            format!(
                r#"{{"product":[{{"ramp":{{"to":1,"start_s":{t},"duration_s":{d}}}}},{{"ramp":{{"from":1,"to":0,"start_s":{},"duration_s":{d}}}}}]}}"#,
                t + d
            )
        } else {
            format!(
                r#"{{"product":[{{"sigmoid":{{"amplitude":1,"steepness_per_s":{k},"midpoint_s":{t}}}}},{{"sigmoid":{{"amplitude":1,"steepness_per_s":-{k},"midpoint_s":{}}}}}]}}"#,
                t + d
            )
        };
        signal(&text)
    })
}

fn nested() -> impl Strategy<Value = Signal> {
    let leaf = prop_oneof![4 => simple(), 1 => pulse()];
    leaf.prop_recursive(3, 12, 3, |inner| {
        prop_oneof![
            prop::collection::vec(inner.clone(), 1..4).prop_map(Signal::Sum),
            prop::collection::vec(inner, 1..4).prop_map(Signal::Product),
        ]
    })
}

/// Knots, crests of the fastest sines, and their neighborhoods.
fn places(signal: &Signal, out: &mut Vec<f64>) {
    match signal {
        Signal::Table(table) => out.extend(&table.times_s),
        Signal::Ramp(ramp) => out.extend([0.0, 0.21, 0.5, 0.79, 1.0].map(|s| ramp.start_s + s * ramp.duration_s)),
        Signal::Sigmoid(s) => {
            out.extend((-30..=30).map(|z| s.midpoint_s + 0.25 * f64::from(z) / s.steepness_per_s));
        }
        Signal::Sine(sine) => {
            let crests = (0..(4.0 * sine.frequency_hz * END).min(4000.0) as i32 + 4).map(|k| {
                (0.5 * std::f64::consts::PI * f64::from(k) - sine.phase_rad)
                    / (2.0 * std::f64::consts::PI * sine.frequency_hz)
            });
            out.extend(crests);
            out.extend((0..=20).map(|k| f64::from(k) / 20.0 * sine.ramp_cycles / sine.frequency_hz));
        }
        Signal::Sum(parts) | Signal::Product(parts) => parts.iter().for_each(|part| places(part, out)),
        _ => {}
    }
}

/// Largest magnitudes of value, rate and acceleration by dense sampling, and smallest and largest value.
fn sampled(signal: &Signal) -> ([f64; 3], [f64; 2]) {
    let mut at: Vec<f64> = (0..=4000).map(|k| END * f64::from(k) / 4000.0).collect();
    places(signal, &mut at);
    at.retain(|t| (0.0..=END).contains(t));
    at.sort_by(f64::total_cmp);
    let between: Vec<f64> = at
        .windows(2)
        .flat_map(|w| [0.25, 0.5, 0.618, 0.75].map(|s| w[0] + s * (w[1] - w[0])))
        .collect();
    at.extend(between);
    let mut found = ([0.0_f64; 3], [f64::INFINITY, f64::NEG_INFINITY]);
    let mut see = |t: f64, within: f64| {
        let jet = signal.jet(SmoothTime { t, within });
        for (most, x) in found.0.iter_mut().zip([jet.value, jet.rate, jet.acceleration]) {
            *most = most.max(x.abs());
        }
        found.1 = [found.1[0].min(jet.value), found.1[1].max(jet.value)];
    };
    for (from, to) in signal.smooth_intervals(END) {
        see(from, 0.5 * (from + to));
        see(to, 0.5 * (from + to));
    }
    at.into_iter().filter(|t| *t > 0.0 && *t < END).for_each(|t| see(t, t));
    found
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 500, ..ProptestConfig::default() })]

    /// Rounding errors of sums of large terms are tolerated.
    #[test]
    fn nothing_exceeds_the_bounds_and_they_are_not_wide(signal in nested()) {
        let bounds = signal.largest(END);
        let range = signal.range(0.0, END);
        let (found, [low, high]) = sampled(&signal);
        let most = [bounds.value, bounds.rate, bounds.acceleration];
        for k in 0..3 {
            prop_assert!(found[k] <= most[k] * (1.0 + 1e-9), "{k}: {} above {}", found[k], most[k]);
            prop_assert!(bounds.limited || most[k] <= 1.2 * found[k] + 1e-9, "{k}: {} found, bound {}", found[k], most[k]);
        }
        let size = bounds.value;
        prop_assert!(range.low <= low + 1e-9 * size && range.high >= high - 1e-9 * size, "{range:?}: {low} {high}");
        let wide = 0.2 * size + 1e-9;
        prop_assert!(bounds.limited || (range.low >= low - wide && range.high <= high + wide), "{range:?}: {low} {high}");
    }

    /// Goal: an oscillator at rest, driven by a signal and solved exactly between many instants, never differs from the signal by more than
    /// the bound.
    #[test]
    fn oscillators_stay_within_what_excites(signal in nested(), w in 5.0..300.0f64, part in 0.2..1.0f64, held in -1.0..1.0f64) {
        let bound = signal.excitation(END, held).above(part * w);
        let departure = departure(&signal, w, held);
        prop_assert!(departure <= bound * 1.001 + 1e-9, "{departure} above {bound}");
    }
}

/// Largest `|q - s|` of `q'' + w² q = w² s` from rest at `held`. Between instants `s` is a parabola through both ends with the
/// curvature of the middle; q of that is exact.
fn departure(signal: &Signal, w: f64, held: f64) -> f64 {
    let mut at: Vec<f64> = (0..=20_000).map(|k| END * f64::from(k) / 20_000.0).collect();
    places(signal, &mut at);
    let mut breaks = vec![];
    signal.breaks(END, &mut breaks);
    at.extend(breaks);
    at.retain(|t| (0.0..=END).contains(t));
    at.sort_by(f64::total_cmp);
    at.dedup();
    let (mut q, mut p, mut most) = (held, 0.0, 0.0_f64);
    for pair in at.windows(2) {
        let (a, h) = (pair[0], pair[1] - pair[0]);
        let within = a + 0.5 * h;
        let value = |t: f64| signal.jet(SmoothTime { t, within }).value;
        let (s0, sm, s1) = (value(a), value(within), value(pair[1]));
        // s = s0 + b x + c x², q = s - 2 c/w² + A cos w x + B sin w x
        // a very short piece is treated as straight: the difference of its values would be a rounding error
        let c = if w * h < 1e-4 {
            0.0
        } else {
            2.0 * (s0 - 2.0 * sm + s1) / (h * h)
        };
        let b = (s1 - s0) / h - c * h;
        let (big_a, big_b) = (q - s0 + 2.0 * c / (w * w), (p - b) / w);
        let (sin, cos) = (w * h).sin_cos();
        most = most.max((q - s0).abs());
        q = s1 - 2.0 * c / (w * w) + big_a * cos + big_b * sin;
        p = b + 2.0 * c * h - big_a * w * sin + big_b * w * cos;
        most = most.max((q - s1).abs());
    }
    most
}

#[test]
fn size_of_a_sine_does_not_depend_on_the_length_of_the_run() {
    let signal = signal(r#"{"sine": {"amplitude": 0.012, "frequency_hz": 20}}"#);
    for end in [0.5, 50.0, 100.0, 200.0, 5000.0] {
        let most = signal.largest(end);
        let omega = 40.0 * std::f64::consts::PI;
        assert!((most.value / 0.012 - 1.0).abs() < 1e-4, "{end}: {most:?}");
        assert!((most.rate / (0.012 * omega) - 1.0).abs() < 1e-4, "{end}: {most:?}");
        let acceleration = 0.012 * omega * omega;
        assert!((most.acceleration / acceleration - 1.0).abs() < 1e-4, "{end}: {most:?}");
    }
}

#[test]
fn exact_bounds_of_single_forms() {
    let sine = signal(r#"{"sine":{"amplitude":3,"frequency_hz":1e4}}"#);
    let bounds = sine.largest(100.0);
    assert!((bounds.value / 3.0 - 1.0).abs() < 1e-9, "{bounds:?}");
    assert!((bounds.acceleration / (3.0 * (2e4 * std::f64::consts::PI).powi(2)) - 1.0).abs() < 1e-9);
    let ramp = signal(r#"{"ramp":{"to":1,"start_s":1.2345678,"duration_s":1e-7}}"#);
    assert!((ramp.largest(1e4).rate / 1.875e7 - 1.0).abs() < 1e-9);
    assert!((ramp.jumps(1e4, 0.5)[0] - 0.5).abs() < 1e-12);
    let square = signal(
        r#"{"product":[{"sine":{"amplitude":1,"frequency_hz":50}},{"sine":{"amplitude":1,"frequency_hz":50}}]}"#,
    );
    let range = square.range(0.0, 1e4);
    assert!(range.low > -0.01 && range.low <= 0.0 && range.high < 1.01, "{range:?}");
}

/// Goal: bounds include both signs of a pulse within a hundred-thousandth of the run, which samples miss.
#[test]
fn a_polynomial_pulse_is_seen_and_shortens_steps() {
    let bump =
        signal(r#"{"polynomial":{"coefficients":[0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,1]}}"#);
    let scale = bump.shortest_time_s(1.0).unwrap();
    assert!(scale < 0.3, "{scale}");
}

/// Goal: an opening that leaves its range for a hundred-thousandth of the run is detected; openings that touch the ends are accepted.
#[test]
fn what_leaves_a_range_is_found_and_what_touches_it_is_not() {
    for k in 0..40 {
        let t = 0.7 + 2.3 * f64::from(k);
        let pulse = format!(
            r#"{{"sum":[0.6,{{"table":{{"times_s":[{t},{},{}],"values":[0,0.5,0],"interpolation":"linear"}}}}]}}"#,
            t + 5e-4,
            t + 1e-3
        );
        let found = signal(&pulse).leaves(0.0, 1.0, 100.0);
        assert!(found.is_some_and(|excess| excess.value > 1.0), "{t}: {found:?}");
    }
    for touching in [
        r#"{"sum":[0.5,{"sine":{"amplitude":0.5,"frequency_hz":50}}]}"#,
        r#"{"product":[4,{"polynomial":{"coefficients":[0,0.01]}},{"polynomial":{"coefficients":[1,-0.01]}}]}"#,
        r#"{"product":[{"sigmoid":{"amplitude":1,"steepness_per_s":20,"midpoint_s":30}},{"sum":[1,{"sigmoid":{"amplitude":-1,"steepness_per_s":20,"midpoint_s":60}}]}]}"#,
    ] {
        let found = signal(touching).leaves(-1e-9, 1.0 + 1e-9, 100.0);
        assert!(found.is_none(), "{touching}: {found:?}");
    }
}

/// Goal: simple signals need microseconds, long tables linear time, and many cycles no more than few.
#[test]
fn bounds_cost_little() {
    let time = |json: &str, end: f64, most: f64| {
        let signal = signal(json);
        let begin = std::time::Instant::now();
        let mut repeats = 0;
        while repeats < 20 && begin.elapsed().as_secs_f64() < 0.2 {
            std::hint::black_box(signal.largest(end));
            std::hint::black_box(signal.excitation(end, 0.0).above(10.0));
            repeats += 1;
        }
        let each = begin.elapsed().as_secs_f64() / f64::from(repeats);
        println!("{:.1} us: {}", 1e6 * each, &json[..json.len().min(80)]);
        assert!(each < most, "{each} s: {}", &json[..json.len().min(80)]);
    };
    time("3", 1.0, 1e-3);
    time(r#"{"sine":{"amplitude":1,"frequency_hz":20}}"#, 1.0, 1e-3);
    time(
        r#"{"sine":{"amplitude":1,"frequency_hz":20,"ramp_cycles":1}}"#,
        1.0,
        2e-2,
    );
    time(
        r#"{"sine":{"amplitude":1,"frequency_hz":1e5,"ramp_cycles":1}}"#,
        100.0,
        2e-2,
    );
    time(r#"{"ramp":{"to":1,"start_s":0.3,"duration_s":0.1}}"#, 1.0, 2e-2);
    time(
        r#"{"sum":[1,{"ramp":{"to":1,"duration_s":0.1}},{"sine":{"amplitude":1,"frequency_hz":20}}]}"#,
        1.0,
        2e-2,
    );
    for kind in ["linear", "monotone", "cubic"] {
        let times: Vec<f64> = (0..100_000).map(|k| f64::from(k) * 1e-5).collect();
        let values: Vec<f64> = times.iter().map(|t| (40.0 * t).sin()).collect();
        let text = format!(r#"{{"table":{{"times_s":{times:?},"values":{values:?},"interpolation":"{kind}"}}}}"#);
        time(&text, 1.0, 5.0);
    }
}

/// Goal: if no interval has a time scale of its own, the signal keeps its value to the last digit; the smallest scale is that of the whole
/// run, as without intervals.
#[test]
fn nothing_happens_between_stretches() {
    let pulse = r#"{"product": [{"sigmoid": {"amplitude": 2, "steepness_per_s": 1e5, "midpoint_s": 3}},
        {"sum": [1, {"sigmoid": {"amplitude": -1, "steepness_per_s": 2e4, "midpoint_s": 3.5}}]}]}"#;
    let power = format!(r#"{{"polynomial": {{"coefficients": [{}1]}}}}"#, "0,".repeat(60));
    let table =
        r#"{"table": {"times_s": [2, 3, 3.001, 3.002, 4], "values": [1, 0, 5, 0, 1], "interpolation": "cubic"}}"#;
    let burst = r#"{"product": [{"sine": {"amplitude": 1, "frequency_hz": 1e4}},
        {"ramp": {"to": 1, "start_s": 3, "duration_s": 0.01}},
        {"sum": [1, {"ramp": {"to": -1, "start_s": 3.1, "duration_s": 0.01}}]}]}"#;
    for text in [pulse, &power, table, burst] {
        let signal = signal(text);
        let (end, mut from) = (if text == power { 1.0 } else { 10.0 }, 0.0);
        let all = signal.stretches(end);
        let size = signal.largest(end).value;
        let mut quiet = 0.0;
        for stretch in &all {
            let range = signal.range(from, stretch.to);
            if stretch.scale == f64::INFINITY {
                assert!(range.high - range.low <= 1e-14 * size, "{text}: {from} to {stretch:?}");
                quiet += stretch.to - from;
            }
            from = stretch.to;
        }
        assert_eq!(from, end);
        assert!(quiet > 0.4 * end, "{text}: {all:?}");
        let least = all.iter().map(|s| s.scale).fold(f64::INFINITY, f64::min);
        let whole = signal.shortest_unmarked_time_s(end).expect("it changes");
        assert!(
            least >= whole * (1.0 - 1e-12) && least <= 2.0 * whole,
            "{text}: {least} {whole}"
        );
    }
}

/// Goal: the duration of a sine is `∫ |s| dt = 2/π` of the time, for any number of whole cycles: evenly spaced points would hit the zeros
/// of whole cycles. Tolerance: of 32 points per cycle, 0.2 %.
#[test]
fn sines_of_whole_cycles_last() {
    for cycles in [1, 4, 8, 32, 36, 64, 72, 500, 2048, 32_768, 65_536, 131_072, 1_000_000] {
        let (cycles, end) = (f64::from(cycles), END);
        for phase in [0.0, 0.4] {
            let sine = format!(
                r#"{{"sine":{{"amplitude":-3.0,"frequency_hz":{},"phase_rad":{phase}}}}}"#,
                cycles / end
            );
            let both = format!(r#"{{"product":[2.0,{sine}]}}"#);
            for (json, size) in [(sine.as_str(), 3.0), (both.as_str(), 6.0)] {
                let [most, lasts] = signal(json).lasting(end, end);
                let wanted = size * std::f64::consts::FRAC_2_PI;
                assert!((most / size - 1.0).abs() < 1e-3, "{json}: {most}");
                assert!((lasts / wanted - 1.0).abs() < 2e-3, "{json}: {lasts}, wanted {wanted}");
            }
        }
    }
    let [_, lasts] = signal("-0.7").lasting(END, END);
    assert!((lasts - 0.7).abs() < 1e-12, "{lasts}");
}

/// Goal: bounds that a thread has found before are those of a new search, however many signals, ends and held values lie between.
#[test]
fn bounds_found_before_are_those_of_a_search() {
    let signals: Vec<Signal> = (1..=50)
        .map(|k| {
            signal(&format!(
                r#"{{"sine":{{"amplitude":{k},"frequency_hz":0.{k},"ramp_cycles":1}}}}"#
            ))
        })
        .collect();
    let all = || -> Vec<_> {
        let of = |s: &Signal, end: f64| {
            let excited = [0.0, 0.5].map(|held| s.excitation(end, held).above(3.0));
            (s.largest(end), s.reaches(end), s.impulse(end), excited)
        };
        let twice = |s: &Signal, end: f64| {
            let found = of(s, end);
            assert_eq!(found, of(s, end));
            found
        };
        signals
            .iter()
            .flat_map(|s| [0.5, END].map(|end| twice(s, end)))
            .collect()
    };
    let first = all();
    let elsewhere = std::thread::scope(|scope| scope.spawn(all).join().expect("a search"));
    assert_eq!(first, elsewhere);
    assert_ne!(first[0], first[1]);
}
