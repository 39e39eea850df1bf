//! Relaxation of equal bladders joined by equal tubes, and the energy that it dissipates.

use std::f64::consts::PI;

use serde_json::{Value, json};

use super::figure::ExactFigure;
use super::problem::SolvedProblem;
use super::solve::{SolvedRun, modes, solve};
use super::wet::{BLADDER, COMPLIANCE, TUBE, TUBE_LENGTH, case, pressures};
use crate::error::Result;
use crate::run::modes::TimeBehavior;

/// Number of bladders in a chain.
const N: usize = 6;
/// Resistance between the centers of neighboring bladders: a tube and two half bladders in series.
const R: f64 = BLADDER + TUBE;
/// Initial pressure [Pa].
const START: f64 = 1000.0;

const GOAL: &str = "volume balance, tubes and bladders in series; every decay rate of the linearised network";
const REASON: &str = "one volume a bladder makes the lumped chain exact: what is left is round-off";
const IN_TIME: &str =
    "one volume a bladder makes the lumped network exact: what is left is the integrator's error, rtol 1e-9";

/// All rows.
pub fn rows() -> Vec<SolvedProblem> {
    let n = N as f64;
    let chain = SolvedProblem::new(
        "network-closed-chain",
        [
            "eigenvalues of a path (discrete cosines): (4/RC) sin^2(k pi/2N)",
            GOAL,
            REASON,
        ],
        move || rates(chain_of(json!(["sealed", "sealed"])), (1..N).map(|k| k as f64 * PI / n)),
    );
    let open = SolvedProblem::new(
        "network-open-chain",
        [
            "path with one end at pressure zero behind R: (4/RC) sin^2((2k - 1) pi/(2 (2N + 1)))",
            GOAL,
            REASON,
        ],
        move || rates(open_chain(), (1..=N).map(|k| (2 * k - 1) as f64 * PI / (2.0 * n + 1.0))),
    );
    let ring = SolvedProblem::new(
        "network-ring",
        [
            "eigenvalues of a ring, (4/RC) sin^2(k pi/N), all but the last twice",
            GOAL,
            REASON,
        ],
        move || rates(ring(), (1..N).map(|k| 2.0 * (k / 2 + k % 2) as f64 * PI / n)),
    );
    vec![chain, open, ring, two_bladders(), dissipation()]
}

fn upper_row() -> Vec<usize> {
    (1..=N).collect()
}

fn chain_of(ends: Value) -> Value {
    json!({"chains": [{"bladders": upper_row(), "ends": ends}]})
}

/// Inlet of bladder 1 at pressure zero behind a tube, which is longer to replace the missing half bladder.
fn open_chain() -> Value {
    let length = TUBE_LENGTH * (1.0 + 0.5 * BLADDER / TUBE);
    json!({
        "chains": [{"bladders": upper_row(), "ends": ["connected", "sealed"]}],
        "junctions": ["outside"],
        "tubes": [{"from": {"junction": "outside"}, "to": {"bladder": 1, "end": "inlet"}, "length_m": length}],
        "ports": [{"at": {"junction": "outside"}, "pressure_pa": 0}]
    })
}

fn ring() -> Value {
    json!({
        "chains": [{"bladders": upper_row(), "ends": ["connected", "connected"]}],
        "tubes": [{"from": {"bladder": N, "end": "outlet"}, "to": {"bladder": 1, "end": "inlet"}}]
    })
}

/// Number of requested modes: more than the beam and the network have together.
const ALL: usize = 100;

/// Compares decay rates with `(4/RC) sin²(angle/2)`, the slowest first.
fn rates(network: Value, angles: impl Iterator<Item = f64>) -> Result<Vec<ExactFigure>> {
    let found = modes(&case(N, network, 1.0, 1.0), ALL)?;
    let mut rates: Vec<f64> = found
        .modes
        .iter()
        .filter(|m| m.kind == TimeBehavior::Decay)
        .map(|m| -m.s.re)
        .collect();
    rates.sort_by(f64::total_cmp);
    let figures = (1..).zip(angles).map(|(k, angle)| {
        let exact = 4.0 / (R * COMPLIANCE) * (0.5 * angle).sin().powi(2);
        let rate = rates.get(k - 1).copied().unwrap_or(f64::NAN);
        ExactFigure::relative(format!("rate of mode {k} [1/s]"), rate, exact, 1e-10)
    });
    let mut all: Vec<ExactFigure> = figures.collect();
    let count = all.len() as f64;
    all.push(ExactFigure::absolute("number of rates", rates.len() as f64, count, 0.0));
    Ok(all)
}

/// Pressures of the upper row at the end of a run [Pa].
fn upper_pressures(solved: &SolvedRun, count: usize) -> impl Iterator<Item = f64> {
    solved
        .field("pressure_pa")
        .last()
        .into_iter()
        .flatten()
        .copied()
        .take(count)
}

fn two_bladders() -> SolvedProblem {
    SolvedProblem::new(
        "network-two-bladders",
        [
            "two capacitors: the difference of pressure decays with the time R C/2",
            "the smallest network",
            IN_TIME,
        ],
        || {
            let tau = 0.5 * R * COMPLIANCE;
            let mut run = case(
                2,
                json!({"chains": [{"bladders": [1, 2], "ends": ["sealed", "sealed"]}]}),
                tau,
                tau,
            );
            run["start"] = json!({"pressures": pressures([START, 0.0].into_iter())});
            let left: Vec<f64> = upper_pressures(&solve(&run)?, 2).collect();
            let [a, b] = left[..] else { return Ok(vec![]) };
            Ok(vec![ExactFigure::relative(
                "decay time [s]",
                tau / (START / (a - b)).ln(),
                tau,
                1e-6,
            )])
        },
    )
}

fn dissipation() -> SolvedProblem {
    SolvedProblem::new(
        "network-dissipation",
        [
            "sum q^2 R = -d/dt sum C p^2/2",
            "energy of the network: what the bladders lose is dissipated, shared between tubes and bladders as their resistances",
            "the integrals are as good as the integrator, rtol 1e-9, and 20 decay times leave e^-40 of the energy",
        ],
        || {
            let slowest = R * COMPLIANCE / (4.0 * (0.5 * PI / N as f64).sin().powi(2));
            let mut run = case(N, chain_of(json!(["sealed", "sealed"])), 20.0 * slowest, 20.0 * slowest);
            let start = |j: usize| if j == 1 { START } else { 0.0 };
            run["start"] = json!({"pressures": pressures((1..=N).map(start))});
            let solved = solve(&run)?;
            let (tubes, bladders) = (solved.last("dissipated_tubes"), solved.last("dissipated_bladders"));
            let lost = 0.5 * COMPLIANCE * START * START * (1.0 - 1.0 / N as f64);
            Ok(vec![
                ExactFigure::relative("dissipated in all [J]", tubes + bladders, lost, 1e-6),
                ExactFigure::relative("share of the tubes", tubes / (tubes + bladders), TUBE / R, 1e-6),
                ExactFigure::relative(
                    "energy left [J]",
                    solved.last("bladder_energy"),
                    lost / (N - 1) as f64,
                    1e-6,
                ),
            ])
        },
    )
}
