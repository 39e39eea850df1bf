//! Self-oscillations: Beck's column beyond flutter, compared with a long run and with the theory of its onset.

use slcbeam::case::{self, Case};
use slcbeam::error::{Code, Error};
use slcbeam::run::dynamics::{self, Outcome};
use slcbeam::run::energies::open_over_window;
use slcbeam::run::floquet::{self, CycleStability};
use slcbeam::run::modes::{self, ModeOptions};
use slcbeam::run::periodic::{record, scene, settle, subharmonic};
use slcbeam::run::record::{Control, Memory, Unrecorded};
use slcbeam::run::summary::Status;

/// The shipped column under a follower load [N].
fn beck(load: f64) -> Case {
    let sets = [
        format!("/ends/tip/free/follower_normal_n/ramp/to={}", -load),
        "/time/output_interval_s=2e-4".into(),
        "/time/window_s=0.2".into(),
    ];
    let text = include_str!("../../cases/flutter-cycle.json");
    case::parse(text, "flutter-cycle.json".as_ref(), "cases".as_ref(), &sets).unwrap()
}

fn amplitude(outcome: &Outcome) -> f64 {
    assert_eq!(outcome.summary.status, Status::Finished);
    outcome.summary.quantities["tip_u1_m"].window_max_abs.unwrap()
}

/// Goal: period and amplitude of the limit cycle are those of the end of a long run to 1e-3; its energies balance, and its trivial
/// multiplier is 1 within the error of the steps. Disturbances decay with 11 1/s: after 2 s the run has settled to 1e-9.
#[test]
fn a_limit_cycle_is_the_end_of_a_long_run() {
    let case = beck(17_000.0);
    let (scene, mut cycle, _) = subharmonic::find(&case, 1).unwrap();
    let found = record::record(&case, &scene, &cycle, &mut Unrecorded(|_| Control::Continue)).unwrap();
    let mut rows = Memory::default();
    let run = dynamics::run_with(&case, scene::system(&case).unwrap(), &[], &mut rows).unwrap();
    let (t, u) = (rows.column("t").unwrap(), rows.column("tip_u1").unwrap());
    let upward = (1..u.len()).filter(|k| u[k - 1] < 0.0 && u[*k] >= 0.0);
    let crossings: Vec<f64> = upward
        .map(|k| t[k - 1] - u[k - 1] * (t[k] - t[k - 1]) / (u[k] - u[k - 1]))
        .collect();
    let last = crossings.len() - 1;
    let period = (crossings[last] - crossings[last - 5]) / 5.0;
    let errors = [scene.drive.period / period, amplitude(&found) / amplitude(&run)].map(|ratio| ratio - 1.0);
    println!(
        "period {period} s, amplitude {} m: differences {errors:?}",
        amplitude(&run)
    );
    assert!(errors.iter().all(|error| error.abs() < 1e-3), "{errors:?}");
    let largest = found
        .summary
        .balances
        .energy_j
        .values()
        .fold(0.0_f64, |m, x| m.max(x.abs()));
    let open = open_over_window(&found.summary.quantities, largest).unwrap();
    println!("open part of the energy balance: {open:e}");
    assert!(open < 1e-4, "{open:e}");
    let stability = floquet::multipliers(&scene, &mut cycle, 3);
    let trivial = stability.trivial.unwrap();
    println!("trivial multiplier - 1: {:e}", trivial.re - 1.0);
    assert!((trivial.re - 1.0).abs() < 1e-5 && trivial.im == 0.0, "{trivial:?}");
    assert_eq!(stability.verdict.stability, CycleStability::Stable);
}

/// Source: normal form of a supercritical Hopf bifurcation, `r' = σ r - c r³`: the cycle has the multiplier of the growth rate -2 σ, and
/// its frequency tends to that of the growing mode in proportion to σ (Seydel 2010).
/// Goal: just beyond the flutter load the cycles have them. Tolerance: terms of relative order a² of the amplitude a, 0.028 at the larger
/// load.
#[test]
fn just_beyond_flutter_a_cycle_has_the_normal_form() {
    let at = |load: f64| {
        let case = beck(load);
        let plan = ModeOptions {
            count: 1,
            near_hz: 17.0,
            limits: false,
        };
        let about = modes::at_equilibrium(&case, case.time.end_s).unwrap();
        let mode = modes::compute(about, &plan).unwrap().modes[0].clone();
        let (scene, mut cycle, _) = subharmonic::find(&case, 1).unwrap();
        let growth = floquet::multipliers(&scene, &mut cycle, 2).verdict.growth_per_s;
        let detuning = 1.0 / (scene.drive.period * mode.frequency_hz().unwrap()) - 1.0;
        let rate = growth / (-2.0 * mode.s.re);
        println!("{load} N: growth over -2 σ {rate}, frequency over that of the mode - 1: {detuning:e}");
        (mode.s.re, rate, detuning)
    };
    let [near, far] = [13_150.0, 13_250.0].map(at);
    assert!((near.1 - 1.0).abs() < 0.005 && (far.1 - 1.0).abs() < 0.02);
    assert!(near.2.abs() < 1e-3);
    let shares = [far.2 / near.2, far.0 / near.0];
    println!("ratios of detuning and of growth: {shares:?}");
    assert!((shares[0] / shares[1] - 1.0).abs() < 0.03, "{shares:?}");
}

/// Goal: at a loose tolerance, at which the energy balance over the cycle does not close, the cycle is found again at a tighter one.
#[test]
fn a_loose_tolerance_is_tightened() {
    let mut case = beck(17_000.0);
    case.solver.rtol = 0.03;
    let (scene, cycle, _) = subharmonic::find(&case, 1).unwrap();
    let settled = settle(&case, scene, cycle).unwrap();
    println!("{:?}, period {} s", settled.refined, settled.scene.drive.period);
    assert!(settled.refined.unwrap().rtol < 0.03);
    assert!((settled.scene.drive.period / 0.052_059_7 - 1.0).abs() < 1e-3);
}

/// Goal: below the flutter load the error reports rest, the amplitude and the decay of the slowest mode.
#[test]
fn a_motion_that_decays_is_no_cycle() {
    let Err(Error::Solver(error)) = subharmonic::find(&beck(10_000.0), 1).map(|_| ()) else {
        panic!("a cycle below the flutter load")
    };
    assert_eq!(error.code, Code::NoCycle);
    for part in ["comes to rest", "Amplitude at the end: 29.4 µm"] {
        assert!(error.what.contains(part), "{}", error.what);
    }
    assert!(error.cause.unwrap().contains("decays at 2.2886 /s"));
    let several = subharmonic::find(&beck(17_000.0), 2).map(|_| ());
    assert!(matches!(several, Err(Error::Usage(text)) if text.contains("has one period")));
}
