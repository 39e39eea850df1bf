//! Whether an accuracy that was promised is kept.

use std::sync::Mutex;

use slcbeam::case::Case;
use slcbeam::discrete::System;
use slcbeam::run::rounding_scales::RoundingScales;
use slcbeam::run::summary::Summary;
use slcbeam::study::companion::{self, Accurate, error};
use slcbeam::study::target;

use crate::judge::{self, KNOWN, Verdict, Word, errors, guess, should_end, unknown};
use crate::reference::{Found, Reference};
use crate::run::{BUDGET, each_seed, figures, finished, steps};
use crate::scene::{self, Kind};

/// Steps times unknowns of a run that is kept.
const WORK: f64 = 3e6;
/// The same of a reference.
const REFERENCE: f64 = 1.5e7;

/// Judges the run that a search chooses, with error over estimate of its quantities.
pub fn judge(case: &Case, asked: f64, found: &Found) -> (Verdict, Vec<f64>) {
    let mut record = |case: &Case, accuracy: &Accurate| {
        let system = System::new(case)?;
        companion::measured(case, system, accuracy, &mut steps((WORK / guess(case)) as u64))
    };
    let outcome = match target::reach(case, asked, None, &mut record) {
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
        Found::Known(reference) => kept(case, &run, asked, reference),
    }
}

fn kept(case: &Case, run: &Summary, asked: f64, reference: &Reference) -> (Verdict, Vec<f64>) {
    let Some(accuracy) = &run.accuracy else {
        return (Verdict::new(Word::Warned, "nothing is promised"), vec![]);
    };
    let reference = &beside_others(case, run, reference);
    let off = errors(&figures(run), reference, |_| true);
    let surely = off.iter().find(|one| one.beyond(asked));
    let Some(worst) = surely.or(off.first()) else {
        return (Verdict::new(Word::Unknown, "no figures"), vec![]);
    };
    let estimate = |quantity: &str| accuracy.quantities.get(quantity).and_then(|e| e.total);
    let told = format!(
        "{}; estimate {:.1e}, {} cells ({} in the reference), rtol {:.0e}, reached {}",
        worst.told(),
        estimate(&worst.quantity).unwrap_or(f64::NAN),
        accuracy.cells_per_segment,
        reference.cells,
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
        // two coarse meshes may point to a wrong limit; a finer run is not judged by it
        (true, true) if accuracy.cells_per_segment > reference.cells => Word::Unknown,
        (true, true) => Word::Silent,
        (true, false) => Word::Warned,
        (false, _) if unknown(&off, asked).is_some() => Word::Unknown,
        (false, _) => Word::Right,
    };
    (Verdict::new(word, told), ratios)
}

/// A reference with the sizes that an accuracy refers to.
fn beside_others(case: &Case, run: &Summary, reference: &Reference) -> Reference {
    let floors = RoundingScales::from_case(case).expect("a case that runs");
    let factors = error::factors_of_sizes(run, &floors, error::SMALL);
    let mut reference = reference.clone();
    for (name, size) in &mut reference.sizes {
        *size *= factors.get(name.as_str()).copied().unwrap_or(1.0);
    }
    reference
}

/// How often an accuracy of 1 % is reached, and how often that is true, in the scenes of seeds.
#[derive(Debug, Default)]
pub struct Tally {
    pub asked: usize,
    pub reached: usize,
    /// Seeds whose figures are wrong by more than 1 % all the same.
    pub broken: Vec<u64>,
}

/// Asks for 1 % in the scenes of seeds, two at a time.
pub fn run(kind: Kind, first: u64, count: u64) -> Tally {
    let (seeds, tally): (Vec<u64>, _) = ((first..first + count).collect(), Mutex::new(Tally::default()));
    each_seed(&seeds, |seed| one(kind, seed, &tally));
    tally.into_inner().expect("no thread panics")
}

fn one(kind: Kind, seed: u64, tally: &Mutex<Tally>) {
    const ASKED: f64 = 0.01;
    let scene = scene::draw(seed, kind);
    let (Ok(case), Some(found)) = (judge::read(&scene), judge::reference(&scene, KNOWN * ASKED, REFERENCE)) else {
        return;
    };
    let Found::Known(_) = &found else { return };
    let (verdict, _) = judge(&case, ASKED, &found);
    println!("{seed} {:?} {}", verdict.word, verdict.why);
    let mut tally = tally.lock().expect("no thread panics");
    match verdict.word {
        Word::Right | Word::Silent if verdict.why.contains("reached true") => tally.reached += 1,
        Word::Unknown => return,
        _ => {}
    }
    tally.asked += 1;
    if verdict.word == Word::Silent {
        tally.broken.push(seed);
    }
}
