//! `COLUMN=QUANTITY[@PLACE]`: assigns a measured column to a column of a result.

use serde::{Deserialize, Serialize};

use super::places;
use super::table::DataTable;
use crate::case::nearest;
use crate::case::schema::Case;
use crate::case::units::suffixed;
use crate::discrete::quantities::probes;
use crate::error::{Error, Result, listed};

/// Requested assignment of a measured column.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Match {
    /// Column of the data.
    pub column: String,
    /// Quantity of the result, with or without its unit.
    pub quantity: String,
    /// Position, if given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub place: Option<String>,
}

impl Match {
    /// Parses `COLUMN=QUANTITY[@PLACE]`.
    ///
    /// # Errors
    /// [`Error::Usage`] with the expected form.
    pub fn parse(text: &str) -> Result<Self> {
        let wanted = || {
            let what = "expected COLUMN=QUANTITY[@PLACE], such as angle_deg=tip_angle or p_kpa=pressure@'bladder 3'";
            Error::Usage(format!("--match '{text}': {what}"))
        };
        let (column, quantity) = text.rsplit_once('=').ok_or_else(wanted)?;
        let (quantity, place) = match quantity.split_once('@') {
            Some((quantity, place)) => (quantity, Some(place.trim().to_owned())),
            None => (quantity, None),
        };
        let [column, quantity] = [column, quantity].map(|part| part.trim().to_owned());
        if column.is_empty() || quantity.is_empty() || place.as_ref().is_some_and(String::is_empty) {
            return Err(wanted());
        }
        Ok(Self {
            column,
            quantity,
            place,
        })
    }

    /// Formats the assignment as on the command line.
    pub fn describe(&self) -> String {
        let place = self.place.as_ref().map_or(String::new(), |place| format!("@{place}"));
        format!("{}={}{place}", self.column, self.quantity)
    }

    /// Returns the name of the result's column, with its unit if that was given. Adds the probe that the column needs
    /// to the case.
    ///
    /// # Errors
    /// [`Error::Usage`] if there is no such position.
    pub fn placed(&self, case: &mut Case) -> Result<String> {
        let Some(place) = &self.place else {
            return Ok(self.quantity.clone());
        };
        let placed = places::parse_place(case, &self.quantity, place)?;
        case.probes.extend(placed.probe);
        Ok(placed.name)
    }
}

/// Measured column assigned to a column of results.
#[derive(Clone, Debug, PartialEq)]
pub struct Matched {
    /// Requested assignment.
    pub asked: Match,
    /// Index of the column in the table.
    pub column: usize,
    /// Index of the column in the result.
    pub index: usize,
    /// Name of the result's column, without unit.
    pub name: String,
    /// Unit of the result's column.
    pub unit: String,
    /// Factor from the unit of the measured column to that of the result.
    pub scale: f64,
    /// Measured values in the unit of the result; `None` for empty cells.
    pub values: Vec<Option<f64>>,
}

impl Matched {
    /// Name with unit, as in keys of results.
    pub fn key(&self) -> String {
        probes::key(&self.name, &self.unit)
    }
}

/// Name without unit, and unit, of a column of a result.
pub type Named = (String, String);

/// Finds the columns of assignments among those of a result; `names` are the names returned by [`Match::placed`].
///
/// # Errors
/// [`Error::Usage`] for unknown columns and quantities, units that do not match, two matches of one column, a column
/// without numbers; [`Error::Case`] for cells that are not numbers.
pub fn resolve(table: &DataTable, matches: &[Match], names: &[String], columns: &[Named]) -> Result<Vec<Matched>> {
    if matches.is_empty() {
        let what = "nothing to compare. Use --match COLUMN=QUANTITY[@PLACE], such as angle_deg=tip_angle";
        return Err(Error::Usage(what.into()));
    }
    let mut found: Vec<Matched> = vec![];
    for (asked, name) in matches.iter().zip(names) {
        let wrong = |what: String| Error::Usage(format!("--match {}: {what}", asked.describe()));
        let column = table.wanted(&asked.column, "--match")?;
        let index = find(columns, name).ok_or_else(|| {
            let known = columns.iter().map(|(name, _)| name.as_str());
            let meant = nearest(name, known.clone()).or_else(|| {
                let plain = suffixed(name).map_or(name.as_str(), |(plain, _)| plain);
                let whole = known.clone().find(|known| known.ends_with(&format!("_{plain}")));
                whole.map(str::to_owned).or_else(|| nearest(plain, known))
            });
            let meant = meant.map_or_else(|| available(columns), |meant| format!("; nearest is {meant}"));
            wrong(format!("the result has no quantity {name}{meant}"))
        })?;
        let (name, unit) = &columns[index];
        if found.iter().any(|other| other.column == column) {
            return Err(wrong(format!("the column {} is matched twice", asked.column)));
        }
        if found.iter().any(|other| other.index == index) {
            return Err(wrong(format!("{name} is matched twice")));
        }
        let scale = table.scale(column, unit, name)?;
        let values = table.numbers(column, scale)?;
        if values.iter().all(Option::is_none) {
            return Err(wrong(format!("the column {} contains no number", asked.column)));
        }
        found.push(Matched {
            asked: asked.clone(),
            column,
            index,
            name: name.clone(),
            unit: unit.clone(),
            scale,
            values,
        });
    }
    Ok(found)
}

/// Lists the available columns, only the first of very many.
fn available(columns: &[Named]) -> String {
    let names = columns.iter().map(|(name, _)| name.as_str());
    format!(
        "; there are {}",
        listed(names.filter(|name| !["t", "load_factor"].contains(name)))
    )
}

/// Index of the column of a name, with or without its unit.
fn find(columns: &[Named], name: &str) -> Option<usize> {
    let plain = columns.iter().position(|(own, _)| own == name);
    plain.or_else(|| {
        columns.iter().position(|(own, unit)| {
            let keyed = suffixed(name).is_some_and(|(rest, of)| rest == own && of.si == unit && of.name == of.si);
            keyed || probes::key(own, unit) == name
        })
    })
}
