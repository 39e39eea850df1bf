//! Properties of a tube: its own values, or the defaults of `/tubes`. Checks of its pump and of the pilot of its valve.

use crate::case::faults::Violations;
use crate::case::numbers::plain;
use crate::case::schema::{self, AccumulatorKind, Case, CrossSection, Pilot, TubeDefaults};
use crate::case::wiring::PermeabilitySource;
use crate::case::wording::nearest;
use crate::error::{Code, Violation, listed};

/// Default loss of a tube, in dynamic pressures of its mean velocity: sharp entrance 0.5, exit 1.
const SHARP_EDGED: f64 = 1.5;

/// Radius of a circular tube: its own, or that of `/tubes` if the tube has neither a cross-section nor a permeability.
pub(super) fn radius(tube: &schema::Tube, usual: Option<&TubeDefaults>) -> Option<f64> {
    match (&tube.cross_section, tube.permeability_m4) {
        (Some(CrossSection::Circle { radius_m }), _) => Some(*radius_m),
        (None, None) => usual.map(|usual| usual.radius_m),
        _ => None,
    }
}

/// Loss coefficient of a tube: its own, that of `/tubes`, or that of sharp edges.
pub(super) fn loss_coefficient(own: Option<f64>, usual: Option<&TubeDefaults>) -> f64 {
    own.or_else(|| usual?.loss_coefficient).unwrap_or(SHARP_EDGED)
}

/// Roughness of a tube's wall [m]: its own, that of `/tubes`, or 0.
pub(super) fn roughness(own: Option<f64>, usual: Option<&TubeDefaults>) -> f64 {
    own.or_else(|| usual?.roughness_m).unwrap_or(0.0)
}

/// Length [m] and bore of a tube: its own, or those of `/tubes`.
pub(super) fn size<'a>(tube: &'a schema::Tube, usual: Option<&TubeDefaults>) -> Option<(f64, PermeabilitySource<'a>)> {
    let own = tube.permeability_m4.map(PermeabilitySource::Permeability);
    let bore = own
        .or_else(|| tube.cross_section.as_ref().map(PermeabilitySource::CrossSection))
        .or_else(|| usual.map(PermeabilitySource::usual))?;
    Some((tube.length_m.or_else(|| usual.map(|tubes| tubes.length_m))?, bore))
}

/// Checks that a pump has one law, and that its curve is one.
pub(super) fn pump(case: &Case, pump: &schema::Pump, pointer: &str, faults: &mut Violations) {
    if pump.pressure_pa.is_some() == pump.curve.is_some() {
        let what = match pump.curve {
            None => "a pump without pressure",
            Some(_) => "a pump with both a pressure and a curve",
        };
        let fault = Violation::new(Code::Wiring, pointer, what);
        faults.push(fault.allowed("exactly one of pressure_pa and curve"));
    }
    let Some(curve) = &pump.curve else { return };
    if pump.resistance_pa_s_m3 > 0.0 {
        let what = "a resistance beside a curve, which contains the decrease of the pressure";
        let fault = Violation::new(Code::Wiring, format!("{pointer}/resistance_pa_s_m3"), what);
        faults.push(fault.hint("remove the resistance"));
    }
    let (flows, pressures) = (&curve.flow_m3_s, &curve.pressure_pa);
    points(
        &format!("{pointer}/curve/flow_m3_s"),
        ["flow", "flows are in m^3/s; a ml/s is 1e-6"],
        [flows, pressures],
        faults,
    );
    let massless = case.fluid.as_ref().is_some_and(|fluid| fluid.density_kg_m3 == 0.0);
    if massless && pressures.windows(2).any(|pair| pair[0] < pair[1]) {
        let what = "a curve that rises with flow, for a fluid without mass";
        let fault = Violation::new(Code::Together, format!("{pointer}/curve"), what);
        faults.push(fault.hint("give /fluid/density_kg_m3: only inertia determines the flow where the pressure rises"));
    }
}

/// Checks the points of a curve of pressure over another quantity, whose values are at `pointer`: as many as pressures, ascending, and
/// apart. `names` are the name of the quantity and a hint about its unit. True if they are.
pub(super) fn points(pointer: &str, names: [&str; 2], values: [&[f64]; 2], faults: &mut Violations) -> bool {
    let ([name, hint], [at, pressures], before) = (names, values, faults.count());
    if at.len() != pressures.len() {
        let what = format!("{} {name}s for {} pressures", at.len(), pressures.len());
        let fault = Violation::new(Code::Count, pointer, what);
        faults.push(fault.allowed(pressures.len().to_string()));
    }
    if let Some(k) = at.windows(2).position(|pair| pair[0] >= pair[1]) {
        let what = format!("{name} {} after {name} {}", plain(at[k + 1]), plain(at[k]));
        let fault = Violation::new(Code::Wiring, format!("{pointer}/{}", k + 1), what);
        faults.push(fault.allowed(format!("ascending {name}s")));
    }
    let steep = at.windows(2).zip(pressures.windows(2));
    let steep = steep.map(|(x, p)| (p[1] - p[0]) / (x[1] - x[0]) / (x[1] - x[0]));
    if steep.into_iter().any(|bend| !(6.0 * bend).is_finite()) && faults.count() == before {
        let fault = Violation::new(Code::Wiring, pointer, format!("{name}s too close to each other"));
        faults.push(fault.hint(hint));
    }
    faults.count() == before
}

/// Resolves the pilot of a tube's valve: its accumulator by its index, and its volumes. Reports faults.
pub(super) fn pilot<'a>(
    case: &'a Case,
    tube: &'a schema::Tube,
    pointer: &str,
    faults: &mut Violations,
) -> Option<(usize, &'a Pilot)> {
    let pilot = tube.pilot.as_ref()?;
    let pointer = format!("{pointer}/pilot");
    if tube.check_valve.is_some() {
        let what = "a pilot of a tube with a check valve";
        let fault = Violation::new(Code::Together, pointer.clone(), what);
        faults.push(fault.hint("give the check valve to another tube in series, joined by a junction"));
    }
    if pilot.closed_at_m3 == pilot.open_at_m3 {
        let what = format!("{} m^3, at which the valve is also closed", plain(pilot.open_at_m3));
        let fault = Violation::new(Code::Wiring, format!("{pointer}/open_at_m3"), what);
        faults.push(fault.allowed("another volume than closed_at_m3"));
    }
    let vessels = case.network.as_ref().map_or(&[][..], |network| &network.accumulators);
    let names: Vec<String> = vessels.iter().map(schema::Accumulator::label).collect();
    let at = format!("{pointer}/vessel");
    let Some(vessel) = names.iter().position(|name| *name == pilot.vessel) else {
        let what = format!("\"{}\" is not the name of an accumulator", pilot.vessel);
        let known = || names.iter().map(String::as_str);
        faults.push(Violation {
            nearest: nearest(&pilot.vessel, known()),
            allowed: (!names.is_empty()).then(|| listed(known())),
            ..Violation::new(Code::Wiring, at, what).hint("name an accumulator under /network/accumulators")
        });
        return None;
    };
    if names.iter().filter(|name| **name == pilot.vessel).count() > 1 {
        let what = format!("\"{}\" is the name of several accumulators", pilot.vessel);
        let fault = Violation::new(Code::Wiring, at.clone(), what);
        faults.push(fault.hint("give each accumulator a name of its own (/network/accumulators/0/name)"));
    }
    if matches!(vessels[vessel].kind, AccumulatorKind::Tank { .. }) {
        let what = format!("the rigid tank \"{}\", whose volume is constant", pilot.vessel);
        let fault = Violation::new(Code::Wiring, at, what);
        faults.push(fault.allowed("an accumulator of kind elastic, gas or curve"));
    }
    Some((vessel, pilot))
}
