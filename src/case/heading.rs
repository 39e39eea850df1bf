//! Headings of tables: `angle_deg`, `pressure [kPa]`, `volume (ml)`.

use super::separated;
use super::units::{self, Unit, UnitSuffix};
use crate::error::visible;

/// Name and unit of a column.
#[derive(Clone, Debug, PartialEq)]
pub struct Heading {
    /// Original text.
    pub heading: String,
    /// Name without the unit.
    pub name: String,
    /// Unit, if known.
    pub unit: Option<Unit>,
    /// Apparent unit that is not known.
    pub unknown: Option<String>,
    /// True if the unit is between brackets.
    bracketed: bool,
}

impl Heading {
    /// Parses a heading.
    pub fn parse(heading: &str) -> Self {
        Self::sought(heading, None)
    }

    /// Parses a heading; a known dimension `si` selects the meaning of an ambiguous end (`_n_m`, `_in`).
    fn sought(heading: &str, si: Option<&str>) -> Self {
        let brackets = in_brackets(heading);
        let column = |name: &str, unit, unknown: Option<&str>| Self {
            heading: heading.into(),
            name: name.into(),
            unit,
            unknown: unknown.map(String::from),
            bracketed: brackets.is_some(),
        };
        match &brackets {
            Some((name, unit)) => match units::bracketed(unit) {
                Some(known) => column(name, Some(known), None),
                None => column(name, None, Some(unit)),
            },
            None => match separated::suffix(heading, si) {
                UnitSuffix::Known(name, unit) => column(name, Some(unit), None),
                UnitSuffix::Unknown(name, unit) => column(name, None, Some(unit)),
                UnitSuffix::None => column(heading, None, None),
            },
        }
    }

    /// True if all cells of a line are numbers; such a line is not a heading.
    pub fn are_numbers<'c>(mut cells: impl Iterator<Item = &'c str> + Clone) -> bool {
        cells.clone().next().is_some() && cells.all(|cell| cell.trim().parse::<f64>().is_ok())
    }

    /// Factor from the unit of the column to the SI unit `si`; 1 without a unit. `what` names the quantity in messages.
    ///
    /// # Errors
    /// The heading names another dimension or an unknown unit.
    pub fn scale(&self, si: &str, what: &str) -> Result<f64, String> {
        let Self { unit, unknown, .. } = Self::sought(&self.heading, Some(si));
        let heading = visible(&self.heading);
        let known = || {
            let names: Vec<&str> = units::of_dimension(si).map(|unit| unit.name).collect();
            // a ratio of two units is no dimension of its own
            if names.is_empty() {
                si.to_owned()
            } else {
                names.join(", ")
            }
        };
        let remedy = || {
            let first = units::of_dimension(si).map(|unit| unit.name).nth(1).unwrap_or(si);
            format!("{} [{first}]", visible(&self.name))
        };
        if let Some(unknown) = unknown {
            let unknown = visible(&unknown);
            return Err(match self.bracketed {
                true => format!(
                    "the unit [{unknown}] of the column {heading} is not known; units of {what} are {}",
                    known()
                ),
                false => format!(
                    "the unit {unknown} at the end of {heading} is not known; units of {what} are {}, written as in {}",
                    known(),
                    remedy()
                ),
            });
        }
        match unit {
            None => Ok(1.0),
            Some(unit) if unit.si == si => Ok(unit.scale),
            Some(unit) => Err(format!(
                "the column {heading} is in {}, but {what} is in {}",
                unit.name,
                if si == "1" { "no unit".into() } else { known() }
            )),
        }
    }
}

/// Name and unit of a heading with a bracketed unit: any text in brackets at its end, or a known unit in brackets before the end.
fn in_brackets(heading: &str) -> Option<(String, String)> {
    let pairs = [('[', ']'), ('(', ')'), ('{', '}'), ('<', '>')];
    let whole = heading.trim_end();
    let last = pairs.into_iter().find_map(|(open, close)| {
        let (name, unit) = whole.strip_suffix(close)?.rsplit_once(open)?;
        Some((name.trim().to_owned(), unit.trim().to_owned()))
    });
    last.or_else(|| {
        pairs.into_iter().find_map(|(open, close)| {
            let (before, rest) = whole.split_once(open)?;
            let (unit, after) = rest.split_once(close)?;
            let known = units::bracketed(unit).is_some_and(|unit| unit.name != "1");
            known.then(|| (format!("{} {}", before.trim(), after.trim()), unit.trim().to_owned()))
        })
    })
}

#[cfg(test)]
mod tests {
    use super::Heading;

    #[test]
    fn brackets_and_ends_of_names_follow_one_rule() {
        let scale = |heading: &str, si| Heading::parse(heading).scale(si, "it");
        for (heading, si, factor) in [
            ("p_kpa", "Pa", 1e3),
            ("p [kPa]", "Pa", 1e3),
            ("p", "Pa", 1.0),
            ("pressure_in", "Pa", 1.0),
            ("q_n_mm", "N/m", 1e3),
            ("m_n_mm", "N m", 1e-3),
            ("opening (%)", "1", 0.01),
            ("opening_percent", "1", 0.01),
            ("p_torr", "Pa", 101_325.0 / 760.0),
            ("p [mmHg]", "Pa", 133.322_387_415),
            ("time (in ms)", "s", 1e-3),
            ("flow_ml_h", "m^3/s", 1e-6 / 3600.0),
            ("flow (mL/h)", "m^3/s", 1e-6 / 3600.0),
            ("p (kPa) of bladder 1", "Pa", 1e3),
            ("bladder (1) pressure", "Pa", 1.0),
            ("t {ms}", "s", 1e-3),
        ] {
            assert_eq!(scale(heading, si), Ok(factor), "{heading}");
        }
        for (heading, si, said) in [
            (
                "tip_in",
                "m",
                "the unit in at the end of tip_in is not known; units of it are m, cm, mm, um",
            ),
            ("tip [in]", "m", "the unit [in] of the column tip [in] is not known"),
            ("p_inhg", "Pa", "the unit inhg at the end"),
            (
                "flow_ml_s",
                "Pa",
                "the column flow_ml_s is in ml/s, but it is in Pa, kPa",
            ),
            ("x_n_s_m", "m", "the unit n_s_m at the end"),
        ] {
            let found = scale(heading, si).expect_err(heading);
            assert!(found.contains(said), "{found}");
        }
    }
}
