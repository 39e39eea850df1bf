//! Arguments of a map, for the two commands that draw one.

use clap::Args;

/// A map of where a shaken beam is stable.
#[derive(Clone, Debug, Args)]
pub struct MapArguments {
    /// Map growth over these two parameters of a root that is shaken along the beam: frequency,amplitude
    #[arg(long, value_name = "PARAMETERS")]
    pub map: Option<String>,
    /// Ranges of the map: Hz from:to, m from:to [default: 0.6 to 1.6 of the case's frequency, up to 1.5 of its amplitude]
    #[arg(long, value_name = "FROM:TO,FROM:TO", requires = "map")]
    pub range: Option<String>,
    /// Points of the map along each parameter
    #[arg(long, value_name = "COUNT,COUNT", default_value = "21,12", requires = "map")]
    pub points: String,
    /// Permeability factors of the map, a panel each
    #[arg(
        long,
        value_name = "LIST",
        value_delimiter = ',',
        default_value = "1,0.01",
        requires = "map"
    )]
    pub permeability: Vec<f64>,
}
