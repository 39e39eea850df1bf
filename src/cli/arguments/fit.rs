//! Arguments of `fit` and `compare`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::{CaseArguments, ResultArguments};
use crate::study::fit::robust::LossFunction;

/// Weight of large residuals.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Robust {
    /// Absolute value in place of the square beyond some standard deviations
    Huber,
    /// Nearly no weight for large residuals
    Cauchy,
}

impl From<Robust> for LossFunction {
    fn from(one: Robust) -> Self {
        match one {
            Robust::Huber => Self::Huber,
            Robust::Cauchy => Self::Cauchy,
        }
    }
}

/// Analysis of a case.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum FittedThrough {
    /// A run in time: rows are instants
    Run,
    /// Static equilibria: rows are cases, --drive names the numbers that they set
    Equilibrium,
    /// The frequency response of small motions about the start: rows are frequencies, --input names the signal that acts
    Response,
}

/// `fit`.
#[derive(Debug, Args)]
pub struct FitArguments {
    /// The case.
    #[command(flatten)]
    pub case: CaseArguments,
    /// Measured data (CSV): a line of headings with units, such as t_s,angle_deg; an empty cell was not measured
    pub data: PathBuf,
    /// Seek a number of the case between bounds, repeatable, such as /beam/young_modulus_pa=1e5:1e7
    #[arg(long, value_name = "POINTER=LOW:HIGH", allow_hyphen_values = true)]
    pub vary: Vec<String>,
    /// A column beside a quantity of the result, repeatable, such as angle_deg=tip_angle, p_kpa="pressure@bladder 3", u_mm=u1@0.5
    #[arg(long = "match", value_name = "COLUMN=QUANTITY[@PLACE]")]
    pub matches: Vec<String>,
    /// Analysis of the case [default: equilibrium with --drive, response with --input, else run]
    #[arg(long, value_enum)]
    pub command: Option<FittedThrough>,
    /// Column of time [default: t or time]
    #[arg(long, value_name = "COLUMN", conflicts_with = "drive")]
    pub time: Option<String>,
    /// A number of the case that every row sets, repeatable, such as p_kpa=/network/chains/0/ends/0/pressure_pa
    #[arg(long, value_name = "COLUMN=POINTER")]
    pub drive: Vec<String>,
    /// Input of a response: the JSON pointer of a signal of the case, such as /ends/root/clamped/u1_m
    #[arg(long, value_name = "POINTER", conflicts_with_all = ["drive", "time"])]
    pub input: Option<String>,
    /// Standard deviation of a column's noise in its own unit, repeatable [default: a column COLUMN_sd, else what the fit leaves]
    #[arg(long, value_name = "COLUMN=SIGMA")]
    pub noise: Vec<String>,
    /// Reduce the weight of large residuals
    #[arg(long, value_enum)]
    pub robust: Option<Robust>,
    /// Searches, from the case's own numbers and from places between the bounds
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub starts: u32,
    /// Simulations at once [default: one for every core]
    #[arg(long, value_name = "N", value_parser = crate::cli::progress_line::count)]
    pub jobs: Option<usize>,
    /// Its result.
    #[command(flatten)]
    pub result: ResultArguments,
    /// Print fit.json instead of the text
    #[arg(long)]
    pub json: bool,
}

/// `compare`.
#[derive(Debug, Args)]
pub struct CompareArguments {
    /// Result folders, two or more, which are compared with the first; or one, and measured data (CSV) with --match
    #[arg(required = true, num_args = 2.., value_name = "RESULT")]
    pub results: Vec<PathBuf>,
    /// Compare with this one of the folders [default: the first]
    #[arg(long, value_name = "FOLDER", conflicts_with = "matches")]
    pub with: Option<PathBuf>,
    /// A column of the data beside a quantity of the run, repeatable, such as angle_deg=tip_angle
    #[arg(long = "match", value_name = "COLUMN=QUANTITY[@PLACE]")]
    pub matches: Vec<String>,
    /// Column of time of the data [default: t or time]
    #[arg(long, value_name = "COLUMN", requires = "matches")]
    pub time: Option<String>,
    /// A page of tables and of histories over each other, report.html in this folder; or a picture of two, where it ends in .svg
    #[arg(short, long, value_name = "FOLDER", value_parser = crate::cli::progress_line::output_path())]
    pub out: Option<PathBuf>,
    /// Print as JSON
    #[arg(long)]
    pub json: bool,
}
