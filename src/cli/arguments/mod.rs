//! Command-line arguments.

mod at_rest;
mod fit;
mod map;
mod optimize;
mod periodic;
mod run;
mod sense;
mod sweep;
pub mod uncertain;

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};

use super::bands::BandsArguments;
use super::coefficients::CoefficientsArguments;
use super::completions::CompletionsArguments;
use super::explain::ExplainArguments;
use super::export::ExportArguments;
use super::interrupt::WallArguments;
use super::measure::MeasureArguments;
use super::new::NewArguments;
use super::plot::PlotArguments;
use super::report::ReportArguments;
use super::response::ResponseArguments;
use super::result_folder::PlaceArguments;
use super::schema::SchemaArguments;
use crate::error::Result;
pub use at_rest::{EquilibriumArguments, ModesArguments};
pub use fit::{CompareArguments, FitArguments, FittedThrough};
pub use map::MapArguments;
pub use optimize::OptimizeArguments;
pub use periodic::PeriodicArguments;
pub use run::RunArguments;
pub use sense::SenseArguments;
pub use sweep::{AnalysisArguments, MergeArguments, Script, SweepArguments};
pub use uncertain::UncertainArguments;

/// Elastic beams with fluid-filled bladders joined by slender tubes: dynamics with error control.
#[derive(Debug, Parser)]
#[command(name = "slcbeam", version, max_term_width = 100)]
pub struct Arguments {
    /// The subcommand.
    #[command(subcommand)]
    pub command: Command,
}

/// Subcommands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Simulate a case and write a result folder
    Run(RunArguments),
    /// Validate a case; print characteristic numbers, coupling audit and chosen effects; write nothing
    Check(CheckArguments),
    /// Compute the coefficients of a section from its geometry, with errors
    Coefficients(CoefficientsArguments),
    /// Fit coefficients to measurements, with errors: volumes, extensions, curvatures and flows over pressure, force and moment
    Measure(MeasureArguments),
    /// Find the static equilibrium under the loads of one instant, along the path from rest
    Equilibrium(EquilibriumArguments),
    /// Measure the cost of accuracy: time against error over tolerances, meshes and orders
    Study(StudyArguments),
    /// Measure each effect: changed results and saved time if the model leaves it out; recommend effects to leave out
    Effects(EffectsArguments),
    /// Find frequencies, damping, shapes and stability of small motions, with coupled, undrained and drained fluid
    Modes(ModesArguments),
    /// Compute the frequency response of small motions: amplitude and phase of outputs over a signal of the case, peaks and poles
    Response(ResponseArguments),
    /// Compute waves of a beam whose cells repeat: wave numbers, attenuation, gaps and standing waves
    Bands(BandsArguments),
    /// Find the steady cycle of a periodically driven case and its stability, or a stability map of shaking
    Floquet(FloquetArguments),
    /// Find the steady cycle of a periodically driven case directly, without its transient, or along a parameter; or a self-oscillation
    Periodic(PeriodicArguments),
    /// Compute many designs on all cores into one table: grids, ranges, samples, several cases; after an interruption the same command
    /// computes the missing designs
    Sweep(SweepArguments),
    /// Join the shards of a sweep to one table, and list missing designs
    Merge(MergeArguments),
    /// Fit numbers of a case to measured data between bounds, with errors; report what the data do not determine
    Fit(FitArguments),
    /// Find loads from measured pressures of bladders, at rest or over time, with bands; report observable loads and the best sensors
    Sense(SenseArguments),
    /// Find numbers of a case, between bounds, that maximize or minimize a figure under limits to other figures
    Optimize(OptimizeArguments),
    /// Compare result folders: error norms of every field and quantity, figures, cost; or a run with measured data
    Compare(CompareArguments),
    /// Write a result in other formats: tables of its fields (CSV), surfaces that ParaView opens (VTK)
    Export(ExportArguments),
    /// Write one self-contained HTML page of a result folder of any command
    Report(ReportArguments),
    /// Draw quantities of results as a vector picture (SVG, PDF) in the sizes and fonts of journals
    Plot(PlotArguments),
    /// Print the paper's tables A.1 and A.2 (maps between beam and network) for a case, as CSV
    Mapping(MappingArguments),
    /// Compute exact results of beam and network theory and compare, with observed orders
    Verify(VerifyArguments),
    /// Print the JSON Schema of a case
    Schema(SchemaArguments),
    /// Explain a message by its number (E004, W006), or a key or effect of a case by its name
    Explain(ExplainArguments),
    /// Write a starting case with remarks, and the schema by which editors explain its keys
    New(NewArguments),
    /// Print a script by which a shell completes commands and options
    Completions(CompletionsArguments),
}

/// A case file and changes to it.
#[derive(Clone, Debug, Args)]
pub struct CaseArguments {
    /// Case file (JSON); - is standard input
    pub case: PathBuf,
    /// Change a value of the case, repeatable: a JSON pointer and a JSON value, such as /solver/rtol=1e-7
    #[arg(long = "set", value_name = "POINTER=JSON")]
    pub sets: Vec<String>,
}

/// Folder, time limit and progress of a computation.
#[derive(Clone, Debug, Args)]
pub struct ResultArguments {
    /// Folder of the result.
    #[command(flatten)]
    pub place: PlaceArguments,
    /// Limit of wall time.
    #[command(flatten)]
    pub wall: WallArguments,
    /// No progress
    #[arg(long)]
    pub quiet: bool,
}

/// `check`.
#[derive(Debug, Args)]
pub struct CheckArguments {
    /// The case.
    #[command(flatten)]
    pub case: CaseArguments,
    /// Print as JSON
    #[arg(long)]
    pub json: bool,
    /// Print every characteristic number, coefficient and effect
    #[arg(long)]
    pub verbose: bool,
}

/// `study`.
#[derive(Debug, Args)]
pub struct StudyArguments {
    /// The case.
    #[command(flatten)]
    pub case: CaseArguments,
    /// Wall time for everything, such as 90s or 2m; half of it is for points, the rest for their references
    #[arg(long, value_name = "TIME", default_value = "120s")]
    pub budget: String,
    /// Tolerances
    #[arg(
        long,
        value_name = "LIST",
        value_delimiter = ',',
        default_value = "1e-2,1e-3,1e-4,1e-5,1e-6,1e-7"
    )]
    pub rtol: Vec<f64>,
    /// Meshes: beam cells per segment, each with half as many fluid cells per bladder; powers of two are most informative
    #[arg(long, value_name = "LIST", value_delimiter = ',', default_value = "1,2,4,8")]
    pub cells: Vec<usize>,
    /// Methods: ida (with each of the orders), trbdf2, esdirk34, esdirk46, esdirk57
    #[arg(long, value_name = "LIST", value_delimiter = ',', default_value = "ida,esdirk46")]
    pub methods: Vec<String>,
    /// Highest BDF orders
    #[arg(long, value_name = "LIST", value_delimiter = ',', default_value = "2,5")]
    pub orders: Vec<u8>,
    /// Timed runs of a setting, after one to warm up, as far as the budget allows
    #[arg(long, value_name = "COUNT", default_value_t = 3, value_parser = crate::cli::progress_line::count)]
    pub repeats: usize,
    /// Subject of table, picture and sentence: a column, field or figure [default: tip_u1, else tip_u3]
    #[arg(long, value_name = "NAME")]
    pub measure: Option<String>,
    /// Run on all cores at once; times suffer
    #[arg(long)]
    pub parallel: bool,
    /// Its result.
    #[command(flatten)]
    pub result: ResultArguments,
    /// Print study.json instead of the table
    #[arg(long)]
    pub json: bool,
}

/// `effects`.
#[derive(Debug, Args)]
pub struct EffectsArguments {
    /// The case.
    #[command(flatten)]
    pub case: CaseArguments,
    /// Wall time for everything, such as 90s or 2m
    #[arg(long, value_name = "TIME", default_value = "120s")]
    pub budget: String,
    /// Timed runs of each model, after one to warm up, as far as the budget allows; with 0 no verdict looks at time
    #[arg(long, value_name = "COUNT", default_value_t = 3, value_parser = crate::cli::progress_line::count)]
    pub repeats: usize,
    /// Quantity that table and picture show, or "largest": of each effect the one that changes most [default: tip_u1_m, else
    /// tip_u3_m]
    #[arg(long, value_name = "NAME")]
    pub measure: Option<String>,
    /// Write what is recommended into the case file, as its "effects"
    #[arg(long, conflicts_with = "sets")]
    pub write: bool,
    /// Its result.
    #[command(flatten)]
    pub result: ResultArguments,
    /// Print effects.json instead of the table
    #[arg(long)]
    pub json: bool,
}

/// `floquet`.
#[derive(Debug, Args)]
pub struct FloquetArguments {
    /// The case.
    #[command(flatten)]
    pub case: CaseArguments,
    /// Multipliers, the largest first
    #[arg(long, value_name = "COUNT", default_value_t = 12, value_parser = crate::cli::progress_line::count)]
    pub count: usize,
    /// Period of a case in which nothing is periodic
    #[arg(long, value_name = "SECONDS", conflicts_with = "map")]
    pub period: Option<f64>,
    /// A map instead.
    #[command(flatten)]
    pub map: MapArguments,
    /// Choose mesh and tolerance so that the estimated relative error of every number is below this, such as 0.01
    #[arg(long, value_name = "REL", conflicts_with = "map", value_parser = crate::cli::progress_line::ratio)]
    pub accuracy: Option<f64>,
    /// Uncertain numbers.
    #[command(flatten)]
    pub uncertain: UncertainArguments,
    /// Its result.
    #[command(flatten)]
    pub result: ResultArguments,
    /// Print floquet.json or map.json instead of the table
    #[arg(long)]
    pub json: bool,
}

/// Parses all values of a repeatable option.
///
/// # Errors
/// That of the first value that is wrong.
pub fn parse_all<T>(texts: &[String], parse: fn(&str) -> Result<T>) -> Result<Vec<T>> {
    texts.iter().map(|text| parse(text)).collect()
}

/// `mapping`.
#[derive(Debug, Args)]
pub struct MappingArguments {
    /// The case.
    #[command(flatten)]
    pub case: CaseArguments,
    /// Which table [default: both, a blank line between them]
    #[arg(long)]
    pub table: Option<MapTable>,
    /// Print as JSON
    #[arg(long)]
    pub json: bool,
}

/// `verify`.
#[derive(Debug, Args)]
pub struct VerifyArguments {
    /// Only results whose name contains this
    pub name: Option<String>,
    /// Limit of wall time.
    #[command(flatten)]
    pub wall: WallArguments,
    /// Compute instead the coefficients of the published cell, for every shape that the paper leaves open, beside the printed ones
    #[arg(long, conflicts_with = "name")]
    pub paper: bool,
    /// Print as JSON
    #[arg(long)]
    pub json: bool,
}

/// The two maps.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum MapTable {
    /// Table A.1.
    ThetaToXf,
    /// Table A.2.
    XfToTheta,
}
