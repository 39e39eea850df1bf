//! Which warnings say that a number may be wrong, and what kind of error each of them names.
//!
//! Others are about the model (W001, W003, W004, W005, W017), about the motion (W006, W007) or about cost (W011): the reference
//! solves the same model, so that these excuse nothing here. W002 tells before the run what W009 tells when it happens.

use slcbeam::error::Code;

/// Where an error comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Cause {
    /// Effects that were left out.
    Effects,
    /// Steps in time.
    Time,
    /// The mesh.
    Space,
    /// Too few output times.
    Outputs,
    /// None of them alone.
    Joint,
}

/// What a warning names: a list of causes, or everything.
const TRUST: [(Code, &[Cause]); 10] = [
    // The balance is off by the steps' error; what jumps without inertia shows there too.
    (Code::EnergyOpen, &[Cause::Time]),
    (Code::PortFlow, &[Cause::Time]),
    // From then on the state is not unique: nothing that follows can be trusted.
    (Code::LostConvexity, ALL),
    // The straight state is kept where it is not stable.
    (Code::Buckling, ALL),
    // The estimate is above what was asked.
    (Code::Accuracy, ALL),
    (Code::FewOutputs, &[Cause::Outputs]),
    (Code::Unresolved, &[Cause::Space]),
    // Only figures of energy, whatever made them wrong.
    (Code::EnergyFigure, ALL),
    // Names each quantity, whatever made it wrong.
    (Code::ErrorEstimate, ALL),
    // Says itself that results are not those of the model.
    (Code::OutOfRange, ALL),
];

const ALL: &[Cause] = &[Cause::Effects, Cause::Time, Cause::Space, Cause::Outputs, Cause::Joint];

/// The codes of warnings about trust.
pub fn warned(warnings: &[String]) -> Vec<Code> {
    let mut all: Vec<Code> = warnings.iter().filter_map(|w| code(w)).collect();
    all.dedup();
    all
}

fn code(warning: &str) -> Option<Code> {
    let code = warning.split_whitespace().next().and_then(Code::find);
    code.filter(|code| TRUST.iter().any(|(c, _)| c == code))
}

/// Whether a warning names an error of these causes in this figure. Where no cause was found by itself any will do.
pub fn names(warning: &str, causes: &[Cause], quantity: &str) -> bool {
    let Some(code) = code(warning) else { return false };
    let energy = quantity.ends_with("_j") || quantity == "efficiency";
    let of = TRUST
        .iter()
        .find(|(c, _)| *c == code)
        .map_or(&[][..], |(_, causes)| causes);
    let about = match code {
        Code::EnergyFigure => energy,
        Code::ErrorEstimate => warning.contains(quantity) || warning.contains("not known"),
        _ => true,
    };
    about && (causes == [Cause::Joint] || causes.iter().any(|c| of.contains(c)))
}
