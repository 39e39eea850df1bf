//! Modes of one sort, and the order of output.

use serde::{Deserialize, Serialize};

use super::{Linearised, Mode, ModeOptions, Modes, TimeBehavior, compute, limits};
use crate::error::Result;
use crate::spectral::AT_LAST_DENSE;

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

/// Largest number of modes searched in a large system if no sort is requested, over the number of requested modes.
const AMONG: usize = 8;

/// |s| over the frequency of an oscillation with a damping ratio of 0.9, `1/√(1 - 0.9²)`: more strongly damped ones hardly oscillate.
const DAMPED: f64 = 2.294;

impl Modes {
    /// True if every oscillation of lower frequency is listed, apart from those with damping ratios above 0.9.
    pub fn certain(&self, mode: &Mode) -> bool {
        DAMPED * mode.s.im <= self.radius
    }
}

/// Modes of a linearization: as many of a sort as planned, if there are so many among the nearest thousand; without a sort, as many
/// oscillations. Also returns the plan that finds all of them. Modes of other sorts remain until [`arrange`] removes them.
///
/// # Errors
/// As [`compute`].
pub fn of_sort(about: Linearised, plan: &ModeOptions, sort: Option<ModeFilter>) -> Result<(Modes, ModeOptions)> {
    // hundreds of decays may lie nearer to zero than oscillations and growth, which are listed first
    let of = match sort {
        Some(sort) => sort,
        None if about.system().layout.inertia && plan.near_hz == 0.0 => ModeFilter::Oscillation,
        None => return Ok((compute(about, plan)?, *plan)),
    };
    // the lowest frequencies are not those of the smallest |s| if damping is strong
    let lowest = of == ModeFilter::Oscillation && plan.near_hz == 0.0;
    let mut wider = ModeOptions { limits: false, ..*plan };
    if lowest {
        wider.count *= 2;
    }
    let mut found = compute(about, &wider)?;
    loop {
        let uncertain = |mode: &Mode| lowest && !found.clustered && !found.certain(mode);
        let own = found.modes.iter().filter(|mode| of.has(mode.kind) && !uncertain(mode));
        let moving = found.modes.iter().filter(|mode| !mode.kind.stays()).count();
        let most = match sort {
            None if found.finite > AT_LAST_DENSE => (AMONG * plan.count).min(MOST),
            _ => MOST,
        };
        if own.count() >= plan.count || moving < wider.count || wider.count >= most {
            break;
        }
        // if all eigenvalues were computed at once, a smaller number saves nothing
        wider.count = if found.dense { most } else { (2 * wider.count).min(most) };
        found = compute(found.about, &wider)?;
    }
    let mut listed = found.modes.clone();
    arrange(&mut listed, sort, plan);
    // the comparison with other systems needs all modes as near as those listed
    let far = |mode: &Mode| (mode.s - plan.target()).norm();
    let farthest = listed.iter().map(far).fold(0.0, f64::max);
    found.modes.retain(|mode| mode.kind.stays() || far(mode) <= farthest);
    let plan = ModeOptions {
        count: found.modes.iter().filter(|mode| !mode.kind.stays()).count().max(1),
        ..*plan
    };
    if plan.limits {
        limits::find(&mut found, &plan);
    }
    Ok((found, plan))
}

/// Sorts modes for output: growth, oscillation, decay, constant modes, each from slow to fast. Oscillations are sorted by frequency, as
/// sweeps number them, others by rate. Keeps only as many as planned, of the sort if one is requested: the slowest, or those nearest to
/// the planned frequency.
pub fn arrange(modes: &mut Vec<Mode>, sort: Option<ModeFilter>, plan: &ModeOptions) {
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
    let by_pace =
        |modes: &mut Vec<Mode>| modes.sort_by(|a, b| group(a).cmp(&group(b)).then(pace(a).total_cmp(&pace(b))));
    match plan.near_hz > 0.0 {
        true => modes.sort_by_key(group),
        false => by_pace(modes),
    }
    let mut left = plan.count;
    modes.retain(|mode| {
        let kept = left > 0 || (sort.is_none() && mode.kind.stays());
        left -= usize::from(kept && (sort.is_some() || !mode.kind.stays()));
        kept
    });
    by_pace(modes);
}
