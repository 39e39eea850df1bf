//! What the effects that candidates leave out change, and whether to take them in.
//!
//! A run with all of them stands beside a candidate at the same mesh and tolerance, so that both have the same numerical error.

use std::collections::BTreeMap;

use super::estimates::{At, Way};
use super::models::{self, Full};
use super::search::{Ran, Search};
use crate::error::Result;
use crate::run::summary::Status;
use crate::study::effects::choices::effects;

/// Part of the accuracy asked that the effects left out may take.
const SHARE: f64 = 0.3;
/// How far beyond the accuracy asked, and beyond what the first runs are apart, a change is no matter of coarse runs.
const GROSS: f64 = 3.0;
/// Models with some of the effects that are tried before that with all.
const TRIED: usize = 2;

/// What came of a look at the effects that are left out.
pub enum Look {
    /// What they change is known, or cannot be known.
    Known,
    /// Candidates have more effects from now on.
    MoreEffects,
    /// Everything must stop.
    Stopped(String),
}

impl Search<'_> {
    /// Looks at what the effects left out change beside a candidate, by a run on half its mesh, and takes them in where it is too
    /// much: strictly in the end, or by a generous measure at the beginning.
    pub fn look_at_effects(&mut self, at: At, strictly: bool) -> Result<Look> {
        let Some(full) = self.full.clone() else {
            return Ok(Look::Known);
        };
        let beside = (at.0 / 2, at.1);
        let known = self.runs.effects(at).filter(|_| strictly);
        // What is seen beside a coarser candidate does; what is too much there may be its numerical error.
        if known.is_some_and(|level| self.within(&self.runs.changes(level), SHARE * self.asked)) {
            return Ok(Look::Known);
        }
        if let Ran::Stopped(reason) = self.run(Way::Full, beside)? {
            return Ok(Look::Stopped(reason));
        }
        if !self.runs.hold(Way::Full, beside) || !self.runs.hold(Way::Candidate, beside) {
            return Ok(Look::Known);
        }
        let changes = self.runs.changes(beside);
        let allowed = |name: &str| {
            if strictly {
                return SHARE * self.asked;
            }
            let apart = [beside, (at.0, at.1 - 1)].map(|other| self.runs.difference(name, at, other).unwrap_or(1.0));
            GROSS * apart.into_iter().fold(self.asked, f64::max)
        };
        if changes.iter().all(|(name, change)| *change <= allowed(name)) {
            return Ok(Look::Known);
        }
        let most = if strictly {
            SHARE * self.asked
        } else {
            GROSS * self.asked
        };
        self.take_in(&full, beside, most)
    }

    fn within(&self, changes: &BTreeMap<String, f64>, most: f64) -> bool {
        changes.values().all(|change| *change <= most)
    }

    /// Goes over to the fewest effects with which what is left out changes no more than `most`, beside a run with all of them.
    fn take_in(&mut self, full: &Full, beside: At, most: f64) -> Result<Look> {
        for candidate in models::tighter(&self.case, full)?.into_iter().take(TRIED) {
            let case = crate::study::accuracy::plan::refined(&candidate, beside.0, 10_f64.powi(-beside.1));
            let (summary, stopped) = self.unrecorded(&case, Way::Candidate, beside, None)?;
            if let Some(reason) = stopped {
                return Ok(Look::Stopped(reason));
            }
            if summary.status != Status::Finished {
                continue;
            }
            let before = self.runs.clone();
            self.runs.go_over(false);
            self.runs.take(Way::Candidate, beside, &summary);
            if self.within(&self.runs.changes(beside), most) {
                self.taken_in
                    .extend(models::more(&effects(&self.case)?, &effects(&candidate)?));
                self.case = candidate;
                self.full = models::full(&self.case)?;
                self.failed.clear();
                return Ok(Look::MoreEffects);
            }
            self.runs = before;
        }
        self.take_all_effects();
        Ok(Look::MoreEffects)
    }

    /// Goes over to all effects; false where candidates have them.
    pub fn take_all_effects(&mut self) -> bool {
        let Some(full) = self.full.take() else { return false };
        self.taken_in.extend(full.left_out);
        self.case = full.case;
        self.runs.go_over(true);
        self.failed.clear();
        true
    }
}
