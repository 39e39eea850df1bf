//! Positions of quantities: `tip`, `bladder 3`, `port inlet`, the name of a probe, or a share of the beam's length.

use crate::case::bladder_numbers;
use crate::case::schema::{Case, Probe};
use crate::case::spans;
use crate::case::wiring::bladder_index;
use crate::discrete::quantities::stations;
use crate::error::{Error, Result};

/// Name of a column at a position, and the probe that it requires.
#[derive(Clone, Debug, PartialEq)]
pub struct QuantityAtPlace {
    /// Name of the column, with its unit if that was given.
    pub name: String,
    /// Probe that the case lacks.
    pub probe: Option<Probe>,
}

/// Accepted positions, for messages.
const WANTED: &str = "a share of the length from 0 to 1, tip, the name of a probe, `bladder 3`, `port NAME`, \
                      `accumulator NAME` or `contact NAME`";

/// Returns the column of a quantity at a position.
///
/// # Errors
/// [`Error::Usage`]: the case has no such position, or the quantity does not exist there.
pub fn parse_place(case: &Case, quantity: &str, place: &str) -> Result<QuantityAtPlace> {
    let wrong = |what: String| Error::Usage(format!("--match ..={quantity}@{place}: {what}"));
    let placed = |begin: &str, probe| QuantityAtPlace {
        name: format!("{begin}_{quantity}"),
        probe,
    };
    let place = place.trim();
    if case.is_structure() {
        return in_structure(case, quantity, place).map_err(wrong);
    }
    if place == "tip" || case.probes.iter().any(|probe| probe.name == place) {
        return Ok(placed(place, None));
    }
    if let Ok(at) = place.parse::<f64>() {
        if !(0.0..=1.0).contains(&at) {
            return Err(wrong(format!(
                "{at} is not a share of the length (0 at the root to 1 at the tip)"
            )));
        }
        let probe = at_place(case, at);
        return Ok(placed(&probe.name.clone(), missing(case, probe)));
    }
    let (kind, name) = place.split_once(char::is_whitespace).unwrap_or((place, ""));
    match kind {
        "bladder" => of_bladder(case, quantity, name.trim()).map_err(wrong),
        "port" | "accumulator" | "contact" => Ok(placed(&stations::begin(kind, name.trim()), None)),
        _ => {
            let names = case.probes.iter().map(|probe| probe.name.as_str()).chain(["tip"]);
            let meant =
                crate::case::nearest(place, names).map_or(String::new(), |meant| format!("; nearest is {meant}"));
            Err(wrong(format!(
                "the case has no place {place}{meant}. Expected {WANTED}"
            )))
        }
    }
}

/// Returns the column of a quantity at a place of a structure, which has no place without the name of a beam.
fn in_structure(case: &Case, quantity: &str, place: &str) -> std::result::Result<QuantityAtPlace, String> {
    let kind = place.split_once(char::is_whitespace);
    let column = |begin: &str| QuantityAtPlace {
        name: format!("{begin}_{quantity}"),
        probe: None,
    };
    if let Some((kind, name)) = kind.filter(|(kind, _)| ["port", "accumulator", "contact"].contains(kind)) {
        return Ok(column(&stations::begin(kind, name.trim())));
    }
    let places: Vec<String> = case
        .beams
        .iter()
        .flat_map(|beam| {
            let probes = beam.probes.iter().map(|probe| probe.name.as_str());
            ["tip"]
                .into_iter()
                .chain(probes)
                .map(|place| format!("{}.{place}", beam.name))
        })
        .collect();
    match places.iter().any(|known| known == place) {
        true => Ok(column(place)),
        false => Err(format!(
            "the case is a structure without the place {place}. Places are {}, `port NAME`, `accumulator NAME` and `contact NAME`; \
             probes of its beams add others",
            places.join(", ")
        )),
    }
}

/// Returns the column of the pressure of a bladder, which is the pressure at its middle.
fn of_bladder(case: &Case, quantity: &str, label: &str) -> std::result::Result<QuantityAtPlace, String> {
    let Some(bladders) = &case.bladders else {
        return Err("the case has no bladders".into());
    };
    let count = bladders.per_row;
    let number = label.replace('−', "-").parse::<i64>().ok();
    let there = |n: &i64| bladder_index(*n, count).is_some_and(|bladder| spans::has_bladder(case, bladder));
    let Some(number) = number.filter(there) else {
        return Err(match number {
            Some(number) => bladder_numbers::missing(case, number),
            None => format!(
                "no such bladder. The case has bladders {}",
                bladder_numbers::existing(case)
            ),
        });
    };
    let end = match quantity {
        "pressure" | "pressure_pa" => ["pressure_lower", "pressure_upper"][usize::from(number > 0)],
        _ => return Err("a bladder only has the quantity pressure".into()),
    };
    let at = (number.unsigned_abs() as f64 - 0.5) / count as f64;
    let probe = at_place(case, at);
    Ok(QuantityAtPlace {
        name: format!("{}_{end}", probe.name),
        probe: missing(case, probe),
    })
}

/// Returns the probe of the case at a position, or a new one named after the position.
fn at_place(case: &Case, at: f64) -> Probe {
    let there = case.probes.iter().find(|probe| (probe.at - at).abs() < 1e-12);
    there.cloned().unwrap_or_else(|| Probe {
        name: format!(
            "at-{}",
            format!("{at:.6}")
                .trim_end_matches('0')
                .replace('.', "-")
                .trim_end_matches('-')
        ),
        at,
    })
}

fn missing(case: &Case, probe: Probe) -> Option<Probe> {
    (!case.probes.contains(&probe)).then_some(probe)
}
