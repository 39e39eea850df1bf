//! What can be asked for.

mod map;
mod periodic;
mod sweep;

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};

use super::coefficients::CoefficientsArguments;
use super::completions::CompletionsArguments;
use super::explain::ExplainArguments;
use super::export::ExportArguments;
use super::measure::MeasureArguments;
use super::new::NewArguments;
use super::place::PlaceArguments;
use super::report::ReportArguments;
use super::schema::SchemaArguments;
pub use map::MapArguments;
pub use periodic::PeriodicArguments;
pub use sweep::{MergeArguments, Script, SweepArguments};

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
    /// Find what accuracy costs: time against error over tolerances, meshes and orders
    Study(StudyArguments),
    /// Find what each effect does: the full model without it, what that changes and saves, what to leave out
    Effects(EffectsArguments),
    /// Find frequencies, damping, shapes and stability of small motions, with the fluid as it is, sealed in, and free
    Modes(ModesArguments),
    /// Find the steady cycle of a periodically driven case and whether it is stable, or a map of where shaking is stable
    Floquet(FloquetArguments),
    /// Find the steady cycle of a periodically driven case directly, without its transient; or along a parameter
    Periodic(PeriodicArguments),
    /// Compute many designs on all cores into one table: grids, ranges, samples, cases beside each other
    Sweep(SweepArguments),
    /// Join the shards of a sweep to one table, and name what is lost
    Merge(MergeArguments),
    /// Compare two result folders: error norms of every field and quantity, cost ratio
    Compare(CompareArguments),
    /// Write a result in other formats: tables of its fields (CSV), surfaces that ParaView opens (VTK)
    Export(ExportArguments),
    /// Make one self-contained HTML page of a result folder, whichever command filled it
    Report(ReportArguments),
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

impl Command {
    /// Whether a script asks.
    pub fn json(&self) -> bool {
        match self {
            Self::Run(a) => a.json,
            Self::Check(a) => a.json,
            Self::Coefficients(a) => a.json,
            Self::Measure(a) => a.json,
            Self::Equilibrium(a) => a.json,
            Self::Study(a) => a.json,
            Self::Effects(a) => a.json,
            Self::Modes(a) => a.json,
            Self::Floquet(a) => a.json,
            Self::Periodic(a) => a.json,
            Self::Sweep(a) => a.json,
            Self::Merge(a) => a.json,
            Self::Compare(a) => a.json,
            Self::Mapping(a) => a.json,
            Self::Verify(a) => a.json,
            Self::Schema(a) => a.json,
            Self::Export(a) => a.json,
            Self::Report(a) => a.json,
            Self::Explain(a) => a.json,
            Self::New(a) => a.json,
            Self::Completions(_) => false,
        }
    }
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

/// `run`.
#[derive(Debug, Args)]
pub struct RunArguments {
    /// The case.
    #[command(flatten)]
    pub case: CaseArguments,
    /// Where its result goes.
    #[command(flatten)]
    pub place: PlaceArguments,
    /// Choose mesh and tolerance so that the estimated relative error of every quantity is below this, such as 0.01
    #[arg(long, value_name = "REL", conflicts_with = "resume")]
    pub accuracy: Option<f64>,
    /// Give derivatives with respect to this number of the case too, repeatable: a JSON pointer, such as /fluid/viscosity_pa_s
    #[arg(long = "sensitivity", value_name = "POINTER", conflicts_with = "accuracy")]
    pub sensitivities: Vec<String>,
    /// Go on from the last checkpoint in the result folder (needs /time/checkpoint_interval_s in the case)
    #[arg(long, conflicts_with = "force")]
    pub resume: bool,
    /// Stop after so many seconds of wall time, with everything so far written
    #[arg(long, value_name = "SECONDS", value_parser = super::line::duration)]
    pub max_wall: Option<f64>,
    /// Leave summary.json, case.json and the arrays of fields.npz alone: no pictures, no page, no tables
    #[arg(long)]
    pub lean: bool,
    /// No progress bar
    #[arg(long)]
    pub quiet: bool,
    /// Print summary.json instead of the summary box
    #[arg(long)]
    pub json: bool,
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
}

/// `equilibrium`.
#[derive(Debug, Args)]
pub struct EquilibriumArguments {
    /// The case.
    #[command(flatten)]
    pub case: CaseArguments,
    /// Instant whose loads, end motions, port pressures and valves are the full ones [default: the end of the run]
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true)]
    pub at: Option<f64>,
    /// Loading in stages: instants whose loads are reached first, one after the other, such as -1 or 0.2,0.5
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true)]
    pub via: Option<String>,
    /// Share of these loads at which the path ends, of the last stage where there are several
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, allow_negative_numbers = true)]
    pub load_factor: f64,
    /// Points along the path at least
    #[arg(long, value_name = "COUNT", default_value_t = 16)]
    pub points: usize,
    /// Stay on a path that becomes unstable (a column that stays straight) instead of taking the one that crosses it
    #[arg(long)]
    pub keep_branch: bool,
    /// Differentiate the last state by this number of the case, a JSON pointer such as /bladders/area_per_pressure_m2_per_pa;
    /// repeatable
    #[arg(long, value_name = "POINTER")]
    pub sensitivity: Vec<String>,
    /// Choose mesh so that the estimated relative error of every number is below this, such as 0.01
    #[arg(long, value_name = "REL")]
    pub accuracy: Option<f64>,
    /// Where its result goes.
    #[command(flatten)]
    pub place: PlaceArguments,
    /// No progress
    #[arg(long)]
    pub quiet: bool,
    /// Print equilibrium.json instead of the table
    #[arg(long)]
    pub json: bool,
}

/// `study`.
#[derive(Debug, Args)]
pub struct StudyArguments {
    /// The case.
    #[command(flatten)]
    pub case: CaseArguments,
    /// Where its result goes.
    #[command(flatten)]
    pub place: PlaceArguments,
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
    /// Meshes: beam cells per segment, each with half as many fluid cells per bladder; powers of two tell most
    #[arg(long, value_name = "LIST", value_delimiter = ',', default_value = "1,2,4,8")]
    pub cells: Vec<usize>,
    /// Methods: ida (with each of the orders), trbdf2, esdirk34, esdirk46, esdirk57
    #[arg(long, value_name = "LIST", value_delimiter = ',', default_value = "ida,esdirk46")]
    pub methods: Vec<String>,
    /// Highest BDF orders
    #[arg(long, value_name = "LIST", value_delimiter = ',', default_value = "2,5")]
    pub orders: Vec<u8>,
    /// Timed runs of a setting, after one to warm up, as far as the budget allows
    #[arg(long, value_name = "COUNT", default_value_t = 3)]
    pub repeats: usize,
    /// What table, picture and sentence are about: a column, field or figure [default: tip_u1, else tip_u3]
    #[arg(long, value_name = "NAME")]
    pub measure: Option<String>,
    /// Run on all cores at once; times suffer
    #[arg(long)]
    pub parallel: bool,
    /// No progress
    #[arg(long)]
    pub quiet: bool,
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
    /// Where its result goes.
    #[command(flatten)]
    pub place: PlaceArguments,
    /// Wall time for everything, such as 90s or 2m
    #[arg(long, value_name = "TIME", default_value = "120s")]
    pub budget: String,
    /// Timed runs of each model, after one to warm up, as far as the budget allows; with 0 no verdict looks at time
    #[arg(long, value_name = "COUNT", default_value_t = 3)]
    pub repeats: usize,
    /// Quantity that table and picture show, or "largest": of each effect the one that changes most [default: tip_u1_m, else
    /// tip_u3_m]
    #[arg(long, value_name = "NAME")]
    pub measure: Option<String>,
    /// Write what is recommended into the case file, as its "effects"
    #[arg(long, conflicts_with = "sets")]
    pub write: bool,
    /// No progress
    #[arg(long)]
    pub quiet: bool,
    /// Print effects.json instead of the table
    #[arg(long)]
    pub json: bool,
}

/// `modes`.
#[derive(Debug, Args)]
pub struct ModesArguments {
    /// The case.
    #[command(flatten)]
    pub case: CaseArguments,
    /// Modes to find; rigid motions and kept volumes come besides
    #[arg(long, value_name = "COUNT", default_value_t = 12)]
    pub count: usize,
    /// Find those nearest this frequency [Hz] [default: the slowest]
    #[arg(long, value_name = "HZ", allow_negative_numbers = true)]
    pub near: Option<f64>,
    /// About the equilibrium under the loads at this instant [s] [default: about the start]
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true)]
    pub at: Option<f64>,
    /// Differentiate frequencies and growth rates by this number of the case, a JSON pointer such as /beam/young_modulus_pa;
    /// repeatable
    #[arg(long, value_name = "POINTER")]
    pub sensitivity: Vec<String>,
    /// A map instead: that of `floquet`.
    #[command(flatten)]
    pub map: MapArguments,
    /// Choose mesh so that the estimated relative error of every number is below this, such as 0.01
    #[arg(long, value_name = "REL", conflicts_with = "map")]
    pub accuracy: Option<f64>,
    /// Where its result goes.
    #[command(flatten)]
    pub place: PlaceArguments,
    /// No progress
    #[arg(long)]
    pub quiet: bool,
    /// Print modes.json instead of the table
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
    #[arg(long, value_name = "COUNT", default_value_t = 12)]
    pub count: usize,
    /// Period of a case in which nothing is periodic
    #[arg(long, value_name = "SECONDS", conflicts_with = "map")]
    pub period: Option<f64>,
    /// A map instead.
    #[command(flatten)]
    pub map: MapArguments,
    /// Choose mesh and tolerance so that the estimated relative error of every number is below this, such as 0.01
    #[arg(long, value_name = "REL", conflicts_with = "map")]
    pub accuracy: Option<f64>,
    /// Where its result goes.
    #[command(flatten)]
    pub place: PlaceArguments,
    /// No progress
    #[arg(long)]
    pub quiet: bool,
    /// Print floquet.json or map.json instead of the table
    #[arg(long)]
    pub json: bool,
}

/// `compare`.
#[derive(Debug, Args)]
pub struct CompareArguments {
    /// First result folder
    pub a: PathBuf,
    /// Second result folder
    pub b: PathBuf,
    /// Draw both over each other into this SVG file
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Print as JSON
    #[arg(long)]
    pub json: bool,
}

/// `mapping`.
#[derive(Debug, Args)]
pub struct MappingArguments {
    /// The case.
    #[command(flatten)]
    pub case: CaseArguments,
    /// Which table [default: both, a blank line between them]
    #[arg(long)]
    pub table: Option<Table>,
    /// Print as JSON
    #[arg(long)]
    pub json: bool,
}

/// `verify`.
#[derive(Debug, Args)]
pub struct VerifyArguments {
    /// Only results whose name contains this
    pub name: Option<String>,
    /// Compute instead the coefficients of the published cell, for every shape that the paper leaves open, beside the printed ones
    #[arg(long, conflicts_with = "name")]
    pub paper: bool,
    /// Print as JSON
    #[arg(long)]
    pub json: bool,
}

/// The two maps.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Table {
    /// Table A.1.
    ThetaToXf,
    /// Table A.2.
    XfToTheta,
}
