//! Wirings, or anything else of a case, as something that is chosen: all of a set, one after the other.

use crate::case::Case;
use crate::error::{Error, Result};

/// Alternatives at most.
pub const MOST: usize = 5000;

/// One of a set.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Alternative {
    /// What it is called.
    pub name: String,
    /// What it sets in the case, each as `POINTER=JSON`.
    pub sets: Vec<String>,
}

/// Alternatives of `POINTER=JSON|JSON|..`.
///
/// # Errors
/// [`Error::Usage`] with what is wanted.
pub fn choices(text: &str) -> Result<Vec<Alternative>> {
    let wrong = |what: &str| Error::Usage(format!("--choose '{text}': {what}"));
    let wanted = "a JSON pointer and alternatives are wanted, such as '/network/chains/0/bladders=[1, 2, 3]|[1, 3, 2]'";
    let (pointer, values) = text.split_once('=').ok_or_else(|| wrong(wanted))?;
    if !pointer.starts_with('/') {
        return Err(wrong(wanted));
    }
    let all: Vec<&str> = values.split('|').map(str::trim).collect();
    if all.len() < 2 || all.iter().any(|one| one.is_empty()) {
        return Err(wrong("two alternatives at least, with | between them"));
    }
    let key = pointer.rsplit('/').next().unwrap_or(pointer);
    let one = |value: &&str| Alternative {
        name: format!("{key} {value}"),
        sets: vec![format!("{pointer}={value}")],
    };
    Ok(all.iter().map(one).collect())
}

/// Every combination of one of each set.
///
/// # Errors
/// [`Error::Usage`] for more than [`MOST`].
pub fn combinations(sets: Vec<Vec<Alternative>>) -> Result<Vec<Alternative>> {
    let count = sets.iter().try_fold(1_usize, |n, set| n.checked_mul(set.len()));
    if count.is_none_or(|n| n > MOST) {
        return Err(Error::Usage(format!(
            "more than {MOST} alternatives: all of them are computed, so choose between fewer"
        )));
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

/// Wirings in which the first two chains of a case, of opposite bladders one beside the other, change sides at most so often along the beam.
/// Both begin on the sides on which they do in the case.
///
/// # Errors
/// [`Error::Usage`] where there are no two such chains, or more than [`MOST`] wirings.
pub fn crossovers(case: &Case, most: usize) -> Result<Vec<Alternative>> {
    let chains = case.network.as_ref().map_or(&[][..], |network| &network.chains);
    let sides = |chain: usize| -> Vec<i64> { chains.get(chain).map_or_else(Vec::new, |chain| chain.bladders.clone()) };
    let (a, b) = (sides(0), sides(1));
    let opposite = a.len() == b.len() && a.iter().zip(&b).all(|(a, b)| *a == -*b);
    if a.len() < 2 || !opposite {
        return Err(Error::Usage(
            "--crossovers: the first two chains of /network have to hold opposite bladders, one beside the other: [1, 2, ..] and [-1, -2, ..]"
                .into(),
        ));
    }
    let places = a.len() - 1;
    let side = a[0].signum();
    let mut all = vec![];
    let mut crossed: Vec<Vec<usize>> = vec![vec![]];
    for count in 0..=most.min(places) {
        for after in &crossed {
            if all.len() >= MOST {
                return Err(Error::Usage(format!(
                    "--crossovers {most}: more than {MOST} wirings, all of which would be computed; ask for fewer crossovers"
                )));
            }
            all.push(wiring(&a, side, after));
        }
        if count < most {
            let more = |after: &Vec<usize>| {
                let from = after.last().map_or(1, |last| last + 1);
                (from..=places)
                    .map(|next| [&after[..], &[next]].concat())
                    .collect::<Vec<_>>()
            };
            crossed = crossed.iter().flat_map(more).collect();
            if crossed.len() > MOST {
                crossed.truncate(MOST);
            }
        }
    }
    Ok(all)
}

/// The wiring that changes sides after so many bladders each.
fn wiring(chain: &[i64], first: i64, after: &[usize]) -> Alternative {
    let mut side = first;
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
