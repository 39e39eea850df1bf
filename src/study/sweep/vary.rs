//! `POINTER=SPEC`: the values of one number of the case.

use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::case::{amounts, short, unknown};
use crate::error::{Error, Result};
use crate::numerics::normal::quantile;

/// Largest number of values of one axis.
pub const MOST_VALUES: usize = 1_000_000;

/// Varied number, and its values.
#[derive(Clone, Debug, PartialEq)]
pub struct VariedNumber {
    /// JSON pointer into the case.
    pub pointer: String,
    /// Specification, as typed.
    pub spec: String,
    /// Its values.
    pub values: VariedValues,
}

/// Values of one number.
#[derive(Clone, Debug, PartialEq)]
pub enum VariedValues {
    /// Listed values, in their order.
    Listed(Vec<Value>),
    /// Uniform distribution between two bounds.
    Uniform(f64, f64),
    /// Normal distribution with mean and standard deviation.
    Normal(f64, f64),
}

/// Sampling of designs from distributions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Draw {
    /// All combinations of listed values; nothing is drawn.
    #[default]
    Grid,
    /// Number of designs of a Latin hypercube: each of as many equally likely strata of every number contains one.
    Latin(usize),
    /// Number of points of Sobol's sequence, from its start.
    Sobol(usize),
}

impl Draw {
    /// Parses `grid`, `latin:N`, `sobol:N`.
    ///
    /// # Errors
    /// [`Error::Usage`].
    pub fn parse(text: &str) -> Result<Self> {
        let wrong = || {
            Error::Usage(format!(
                "--design {text}: expected grid, latin:N or sobol:N, such as latin:100 (N from 1 to {MOST_VALUES})"
            ))
        };
        let number = |n: &str| {
            n.parse()
                .ok()
                .filter(|n| (1..=MOST_VALUES).contains(n))
                .ok_or_else(wrong)
        };
        match text.split_once(':') {
            None if text == "grid" => Ok(Self::Grid),
            Some(("latin", n)) => Ok(Self::Latin(number(n)?)),
            Some(("sobol", n)) => Ok(Self::Sobol(number(n)?)),
            _ => Err(wrong()),
        }
    }

    /// Formats the option as typed.
    pub fn describe(self) -> String {
        match self {
            Self::Grid => "grid".into(),
            Self::Latin(n) => format!("latin:{n}"),
            Self::Sobol(n) => format!("sobol:{n}"),
        }
    }

    /// Number of designs that are drawn; 1 if nothing is drawn.
    pub fn count(self) -> usize {
        match self {
            Self::Grid => 1,
            Self::Latin(n) | Self::Sobol(n) => n,
        }
    }
}

impl VariedNumber {
    /// Parses `POINTER=SPEC`.
    ///
    /// # Errors
    /// [`Error::Usage`] with the expected form.
    pub fn parse(text: &str) -> Result<Self> {
        Self::parse_as("--vary", text)
    }

    /// Parses `POINTER=SPEC` of another option than `--vary`.
    ///
    /// # Errors
    /// [`Error::Usage`] with the expected form.
    pub fn parse_as(option: &str, text: &str) -> Result<Self> {
        let wrong = |what: String| Error::Usage(format!("{option} '{text}': {what}"));
        let (pointer, spec) = text
            .split_once('=')
            .ok_or_else(|| wrong("expected a JSON pointer and its values, such as /solver/rtol=1e-4,1e-5".into()))?;
        check_pointer(pointer).map_err(wrong)?;
        Ok(Self {
            pointer: pointer.into(),
            spec: spec.into(),
            values: VariedValues::parse(spec)
                .map_err(|why| amounts::rewritten(option, pointer, spec).unwrap_or(why))
                .map_err(wrong)?,
        })
    }

    /// True if its values are drawn, not listed.
    pub fn drawn(&self) -> bool {
        !matches!(self.values, VariedValues::Listed(_))
    }
}

/// Checks that a text is a pointer that can be varied.
///
/// # Errors
/// A description of the fault.
pub fn check_pointer(pointer: &str) -> std::result::Result<(), String> {
    let zeros = |part: &str| part.len() > 1 && part.starts_with('0') && part.bytes().all(|b| b.is_ascii_digit());
    let other_name = |part: &&str| part.starts_with('+') || zeros(part);
    if pointer.split('/').any(|part| part == "*") {
        Err(
            "a pointer names one number. To change several numbers together, use a table with a column for each: \
             slcbeam sweep --designs"
                .into(),
        )
    } else if let Some(part) = pointer.split('/').find(other_name) {
        Err(format!(
            "`{part}` is not an array index. Use 0, 1, 2 and so on, without a sign or leading zeros"
        ))
    } else if pointer.starts_with('/') && pointer.len() > 1 {
        Ok(())
    } else {
        Err(format!(
            "a JSON pointer starts with `/` and names a key: {}",
            unknown::whole(pointer)
        ))
    }
}

impl VariedValues {
    /// Value below which a share of the distribution lies; `None` for a list.
    pub fn at(&self, share: f64) -> Option<f64> {
        match self {
            Self::Listed(_) => None,
            Self::Uniform(low, high) => Some(low + (high - low) * share),
            Self::Normal(mean, sd) => Some(mean + sd * quantile(share)),
        }
    }

    /// Mean and standard deviation of the distribution; `None` for a list.
    pub fn moments(&self) -> Option<[f64; 2]> {
        match self {
            Self::Listed(_) => None,
            Self::Uniform(low, high) => Some([0.5 * (low + high), (high - low) / 12_f64.sqrt()]),
            Self::Normal(mean, sd) => Some([*mean, *sd]),
        }
    }

    fn parse(spec: &str) -> std::result::Result<Self, String> {
        let (kind, rest) = spec.split_once(':').unwrap_or((spec, ""));
        match kind {
            "lin" | "log" => range(kind, rest).map(Self::Listed),
            "uniform" => match numbers(rest)?[..] {
                [low, high] if low < high => Ok(Self::Uniform(low, high)),
                [low, high] => Err(format!("{low} is not below {high}. Use uniform:LOW:HIGH")),
                _ => Err("expected two numbers, uniform:LOW:HIGH".into()),
            },
            "normal" => match numbers(rest)?[..] {
                [mean, sd] if sd > 0.0 => Ok(Self::Normal(mean, sd)),
                [_, sd] => Err(format!(
                    "the standard deviation {sd} is not above 0. Use normal:MEAN:SD"
                )),
                _ => Err("expected two numbers, normal:MEAN:SD".into()),
            },
            _ => listed(spec).map(Self::Listed),
        }
    }
}

/// Parses finite numbers separated by colons.
pub(in crate::study) fn numbers(text: &str) -> std::result::Result<Vec<f64>, String> {
    let number = |part: &str| {
        let read = part.trim().parse().ok().filter(|x: &f64| x.is_finite());
        read.ok_or_else(|| format!("`{part}` is not a finite number. Give values in the unit that the key names"))
    };
    text.split(':').map(number).collect()
}

/// Parses `lin:LOW:HIGH:COUNT`, `log:LOW:HIGH:COUNT`.
fn range(kind: &str, text: &str) -> std::result::Result<Vec<Value>, String> {
    let wanted = format!("expected {kind}:LOW:HIGH:COUNT, such as {kind}:0.1:1:10");
    let (ends, count) = text.rsplit_once(':').ok_or_else(|| wanted.clone())?;
    let [low, high] = numbers(ends)?[..] else {
        return Err(wanted);
    };
    let count = count.trim().parse().ok().filter(|n| (2..=MOST_VALUES).contains(n));
    let Some(count) = count else {
        return Err(format!("{wanted}, with COUNT from 2 to {MOST_VALUES}"));
    };
    if low >= high {
        return Err(format!("{low} is not below {high}; {wanted}"));
    }
    if kind == "log" && low <= 0.0 {
        return Err(format!("{low} has no logarithm; {wanted}"));
    }
    let value = |k: usize| {
        let share = k as f64 / (count - 1) as f64;
        match (k, kind) {
            (0, _) => low,
            (k, _) if k + 1 == count => high,
            (_, "log") => low * (high / low).powf(share),
            _ => low + (high - low) * share,
        }
    };
    // 15 digits: 0.1 + 0.2 is 0.3
    let value = |k: usize| format!("{:.14e}", value(k)).parse().unwrap_or_else(|_| value(k));
    Ok((0..count).map(|k| number(value(k))).collect())
}

/// Converts a number to JSON; a whole number has no decimal point, as some keys require.
pub fn number(x: f64) -> Value {
    if x.fract() == 0.0 && x.abs() < 1e15 {
        Value::from(x as i64)
    } else {
        Value::from(x)
    }
}

/// Parses JSON values separated by commas.
fn listed(text: &str) -> std::result::Result<Vec<Value>, String> {
    if text.trim().is_empty() {
        return Err("no values".into());
    }
    let all: Vec<Value> = serde_json::from_str(&format!("[{text}]")).map_err(|_| {
        let kinds = ["lin", "log", "uniform", "normal"];
        let kind = text.split(':').next().filter(|_| text.contains(':')).map(str::trim);
        let forms = "lin:LOW:HIGH:COUNT, log:LOW:HIGH:COUNT, uniform:LOW:HIGH, normal:MEAN:SD";
        match kind {
            Some(kind) if kind.bytes().all(|b| b.is_ascii_alphabetic() || b == b'-' || b == b'_') => {
                // a typing error, not another word
                let slip = |known: &&str| strsim::damerau_levenshtein(&kind.to_lowercase(), known) <= 2;
                let meant = kinds
                    .into_iter()
                    .filter(slip)
                    .min_by_key(|known| strsim::damerau_levenshtein(kind, known));
                match meant {
                    Some(meant) => format!("did you mean {meant}:..?"),
                    None => format!(
                        "unknown form `{}:`. Use {forms}. For other distributions, give a table of designs: slcbeam \
                         sweep --designs",
                        short(kind)
                    ),
                }
            }
            _ => format!(
                "expected JSON values separated by commas (numbers without units, text in double quotes inside single \
                 quotes), or {forms}"
            ),
        }
    })?;
    Ok(all.into_iter().map(plain).collect())
}

/// Converts a whole number to a JSON integer; returns other values unchanged.
pub fn plain(value: Value) -> Value {
    match &value {
        Value::Number(own) if own.is_f64() => own.as_f64().map_or(value, number),
        _ => value,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equally_spaced_values_are_decimal_fractions() {
        let values = range("lin", "0.1:0.7:7").map(Value::from);
        assert_eq!(values, Ok(serde_json::json!([0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7])));
    }
}
