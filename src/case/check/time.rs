//! Checks of run and output times.

use crate::case::faults::Violations;
use crate::case::schema::Case;
use crate::error::{Code, Violation};

/// Largest number of rows of a history, without those that `/time/history` omits: about 2 GB, more than any program reads.
const MOST_ROWS: f64 = 1e7;

/// Largest number of checkpoints; each restarts the integrator.
const MOST_CHECKPOINTS: f64 = 1e5;

/// Pointer of the end of a run.
pub(super) const END: &str = "/time/end_s";
/// Pointer of the output interval, on which other intervals depend.
const OUTPUT: &str = "/time/output_interval_s";

pub(super) fn check(case: &Case, faults: &mut Violations) {
    let time = &case.time;
    // an invalid time already has its fault
    let sound = |time: &f64| *time > 0.0;
    if !sound(&time.end_s) || !faults.are_sound(&[END]) {
        return;
    }
    let mut refuse = |key: &str, what: String, allowed: String| {
        let fault = Violation::new(Code::Times, format!("/time/{key}"), what).allowed(allowed);
        faults.push_beside(&[OUTPUT], fault);
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
    let output = time.output_interval();
    let written = |interval: f64| (interval, time.written(interval));
    let all = |interval: f64| (interval, time.end_s / interval);
    let (fields, checkpoints) = (time.fields_interval_s, time.checkpoint_interval_s);
    let counted = [
        ("output_interval_s", Some(written(output)), MOST_ROWS, "rows"),
        ("fields_interval_s", fields.map(written), MOST_ROWS, "instants"),
        (
            "checkpoint_interval_s",
            checkpoints.map(all),
            MOST_CHECKPOINTS,
            "checkpoints",
        ),
    ];
    for (key, counted, most, what) in counted {
        if let Some((interval, count)) = counted.filter(|(each, count)| sound(each) && *count > most * (1.0 + 1e-9)) {
            let least = interval * count / most;
            refuse(
                key,
                format!("{interval:e} s gives {count:.1e} {what} in a run of {} s", time.end_s),
                format!("at least {least:e} s, which gives {most:.0} {what}"),
            );
        }
    }
    if let Some(fields) = time.fields_interval_s.filter(|fields| sound(fields) && sound(&output)) {
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
