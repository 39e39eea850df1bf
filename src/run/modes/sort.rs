//! Modes of one sort, and the order of output.

use serde::{Deserialize, Serialize};

use super::{Linearised, Mode, ModeOptions, Modes, TimeBehavior, compute};
use crate::error::Result;

/// Sort of modes to select.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ModeFilter {
    /// Oscillations, growing or not.
    Oscillation,
    /// Decays without oscillation.
    Decay,
    /// Growth, with or without oscillation.
    Growth,
}

impl ModeFilter {
    /// True if a mode of this kind belongs to the sort.
    pub fn has(self, kind: TimeBehavior) -> bool {
        match self {
            Self::Oscillation => kind.swings(),
            Self::Decay => kind == TimeBehavior::Decay,
            Self::Growth => kind.grows(),
        }
    }

    /// Name on the command line.
    pub fn word(self) -> &'static str {
        match self {
            Self::Oscillation => "oscillation",
            Self::Decay => "decay",
            Self::Growth => "growth",
        }
    }
}

/// Largest number of modes among which those of a sort are searched.
const MOST: usize = 1000;

/// Largest number of modes searched if no sort is requested, over the number of requested modes.
const AMONG: usize = 8;

/// Modes of a linearization: as many of a sort as planned, if there are so many among the nearest thousand. Also returns the plan that
/// finds all of them. Modes of other sorts remain until [`arrange`] removes them.
///
/// # Errors
/// As [`of`].
pub fn of_sort(about: Linearised, plan: &ModeOptions, sort: Option<ModeFilter>) -> Result<(Modes, ModeOptions)> {
    // hundreds of decays of the fluid may lie nearer to zero than oscillations and growth, which are listed first
    let (sort, most) = match sort {
        Some(sort) => (sort, MOST),
        None if about.system().layout.inertia && plan.near_hz == 0.0 => {
            (ModeFilter::Oscillation, (AMONG * plan.count).clamp(plan.count, MOST))
        }
        None => return Ok((compute(about, plan)?, *plan)),
    };
    let mut wider = ModeOptions { limits: false, ..*plan };
    let mut about = about;
    loop {
        let found = compute(about, &wider)?;
        let own = found.modes.iter().filter(|mode| sort.has(mode.kind)).count();
        let moving = found.modes.iter().filter(|mode| !mode.kind.stays()).count();
        let more = own < plan.count && moving >= wider.count && wider.count < most;
        if !more {
            let plan = ModeOptions {
                limits: plan.limits,
                ..wider
            };
            return match plan.limits {
                true => Ok((compute(found.about, &plan)?, plan)),
                false => Ok((found, plan)),
            };
        }
        // if all eigenvalues were computed at once, a smaller number saves nothing
        wider.count = if found.dense { most } else { (2 * wider.count).min(most) };
        about = found.about;
    }
}

/// Sorts modes for output: growth, oscillation, decay, constant modes, each from slow to fast. Oscillations are sorted by frequency, as
/// sweeps number them, others by rate. Keeps only `count` of them, of the sort if one is requested.
pub fn arrange(modes: &mut Vec<Mode>, sort: Option<ModeFilter>, count: usize) {
    if let Some(sort) = sort {
        modes.retain(|mode| sort.has(mode.kind));
    }
    let group = |mode: &Mode| match mode.kind {
        TimeBehavior::Flutter | TimeBehavior::Divergence => 0,
        TimeBehavior::Oscillation => 1,
        TimeBehavior::Decay => 2,
        TimeBehavior::Rigid => 3,
        TimeBehavior::Volume => 4,
    };
    let pace = |mode: &Mode| if mode.kind.swings() { mode.s.im } else { mode.s.norm() };
    // of modes beside a frequency, the nearest are kept
    modes.sort_by_key(group);
    let mut left = count;
    modes.retain(|mode| {
        let kept = left > 0 || (sort.is_none() && mode.kind.stays());
        left -= usize::from(kept && (sort.is_some() || !mode.kind.stays()));
        kept
    });
    modes.sort_by(|a, b| group(a).cmp(&group(b)).then(pace(a).total_cmp(&pace(b))));
}
