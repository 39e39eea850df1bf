//! `--uncertain`: spread of the figures of a command due to uncertain numbers.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use serde::Serialize;
use serde_json::Value;

use super::arguments::{CaseArguments, UncertainArguments};
use super::sweep::progress::Counter;
use super::{interrupt, journal, resources, sweep, terminal};
use crate::case::{self, Case, inherited};
use crate::error::{Result, usage};
use crate::output::uncertainty as files;
use crate::output::{ResultFolder, report};
use crate::results::run::Bands;
use crate::results::uncertainty::Uncertainty;
use crate::run::summary::{CompanionRun, Status};
use crate::study::analysis::AnalysisOutcome;
use crate::study::analysis::{self, AnalysisKind, AnalysisRequest};
use crate::study::evaluations::Evaluations;
use crate::study::sweep::designs::pairs;
use crate::study::sweep::{VariedNumber, pool};
use crate::study::uncertain::{self, FirstOrderSlopes, SamplePlan};

/// Step of a difference, relative to the standard deviation.
const STEP: f64 = 0.1;

/// A request for uncertainty, with checked samples.
pub struct Uncertain {
    plan: SamplePlan,
    path: PathBuf,
    text: String,
    sets: Vec<String>,
    /// The case itself.
    own: Case,
    what: AnalysisKind,
    jobs: usize,
    quiet: bool,
    flag: Arc<AtomicBool>,
    evaluations: Evaluations,
}

impl UncertainArguments {
    /// Rejects uncertain numbers beside something that they cannot be combined with, with a message.
    ///
    /// # Errors
    /// A number is uncertain, and `beside` is true.
    pub fn refuse(&self, beside: bool, message: &str) -> Result<()> {
        match beside && !self.uncertain.is_empty() {
            true => usage(message),
            false => Ok(()),
        }
    }

    /// Checks every sample of a case before anything is computed; none if no number is uncertain.
    ///
    /// # Errors
    /// Contradictory arguments, or a sample that is not a valid case.
    pub fn begin(
        &self,
        CaseArguments { case: path, sets }: &CaseArguments,
        own: &Case,
        what: AnalysisKind,
        quiet: bool,
    ) -> Result<Option<Uncertain>> {
        if self.uncertain.is_empty() {
            return Ok(None);
        }
        if path == Path::new("-") {
            return usage("--uncertain: the case is read again for every sample; name its file in place of -");
        }
        let read = |text: &String| VariedNumber::parse_as("--uncertain", text);
        let inputs = self.uncertain.iter().map(read).collect::<Result<Vec<_>>>()?;
        let one = Uncertain {
            plan: SamplePlan::new(inputs, self.samples, self.seed, self.indices)?,
            jobs: sweep::jobs(self.jobs)?,
            text: case::text(path)?,
            path: path.clone(),
            sets: sets.clone(),
            own: own.clone(),
            what,
            quiet,
            flag: interrupt::flag(),
            evaluations: Evaluations::default(),
        };
        one.check()?;
        Ok(Some(one))
    }
}

impl Uncertain {
    /// Adds the effects with which a run was repeated to the samples.
    pub fn with_effects(&mut self, companion: &CompanionRun) {
        let added = companion.earlier_runs.iter().flat_map(|run| &run.added_effects);
        self.sets
            .extend(added.map(|effect| format!("/effects/{effect}=\"on\"")));
    }

    fn case(&self, own: Vec<String>) -> Result<Case> {
        let beside = self.path.parent().unwrap_or(Path::new(""));
        case::parse_varied(&self.text, &self.path, beside, &self.sets, &own)
            .map_err(|error| error.by("--uncertain", &own))
    }

    fn check(&self) -> Result<()> {
        let all: Vec<usize> = (0..self.plan.count()).collect();
        let look = |number: usize| {
            let case = self.case(self.plan.sets(number))?;
            resources::fits(&case, 0, self.jobs)?;
            self.what.analysis().check(&case)
        };
        let faults = sweep::faults(&all, self.jobs, &self.flag, &look, &mut |_| ())?;
        let Some((number, fault)) = faults.into_iter().next() else {
            return Ok(());
        };
        let values: Vec<Value> = self.plan.values(number).into_iter().map(Value::from).collect();
        terminal::print_line(&format!(
            "slcbeam: sample {number} of {} ({}) cannot be computed: the distribution extends beyond the range of the \
             model. No sample was started",
            all.len(),
            pairs(&self.plan.pointers(), &values)
        ));
        Err(fault)
    }

    fn stopped(&self) -> bool {
        interrupt::raised(&self.flag)
    }

    /// Figures of a case under its key, on request with the errors due to meshes; none if interrupted.
    fn found(&self, key: &impl Serialize, case: &Case, meshes: bool) -> Option<AnalysisOutcome> {
        let ask = AnalysisRequest {
            what: &self.what,
            accuracy: None,
            from: None,
            meshes,
            waves: meshes,
        };
        let stop = || self.stopped();
        let found = || analysis::found(case, ask, &stop, &|case| analysis::run(case, ask, &stop));
        analysis::stored(&self.evaluations, key, &stop, found)
    }

    /// Computes all samples; none if interrupted.
    ///
    /// # Errors
    /// The case itself cannot be computed.
    pub fn compute(&self) -> Result<Option<Uncertainty>> {
        let Some(own) = self.found(&"own", &self.own, true) else {
            return Ok(None);
        };
        let mut counter = Counter::new(self.quiet, "samples done", self.plan.count());
        let all: Vec<usize> = (0..self.plan.count()).collect();
        let mut samples: Vec<Option<AnalysisOutcome>> = vec![None; all.len()];
        let work = |number: usize| {
            if self.stopped() {
                return None;
            }
            let of = match self.case(self.plan.sets(number)) {
                Ok(case) => self.found(&number, &case, false)?,
                Err(error) => AnalysisOutcome::failed(&error),
            };
            Some((number, of))
        };
        pool::each(&all, self.jobs, &work, &mut |(number, found)| {
            counter.one(found.status != Status::Finished);
            samples[number] = Some(found);
            Ok(())
        })?;
        let Some(samples) = samples.into_iter().collect::<Option<Vec<_>>>() else {
            return Ok(None);
        };
        let resolved = serde_json::to_value(self.own.resolved()).unwrap_or_default();
        let own_values: Vec<Option<f64>> = self
            .plan
            .inputs()
            .iter()
            .map(|one| resolved.pointer(&one.pointer)?.as_f64())
            .collect();
        let mut judged = uncertain::judge(
            (&self.own.name, self.own.beam.length_m),
            self.what.word(),
            &self.plan,
            &own,
            &own_values,
            &samples,
            self.slopes(),
        );
        let pointers = self.plan.pointers();
        let shape = inherited::varied(&self.own, pointers.iter().map(String::as_str));
        judged.warnings.extend(shape);
        Ok(Some(judged))
    }

    /// Derivatives at the means; for cycles, which have no derivatives of their own, by differences of two cycles.
    fn slopes(&self) -> FirstOrderSlopes {
        let means = match self.case(self.plan.sets_at(|one| one[0])) {
            Ok(means) => means,
            Err(error) => return Err(format!("the case about the means: {error}")),
        };
        let difference = |number: usize| {
            let beside = |sign: f64| {
                let mut k = 0;
                let sets = self.plan.sets_at(|[mean, sd]| {
                    k += 1;
                    if k - 1 == number { mean + sign * STEP * sd } else { mean }
                });
                let found = self.found(&("beside", number, sign), &self.case(sets).ok()?, false)?;
                (found.status == Status::Finished).then_some(found)
            };
            let (above, below) = (beside(1.0)?, beside(-1.0)?);
            let step = 2.0 * STEP * self.plan.inputs()[number].values.moments()?[1];
            let slope = |(name, x): &(String, f64)| Some((name.clone(), (x - below.figure(name)?) / step));
            Some(above.figures.iter().filter_map(slope).collect())
        };
        let stop = || self.stopped();
        self.evaluations.get(&"slopes", &stop, || {
            uncertain::slopes(&means, &self.what, &self.plan.pointers(), &stop, &difference)
        })
    }
}

/// Computes the requested uncertainty, if any, with its journal in the folder of the result, if there is one.
///
/// # Errors
/// The case itself cannot be computed; the journal cannot be read.
pub fn compute(asked: Option<&Uncertain>, folder: Option<&ResultFolder>) -> Result<Option<Uncertainty>> {
    let Some(asked) = asked else {
        return Ok(None);
    };
    let Uncertain { plan, text, sets, .. } = asked;
    let settings = format!("{} {plan:?} {sets:?} {text}", asked.what.word());
    if let Some(folder) = folder {
        journal::begin(&asked.evaluations, folder, ("--uncertain", &asked.own, &settings))?;
    }
    let found = asked.compute()?;
    if let Some(folder) = folder {
        journal::end(&asked.evaluations, folder, found.is_none(), Ok(()))?;
    }
    if found.is_none() {
        terminal::print_line("slcbeam: interrupted; no uncertainty was computed");
    }
    Ok(found)
}

/// Writes an uncertainty, if there is one, and the files that contain its bands.
///
/// # Errors
/// A file cannot be written.
pub fn write(
    found: Option<&Uncertainty>,
    folder: &ResultFolder,
    with_bands: &[(&str, &dyn Fn() -> String)],
) -> Result<()> {
    let Some(found) = found else { return Ok(()) };
    files::write(folder, found)?;
    let mut all = with_bands.iter();
    all.try_for_each(|(name, text)| folder.write(name, text().as_bytes()).map(|_| ()))
}

/// Writes what [`write`] does, and the page, after the files of a result were written.
///
/// # Errors
/// That of `written`; a file cannot be written.
pub fn complete(
    found: Option<&Uncertainty>,
    (folder, case): (&ResultFolder, &Case),
    written: Result<()>,
    with_bands: &[(&str, &dyn Fn() -> String)],
) -> Result<()> {
    written
        .and(write(found, folder, with_bands))
        .and(report::complete(folder, case))
}

/// Bands for the result of the command itself.
pub fn bands(found: Option<&Uncertainty>) -> Bands {
    found.map_or_else(Bands::new, Uncertainty::bands)
}

/// Text about the uncertainty, below that of a command.
pub fn below(found: Option<&Uncertainty>) -> String {
    found.map_or(String::new(), |found| format!("\n{}", files::describe(found)))
}
