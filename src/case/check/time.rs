//! Run and output times.

use crate::case::faults::Faults;
use crate::case::schema::Case;
use crate::error::{Code, Violation};

/// Rows of a history at most, those that `/time/history` leaves out not counted: some 2 GB, more than anything reads.
const MOST_ROWS: f64 = 1e7;

/// Checkpoints at most; each costs a start afresh of the integrator.
const MOST_CHECKPOINTS: f64 = 1e5;

pub(super) fn check(case: &Case, faults: &mut Faults) {
    let time = &case.time;
    let mut refuse = |key: &str, what: String, allowed: String| {
        faults.push(Violation::new(Code::Times, format!("/time/{key}"), what).allowed(allowed));
    };
    let intervals = [
        ("output_interval_s", time.output_interval_s),
        ("fields_interval_s", time.fields_interval_s),
        ("window_s", time.window_s),
    ];
    for (key, interval) in intervals {
        if let Some(interval) = interval.filter(|interval| *interval > time.end_s * (1.0 + 1e-9)) {
            let what = format!("{interval} s is longer than the run of {} s", time.end_s);
            refuse(key, what, format!("at most {} s", time.end_s));
        }
    }
    let written = |interval: f64| time.written(interval);
    let all = |interval: f64| time.end_s / interval;
    let counted: [(_, _, &dyn Fn(f64) -> f64, _, _); 3] = [
        (
            "output_interval_s",
            Some(time.output_interval()),
            &written,
            MOST_ROWS,
            "rows",
        ),
        (
            "fields_interval_s",
            time.fields_interval_s,
            &written,
            MOST_ROWS,
            "instants",
        ),
        (
            "checkpoint_interval_s",
            time.checkpoint_interval_s,
            &all,
            MOST_CHECKPOINTS,
            "checkpoints",
        ),
    ];
    for (key, interval, of, most, what) in counted {
        let Some(interval) = interval else { continue };
        let count = of(interval);
        if count > most * (1.0 + 1e-9) {
            refuse(
                key,
                format!("{interval:e} s makes {count:.1e} {what} in a run of {} s", time.end_s),
                format!(
                    "at least {:e} s, which makes {most:.0} of them",
                    interval * count / most
                ),
            );
        }
    }
    let output = time.output_interval();
    if let Some(fields) = time.fields_interval_s {
        let ratio = fields / output;
        if ratio < 1.0 - 1e-6 || (ratio - ratio.round()).abs() > 1e-6 * ratio {
            let what = format!("{fields} s is not a multiple of the output interval of {output} s");
            let below = (ratio.floor().max(1.0)) * output;
            refuse(
                "fields_interval_s",
                what,
                format!("multiples of {output} s, such as {below} s"),
            );
        }
    }
}
