//! What becomes of a scene.

use std::path::Path;

use serde_json::Value;
use slcbeam::case::{self, Case};
use slcbeam::discrete::System;
use slcbeam::error::{Code, Error};
use slcbeam::run::summary::Summary;

use crate::promise;
use crate::reference::{self, FAILED, Found, Reference};
use crate::run::{Figures, Work, figures, finished};
use crate::trust::{self, Cause};

/// How a scene ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Word {
    /// Within what was promised.
    Right,
    /// Off, and said so.
    Warned,
    /// The run ended early and said why.
    Ended,
    /// Off, and not a word beside it.
    Silent,
    /// The reference is not known well enough.
    Unknown,
    /// Refused by the check of the case.
    Refused,
    /// Not asked for.
    Skipped,
}

/// A verdict on a scene's run with the settings of the program.
#[derive(Clone, Debug)]
pub struct Verdict {
    /// In one word.
    pub word: Word,
    /// Why, with the worst figure.
    pub why: String,
    /// Causes of an error.
    pub causes: Vec<Cause>,
    /// A warning of trust, while every figure is right to 1 %.
    pub needless: Option<Vec<Code>>,
}

impl Verdict {
    pub fn new(word: Word, why: impl Into<String>) -> Self {
        Self {
            word,
            why: why.into(),
            causes: vec![],
            needless: None,
        }
    }
}

/// Off by more than this at default settings, relative to the figure.
pub const DEFAULT: f64 = 0.05;
/// A reference is known when its error is below this part of what is judged by it.
pub const KNOWN: f64 = 0.2;
/// Right to this, a warning was needless.
pub const NEEDLESS: f64 = 0.01;
/// Steps times unknowns times stages for one scene: with the default settings, and for the reference.
const WORK: [f64; 2] = [2e6, 1.5e7];

/// Reads a scene.
pub fn read(scene: &Value) -> Result<Case, String> {
    let words = |error| match error {
        Error::Case(fault) => {
            let first = fault.violations.first();
            first.map_or(String::new(), |v| format!("{}: {}", v.pointer, v.what))
        }
        other => other.to_string(),
    };
    let case = case::parse(&scene.to_string(), Path::new("scene.json"), Path::new("."), &[]).map_err(words)?;
    System::new(&case).map_err(words)?;
    Ok(case)
}

/// The two verdicts on a scene.
pub struct Both {
    /// On the default settings.
    pub default: Verdict,
    /// On an accuracy asked for.
    pub promise: Verdict,
    /// What was asked for.
    pub asked: f64,
    /// Error over estimate of every quantity whose error is known.
    pub ratios: Vec<f64>,
}

impl Both {
    fn alike(verdict: Verdict, asked: f64, parts: [bool; 2]) -> Self {
        let [default, promise] = parts.map(|asked| if asked { verdict.clone() } else { skipped() });
        Self {
            default,
            promise,
            asked,
            ratios: vec![],
        }
    }
}

fn skipped() -> Verdict {
    Verdict::new(Word::Skipped, "")
}

/// Judges a scene with the default settings, and with an accuracy.
pub fn judge(scene: &Value, asked: f64, parts: [bool; 2], close: f64) -> Both {
    match (read(scene), reference(scene, close, WORK[1])) {
        (Ok(case), Some(found)) => against(&case, &found, asked, parts),
        (read, _) => Both::alike(
            Verdict::new(Word::Refused, read.err().unwrap_or_default()),
            asked,
            parts,
        ),
    }
}

/// The reference of a scene, unless that is refused, to `close` if so much work suffices.
pub fn reference(scene: &Value, close: f64, work: f64) -> Option<Found> {
    let case = read(scene).ok()?;
    let cells = case.mesh.cells_per_segment;
    let unknowns = guess(&case) * 4.0 / cells as f64;
    let mut work = Work { left: work };
    Some(reference::find(&case, scene, 2 * cells, unknowns, close, &mut work))
}

/// Judges a case against a reference.
pub fn against(case: &Case, found: &Found, asked: f64, parts: [bool; 2]) -> Both {
    // Where runs of the reference fail the program's may say so too, and then nothing is wrong.
    if let Found::Unknown(why) = found
        && !why.starts_with(FAILED)
    {
        return Both::alike(Verdict::new(Word::Unknown, why.as_str()), asked, parts);
    }
    let default = if parts[0] { default(case, found) } else { skipped() };
    let (promise, ratios) = if parts[1] {
        promise::judge(case, asked, found)
    } else {
        (skipped(), vec![])
    };
    Both {
        default,
        promise,
        asked,
        ratios,
    }
}

fn default(case: &Case, found: &Found) -> Verdict {
    let mut work = Work { left: WORK[0] };
    let Some(run) = work.run_with_errors(case, guess(case)) else {
        return Verdict::new(Word::Unknown, "too long at default settings");
    };
    match found {
        _ if !finished(&run) => Verdict::new(Word::Ended, run.reason.unwrap_or_default()),
        Found::Unknown(why) => Verdict::new(Word::Unknown, why.as_str()),
        Found::Ends(why) => should_end(&run, why),
        Found::Known(reference) => compare(case, &run, reference),
    }
}

/// A run that reached its end where all others stop.
pub fn should_end(run: &Summary, why: &str) -> Verdict {
    let warned = trust::warned(&run.warnings);
    let word = if warned.is_empty() { Word::Silent } else { Word::Warned };
    Verdict::new(word, format!("finished {warned:?}, where it should end: {why}"))
}

/// Number of unknowns with everything that may be chosen.
pub fn guess(case: &Case) -> f64 {
    System::new(case).unwrap().layout.len as f64
}

fn compare(case: &Case, run: &Summary, reference: &Reference) -> Verdict {
    let warned = trust::warned(&run.warnings);
    let off = errors(&figures(run), reference, |_| true);
    let Some(worst) = off.first() else {
        return Verdict::new(Word::Unknown, "no figures");
    };
    let mut excused = None;
    for one in off.iter().filter(|one| one.beyond(DEFAULT)) {
        // Causes take runs: those of the worst figure are taken for the others, unless they excuse too little.
        let told_of = |causes: &[Cause]| {
            let names = |w: &String| trust::names(w, causes, &one.quantity);
            run.warnings.iter().any(names)
        };
        if excused
            .as_ref()
            .is_some_and(|(causes, _): &(Vec<Cause>, _)| told_of(causes))
        {
            continue;
        }
        let causes = causes(case, reference, one);
        let why = format!("{}; {causes:?}; warned {warned:?}", one.told());
        if !told_of(&causes) {
            return Verdict {
                causes,
                ..Verdict::new(Word::Silent, why)
            };
        }
        excused = excused.or(Some((causes, why)));
    }
    if let Some((causes, why)) = excused {
        return Verdict {
            causes,
            ..Verdict::new(Word::Warned, why)
        };
    }
    if let Some(doubt) = unknown(&off, DEFAULT) {
        return Verdict::new(Word::Unknown, format!("reference known to {doubt:.1e} only"));
    }
    let right = off.iter().all(|one| one.error + one.doubt <= NEEDLESS);
    Verdict {
        needless: (right && !warned.is_empty()).then_some(warned),
        ..Verdict::new(Word::Right, worst.told())
    }
}

/// How well a reference is known that is not known well enough: more than a quarter of its figures to less than a fifth of
/// what is allowed. Others are judged by the rest.
pub fn unknown(off: &[Off], allowed: f64) -> Option<f64> {
    let mut doubts: Vec<f64> = off.iter().map(|one| one.doubt).collect();
    doubts.sort_by(f64::total_cmp);
    let most = *doubts.get(3 * doubts.len() / 4)?;
    (most > KNOWN * allowed).then_some(most)
}

/// An error of a figure.
pub struct Off {
    pub quantity: String,
    pub figure: String,
    pub value: f64,
    pub reference: f64,
    /// Relative to the quantity.
    pub error: f64,
    /// The reference's own.
    pub doubt: f64,
}

impl Off {
    /// Surely off by more than this.
    pub fn beyond(&self, allowed: f64) -> bool {
        self.doubt <= KNOWN * allowed.max(0.5 * self.error) && self.error > allowed + self.doubt
    }

    pub fn told(&self) -> String {
        format!(
            "{}/{} {:.4e} for {:.4e}, off by {:.2e} (reference known to {:.0e})",
            self.quantity, self.figure, self.value, self.reference, self.error, self.doubt
        )
    }
}

/// Errors of all figures that count, worst first: those that are surely large before those that may be. Negligible quantities have none.
pub fn errors(figures: &Figures, reference: &Reference, counts: impl Fn(&str) -> bool) -> Vec<Off> {
    let mut all = vec![];
    for (quantity, known) in &reference.figures {
        let (size, negligible) = (reference.sizes[quantity], reference.is_negligible(quantity, figures));
        for (figure, &(value, error)) in known.iter().filter(|(figure, _)| counts(figure)) {
            let got = figures.get(quantity).and_then(|q| q.get(figure.as_str())).copied();
            let Some(got) = got else { continue };
            all.push(Off {
                quantity: quantity.clone(),
                figure: figure.clone(),
                value: got,
                reference: value,
                error: if negligible { 0.0 } else { (got - value).abs() / size },
                doubt: error / size,
            });
        }
    }
    all.sort_by(|a, b| (b.error - 3.0 * b.doubt).total_cmp(&(a.error - 3.0 * a.doubt)));
    all
}

/// Where an error comes from: the change that alone takes most of it away; where none does, all without which it comes back.
fn causes(case: &Case, reference: &Reference, worst: &Off) -> Vec<Cause> {
    let all = [Cause::Space, Cause::Effects, Cause::Time, Cause::Outputs];
    let error = |changes: &[Cause]| {
        let mut better = case.clone();
        for change in changes {
            mend(&mut better, *change, reference.cells / 2);
        }
        let mut work = Work { left: WORK[0] };
        let run = work.run(&better, guess(&better)).filter(finished)?;
        let now = errors(&figures(&run), reference, |figure| figure == worst.figure);
        now.iter()
            .find(|off| off.quantity == worst.quantity)
            .map(|off| off.error)
    };
    let mends = |cause: &&Cause| error(&[**cause]).is_some_and(|e| e < 0.4 * worst.error);
    if let Some(alone) = all.iter().find(mends) {
        return vec![*alone];
    }
    let others = |cause: Cause| all.iter().copied().filter(|c| *c != cause).collect::<Vec<_>>();
    let needs = |cause: &Cause| error(&others(*cause)).is_some_and(|e| e > 0.3 * worst.error);
    let needed: Vec<Cause> = all.iter().copied().filter(needs).collect();
    if needed.is_empty() { vec![Cause::Joint] } else { needed }
}

fn mend(case: &mut Case, cause: Cause, cells: usize) {
    match cause {
        Cause::Effects => case.effects = slcbeam::case::schema::Effects::Full,
        Cause::Time => case.solver.rtol = 1e-7,
        Cause::Space => *case = slcbeam::study::accuracy::plan::refined(case, cells, case.solver.rtol),
        Cause::Outputs | Cause::Joint => crate::run::sampled(case),
    }
}
