//! Checks of the fluid: keys of gases and of liquids, and gas pressures above absolute vacuum.

use super::strength::inlets;
use super::vessels;
use crate::case::faults::Violations;
use crate::case::numbers::plain;
use crate::case::schema::{AccumulatorKind, Case, Fluid, FluidKind};
use crate::error::{Code, Violation};

pub(super) fn check(case: &Case, faults: &mut Violations) {
    let Some(fluid) = &case.fluid else { return };
    let gas = fluid.kind == FluidKind::Gas;
    let some_gas = fluid.gas() > 0.0;
    vessels::check(case, fluid, faults);
    let mut accumulators = case.network.iter().flat_map(|network| &network.accumulators);
    let cushioned = accumulators.any(|one| matches!(one.kind, AccumulatorKind::Gas { .. }));
    let of_liquid = [
        ("bulk_modulus_pa", fluid.bulk_modulus_pa),
        ("gas_fraction", fluid.gas_fraction),
    ];
    let of_gas = [
        ("polytropic_exponent", fluid.polytropic_exponent),
        ("ambient_pressure_pa", fluid.ambient_pressure_pa),
    ];
    if let Some(named) = fluid.preset.filter(|named| named.kind() != fluid.kind) {
        let word = |kind: FluidKind| if kind == FluidKind::Gas { "gas" } else { "liquid" };
        let (is, given) = (word(named.kind()), word(fluid.kind));
        let what = format!("{} is a {is}, but kind is {given}", named.name());
        let fault = Violation::new(Code::Together, "/fluid/kind", what).allowed(format!("\"{is}\", or no kind"));
        let hint = "leave kind out, name another fluid, or give density_kg_m3 and viscosity_pa_s in place of preset";
        faults.push_at_key(fault.hint(hint));
        return;
    }
    let mut refuse = |key: &str, what: &str, hint: &str| {
        let fault = Violation::new(Code::Together, format!("/fluid/{key}"), what);
        faults.push_at_key(fault.hint(hint));
    };
    for (key, _) in of_liquid.iter().filter(|(_, value)| gas && value.is_some()) {
        refuse(
            key,
            &format!("\"{key}\" of a gas"),
            "only a liquid has it: leave it out, or give kind \"liquid\"",
        );
    }
    let presses = |key: &str| some_gas || (key == "ambient_pressure_pa" && cushioned);
    for (key, _) in of_gas.iter().filter(|(key, value)| !presses(key) && value.is_some()) {
        let hint = "only gas has it: leave it out, or give kind \"gas\" or a gas_fraction";
        refuse(key, &format!("\"{key}\" of a liquid without gas"), hint);
    }
    if some_gas {
        pressures(case, fluid, faults);
    }
}

/// Checks that the lowest gauge pressure of a gas is above absolute vacuum.
pub(super) fn above_vacuum(fluid: &Fluid, pointer: String, lowest: f64, faults: &mut Violations) {
    let ambient = fluid.ambient_pressure();
    if lowest <= -ambient {
        let what = format!("{} Pa, at or below absolute vacuum", plain(lowest));
        let fault = Violation::new(Code::Range, pointer, what).allowed(format!("above -{} Pa", plain(ambient)));
        let hint = "pressures are relative to ambient_pressure_pa, and the absolute pressure of a gas is above 0";
        faults.push_beside(&["/fluid/ambient_pressure_pa"], fault.hint(hint));
    }
}

/// Checks that the prescribed pressures of ports and of the start are above absolute vacuum.
fn pressures(case: &Case, fluid: &Fluid, faults: &mut Violations) {
    let mut look = |pointer: String, lowest: f64| above_vacuum(fluid, pointer, lowest, faults);
    for (pointer, signal) in inlets(case).pressures {
        look(pointer, signal.range(0.0, case.time.end_s).low);
    }
    for (i, some) in case.start.pressures.iter().enumerate() {
        look(
            format!("/start/pressures/{i}/pressure_pa"),
            some.pressure_pa.range(0.0, 1.0).low,
        );
    }
}
