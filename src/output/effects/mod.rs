//! What an ablation leaves behind: `effects.csv`, `effects.json`, `effects.svg`, and its words.

mod table;

use std::path::PathBuf;

use super::folder::ResultFolder;
use super::plot::ablation::{self, AblationBars, Bar};
use crate::case::schema::Effect;
use crate::discrete::quantities::Interest;
use crate::error::Result;
use crate::results;
use crate::study::effects::ablation::{Compared, LARGEST};
use crate::study::effects::change::Measure;
use crate::study::effects::{Ablation, Verdict};

pub use table::{csv, sentence, table};

/// One row an effect and quantity.
pub const CSV: &str = "effects.csv";
/// Everything.
pub const JSON: &str = "effects.json";
/// Changes and work.
pub const PICTURE: &str = "effects.svg";

/// What bars and columns show: a quantity, or of each effect the one that changes most.
#[derive(Clone, Debug, PartialEq)]
pub enum Shown {
    /// A quantity of the full model.
    Quantity(String),
    /// The one that changes most.
    Largest,
}

impl Shown {
    /// What was asked for; by default the deflection of the tip, else how far it moves along.
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

    /// In words.
    pub fn words(&self) -> &str {
        match self {
            Self::Quantity(name) => name,
            Self::Largest => "the quantity that changes most",
        }
    }

    /// Its change.
    pub fn change(&self, compared: &Compared) -> Option<f64> {
        match self {
            Self::Quantity(name) => compared.changes.get(name).copied(),
            Self::Largest => compared.largest.as_ref().map(|l| l.1),
        }
    }

    /// The integrator's own error in it: the least of all where no quantity is named.
    pub fn own(&self, found: &Ablation) -> Option<f64> {
        let own = |m: &Measure| m.own;
        match self {
            Self::Quantity(name) => found.measures.iter().find(|m| m.name == *name).and_then(own),
            Self::Largest => found.measures.iter().filter_map(own).reduce(f64::min),
        }
    }
}

/// The text of `effects.json`; what is not finite is null.
pub fn json(found: &Ablation) -> String {
    results::told(found, Some(&sentence(found)))
}

/// Writes the files into a folder; others in it stay.
pub fn write(folder: &mut ResultFolder, found: &Ablation, shown: &Shown) -> Result<Vec<PathBuf>> {
    let mut files = vec![(CSV, csv(found)), (JSON, json(found))];
    files.extend(ablation::draw(&bars(found, shown)).map(|text| (PICTURE, text)));
    folder.fill(files)
}

/// The picture's data.
pub fn bars(found: &Ablation, shown: &Shown) -> AblationBars {
    let bar = |name: &str, compared: &Compared, verdict: Option<Verdict>| Bar {
        name: name.into(),
        change: shown.change(compared),
        largest: compared.largest.as_ref().map(|l| l.1),
        work: compared.work,
        verdict,
    };
    let mut bars: Vec<Bar> = vec![];
    for row in &found.rows {
        let name = match row.without.as_slice() {
            [] => row.name.to_string(),
            others => format!("{} (no {})", row.name, Effect::names(others, ", ")),
        };
        bars.extend(row.left_out.as_ref().map(|c| bar(&name, c, Some(row.verdict))));
    }
    bars.extend(table::beside(found).map(|(name, c)| bar(name, c, None)));
    AblationBars {
        case: found.case.clone(),
        measure: shown.words().into(),
        tolerance: found.tolerance,
        own: shown.own(found),
        bars,
    }
}
