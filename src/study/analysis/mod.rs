//! Analyses of a case: each computes figures by name, with errors and derivatives.
//!
//! ```text
//! run          runs in time                          slcbeam run
//! equilibrium  states at rest                        slcbeam equilibrium
//! modes        small motions about the start         slcbeam modes
//! cycle        steady cycles                         slcbeam periodic
//! multipliers  stability of cycles                   slcbeam floquet
//! bands        first gaps of a repeating cell        slcbeam bands
//! response     peaks of a frequency response         slcbeam response
//!
//! outcome      figures of a case, and the outcome of its computation
//! derivatives  derivatives of figures with respect to numbers of the case
//! power        energies and mean powers of a cycle
//! ```
//!
//! Commands and options that compute many designs (`sweep`, `fit`, `optimize`, `--uncertain`) use an analysis only
//! through [`Analysis`]. A new analysis needs a file here and a name in [`AnalysisKind`].

mod bands;
mod cycle;
pub mod derivatives;
mod equilibrium;
pub mod modes;
mod multipliers;
mod outcome;
pub mod power;
pub mod response;
mod run;

use std::cell::Cell;

use serde::{Deserialize, Serialize};

use crate::case::Case;
use crate::case::parameter::Parameter;
use crate::discrete::System;
use crate::error::{Code, Result};
use crate::run::dynamics::{self, Outcome};
use crate::run::record::{Control, FiguresAlone, Progress, Recorder, Unrecorded};
use crate::run::summary::{Accuracy, Status};
use crate::study::evaluations::Evaluations;
use crate::study::refine::{self, meshes};
use crate::study::{companion, target};
use derivatives::FigureSlopes;
pub use outcome::{AnalysisOutcome, word};
pub use response::ResponseAnalysis;

/// Name of the figure that is 1 if the requested accuracy is reached, otherwise 0.
pub const ACCURACY: &str = "accuracy_reached";

/// Function that runs a case in time.
pub type RunCase<'a> = &'a dyn Fn(&Case) -> Result<Outcome>;

/// Returns true if a computation must stop.
pub type StopCheck<'a> = &'a dyn Fn() -> bool;

/// Figures with their derivatives.
pub type FoundSlopes = Result<(AnalysisOutcome, FigureSlopes)>;

/// A computation of a case that yields figures.
pub trait Analysis: Sync {
    /// Rejects a case that the analysis cannot compute, before anything is computed.
    ///
    /// # Errors
    /// The error that the command reports.
    fn check(&self, case: &Case) -> Result<()>;

    /// Computes the figures of a case. `run` runs the case in time, if the analysis needs that.
    ///
    /// # Errors
    /// Those of the command.
    fn figures(&self, case: &Case, ask: AnalysisRequest, stop: StopCheck, run: RunCase) -> Result<AnalysisOutcome>;

    /// Names of the figures of a case.
    ///
    /// # Errors
    /// Those of [`System::new`].
    fn names(&self, case: &Case) -> Result<Vec<String>>;

    /// Rejects numbers of a case for which figures have no derivatives, before anything is computed.
    ///
    /// # Errors
    /// [`Error::Usage`](crate::error::Error::Usage) that names the number.
    fn allows(&self, _: &Case, _: &[Parameter]) -> Result<()> {
        Ok(())
    }

    /// Computes the figures of a case and their derivatives with respect to `parameters`, where these exist. A
    /// computation that does not finish has no derivatives. A run uses the effects of the system `alike`. The
    /// derivatives are exact for runs (IDA's sensitivities, [E41]), equilibria [E43], modes [E44], cycles [E76] and frequency responses [E98];
    /// those of gaps are differences of fourth order.
    ///
    /// # Errors
    /// Those of the command; a number without derivatives.
    fn derivatives(
        &self,
        case: &Case,
        parameters: &[Parameter],
        alike: Option<&System>,
        stop: StopCheck,
    ) -> FoundSlopes;

    /// Error code of a case without figures.
    fn fault(&self) -> Code;

    /// True if the tolerance of time steps limits the accuracy of figures.
    fn is_in_time(&self) -> bool {
        true
    }
}

/// An analysis by the command that runs it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum AnalysisKind {
    /// `run`.
    Run,
    /// `periodic`.
    Periodic,
    /// `equilibrium`.
    Equilibrium,
    /// `modes`.
    Modes,
    /// `floquet`.
    Floquet,
    /// `bands`.
    Bands,
    /// `response`.
    Response(ResponseAnalysis),
}

impl AnalysisKind {
    /// Name of the command.
    pub fn word(&self) -> &'static str {
        match self {
            Self::Run => "run",
            Self::Periodic => "periodic",
            Self::Equilibrium => "equilibrium",
            Self::Modes => "modes",
            Self::Floquet => "floquet",
            Self::Bands => "bands",
            Self::Response(_) => "response",
        }
    }

    /// Words of the command line after the case; empty for analyses without options.
    pub fn options(&self) -> Vec<String> {
        match self {
            Self::Response(response) => response.options(),
            _ => vec![],
        }
    }

    /// Command with its options, as on the command line.
    pub fn describe(&self) -> String {
        let words = std::iter::once(self.word().to_owned()).chain(self.options());
        words.collect::<Vec<_>>().join(" ")
    }

    /// Reason why a result has no figure of a known name, after a colon; empty if there is none.
    pub fn absence(&self) -> String {
        match self {
            Self::Response(ResponseAnalysis { band: [from, to], .. }) => {
                format!(": the amplitude has fewer peaks from {from} to {to} Hz. Widen the band (--from, --to)")
            }
            _ => String::new(),
        }
    }

    /// True if the command itself has the option `--accuracy`.
    pub fn has_accuracy(&self) -> bool {
        !matches!(self, Self::Bands | Self::Response(_))
    }

    /// Returns the analysis.
    pub fn analysis(&self) -> &dyn Analysis {
        match self {
            Self::Run => &run::Run,
            Self::Periodic => &cycle::Periodic,
            Self::Equilibrium => &equilibrium::EquilibriumAnalysis,
            Self::Modes => &modes::ModesAnalysis,
            Self::Floquet => &multipliers::Multipliers,
            Self::Bands => &bands::BandsAnalysis,
            Self::Response(response) => response,
        }
    }
}

/// A request for the figures of a case.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AnalysisRequest<'a> {
    /// The analysis.
    pub what: &'a AnalysisKind,
    /// Requested relative error of every figure.
    pub accuracy: Option<f64>,
    /// Initial mesh and tolerance of the search for the accuracy.
    pub from: Option<target::ReachedSetting>,
    /// True if errors are estimated: for runs by a companion, for other analyses by two or three meshes.
    pub meshes: bool,
    /// True if states of runs are examined for growing waves.
    pub waves: bool,
}

/// Computes the figures of a case; `run` runs it in time, if the analysis needs that. `None` if `stop` became true
/// meanwhile.
pub fn found(case: &Case, ask: AnalysisRequest, stop: StopCheck, run: RunCase) -> Option<AnalysisOutcome> {
    let found = ask.what.analysis().figures(case, ask, stop, run);
    if stop() {
        return None;
    }
    Some(found.unwrap_or_else(|error| AnalysisOutcome::failed(&error)))
}

/// Returns the result stored under a key of a journal, with its warnings; without one, the result of `found`.
pub fn stored(
    evaluations: &Evaluations,
    key: &impl Serialize,
    stop: StopCheck,
    found: impl FnOnce() -> Option<AnalysisOutcome>,
) -> Option<AnalysisOutcome> {
    let apart = |mut found: AnalysisOutcome| {
        let messages = std::mem::take(&mut found.messages);
        (found, messages)
    };
    let (found, messages) = evaluations.get(key, stop, || found().map(apart))?;
    Some(AnalysisOutcome { messages, ..found })
}

/// Runs a case without recording histories and fields.
///
/// # Errors
/// Those of [`companion::run`].
pub fn run(case: &Case, ask: AnalysisRequest, stop: StopCheck) -> Result<Outcome> {
    let wait = Cell::new(0_u32);
    let hook = |_: &Progress| {
        wait.set(wait.get() + 1);
        match wait.get().is_multiple_of(16) && stop() {
            true => Control::Stop("interrupted".into()),
            false => Control::Continue,
        }
    };
    let recorder: &mut dyn Recorder = match ask.waves {
        true => &mut Unrecorded(hook),
        false => &mut FiguresAlone(hook),
    };
    match ask.accuracy {
        None if ask.meshes => target::effects::run(case, recorder),
        None => dynamics::run(case, recorder),
        Some(accuracy) => target::reach(case, accuracy, ask.from.as_ref(), &mut |case, accuracy| {
            companion::measured(case, System::new(case)?, accuracy, recorder)
        }),
    }
}

/// Adds the errors that the search for an accuracy estimated.
fn accurate(found: &mut AnalysisOutcome, accuracy: &Accuracy, name: &dyn Fn(&str) -> String) {
    for (own, estimate) in &accuracy.quantities {
        found.put(format!("{}.error", name(own)), estimate.total);
    }
    reached(found, accuracy);
}

/// Adds a figure that is 1 if the requested accuracy is reached. Otherwise the reason of the row reports the miss, too.
fn reached(found: &mut AnalysisOutcome, accuracy: &Accuracy) {
    found.put(ACCURACY, f64::from(u8::from(accuracy.reached)));
    if let (false, None, Status::Finished) = (accuracy.reached, &found.reason, found.status) {
        found.reason = Some(format!(
            "{} accuracy {:e} is not reached",
            Code::Accuracy.id(),
            accuracy.asked
        ));
    }
    found.warn(refine::warning(accuracy).as_slice());
}

/// Adds the errors estimated by comparing meshes.
fn errors(found: &mut AnalysisOutcome, by_mesh: &meshes::Meshes, name: &dyn Fn(&str) -> String) {
    for (own, share) in &by_mesh.quantities {
        let total = share.known().then(|| share.total());
        found.put(format!("{}.error", name(own)), total);
    }
    found.warn(by_mesh.warning().as_slice());
}
