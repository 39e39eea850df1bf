//! A search among more alternatives than can be computed: from one to a better one next to it, from several starts.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use super::choice::Choice;
use super::found::{Compared, Derivatives, Design, Explored};
use super::problem::{Asked, Problem};
use super::search::{Reached, Search, worth};
use super::wiring::{Alternative, MOST};
use crate::error::{Error, Result};
use crate::numerics::chance::Chance;
use crate::numerics::exchange::{End, Space, Worth, descend, order};
use crate::study::sweep::pool;

/// Searches, where no number of them is asked for.
const SEARCHES: usize = 8;
/// Seed of their starts and ways.
const SEED: u64 = 20;
/// Figures over their size that differ by less are the same.
const SAME: f64 = 1e-6;
/// What cannot be computed is worth least.
const NOTHING: Worth = [f64::INFINITY, 0.0];

/// An alternative that was tried.
pub struct Tried {
    /// What it is.
    pub alternative: Alternative,
    /// Where the search for its numbers ended.
    pub reached: Result<Reached>,
    /// Its designs.
    pub history: Vec<Design>,
    /// Whether derivatives were exact.
    pub exact: bool,
}

impl Tried {
    fn worth(&self) -> Worth {
        let of = |reached: &Reached| worth(&reached.minimum, reached.sizes[0]);
        self.reached.as_ref().map_or(NOTHING, of)
    }

    /// As the result has it.
    pub fn compared(&self) -> Compared {
        Compared::of(&self.alternative, &self.reached)
    }
}

/// All that were tried, in the order of their digits, and what is to be said of the search.
pub fn explore(
    choice: &Choice,
    make: &(dyn Fn(&Alternative) -> Result<Problem> + Sync),
    asked: &Asked,
    stop: &(dyn Fn() -> bool + Sync),
    tell: &(dyn Fn(usize, Option<f64>) + Sync),
) -> Result<(Vec<Tried>, Explored)> {
    // numbers that are sought besides take starts for themselves
    let searches = asked.starts.filter(|_| asked.spans.is_empty()).unwrap_or(SEARCHES);
    let most = (MOST / searches).max(1);
    let all: Mutex<BTreeMap<Vec<usize>, Tried>> = Mutex::new(BTreeMap::new());
    let known = |digits: &[usize]| {
        let all = all.lock().unwrap_or_else(PoisonError::into_inner);
        all.get(digits).map(Tried::worth)
    };
    let look = |digits: &[usize]| {
        let alternative = choice.at(digits);
        let tried = match make(&alternative) {
            Err(error) => Tried {
                alternative,
                reached: Err(error),
                history: vec![],
                exact: true,
            },
            Ok(problem) => {
                let search = Search::new((0, &problem), asked, stop, tell);
                let reached = search.go(1);
                Tried {
                    alternative,
                    reached,
                    history: search.history(),
                    exact: search.derivatives() == Derivatives::Exact,
                }
            }
        };
        // what was broken off is not an answer
        if tried.reached.is_err() && stop() {
            return None;
        }
        let worth = tried.worth();
        let mut all = all.lock().unwrap_or_else(PoisonError::into_inner);
        all.entry(digits.to_vec()).or_insert(tried);
        Some(worth)
    };
    let sizes = choice.sizes();
    let space = Space {
        sizes: &sizes,
        allowed: &|digits| choice.allows(digits),
    };
    let go = |number: usize| -> Option<End> {
        let mut chance = Chance::new(SEED, number as u64);
        let start = match number {
            0 => choice.first(),
            _ => choice.drawn(&mut chance),
        };
        let mut own: BTreeMap<Vec<usize>, Worth> = BTreeMap::new();
        descend(&space, start, &mut chance, &mut |digits| {
            if stop() {
                return None;
            }
            if let Some(worth) = own.get(digits) {
                return Some(*worth);
            }
            if own.len() >= most {
                return None;
            }
            let worth = known(digits).or_else(|| look(digits))?;
            own.insert(digits.to_vec(), worth);
            Some(worth)
        })
    };
    let numbers: Vec<usize> = (0..searches).collect();
    let mut ends: Vec<End> = vec![];
    pool::each(&numbers, asked.jobs, &|k| (!stop()).then(|| go(k)), &mut |end| {
        ends.extend(end);
        Ok(())
    })?;
    let tried: Vec<Tried> = all
        .into_inner()
        .unwrap_or_else(PoisonError::into_inner)
        .into_values()
        .enumerate()
        .map(|(k, mut tried)| {
            tried.history.iter_mut().for_each(|design| design.alternative = k);
            tried
        })
        .collect();
    if tried.is_empty() {
        return Err(Error::Interrupted(
            "interrupted before a design was computed; nothing is written".into(),
        ));
    }
    let best = tried.iter().map(Tried::worth).min_by(order).unwrap_or(NOTHING);
    let same = |end: &&End| end.worth[0] == best[0] && (end.worth[1] - best[1]).abs() <= SAME * best[1].abs();
    let explored = Explored {
        of: choice.count(),
        tried: tried.len(),
        searches,
        ended: ends.iter().filter(|end| end.local).count(),
        came_to_best: ends.iter().filter(same).count(),
    };
    Ok((tried, explored))
}
