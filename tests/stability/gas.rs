//! Gas flow through orifices at pressure ratios at which real orifices choke.

use slcbeam::run::summary::Status;

use crate::harness::{Ran, VOLUME, distance, run};

/// BDF and a one-step method, each with a loose and a tight tolerance; the last is the reference of the others.
const SOLVERS: [(&str, f64, &str); 4] = [
    ("IDA", 1e-3, r#"/solver={"method":"ida","rtol":1e-3}"#),
    ("ESDIRK46", 1e-3, r#"/solver={"method":"esdirk46","rtol":1e-3}"#),
    ("IDA", 1e-6, r#"/solver={"method":"ida","rtol":1e-6}"#),
    ("ESDIRK46", 1e-6, r#"/solver={"method":"esdirk46","rtol":1e-6}"#),
];

/// Energy residual in units of rtol. Nothing oscillates for long here, so it is far below the bound of all hard cases.
const ENERGY: f64 = 30.0;

/// Gauge pressures of supply and chamber [Pa].
const SUPPLY: f64 = 2e5;
const CHAMBER: f64 = -1e5;

/// The Mach number reported by W024.
fn mach(ran: &Ran) -> f64 {
    let told = ran.summary.warnings.iter().find_map(|w| w.strip_prefix("W024"));
    let number = told.and_then(|w| w.split("reached ").nth(1)?.split(' ').next()?.parse().ok());
    number.unwrap_or_else(|| panic!("{}: no W024: {:?}", ran.name, ran.summary.warnings))
}

/// Source: [E54] to [E56]. Goal: a row of air is emptied into 1.3 kPa, filled from 3 bar and emptied again (pressure ratios 75 and 230),
/// through orifices from 0.1 mm to 1 cm wide, at rtol 1e-3 and 1e-6, by BDF and by a one-step method. By the law of viscous flow the gas is
/// supersonic, with the warning W024. Mass closes to rounding errors, energy to the tolerance, and all four runs agree. No pressure leaves
/// the range of chamber and supply, except for 100 Pa by the moving beam. Tolerance: 30 rtol, the error of a step times a few dozen active
/// steps; ten times that for the narrow orifice, which fills only to a sixteenth of the supply, the reference of the scales.
#[test]
fn choking_gas() {
    for (radius, apart_per_rtol) in [(5e-5, 500.0), (5e-4, 30.0), (5e-3, 30.0)] {
        let bores =
            [1, 2].map(|tube| format!(r#"/network/tubes/{tube}/cross_section={{"circle":{{"radius_m":{radius:e}}}}}"#));
        let runs = SOLVERS.map(|(method, rtol, solver)| {
            let ran = run("choking", &[&bores[0], &bores[1], solver])
                .sound_with(ENERGY, VOLUME)
                .steps_within(12, 4_800);
            let mass = ran.summary.balances.volume_residual_relative;
            assert!(mass < VOLUME, "{}: mass {mass:.1e}", ran.name);
            let fast = mach(&ran);
            assert!(fast > 1.0, "{}: Mach number {fast}", ran.name);
            let lowest = ran.column("min_pressure").into_iter().fold(f64::INFINITY, f64::min);
            let (room, highest) = (rtol * SUPPLY, ran.largest("max_pressure"));
            assert!(
                lowest > CHAMBER - room && highest < SUPPLY + room + 100.0,
                "{}: {lowest} {highest}",
                ran.name
            );
            ran.line(&format!(
                "{method}, rtol {rtol:e}, mass {mass:.1e}, Mach {fast:.0}, {lowest:.1} to {highest:.1} Pa"
            ))
        });
        for ran in &runs[..3] {
            let columns = ["tip_u1", "max_pressure", "min_pressure"];
            let apart = columns.map(|column| distance(ran, &runs[3], column));
            let apart = apart.into_iter().fold(0.0, f64::max);
            println!("{}: apart {apart:.1e}", ran.name);
            assert!(apart < apart_per_rtol * ran.rtol, "{}: {apart:.1e}", ran.name);
        }
    }
}

/// Goal: chambers down to a hundred-thousandth of ambient pressure, at every tolerance from 1e-2 to 1e-6, by both methods: all runs finish.
/// Before, the unknown of a junction was its pressure, in which the slope of the flow vanishes towards vacuum: 5 of these 40 runs failed in
/// Newton's iteration. The unknown is now Ψ, in which the flow is linear.
#[test]
fn orifices_into_vacuum() {
    for chamber in [-100_500.0, -101_000.0, -101_300.0, -101_324.0] {
        for method in ["ida", "esdirk46"] {
            for rtol in [1e-2, 1e-3, 1e-4, 1e-5, 1e-6] {
                let sets = [
                    format!("/network/ports/0/pressure_pa={chamber}"),
                    format!(r#"/solver={{"method":"{method}","rtol":{rtol:e}}}"#),
                ];
                let ran = run("choking", &[&sets[0], &sets[1]])
                    .sound_with(ENERGY, VOLUME)
                    .steps_within(12, 4_800);
                assert!(ran.summary.balances.volume_residual_relative < VOLUME, "{}", ran.name);
                ran.line("");
            }
        }
    }
}

/// Goal: a chamber that removes all but a thousandth of the gas, the limit of the equations: the run ends with a time and that cause, by
/// any method and tolerance. Tolerance of the time: the remaining pressure falls as 1/t, so an error of rtol of the supply changes the end
/// by twice itself. At rtol 1e-3, with 200 Pa against the decisive 101 Pa, the end is within half to double; at 1e-6 the error is 0.2 %,
/// and ten times that by the interpolation within steps of a tenth of the time.
#[test]
fn all_gas_gone_is_diagnosed() {
    let ends = SOLVERS.map(|(method, rtol, solver)| {
        let open = [
            "/network/ports/0/pressure_pa=-101300",
            "/network/tubes/1/opening=1",
            "/network/tubes/2/opening=0",
            "/time/end_s=20",
            "/time/output_interval_s=0.1",
            solver,
        ];
        let ran = run("choking", &open);
        let reason = ran.summary.reason.clone().unwrap_or_default();
        println!(
            "{method}, rtol {rtol:e} | {} steps | {:?}: {reason}",
            ran.steps(),
            ran.summary.status
        );
        assert_eq!(ran.summary.status, Status::OutOfRange, "{}: {reason}", ran.name);
        assert!(reason.contains("evacuated at t = "), "{}: {reason}", ran.name);
        assert!(ran.record.rows.iter().flatten().all(|v| v.is_finite()), "{}", ran.name);
        ran.summary.time_s
    });
    for ((_, rtol, _), t) in SOLVERS.iter().zip(ends) {
        let bound = if *rtol > 1e-4 { 2.0 } else { 1.02 };
        let ratio = t / ends[2];
        assert!(ratio < bound && ratio > 1.0 / bound, "{ends:?}");
    }
}
