//! Whether an accuracy that was promised is kept.

use std::cell::Cell;

use slcbeam::case::Case;
use slcbeam::run::dynamics;
use slcbeam::run::record::{Control, Progress};
use slcbeam::run::summary::{Judged, Summary};
use slcbeam::study::target;

use crate::judge::{KNOWN, Verdict, Word, errors, guess, should_end, unknown};
use crate::reference::{Found, Reference};
use crate::run::{BUDGET, figures, finished, steps};

/// Steps of the runs that a search makes beside those that it keeps.
const STEPS: u64 = 10_000;
/// Steps times unknowns of a run that is kept.
const WORK: f64 = 3e6;

/// Judges the run that a search chooses, with error over estimate of its quantities.
pub fn judge(case: &Case, asked: f64, found: &Found) -> (Verdict, Vec<f64>) {
    let left = Cell::new(STEPS);
    let hook = |_: &Progress| match left.get() {
        0 => Control::Stop(BUDGET.into()),
        some => {
            left.set(some - 1);
            Control::Continue
        }
    };
    let mut record = |case: &Case| dynamics::run(case, &mut steps((WORK / guess(case)) as u64));
    let outcome = match target::reach(case, asked, &hook, &mut record) {
        Ok(outcome) => outcome,
        Err(error) => return (Verdict::new(Word::Silent, format!("search: {error}")), vec![]),
    };
    let run = outcome.summary;
    let none = |verdict| (verdict, vec![]);
    match found {
        _ if !finished(&run) && run.reason.as_deref() == Some(BUDGET) => {
            none(Verdict::new(Word::Unknown, "search too long"))
        }
        _ if !finished(&run) => none(Verdict::new(Word::Ended, run.reason.unwrap_or_default())),
        Found::Unknown(why) => none(Verdict::new(Word::Unknown, why.as_str())),
        Found::Ends(why) => none(should_end(&run, why)),
        Found::Known(reference) => kept(&run, asked, reference),
    }
}

fn kept(run: &Summary, asked: f64, reference: &Reference) -> (Verdict, Vec<f64>) {
    let Some(accuracy) = &run.accuracy else {
        return (Verdict::new(Word::Warned, "nothing is promised"), vec![]);
    };
    let statistics = |figure: &str| matches!(figure, "window_rms" | "window");
    let counts = |figure: &str| accuracy.judged_by == Judged::Figures || statistics(figure);
    let off = errors(&figures(run), reference, counts);
    let surely = off.iter().find(|one| one.beyond(asked));
    let Some(worst) = surely.or(off.first()) else {
        return (Verdict::new(Word::Unknown, "no figures"), vec![]);
    };
    let estimate = |quantity: &str| accuracy.quantities.get(quantity).and_then(|e| e.total);
    let told = format!(
        "{}; estimate {:.1e}, {} cells, rtol {:.0e}, reached {}",
        worst.told(),
        estimate(&worst.quantity).unwrap_or(f64::NAN),
        accuracy.cells_per_segment,
        accuracy.rtol,
        accuracy.reached
    );
    let mut ratios = vec![];
    for quantity in reference.sizes.keys() {
        let of = off.iter().filter(|one| one.quantity == *quantity);
        let largest = of.max_by(|a, b| a.error.total_cmp(&b.error));
        if let (Some(largest), Some(estimate)) = (largest, estimate(quantity))
            && accuracy.reached
            && largest.doubt <= KNOWN * largest.error.max(0.05 * asked)
        {
            ratios.push(largest.error.max(0.01 * asked) / estimate.max(0.01 * asked));
        }
    }
    let word = match (worst.beyond(asked), accuracy.reached) {
        (true, true) => Word::Silent,
        (true, false) => Word::Warned,
        (false, _) if unknown(&off, asked).is_some() => Word::Unknown,
        (false, _) => Word::Right,
    };
    (Verdict::new(word, told), ratios)
}
