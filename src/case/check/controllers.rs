//! Checks of controllers: names, intervals, outputs, setpoints. The system checks the measured quantities.

use super::functions::{controls, each_part, part_faults};
use super::time::END;
use crate::case::faults::Violations;
use crate::case::schema::Case;
use crate::error::{Code, Violation};
use crate::functions::control::{ControlLaw, Controller, Hold};
use crate::functions::signals::Signal;

/// Largest number of samples of a run.
const MOST_SAMPLES: f64 = 1e6;

/// All controllers of a case with their pointers, in the order of its signals.
pub fn controllers(case: &Case) -> Vec<(String, &Controller)> {
    with_inputs(case).into_iter().map(|(at, _, one)| (at, one)).collect()
}

/// The same, with a flag: true if the input may jump.
fn with_inputs(case: &Case) -> Vec<(String, bool, &Controller)> {
    let mut all = vec![];
    for (pointer, jumps, signal) in controls(case) {
        each_part(&pointer, signal, &mut |at, part| {
            if let Signal::Controller(one) = part {
                all.push((format!("{at}/controller"), jumps, &**one));
            }
        });
    }
    all
}

pub(super) fn check(case: &Case, faults: &mut Violations) {
    let all = with_inputs(case);
    for (k, (at, jumps, one)) in all.iter().enumerate() {
        let good = |c: char| c.is_ascii_alphanumeric() || "-_".contains(c);
        if one.name.is_empty() || !one.name.chars().all(good) {
            let what = format!("\"{}\" cannot begin the name of a column", one.name);
            let fault = Violation::new(Code::CaseName, format!("{at}/name"), what);
            faults.push(fault.allowed("letters, digits, `-` and `_`"));
        }
        let namesake = all[..k].iter().find(|(.., other)| other.name == one.name);
        if let Some((first, ..)) = namesake.filter(|(.., other)| other != one) {
            let what = format!("another controller has the name \"{}\": {first}", one.name);
            let fault = Violation::new(Code::CaseName, format!("{at}/name"), what);
            faults.push(fault.hint("choose another name; inputs share an output only if their controllers are equal"));
        }
        interval(case, at, one, faults);
        outputs(at, one, faults);
        setpoint(case, at, one, faults);
        if !jumps && one.hold == Hold::Step {
            let what = "the output jumps at samples, and this input must not jump";
            let fault = Violation::new(Code::Function, format!("{at}/hold"), what);
            faults.push_at_key(fault.hint(
                "add \"hold\": \"ramp\": the output then moves to its value along a straight line until the next sample",
            ));
        }
    }
}

fn interval(case: &Case, at: &str, one: &Controller, faults: &mut Violations) {
    let (interval, end) = (one.sample_interval_s, case.time.end_s);
    if !(interval > 0.0 && end > 0.0) {
        return;
    }
    let least = end / MOST_SAMPLES;
    let (what, allowed) = if interval > end {
        (
            format!("{interval} s is longer than the run of {end} s: the controller would sample only at the start"),
            format!("at most {end} s"),
        )
    } else if interval < least * (1.0 - 1e-9) {
        (
            format!(
                "{interval:e} s gives {:.1e} samples in a run of {end} s",
                end / interval
            ),
            format!("at least {least:e} s, which gives {MOST_SAMPLES:.0} samples"),
        )
    } else {
        return;
    };
    let fault = Violation::new(Code::Times, format!("{at}/sample_interval_s"), what);
    faults.push_beside(&[END], fault.allowed(allowed));
}

fn outputs(at: &str, one: &Controller, faults: &mut Violations) {
    let start = one.start;
    let fault = match &one.law {
        ControlLaw::Pi(law) if law.lowest >= law.highest => {
            let what = format!(
                "the lowest output {} is not below the highest, {}",
                law.lowest, law.highest
            );
            Violation::new(Code::Range, format!("{at}/law/pi/lowest"), what)
                .allowed(format!("numbers below {}", law.highest))
        }
        ControlLaw::Pi(law) if !(law.lowest..=law.highest).contains(&start) => {
            let what = format!("the output {start} before the first sample is not between the limits of the law");
            Violation::new(Code::Range, format!("{at}/start"), what)
                .allowed(format!("{} to {}", law.lowest, law.highest))
        }
        ControlLaw::Relay(law) if law.output_below == law.output_above => {
            let what = format!("both outputs of the relay are {}", law.output_below);
            Violation::new(Code::Range, format!("{at}/law/relay/output_above"), what)
                .hint("give two different outputs, or the number itself in place of the controller")
        }
        ControlLaw::Relay(law) if start != law.output_below && start != law.output_above => {
            let what = format!("the output {start} before the first sample is none of the relay");
            Violation::new(Code::Range, format!("{at}/start"), what)
                .allowed(format!("{} or {}", law.output_below, law.output_above))
        }
        _ => return,
    };
    faults.push_at_key(fault);
}

fn setpoint(case: &Case, at: &str, one: &Controller, faults: &mut Violations) {
    let (at, end) = (format!("{at}/setpoint"), case.time.end_s);
    let known = faults.count();
    if one.setpoint.is_controlled() {
        let fault = Violation::new(Code::Function, &at, "a controller in the setpoint of a controller");
        faults.push(fault.hint("give a signal of time; an inner loop can measure what the outer controller sets"));
        return;
    }
    each_part(&at, &one.setpoint, &mut |at, part| part_faults(at, part, end, faults));
    if faults.count() == known
        && faults.are_sound(&[END, &at])
        && let Some(t) = one.setpoint.overflows(end)
    {
        faults.push(Violation::new(
            Code::Function,
            at,
            format!("not a finite number at {t} s"),
        ));
    }
}
