//! Arguments of `sense`.

use std::path::PathBuf;

use clap::Args;

use super::{CaseArguments, ResultArguments};

/// `sense`.
#[derive(Debug, Args)]
pub struct SenseArguments {
    /// The case.
    #[command(flatten)]
    pub case: CaseArguments,
    /// Measured pressures (CSV), a column a bladder such as `pressure_3_pa` or `pressure_-3_kpa`, a row a measurement at rest, or
    /// an instant (--dynamic); without it: loads that pressures can determine, and which pressures to measure
    pub pressures: Option<PathBuf>,
    /// A load to estimate, repeatable: tip-force, tip-moment, tip-axial, uniform, uniform-axial, profile:N with N places,
    /// point:S at a share S of the length [default: tip-force where the tip is free, uniform]
    #[arg(long = "load", value_name = "LOAD")]
    pub loads: Vec<String>,
    /// Standard deviation of the noise of a pressure [Pa] [default: columns such as pressure_3_sd_pa, else estimated from what the
    /// loads leave]
    #[arg(long, value_name = "PA")]
    pub noise: Option<f64>,
    /// Smoothness of a profile, or of a load over time: the most likely one (likelihood), the one whose residuals have the size of the
    /// noise (discrepancy), off, or, of a profile at rest, the standard deviation of its second differences [N/m]
    /// [default: likelihood]
    #[arg(long, value_name = "HOW")]
    pub smoothing: Option<String>,
    /// Rows are instants (column t_s) of a run of the case, and the loads change while it lasts: with inertia and flow, by runs
    #[arg(long, conflicts_with_all = ["at", "choose"], requires = "pressures")]
    pub dynamic: bool,
    /// Equally spaced instants between which a load over time is a smooth curve, from 5 to 200, no
    /// more than rows [default: as many as rows, at most 41]
    #[arg(long, value_name = "N", requires = "dynamic", value_parser = clap::value_parser!(u16).range(5..=200))]
    pub knots: Option<u16>,
    /// Instant of the loads of the case that also act [default: the end of the run]
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true, value_parser = crate::cli::progress_line::instant)]
    pub at: Option<f64>,
    /// Which bladders to measure: the best sets of every size, by the sum of the variances of the loads, or by the volume in which they lie
    #[arg(long, value_name = "BY", num_args = 0..=1, require_equals = true, default_missing_value = "variances",
          value_parser = ["variances", "volume"])]
    pub choose: Option<String>,
    /// Its result.
    #[command(flatten)]
    pub result: ResultArguments,
    /// Print sense.json instead of the table
    #[arg(long)]
    pub json: bool,
}
