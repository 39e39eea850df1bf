//! `POINTER=LOW:HIGH`: a number of a case and the bounds within which it is sought.

use serde::{Deserialize, Serialize};

use super::sweep::vary::{check_pointer, numbers};
use crate::case::parameter::{Parameter, with};
use crate::case::{Case, amounts, is_below};
use crate::error::{Error, Result};
use crate::numerics::sobol::{self, Sobol};

/// What names a number that is sought.
const OPTION: &str = "--vary";

/// Ratio of the bounds from which on a number is sought by its logarithm.
const DECADE: f64 = 10.0;

/// One of two bounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Bound {
    /// The lower.
    Low,
    /// The upper.
    High,
}

/// A number that is sought, and where.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Span {
    /// JSON pointer into the case.
    pub pointer: String,
    /// Lower bound, in the unit that the key names.
    pub low: f64,
    /// Upper bound.
    pub high: f64,
}

impl Span {
    /// Of `POINTER=LOW:HIGH`.
    ///
    /// # Errors
    /// [`Error::Usage`] with what is wanted.
    pub fn parse(text: &str) -> Result<Self> {
        let wrong = |what: String| Error::Usage(format!("--vary '{text}': {what}"));
        let wanted = "a JSON pointer and two bounds are wanted, such as /fluid/viscosity_pa_s=1e-4:1e-2";
        let (pointer, bounds) = text.split_once('=').ok_or_else(|| wrong(wanted.into()))?;
        check_pointer(pointer).map_err(wrong)?;
        if let Some(said) = amounts::rewritten(OPTION, pointer, bounds) {
            return Err(wrong(said));
        }
        if bounds.contains(',') {
            let what = format!(
                "POINTER=LOW:HIGH, two bounds and a colon between them: {pointer}={}",
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
            [low, high] => Err(wrong(format!("{low} is not below {high}; POINTER=LOW:HIGH"))),
            _ => Err(wrong(wanted.into())),
        }
    }

    /// Whether it is sought by its logarithm: bounds of one sign, a decade or more apart.
    pub fn logarithmic(&self) -> bool {
        let sizes = [self.low.abs(), self.high.abs()];
        self.low * self.high > 0.0 && sizes[0].max(sizes[1]) >= DECADE * sizes[0].min(sizes[1])
    }

    /// The value at a place between the bounds, 0 to 1.
    pub fn value(&self, place: f64) -> f64 {
        match place {
            0.0 => self.low,
            1.0 => self.high,
            _ if self.logarithmic() => self.low * (self.high / self.low).powf(place),
            _ => self.low + (self.high - self.low) * place,
        }
    }

    /// The place of a value between the bounds: 0 at the lower, 1 at the upper.
    pub fn place(&self, value: f64) -> f64 {
        if self.logarithmic() {
            (value / self.low).ln() / (self.high / self.low).ln()
        } else {
            (value - self.low) / (self.high - self.low)
        }
    }

    /// Derivative of the value by its place, at a value.
    pub fn slope(&self, value: f64) -> f64 {
        if self.logarithmic() {
            value * (self.high / self.low).ln()
        } else {
            self.high - self.low
        }
    }

    /// Whether a value is within the bounds.
    pub fn holds(&self, value: f64) -> bool {
        (self.low..=self.high).contains(&value)
    }
}

/// Values at places between the bounds; none is exactly 0, where a number has no size to differ by.
pub fn values(spans: &[Span], places: &[f64]) -> Vec<f64> {
    let value = |(span, place): (&Span, &f64)| {
        let (value, least) = (span.value(*place), 1e-6 * (span.high - span.low));
        match value.abs() < least {
            true if span.high > least => least,
            true => -least,
            false => value,
        }
    };
    spans.iter().zip(places).map(value).collect()
}

/// Values to begin with: those of the case, or the middle of the bounds where these do not hold them. `set` are pointers to what is set
/// besides.
///
/// # Errors
/// [`Error::Usage`] for what is no number of the model, and for two that would be set at once.
pub fn begin<'a>(case: &Case, spans: &'a [Span], set: impl Iterator<Item = &'a str>) -> Result<Vec<f64>> {
    let all: Vec<&str> = spans.iter().map(|span| span.pointer.as_str()).chain(set).collect();
    for (k, pointer) in all.iter().enumerate() {
        if let Some(other) = all[..k]
            .iter()
            .find(|other| is_below(pointer, other) || is_below(other, pointer))
        {
            return Err(Error::Usage(format!(
                "{pointer} and {other} would be set at once; leave one of them out"
            )));
        }
    }
    let start = |span: &Span| {
        let find = |case: &Case| Ok(Parameter::find_as(OPTION, case, &span.pointer)?.value);
        let own = Parameter::number(OPTION, case, &span.pointer)?.value;
        let value = match own == 0.0 {
            // one that is 0 has no size to differ by, but another value has
            true => {
                with(case, &[(&span.pointer, span.value(0.5))]).map_or_else(|_| find(case), |middle| find(&middle))?
            }
            false => own,
        };
        Ok(if span.holds(value) { value } else { span.value(0.5) })
    };
    spans.iter().map(start).collect()
}

/// Looks at what a case would be at every bound, with the other numbers at their values to begin with: a bound that the case cannot take is
/// none. `begin` is the case at these values. Where others may follow (`alone`) faults of the number itself count, not of what else stands in
/// the case beside it.
///
/// # Errors
/// Those of the case, and of `check`.
pub fn check(begin: &Case, spans: &[Span], alone: bool, check: &dyn Fn(&Case) -> Result<()>) -> Result<()> {
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

/// Places between the bounds from which to search: that of the values to begin with, then those of Sobol's sequence.
///
/// # Errors
/// [`Error::Usage`] for several in more directions than the sequence has.
pub fn places(spans: &[Span], begin: &[f64], count: usize) -> Result<Vec<Vec<f64>>> {
    let count = count.max(1);
    if count > 1 && spans.len() > sobol::MOST {
        let what = format!("--starts: several are for {} numbers at most", sobol::MOST);
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
