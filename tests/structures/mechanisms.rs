//! Mechanisms of flexible beams in motion.
//!
//! Source: one spectral element per beam (Lagrange polynomials at Gauss-Lobatto points, degree 12 to 23) and Radau's method of order 5, checked
//! with a second program; digits given are converged.

use serde_json::{Value, json};
use slcbeam::run::record::Memory;
use slcbeam::run::summary::Summary;

use crate::balances::close;
use crate::plans::{beam, extrapolated, held, joint, section, structure};
use crate::scene::finished;

/// Value of a column at a recorded time.
fn at(memory: &Memory, t: f64, column: &str) -> f64 {
    let times = memory.column("t").unwrap();
    let k = times
        .iter()
        .position(|time| (time - t).abs() < 1e-9)
        .expect("a recorded time");
    memory.column(column).expect(column)[k]
}

/// `sin` or `cos` of `8 (2.5 t⁴ - 3 t⁵ + t⁶)`, its series nested as signals, up to `t = 1`, then of `8 (t - 0.5)`; times a factor.
fn crank(sine: bool, factor: f64) -> Value {
    let phase = json!({"polynomial": {"coefficients": [0, 0, 0, 0, 20.0, -24.0, 8.0]}});
    // 1 - φ²/(n (n + 1)) (1 - ...): 14 terms reach 1e-12 at 4 rad
    let mut series = json!(1.0);
    for k in (1..15).rev() {
        let n = f64::from(if sine { 2 * k } else { 2 * k - 1 });
        let next = json!({"product": [-1.0 / (n * (n + 1.0)), phase, phase, series]});
        series = json!({"sum": [1.0, next]});
    }
    if sine {
        series = json!({"product": [phase, series]});
    }
    let phase = -4.0 + if sine { 0.0 } else { std::f64::consts::FRAC_PI_2 };
    let uniform = json!({"sine": {"amplitude": 1.0, "frequency_hz": 8.0 / std::f64::consts::TAU, "phase_rad": phase}});
    let step = |from: f64| json!({"ramp": {"from": from, "to": 1.0 - from, "start_s": 1.0, "duration_s": 0.0}});
    json!({"sum": [{"product": [factor, step(1.0), series]}, {"product": [factor, step(0.0), uniform]}]})
}

/// Joint of coupler and rocker at the start, to the right and up.
const PIN: [f64; 2] = [0.75, 0.580_947_501_931_112_5];

/// Displacements across and along a beam at this angle whose root is at the end of a crank of 0.2.
fn on_crank(angle: f64) -> Value {
    let (sin, cos) = angle.sin_cos();
    // across = up cos - right sin, along = up sin + right cos
    json!({"pinned": {
        "u1_m": {"sum": [0.2 * sin, crank(true, 0.2 * cos), crank(false, -0.2 * sin)]},
        "u3_m": {"sum": [-0.2 * cos, crank(true, 0.2 * sin), crank(false, 0.2 * cos)]}
    }})
}

/// Four-bar linkage whose crank of 0.2 turns at 8 rad/s after a smooth start: the root of its coupler is driven.
fn four_bar(cells: usize, end: f64, rtol: f64) -> Value {
    let coupler = PIN[1].atan2(PIN[0] - 0.2);
    let mut ab = held(
        beam("coupler", 0.8, coupler.to_degrees(), cells),
        "root",
        on_crank(coupler),
    );
    ab["origin_m"] = json!([0.0, 0.2]);
    ab["beam"] = section([1e5, 50.0, 1.0]);
    let rocker = PIN[1].atan2(PIN[0] - 0.9);
    let mut db = held(beam("rocker", 0.6, rocker.to_degrees(), cells), "root", json!("pinned"));
    db["origin_m"] = json!([0.0, 0.9]);
    db["probes"] = json!([{"name": "middle", "at": 0.5}]);
    let mut case = structure(
        section([1e4, 2.0, 1.0]),
        vec![ab, db],
        vec![joint("hinge", &["coupler.tip", "rocker.tip"])],
    );
    case["time"] = json!({"end_s": end, "output_interval_s": 0.5});
    case["solver"] = json!({"rtol": rtol});
    case
}

/// Angle of the rocker's chord, and the deflection of its middle.
fn rocker(memory: &Memory, t: f64) -> [f64; 2] {
    let of = |name: &str| at(memory, t, &format!("rocker.{name}"));
    let chord = [of("tip_z") - 0.9, of("tip_x")];
    let angle = chord[1].atan2(chord[0]);
    let (sin, cos) = PIN[1].atan2(PIN[0] - 0.9).sin_cos();
    let (across, along) = (of("middle_u1"), 0.3 + of("middle_u3"));
    let middle = [along * cos - across * sin, along * sin + across * cos];
    [angle, middle[1] * angle.cos() - middle[0] * angle.sin()]
}

fn compare(cells: [usize; 2], end: f64, rtol: f64, references: &[(f64, f64, f64)], most: [f64; 2]) {
    let runs = cells.map(|cells| finished(&four_bar(cells, end, rtol)));
    for (memory, summary) in &runs {
        close("four-bar", summary, 1e-5);
        assert!(memory.column("rocker.tip_x").is_some());
    }
    for &(t, angle, deflection) in references {
        let found = runs.each_ref().map(|(memory, _)| rocker(memory, t));
        let of = |k: usize| extrapolated([found[0][k], found[1][k]]);
        println!(
            "t = {t}: angle {:.9} for {angle} ({:.1e}), deflection {:.9} for {deflection} ({:.1e}); {found:?}",
            of(0),
            of(0) - angle,
            of(1),
            of(1) - deflection
        );
        assert!((of(0) - angle).abs() < most[0], "angle at {t}");
        assert!((of(1) - deflection).abs() < most[1], "deflection at {t}");
    }
}

/// Goal: angle and deflection of the rocker, extrapolated from two meshes.
#[test]
fn a_flexible_four_bar_turns_as_by_spectral_elements() {
    let references = [
        (0.5, 1.72874242565, -0.00193796825115),
        (1.0, 2.41664758437, 0.00403769690314),
    ];
    compare([16, 32], 1.0, 1e-8, &references, [2e-8, 2e-7]);
}

/// Goal: the same for two further revolutions, on finer meshes.
#[test]
#[ignore = "takes minutes"]
fn a_flexible_four_bar_turns_on_as_by_spectral_elements() {
    let references = [
        (0.5, 1.72874242565, -0.00193796825115),
        (1.0, 2.41664758437, 0.00403769690314),
        (2.0, 2.02140456252, -0.00134283334821),
        (3.0, 1.78505657891, -0.00671788452779),
    ];
    compare([32, 64], 3.0, 1e-10, &references, [1e-7, 1e-6]);
}

/// Slider-crank with the same crank: a rod of 0.6 to a mass of 0.5 in a slot of a stiff beam.
fn slider_crank(cells: usize) -> Value {
    let mut rod = held(beam("rod", 0.6, 0.0, cells), "root", on_crank(0.0));
    rod["origin_m"] = json!([0.0, 0.2]);
    rod["attachments"] = json!([{"at": 1.0, "mass_kg": 0.5}]);
    rod["probes"] = json!([{"name": "middle", "at": 0.5}]);
    let mut ground = held(beam("ground", 0.1, 0.0, 1), "root", json!("clamped"));
    ground["origin_m"] = json!([0.0, 0.7]);
    ground["beam"] = section([1e10, 1e8, 1.0]);
    let slot = json!({"at": ["ground.tip", "rod.tip"], "kind": {"slider": {"wall_stiffness_n_m": 1e8}}});
    let mut case = structure(section([1e4, 2.0, 1.0]), vec![rod, ground], vec![slot]);
    case["time"] = json!({"end_s": 1.0, "output_interval_s": 0.5});
    case["solver"] = json!({"rtol": 1e-8});
    case
}

/// Goal: place of the slider, angle of the rod and deflection of its middle, extrapolated from two meshes.
#[test]
fn a_flexible_slider_crank_moves_as_by_spectral_elements() {
    let runs = [16, 32].map(|cells| finished(&slider_crank(cells)));
    for (t, reference) in [
        (0.5, [0.750924226225, -0.196208133956, 0.000415559065139]),
        (1.0, [0.44938587061, 0.255224767875, -0.00250492575911]),
    ] {
        let found = runs.each_ref().map(|(memory, summary)| {
            close("slider-crank", summary, 1e-5);
            let of = |name: &str| at(memory, t, &format!("rod.{name}"));
            // the crank's end by its own angle, 8 (2.5 t⁴ - 3 t⁵ + t⁶)
            let phase = 8.0 * t.powi(4) * (2.5 - 3.0 * t + t * t);
            let a = [0.2 * phase.cos(), 0.2 * phase.sin()];
            let angle = (of("tip_x") - a[1]).atan2(of("tip_z") - a[0]);
            let middle = [0.5 + of("middle_u3") - a[0], of("middle_u1") - a[1]];
            [of("tip_z"), angle, middle[1] * angle.cos() - middle[0] * angle.sin()]
        });
        for k in 0..3 {
            let value = extrapolated([found[0][k], found[1][k]]);
            println!(
                "t = {t}, {k}: {value:.10} for {}: {:.1e}",
                reference[k],
                value - reference[k]
            );
            assert!(
                (value - reference[k]).abs() < 1e-6,
                "{t} {k}: {value} for {}",
                reference[k]
            );
        }
    }
}

/// Five free beams: a cross of rigidly joined arms, and a beam of 0.5 hinged to the first; half a sine pushes the second to the left.
fn assembly(cells: usize) -> Value {
    let mut arms: Vec<Value> = (0..4_u8)
        .map(|k| beam(&format!("arm{}", k + 1), 1.0, 90.0 * f64::from(k), 2 * cells))
        .collect();
    let pulse = json!({"product": [
        {"sine": {"amplitude": 0.5, "frequency_hz": 1.0}},
        {"ramp": {"from": 1.0, "to": 0.0, "start_s": 0.5, "duration_s": 0.0}}
    ]});
    arms[1]["ends"]["tip"] = json!({"free": {"force_x_n": pulse}});
    arms.push(beam("last", 0.5, 0.0, cells));
    let joints = vec![
        joint("rigid", &["arm1.root", "arm2.root", "arm3.root", "arm4.root"]),
        joint("hinge", &["arm1.tip", "last.root"]),
    ];
    let mut case = structure(section([1e3, 1.0, 1.0]), arms, joints);
    case["time"] = json!({"end_s": 2.0, "output_interval_s": 0.5});
    case["solver"] = json!({"rtol": 1e-8});
    case
}

fn places(run: &(Memory, Summary), t: f64) -> Vec<f64> {
    let names = ["arm1", "arm2", "arm3", "arm4", "last"];
    let columns = names
        .iter()
        .flat_map(|name| [format!("{name}.tip_z"), format!("{name}.tip_x")]);
    columns.map(|column| at(&run.0, t, &column)).collect()
}

/// Goal: tips of a free assembly after a push, extrapolated from two meshes, its energy after the push, and its balances.
#[test]
fn a_free_assembly_moves_as_by_spectral_elements() {
    assembled([8, 16], 1e-4);
}

/// Goal: the same on finer meshes.
#[test]
#[ignore = "takes minutes"]
fn a_free_assembly_converges_to_spectral_elements() {
    assembled([16, 32], 1e-5);
}

fn assembled(meshes: [usize; 2], within: f64) {
    let runs = meshes.map(|cells| finished(&assembly(cells)));
    for (t, reference) in [
        (
            1.0,
            [
                0.97313554082,
                0.049750629898,
                -0.13883554997,
                0.99336380941,
                -1.0233275961,
                -0.063985849787,
                0.077226507296,
                -0.99490118021,
                1.4677054534,
                -0.023851857049,
            ],
        ),
        (
            2.0,
            [
                0.93199922666,
                0.22589830878,
                -0.26715557524,
                0.9638027169,
                -1.0226908814,
                -0.19301359475,
                0.066439290675,
                -1.0037204097,
                1.2959225575,
                -0.11695026934,
            ],
        ),
    ] {
        let found = runs.each_ref().map(|run| places(run, t));
        let mut worst = 0.0_f64;
        for (k, reference) in reference.into_iter().enumerate() {
            worst = worst.max((extrapolated([found[0][k], found[1][k]]) - reference).abs());
        }
        println!("t = {t}: worst place {worst:.1e} of displacements up to 0.3");
        assert!(worst < within, "{t}: {worst:.1e}");
    }
    let energies = runs.each_ref().map(|run| {
        let of = |name: &str| at(&run.0, 2.0, name);
        close("free assembly", &run.1, 1e-6);
        assert!(
            (of("work_loads") + of("work_ends") - of("kinetic_energy") - of("axial_energy") - of("bending_energy"))
                .abs()
                < 1e-7
        );
        of("kinetic_energy") + of("axial_energy") + of("bending_energy")
    });
    let energy = extrapolated(energies);
    println!("energy {energy:.8} for 0.0431130059");
    assert!((energy / 0.0431130059 - 1.0).abs() < 1e-5);
}
