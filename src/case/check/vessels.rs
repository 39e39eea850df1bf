//! Checks of accumulators: their fluid, and curves of pressure over volume.

use super::fluid::above_vacuum;
use super::tubes::points;
use crate::case::faults::Violations;
use crate::case::numbers::plain;
use crate::case::schema::{Accumulator, AccumulatorKind, Case, Fluid, FluidKind};
use crate::error::{Code, Violation};
use crate::functions::{Interpolation, PiecewiseCurve};

/// Checks accumulators: a tank needs a compressible fluid, an elastic vessel of gas needs a volume, and gas pressures stay above vacuum.
pub(super) fn check(case: &Case, fluid: &Fluid, faults: &mut Violations) {
    let all = case.network.iter().flat_map(|network| &network.accumulators);
    for (i, one) in all.enumerate() {
        let pointer = format!("/network/accumulators/{i}");
        let start = format!("{pointer}/start_pressure_pa");
        match one.kind {
            AccumulatorKind::Tank { .. } if !fluid.is_compressible() => {
                let what = "a tank of incompressible fluid, which stores nothing";
                let fault = Violation::new(Code::Together, format!("{pointer}/kind/tank"), what);
                let hint = "give \"elastic\" or \"gas\" in its place, or bulk_modulus_pa or gas_fraction in /fluid, or kind \"gas\" there";
                faults.push_at_key(fault.hint(hint));
            }
            AccumulatorKind::Elastic { volume_m3: 0.0, .. } if fluid.kind == FluidKind::Gas => {
                let what = "an elastic vessel of gas without a volume at ambient pressure";
                let fault = Violation::new(Code::Together, format!("{pointer}/kind/elastic"), what);
                faults
                    .push_at_key(fault.hint("give its volume_m3: pressure compresses the gas and stretches the walls"));
            }
            AccumulatorKind::Elastic {
                compliance_m3_pa,
                volume_m3,
            } if fluid.kind == FluidKind::Gas && volume_m3 + compliance_m3_pa * one.start_pressure_pa <= 0.0 => {
                let what = format!("{} Pa, at which the vessel has no volume", plain(one.start_pressure_pa));
                let least = format!(
                    "above -{} Pa, -volume_m3/compliance_m3_pa",
                    plain(volume_m3 / compliance_m3_pa)
                );
                let parts = ["volume_m3", "compliance_m3_pa"].map(|key| format!("{pointer}/kind/elastic/{key}"));
                let fault = Violation::new(Code::Range, start, what).allowed(least);
                faults.push_beside(&parts.each_ref().map(String::as_str), fault);
            }
            AccumulatorKind::Gas { .. } if fluid.kind == FluidKind::Gas && one.start_pressure_pa < 0.0 => {
                let what = format!(
                    "{} Pa, at which the vessel contains a negative amount of gas",
                    plain(one.start_pressure_pa)
                );
                faults.push(Violation::new(Code::Range, start, what).allowed("0 Pa or more"));
            }
            AccumulatorKind::Curve { .. } if fluid.is_compressible() => {
                let what = "a curve of pressure over volume for a compressible fluid";
                let fault = Violation::new(Code::Together, format!("{pointer}/kind/curve"), what);
                let hint = "give an incompressible fluid, or \"elastic\" in place of the curve";
                faults.push_at_key(fault.hint(hint));
            }
            AccumulatorKind::Tank { .. } | AccumulatorKind::Elastic { .. } | AccumulatorKind::Curve { .. }
                if fluid.gas() <= 0.0 => {}
            _ => above_vacuum(fluid, start, one.start_pressure_pa, faults),
        }
    }
}

/// Checks the points of an accumulator of kind `curve`: volumes ascend, and the pressure rises beyond both ends.
pub(super) fn curve(one: &Accumulator, pointer: &str, faults: &mut Violations) {
    let AccumulatorKind::Curve { volume_m3, pressure_pa } = &one.kind else {
        return;
    };
    let pointer = format!("{pointer}/kind/curve");
    let names = ["volume", "volumes are in m^3; a ml is 1e-6"];
    if !points(&format!("{pointer}/volume_m3"), names, [volume_m3, pressure_pa], faults) {
        return;
    }
    let Some(curve) = PiecewiseCurve::through(volume_m3, pressure_pa, Interpolation::Monotone) else {
        return;
    };
    let last = volume_m3.len() - 1;
    for (k, end) in [(0, "first"), (last, "last")] {
        if curve.at(volume_m3[k]).rate <= 0.0 {
            let what = format!("a pressure that does not rise with volume at the {end} point");
            let fault = Violation::new(Code::Wiring, format!("{pointer}/pressure_pa/{k}"), what);
            faults
                .push(fault.hint("add a point from which the pressure rises: beyond the points the curve is straight"));
        }
    }
}
