//! Ablation: runs the full model, the full model at a tenth of the tolerance, the model without each effect, and the
//! automatic choice.

use serde::{Deserialize, Serialize};

use super::choices::{OmissionKind, candidates, effects, guards, whole, with, without};
use super::figure_change::{Changes, ComparedFigures, ModelMeasure, Reference, Size, judge, largest};
use super::recommend::{Recommendation, recommend};
use super::trial::{ModelTrial, Runs, TrialPlan, TrialWatch};
use crate::case::Case;
use crate::case::schema::{Effect, Effects};
use crate::error::{Error, Result};
use crate::run::json_null;
use crate::study::evaluations::Evaluations;
use crate::study::significant::RoundingScales;

/// Tightest tolerance that is allowed.
const TIGHTEST: f64 = 1e-13;
/// Error of the full model above which the integrator cannot follow its motion.
const LOST: f64 = 0.3;
/// Least relative saving of work, or of time, that justifies leaving an effect out.
pub const WORTH: f64 = 0.05;

/// Name of the measure that is, for each effect, the quantity with the largest change.
pub const LARGEST: &str = "largest";

/// Verdict on an effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum EffectVerdict {
    /// Without it, results change by more than the tolerance.
    Needed,
    /// Without it, results change by less than the tolerance, and nothing is saved.
    Harmless,
    /// Without it, results change by less than the tolerance, and work or time is saved.
    Saves,
    /// The change exceeds the tolerance, but not the integrator's own error.
    Undecided,
    /// The model without it could not be run to the end.
    Failed,
    /// It cannot be left out of this case.
    Kept,
    /// It is not in the full model.
    Absent,
}

/// Run compared with another run.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct ComparedRun {
    /// The run.
    pub trial: ModelTrial,
    /// Model with which it is compared.
    pub against: String,
    /// Relative change by quantity.
    #[serde(deserialize_with = "json_null::by_name")]
    pub changes: Changes,
    /// Name and change of the quantity that changes most.
    #[serde(deserialize_with = "json_null::named")]
    pub largest: Option<(String, f64)>,
    /// True if that change is above the integrator's own error.
    pub above_own_error: bool,
    /// Difference of the numbers of unknowns.
    pub unknowns: i64,
    /// Ratio of the work.
    #[serde(deserialize_with = "json_null::number")]
    pub work: f64,
    /// Ratio of the least wall times.
    #[serde(deserialize_with = "json_null::number")]
    pub wall: f64,
}

/// Row of the table: one effect.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct AblationRow {
    /// The effect.
    pub name: Effect,
    /// Verdict.
    pub verdict: EffectVerdict,
    /// Reason why it was not run, or did not finish.
    pub reason: Option<String>,
    /// True if `"auto"` keeps it.
    pub auto: bool,
    /// Criterion by which `"auto"` decides.
    pub number: String,
    /// Effects left out of both models that are compared.
    pub without: Vec<Effect>,
    /// Effects that have no meaning without it.
    pub takes: Vec<Effect>,
    /// Comparison of the model without it.
    pub left_out: Option<ComparedRun>,
}

/// Result of an ablation: the influence of each effect on a case.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Ablation {
    /// Name of the case.
    pub case: String,
    /// Requested repeats and budget.
    pub plan: TrialPlan,
    /// The case's `effects_tolerance`.
    pub tolerance: f64,
    /// Relative tolerance of the integrator.
    pub rtol: f64,
    /// Figures that are compared: only those over the window if the motion cannot be followed.
    pub judged_by: ComparedFigures,
    /// Quantities of the full model.
    pub measures: Vec<ModelMeasure>,
    /// The full model.
    pub full: ModelTrial,
    /// The full model at a tenth of the tolerance.
    pub tighter: ModelTrial,
    /// Rows of the table, one per effect.
    pub rows: Vec<AblationRow>,
    /// The automatic choice.
    pub auto: Option<ComparedRun>,
    /// The choices that the case sets by name, if any.
    pub given: Option<ComparedRun>,
    /// Recommended choices.
    pub recommendation: Option<Recommendation>,
    /// Wall time of everything [s].
    pub spent_s: f64,
}

/// Criteria of comparisons, from the full model.
pub struct Criteria {
    reference: Reference,
    measures: Vec<ModelMeasure>,
    tolerance: f64,
    timed: bool,
}

impl Criteria {
    /// Compares the run `other` with the run `base`; `None` if only the latter did not finish.
    pub fn compare(&self, runs: &Runs, base: usize, other: usize) -> Option<ComparedRun> {
        let (base, trial) = (runs.trial(base), runs.trial(other));
        let changes = match &trial.summary {
            Some(summary) => self.reference.changes(base.summary.as_ref()?, summary),
            None => Changes::new(),
        };
        let most = largest(&changes, &self.measures, self.tolerance).filter(|_| trial.summary.is_some());
        Some(ComparedRun {
            trial: trial.clone(),
            against: base.what.clone(),
            changes,
            above_own_error: most.is_some_and(|(m, change)| change > m.own.unwrap_or(0.0)),
            largest: most.map(|(m, change)| (m.name.clone(), change)),
            unknowns: trial.unknowns as i64 - base.unknowns as i64,
            work: trial.work / base.work,
            wall: trial.wall_s() / base.wall_s(),
        })
    }

    /// Verdict of a comparison; `scatter` is the relative scatter of the wall times of `base`.
    pub fn verdict(&self, compared: &ComparedRun, scatter: f64) -> EffectVerdict {
        if compared.trial.summary.is_none() {
            return EffectVerdict::Failed;
        }
        match judge(&compared.changes, &self.measures, self.tolerance) {
            Size::Large => EffectVerdict::Needed,
            Size::Hidden => EffectVerdict::Undecided,
            Size::Small => {
                let timed = self.timed && compared.trial.repeats > 1;
                let clear = WORTH + scatter.max(compared.trial.scatter());
                let (faster, slower) = (
                    timed && compared.wall < 1.0 - clear,
                    timed && compared.wall > 1.0 + clear,
                );
                if faster || compared.work < 1.0 - WORTH && !slower {
                    EffectVerdict::Saves
                } else {
                    EffectVerdict::Harmless
                }
            }
        }
    }
}

/// Runs the full model, the model without each effect, the automatic choice and the recommended choices. Runs stored in
/// `evaluations` are not repeated.
///
/// # Errors
/// [`Error::Usage`] for a measure that the full model lacks.
pub fn ablate(
    case: &Case,
    plan: TrialPlan,
    measure: Option<&str>,
    evaluations: &Evaluations,
    watch: TrialWatch,
) -> Result<Ablation> {
    let auto_case = with(case, Effects::Auto);
    let decided = effects(&auto_case)?;
    let mut found = Ablation {
        case: case.name.clone(),
        plan,
        tolerance: case.effects_tolerance(),
        rtol: case.solver.rtol,
        judged_by: ComparedFigures::Figures,
        measures: vec![],
        full: ModelTrial::skipped("full"),
        tighter: ModelTrial::skipped("full, a tenth of the tolerance"),
        rows: vec![],
        auto: None,
        given: None,
        recommendation: None,
        spent_s: 0.0,
    };
    let all = candidates(case)?;
    let mut runs = Runs::new(plan, evaluations, watch);
    let full_case = whole(case)?;
    let full = runs.run("full", full_case.clone())?;
    found.full = runs.trial(full).clone();
    let row = |name: Effect, out: &OmissionKind| AblationRow {
        name,
        verdict: EffectVerdict::Failed,
        reason: None,
        auto: decided.has(name),
        number: decided.decision(name).cause.to_string(),
        without: out.without.clone(),
        takes: out.takes.clone(),
        left_out: None,
    };
    let Some(summary) = &found.full.summary else {
        found.spent_s = runs.spent_s();
        return Ok(found);
    };
    let floors = RoundingScales::from_case(case)?;
    known(measure, &Reference::new(summary, &floors).measures(None))?;
    let mut tight_case = full_case;
    tight_case.solver.rtol = (0.1 * tight_case.solver.rtol).max(TIGHTEST);
    let tighter = runs.run("full, a tenth of the tolerance", tight_case)?;
    let mut pairs = vec![];
    for candidate in &all {
        let mut run = |off: &[Effect]| runs.run(&format!("without {}", Effect::names(off, ", ")), without(case, off)?);
        pairs.push(match &candidate.out {
            Ok(out) => {
                let base = match out.without.as_slice() {
                    [] => full,
                    others => run(others)?,
                };
                let off = [out.without.as_slice(), &[candidate.effect]].concat();
                Some((base, run(&off)?))
            }
            Err(_) => None,
        });
    }
    let auto = runs.run("auto", auto_case)?;
    let given = match case.effects {
        Effects::Chosen(_) => Some(runs.run("as in the case", case.clone())?),
        _ => None,
    };
    runs.repeat();
    found.full = runs.trial(full).clone();
    found.tighter = runs.trial(tighter).clone();
    let Some(judge) = judged(&mut found, plan, &floors) else {
        return Ok(found);
    };

    for (candidate, pair) in all.iter().zip(pairs) {
        found.rows.push(match (&candidate.out, pair) {
            (Ok(out), Some((base, other))) => {
                let left_out = judge.compare(&runs, base, other);
                let failed = runs
                    .trial(other)
                    .reason
                    .clone()
                    .or_else(|| runs.trial(base).reason.clone());
                let verdict = left_out.as_ref().map(|c| judge.verdict(c, runs.trial(base).scatter()));
                AblationRow {
                    verdict: verdict.unwrap_or(EffectVerdict::Failed),
                    reason: failed,
                    left_out,
                    ..row(candidate.effect, out)
                }
            }
            (out, _) => {
                let kept = out.as_ref().err();
                let there = kept.is_some_and(|k| k.there);
                AblationRow {
                    verdict: if there {
                        EffectVerdict::Kept
                    } else {
                        EffectVerdict::Absent
                    },
                    reason: kept.map(|k| k.why.clone()),
                    ..row(candidate.effect, &OmissionKind::default())
                }
            }
        });
    }
    let guard = guards(case, &decided)?;
    found.recommendation = Some(recommend(case, &found.rows, guard.as_ref(), &judge, &mut runs)?);
    found.auto = judge.compare(&runs, full, auto);
    found.given = given.and_then(|given| judge.compare(&runs, full, given));
    found.spent_s = runs.spent_s();
    Ok(found)
}

/// Rejects an unknown measure.
fn known(measure: Option<&str>, measures: &[ModelMeasure]) -> Result<()> {
    let Some(name) = measure else { return Ok(()) };
    let names: Vec<&str> = [LARGEST]
        .into_iter()
        .chain(measures.iter().map(|m| m.name.as_str()))
        .collect();
    if names.contains(&name) {
        return Ok(());
    }
    Err(Error::Usage(format!(
        "--measure {name}: unknown measure. Use one of {}",
        names.join(", ")
    )))
}

/// Returns the criteria of comparisons: every figure, or only those over the window if the integrator cannot follow the
/// motion.
fn judged(found: &mut Ablation, plan: TrialPlan, floors: &RoundingScales) -> Option<Criteria> {
    let full = found.full.summary.as_ref()?;
    let mut reference = Reference::new(full, floors);
    let own = |reference: &Reference| Some(reference.changes(full, found.tighter.summary.as_ref()?));
    let lost = own(&reference).is_some_and(|own| own.values().any(|error| *error > LOST));
    if lost {
        reference.judged_by = ComparedFigures::WindowStatistics;
    }
    found.judged_by = reference.judged_by;
    found.measures = reference.measures(own(&reference).as_ref());
    Some(Criteria {
        measures: found.measures.clone(),
        reference,
        tolerance: found.tolerance,
        timed: plan.repeats > 0,
    })
}
