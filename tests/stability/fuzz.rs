//! Random valid cases, each run with a budget: finished with closed balances, or a diagnosis; never a panic.

use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use slcbeam::case;
use slcbeam::run::dynamics;
use slcbeam::run::record::Memory;
use slcbeam::run::summary::Status;

use crate::fuzz_case;
use crate::harness::{BUDGET, Budget};

/// Budget of steps and seconds of one run. Longer runs are counted, not judged: mostly undamped waves from an abrupt start, resolved as the
/// tolerance requires.
const STEPS: u64 = 20_000;
/// Safety limit; the step limit is decisive.
const SECONDS: f64 = 60.0;

/// Energy residual below which a balance is closed, as in the run's own warning. It is not in units of rtol: the largest energy of a random
/// case may be far below the scales of the tolerances (a small load with a large driven motion).
const CLOSED: f64 = 0.01;

/// Accepted volume loss of a closed network: rounding errors of flows between nearly equal pressures and of the matrix, 1e-16 times step
/// over time constant (up to 10^10 here, 2.5e-7 observed).
const VOLUME: f64 = 1e-6;

/// Verdict on one seed.
enum Verdict {
    /// Good, with a word for the tally.
    Good(&'static str),
    /// Failed, with the reason.
    Bad(String),
}

/// Verdict of a seed, and the warnings of the run.
fn judge(seed: u64) -> (Verdict, String) {
    let text = fuzz_case::text(seed);
    let mut told = String::new();
    let verdict = catch_unwind(AssertUnwindSafe(|| run(&text, &mut told)));
    (verdict.unwrap_or_else(|_| Verdict::Bad("panic".into())), told)
}

fn run(text: &str, told: &mut String) -> Verdict {
    let case = match case::parse(text, Path::new("fuzz.json"), Path::new("."), &[]) {
        Ok(case) => case,
        Err(slcbeam::error::Error::Case(fault)) if fault.violations.iter().all(|v| !v.what.is_empty()) => {
            *told = format!("refused: {}", fault.violations[0].what);
            return Verdict::Good("refused by the case check");
        }
        Err(other) => return Verdict::Bad(format!("read: {other}")),
    };
    let mut recorder = Budget::new(STEPS, SECONDS);
    let outcome = match dynamics::run(&case, &mut recorder) {
        Ok(outcome) => outcome,
        Err(slcbeam::error::Error::Case(fault)) if !fault.violations.is_empty() => {
            return Verdict::Good("refused by the model");
        }
        Err(error) => return Verdict::Bad(format!("recorder: {error}")),
    };
    let s = &outcome.summary;
    if recorder.memory.rows.iter().flatten().any(|v| !v.is_finite()) {
        return Verdict::Bad(format!("numbers not finite ({:?}, {:?})", s.status, s.reason));
    }
    let reason = s.reason.as_deref().unwrap_or("");
    *told = format!(
        "{:?} at {:.3} of the run, {} steps, {} newton failures, {} rejected, energy {:.1e}, closed volume {:.1e}: {reason}",
        s.status,
        s.time_s / case.time.end_s,
        s.solver.steps,
        s.solver.newton_failures,
        s.solver.error_test_failures,
        s.balances.energy_residual_relative,
        s.balances.closed_volume_residual_relative
    );
    match s.status {
        Status::Finished => {
            let b = &s.balances;
            let volume = b.closed_volume_residual_relative;
            if volume.is_nan() || volume > VOLUME {
                return Verdict::Bad(format!("closed volume residual {volume:.1e}"));
            }
            if b.energy_residual_relative <= CLOSED {
                return Verdict::Good("finished, balances closed");
            }
            if !s.warnings.iter().any(|w| w.contains("energy balance")) {
                return Verdict::Bad(format!(
                    "energy residual {:.1e} without a warning",
                    b.energy_residual_relative
                ));
            }
            confirm(case, &recorder.memory)
        }
        Status::Stopped if reason == BUDGET => Verdict::Good("budget used up"),
        Status::OutOfRange if reason.contains("t = ") && reason.contains("closed") => {
            Verdict::Good("out of range: bladder closed")
        }
        Status::OutOfRange if reason.contains("t = ") && reason.contains("reached") => Verdict::Good("out of range"),
        Status::OutOfRange | Status::Stopped => Verdict::Bad(format!("stopped without time and cause: {reason}")),
        Status::Failed => match &outcome.fault {
            Some(f)
                if f.at.time_s().is_some_and(f64::is_finite)
                    && !f.what.is_empty()
                    && f.cause.is_some()
                    && f.hint.is_some() =>
            {
                if f.what.contains("no consistent start") {
                    Verdict::Good("failed with a diagnosis: start")
                } else {
                    Verdict::Good("failed with a diagnosis: on the way")
                }
            }
            other => Verdict::Bad(format!("failed without a diagnosis: {other:?}")),
        },
    }
}

/// A run with an open energy balance has warned of it. The answer is right all the same if a hundredth of the tolerance changes it by less
/// than 5 % of its largest value, counted from a thousandth of the scales.
fn confirm(mut case: slcbeam::case::Case, loose: &Memory) -> Verdict {
    let tight = case.solver.rtol < 5e-5;
    case.solver.rtol = (0.01 * case.solver.rtol).max(1e-9);
    let mut recorder = Budget::new(5 * STEPS, SECONDS);
    let Ok(outcome) = dynamics::run(&case, &mut recorder) else {
        return Verdict::Bad("recorder".into());
    };
    if outcome.summary.status != Status::Finished {
        return Verdict::Good("finished, energy open and warned of, too costly to confirm");
    }
    let columns = [
        ("tip_u1", case.beam.length_m),
        ("tip_u3", case.beam.length_m),
        ("tip_angle", 1.0),
    ];
    let confirmed = columns.into_iter().all(|(column, size)| {
        let (a, b) = (
            loose.column(column).unwrap_or_default(),
            recorder.memory.column(column).unwrap_or_default(),
        );
        let largest = b.iter().fold(1e-3 * size, |m: f64, v| m.max(v.abs()));
        a.iter().zip(&b).all(|(a, b)| (a - b).abs() <= 0.05 * largest)
    });
    Verdict::Good(match (confirmed, tight) {
        (true, _) => "finished, energy open and warned of, answer confirmed",
        (false, false) => "finished, energy open and warned of, off by more than 5 % at rtol 1e-3 or 1e-4",
        (false, true) => "finished, energy open and warned of, off by more than 5 % at rtol 1e-5 or 1e-6",
    })
}

/// Seeds that failed once; they remain in the test permanently.
const REGRESSIONS: [u64; 5] = [
    // no consistent start, because of rounding errors of rates in networks that equalize in nanoseconds
    41, 44, 90, 123, 170,
];

/// Goal: 200 random cases (or SLCBEAM_FUZZ of them) end well. Most must be real tests: at least half finishes, and the case check rejects
/// at most a tenth.
#[test]
fn random_cases_finish_or_are_diagnosed() {
    let wanted: Option<u64> = std::env::var("SLCBEAM_FUZZ").ok().and_then(|n| n.parse().ok());
    let first: u64 = std::env::var("SLCBEAM_FUZZ_FIRST")
        .ok()
        .and_then(|n| n.parse().ok())
        .unwrap_or(1);
    let count = wanted.unwrap_or(200);
    let wordy = std::env::var("SLCBEAM_FUZZ_WORDY").is_ok();
    let range = first..first + count;
    let others = REGRESSIONS.into_iter().filter(|seed| !range.contains(seed));
    let seeds: Vec<u64> = others.chain(range.clone()).collect();
    let next = AtomicU64::new(0);
    let tally = Mutex::new((BTreeMap::<&'static str, u64>::new(), Vec::<String>::new()));
    std::thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                while let Some(&seed) = seeds.get(next.fetch_add(1, Ordering::Relaxed) as usize) {
                    let (verdict, told) = judge(seed);
                    if wordy {
                        println!("seed {seed}: {told}");
                    }
                    let mut tally = tally.lock().expect("no thread panics while it counts");
                    match verdict {
                        Verdict::Good(word) => *tally.0.entry(word).or_default() += 1,
                        Verdict::Bad(what) => tally.1.push(format!("seed {seed}: {what}")),
                    }
                }
            });
        }
    });
    let (counts, bad) = tally.into_inner().expect("no thread panics while it counts");
    println!("fuzz: {} cases from seed {first}", seeds.len());
    for (word, number) in &counts {
        println!("  {number:5} {word}");
    }
    println!("  {:5} wrong", bad.len());
    assert!(bad.is_empty(), "{}", bad.join("\n"));
    // Of 2000, 14 % have open balances and 3 % are wrong: at rtol 1e-3, which gives 3 % of the answer, nearly half; at 1e-6, 2 %.
    let with = |what: &str| -> u64 {
        counts
            .iter()
            .filter(|(word, _)| word.contains(what))
            .map(|(_, n)| n)
            .sum()
    };
    assert!(2 * with("finished") > count, "too few cases finish");
    assert!(10 * with("refused") < count, "too many cases are refused");
    assert!(4 * with("energy open") < count, "too many energy balances stay open");
    assert!(
        10 * with("off by") < count,
        "too many answers that a tighter tolerance changes"
    );
    assert!(
        50 * with("rtol 1e-5 or 1e-6") < count,
        "too many answers that a tighter tolerance changes, at rtol 1e-5"
    );
}

/// Prints the text of one seed: `SLCBEAM_FUZZ_SEED=17 cargo test --release --test stability print_seed -- --ignored --nocapture`.
#[test]
#[ignore = "prints a case for inspection"]
fn print_seed() {
    let seed = std::env::var("SLCBEAM_FUZZ_SEED")
        .ok()
        .and_then(|n| n.parse().ok())
        .unwrap_or(1);
    println!("{}", fuzz_case::text(seed));
}
