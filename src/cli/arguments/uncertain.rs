//! Arguments for uncertain numbers of a case.

use std::ffi::OsString;

use clap::Args;
use clap::error::{ContextKind, ContextValue, ErrorKind};

use crate::error::Error;

/// Numbers of the case that are uncertain.
#[derive(Clone, Debug, Args)]
pub struct UncertainArguments {
    /// Spread of the figures due to an uncertain number of the case, to first order and by samples: a JSON pointer and
    /// normal:MEAN:SD or uniform:LOW:HIGH in the unit of the key; repeatable
    #[arg(long, value_name = "POINTER=SPEC")]
    pub uncertain: Vec<String>,
    /// Samples, each of them computed
    #[arg(long, value_name = "COUNT", default_value_t = 64, requires = "uncertain", value_parser = crate::cli::progress_line::count)]
    pub samples: usize,
    /// Also compute Sobol's indices, the share of each number in the variance; needs --samples more runs, and as many again for each number
    #[arg(long, requires = "uncertain")]
    pub indices: bool,
    /// Seed of the samples
    #[arg(long, value_name = "NUMBER", default_value_t = 1, requires = "uncertain")]
    pub seed: u64,
    /// Samples at once [default: one a core]
    #[arg(long, value_name = "COUNT", requires = "uncertain", value_parser = crate::cli::progress_line::count)]
    pub jobs: Option<usize>,
}

/// Alternatives, by commands that do not accept `--uncertain`.
const INSTEAD: [(&str, &str); 6] = [
    (
        "optimize",
        "for the optimum, use its case in the result: `slcbeam run DIR/optimum-case.json --uncertain ..`, or the \
         command that --command names",
    ),
    (
        "fit",
        "use the fitted numbers and their standard errors: `slcbeam run DIR/fitted-case.json --uncertain \
         POINTER=normal:VALUE:STANDARD_ERROR`",
    ),
    (
        "sense",
        "its result contains bands of the loads by the noise of pressures; for uncertain numbers of the case, repeat \
         the command with --set at both ends of their ranges",
    ),
    (
        "sweep",
        "--vary POINTER=normal:MEAN:SD --design sobol:64 draws designs; for one design: `slcbeam run CASE --set .. \
         --uncertain ..`",
    ),
    (
        "study",
        "use `slcbeam run CASE --uncertain ..` with the mesh and tolerance that the study recommends",
    ),
    (
        "effects",
        "use `slcbeam run CASE --uncertain ..` with the omitted effects set to \"off\"",
    ),
];

/// Error of a command line with `--uncertain` for a command that does not accept it, with an alternative; none for other faults.
pub fn elsewhere(words: &[OsString], answer: &clap::Error) -> Option<Error> {
    let unknown = matches!(answer.get(ContextKind::InvalidArg), Some(ContextValue::String(text)) if text.starts_with("--uncertain"));
    if answer.kind() != ErrorKind::UnknownArgument || !unknown {
        return None;
    }
    let command = words.get(1)?.to_string_lossy();
    let goes = "--uncertain is an option of run, equilibrium, modes, response, periodic and floquet";
    let instead = INSTEAD.iter().find(|(own, _)| *own == command);
    Some(Error::Usage(match instead {
        Some((_, instead)) => format!("{goes}, not of {command}; {instead}"),
        None => format!("{goes}, not of {command}"),
    }))
}
