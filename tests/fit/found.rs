//! What made the data is found again.

use slcbeam::results;
use slcbeam::results::fit::Fit;
use slcbeam::study::fit::abscissa::DrivenNumber;
use slcbeam::study::fit::problem::FitRequest;

use crate::common::*;

const ACTUATOR: &str = "cases/tour-actuator.json";
/// A dry cantilever that is pushed at its tip and hangs under its weight.
const CANTILEVER: &str = "cases/dry-cantilever.json";
const PUSHED: [&str; 4] = [
    "/ends/tip={\"free\": {\"force_x_n\": 0.1}}",
    "/loads=[{\"gravity\": {\"x_m_s2\": -5.0}}]",
    "/mesh/cells_per_segment=1",
    "/start={}",
];

/// Angle of the tip over the pressure of the pump, in degrees and kPa, with noise of 0.05 degrees.
fn angles(young: f64, opening: f64) -> String {
    let case = load(ACTUATOR, &[]);
    let mut noise = noise(3);
    let mut text = String::from("p_kpa,angle_deg\n");
    for k in 0..=12 {
        let pressure = 5e3 * f64::from(k);
        let angle = at_rest(
            &case,
            &[(YOUNG, young), (OPENING, opening), (PUMP, pressure)],
            "tip_angle",
        );
        text += &format!("{},{}\n", pressure / 1e3, angle.to_degrees() + 0.05 * noise());
    }
    text
}

/// Source: the actuator of the tour with another modulus and another opening coefficient, by the equilibria of the program itself. Goal: both
/// are found from angles over pressures, within three standard errors, which are a few per cent; the folder is whole.
#[test]
fn modulus_and_coupling_from_angles_over_pressures() {
    let dir = tempfile::tempdir().expect("a folder");
    let (young, opening) = (2.3e6, 4.4e-6);
    let data = file(&dir, "angles.csv", &angles(young, opening));
    let out = path(&dir, "fitted");
    let drive = format!("p_kpa={PUMP}");
    let (vary, coupling) = (format!("{YOUNG}=5e5:1e7"), format!("{OPENING}=1e-6:2e-5"));
    let asked = [
        "fit",
        ACTUATOR,
        &data,
        "--vary",
        &vary,
        "--vary",
        &coupling,
        "--match",
        "angle_deg=tip_angle",
        "--drive",
        &drive,
        "--noise",
        "angle_deg=0.05",
        "--out",
        &out,
    ];
    let found = json(&asked);
    for (k, truth) in [young, opening].into_iter().enumerate() {
        let error = number(&found["parameters"][k]["standard_error"]);
        assert!(off(&found, k, truth) < 3.0 && error < 0.05 * truth, "{found:#}");
    }
    assert!(found["unseen"].as_array().is_some_and(Vec::is_empty), "{found:#}");
    // the kept file is what was printed, and the fitted case gives the fitted angle
    let text = std::fs::read_to_string(dir.path().join("fitted/fit.json")).expect("a file");
    let kept = results::read::<Fit>(&text).expect("a fit").result;
    assert_eq!(kept.parameters[0].value, number(&found["parameters"][0]["value"]));
    for name in ["fit.csv", "fit.svg", "case.json", "report.html"] {
        assert!(dir.path().join("fitted").join(name).is_file(), "{name}");
    }
    let table = std::fs::read_to_string(dir.path().join("fitted/fit.csv")).expect("a table");
    let last: Vec<f64> = table
        .lines()
        .last()
        .expect("a row")
        .split(',')
        .map(|x| x.parse().expect("a number"))
        .collect();
    let fitted = load(&path(&dir, "fitted/fitted-case.json"), &[]);
    let angle = at_rest(&fitted, &[(PUMP, last[0])], "tip_angle");
    assert!(
        (angle - last[2]).abs() < 1e-9 && (last[2] - last[1] - last[3]).abs() < 1e-12,
        "{last:?}"
    );
}

/// Source: two bladders and a tube, whose pressures meet exponentially. Goal: the permeability of the tube is found from
/// two pressures over time, at instants and units of a laboratory's own.
#[test]
fn permeability_from_a_step_response() {
    let dir = tempfile::tempdir().expect("a folder");
    let tube = "/tubes/permeability_m4";
    let permeability = 9e-13;
    let probed = load(
        "cases/two-bladders.json",
        &["/mesh/cells_per_segment=4", "/probes=[{\"name\": \"p\", \"at\": 0.5}]"],
    );
    let memory = run(&probed, &[(tube, permeability)]);
    let [times, upper, lower] =
        ["t", "p_pressure_upper", "p_pressure_lower"].map(|name| memory.column(name).expect("a column"));
    let mut noise = noise(5);
    let mut text = String::from("time_ms;first_kpa;second_kpa\n");
    for k in (3..times.len()).step_by(37) {
        text += &format!("{};{}", 1e3 * times[k], 1e-3 * (upper[k] + 5.0 * noise()));
        // every third of the second was not measured
        text += &match k % 3 {
            0 => ";\n".to_owned(),
            _ => format!(";{}\n", 1e-3 * (lower[k] + 5.0 * noise())),
        };
    }
    let data = file(&dir, "pressures.csv", &text);
    let out = path(&dir, "fitted");
    let found = json(&[
        "fit",
        "cases/two-bladders.json",
        &data,
        "--set",
        "/mesh/cells_per_segment=4",
        "--vary",
        &format!("{tube}=1e-13:1e-11"),
        "--match",
        "first_kpa=pressure@bladder 1",
        "--match",
        "second_kpa=pressure@bladder -1",
        "--out",
        &out,
    ]);
    let error = number(&found["parameters"][0]["standard_error"]);
    assert!(
        off(&found, 0, permeability) < 3.5 && error < 0.05 * permeability,
        "{found:#}"
    );
    assert_eq!(load(&path(&dir, "fitted/fitted-case.json"), &[]).probes.len(), 1);
}

/// Sets of ten deflections with noise that is found from the fit; how many intervals of 95 % hold the truth, of each of two numbers.
fn held(seeds: u64) -> [u32; 2] {
    let case = load(CANTILEVER, &PUSHED);
    let gravity = "/loads/0/gravity/x_m_s2";
    let truth = [1.7e6, -6.0];
    let forces: Vec<f64> = (0..10).map(|k| 0.05 * f64::from(k)).collect();
    let exact: Vec<f64> = forces
        .iter()
        .map(|force| {
            at_rest(
                &case,
                &[(YOUNG, truth[0]), (gravity, truth[1]), (FORCE, *force)],
                "tip_u1",
            )
        })
        .collect();
    let asked = FitRequest {
        drives: vec![DrivenNumber::parse(&format!("f_n={FORCE}")).expect("a drive")],
        ..by_squares(&[(YOUNG, 3e5, 1e7), (gravity, -20.0, -0.5)], &["u_mm=tip_u1"])
    };
    let mut held = [0; 2];
    for seed in 0..seeds {
        let mut noise = noise(100 + seed);
        let rows = forces.iter().zip(&exact);
        let rows = rows.map(|(force, u)| format!("{force},{}\n", 1e3 * u + 0.02 * noise()));
        let text = format!("f_n,u_mm\n{}", rows.collect::<String>());
        count_held(&case, &asked, &text, truth, &mut held);
    }
    println!("held {held:?} of {seeds}");
    held
}

/// Goal: intervals that are too small by half would hold the truth in 20 of 30 sets; less than 26 come in 1 of 100 by chance.
#[test]
fn intervals_hold_the_truth() {
    assert!(held(30).iter().all(|held| *held >= 26));
}

/// Goal: 92 to 98 of 100: of 200 draws from 95 % less than 184 or more than 196 come in 3 and 2 of 100; of the seeds here they do not.
#[test]
#[ignore = "a minute"]
fn intervals_hold_the_truth_as_often_as_they_say() {
    let held = held(200);
    assert!(held.iter().all(|held| (184..=196).contains(held)), "{held:?} of 200");
}

/// Goal: two measurements that went wrong pull least squares away, and Huber's and Cauchy's losses hardly.
#[test]
fn losses_leave_outliers_aside() {
    let dir = tempfile::tempdir().expect("a folder");
    let case = load(CANTILEVER, &PUSHED);
    let truth = 1.7e6;
    let mut noise = noise(11);
    let mut text = String::from("f_n,u_mm\n");
    for k in 1..=20 {
        let force = 0.03 * f64::from(k);
        let u = 1e3 * at_rest(&case, &[(YOUNG, truth), (FORCE, force)], "tip_u1") + 0.01 * noise();
        text += &format!("{force},{}\n", if k % 9 == 0 { u + 1.0 } else { u });
    }
    let data = file(&dir, "pushed.csv", &text);
    let (vary, drive) = (format!("{YOUNG}=3e5:1e7"), format!("f_n={FORCE}"));
    let sets: Vec<&str> = PUSHED.iter().flat_map(|set| ["--set", set]).collect();
    let found = |more: &[&str], name: &str| {
        let out = path(&dir, name);
        let asked = [
            "fit",
            CANTILEVER,
            &data,
            "--vary",
            &vary,
            "--match",
            "u_mm=tip_u1",
            "--drive",
            &drive,
            "--out",
            &out,
        ];
        let found = json(&[&asked[..], &sets, more].concat());
        (number(&found["parameters"][0]["value"]) / truth - 1.0).abs()
    };
    let [plain, huber, cauchy] = [
        found(&[], "plain"),
        found(&["--robust", "huber"], "huber"),
        found(&["--robust", "cauchy"], "cauchy"),
    ];
    println!("off by {plain:.1e}, {huber:.1e}, {cauchy:.1e}");
    assert!(huber < 0.2 * plain && cauchy < 0.05 * plain, "{plain} {huber} {cauchy}");
}
