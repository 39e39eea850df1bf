//! Output files of an ablation, `effects.csv`, `effects.json` and `effects.svg`, and its text.

mod picture;
mod table;

use super::folder::ResultFolder;
use crate::discrete::quantities::Interest;
use crate::error::Result;
use crate::results;
use crate::study::effects::Ablation;
use crate::study::effects::ablation::{ComparedRun, LARGEST};
use crate::study::effects::figure_change::ModelMeasure;

pub use picture::{Bar, bars};
pub use table::{csv, sentence, table};

/// One row per effect and quantity.
pub const CSV: &str = "effects.csv";
/// Complete result.
pub const JSON: &str = "effects.json";
/// Changes and work.
pub const PICTURE: &str = "effects.svg";

/// Quantity shown in bars and columns.
#[derive(Clone, Debug, PartialEq)]
pub enum ShownQuantity {
    /// A quantity of the full model.
    Quantity(String),
    /// For each effect the quantity that changes most.
    Largest,
}

impl ShownQuantity {
    /// Chooses the requested quantity. Without a request: the transverse displacement of the tip, else the axial one, else the largest
    /// change.
    pub fn choose(found: &Ablation, asked: Option<&str>) -> Self {
        let known = |name: &&str| found.measures.iter().any(|m| m.name == *name);
        let first = || {
            [Interest::TipU1, Interest::TipU3]
                .map(Interest::name)
                .into_iter()
                .find(known)
        };
        match asked.or_else(first) {
            Some(LARGEST) | None => Self::Largest,
            Some(name) => Self::Quantity(name.into()),
        }
    }

    /// Name of the quantity in text.
    pub fn describe(&self) -> &str {
        match self {
            Self::Quantity(name) => name,
            Self::Largest => "the quantity that changes most",
        }
    }

    /// Change of the quantity.
    pub fn change(&self, compared: &ComparedRun) -> Option<f64> {
        match self {
            Self::Quantity(name) => compared.changes.get(name).copied(),
            Self::Largest => compared.largest.as_ref().map(|l| l.1),
        }
    }

    /// Integrator's own error in the quantity; for [`Shown::Largest`] the smallest own error of all quantities.
    pub fn own(&self, found: &Ablation) -> Option<f64> {
        let own = |m: &ModelMeasure| m.own;
        match self {
            Self::Quantity(name) => found.measures.iter().find(|m| m.name == *name).and_then(own),
            Self::Largest => found.measures.iter().filter_map(own).reduce(f64::min),
        }
    }
}

/// Text of `effects.json`; numbers that are not finite are null.
pub fn json(found: &Ablation) -> String {
    results::text_with(found, Some(&sentence(found)))
}

/// Writes the files into a folder; other files in it stay.
pub fn write(folder: &mut ResultFolder, found: &Ablation, shown: &ShownQuantity) -> Result<()> {
    let files = [(CSV, csv(found)), (JSON, json(found))];
    folder.fill(files, [(PICTURE, picture::draw(found, shown))])
}
