//! Checks of the viscoelastic solid.

use crate::case::faults::Violations;
use crate::case::schema::Case;
use crate::error::{Code, Violation};

pub(super) fn check(case: &Case, faults: &mut Violations) {
    let Some(written) = &case.beam.viscoelasticity else {
        return;
    };
    let pointer = "/beam/viscoelasticity";
    let Some(loss_factor) = &written.loss_factor else {
        if written.prony.is_empty() {
            let fault = Violation::new(Code::Missing, pointer, "neither branches nor a loss factor");
            faults.push(
                fault
                    .allowed("\"prony\" with at least one branch, or \"loss_factor\"")
                    .hint("give one of them, or leave viscoelasticity out"),
            );
        }
        return;
    };
    if !written.prony.is_empty() {
        let fault = Violation::new(
            Code::Together,
            format!("{pointer}/prony"),
            "both branches and a loss factor",
        );
        faults.push_at_key(fault.hint("a loss factor determines its own branches: give one of the two"));
        return;
    }
    if !faults.are_sound(&["/beam/viscoelasticity/loss_factor"]) {
        return;
    }
    let (from, to) = (loss_factor.from_hz, loss_factor.to_hz);
    if from >= to {
        let fault = Violation::new(
            Code::Range,
            format!("{pointer}/loss_factor/to_hz"),
            format!("a band that ends at {to} Hz, not above its start"),
        );
        faults.push(fault.allowed(format!("above {from} Hz")));
    } else if to / from > WIDEST {
        let fault = Violation::new(
            Code::Range,
            format!("{pointer}/loss_factor/to_hz"),
            format!("a band of {:.1} decades", (to / from).log10()),
        );
        faults.push(fault.allowed(format!("{} decades at most", WIDEST.log10())));
    } else if written.branches().is_none() {
        let fault = Violation::new(
            Code::Range,
            format!("{pointer}/loss_factor/value"),
            format!(
                "no Prony series reaches the loss factor {} from {from} to {to} Hz",
                loss_factor.value
            ),
        );
        faults.push(
            fault
                .allowed("about 0.5 at most, a little more over narrow bands")
                .hint("give a narrower band, or the branches of a measured series in \"prony\""),
        );
    }
}

/// Largest ratio of the upper to the lower end of a frequency band.
const WIDEST: f64 = 1e12;
