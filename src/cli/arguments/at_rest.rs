//! Arguments of `equilibrium` and `modes`.

use clap::{Args, ValueEnum};

use super::{CaseArguments, MapArguments, ResultArguments, UncertainArguments};
use crate::run::modes::ModeFilter;

/// Of which kind modes are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ModeKind {
    /// Modes that oscillate, growing or not
    Oscillation,
    /// Modes that decay without oscillation
    Decay,
    /// Modes that grow, with or without oscillation
    Growth,
}

impl From<ModeKind> for ModeFilter {
    fn from(kind: ModeKind) -> Self {
        match kind {
            ModeKind::Oscillation => Self::Oscillation,
            ModeKind::Decay => Self::Decay,
            ModeKind::Growth => Self::Growth,
        }
    }
}

/// `equilibrium`.
#[derive(Debug, Args)]
pub struct EquilibriumArguments {
    /// The case.
    #[command(flatten)]
    pub case: CaseArguments,
    /// Instant of the full loads, end motions, port pressures and valves [default: the end of the run]
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true, value_parser = crate::cli::progress_line::instant)]
    pub at: Option<f64>,
    /// Loading in stages: instants whose loads are reached first, one after the other, such as -1 or 0.2,0.5
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true)]
    pub via: Option<String>,
    /// Fraction of these loads at which the path ends; with several stages, of the loads of the last
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, allow_negative_numbers = true)]
    pub load_factor: f64,
    /// Points along the path at least
    #[arg(long, value_name = "COUNT", default_value_t = 16, value_parser = crate::cli::progress_line::count)]
    pub points: usize,
    /// Stay on a path that becomes unstable (a column that stays straight) instead of taking the one that crosses it
    #[arg(long)]
    pub keep_branch: bool,
    /// Differentiate the last state by this number of the case, a JSON pointer such as /bladders/area_per_pressure_m2_per_pa;
    /// repeatable
    #[arg(long, value_name = "POINTER")]
    pub sensitivity: Vec<String>,
    /// Choose mesh so that the estimated relative error of every number is below this, such as 0.01
    #[arg(long, value_name = "REL", value_parser = crate::cli::progress_line::ratio)]
    pub accuracy: Option<f64>,
    /// Uncertain numbers.
    #[command(flatten)]
    pub uncertain: UncertainArguments,
    /// Its result.
    #[command(flatten)]
    pub result: ResultArguments,
    /// Print equilibrium.json instead of the table
    #[arg(long)]
    pub json: bool,
}

/// `modes`.
#[derive(Debug, Args)]
pub struct ModesArguments {
    /// The case.
    #[command(flatten)]
    pub case: CaseArguments,
    /// Modes to find; rigid motions and conserved volumes are listed in addition
    #[arg(long, value_name = "COUNT", default_value_t = 12, value_parser = crate::cli::progress_line::count)]
    pub count: usize,
    /// Find only modes of one kind
    #[arg(long, value_enum, value_name = "KIND", conflicts_with_all = ["map", "accuracy", "uncertain"])]
    pub kind: Option<ModeKind>,
    /// Find modes nearest this frequency [Hz] [default: the slowest]
    #[arg(long, value_name = "HZ", allow_negative_numbers = true, value_parser = crate::cli::progress_line::frequency)]
    pub near: Option<f64>,
    /// About the equilibrium under the loads at this instant [s] [default: about the start]
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true, value_parser = crate::cli::progress_line::instant)]
    pub at: Option<f64>,
    /// Differentiate frequencies and growth rates by this number of the case, a JSON pointer such as /beam/young_modulus_pa;
    /// repeatable
    #[arg(long, value_name = "POINTER")]
    pub sensitivity: Vec<String>,
    /// A map instead: that of `floquet`.
    #[command(flatten)]
    pub map: MapArguments,
    /// Choose mesh so that the estimated relative error of every number is below this, such as 0.01
    #[arg(long, value_name = "REL", conflicts_with = "map", value_parser = crate::cli::progress_line::ratio)]
    pub accuracy: Option<f64>,
    /// Uncertain numbers.
    #[command(flatten)]
    pub uncertain: UncertainArguments,
    /// Its result.
    #[command(flatten)]
    pub result: ResultArguments,
    /// Print modes.json instead of the table
    #[arg(long)]
    pub json: bool,
}
