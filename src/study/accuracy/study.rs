//! Accuracy study of a case: runs, errors, Pareto front, notes.

use serde::{Deserialize, Serialize};

use super::errors::{self, BETTER, SignalErrors};
use super::norms::Norms;
use super::pareto_front::{self, CheapestPoint, CostMark, CostMinimum, ErrorBalance};
use super::plan::StudyPlan;
use super::reference::{self, BestOnMesh, MeshLimit};
use super::scheme::Scheme;
use super::signals::{self, ComparedSignal, SignalKind};
use super::sweep::{self, StudyWatch};
use super::trial::{RunPurpose, StudyTrial};
use crate::case::units::suffixed;
use crate::case::{Case, Rotation, Translation};
use crate::discrete::quantities::Observable;
use crate::error::numbers::counted;
use crate::error::{Error, Result};
use crate::study::evaluations::Evaluations;

/// Accuracies for which the cheapest point is searched.
const ACCURACIES: [f64; 4] = [1e-1, 1e-2, 1e-3, 1e-4];
/// Signals below this share of the largest one of their unit are rounding errors.
const NOTHING: f64 = 1e-6;

/// A run with its errors.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct StudyPoint {
    /// The run.
    pub trial: StudyTrial,
    /// Errors in every measure; finished runs only.
    pub errors: Option<Vec<SignalErrors>>,
    /// True if no other point is both more accurate and cheaper, in the headline measure.
    pub on_front: bool,
}

/// The balance of temporal and spatial error on one line.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct LineBalance {
    /// Beam cells per segment.
    pub cells: usize,
    /// Time integration.
    pub scheme: Scheme,
    /// Tolerance, error and cost at the balance.
    pub at: ErrorBalance,
}

/// Result of a study.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Study {
    /// Name of the case.
    pub case: String,
    /// Requested settings.
    pub plan: StudyPlan,
    /// Total cost, in the unit of the budget.
    pub spent: f64,
    /// Measures, each in the limit of vanishing mesh size.
    pub measures: Vec<MeshLimit>,
    /// Signals that are not measured: prescribed, not in all runs, or rounding errors only.
    pub left_out: Vec<String>,
    /// Index of the measure shown by picture, table and sentence, in the maximum norm.
    pub headline: usize,
    /// The best run on each mesh.
    pub references: Vec<BestOnMesh>,
    /// All runs, references included.
    pub points: Vec<StudyPoint>,
    /// Points of the Pareto front, by falling error.
    pub front: Vec<usize>,
    /// Cheapest points for errors of 10 %, 1 %, 0.1 %, 0.01 %.
    pub answers: Vec<CheapestPoint>,
    /// Cost minima of lines on which looser tolerances cost more.
    pub feet: Vec<CostMinimum>,
    /// Points at which temporal and spatial error are equal.
    pub balances: Vec<LineBalance>,
    /// Notes on the reliability of these numbers.
    pub notes: Vec<String>,
}

impl Study {
    /// Returns the headline measure.
    pub fn measure(&self) -> Option<&MeshLimit> {
        self.measures.get(self.headline)
    }

    /// Returns the errors of a point in the headline measure.
    pub fn error(&self, point: usize) -> Option<&SignalErrors> {
        self.points.get(point)?.errors.as_ref()?.get(self.headline)
    }

    /// Returns the finished points of a line, loose to tight, without references.
    pub fn line(&self, cells: usize, scheme: Scheme) -> Vec<usize> {
        let mut line: Vec<usize> = (0..self.points.len())
            .filter(|&k| {
                let trial = &self.points[k].trial;
                trial.role == RunPurpose::Point && trial.finished() && trial.line() == (cells, scheme)
            })
            .collect();
        line.sort_by(|&a, &b| {
            self.points[b]
                .trial
                .setting
                .rtol
                .total_cmp(&self.points[a].trial.setting.rtol)
        });
        line
    }
}

/// Studies a case; `measure` names the headline measure, by default the tip deflection. Runs stored in `evaluations` are not repeated.
pub fn study(
    case: &Case,
    plan: StudyPlan,
    measure: Option<&str>,
    evaluations: &Evaluations,
    watch: StudyWatch,
) -> Result<Study> {
    if let Some(name) = measure.filter(|name| !signals::possible(name)) {
        return Err(Error::Usage(format!(
            "--measure {name}: unknown measure. Use one of {}, or a figure such as tip_u1_m.max_abs",
            signals::names()
        )));
    }
    let (mut trials, spent) = sweep::sweep(case, &plan, evaluations, watch)?;
    let (left_out, sizes) = agree(&mut trials, &prescribed(case));
    let names: Vec<String> = best(&trials)
        .iter()
        .flat_map(|s| s.iter().map(|s| s.name.clone()))
        .collect();
    let headline = headline(&names, measure)?;
    let mut schemes: Vec<Scheme> = plan.schemes.iter().copied().chain(plan.reference_schemes()).collect();
    schemes.sort_unstable();
    schemes.dedup();
    let references: Vec<BestOnMesh> = plan
        .reference_cells()
        .into_iter()
        .filter_map(|k| reference::temporal(&trials, k, &schemes, &sizes, headline))
        .collect();
    // The mesh beyond the finest improves the limit only if its temporal error is small enough.
    let without = references
        .iter()
        .filter(|r| plan.cells.contains(&r.cells))
        .cloned()
        .collect::<Vec<_>>();
    let limit = |(k, signal): (usize, &ComparedSignal)| {
        let limits = [&references, &without].map(|meshes| reference::limit(meshes, signal, k, sizes[k]));
        limits
            .into_iter()
            .flatten()
            .min_by(|a, b| a.own().max.total_cmp(&b.own().max))
    };
    let measures: Vec<MeshLimit> = best(&trials)
        .iter()
        .flat_map(|signals| signals.iter().enumerate())
        .filter_map(limit)
        .collect();
    trials.sort_by(|a, b| {
        let key = |t: &StudyTrial| (t.role == RunPurpose::Reference, t.line());
        key(a).cmp(&key(b)).then(b.setting.rtol.total_cmp(&a.setting.rtol))
    });
    let points = trials
        .into_iter()
        .map(|trial| StudyPoint {
            errors: errors::errors(&trial, &references, &measures),
            trial,
            on_front: false,
        })
        .collect();
    let mut study = Study {
        case: case.name.clone(),
        plan,
        spent,
        measures,
        left_out,
        headline,
        references,
        points,
        front: vec![],
        answers: vec![],
        feet: vec![],
        balances: vec![],
        notes: vec![],
    };
    conclude(&mut study);
    study.notes = notes(&study);
    Ok(study)
}

/// Signals of the finished run with the finest mesh and, on that mesh, the tightest tolerance.
fn best(trials: &[StudyTrial]) -> Option<&Vec<ComparedSignal>> {
    let finest = trials.iter().filter(|t| t.finished()).max_by(|a, b| {
        a.setting
            .cells
            .cmp(&b.setting.cells)
            .then(b.setting.rtol.total_cmp(&a.setting.rtol))
    });
    finest.and_then(|t| t.signals.as_ref())
}

/// Names of the signals that a driven or held tip prescribes: they have no error in any setting.
fn prescribed(case: &Case) -> Vec<&'static str> {
    let tip = case.ends.tip.resolve();
    let moved = |direction: &Translation| matches!(direction, Translation::Displacement(_));
    let all = [
        (moved(&tip.transverse), Observable::TipU1),
        (moved(&tip.axial), Observable::TipU3),
        (matches!(tip.rotation, Rotation::Slope(_)), Observable::TipAngle),
    ];
    let names = all.into_iter().filter(|(given, _)| *given).map(|(_, one)| one.name());
    names.collect()
}

/// Retains the signals that all finished runs have, that are not prescribed and that exceed rounding errors, in the same order in all runs.
/// Returns the names of the others, and the sizes of those retained.
fn agree(trials: &mut [StudyTrial], prescribed: &[&str]) -> (Vec<String>, Vec<Norms>) {
    let Some(best) = best(trials) else {
        return (vec![], vec![]);
    };
    let size = |s: &ComparedSignal| {
        s.scale
            .map_or_else(|| Norms::from_values(s.values.iter().copied()), Norms::both)
    };
    let largest = |unit: &str| {
        let alike = best.iter().filter(|s| s.unit == unit && s.kind != SignalKind::Quantity);
        alike.map(|s| size(s).max).fold(0.0, f64::max)
    };
    let everywhere = |signal: &ComparedSignal| {
        let same = |s: &ComparedSignal| {
            s.name == signal.name && s.kind == signal.kind && s.values.len() == signal.values.len()
        };
        trials
            .iter()
            .filter_map(|t| t.signals.as_ref())
            .all(|signals| signals.iter().any(same))
    };
    let counts = |s: &&ComparedSignal| {
        let size = size(s).max;
        // a figure of a quantity is named `tip_u3_m.max_abs`
        let name = s
            .name
            .split('.')
            .next()
            .map_or("", |name| suffixed(name).map_or(name, |(plain, _)| plain));
        !prescribed.contains(&name) && size > 0.0 && size >= NOTHING * largest(&s.unit) && everywhere(s)
    };
    let (kept, others): (Vec<&ComparedSignal>, Vec<&ComparedSignal>) = best.iter().partition(counts);
    let left_out = others.iter().map(|s| s.name.clone()).collect();
    let sizes = kept.iter().map(|s| size(s)).collect();
    let kept: Vec<(String, SignalKind)> = kept.iter().map(|s| (s.name.clone(), s.kind)).collect();
    for signals in trials.iter_mut().filter_map(|t| t.signals.as_mut()) {
        let find =
            |(name, kind): &(String, SignalKind)| signals.iter().find(|s| s.name == *name && s.kind == *kind).cloned();
        *signals = kept.iter().filter_map(find).collect();
    }
    (left_out, sizes)
}

fn headline(names: &[String], wanted: Option<&str>) -> Result<usize> {
    let at = |name: &str| names.iter().position(|n| n == name);
    match wanted {
        Some(name) if !names.is_empty() => at(name).ok_or_else(|| {
            Error::Usage(format!(
                "--measure {name}: not a measure of this case. It has {}",
                names.join(", ")
            ))
        }),
        _ => Ok(at(Observable::TipU1.name())
            .or_else(|| at(Observable::TipU3.name()))
            .unwrap_or(0)),
    }
}

fn conclude(study: &mut Study) {
    let all = 0..study.points.len();
    let none = CostMark {
        error: f64::INFINITY,
        cost: f64::INFINITY,
    };
    let marks = |error: fn(&SignalErrors) -> f64| -> Vec<CostMark> {
        let mark = |k: usize| match study.error(k) {
            Some(errors) if study.points[k].trial.role == RunPurpose::Point => CostMark {
                error: error(errors),
                cost: study.points[k].trial.wall_min_s,
            },
            _ => none,
        };
        (0..study.points.len()).map(mark).collect()
    };
    let (totals, bounds) = (marks(|e| e.total.max), marks(|e| e.bound.max));
    let (of_totals, of_bounds) = (pareto_front::front(&totals), pareto_front::front(&bounds));
    study.answers = pareto_front::answers(&bounds, &of_bounds, &ACCURACIES);
    // exclude a setting that misses the loosest accuracy, however cheap it is
    study.front = of_totals;
    study.front.retain(|&k| totals[k].error <= ACCURACIES[0]);
    let cost: Vec<f64> = all.clone().map(|k| study.points[k].trial.wall_min_s).collect();
    let work: Vec<f64> = all
        .map(|k| study.points[k].trial.counters.residual_evaluations as f64)
        .collect();
    let lines = || {
        study
            .plan
            .cells
            .iter()
            .flat_map(|&c| study.plan.schemes.iter().map(move |&o| (c, o)))
    };
    study.feet = lines()
        .filter_map(|(c, o)| pareto_front::cost_minimum(&study.line(c, o), &cost, &work))
        .collect();
    study.balances = lines()
        .filter_map(|(cells, scheme)| {
            let line = study.line(cells, scheme);
            let along = line.iter().filter_map(|&k| {
                let errors = study.error(k)?;
                Some((
                    study.points[k].trial.setting.rtol,
                    errors.temporal?.max,
                    errors.total.max,
                    cost[k],
                ))
            });
            let spatial = study.error(*line.first()?)?.spatial?.max;
            let at = pareto_front::balance(&along.collect::<Vec<_>>(), spatial)?;
            Some(LineBalance { cells, scheme, at })
        })
        .collect();
    for &k in &study.front {
        study.points[k].on_front = true;
    }
}

fn notes(study: &Study) -> Vec<String> {
    let mut notes = vec![];
    let Some(measure) = study.measure() else {
        return vec!["no run finished: there is nothing to compare".into()];
    };
    let own = measure.own().max;
    let judged: Vec<bool> = (0..study.points.len())
        .filter(|&k| study.points[k].trial.role == RunPurpose::Point)
        .filter_map(|k| Some(study.error(k)?.judged))
        .collect();
    let unjudged = judged.iter().filter(|j| !**j).count();
    if unjudged > 0 {
        notes.push(format!(
            "not judged: {unjudged} of {}: the reference is not {BETTER} times more accurate than they are (its own \
             relative error in {} is {own:.1e}). Improve it by a larger --budget, tighter --rtol and more --cells",
            counted(judged.len() as u64, "point"),
            measure.name
        ));
    }
    let known = |cells: &usize| study.references.iter().any(|r| r.cells == *cells);
    if !study.plan.cells.iter().all(known) {
        notes.push("some meshes have no finished run. The comparison omits them".into());
    }
    if study.references.len() == 1 {
        notes.push(
            "only one mesh: errors include the time integration, but not the mesh. Give at least two numbers to \
             --cells"
                .into(),
        );
    }
    if study.references.len() > 1 && measure.extrapolated_with.is_none() {
        notes.push(format!(
            "the meshes do not converge in {} at a known order. The finest mesh serves as the reference",
            measure.name
        ));
    } else if measure.order.is_some() && !measure.order_is_clean {
        notes.push(format!(
            "the observed order of {} is unreliable: time integration errors exceed a tenth of the differences \
             between meshes",
            measure.name
        ));
    }
    for r in &study.references {
        let k = study.headline;
        if r.checked_by.is_none() {
            notes.push(format!(
                "{}: no run of another order or method is accurate enough to check the reference. Its error is \
                 estimated only from its own tolerances",
                counted(r.cells as u64, "cell")
            ));
        }
        if let (Some(t), Some(o)) = (r.by_tolerance[k], r.by_order[k])
            && r.own[k].max > t.max
        {
            notes.push(format!(
                "{}: the two error estimates of the reference disagree ({:.1e} from its tolerances, {:.1e} from \
                 another scheme). The larger one is used",
                counted(r.cells as u64, "cell"),
                t.max,
                o.max
            ));
        }
    }
    notes
}
