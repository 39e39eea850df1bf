//! Quantities of interest: what the summary tells of a whole run.

use std::fmt;

use serde::{Deserialize, Serialize};

use super::observables::{Group, Observable};
use crate::discrete::glance::Watched;

/// What a quantity of interest follows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// Values that swing, between output times too; of two the larger in size.
    Motion(&'static [Watched]),
    /// Energies of one group, together.
    Energy(Group),
    /// The energy harvested over what was put in; in the window, over all that was spent in it.
    Efficiency,
}

/// What a quantity needs to be there.
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
    source: Source,
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
            /// All of them.
            pub const ALL: &[Self] = &[$(Self::$id),*];

            fn entry(self) -> &'static Entry {
                &TABLE[self as usize]
            }
        }

        static TABLE: &[Entry] = &[$(Entry { name: $name, unit: $unit, words: $words, source: $source, columns: &$columns, when: When::$when }),*];
    };
}

// name [unit], what it is called, when it is there, what it follows, columns of the history from which it can be told as well
interest! {
    TipU1: "tip_u1_m" ["m"], "tip deflection", Always, Source::Motion(&[Watched::Tip1]), [Observable::TipU1];
    TipU3: "tip_u3_m" ["m"], "axial tip displacement", Always, Source::Motion(&[Watched::Tip3]), [Observable::TipU3];
    TipAngle: "tip_angle_rad" ["rad"], "tip angle", Always, Source::Motion(&[Watched::Angle]), [Observable::TipAngle];
    MidspanU1: "midspan_u1_m" ["m"], "deflection in the middle", Always, Source::Motion(&[Watched::Middle1]), [];
    LargestU1: "largest_u1_m" ["m"], "largest deflection", Always, Source::Motion(&[Watched::Largest1]), [];
    LargestU3: "largest_u3_m" ["m"], "largest axial displacement", Always, Source::Motion(&[Watched::Largest3]), [];
    MaxPressure: "max_pressure_pa" ["Pa"], "the largest pressure in size, above or below that around", Wet, Source::Motion(&[Watched::High, Watched::Low]),
        [Observable::MaxPressure, Observable::MinPressure];
    InputEnergy: "input_energy_j" ["J"], "energy put in", Always, Source::Energy(Group::PutIn), [];
    HarvestedEnergy: "harvested_energy_j" ["J"], "energy harvested", Turbines, Source::Energy(Group::Harvested), [];
    Efficiency: "efficiency" ["1"], "efficiency", Turbines, Source::Efficiency, [];
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

    /// What it is called within a sentence.
    pub fn words(self) -> &'static str {
        self.entry().words
    }

    /// What it follows.
    pub fn source(self) -> Source {
        self.entry().source
    }

    /// Columns of the history from which it can be told as well; of two the larger in size.
    pub fn columns(self) -> &'static [Observable] {
        self.entry().columns
    }

    /// Those of a run: `has` tells whether there is fluid, and whether there are turbines.
    pub fn of([wet, turbines]: [bool; 2]) -> impl Iterator<Item = Self> {
        Self::ALL.iter().copied().filter(move |one| match one.entry().when {
            When::Always => true,
            When::Wet => wet,
            When::Turbines => turbines,
        })
    }

    /// That of a name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|one| one.name() == name)
    }
}

impl fmt::Display for Interest {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(self.name())
    }
}
