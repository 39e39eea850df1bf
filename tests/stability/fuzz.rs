//! Random valid cases, each run with a budget: finished with closed balances, or a diagnosis; never a panic.

use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use slcbeam::case;
use slcbeam::run::dynamics;
use slcbeam::run::summary::Status;

use crate::fuzz_case;
use crate::harness::{BUDGET, Budget};

/// Steps and seconds of one run. A case that needs more is tallied, not judged: mostly undamped waves started by a jump,
/// followed as the tolerance asks.
const STEPS: u64 = 20_000;
const SECONDS: f64 = 1.5;

/// Energy residual in units of rtol of the largest energy seen. Wider than for the hard cases: the largest energy of a
/// random case may be far below the sizes to which tolerances refer (a small load beside a large driven motion), so this
/// asks only that the balance is closed at all. At least 1 %, so that rtol = 1e-6 is not asked for what jumps leave.
fn energy_bound(rtol: f64) -> f64 {
    (3000.0 * rtol).clamp(0.01, 1.0)
}

/// Verdict on one seed.
enum Verdict {
    /// One word, for the tally.
    Good(&'static str),
    /// What is wrong.
    Bad(String),
}

fn judge(seed: u64) -> Verdict {
    let text = fuzz_case::text(seed);
    match catch_unwind(AssertUnwindSafe(|| run(&text))) {
        Ok(verdict) => verdict,
        Err(_) => Verdict::Bad("panic".into()),
    }
}

fn run(text: &str) -> Verdict {
    let loaded = match case::parse(text, Path::new("fuzz.json"), Path::new("."), &[]) {
        Ok(loaded) => loaded,
        Err(slcbeam::error::Error::Case(fault)) if fault.violations.iter().all(|v| !v.what.is_empty()) => {
            return Verdict::Good("refused by the case check");
        }
        Err(other) => return Verdict::Bad(format!("read: {other}")),
    };
    let mut recorder = Budget::new(STEPS, SECONDS);
    let outcome = match dynamics::run(&loaded.case, &mut recorder) {
        Ok(outcome) => outcome,
        Err(error) => return Verdict::Bad(format!("recorder: {error}")),
    };
    let s = &outcome.summary;
    if recorder.memory.rows.iter().flatten().any(|v| !v.is_finite()) {
        return Verdict::Bad(format!("numbers not finite ({:?}, {:?})", s.status, s.reason));
    }
    let reason = s.reason.as_deref().unwrap_or("");
    match s.status {
        Status::Finished => {
            let b = &s.balances;
            let rtol = loaded.case.solver.rtol;
            if b.energy_residual_relative.is_nan() || b.energy_residual_relative > energy_bound(rtol) {
                return Verdict::Bad(format!(
                    "energy residual {:.1e} at rtol {rtol:.0e}",
                    b.energy_residual_relative
                ));
            }
            if b.closed_volume_residual_relative.is_nan() || b.closed_volume_residual_relative > 1e-9 {
                return Verdict::Bad(format!(
                    "closed volume residual {:.1e}",
                    b.closed_volume_residual_relative
                ));
            }
            Verdict::Good("finished, balances closed")
        }
        Status::Stopped if reason == BUDGET => Verdict::Good("budget used up"),
        Status::Stopped if reason.contains("t = ") && reason.contains("closed") => {
            Verdict::Good("stopped: bladder closed")
        }
        Status::Stopped => Verdict::Bad(format!("stopped without time and cause: {reason}")),
        Status::Failed => match &outcome.fault {
            Some(f) if f.time_s.is_finite() && !f.what.is_empty() && f.cause.is_some() && f.hint.is_some() => {
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

/// Seeds of cases that went wrong once stay here for ever.
const REGRESSIONS: [u64; 0] = [];

/// Goal: 200 random cases (SLCBEAM_FUZZ says how many) end well; most of what is generated must be a real test: at
/// least half finishes, at most a tenth is refused by the case check.
#[test]
fn random_cases_finish_or_are_diagnosed() {
    let wanted: Option<u64> = std::env::var("SLCBEAM_FUZZ").ok().and_then(|n| n.parse().ok());
    let first: u64 = std::env::var("SLCBEAM_FUZZ_FIRST")
        .ok()
        .and_then(|n| n.parse().ok())
        .unwrap_or(1);
    let count = wanted.unwrap_or(200);
    let seeds: Vec<u64> = REGRESSIONS.into_iter().chain(first..first + count).collect();
    let next = AtomicU64::new(0);
    let tally = Mutex::new((BTreeMap::<&'static str, u64>::new(), Vec::<String>::new()));
    std::thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                while let Some(&seed) = seeds.get(next.fetch_add(1, Ordering::Relaxed) as usize) {
                    let verdict = judge(seed);
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
    let of = |word: &str| counts.get(word).copied().unwrap_or(0);
    assert!(2 * of("finished, balances closed") > count, "too few cases finish");
    assert!(
        10 * of("refused by the case check") < count,
        "too many cases are refused"
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
