//! One run within a budget that is counted, not timed, so that it is the same on every machine.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};

use slcbeam::case::Case;
use slcbeam::case::schema::{Effects, Method};
use slcbeam::discrete::System;
use slcbeam::run::dynamics::{self, Outcome};
use slcbeam::run::record::{Control, Progress, Recorder, Unrecorded};
use slcbeam::run::summary::{Status, Summary};
use slcbeam::study::accuracy::plan;
use slcbeam::study::companion;

/// Why a run was cut short by its budget.
pub const BUDGET: &str = "budget";

/// Keeps nothing and stops when so many steps are used up.
pub fn steps(count: u64) -> impl Recorder {
    Unrecorded(move |progress: &Progress| match progress.steps >= count {
        true => Control::Stop(BUDGET.into()),
        false => Control::Continue,
    })
}

/// What may still be spent on a scene: steps times unknowns times stages.
pub struct Work {
    /// What is left.
    pub left: f64,
}

impl Work {
    /// Runs a case; `unknowns` is a guess of their number. No summary where the budget did not last.
    pub fn run(&mut self, case: &Case, unknowns: f64) -> Option<Summary> {
        self.run_by(case, unknowns, |case, recorder| dynamics::run(case, recorder).ok())
    }

    /// The same with error bars.
    pub fn run_with_errors(&mut self, case: &Case, unknowns: f64) -> Option<Summary> {
        self.run_by(case, unknowns, |case, recorder| {
            companion::run(case, System::new(case).ok()?, &[], recorder).ok()
        })
    }

    fn run_by(
        &mut self,
        case: &Case,
        unknowns: f64,
        run: impl FnOnce(&Case, &mut dyn Recorder) -> Option<Outcome>,
    ) -> Option<Summary> {
        let stages = match case.solver.method {
            Method::Esdirk57 => 7.0,
            Method::Esdirk46 => 6.0,
            Method::Auto | Method::Ida | Method::Trbdf2 | Method::Esdirk34 => 2.0,
        };
        let price = unknowns.max(1.0) * stages;
        let steps = (self.left / price) as u64;
        if steps < 50 {
            self.left = 0.0;
            return None;
        }
        let outcome = run(case, &mut self::steps(steps))?;
        self.left -= outcome.summary.solver.steps as f64 * price;
        (outcome.summary.reason.as_deref() != Some(BUDGET)).then_some(outcome.summary)
    }
}

/// The case with everything it describes, on a mesh, with a one-step method, no step longer than `fastest` [s], sampled finely.
pub fn exact(case: &Case, cells: usize, method: Method, rtol: f64, fastest: f64) -> Case {
    let mut case = plan::refined(case, cells, rtol);
    case.effects = Effects::Full;
    case.solver.method = method;
    // Slow things too are looked at often, and nothing fast is stepped over.
    case.solver.max_step_s = Some(fastest.min(case.time.end_s / 100.0));
    sampled(&mut case);
    case
}

/// Least number of samples in a run.
const SAMPLES: f64 = 500.0;

/// Outputs at a whole part of their interval, enough to see every swing.
pub fn sampled(case: &mut Case) {
    let interval = case.time.output_interval();
    let window = case.time.window();
    let parts = (interval * SAMPLES / case.time.end_s - 1e-6).ceil().max(1.0);
    case.time.output_interval_s = Some(interval / parts);
    case.time.fields_interval_s = Some(case.time.end_s / 10.0).filter(|f| *f >= interval);
    if case.time.fields_interval_s.is_none() {
        case.time.fields_interval_s = Some(interval);
    }
    case.time.window_s = Some(window);
}

/// Figures of every quantity, by the names in `summary.json`.
pub type Figures = BTreeMap<String, BTreeMap<String, f64>>;

/// The figures of a summary.
pub fn figures(summary: &Summary) -> Figures {
    let of = |(name, q): (&String, &slcbeam::run::summary::Quantity)| {
        (
            name.clone(),
            q.figures().map(|(figure, value)| (figure.to_owned(), value)).collect(),
        )
    };
    summary.quantities.iter().map(of).collect()
}

/// Whether a run reached its end.
pub fn finished(summary: &Summary) -> bool {
    summary.status == Status::Finished
}

/// Evaluates seeds on two threads.
pub fn each_seed(seeds: &[u64], evaluate: impl Fn(u64) + Sync) {
    let next = AtomicUsize::new(0);
    std::thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                while let Some(&seed) = seeds.get(next.fetch_add(1, Ordering::Relaxed)) {
                    evaluate(seed);
                }
            });
        }
    });
}
