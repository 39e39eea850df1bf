//! Arguments of `optimize`.

use clap::Args;

use super::{AnalysisArguments, CaseArguments, ResultArguments};

/// `optimize`.
#[derive(Debug, Args)]
#[command(group(clap::ArgGroup::new("goal").required(true)))]
pub struct OptimizeArguments {
    /// The case.
    #[command(flatten)]
    pub case: CaseArguments,
    /// Seek a number of the case between bounds, repeatable, such as /network/permeability_factor=0.01:1
    #[arg(long, value_name = "POINTER=LOW:HIGH", allow_hyphen_values = true)]
    pub vary: Vec<String>,
    /// Choose between alternatives for a part of the case, repeatable, such as '/network/chains/0/bladders=[1, 2, 3]|[1, 3, 2]'
    #[arg(long, value_name = "POINTER=JSON|JSON..")]
    pub choose: Vec<String>,
    /// Choose between all wirings in which the first two chains, of opposite bladders, change sides at most so often along the beam
    #[arg(long, value_name = "N", value_parser = crate::cli::progress_line::count)]
    pub crossovers: Option<usize>,
    /// Figure to maximize, as named in the table of sweep, such as harvested_power_w.mean, tip_u1_m, mode_1.frequency_hz
    #[arg(long, value_name = "QUANTITY[.FIGURE]", group = "goal")]
    pub maximize: Option<String>,
    /// Figure to minimize
    #[arg(long, value_name = "QUANTITY[.FIGURE]", group = "goal")]
    pub minimize: Option<String>,
    /// Limit of another figure, repeatable, such as 'max_pressure_pa<=2e4' or 'tip_u1_m>=0.01'
    #[arg(long, value_name = "QUANTITY[.FIGURE]<=VALUE")]
    pub subject_to: Vec<String>,
    /// Analysis of every design.
    #[command(flatten)]
    pub analysis: AnalysisArguments,
    /// Searches, from the case's own numbers and from places between the bounds
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub starts: u32,
    /// Searches at once [default: one for every core]
    #[arg(long, value_name = "N", value_parser = crate::cli::progress_line::count)]
    pub jobs: Option<usize>,
    /// Its result.
    #[command(flatten)]
    pub result: ResultArguments,
    /// Print optimum.json instead of the text
    #[arg(long)]
    pub json: bool,
}
