//! Arguments of `sweep` and `merge`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::{PlaceArguments, ResultArguments};
use crate::cli::response::{DEFAULT_BAND, check_band, each_frequency, each_once};
use crate::error::{Result, usage};
use crate::study::analysis::{AnalysisKind, ResponseAnalysis};
use crate::study::sweep::Shard;

/// Commands that a design can go through.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum DesignCommand {
    /// A run in time
    Run,
    /// The steady cycle
    Periodic,
    /// The static equilibrium
    Equilibrium,
    /// Small motions
    Modes,
    /// Gaps between the waves of repeating cells
    Bands,
    /// Peaks and values of the frequency response from --input to --output
    Response,
}

/// `--command` with the options of a response.
#[derive(Clone, Debug, Args)]
pub struct AnalysisArguments {
    /// Analysis of every design
    #[arg(long, value_enum, default_value_t = DesignCommand::Run)]
    pub command: DesignCommand,
    /// Input of --command response: the JSON pointer of a signal of the case, such as /ends/root/clamped/u1_m
    #[arg(long, value_name = "POINTER")]
    pub input: Option<String>,
    /// Output of --command response: a quantity or a probe, such as tip_u1; repeatable
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    pub output: Vec<String>,
    /// First frequency [Hz] of the band in which --command response finds peaks [default: 1]
    #[arg(long, value_name = "HZ", allow_negative_numbers = true, value_parser = crate::cli::progress_line::frequency)]
    pub from: Option<f64>,
    /// Last frequency of this band [Hz] [default: 200]
    #[arg(long, value_name = "HZ", allow_negative_numbers = true, value_parser = crate::cli::progress_line::frequency)]
    pub to: Option<f64>,
    /// Frequency [Hz] at which --command response gives amplitude and phase; repeatable
    #[arg(long, value_name = "HZ", value_delimiter = ',', allow_negative_numbers = true, value_parser = crate::cli::progress_line::frequency)]
    pub frequency: Vec<f64>,
}

impl AnalysisArguments {
    /// The requested analysis.
    ///
    /// # Errors
    /// [`Error::Usage`]: options of a response for another analysis, a response without input or output, or frequencies that are not
    /// positive.
    pub fn analysis(&self) -> Result<AnalysisKind> {
        Ok(match self.command {
            DesignCommand::Response => AnalysisKind::Response(self.response()?),
            other => {
                let given = [
                    ("--input", self.input.is_some()),
                    ("--output", !self.output.is_empty()),
                    ("--from", self.from.is_some()),
                    ("--to", self.to.is_some()),
                    ("--frequency", !self.frequency.is_empty()),
                ];
                if let Some((option, _)) = given.iter().find(|(_, given)| *given) {
                    return usage(format!("{option} is an option of --command response only"));
                }
                match other {
                    DesignCommand::Periodic => AnalysisKind::Periodic,
                    DesignCommand::Equilibrium => AnalysisKind::Equilibrium,
                    DesignCommand::Modes => AnalysisKind::Modes,
                    DesignCommand::Bands => AnalysisKind::Bands,
                    _ => AnalysisKind::Run,
                }
            }
        })
    }

    fn response(&self) -> Result<ResponseAnalysis> {
        let Some(input) = self.input.clone().filter(|_| !self.output.is_empty()) else {
            let what = "--command response needs --input POINTER, a signal of the case such as /ends/root/clamped/u1_m, and \
                        --output NAME, such as tip_u1";
            return usage(what);
        };
        let [first, last] = DEFAULT_BAND;
        let [from, to] = [self.from.unwrap_or(first), self.to.unwrap_or(last)];
        check_band([from, to], 2, from < to, "below")?;
        Ok(ResponseAnalysis {
            input,
            outputs: each_once(&self.output),
            band: [from, to],
            frequencies: each_frequency(&self.frequency)?,
        })
    }
}

/// Who starts the jobs of a script.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Script {
    /// A job array of Slurm
    Slurm,
    /// GNU parallel
    Parallel,
}

/// `sweep`.
#[derive(Debug, Args)]
pub struct SweepArguments {
    /// Case files (JSON): one, or several that are compared in every design; - is standard input
    #[arg(required = true, value_name = "CASE")]
    pub cases: Vec<PathBuf>,
    /// Vary a value of the case, repeatable: a JSON pointer and its values, such as /solver/rtol=1e-4,1e-5, /beam/length_m=lin:0.1:0.2:5,
    /// /network/permeability_factor=log:0.01:1:25, or drawn: =uniform:LOW:HIGH, =normal:MEAN:SD; texts
    /// stand in double quotes: '/effects/tube_inertia="on","off"'
    #[arg(long, value_name = "POINTER=SPEC", allow_hyphen_values = true)]
    pub vary: Vec<String>,
    /// Designs from a CSV file: columns are JSON pointers, rows are designs
    #[arg(long, value_name = "FILE.csv", conflicts_with_all = ["vary", "design"])]
    pub designs: Option<PathBuf>,
    /// Analysis of every design.
    #[command(flatten)]
    pub analysis: AnalysisArguments,
    /// Sampling of designs with drawn values: latin:N or sobol:N; grid: all combinations of values
    #[arg(long, value_name = "grid|latin:N|sobol:N", default_value = "grid")]
    pub design: String,
    /// Seed of other drawn designs [default: 1 for latin; sobol without a seed]
    #[arg(long, value_name = "N")]
    pub seed: Option<u64>,
    /// Change a value of all cases, repeatable: a JSON pointer and a JSON value, such as /solver/rtol=1e-7
    #[arg(long = "set", value_name = "POINTER=JSON")]
    pub sets: Vec<String>,
    /// Choose mesh and tolerance of every design so that the estimated relative error of every number is below this, such as 0.01
    #[arg(long, value_name = "REL", value_parser = crate::cli::progress_line::ratio)]
    pub accuracy: Option<f64>,
    /// Omit mesh errors of cycles, equilibria and modes; the sweep then takes a third of the time
    #[arg(long)]
    pub no_mesh_errors: bool,
    /// Designs computed at once [default: one for every core]
    #[arg(long, value_name = "N", value_parser = crate::cli::progress_line::count)]
    pub jobs: Option<usize>,
    /// Compute a part alone, such as 2/8: the second of eight; `slcbeam merge` joins them
    #[arg(long, value_name = "I/N", value_parser = Shard::parse)]
    pub shard: Option<Shard>,
    /// Print a script that computes the sweep in shards, and compute nothing
    #[arg(long, value_enum, conflicts_with_all = ["shard", "restart", "retry"])]
    pub script: Option<Script>,
    /// Shards of the script
    #[arg(long, value_name = "N", default_value_t = 8, requires = "script", value_parser = crate::cli::progress_line::count)]
    pub shards: usize,
    /// Tables alone: no pictures and no page, neither of the sweep nor of designs
    #[arg(long)]
    pub lean: bool,
    /// Keep the case of every design, cases/NNNNN.json
    #[arg(long)]
    pub keep_cases: bool,
    /// Keep the result folder of every design, designs/NNNNN, of runs
    #[arg(long)]
    pub keep_folders: bool,
    /// Compute missing designs, as the same command always does, and repeat designs that did not finish
    #[arg(long, conflicts_with = "restart")]
    pub retry: bool,
    /// Start again if the folder contains another sweep, or a part of this one
    #[arg(long)]
    pub restart: bool,
    /// Its result.
    #[command(flatten)]
    pub result: ResultArguments,
    /// Print sweep.json instead of the text
    #[arg(long)]
    pub json: bool,
}

/// `merge`.
#[derive(Debug, Args)]
pub struct MergeArguments {
    /// Folders of shards
    #[arg(required = true, value_name = "DIR")]
    pub parts: Vec<PathBuf>,
    /// Folder of the whole sweep, if not out/<case name>-sweep.
    #[command(flatten)]
    pub place: PlaceArguments,
    /// Tables alone: no pictures and no page
    #[arg(long)]
    pub lean: bool,
    /// No progress; merging shows none
    #[arg(long)]
    pub quiet: bool,
    /// Print sweep.json instead of the text
    #[arg(long)]
    pub json: bool,
}
