//! What of a case may be uncertain.

use clap::Args;

/// Numbers of the case that are uncertain.
#[derive(Clone, Debug, Args)]
pub struct UncertainArguments {
    /// How far the figures spread where a number of the case is uncertain, to first order and by samples: a JSON pointer and
    /// normal:MEAN:SD or uniform:LOW:HIGH in the unit of the key; repeatable
    #[arg(long, value_name = "POINTER=SPEC")]
    pub uncertain: Vec<String>,
    /// Samples, each of them computed
    #[arg(long, value_name = "COUNT", default_value_t = 64, requires = "uncertain", value_parser = crate::cli::line::count)]
    pub samples: usize,
    /// Sobol's indices as well, whose share of the variance is which number's: as many samples again, and as many more for each number
    #[arg(long, requires = "uncertain")]
    pub indices: bool,
    /// Seed of the samples
    #[arg(long, value_name = "NUMBER", default_value_t = 1, requires = "uncertain")]
    pub seed: u64,
    /// Samples at once [default: one a core]
    #[arg(long, value_name = "COUNT", requires = "uncertain", value_parser = crate::cli::line::count)]
    pub jobs: Option<usize>,
}
