//! Named numbers with estimated errors, of whatever computes a case at once: equilibria, modes, cycles, multipliers.
//!
//! With `x(K, τ)` a number on a mesh of K cells a segment at tolerance τ,
//!
//! ```text
//! e_space = S ρ/(1 - ρ) |x(K) - x(K/2)|      ρ = |x(K) - x(K/2)|/|x(K/2) - x(K/4)|      e_time likewise with 10 τ, 100 τ
//! ```
//!
//! the sum of the geometric series of differences, with a factor S for safety. No mesh is believed whose half and quarter have not
//! been looked at, no tolerance without ten times it.

pub mod numbers;

use std::collections::BTreeMap;
use std::time::Instant;

use super::accuracy::plan;
use crate::case::Case;
use crate::error::{Code, Result};
use crate::run::summary::{Accuracy, Estimate, Judged, Pilot};

/// Finest mesh and tightest tolerance that are tried: cells a segment, decades.
const FINEST: usize = 64;
const TIGHTEST: i32 = 9;
/// First mesh and tolerance that may do.
const FIRST: At = (4, 5);
/// Ratios of differences that are believed: beyond them differences happen to be small or large.
const BELIEVED: [f64; 2] = [0.2, 0.7];
/// Of an estimate, for safety.
const SAFETY: f64 = 1.25;
/// Largest dimensionless accuracy that makes sense, and least.
const SENSIBLE: std::ops::RangeInclusive<f64> = 1e-6..=0.5;

/// Cells a segment, and `k` of `rtol = 10^-k`.
type At = (usize, i32);

/// A number that is computed, and the size beside which its errors count when it is smaller itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Number {
    /// Its value.
    pub value: f64,
    /// What would be large.
    pub size: f64,
}

/// Numbers by name.
pub type Numbers = BTreeMap<String, Number>;

/// Finds mesh, and tolerance where `in_time`, at which every number of `compute` has an estimated error below `asked`, relative to
/// it. Returns the case so, and what is known.
///
/// # Errors
/// Those of `compute`, on the first mesh; when a finer one fails, the one before stands.
pub fn refine(
    case: &Case,
    asked: f64,
    in_time: bool,
    compute: &mut dyn FnMut(&Case) -> Result<Numbers>,
) -> Result<(Case, Accuracy)> {
    let mut search = Search {
        case,
        in_time,
        runs: BTreeMap::new(),
        pilots: vec![],
    };
    let mut at = FIRST;
    for needed in search.needed(at) {
        search.run(needed, compute)?;
    }
    let mut estimates = search.estimates(at);
    while largest(&estimates) > asked {
        let (cells, decades) = at;
        let part = |of: fn(&Estimate) -> Option<f64>| estimates.values().filter_map(of).fold(0.0, f64::max);
        let (time, space) = (part(|e| e.time), part(|e| e.space));
        let finer = (2 * cells, decades);
        let next = match in_time && (time > space || finer.0 > FINEST) {
            true => (cells, decades + 1),
            false => finer,
        };
        let possible = next.0 <= FINEST && next.1 <= TIGHTEST;
        let needed = search.needed(next);
        if !possible || needed.into_iter().any(|needed| search.run(needed, compute).is_err()) {
            break;
        }
        at = next;
        estimates = search.estimates(at);
    }
    let case = search.variant(at);
    let accuracy = Accuracy {
        asked,
        reached: largest(&estimates) <= asked,
        cells_per_segment: case.mesh.cells_per_segment,
        cells_per_bladder: case.mesh.cells_per_bladder,
        rtol: case.solver.rtol,
        judged_by: Judged::Figures,
        effects: String::new(),
        quantities: estimates,
        pilots: search.pilots,
    };
    Ok((case, accuracy))
}

/// Whether an accuracy makes sense.
pub fn sensible(asked: f64) -> bool {
    SENSIBLE.contains(&asked)
}

/// What to say where an accuracy is not reached.
pub fn warning(found: &Accuracy) -> Option<String> {
    let short = found.quantities.iter().filter_map(|(name, e)| match e.total {
        Some(total) if total <= found.asked => None,
        Some(total) => Some(format!("{name} {total:.1e}")),
        None => Some(format!("{name} unknown")),
    });
    let short: Vec<String> = short.collect();
    (!found.reached).then(|| {
        Code::Accuracy.warning(format!(
            "accuracy: {:e} is not reached with {} cells a segment and rtol {:e}: {}",
            found.asked,
            found.cells_per_segment,
            found.rtol,
            short.join(", ")
        ))
    })
}

struct Search<'a> {
    case: &'a Case,
    in_time: bool,
    runs: BTreeMap<At, Numbers>,
    pilots: Vec<Pilot>,
}

impl Search<'_> {
    fn variant(&self, (cells, decades): At) -> Case {
        let rtol = if self.in_time {
            10_f64.powi(-decades)
        } else {
            self.case.solver.rtol
        };
        plan::refined(self.case, cells, rtol)
    }

    /// A setting and those that it is judged by.
    fn needed(&self, (cells, decades): At) -> Vec<At> {
        let mut all = vec![(cells / 4, decades), (cells / 2, decades), (cells, decades)];
        if self.in_time {
            all.extend([(cells, decades - 1), (cells, decades - 2)]);
        }
        all
    }

    fn run(&mut self, at: At, compute: &mut dyn FnMut(&Case) -> Result<Numbers>) -> Result<()> {
        if self.runs.contains_key(&at) {
            return Ok(());
        }
        let (case, begin) = (self.variant(at), Instant::now());
        let numbers = compute(&case)?;
        self.runs.insert(at, numbers);
        self.pilots.push(Pilot {
            with: String::new(),
            unknowns: 0,
            cells_per_segment: at.0,
            rtol: case.solver.rtol,
            steps: 0,
            wall_s: begin.elapsed().as_secs_f64(),
        });
        Ok(())
    }

    fn estimates(&self, at: At) -> BTreeMap<String, Estimate> {
        let (cells, decades) = at;
        let Some(numbers) = self.runs.get(&at) else {
            return BTreeMap::new();
        };
        let of = |(name, number): (&String, &Number)| {
            let space = self.series(name, number, [(cells / 4, decades), (cells / 2, decades)]);
            let time = self
                .in_time
                .then(|| self.series(name, number, [(cells, decades - 2), (cells, decades - 1)]));
            let estimate = Estimate {
                time: time.flatten(),
                space,
                total: match time {
                    None => space,
                    Some(time) => time.zip(space).map(|(t, s)| t + s),
                },
                ..Estimate::default()
            };
            (name.clone(), estimate)
        };
        numbers.iter().map(of).collect()
    }

    /// Error of a number, relative to it, by what it was twice before.
    fn series(&self, name: &str, number: &Number, [coarsest, coarse]: [At; 2]) -> Option<f64> {
        let value = |at: At| Some(self.runs.get(&at)?.get(name)?.value);
        let (coarsest, coarse) = (value(coarsest)?, value(coarse)?);
        let (before, last) = ((coarse - coarsest).abs(), (number.value - coarse).abs());
        if last == 0.0 {
            return Some(0.0);
        }
        let [least, most] = BELIEVED;
        let ratio = if before > 0.0 {
            (last / before).clamp(least, most)
        } else {
            most
        };
        let size = number.value.abs().max(number.size).max(f64::MIN_POSITIVE);
        Some(SAFETY * ratio / (1.0 - ratio) * last / size).filter(|e| e.is_finite())
    }
}

fn largest(estimates: &BTreeMap<String, Estimate>) -> f64 {
    let total = |e: &Estimate| e.total.unwrap_or(f64::INFINITY);
    estimates.values().map(total).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn case() -> Case {
        serde_json::from_str(
            r#"{"name": "x", "beam": {"length_m": 1, "height_m": 0.01, "width_m": 0.01, "young_modulus_pa": 1e9,
                "density_kg_m3": 1e3}, "ends": {"root": "clamped", "tip": "free"}, "time": {"end_s": 1}}"#,
        )
        .unwrap()
    }

    /// A number with errors of order 2 in space and 4/5 in the tolerance, of one sign: reached, and the estimate is no less than the truth and no
    /// more than three times it. One that goes on to jump is said not to be reached.
    #[test]
    fn numbers_are_refined_until_their_estimates_do() {
        let value = |case: &Case| {
            let h = 1.0 / case.mesh.cells_per_segment as f64;
            1.0 + 0.7 * h * h + 3.0 * case.solver.rtol.powf(0.8)
        };
        let mut compute = |case: &Case| {
            let number = Number {
                value: value(case),
                size: 0.0,
            };
            Ok(Numbers::from([("x".to_string(), number)]))
        };
        let (chosen, found) = refine(&case(), 1e-3, true, &mut compute).unwrap();
        let (error, total) = ((value(&chosen) - 1.0).abs(), found.quantities["x"].total.unwrap());
        assert!(
            found.reached && error <= total && total < 3.0 * error,
            "{error:e} {total:e}"
        );
        assert_eq!(warning(&found), None);
        let mut sign = 1.0;
        let mut jumps = |_: &Case| {
            sign = -sign;
            Ok(Numbers::from([(
                "x".to_string(),
                Number {
                    value: 2.0 + sign,
                    size: 0.0,
                },
            )]))
        };
        let (_, found) = refine(&case(), 1e-3, false, &mut jumps).unwrap();
        assert!(!found.reached && warning(&found).unwrap().contains("W012"));
    }
}
