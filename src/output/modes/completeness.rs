//! Completeness of the listed oscillations.

use super::Report;
use crate::error::Code;
use crate::output::numbers::{counted, significant};
use crate::run::modes::{Mode, ModeFilter};

impl Report<'_> {
    /// Oscillations, in the order of the list, if as many of the lowest as possible were requested.
    fn lowest(&self) -> Option<Vec<&Mode>> {
        let inertia = self.found.about.system().layout.inertia;
        let asked = matches!(self.sort, None | Some(ModeFilter::Oscillation)) && inertia && self.plan.near_hz == 0.0;
        asked.then(|| self.found.modes.iter().filter(|mode| mode.kind.swings()).collect())
    }

    /// Number of all oscillations of the case, if it has fewer than requested.
    pub(super) fn only(&self) -> Option<String> {
        let count = self.lowest()?.len();
        let found = self.found;
        let all = found.radius.is_infinite() && found.lost == 0;
        (all && count < self.plan.count && !found.modes.is_empty()).then(|| {
            let are = if count == 1 { "is" } else { "are" };
            format!(
                "there {are} {} in all: all {} were computed",
                counted(count as u64, "oscillation"),
                counted(found.finite as u64, "finite eigenvalue")
            )
        })
    }

    /// Warns of oscillations that may be missing.
    pub(super) fn uncertain(&self) -> Option<String> {
        let lowest = self.lowest()?;
        let found = self.found;
        // both have a warning of their own
        if found.clustered || found.lost > 0 || found.radius.is_infinite() {
            return None;
        }
        let certain = lowest.iter().filter(|mode| found.certain(mode)).count();
        (certain < self.plan.count).then(|| {
            Code::LostModes.warning(format!(
                "{} of {} requested oscillations are certain to be the lowest: all modes with |s| up to {} 1/s were \
                 searched, and decays are too many among them. Strongly damped oscillations may be missing. Use --kind \
                 oscillation, --near, or fewer cells.",
                certain,
                self.plan.count,
                significant(found.radius, 3)
            ))
        })
    }
}
