//! What a case may have and is seldom meant: told, not refused.

use super::functions::controls;
use crate::case::locate::child;
use crate::case::numbers::{digits, plain};
use crate::case::schema::Case;
use crate::case::schema::Load;
use crate::functions::signals::Signal;

/// Density of the solid below which grams per cubic centimetre are suspected [kg/m^3]; silicones and rubbers have a thousand.
const LIGHT: f64 = 100.0;

/// Viscosity above which millipascal seconds are suspected [Pa s]; honey has ten.
const THICK: f64 = 100.0;

/// Gravity beyond which millimetres are suspected [m/s^2]; that of the earth is 9.81.
const HEAVY: f64 = 100.0;

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
    for (k, load) in case.loads.iter().enumerate() {
        let Load::Gravity { x_m_s2, z_m_s2 } = load else {
            continue;
        };
        for (key, size) in [("x_m_s2", *x_m_s2), ("z_m_s2", *z_m_s2)] {
            if size.abs() > HEAVY {
                let what = format!(
                    "a gravity of {} m/s^2 is {} times that of the earth, 9.81: is this in mm/s^2?",
                    plain(size),
                    digits(size.abs() / 9.81)
                );
                all.push((format!("/loads/{k}/gravity/{key}"), what));
            }
        }
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

/// Damping times that are longer than the period of the first bending mode of this frequency [Hz]: nothing swings.
pub fn damping(case: &Case, first: Option<f64>) -> Vec<(String, String)> {
    let Some(frequency) = first.filter(|_| case.plausibility.is_on()) else {
        return vec![];
    };
    let damping = &case.beam.damping;
    let times = [
        ("bending_time_s", damping.bending_time_s),
        ("axial_time_s", damping.axial_time_s),
    ];
    let told = times.into_iter().filter(|(_, time)| time * frequency > 1.0);
    let told = told.map(|(key, time)| {
        let what = format!(
            "a damping time of {} s is longer than the period of the first bending mode, {} s, so that nothing swings: is this in ms?",
            plain(time),
            digits(1.0 / frequency)
        );
        (format!("/beam/damping/{key}"), what)
    });
    told.collect()
}

/// That nothing holds the beam in some directions.
pub fn unheld(case: &Case, directions: &[&str]) -> Option<(String, String)> {
    if directions.is_empty() || !case.plausibility.is_on() {
        return None;
    }
    let what = format!(
        "nothing holds the beam {}: what pushes it makes it fly off as a whole; hold an end, or attach a spring to ground, unless it is to fly",
        directions.join(" and ")
    );
    Some(("/ends".to_owned(), what))
}

/// What there is to say of an instant that is asked about outside the run [s].
pub fn instant(case: &Case, at: f64) -> Option<String> {
    let end = case.time.end_s;
    let side = match at {
        _ if at < 0.0 => "before the run begins at 0 s",
        _ if at > end * (1.0 + 1e-9) => "after it ends",
        _ => return None,
    };
    Some(format!(
        "--at {}: this is {side}; the run of the case is from 0 to {} s, and what acts is taken as its signals go on",
        plain(at),
        plain(end)
    ))
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
