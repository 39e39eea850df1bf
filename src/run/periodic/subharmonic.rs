//! Cycles of several periods: subharmonics, whose motion recurs after two or more periods of the drive.
//!
//! Newton's iteration finds the nearest cycle, and a cycle of one period also recurs after two. The search therefore starts away from
//! it, at states of the motion itself.

use serde::{Deserialize, Serialize};

use super::PeriodicScene;
use super::scene::{fault, whole};
use super::self_oscillation;
use super::shooting::{Cycle, ShootingRecord, attempt, shoot};
use crate::case::schema::Case;
use crate::discrete::layout::LineLayout;
use crate::error::{Error, Result};
use crate::numerics::krylov;
use crate::onestep::step_map::StepError;
use crate::run::drive::comes_to_rest;
use crate::run::stop::StopFlag;

/// Largest number of periods of a cycle.
pub const MOST: usize = 64;
/// Largest displacement by which an unstable cycle is perturbed, over the length of the beam.
const PUSH: f64 = 1e-3;
/// Number of full cycles simulated between two attempts.
const PATIENCE: usize = 12;
/// Largest number of attempts.
const TRIES: usize = 40;
/// Number of successive approaches to a cycle of fewer periods up to which the search continues.
const NEARER: usize = 3;
/// Distance of two states, in tolerances, below which they count as equal.
const SAME: f64 = 10.0;
/// Number of multipliers, residual of their vectors, and largest number of vectors of the Krylov space.
const MULTIPLIERS: (usize, f64, usize) = (2, 1e-6, 300);

/// Number of periods after which a cycle recurs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Periods {
    /// Requested number of periods.
    pub asked: usize,
    /// Smallest number of periods after which it recurs; divides the requested one.
    pub shortest: usize,
    /// Number of periods simulated until the motion had settled.
    pub waited: usize,
    /// True if the cycle of one period is unstable, so that the search began beside it; else it began at the start of the case.
    pub beside: bool,
}

impl Periods {
    /// Description for messages.
    pub fn describe(&self) -> String {
        let Self {
            asked,
            shortest,
            waited,
            beside,
        } = self;
        let times = match shortest {
            1 => "every period".to_string(),
            count => format!("after {count} periods, not sooner"),
        };
        let from = if *beside {
            "from a disturbance of the cycle of one period, which is unstable"
        } else {
            "from the start of the case"
        };
        if shortest == asked {
            return format!("recurs {times}; found after {waited} periods {from}");
        }
        format!(
            "a cycle of {asked} periods was requested, but the cycle found recurs {times}. No longer cycle was found \
             within {waited} periods {from}. Another /start may lead to one."
        )
    }
}

/// Finds a cycle that recurs after `asked` periods of the drive, and not after fewer if such a cycle is found on the way.
///
/// ```text
/// P^N(y) = y, [E37] with the period N T        P^d(y) ≠ y for every d < N that divides N
/// ```
///
/// If the cycle of one period is unstable, the search begins beside it, along the multiplier of largest modulus: near -1 or beyond
/// it the disturbance recurs after two periods. Otherwise, or if no such cycle is found, it begins at the start of the case. The
/// motion is simulated until Newton's iteration from its state finds a cycle of this number of periods.
///
/// # Errors
/// The case has no period, the number of periods is out of range, or no cycle was found.
pub fn find(case: &Case, asked: usize) -> Result<(PeriodicScene, Cycle, Periods)> {
    find_until(case, asked, &StopFlag::default())
}

/// Finds the cycle of [`find`] unless `stop` requests an end; of a case whose signals all become constant a self-oscillation,
/// see [`self_oscillation::find`].
///
/// # Errors
/// As [`find`], or a stop was requested.
pub fn find_until(case: &Case, asked: usize, stop: &StopFlag) -> Result<(PeriodicScene, Cycle, Periods)> {
    if !(1..=MOST).contains(&asked) {
        return Err(Error::Usage(format!("--periods {asked}: must be from 1 to {MOST}")));
    }
    if comes_to_rest(&whole(case)?) {
        if asked != 1 {
            return Err(Error::Usage(format!(
                "--periods {asked}: nothing drives {} periodically, and a self-oscillation has one period. Omit the option",
                case.name
            )));
        }
        let (scene, cycle) = self_oscillation::find(case, stop)?;
        let periods = Periods {
            asked,
            shortest: 1,
            waited: 0,
            beside: false,
        };
        return Ok((scene, cycle, periods));
    }
    let single = PeriodicScene::new(case, None)?.heeding(stop);
    single.held(&case.name)?;
    let of_one = shoot(&single, None);
    let periods = |shortest, waited, beside| Periods {
        asked,
        shortest,
        waited,
        beside,
    };
    if asked == 1 {
        return Ok((single, of_one.map_err(fault)?, periods(1, 0, false)));
    }
    let scene = single.over(asked);
    let of_one = match of_one {
        Err(error) if stop.raised() => return Err(fault(error)),
        other => other,
    };
    let pushed = of_one.ok().and_then(|mut cycle| beside(&single, &mut cycle));
    let off = pushed.is_some();
    let mut y = pushed.unwrap_or_else(|| single.guess.clone());
    let mut shorter: Option<(Cycle, usize)> = None;
    let (mut nearer, mut distance) = (0, f64::INFINITY);
    let mut last = StepError::new(0.0, "no cycle was found");
    let mut search = ShootingRecord::default();
    for tries in 1..=TRIES {
        let waited = tries * PATIENCE * asked;
        y = single.go_on(&y, PATIENCE * asked, &mut search).map_err(fault)?;
        match attempt(&scene, y.clone(), &mut search) {
            Err(error) if stop.raised() => return Err(fault(error)),
            Err(error) => last = error,
            Ok(cycle) => match shortest(&single, &cycle.y, asked).map_err(fault)? {
                count if count == asked => return Ok((scene, cycle, periods(asked, waited, off))),
                count => {
                    let now = far(&scene, &y, &cycle.y);
                    nearer = if now < distance { nearer + 1 } else { 0 };
                    distance = now;
                    if now < SAME || nearer > NEARER {
                        return Ok((scene, cycle, periods(count, waited, off)));
                    }
                    shorter = Some((cycle, count));
                }
            },
        }
    }
    let waited = TRIES * PATIENCE * asked;
    shorter.map_or(Err(fault(last)), |(cycle, count)| {
        Ok((scene, cycle, periods(count, waited, off)))
    })
}

/// Distance of a state from another, in tolerances.
fn far(scene: &PeriodicScene, y: &[f64], other: &[f64]) -> f64 {
    let mut change: Vec<f64> = y.iter().zip(other).map(|(a, b)| a - b).collect();
    scene.admit(&mut change);
    scene.size(&change, other)
}

/// Smallest number of periods, a divisor of `asked`, after which a state recurs.
fn shortest(single: &PeriodicScene, y: &[f64], asked: usize) -> std::result::Result<usize, StepError> {
    for count in (1..asked).filter(|count| asked.is_multiple_of(*count)) {
        let back = single.go_on(y, count, &mut ShootingRecord::default())?;
        if far(single, &back, y) < SAME {
            return Ok(count);
        }
    }
    Ok(asked)
}

/// A state beside a cycle, along the disturbance that grows most; `None` if none grows.
fn beside(scene: &PeriodicScene, cycle: &mut Cycle) -> Option<Vec<f64>> {
    let (count, residual, most) = MULTIPLIERS;
    let mut start = krylov::everything(cycle.y.len());
    scene.admit(&mut start);
    let most = scene.dimension().min(most);
    let map = |v: &mut [f64]| {
        cycle.march.propagate(v);
        scene.admit(v);
    };
    let found = krylov::largest(map, &start, count.min(most), residual, most);
    let grows = found.into_iter().find(|eigen| eigen.value.norm() > 1.0)?;
    let [v, _] = grows.vector;
    let l = &scene.system.layout;
    let moved = l.lines.iter().flat_map(LineLayout::unknowns);
    let largest = moved.map(|(_, u, _)| (v[u] * l.scales[u]).abs()).fold(0.0, f64::max);
    // a disturbance of the fluid alone is limited by the scales of its unknowns
    let by_fluid = v.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let size = (PUSH * scene.system.model.length / largest).min(1.0 / by_fluid.max(f64::MIN_POSITIVE));
    Some(cycle.y.iter().zip(&v).map(|(y, v)| y + size * v).collect())
}
