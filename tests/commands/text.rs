//! How numbers, tables and a run in a glance read.

use std::path::Path;

use serde_json::Value;
use slcbeam::cli::summary_box::render;
use slcbeam::output::columns::aligned;
use slcbeam::output::numbers::{count, duration, quantity, shortest, trimmed, with_error};
use slcbeam::run::summary::{Balances, CompanionRun, Counters, Quantity, Status, Summary, WallTimes};
use slcbeam::run::uncertainty_band::Band;

#[test]
fn quantities_read_well() {
    assert_eq!(quantity(0.0123, "m", 3), "12.3 mm");
    assert_eq!(quantity(-4070.0, "Pa", 3), "−4.07 kPa");
    assert_eq!(quantity(1e-3, "s", 3), "1.00 ms");
    assert_eq!(quantity(0.0, "J", 3), "0 J");
    assert_eq!(quantity(f64::NAN, "J", 3), "–");
    assert_eq!(quantity(2.5e-7, "m^3/s", 2), "250·10⁻⁹ m³/s");
    assert_eq!(quantity(0.25, "1", 2), "0.25");
    assert_eq!(trimmed("450.0 ms"), "450 ms");
    assert_eq!(trimmed("400"), "400");
}

#[test]
fn durations_and_counts_read_well() {
    assert_eq!(duration(0.85), "850 ms");
    assert_eq!(duration(200.0), "3 min 20 s");
    assert_eq!(duration(7500.0), "2 h 05 min");
    assert_eq!(duration(f64::INFINITY), "–");
    assert_eq!(count(1234567), "1 234 567");
    assert_eq!(count(123), "123");
}

#[test]
fn shortest_reads_back_as_the_same_number() {
    for x in [0.0, -0.0, 0.1, 1e-300, -2.5e22, 1.0 / 3.0, f64::MIN_POSITIVE] {
        let back: f64 = shortest(x).parse().expect("a number");
        assert_eq!(back.to_bits(), x.to_bits(), "{}", shortest(x));
        assert!(shortest(x).len() < 26);
    }
}

/// Goal: columns stand below each other whatever the cells hold, and nothing stands behind the last.
#[test]
fn cells_stand_below_each_other() {
    let lines = [["", "name", "size"], ["", "a", "12.5 µm"], ["", "双 u₁", "3"]].map(|l| l.map(String::from));
    let text = aligned(&lines, &[1]);
    assert_eq!(text, "  name      size\n  a      12.5 µm\n  双 u₁        3\n");
    assert_eq!(aligned::<Vec<String>>(&[], &[]), "");
    assert_eq!(
        aligned(&[vec!["a".into()], vec!["b".into(), "c".into()]], &[]),
        "a\nb  c\n"
    );
}

fn summary(status: Status) -> Summary {
    let quantity = |max| Quantity {
        max_abs: Some(max),
        last: Some(max),
        ..Quantity::default()
    };
    Summary {
        case: "wiring-2".to_string(),
        status,
        reason: None,
        time_s: 0.5,
        unknowns: 371,
        quantities: [
            ("tip_u1_m", 1.23e-4),
            ("tip_u3_m", 1.25e-3),
            ("max_pressure_pa", 9010.0),
        ]
        .map(|(name, max)| (name.to_string(), quantity(max)))
        .into(),
        balances: Balances {
            energy_residual_relative: 3e-8,
            ..Balances::default()
        },
        solver: Counters {
            steps: 12345,
            steps_by_order: vec![12, 300, 2033, 10000],
            ..Counters::default()
        },
        wall_s: WallTimes {
            total: 12.3,
            residual: 4.0,
            jacobian: 3.0,
            linear_solver: 4.0,
            output: 0.5,
            ..WallTimes::default()
        },
        effects: Default::default(),
        characteristic: Default::default(),
        origins: Default::default(),
        growth: None,
        growing_wave: None,
        tables_crc32: Default::default(),
        accuracy: None,
        errors: Default::default(),
        companion: None,
        sensitivities: Default::default(),
        probes: Default::default(),
        ports: Default::default(),
        step_response: Default::default(),
        bands: Default::default(),
        warnings: Vec::new(),
    }
}

fn is_a_box(text: &str, width: usize) -> bool {
    text.lines().all(|l| l.chars().count() == width)
}

#[test]
fn a_finished_run_in_a_glance() {
    let of = |figures: &[(&str, f64)]| figures.iter().map(|(name, e)| (name.to_string(), *e)).collect();
    let finished = Summary {
        errors: [
            ("tip_u1_m".to_string(), of(&[("final", 4.2e-6), ("max_abs", 1.4e-6)])),
            ("max_pressure_pa".to_string(), of(&[("max_abs", 210.0)])),
        ]
        .into(),
        companion: Some(CompanionRun {
            cells_per_segment: 2,
            cells_per_bladder: 4,
            rtol: 1e-4,
            wall_s: 6.2,
            ..CompanionRun::default()
        }),
        ..summary(Status::Finished)
    };
    let text = render(&finished, Path::new("out/wiring-2"), true, false, 76);
    insta::assert_snapshot!(text, @r"
    ╭─ wiring-2 ──────────────────────────────────────────────────── finished ─╮
    │ tip         at the end: u₁ 123 ± 5 µm · u₃ 1.25 mm                       │
    │             largest: u₁ 123.0 ± 1.4 µm · u₃ 1.25 mm                      │
    │ pressure    largest in the fluid: 9.0 ± 0.3 kPa                          │
    │ errors      ± by a companion run: 2 cells per segment, 4 per bladder,    │
    │             rtol 1·10⁻⁴ · 6.20 s                                         │
    │ balances    relative residuals: energy 3.0·10⁻⁸                          │
    │ integrator  12 345 steps, mostly of order 4 · 0 rejected · 371 unknowns  │
    │ time        500 ms simulated in 12.3 s · 24.6 s per simulated second     │
    │ spent on    residual 33 % · Jacobian 24 % · linear solver 33 % ·         │
    │             output 4 %                                                   │
    ╰─ report.html and data in out/wiring-2 ───────────────────────────────────╯
    ");
    assert!(is_a_box(&text, 76));
}

#[test]
fn a_failure_says_why_and_warnings_come_first() {
    let mut failed = summary(Status::Failed);
    failed.reason = Some("the step became smaller than round-off at t = 0.0213 s".to_string());
    failed.warnings = (1..=7)
        .zip(["W004", "W021", "W003", "W007", "W005", "other", "W005"])
        .map(|(k, code)| format!("{code} warning number {k} that goes on for quite a few words"))
        .collect();
    failed.balances.volume_residual_relative = f64::NAN;
    let text = render(&failed, Path::new("out/wiring-2"), true, false, 60);
    insta::assert_snapshot!(text, @r"
    ╭─ wiring-2 ────────────────────────────────────── FAILED ─╮
    │ why         the step became smaller than round-off at t  │
    │             = 0.0213 s                                   │
    │ warning     W007 warning number 4 that goes on for quite │
    │             a few words                                  │
    │ warning     W004 warning number 1 that goes on for quite │
    │             a few words                                  │
    │ warning     W021 warning number 2 that goes on for quite │
    │             a few words                                  │
    │             others in summary.json: W003 Inertia or      │
    │             losses of the flow left out, W005 Beam too   │
    │             short for a rod model, 1 more (slcbeam       │
    │             explain W003)                                │
    │ tip         at the end: u₁ 123 µm · u₃ 1.25 mm           │
    │             largest: u₁ 123 µm · u₃ 1.25 mm              │
    │ pressure    largest in the fluid: 9.01 kPa               │
    │ balances    relative residuals: energy 3.0·10⁻⁸ ·        │
    │             volume –                                     │
    │ integrator  12 345 steps, mostly of order 4 ·            │
    │             0 rejected · 371 unknowns                    │
    │ time        500 ms simulated in 12.3 s · 24.6 s per      │
    │             simulated second                             │
    ╰─ report.html and data in out/wiring-2 ───────────────────╯
    ");
    assert!(is_a_box(&text, 60));
    let painted = render(&failed, Path::new("out/wiring-2"), true, true, 60);
    assert!(painted.contains("\u{1b}[1;31mFAILED"));
}

/// Goal: bands stand beside the numerical errors of what is told, in a box of any width; what does not spread has none.
#[test]
fn bands_are_told() {
    let mut known = summary(Status::Finished);
    let band = |value: f64, share: f64| Band {
        value,
        numerical_error: Some(0.002 * value),
        sd: 0.5 * share * value,
        low: (1.0 - share) * value,
        high: (1.0 + share) * value,
        samples: 64,
        drawn: 64,
    };
    known.bands = [
        ("tip_u1_m.max_abs", band(1.23e-4, 0.1)),
        ("tip_u3_m.max_abs", band(1.25e-3, 0.0)),
        ("max_pressure_pa.max_abs", band(9010.0, 0.002)),
        ("max_pressure_pa.final", band(9010.0, 0.5)),
    ]
    .map(|(name, band)| (name.to_owned(), band))
    .into();
    let text = |width| render(&known, Path::new("out/wiring-2"), true, false, width);
    for part in [
        "u₁ 111 µm … 135 µm (± 246 nm numerically)",
        "p 8.992 kPa … 9.028 kPa (± 18 Pa numerically)",
    ] {
        let words = text(100).replace('│', " ");
        let words: Vec<&str> = words.split_whitespace().collect();
        assert!(words.join(" ").contains(part), "{}", text(100));
    }
    assert!(!text(100).contains("u₃ 1.25 mm …"), "{}", text(100));
    for width in [50, 64, 100] {
        assert!(is_a_box(&text(width), width), "{}", text(width));
    }
}

/// Goal: powers stand in watts beside the energies of the run.
#[test]
fn powers_are_told() {
    let energy = |last, power| Quantity {
        last: Some(last),
        window_power_w: Some(power),
        ..Quantity::default()
    };
    let mut harvested = summary(Status::Finished);
    let energies = [
        ("input_energy_j", energy(3.0, 0.0123)),
        ("harvested_energy_j", energy(1.0, 4.5e-3)),
    ];
    harvested.quantities = energies.map(|(name, q)| (name.to_string(), q)).into();
    let text = render(&harvested, Path::new("out"), true, false, 100);
    let row = "put in 3.00 J (12.3 mW in the window) · harvested 1.00 J (4.50 mW in the window)";
    assert!(text.contains(row), "{text}");
}

#[test]
fn a_long_path_is_not_cut() {
    let path = "out/".to_string() + &"long/".repeat(20);
    assert!(render(&summary(Status::Finished), Path::new(&path), false, false, 60).contains(&path));
}

/// Exit code, standard output and standard error of the program.
pub fn slcbeam(here: &Path, arguments: &[&str]) -> (i32, String, String) {
    let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_slcbeam"));
    let output = command
        .current_dir(here)
        .args(arguments)
        .output()
        .expect("the program starts");
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("text");
    (
        output.status.code().unwrap_or(-1),
        text(output.stdout),
        text(output.stderr),
    )
}

/// Goal: whatever has a name is explained: messages, keys, effects, columns, symbols, and words that people use instead.
#[test]
fn messages_and_keys_are_explained() {
    let here = Path::new(".");
    let (code, all, _) = slcbeam(here, &["explain"]);
    assert!(code == 0 && all.lines().count() > 30, "{all}");
    let (_, one, _) = slcbeam(here, &["explain", "w006"]);
    assert!(one.contains("Mathieu"), "{one}");
    let (_, key, _) = slcbeam(here, &["explain", "/bladders/permeability_m4"]);
    assert!(key.contains("[m^4]") && key.contains("TubeDefaults"), "{key}");
    let (_, flow, _) = slcbeam(here, &["explain", "flow"]);
    assert!(
        flow.contains("EffectChoices/flow") && flow.contains("flow_m3_s"),
        "{flow}"
    );
    let (_, network, _) = slcbeam(here, &["explain", "network"]);
    assert!(
        network.contains("Network/chains") && network.contains("Network/turbines"),
        "{network}"
    );
    assert_eq!(
        slcbeam(here, &["explain", "W6"]).1,
        slcbeam(here, &["explain", "w006"]).1
    );
    let (_, effect, _) = slcbeam(here, &["explain", "finite_rotation", "--json"]);
    assert!(serde_json::from_str::<Value>(&effect).unwrap()[0]["meaning"].is_string());
    for (asked, words) in [
        ("resistance", ["permeability_m4", "resistance_pa_s_m3"]),
        ("pumps", ["pressure_pa", "flow_m3_s"]),
        ("tip_angle", ["tip_angle (column): ", "[rad], a column of history.csv"]),
        ("harvested_energy_j", ["energy harvested [J]", "summary.json"]),
        ("port_inlet_of_bladder_1_flow", ["port_NAME_flow (result): ", "flow in"]),
        ("EI", ["EI (symbol): bending stiffness [N m²]", "E1 in docs/model.md"]),
        ("Re", ["Reynolds number of a tube", "E52"]),
        ("drained", ["(word): bladders whose pressure", "drained"]),
        ("Probe", ["/probes: ", "Probe/at"]),
        ("CheckValve", ["Tube/check_valve", "Leakage conductance"]),
        (
            "dashpot",
            ["keys with this word in their descriptions", "damping_x_n_s_m"],
        ),
    ] {
        let (code, said, err) = slcbeam(here, &["explain", asked]);
        assert!(
            code == 0 && words.iter().all(|word| said.contains(word)),
            "{asked}: {said}{err}"
        );
    }
    let (_, symbol, _) = slcbeam(here, &["explain", "EA", "--json"]);
    assert_eq!(serde_json::from_str::<Value>(&symbol).unwrap()[0]["symbol"], "EA");
    let (code, _, err) = slcbeam(here, &["explain", "tip_angel"]);
    assert!(code == 2 && err.contains("did you mean tip_angle"), "{err}");
    let (code, _, err) = slcbeam(here, &["explain", "finite_rotaton"]);
    assert!(code == 2 && err.contains("did you mean finite_rotation"), "{err}");
}

/// Goal: what to do stands at the end of a warning, which is not cut; the tip has its sign, when it was furthest away, and where it ends.
#[test]
fn warnings_are_whole_and_the_tip_has_its_end() {
    let mut told = summary(Status::Finished);
    let long = "W001 pressures bend the beam 124 times as much as moments open bladders; energies and efficiencies are wrong by that \
                factor, and so is whatever they are compared with; what to do stands at the very end: use \"reciprocal\"";
    told.warnings = vec![long.to_string()];
    let tip = told.quantities.get_mut("tip_u1_m").expect("a tip");
    (tip.last, tip.max_abs, tip.extreme, tip.max_abs_at_s) = (Some(1.14e-3), Some(2.57e-3), Some(-2.57e-3), Some(0.0));
    let text = render(&told, Path::new("out/wiring-2"), true, false, 60);
    let words: Vec<&str> = text.split(['│', ' ', '\n']).filter(|word| !word.is_empty()).collect();
    let text = words.join(" ");
    assert!(text.contains("stands at the very end: use \"reciprocal\""), "{text}");
    assert!(text.contains("tip at the end: u₁ 1.14 mm"), "{text}");
    assert!(text.contains("largest: u₁ −2.57 mm at 0 s"), "{text}");
}

/// Goal: a name of output with control characters is refused at once, by every command that writes one.
#[test]
fn names_of_output_hold_no_control_characters() {
    let dir = tempfile::tempdir().expect("a folder");
    let name = dir.path().join("a\nb");
    let name = name.to_str().expect("text");
    for words in [
        vec!["run", "cases/curl.json", "--out", name],
        vec![
            "sweep",
            "cases/curl.json",
            "--vary",
            "/beam/width_m=0.01:0.02:2",
            "--out",
            name,
        ],
        vec!["merge", "x", "--out", name],
        vec!["report", "x", "--out", name],
        vec!["export", "x", "--out", name],
        vec!["compare", "x", "y", "--out", name],
        vec!["new", "beam", name],
    ] {
        let (code, _, err) = slcbeam(Path::new("."), &words);
        assert!(code == 2 && err.contains("control characters"), "{words:?}: {err}");
        assert!(!Path::new(name).exists(), "{words:?}");
    }
}

/// Goal: value and error end at the same digit; the error is rounded up.
#[test]
fn a_value_and_its_error_are_rounded_alike() {
    for (value, error, unit, text) in [
        (0.0215123, 0.00037, "m", "21.5 ± 0.4 mm"),
        (0.0215123, 0.00131, "m", "21.5 ± 1.4 mm"),
        (-4072.0, 12.0, "Pa", "−4.072 ± 0.012 kPa"),
        (9.1e-6, 6e-7, "m", "9.1 ± 0.6 µm"),
        (2e-6, 4e-6, "J", "2.0 ± 4.0 µJ"),
        (3.2e-8, 4.58e-7, "J", "32 ± 458 nJ"),
        (-1e-23, 3e-23, "W", "−1.0·10⁻¹¹ pW ± 3·10⁻¹¹ pW"),
        (1.0, 0.0, "m", "1.000 ± 0.001 m"),
        (0.0, 1e-3, "m", "0.0 ± 1.0 mm"),
        (2.5e-6, 3e-8, "m^3/s", "(2.50 ± 0.03)·10⁻⁶ m³/s"),
        (0.0, 0.0, "J", "0 J"),
    ] {
        assert_eq!(with_error(value, error, unit), text);
    }
}
