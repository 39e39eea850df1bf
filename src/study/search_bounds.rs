//! `POINTER=LOW:HIGH`: a parameter of a case and its bounds in a search.

use serde::{Deserialize, Serialize};

use super::sweep::vary::{check_pointer, numbers};
use crate::case::parameter::{Parameter, with};
use crate::case::{Case, amounts, is_below};
use crate::error::{Error, Result};
use crate::numerics::sobol::{self, Sobol};

/// Option that names a parameter.
const OPTION: &str = "--vary";

/// Ratio of the bounds from which on the search uses the logarithm.
const DECADE: f64 = 10.0;

/// One of the two bounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Bound {
    /// The lower.
    Low,
    /// The upper.
    High,
}

/// A parameter of a search, with its bounds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ParameterBounds {
    /// JSON pointer into the case.
    pub pointer: String,
    /// Lower bound, in the unit that the key names.
    pub low: f64,
    /// Upper bound.
    pub high: f64,
}

impl ParameterBounds {
    /// Parses `POINTER=LOW:HIGH`.
    ///
    /// # Errors
    /// [`Error::Usage`] with the expected form.
    pub fn parse(text: &str) -> Result<Self> {
        let wrong = |what: String| Error::Usage(format!("--vary '{text}': {what}"));
        let wanted = "expected a JSON pointer and two bounds, such as /fluid/viscosity_pa_s=1e-4:1e-2";
        let (pointer, bounds) = text.split_once('=').ok_or_else(|| wrong(wanted.into()))?;
        check_pointer(pointer).map_err(wrong)?;
        if let Some(said) = amounts::rewritten(OPTION, pointer, bounds) {
            return Err(wrong(said));
        }
        if bounds.contains(',') {
            let what = format!(
                "expected POINTER=LOW:HIGH with a colon between the bounds: {pointer}={}",
                bounds.replacen(',', ":", 1)
            );
            return Err(wrong(what));
        }
        match numbers(bounds).map_err(wrong)?[..] {
            [low, high] if low < high => Ok(Self {
                pointer: pointer.into(),
                low,
                high,
            }),
            [low, high] => Err(wrong(format!("{low} is not below {high}. Use POINTER=LOW:HIGH"))),
            _ => Err(wrong(wanted.into())),
        }
    }

    /// True for bounds of one sign that differ by a decade or more: the search then uses the logarithm.
    pub fn logarithmic(&self) -> bool {
        let sizes = [self.low.abs(), self.high.abs()];
        self.low * self.high > 0.0 && sizes[0].max(sizes[1]) >= DECADE * sizes[0].min(sizes[1])
    }

    /// Value at a place between the bounds, from 0 to 1.
    pub fn value(&self, place: f64) -> f64 {
        match place {
            0.0 => self.low,
            1.0 => self.high,
            _ if self.logarithmic() => self.low * (self.high / self.low).powf(place),
            _ => self.low + (self.high - self.low) * place,
        }
    }

    /// Place of a value between the bounds: 0 at the lower, 1 at the upper.
    pub fn place(&self, value: f64) -> f64 {
        if self.logarithmic() {
            (value / self.low).ln() / (self.high / self.low).ln()
        } else {
            (value - self.low) / (self.high - self.low)
        }
    }

    /// Derivative of the value with respect to its place.
    pub fn slope(&self, value: f64) -> f64 {
        if self.logarithmic() {
            value * (self.high / self.low).ln()
        } else {
            self.high - self.low
        }
    }

    /// True if a value is within the bounds.
    pub fn holds(&self, value: f64) -> bool {
        (self.low..=self.high).contains(&value)
    }
}

/// Values at places between the bounds. None is exactly 0, because differences are relative to the value.
pub fn values(spans: &[ParameterBounds], places: &[f64]) -> Vec<f64> {
    let value = |(span, place): (&ParameterBounds, &f64)| {
        let (value, least) = (span.value(*place), 1e-6 * (span.high - span.low));
        match value.abs() < least {
            true if span.high > least => least,
            true => -least,
            false => value,
        }
    };
    spans.iter().zip(places).map(value).collect()
}

/// Initial values: those of the case, or the middle of the bounds if these exclude it. `set` are pointers of other settings.
///
/// # Errors
/// [`Error::Usage`] for a pointer to no number of the model, and for two pointers that overlap.
pub fn begin<'a>(case: &Case, spans: &'a [ParameterBounds], set: impl Iterator<Item = &'a str>) -> Result<Vec<f64>> {
    let all: Vec<&str> = spans.iter().map(|span| span.pointer.as_str()).chain(set).collect();
    for (k, pointer) in all.iter().enumerate() {
        if let Some(other) = all[..k]
            .iter()
            .find(|other| is_below(pointer, other) || is_below(other, pointer))
        {
            return Err(Error::Usage(format!(
                "{pointer} and {other} set the same number. Leave out one of them"
            )));
        }
    }
    let start = |span: &ParameterBounds| {
        let find = |case: &Case| Ok(Parameter::find_as(OPTION, case, &span.pointer)?.value);
        let own = Parameter::number(OPTION, case, &span.pointer)?.value;
        let value = match own == 0.0 {
            // 0 gives no size for differences; another value does
            true => {
                with(case, &[(&span.pointer, span.value(0.5))]).map_or_else(|_| find(case), |middle| find(&middle))?
            }
            false => own,
        };
        Ok(if span.holds(value) { value } else { span.value(0.5) })
    };
    spans.iter().map(start).collect()
}

/// Checks the case at every bound, with the other parameters at their initial values. `begin` is the case at these values. With `alone`,
/// only faults at the parameter itself count, since other settings may still follow.
///
/// # Errors
/// Those of the case at a bound, and of `check`.
pub fn check(begin: &Case, spans: &[ParameterBounds], alone: bool, check: &dyn Fn(&Case) -> Result<()>) -> Result<()> {
    check(begin)?;
    for span in spans {
        let counts = |error: &Error| match error {
            Error::Case(fault) if alone => fault.violations.iter().any(|one| is_below(&one.pointer, &span.pointer)),
            _ => true,
        };
        for bound in [0.0, 1.0] {
            let value = values(std::slice::from_ref(span), &[bound])[0];
            let found = with(begin, &[(&span.pointer, value)]).and_then(|case| check(&case));
            match found {
                Err(error) if counts(&error) => return Err(error),
                _ => {}
            }
        }
    }
    Ok(())
}

/// Initial places of a search: that of the initial values, then those of a Sobol sequence.
///
/// # Errors
/// [`Error::Usage`] for several places in more dimensions than the Sobol sequence has.
pub fn places(spans: &[ParameterBounds], begin: &[f64], count: usize) -> Result<Vec<Vec<f64>>> {
    let count = count.max(1);
    if count > 1 && spans.len() > sobol::MOST {
        let what = format!(
            "--starts: several starts are possible for at most {} numbers",
            sobol::MOST
        );
        return Err(Error::Usage(what));
    }
    let own = spans.iter().zip(begin).map(|(span, value)| span.place(*value));
    let mut all = vec![own.collect()];
    let axes: Vec<Sobol> = (0..spans.len().min(sobol::MOST)).map(Sobol::along).collect();
    for k in 1..count {
        all.push(axes.iter().map(|axis| axis.share(k as u32 - 1, 0)).collect());
    }
    Ok(all)
}
