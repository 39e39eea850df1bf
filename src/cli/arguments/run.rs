//! Arguments of `run`.

use clap::Args;

use super::{CaseArguments, PlaceArguments, UncertainArguments};

/// `run`.
#[derive(Debug, Args)]
pub struct RunArguments {
    /// The case.
    #[command(flatten)]
    pub case: CaseArguments,
    /// Uncertain numbers.
    #[command(flatten)]
    pub uncertain: UncertainArguments,
    /// Folder of the result.
    #[command(flatten)]
    pub place: PlaceArguments,
    /// Choose mesh and tolerance so that the estimated relative error of every quantity is below this, such as 0.01
    #[arg(long, value_name = "REL", conflicts_with = "resume", value_parser = crate::cli::progress_line::ratio)]
    pub accuracy: Option<f64>,
    /// Also compute derivatives with respect to this number of the case, repeatable: a JSON pointer, such as /fluid/viscosity_pa_s
    #[arg(long = "sensitivity", value_name = "POINTER", conflicts_with = "accuracy")]
    pub sensitivities: Vec<String>,
    /// Continue from the last checkpoint in the result folder (needs /time/checkpoint_interval_s in the case)
    #[arg(long, conflicts_with = "force")]
    pub resume: bool,
    /// Stop after this wall time; results so far are written
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true, value_parser = crate::cli::progress_line::duration)]
    pub max_wall: Option<f64>,
    /// Write only summary.json, case.json and the arrays of fields.npz: no pictures, no page, no tables
    #[arg(long)]
    pub lean: bool,
    /// No progress bar
    #[arg(long)]
    pub quiet: bool,
    /// Print summary.json instead of the summary box
    #[arg(long)]
    pub json: bool,
}
