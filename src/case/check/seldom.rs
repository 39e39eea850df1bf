//! What a case may have and is seldom meant: told, not refused.

use super::functions::controls;
use crate::case::locate::child;
use crate::case::numbers::plain;
use crate::case::schema::Case;
use crate::functions::signals::Signal;

/// Density of the solid below which grams per cubic centimetre are suspected [kg/m^3]; silicones and rubbers have a thousand.
const LIGHT: f64 = 100.0;

/// Viscosity above which millipascal seconds are suspected [Pa s]; honey has ten.
const THICK: f64 = 100.0;

/// Numbers of a unit that is seldom meant, each with its pointer and what there is to say.
pub fn sizes(case: &Case) -> Vec<(String, String)> {
    if !case.plausibility.is_on() {
        return vec![];
    }
    let mut all = vec![];
    let density = case.beam.density_kg_m3;
    if density < LIGHT {
        let what = format!(
            "a solid of {} kg/m^3 is lighter than foam; silicone has about 1000: is this in g/cm^3?",
            plain(density)
        );
        all.push(("/beam/density_kg_m3".to_owned(), what));
    }
    if let Some(fluid) = case.fluid.as_ref().filter(|fluid| fluid.viscosity_pa_s > THICK) {
        let viscosity = plain(fluid.viscosity_pa_s);
        let what = format!(
            "a viscosity of {viscosity} Pa s is ten times that of honey and more; water has 1e-3: is this in mPa s?"
        );
        all.push(("/fluid/viscosity_pa_s".to_owned(), what));
    }
    let length = case.beam.length_m;
    for (pointer, _, signal) in controls(case) {
        let moves = pointer.starts_with("/ends/") && ["/u1_m", "/u3_m"].iter().any(|key| pointer.ends_with(key));
        if let Some(far) = signal.leaves(-length, length, case.time.end_s).filter(|_| moves) {
            let what = format!(
                "the end moves to {} m at {} s, farther than the beam is long, {} m: is this in millimetres?",
                plain(far.value),
                plain(far.t),
                plain(length)
            );
            all.push((pointer, what));
        }
    }
    all
}

/// Ramps and tables that begin when the run has ended, each with its pointer and what there is to say.
pub fn late(case: &Case) -> Vec<(String, String)> {
    let mut all = vec![];
    for (pointer, _, signal) in controls(case) {
        begins(&pointer, signal, &mut |at, start| {
            if start >= case.time.end_s {
                let end = plain(case.time.end_s);
                all.push((
                    at,
                    format!(
                        "it begins at {} s, and the run ends at {end} s: nothing of it acts",
                        plain(start)
                    ),
                ));
            }
        });
    }
    all
}

/// Where parts of a signal begin to change [s].
fn begins(pointer: &str, signal: &Signal, tell: &mut dyn FnMut(String, f64)) {
    match signal {
        Signal::Ramp(ramp) if ramp.from != ramp.to => tell(child(pointer, "ramp"), ramp.start_s),
        Signal::Table(table) => {
            let changes = table.values.windows(2).position(|pair| pair[0] != pair[1]);
            let first = changes.and_then(|k| table.times_s.get(k));
            if let Some(start) = first {
                tell(child(pointer, "table"), *start);
            }
        }
        Signal::Sum(parts) | Signal::Product(parts) => {
            let name = if matches!(signal, Signal::Sum(_)) {
                "sum"
            } else {
                "product"
            };
            for (k, part) in parts.iter().enumerate() {
                begins(&format!("{pointer}/{name}/{k}"), part, tell);
            }
        }
        _ => {}
    }
}
