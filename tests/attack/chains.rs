//! Chains of kills: a run killed at any time, resumed, killed again, until it ends as the one that was left alone.

use std::path::Path;
use std::time::Duration;

use crate::program::{LONG, kill, run_long, same, start, stderr};

/// Chains take turns at them.
const METHODS: [&str; 5] = ["ida", "trbdf2", "esdirk34", "esdirk46", "esdirk57"];

/// Starts or resumes the longer run with more arguments and kills it after a while, unless it ends before.
fn strike(out: &Path, more: &[&str], resume: bool, after: Duration) -> bool {
    let resume: &[&str] = if resume { &["--resume"] } else { &[] };
    let mut child = start(out, &[&LONG, more, resume].concat());
    std::thread::sleep(after);
    let ended = child.try_wait().expect("its state");
    kill(&mut child);
    ended.is_some_and(|status| status.success())
}

/// Chains of up to six kills each, at times spread by the golden ratio over what a run takes.
fn chains(count: u64) {
    let folder = tempfile::tempdir().expect("a place");
    let sets = METHODS.map(|method| format!("/solver/method=\"{method}\""));
    let alone: Vec<_> = sets
        .iter()
        .zip(METHODS)
        .map(|(set, method)| {
            let out = folder.path().join(method);
            let begin = std::time::Instant::now();
            assert!(run_long(&out, &["--set", set]).status.success(), "{method}");
            (out, begin.elapsed(), ["--set", set.as_str()])
        })
        .collect();
    let mut kills = 0;
    for chain in 0..count {
        let (whole, length, set) = &alone[chain as usize % alone.len()];
        let out = folder.path().join(format!("chain-{chain}"));
        for link in 0..6_u64 {
            let part = (6 * chain + link + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 40;
            let after = length.mul_f64(0.7 * part as f64 / (1 << 24) as f64);
            let resume = out.join("checkpoint.json").exists() || out.join("checkpoint-before.json").exists();
            if strike(&out, set, resume, after) {
                break;
            }
            kills += 1;
        }
        let resume = out.join("checkpoint.json").exists() || out.join("checkpoint-before.json").exists();
        if resume {
            let last = run_long(&out, &[&set[..], &["--resume"]].concat());
            assert!(last.status.success(), "chain {chain}: {}", stderr(&last));
        } else if same(whole, &out).is_err() {
            // killed before its first checkpoint each time: it begins afresh
            let last = run_long(&out, set);
            assert!(last.status.success(), "chain {chain}: {}", stderr(&last));
        }
        if let Err(why) = same(whole, &out) {
            panic!("chain {chain}: {why}");
        }
        std::fs::remove_dir_all(&out).expect("it is removed");
    }
    println!("{count} chains, {kills} kills, 0 lost");
}

#[test]
fn chains_of_kills_lose_nothing() {
    chains(8);
}

#[test]
#[ignore = "half an hour"]
fn a_thousand_chains_of_kills_lose_nothing() {
    chains(1000);
}
