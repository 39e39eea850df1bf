//! Alternatives to choose from: wirings, or any other part of a case.

use serde_json::Value;

use crate::case::Case;
use crate::error::{Error, Result};

/// Largest number of alternatives.
pub const MOST: usize = 5000;

/// Alternative of a set.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Alternative {
    /// Name.
    pub name: String,
    /// Settings in the case, each as `POINTER=JSON`.
    pub sets: Vec<String>,
}

/// Parses the alternatives of `POINTER=JSON|JSON|..`.
///
/// # Errors
/// [`Error::Usage`] with the expected form.
pub fn choices(text: &str) -> Result<Vec<Alternative>> {
    let wrong = |what: &str| Error::Usage(format!("--choose '{text}': {what}"));
    let wanted = "expected a JSON pointer and alternatives, such as '/network/chains/0/bladders=[1, 2, 3]|[1, 3, 2]'";
    let (pointer, values) = text.split_once('=').ok_or_else(|| wrong(wanted))?;
    if !pointer.starts_with('/') {
        return Err(wrong(wanted));
    }
    let all: Vec<&str> = values.split('|').map(str::trim).collect();
    if all.len() < 2 || all.iter().any(|one| one.is_empty()) {
        return Err(wrong("expected at least two alternatives, separated by |"));
    }
    // 0.50 equals 0.5
    let read = |text: &str| match serde_json::from_str::<Value>(text) {
        Ok(number) if number.is_number() => number.as_f64().into(),
        Ok(other) => other,
        Err(_) => Value::from(text),
    };
    for (k, one) in all.iter().enumerate() {
        if all[..k].iter().any(|before| read(before) == read(one)) {
            return Err(wrong(&format!("{one} is given twice")));
        }
    }
    let key = pointer.rsplit('/').next().unwrap_or(pointer);
    let one = |value: &&str| Alternative {
        name: format!("{key} {value}"),
        sets: vec![format!("{pointer}={value}")],
    };
    Ok(all.iter().map(one).collect())
}

/// Returns every combination of one alternative of each set.
///
/// # Errors
/// [`Error::Usage`] for more than [`MOST`].
pub fn combinations(sets: Vec<Vec<Alternative>>) -> Result<Vec<Alternative>> {
    let count = sets.iter().try_fold(1_usize, |n, set| n.checked_mul(set.len()));
    if count.is_none_or(|n| n > MOST) {
        return Err(too_many("--choose"));
    }
    let mut all = vec![];
    for set in sets {
        if all.is_empty() {
            all = set;
            continue;
        }
        let join = |a: &Alternative, b: &Alternative| Alternative {
            name: format!("{}, {}", a.name, b.name),
            sets: [&a.sets[..], &b.sets].concat(),
        };
        all = all
            .iter()
            .flat_map(|a| set.iter().map(|b| join(a, b)).collect::<Vec<_>>())
            .collect();
    }
    Ok(all)
}

/// Wirings in which the first two chains of a case change sides at most `most` times along the beam. The chains must
/// contain opposite bladders in the same order. Both begin on the sides on which they begin in the case.
///
/// # Errors
/// [`Error::Usage`] if there are no two such chains, and for more than [`MOST`] wirings.
pub fn crossings(case: &Case, most: usize) -> Result<Vec<Alternative>> {
    let chains = case.network.as_ref().map_or(&[][..], |network| &network.chains);
    let sides = |chain: usize| -> Vec<i64> { chains.get(chain).map_or_else(Vec::new, |chain| chain.bladders.clone()) };
    let (chain, other) = (sides(0), sides(1));
    let opposite = chain.len() == other.len() && chain.iter().zip(&other).all(|(a, b)| *a == -*b);
    if chain.len() < 2 || !opposite {
        return Err(Error::Usage(
            "--crossovers: the first two chains of /network must contain opposite bladders in the same order: [1, 2, \
             ..] and [-1, -2, ..]"
                .into(),
        ));
    }
    let most = most.min(chain.len() - 1);
    let counts = (1..=most).scan(1.0, |count, k| {
        *count *= (chain.len() - k) as f64 / k as f64;
        Some(*count)
    });
    if 1.0 + counts.sum::<f64>() > MOST as f64 {
        return Err(too_many(&format!("--crossovers {most}")));
    }
    let more = |after: &Vec<usize>| {
        let from = after.last().map_or(1, |last| last + 1);
        let next = (from..chain.len()).map(|next| [&after[..], &[next]].concat());
        next.collect::<Vec<_>>()
    };
    let mut crossed: Vec<Vec<usize>> = vec![vec![]];
    let mut all = vec![];
    for _ in 0..=most {
        all.extend(crossed.iter().map(|after| wiring(&chain, after)));
        crossed = crossed.iter().flat_map(more).collect();
    }
    Ok(all)
}

/// Wiring that changes sides after each of the given numbers of bladders.
fn wiring(chain: &[i64], after: &[usize]) -> Alternative {
    let mut side = chain[0].signum();
    let upper: Vec<i64> = chain
        .iter()
        .enumerate()
        .map(|(k, bladder)| {
            side *= if after.contains(&k) { -1 } else { 1 };
            side * bladder.abs()
        })
        .collect();
    let lower: Vec<i64> = upper.iter().map(|bladder| -bladder).collect();
    let names: Vec<String> = after.iter().map(|k| chain[k - 1].abs().to_string()).collect();
    Alternative {
        name: match names.is_empty() {
            true => "parallel".into(),
            false => format!("crossover after {}", names.join(", ")),
        },
        sets: [upper, lower]
            .iter()
            .enumerate()
            .map(|(k, bladders)| format!("/network/chains/{k}/bladders={bladders:?}"))
            .collect(),
    }
}

/// Error for more alternatives than [`MOST`].
fn too_many(option: &str) -> Error {
    Error::Usage(format!(
        "{option}: too many alternatives (limit {MOST}). Each of them is computed. Choose between fewer"
    ))
}
