//! Which setting makes an error that is large, and the warning.
//!
//! Each setting is changed by itself: the cells of the beam and those of a bladder to those of the companion, a tenth of the tolerance, each
//! effect that is left out. These runs are made only where an error is above the limit and the run is small.

use std::collections::BTreeMap;

use super::variant::{Cause, Variant};
use super::{Limits, error, finish, progress, work};
use crate::case::Case;
use crate::error::numbers::significant;
use crate::error::{Code, Result};
use crate::integrate::halt;
use crate::numerics::threads;
use crate::run::record::Recorder;
use crate::run::summary::{Figures, Status, Summary};
use crate::study::counted::Floors;
use crate::study::target::models;

/// Relative error that is large.
pub const LIMIT: f64 = 0.05;
/// Error bar from which on a quantity may have a large error: bars may be too small by half.
const NAMED_FROM: f64 = 0.5 * LIMIT;
/// Largest work (steps times unknowns) of a run whose errors are attributed.
const LARGEST_WORK: u64 = 20_000_000;
/// Largest work of a run with one change, relative to that of the run.
const LONGEST: u64 = 20;
/// Smallest share of an error at which a cause is named.
const NAMED: f64 = 0.1;
/// Finest meshes and tightest tolerance that are proposed.
const FINEST: usize = 256;
const TIGHTEST: f64 = 1e-12;

/// Warning of figures without errors.
pub fn unknown(status: Status, reason: &str) -> Option<String> {
    (status == Status::Finished)
        .then(|| Code::ErrorEstimate.warning(format!("errors of figures are not known: {reason}. Use --accuracy.")))
}

/// Warns of errors above the limit, with their causes and a remedy.
pub(super) fn attribute(case: &Case, summary: &mut Summary, recorder: &mut dyn Recorder) -> Result<()> {
    let relative = error::relative(summary, &Floors::of(case)?);
    let mut large: Vec<(&String, f64)> = relative.iter().map(|(name, e)| (name, *e)).collect();
    large.retain(|(_, error)| *error > NAMED_FROM);
    large.sort_by(|a, b| b.1.total_cmp(&a.1));
    if large.is_empty() {
        return Ok(());
    }
    let causes = match work(summary) <= LARGEST_WORK {
        true => causes(case, summary, recorder)?,
        false => BTreeMap::new(),
    };
    let warning = words(case, &large, &shares(summary, &causes));
    summary.warnings.insert(0, warning);
    if let Some(companion) = &mut summary.companion {
        companion.causes = causes
            .into_iter()
            .map(|(cause, errors)| (cause.pointer(), errors))
            .collect();
    }
    Ok(())
}

/// Errors of all figures by each cause.
fn causes(case: &Case, summary: &Summary, recorder: &mut dyn Recorder) -> Result<BTreeMap<Cause, Figures>> {
    let effects = models::full(case)?.map_or(vec![], |full| full.left_out);
    let settings = [Cause::BeamMesh, Cause::FluidMesh, Cause::TimeSteps];
    let all = settings.into_iter().chain(effects.into_iter().map(Cause::Effect));
    let limits = Limits {
        cancelled: false.into(),
        work: (LONGEST * work(summary) + super::SMALL_WORK).into(),
    };
    let (own, Some(companion)) = (error::figures(summary), &summary.companion) else {
        return Ok(BTreeMap::new());
    };
    let heard = halt::heard();
    let mut found = BTreeMap::new();
    for cause in all {
        let Some((variant, factor)) = Variant::with_change(case, companion, cause)? else {
            continue;
        };
        let (run, stopped) = std::thread::scope(|scope| {
            let task = threads::begin(scope, || heard.during(|| finish(&variant, &limits)));
            let stopped = super::wait(&task, &limits, &progress(summary), recorder);
            (task.join(), stopped)
        });
        if stopped?.is_some() {
            break;
        }
        if let Ok(run) = run {
            let mut errors = error::differences(&own, &error::figures(&run));
            errors
                .values_mut()
                .flat_map(BTreeMap::values_mut)
                .for_each(|error| *error *= factor);
            found.insert(cause, errors);
        }
    }
    Ok(found)
}

/// Shares of each cause in the largest error of each quantity.
fn shares(summary: &Summary, causes: &BTreeMap<Cause, Figures>) -> BTreeMap<String, Vec<(Cause, f64)>> {
    let of = |name: &String| {
        let size = |errors: &Figures| errors.get(name).map_or(0.0, error::largest);
        let quantity = [&summary.quantities, &summary.probes, &summary.ports];
        let largest = quantity.iter().find_map(|all| all.get(name)).map_or(0.0, |q| q.size());
        let mut all: Vec<(Cause, f64)> = causes.iter().map(|(c, errors)| (*c, size(errors) / largest)).collect();
        all.sort_by(|a, b| b.1.total_cmp(&a.1));
        (name.clone(), all)
    };
    summary.errors.keys().map(of).collect()
}

fn words(case: &Case, large: &[(&String, f64)], shares: &BTreeMap<String, Vec<(Cause, f64)>>) -> String {
    let names: Vec<String> = large
        .iter()
        .map(|(name, e)| format!("{name} ± {}", percent(*e)))
        .collect();
    let found = format!(
        "errors may exceed {} of the largest value: {}.",
        percent(LIMIT),
        names.join(", ")
    );
    let of = |name: &str| shares.get(name).map_or(&[][..], Vec::as_slice);
    let (worst, error) = (large[0].0, large[0].1);
    let causes: Vec<String> = of(worst)
        .iter()
        .filter(|(_, share)| *share >= NAMED * error)
        .map(|(cause, share)| format!("{} {}", cause.name(), percent(*share)))
        .collect();
    // the largest cause of each quantity, and others that are above the limit by themselves
    let mut wanted: BTreeMap<Cause, f64> = BTreeMap::new();
    for (name, error) in large {
        let sum: f64 = of(name).iter().map(|(_, share)| share).sum();
        let named = of(name).iter().filter(|(_, share)| *share >= NAMED * error);
        for (k, (cause, share)) in named.enumerate() {
            // the error bar is what has to become small
            let part = share.max(error * share / sum);
            if k == 0 || part > NAMED_FROM {
                let most = wanted.entry(*cause).or_insert(0.0);
                *most = most.max(part);
            }
        }
    }
    if causes.is_empty() {
        let what = "The causes are not measured for a run of this size, or stand below a tenth of the error";
        return Code::ErrorEstimate.warning(format!("{found} {what}. Use --accuracy {LIMIT}."));
    }
    let set: Vec<String> = wanted.iter().map(|(cause, error)| cause.remedy(case, *error)).collect();
    Code::ErrorEstimate.warning(format!(
        "{found} Causes for {worst}: {}. Use {}.",
        causes.join(", "),
        set.join(" ")
    ))
}

impl Cause {
    fn name(self) -> String {
        match self {
            Self::BeamMesh => "beam mesh".into(),
            Self::FluidMesh => "fluid mesh".into(),
            Self::TimeSteps => "time steps".into(),
            Self::Effect(effect) => format!("{effect} left out"),
        }
    }

    /// The argument that reduces an error of this size below that from which a quantity is named.
    fn remedy(self, case: &Case, error: f64) -> String {
        let times = |order: f64| ((error / NAMED_FROM).log2() / order).ceil().max(1.0).exp2() as usize;
        match self {
            Self::BeamMesh => {
                let cells = case.mesh.cells_per_segment;
                let finer = (cells * times(f64::from(case.mesh.order()))).min(FINEST.max(2 * cells));
                format!("--set {}={finer}", self.pointer())
            }
            Self::FluidMesh => {
                let cells = case.mesh.cells_per_bladder;
                let finer = (cells * times(1.0)).min(FINEST.max(2 * cells));
                format!("--set {}={finer}", self.pointer())
            }
            Self::TimeSteps => {
                let decades = (error / NAMED_FROM).log10().ceil().max(1.0);
                let tighter = (case.solver.rtol * 10_f64.powf(-decades)).max(TIGHTEST);
                format!("--set {}={tighter:.0e}", self.pointer())
            }
            Self::Effect(_) => format!("--set '{}=\"on\"'", self.pointer()),
        }
    }
}

fn percent(x: f64) -> String {
    let digits = match x {
        x if x >= 10.0 => return "over 1000 %".into(),
        x if x < 0.095 => 1,
        x if x < 1.0 => 2,
        _ => 3,
    };
    format!("{} %", significant(100.0 * x, digits))
}
