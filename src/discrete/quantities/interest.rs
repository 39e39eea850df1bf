//! Quantities of interest: the results of a run in its summary.

use std::fmt;

use serde::{Deserialize, Serialize};

use super::observables::{Group, Observable};
use crate::discrete::extrema::MonitoredQuantity;

/// Source of a quantity of interest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InterestSource {
    /// Oscillating values, also between output times; of two, the one with the larger magnitude.
    Motion(&'static [MonitoredQuantity]),
    /// Sum of the energies of one group.
    Energy(Group),
    /// Efficiency: harvested energy over energy put in; in the window, over all energy spent in it.
    Efficiency,
}

/// Condition for the presence of a quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum When {
    Always,
    Wet,
    Turbines,
}

/// One row of the table.
struct Entry {
    name: &'static str,
    unit: &'static str,
    words: &'static str,
    source: InterestSource,
    columns: &'static [Observable],
    when: When,
}

macro_rules! interest {
    ($($id:ident: $name:literal [$unit:literal], $words:literal, $when:ident, $source:expr, $columns:expr;)*) => {
        /// A quantity of interest.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
        pub enum Interest {
            $(#[doc = $words] $id,)*
        }

        impl Interest {
            /// All quantities of interest.
            pub const ALL: &[Self] = &[$(Self::$id),*];

            fn entry(self) -> &'static Entry {
                &TABLE[self as usize]
            }
        }

        static TABLE: &[Entry] = &[$(Entry { name: $name, unit: $unit, words: $words, source: $source, columns: &$columns, when: When::$when }),*];
    };
}

// name [unit], words, condition, source, columns of the history from which it can also be computed
interest! {
    TipU1: "tip_u1_m" ["m"], "tip deflection", Always, InterestSource::Motion(&[MonitoredQuantity::Tip1]), [Observable::TipU1];
    TipU3: "tip_u3_m" ["m"], "axial tip displacement", Always, InterestSource::Motion(&[MonitoredQuantity::Tip3]), [Observable::TipU3];
    TipAngle: "tip_angle_rad" ["rad"], "tip angle", Always, InterestSource::Motion(&[MonitoredQuantity::Angle]), [Observable::TipAngle];
    MidspanU1: "midspan_u1_m" ["m"], "deflection in the middle", Always, InterestSource::Motion(&[MonitoredQuantity::Middle1]), [];
    LargestU1: "largest_u1_m" ["m"], "largest deflection", Always, InterestSource::Motion(&[MonitoredQuantity::Largest1]), [];
    LargestU3: "largest_u3_m" ["m"], "largest axial displacement", Always, InterestSource::Motion(&[MonitoredQuantity::Largest3]), [];
    MaxPressure: "max_pressure_pa" ["Pa"], "the largest pressure in size, above or below that around", Wet, InterestSource::Motion(&[MonitoredQuantity::High, MonitoredQuantity::Low]),
        [Observable::MaxPressure, Observable::MinPressure];
    InputEnergy: "input_energy_j" ["J"], "energy put in", Always, InterestSource::Energy(Group::PutIn), [];
    HarvestedEnergy: "harvested_energy_j" ["J"], "energy harvested", Turbines, InterestSource::Energy(Group::Harvested), [];
    Efficiency: "efficiency" ["1"], "efficiency", Turbines, InterestSource::Efficiency, [];
}

impl Interest {
    /// Name in the summary, unit included.
    pub fn name(self) -> &'static str {
        self.entry().name
    }

    /// Unit, `1` when dimensionless.
    pub fn unit(self) -> &'static str {
        self.entry().unit
    }

    /// Name used within a sentence.
    pub fn describe(self) -> &'static str {
        self.entry().words
    }

    /// Source of the quantity.
    pub fn source(self) -> InterestSource {
        self.entry().source
    }

    /// Columns of the history from which it can also be computed; of two, the one with the larger magnitude.
    pub fn columns(self) -> &'static [Observable] {
        self.entry().columns
    }

    /// Quantities of a run; the flags state the presence of fluid and of turbines.
    pub fn recorded([wet, turbines]: [bool; 2]) -> impl Iterator<Item = Self> {
        Self::ALL.iter().copied().filter(move |one| match one.entry().when {
            When::Always => true,
            When::Wet => wet,
            When::Turbines => turbines,
        })
    }

    /// Quantity of a given name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|one| one.name() == name)
    }
}

impl fmt::Display for Interest {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(self.name())
    }
}
