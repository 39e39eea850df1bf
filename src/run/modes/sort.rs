//! Modes of one sort, and the order in which modes are told.

use serde::{Deserialize, Serialize};

use super::{Kind, Linearised, Mode, Modes, Plan, of};
use crate::error::Result;

/// What of modes is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Sort {
    /// What swings, growing or not.
    Oscillation,
    /// What dies away without swinging.
    Decay,
    /// What grows, swinging or not.
    Growth,
}

impl Sort {
    /// Whether a mode is of it.
    pub fn has(self, kind: Kind) -> bool {
        match self {
            Self::Oscillation => kind.swings(),
            Self::Decay => kind == Kind::Decay,
            Self::Growth => kind.grows(),
        }
    }

    /// As the command line has it.
    pub fn word(self) -> &'static str {
        match self {
            Self::Oscillation => "oscillation",
            Self::Decay => "decay",
            Self::Growth => "growth",
        }
    }
}

/// Modes among which those of a sort are looked for, at most.
const MOST: usize = 1000;

/// The same over those that are told, where no sort is asked for.
const AMONG: usize = 8;

/// Modes of a linearisation, as many of a sort as planned where there are so many among the nearest thousand, with the plan by which all of
/// them are found: others are among them until [`arrange`] takes them out.
///
/// # Errors
/// As [`of`].
pub fn of_sort(about: Linearised, plan: &Plan, sort: Option<Sort>) -> Result<(Modes, Plan)> {
    // beside what swings and grows, which is told first, hundreds of decays of the fluid may lie nearer to zero
    let (sort, most) = match sort {
        Some(sort) => (sort, MOST),
        None if about.system().layout.inertia && plan.near_hz == 0.0 => {
            (Sort::Oscillation, (AMONG * plan.count).clamp(plan.count, MOST))
        }
        None => return Ok((of(about, plan)?, *plan)),
    };
    let mut wider = Plan { limits: false, ..*plan };
    let mut about = about;
    loop {
        let found = of(about, &wider)?;
        let own = found.modes.iter().filter(|mode| sort.has(mode.kind)).count();
        let moving = found.modes.iter().filter(|mode| !mode.kind.stays()).count();
        let more = own < plan.count && moving >= wider.count && wider.count < most;
        if !more {
            let plan = Plan {
                limits: plan.limits,
                ..wider
            };
            return match plan.limits {
                true => Ok((of(found.about, &plan)?, plan)),
                false => Ok((found, plan)),
            };
        }
        // where all eigenvalues were computed at once there is nothing to save
        wider.count = if found.dense { most } else { (2 * wider.count).min(most) };
        about = found.about;
    }
}

/// Puts modes into the order in which they are told: what grows, what swings, what decays, what stays as it is, each from slow to fast: what
/// swings by its frequency, as sweeps number it, what does not by its rate; so many alone, of a sort where one is asked for.
pub fn arrange(modes: &mut Vec<Mode>, sort: Option<Sort>, count: usize) {
    if let Some(sort) = sort {
        modes.retain(|mode| sort.has(mode.kind));
    }
    let group = |mode: &Mode| match mode.kind {
        Kind::Flutter | Kind::Divergence => 0,
        Kind::Oscillation => 1,
        Kind::Decay => 2,
        Kind::Rigid => 3,
        Kind::Volume => 4,
    };
    let pace = |mode: &Mode| if mode.kind.swings() { mode.s.im } else { mode.s.norm() };
    // of modes beside a frequency the nearest are told
    modes.sort_by_key(group);
    let mut left = count;
    modes.retain(|mode| {
        let kept = left > 0 || (sort.is_none() && mode.kind.stays());
        left -= usize::from(kept && (sort.is_some() || !mode.kind.stays()));
        kept
    });
    modes.sort_by(|a, b| group(a).cmp(&group(b)).then(pace(a).total_cmp(&pace(b))));
}
