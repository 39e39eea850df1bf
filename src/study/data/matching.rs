//! `COLUMN=QUANTITY[@PLACE]`: which column of a result a measured column is beside.

use serde::{Deserialize, Serialize};

use super::places;
use super::table::Table;
use crate::case::nearest;
use crate::case::schema::Case;
use crate::case::units::suffixed;
use crate::discrete::quantities::probes;
use crate::error::{Error, Result, listed};

/// What was asked for.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Match {
    /// Column of the data.
    pub column: String,
    /// Quantity of the result, with or without its unit.
    pub quantity: String,
    /// Where, as far as it was told.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub place: Option<String>,
}

impl Match {
    /// Of `COLUMN=QUANTITY[@PLACE]`.
    ///
    /// # Errors
    /// [`Error::Usage`] with what is wanted.
    pub fn parse(text: &str) -> Result<Self> {
        let wanted = || {
            let what = "COLUMN=QUANTITY[@PLACE] is wanted, such as angle_deg=tip_angle or p_kpa=pressure@'bladder 3'";
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

    /// As it is asked for.
    pub fn words(&self) -> String {
        let place = self.place.as_ref().map_or(String::new(), |place| format!("@{place}"));
        format!("{}={}{place}", self.column, self.quantity)
    }

    /// The name of the result's column, with its unit where that was given; a probe that this needs is put into the case.
    ///
    /// # Errors
    /// [`Error::Usage`]: there is no such place.
    pub fn placed(&self, case: &mut Case) -> Result<String> {
        let Some(place) = &self.place else {
            return Ok(self.quantity.clone());
        };
        let placed = places::of(case, &self.quantity, place)?;
        case.probes.extend(placed.probe);
        Ok(placed.name)
    }
}

/// A measured column beside a column of results.
#[derive(Clone, Debug, PartialEq)]
pub struct Matched {
    /// As it was asked for.
    pub asked: Match,
    /// Column of the table.
    pub column: usize,
    /// Column of the result.
    pub index: usize,
    /// Its name without unit.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// How many of that unit one of the column's is.
    pub scale: f64,
    /// The values in the result's unit; nothing where none was measured.
    pub values: Vec<Option<f64>>,
}

impl Matched {
    /// Name with unit, as keys of results have it.
    pub fn key(&self) -> String {
        probes::key(&self.name, &self.unit)
    }
}

/// Name without unit, and unit, of a column of a result.
pub type Named = (String, String);

/// Finds the columns of matches among those of a result; `names` are theirs by [`Match::placed`].
///
/// # Errors
/// [`Error::Usage`] for columns and quantities that are not there, units that do not match, two matches of one column, a column without a
/// number; [`Error::Case`] for cells that are none.
pub fn resolve(table: &Table, matches: &[Match], names: &[String], columns: &[Named]) -> Result<Vec<Matched>> {
    if matches.is_empty() {
        let what = "nothing to compare: --match COLUMN=QUANTITY[@PLACE], such as angle_deg=tip_angle";
        return Err(Error::Usage(what.into()));
    }
    let mut found: Vec<Matched> = vec![];
    for (asked, name) in matches.iter().zip(names) {
        let wrong = |what: String| Error::Usage(format!("--match {}: {what}", asked.words()));
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
            return Err(wrong(format!("the column {} holds no number", asked.column)));
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

/// What there is, where nothing is near; of very many the first.
fn available(columns: &[Named]) -> String {
    let names = columns.iter().map(|(name, _)| name.as_str());
    format!(
        "; there are {}",
        listed(names.filter(|name| !["t", "load_factor"].contains(name)))
    )
}

/// The column of a name, with or without its unit.
fn find(columns: &[Named], name: &str) -> Option<usize> {
    let plain = columns.iter().position(|(own, _)| own == name);
    plain.or_else(|| {
        columns.iter().position(|(own, unit)| {
            let keyed = suffixed(name).is_some_and(|(rest, of)| rest == own && of.si == unit && of.name == of.si);
            keyed || probes::key(own, unit) == name
        })
    })
}
