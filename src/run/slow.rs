//! Fluid that comes to rest later than the run lasts.

use crate::case::schema::{Case, Effect};
use crate::discrete::System;
use crate::error::Code;
use crate::model::slowest::Slowest;

/// What is said of a state at rest where fluid needs longer than the run to come there, with valves as they stand at an instant [s]: the slowest decay
/// of a network lasts longer than the run, so that more than a third of what has to flow by it is still to flow at its end.
pub fn warning(case: &Case, system: &System, at_s: f64) -> Option<String> {
    let model = &system.model;
    let wet = model.wet.as_ref().filter(|_| model.effects.has(Effect::Flow))?;
    let slowest = Slowest::at(wet, at_s).filter(|one| one.time > case.time.end_s)?;
    let [from, to] = &slowest.between;
    Some(Code::LateRest.warning(format!(
        "fluid comes to rest with a time constant of {} (most resists between {from} and {to}); within the {} of the run pressures are others than those at \
         rest: a longer /time/end_s, wider tubes or valves, or `slcbeam run` for what is there by then",
        span(slowest.time),
        span(case.time.end_s)
    )))
}

/// A time with a unit in which it is read.
fn span(seconds: f64) -> String {
    let units = [
        (86400.0 * 365.0, "years"),
        (86400.0, "days"),
        (3600.0, "h"),
        (60.0, "min"),
        (1.0, "s"),
        (1e-3, "ms"),
    ];
    // up to three hundred of a unit in the smaller one
    let (size, unit) = units
        .into_iter()
        .find(|(size, unit)| seconds >= if matches!(*unit, "s" | "ms") { *size } else { 3.0 * size })
        .unwrap_or((1e-6, "µs"));
    let number: f64 = format!("{:.2e}", seconds / size).parse().unwrap_or(seconds / size);
    format!("{number} {unit}")
}

#[cfg(test)]
mod tests {
    use super::span;

    #[test]
    fn times_have_units_of_their_size() {
        let all = [738_079.0, 5.5417, 0.3, 1.5, 4e9, 120.0].map(span);
        assert_eq!(all, ["8.54 days", "5.54 s", "300 ms", "1.5 s", "127 years", "120 s"]);
    }
}
