//! Arguments of `periodic`.

use clap::Args;

use super::{CaseArguments, ResultArguments, UncertainArguments};

/// `periodic`.
#[derive(Debug, Args)]
pub struct PeriodicArguments {
    /// The case.
    #[command(flatten)]
    pub case: CaseArguments,
    /// Cycles along a parameter, followed through folds: a JSON pointer, its range and how many values, spread evenly or by their
    /// logarithms, such as /network/permeability_factor=0.01:1:25:log
    #[arg(long, value_name = "POINTER=FROM:TO:COUNT[:log]")]
    pub sweep: Option<String>,
    /// With --sweep over an amplitude: the backbone of a resonance. At each value this frequency of the drive, a JSON pointer, is the one
    /// at which drive and motion are a quarter period apart
    #[arg(long, value_name = "POINTER", requires = "sweep")]
    pub resonance: Option<String>,
    /// Look for a cycle that comes back after so many periods of what drives the case: 2 for a period that doubles
    #[arg(long, value_name = "COUNT", default_value_t = 1, value_parser = crate::cli::progress_line::count)]
    pub periods: usize,
    /// Choose mesh and tolerance so that the estimated relative error of every number is below this, such as 0.01
    #[arg(long, value_name = "REL", conflicts_with = "sweep", value_parser = crate::cli::progress_line::ratio)]
    pub accuracy: Option<f64>,
    /// Also compute derivatives with respect to this number of the case, repeatable: a JSON pointer, such as /fluid/viscosity_pa_s
    #[arg(long = "sensitivity", value_name = "POINTER", conflicts_with_all = ["accuracy", "sweep"])]
    pub sensitivities: Vec<String>,
    /// Uncertain numbers.
    #[command(flatten)]
    pub uncertain: UncertainArguments,
    /// Its result.
    #[command(flatten)]
    pub result: ResultArguments,
    /// Print cycle.json or sweep.json instead of the text
    #[arg(long)]
    pub json: bool,
}
