//! Sensitivities along runs against differences of complete runs, exact identities, and what is refused.

use std::path::Path;

use serde_json::{Value, json};
use slcbeam::case::parameter::{CHANGE, Parameter, STEPS};
use slcbeam::case::{self, Case};
use slcbeam::dae::{BeamDae, Dae, Fault, Neighbours, Pattern, Seeds};
use slcbeam::discrete::{System, start};
use slcbeam::error::Error;
use slcbeam::run::dynamics;
use slcbeam::run::record::Memory;
use slcbeam::run::summary::{Status, Summary};
use slcbeam::sundials::{Absolute, Ida, IdaOptions, StartOptions, consistent_sensitivities, consistent_start};

fn parse(value: &Value, sets: &[String]) -> Case {
    case::parse(&value.to_string(), Path::new("test.json"), Path::new(""), sets)
        .unwrap_or_else(|e| panic!("{e:?}"))
        .case
}

/// A short beam of two segments with some waves in it, or none; tolerances at which differences of runs keep five digits.
fn beam(end_s: f64) -> Value {
    json!({
        "name": "short",
        "beam": {"length_m": 0.1, "height_m": 0.0216, "width_m": 0.05, "young_modulus_pa": 2e6, "density_kg_m3": 950,
                 "axial_stiffness_factor": 0.53, "bending_stiffness_factor": 0.6,
                 "damping": {"bending_time_s": 1e-3, "axial_time_s": 1e-3}},
        "ends": {"root": "clamped", "tip": "free"},
        "effects": "full",
        "mesh": {"segments": 2, "cells_per_segment": 3, "cells_per_bladder": 2},
        "time": {"end_s": end_s, "output_interval_s": end_s / 40.0, "window_s": end_s / 2.0},
        "solver": {"rtol": 1e-8, "method": "ida", "max_order": 5}
    })
}

/// The same with two bladders a row.
fn wet(end_s: f64) -> Value {
    let mut case = beam(end_s);
    case["mesh"] = json!({"cells_per_segment": 3, "cells_per_bladder": 2});
    case["fluid"] = json!({"density_kg_m3": 1000, "viscosity_pa_s": 8.68e-4});
    case["bladders"] = json!({
        "per_row": 2, "length_m": 0.046, "height_m": 0.0078, "width_m": 0.0078, "permeability_m4": 1.55e-12,
        "area_per_pressure_m2_per_pa": 1.75e-10,
        "area_per_moment_m2_per_n_m": {"opening": 3.75e-6, "closing": 6.54e-6},
        "area_per_force_m2_per_n": {"tension": 3.64e-8, "compression": 6.31e-8},
        "coupling": "reciprocal"
    });
    case["tubes"] = json!({"length_m": 0.02, "radius_m": 0.001, "permeability_m4": 6.72e-13});
    case["network"] = json!({"chains": [{"bladders": [1, 2], "ends": ["sealed", "sealed"]}]});
    case["start"] =
        json!({"pressures": [{"bladders": [1], "pressure_pa": 1000.0}, {"bladders": [-2], "pressure_pa": 300.0}]});
    case
}

fn finished(case: &Case, parameters: &[Parameter]) -> (Memory, Summary) {
    let mut memory = Memory::default();
    let outcome = dynamics::run_with(case, parameters, &mut memory).expect("a run");
    assert_eq!(outcome.summary.status, Status::Finished, "{:?}", outcome.fault);
    (memory, outcome.summary)
}

/// Largest deviation of every column's derivative from differences of complete runs (fourth order over `part` and twice that of
/// the number), relative to the largest derivative of the column or, where that says less, to a tenth of the column's own size over
/// the number.
fn deviations(value: &Value, pointer: &str, part: f64) -> Vec<(String, f64)> {
    let case = parse(value, &[]);
    let parameter = Parameter::find(&case, pointer).unwrap();
    let p = parameter.value;
    let runs = [1.0, -1.0, 2.0, -2.0].map(|k| {
        let set = format!("{pointer}={:e}", p * (1.0 + part * k));
        finished(&parse(value, &[set]), &[]).0
    });
    let (run, _) = finished(&case, &[parameter]);
    let names = run.header.columns.iter().map(|c| c.name.clone());
    let compared = names.filter_map(|name| {
        let slopes = run.sensitivity(&name, pointer)?;
        let own = run.column(&name)?;
        let [a, b, c, d] = runs.each_ref().map(|run| run.column(&name).unwrap());
        let exact: Vec<f64> = (0..own.len())
            .map(|i| (8.0 * (a[i] - b[i]) - (c[i] - d[i])) / (12.0 * part * p))
            .collect();
        let size = |all: &[f64]| all.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let scale = size(&exact).max(0.1 * size(&own) / p.abs());
        let worst = exact
            .iter()
            .zip(&slopes)
            .fold(0.0_f64, |m, (e, s)| m.max((e - s).abs()));
        (scale > 0.0).then(|| (name, worst / scale))
    });
    compared.collect()
}

/// Every column agrees: to 5e-5 what is read off the state, to 1e-3 what is integrated. Runs at rtol 1e-8 leave some 1e-7 in the state
/// and, over differences of `part`, a hundred times that in the reference; integrals are carried without error control.
fn agree(value: &Value, pointer: &str, part: f64) {
    for (name, deviation) in deviations(value, pointer, part) {
        println!("{name} by {pointer}: {deviation:.1e}");
        let integral = ["work", "dissipated", "harvested"]
            .iter()
            .any(|start| name.starts_with(start));
        let tolerance = if integral { 1e-3 } else { 5e-5 };
        assert!(deviation < tolerance, "{name} by {pointer}: {deviation:.1e}");
    }
}

/// A dry beam plucked: stiffness, density, damping and the pluck itself.
#[test]
fn dry_beam() {
    let mut value = beam(0.02);
    value["start"] = json!({"u1_m": {"polynomial": {"coefficients": [0.0, 0.0, 0.02]}}});
    for pointer in [
        "/beam/young_modulus_pa",
        "/beam/density_kg_m3",
        "/beam/length_m",
        "/beam/damping/bending_time_s",
        "/start/u1_m/polynomial/coefficients/2",
    ] {
        agree(&value, pointer, 0.01);
    }
}

/// Two chains of bladders, one through a tube: fluid, tubes, areas, the pressures at the start.
#[test]
fn wet_beam() {
    let value = wet(0.01);
    for pointer in [
        "/fluid/viscosity_pa_s",
        "/tubes/permeability_m4",
        "/bladders/permeability_m4",
        "/bladders/area_per_pressure_m2_per_pa",
        "/bladders/area_per_moment_m2_per_n_m/opening",
        "/beam/young_modulus_pa",
        "/start/pressures/0/pressure_pa",
    ] {
        agree(&value, pointer, 0.01);
    }
}

/// A force that jumps on at the tip: its size, and the instant at which it does. Accelerations jump there, and so do the
/// sensitivities of velocities to the instant. (No sample lies within 2 % of the instant, where differences straddle the jump.)
#[test]
fn force_that_switches() {
    let mut value = beam(0.02);
    value["ends"]["tip"] =
        json!({"free": {"force_x_n": {"ramp": {"from": 0.0, "to": 0.05, "start_s": 0.0043, "duration_s": 0.0}}}});
    let ramp = "/ends/tip/free/force_x_n/ramp";
    for key in ["to", "start_s"] {
        agree(&value, &format!("{ramp}/{key}"), 0.01);
    }
}

/// A root pulled to and fro in a zigzag: where its velocity jumps the unknowns, counted from the root, are restated. How far it
/// goes, and when it turns (differences over 4 and 9 us: the jump excites waves of 1e4 rad/s). The tip is not jerked along with the
/// root: its velocity hardly changes over 86 us around the instant.
#[test]
fn driven_end_that_turns() {
    let mut value = beam(0.02);
    let table = json!({"times_s": [0.0, 0.0043, 0.03], "values": [0.0, 0.001, -0.002], "interpolation": "linear"});
    value["ends"]["root"] = json!({"clamped": {"u1_m": {"table": table}}});
    let (turn, jump) = (0.0043, 0.001 / 0.0043 + 0.003 / 0.0257);
    value["time"]["output_interval_s"] = json!(turn / 100.0);
    let u = finished(&parse(&value, &[]), &[]).0.column("tip_u1").unwrap();
    let change = (u[101] - 2.0 * u[100] + u[99]) / (turn / 100.0);
    assert!(change.abs() < 0.1 * jump, "{change} of {jump}");
    value["time"]["output_interval_s"] = json!(0.0005);
    for key in ["values/1", "times_s/1"] {
        let pointer = format!("/ends/root/clamped/u1_m/table/{key}");
        agree(&value, &pointer, 0.001);
    }
}

/// A shaken root with a smooth start: its frequency moves the end of the ramp too. The figures of the summary (final and largest
/// value, root mean square, work put in) against differences of those of complete runs.
#[test]
fn figures_of_a_shaken_beam() {
    let mut value = wet(0.05);
    value["ends"]["root"] =
        json!({"clamped": {"u1_m": {"sine": {"amplitude": 0.001, "frequency_hz": 40.0, "ramp_cycles": 1.0}}}});
    for key in ["amplitude", "frequency_hz"] {
        let pointer = format!("/ends/root/clamped/u1_m/sine/{key}");
        let case = parse(&value, &[]);
        let parameter = Parameter::find(&case, &pointer).unwrap();
        let p = parameter.value;
        let runs = [1.0, -1.0, 2.0, -2.0].map(|k| {
            let set = format!("{pointer}={:e}", p * (1.0 + 0.005 * k));
            finished(&parse(&value, &[set]), &[]).1
        });
        let (_, summary) = finished(&case, &[parameter]);
        for (name, slopes) in &summary.sensitivities[&pointer].quantities {
            let of = |s: &Summary, figure: &str| s.quantities[name].figures().find(|f| f.0 == figure).unwrap().1;
            // what is final may be passing through zero
            let size = summary.quantities[name]
                .figures()
                .fold(0.0_f64, |m, f| m.max(f.1.abs()));
            for (figure, slope) in slopes.figures() {
                let [a, b, c, d] = runs.each_ref().map(|s| of(s, figure));
                let exact = (8.0 * (a - b) - (c - d)) / (12.0 * 0.005 * p);
                let scale = exact.abs().max(0.1 * size / p);
                let deviation = (slope - exact).abs() / scale;
                println!("{name} {figure} {deviation:.1e}");
                // a largest value is one of the samples: its derivative at that time, which moves on with the frequency
                let moves = key == "frequency_hz" && figure.contains("max");
                assert!(
                    moves || deviation < 1e-4,
                    "{name} {figure} by {key}: {slope:e} for {exact:e}"
                );
            }
        }
    }
}

/// A run that starts in equilibrium under its load: the start's own sensitivity comes from differences of equilibria.
#[test]
fn start_in_equilibrium() {
    let mut value = beam(0.01);
    value["ends"]["tip"] = json!({"free": {"force_x_n": {"sine": {"amplitude": 0.05, "frequency_hz": 20.0, "phase_rad": std::f64::consts::FRAC_PI_2, "ramp_cycles": 0.0}}}});
    value["start"] = json!({"equilibrium": {"loads_at_s": 0.0}});
    for pointer in ["/beam/young_modulus_pa", "/ends/tip/free/force_x_n/sine/amplitude"] {
        agree(&value, pointer, 0.01);
    }
}

/// The systems of a case with one number changed beside its own.
fn with_parameter(case: &Case, pointer: &str) -> BeamDae {
    let dae = BeamDae::new(System::new(case));
    let parameter = Parameter::find(case, pointer).unwrap();
    let systems = STEPS.map(|(step, _)| {
        let changed = parameter
            .changed(case, parameter.value * (1.0 + step * CHANGE))
            .unwrap();
        dae.system().like(&changed).expect("the same unknowns")
    });
    let neighbours = Neighbours::new(&dae, systems);
    dae.with_neighbours(vec![neighbours])
}

/// The volume of a closed network is kept whatever the viscosity: the sum of its areas' sensitivities stays zero, to the round-off
/// and Newton's tolerance of some hundred steps (1e-9 of the largest of them).
#[test]
fn closed_network_keeps_its_volume() {
    let case = parse(&wet(0.01), &[]);
    let mut dae = with_parameter(&case, "/fluid/viscosity_pa_s");
    let (system, now) = dae.instant(0.0);
    let layout = system.layout.clone();
    let chain: Vec<usize> = (0..2 * system.fluid.as_ref().unwrap().cells_per_bladder)
        .map(|i| layout.area + i)
        .collect();
    let mut y = start::state(system, &case, now);
    let mut yp = vec![0.0; y.len()];
    consistent_start(&mut dae, 0.0, &mut y, &mut yp, &StartOptions::default()).unwrap();
    let (mut s, mut sp) = (vec![vec![0.0; y.len()]], vec![vec![0.0; y.len()]]);
    consistent_sensitivities(&mut dae, 0.0, [&y, &yp], &mut s, &mut sp).unwrap();
    let options = IdaOptions {
        relative: 1e-6,
        absolute: Absolute::Same(1e-6),
        ..IdaOptions::default()
    };
    let mut ida = Ida::new(dae, 0.0, &y, &yp, &options).unwrap();
    ida.carry(&s, &sp).unwrap();
    let (mut largest, mut lost) = (0.0_f64, 0.0_f64);
    while !ida.step(0.01).unwrap().stopped {
        let t = ida.time();
        ida.sensitivity(0, t, [&mut s[0], &mut sp[0]]).unwrap();
        largest = chain.iter().fold(largest, |m, &i| m.max(s[0][i].abs()));
        lost = lost.max(chain.iter().map(|&i| s[0][i]).sum::<f64>().abs());
    }
    println!("{lost:e} of {largest:e}");
    assert!(largest > 1e-3 && lost < 1e-9 * largest, "{lost:e} of {largest:e}");
}

/// The beam without its own `tangent`.
struct Plain(BeamDae);

impl Dae for Plain {
    fn len(&self) -> usize {
        self.0.len()
    }
    fn differential(&self) -> &[bool] {
        self.0.differential()
    }
    fn pattern(&self) -> &Pattern {
        self.0.pattern()
    }
    fn residual(&mut self, t: f64, y: &[f64], yp: &[f64], residual: &mut [f64]) -> Result<(), Fault> {
        self.0.residual(t, y, yp, residual)
    }
    fn jacobian(&mut self, t: f64, y: &[f64], yp: &[f64], seeds: Seeds<'_>, values: &mut [f64]) -> Result<(), Fault> {
        self.0.jacobian(t, y, yp, seeds, values)
    }
    fn name(&self, unknown: usize) -> String {
        self.0.name(unknown)
    }
}

/// `[E41]` `F_y s + F_y' s'` by dual numbers is what the Jacobian's columns add up to, for more directions than fit a sweep: exact
/// both, so to round-off of a sum (1e-12 of its largest term or so).
#[test]
fn tangent_is_the_jacobian_applied() {
    let dae = BeamDae::new(System::new(&parse(&wet(0.01), &[])));
    let n = dae.len();
    let wave = |k: usize| -> Vec<f64> { (0..n).map(|i| ((i * (k + 2)) as f64).sin()).collect() };
    let (y, yp): (Vec<f64>, Vec<f64>) = (wave(50).iter().map(|y| 0.1 * y).collect(), wave(51));
    let (along, rates): (Vec<_>, Vec<_>) = ((0..11).map(wave).collect(), (20..31).map(wave).collect());
    let (along, rates): (Vec<&[f64]>, Vec<&[f64]>) = (
        along.iter().map(Vec::as_slice).collect(),
        rates.iter().map(Vec::as_slice).collect(),
    );
    let all = |dae: &mut dyn FnMut(&mut [&mut [f64]])| {
        let mut out = vec![vec![f64::NAN; n]; 11];
        dae(&mut out.iter_mut().map(Vec::as_mut_slice).collect::<Vec<_>>());
        out
    };
    let (mut own, mut plain) = (dae.clone(), Plain(dae));
    let swept = all(&mut |out| own.tangent(0.001, &y, &yp, [&along, &rates], out).unwrap());
    let summed = all(&mut |out| plain.tangent(0.001, &y, &yp, [&along, &rates], out).unwrap());
    for (a, b) in swept.iter().flatten().zip(summed.iter().flatten()) {
        assert!((a - b).abs() <= 1e-11 * (1.0 + a.abs().max(b.abs())), "{a} {b}");
    }
}

/// `[E40]` The difference formula: exact for p⁴, in error by 4 ε⁴ for 1/p; and the residual's slope by the modulus against its own
/// exact value, stiffness being proportional to it: `F(2 E) - F(E)` at the same unknowns and scales.
#[test]
fn difference_formula_is_of_fourth_order() {
    let case = parse(&wet(0.01), &[]);
    let mut dae = with_parameter(&case, "/beam/density_kg_m3");
    let slope = |dae: &mut BeamDae, f: fn(f64) -> f64| {
        let mut out = [0.0];
        let done = dae.neighbours_mut()[0].slope(&mut out, |j, _, out| {
            out[0] = f(1.0 + CHANGE * STEPS[j].0);
            Ok::<(), ()>(())
        });
        assert_eq!(done, Ok(()));
        out[0]
    };
    assert!((slope(&mut dae, |p| p.powi(4)) - 4.0).abs() < 1e-11);
    let error = slope(&mut dae, |p| 1.0 / p) + 1.0;
    assert!(error.abs() < 1e-11 && error.abs() > 1e-13, "{error:e}");

    // a dry beam without damping by time is linear in E, but for the damping, which is proportional to E as well
    let case = parse(&beam(0.01), &[]);
    let mut dae = with_parameter(&case, "/beam/young_modulus_pa");
    let double = parse(&beam(0.01), &["/beam/young_modulus_pa=4e6".into()]);
    let mut twice = BeamDae::new(dae.system().like(&double).unwrap());
    let n = dae.len();
    let y: Vec<f64> = (0..n).map(|i| 0.1 * (i as f64).sin()).collect();
    let yp: Vec<f64> = (0..n).map(|i| (i as f64).cos()).collect();
    let (mut f, mut g, mut out) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
    dae.residual(0.0, &y, &yp, &mut f).unwrap();
    twice.residual(0.0, &y, &yp, &mut g).unwrap();
    dae.slope(0, 0.0, &y, &yp, &mut out).unwrap();
    let largest = f.iter().chain(&g).fold(0.0_f64, |m, x| m.max(x.abs()));
    for i in 0..n {
        assert!(
            (out[i] - (g[i] - f[i])).abs() < 1e-11 * largest,
            "{}: {} {}",
            dae.name(i),
            out[i],
            g[i] - f[i]
        );
    }
}

/// Checkpoints restart the integrator with the sensitivities that it has reached: derivatives change by what the tolerance leaves.
#[test]
fn checkpoints_change_nothing() {
    let mut value = wet(0.01);
    let pointer = "/fluid/viscosity_pa_s";
    let slopes = |value: &Value| {
        let case = parse(value, &[]);
        let parameter = Parameter::find(&case, pointer).unwrap();
        let memory = finished(&case, &[parameter]).0;
        let of = |name| memory.sensitivity(name, pointer).unwrap();
        (memory.checkpoints.len(), [of("max_pressure"), of("dissipated_tubes")])
    };
    let (none, through) = slopes(&value);
    value["time"]["checkpoint_interval_s"] = json!(0.003);
    let (some, restarted) = slopes(&value);
    assert_eq!((none, some), (0, 3));
    for (through, restarted) in through.iter().zip(&restarted) {
        let largest = through.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        for (a, b) in through.iter().zip(restarted) {
            assert!((a - b).abs() < 1e-3 * largest, "{a:e} {b:e} of {largest:e}");
        }
    }
}

/// Sensitivities are IDA's: a case that would take a one-step method takes IDA, and says so.
#[test]
fn integrator_is_ida() {
    let mut value = beam(0.001);
    value["solver"] = json!({"rtol": 1e-4, "method": "esdirk46"});
    let case = parse(&value, &[]);
    let usual = finished(&case, &[]).1.effects["method"].clone();
    let parameter = Parameter::find(&case, "/beam/young_modulus_pa").unwrap();
    let method = finished(&case, &[parameter]).1.effects["method"].clone();
    assert_eq!(usual.value, "ESDIRK46");
    assert_eq!(method.value, "IDA");
    assert!(method.reason.contains("ESDIRK46"), "{}", method.reason);
}

/// A number that moves a switching time past the end of the run has no derivative there.
#[test]
fn switching_times_stay_in_order() {
    let mut value = beam(0.01);
    value["ends"]["tip"] =
        json!({"free": {"force_x_n": {"ramp": {"from": 0.0, "to": 0.05, "start_s": 0.00999, "duration_s": 0.0}}}});
    let case = parse(&value, &[]);
    let parameter = Parameter::find(&case, "/ends/tip/free/force_x_n/ramp/start_s").unwrap();
    match dynamics::run_with(&case, &[parameter], &mut Memory::default()) {
        Err(Error::Usage(what)) => assert!(what.contains("switching times"), "{what}"),
        other => panic!("{other:?}"),
    }
}

/// What has no derivative is refused with one message.
#[test]
fn refusals() {
    let mut value = wet(0.01);
    value["start"]["u1_m"] = json!(0.0);
    let case = parse(&value, &[]);
    let refused = |pointer: &str| match Parameter::find(&case, pointer) {
        Err(Error::Usage(what)) => what,
        other => panic!("{pointer}: {other:?}"),
    };
    for (pointer, word) in [
        ("fluid/viscosity_pa_s", "nearest is /fluid/viscosity_pa_s"),
        ("/fluid/viscosty_pa_s", "nearest is /fluid/viscosity_pa_s"),
        ("/fluid", "no number"),
        ("/bladders/per_row", "count"),
        ("/start/u1_m", "it is 0"),
        ("/name", "not a part of the model"),
        ("/time/end_s", "not a part of the model"),
        ("/solver/rtol", "not a part of the model"),
        ("/mesh/cells_per_segment", "not a part of the model"),
        ("/bladders/coupling", "no number"),
    ] {
        let what = refused(pointer);
        assert!(what.contains(word) && what.contains(pointer), "{what}");
    }
}
